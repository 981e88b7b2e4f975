"""SVG elements: their looks in light and dark mode, curves as path data, escaped text and its estimated width.

The looks for light mode and print are presentation attributes, which need no style sheet; a style sheet changes the
colours of classes in dark mode.
"""

import re
from collections.abc import Iterable, Mapping
from functools import lru_cache
from math import atan2, degrees, hypot, tau
from typing import Any
from unicodedata import east_asian_width

from lxml import etree

from grader.drawing.curves import Arc, Curve, Line
from grader.drawing.scene import Rgba
from grader.drawing.sheet import Panel, Place
from grader.robot.transforms import Vector
from grader.text import printable

_Point = tuple[str, str]  # coordinates on the sheet, as they are written

SVG = "http://www.w3.org/2000/svg"
_LINE = {"fill": "none", "stroke-linecap": "round", "stroke-linejoin": "round"}
_AXIS = {**_LINE, "stroke-width": "1.8"}
_INK, _PAPER = "#1c1f23", "#ffffff"
_DARK_INK, _DARK_PAPER = "#e8eaed", "#16191d"
_AXES = (("x", "#d01f2e", "#ff7b72"), ("y", "#00805c", "#3ddc97"), ("z", "#0a5fd0", "#79b8ff"))
Look = tuple[Mapping[str, str], Mapping[str, str]]  # presentation attributes, and the colours in dark mode


def _line(colour: str, dark: str, width: str = "", **more: str) -> Look:
    widths = {"stroke-width": width} if width else {}
    return {**_LINE, "stroke": colour, **widths, **_attributes(more)}, {"stroke": dark}


def _fill(colour: str, dark: str, **more: str) -> Look:
    return {"fill": colour, **_attributes(more)}, {"fill": dark}


def _attributes(names: Mapping[str, str]) -> dict[str, str]:
    return {name.replace("_", "-"): value for name, value in names.items()}


# The looks of each class. No sign depends on colour alone.
LOOKS: Mapping[str, Look] = {
    "paper": _fill(_PAPER, _DARK_PAPER),
    "rule": _line("#c9ced6", "#3a4048"),
    "edge": _line(_INK, _DARK_INK),
    "edge-on-light": (_line(_INK, "")[0], {}),
    "edge-on-dark": (_line(_DARK_INK, "")[0], {}),
    "hidden": _line(_INK, _DARK_INK, stroke_opacity="0.5"),
    "ground": _line("#6b7280", "#9aa3af", "1.5"),
    "halo": _line(_PAPER, _DARK_PAPER, "5", stroke_opacity="0.75"),
    "reference": _line("#a3157f", "#ff8fd8", "1.8", stroke_dasharray="6 3.5"),
    **{f"axis-{name}": ({**_AXIS, "stroke": colour}, {"stroke": dark}) for name, colour, dark in _AXES},
    **{f"dot-{name}": _fill(colour, dark) for name, colour, dark in _AXES},
    "arrow": _line(_INK, "#ffffff", "2.6"),
    "leader": _line("#b3261e", "#ff8a80", "1.2"),
    "badge": _fill("#b3261e", "#ff8a80"),
    "number": _fill(_PAPER, _DARK_PAPER, font_weight="700", text_anchor="middle"),
    "text": _fill(_INK, _DARK_INK),
    "strong": _fill(_INK, _DARK_INK, font_weight="700"),
    "title": _fill(_INK, _DARK_INK, font_size="17", font_weight="700"),
    "faint": _fill("#4b5563", "#b6bdc7"),
    "letter": (
        {
            **_fill(_INK, "", font_size="11", text_anchor="middle")[0],
            "stroke": _PAPER,
            "stroke-width": "2.5",
            "paint-order": "stroke",
        },
        {"fill": _DARK_INK, "stroke": _DARK_PAPER},
    ),
}
DARK_RULES = "".join(
    f".drawing .{name}{{{';'.join(f'{key}:{value}' for key, value in dark.items())}}}"
    for name, (_, dark) in LOOKS.items()
    if dark
)


def put(parent: Any, tag: str, look: str = "", attributes: Mapping[str, object] = {}, text: str = "") -> Any:
    """Add an element with the looks of a class, and return it. Its text is made printable."""
    looks = {"class": look, **LOOKS[look][0]} if look else {}
    values = {name: number(value) if isinstance(value, float) else str(value) for name, value in attributes.items()}
    element = etree.SubElement(parent, f"{{{SVG}}}{tag}", {**looks, **values})
    if text:
        element.text = printable(text)
    return element


def number(value: float) -> str:
    """Return a length in pixels with one decimal."""
    return f"{round(value, 1) + 0.0:g}"


def colour(rgba: Rgba) -> dict[str, str]:
    """Return the attributes that fill a shape with a colour."""
    channels, alpha = "".join(f"{round(255.0 * value):02x}" for value in rgba[:3]), rgba[3]
    return {"fill": f"#{channels}", **({"fill-opacity": f"{alpha:.2g}"} if alpha < 1.0 else {})}


def edge_look(rgba: Rgba) -> str:
    """Return the class of edges on a colour: dark edges on light colours, light edges on dark ones."""
    red, green, blue, alpha = rgba
    if alpha < 0.5:
        return "edge"
    # As WCAG 2.2 defines it, with a plain gamma.
    luminance = 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2
    return "edge-on-light" if luminance > 0.18 else "edge-on-dark"


def path_data(panel: Panel, curves: Iterable[Curve], *, closed: bool = False) -> str:
    """Return curves of a view as path data on the sheet; one that does not continue the one before begins a subpath."""
    parts: list[str] = []
    last: _Point | None = None
    for curve in curves:
        start = _point(panel, curve.at(0.0))
        if start != last:
            parts.append(f"M{start[0]} {start[1]}")
        halves = 2 if isinstance(curve, Arc) and abs(curve.end - curve.start) > tau / 2.0 - 1e-6 else 1
        for half in range(1, halves + 1):
            end = _point(panel, curve.at(half / halves))
            parts.append(_segment(start, end) if isinstance(curve, Line) else _arc(panel, curve, start, end))
            start = end
        last = start
    return "".join(parts) + ("Z" if closed else "")


def _segment(start: _Point, end: _Point) -> str:
    if start[1] == end[1]:
        return f"H{end[0]}" if start != end else ""
    return f"V{end[1]}" if start[0] == end[0] else f"L{end[0]} {end[1]}"


def _arc(panel: Panel, arc: Arc, start: _Point, end: _Point) -> str:
    """Return an elliptical arc of at most half a turn; a line if it is seen edge-on."""
    rx, ry = (number(panel.scale * hypot(*radius[:2])) for radius in (arc.major, arc.minor))
    if "0" in (rx, ry):
        return _segment(start, end)
    tilt = number(degrees(atan2(-arc.major[1], arc.major[0]))) if rx != ry else "0"
    turn = (arc.major[0] * arc.minor[1] - arc.major[1] * arc.minor[0]) * (arc.end - arc.start)
    return f"A{rx} {ry} {tilt} 0 {0 if turn > 0.0 else 1} {end[0]} {end[1]}"  # y points down on the sheet


def _point(panel: Panel, point: Vector) -> _Point:
    x, y = panel.on_sheet(point)
    return number(x), number(y)


def segments(lines: Iterable[tuple[Place, Place]]) -> str:
    """Return straight lines on the sheet as path data."""
    ends = (((number(a), number(b)), (number(c), number(d))) for (a, b), (c, d) in lines)
    return "".join(f"M{start[0]} {start[1]}{_segment(start, end)}" for start, end in ends)


def circle(centre: Place, radius: float) -> str:
    """Return a circle on the sheet as path data."""
    start = f"M{number(centre[0] - radius)} {number(centre[1])}"
    half = f"a{number(radius)} {number(radius)} 0 1 1"
    return f"{start}{half} {number(2 * radius)} 0{half} {number(-2 * radius)} 0"


SIZE = 12.0  # pixels
LINE = 15.0  # from one line to the next
_NARROW, _WIDE = frozenset(" .,:;'|!ijlt()[]fr-"), frozenset("mwMW@%")
_WORD = re.compile(r"\S*\d (?:m|mm|degrees)\b\S*|\S+")  # a number has its unit on the same line
_CUT = re.compile(r"(?:\s+[-+(]*\d\S*)*\s+\S*$|[\s.,;:]+$")  # numbers before a word that is cut, and that word
_MAX_LINES = 6
_MAX_LENGTH = 1000  # characters: more do not fit into three lines


def put_lines(group: Any, left: float, top: float, width: float, text: str, most: int = _MAX_LINES) -> float:
    """Add a text in lines, the first of them at `top`; return the position of the next line."""
    lines = wrap(text, width, most)
    paragraph = put(group, "text")
    for number, line in enumerate(lines):
        put(paragraph, "tspan", "", {"x": left, "y": top + number * LINE}, line)
    return top + len(lines) * LINE


def wrap(text: str, width: float, most: int = _MAX_LINES) -> list[str]:
    """Return a text in at most some lines of a width in pixels; the last one ends with "..." if words are missing."""
    lines: list[str] = []
    line = ""
    for word in _WORD.findall(" ".join(printable(text[:_MAX_LENGTH]).split())):
        longer = f"{line} {word}" if line else word
        if line and text_width(longer) > width:
            if len(lines) == most - 1:
                return [*lines, _shorten(line, width)]
            lines.append(line)
            longer = word
        line = cut(longer, width)
    return [*lines, line] if line else lines


def cut(text: str, width: float) -> str:
    """Return a text, cut with "..." if it is wider."""
    return text if text_width(text) <= width else _shorten(text, width)


def _shorten(text: str, width: float) -> str:
    """Return the start of a text and "..."; it ends with a whole word, not with a number that has lost its unit."""
    while text and text_width(text) > width - SIZE:
        text = text[:-1]
    return f"{_CUT.sub('', text) or text}..."


def text_width(text: str) -> float:
    """Return the estimated width of a text in DejaVu Sans, which is wider than most fonts."""
    return SIZE * sum(map(_letter_width, text))


@lru_cache(maxsize=1024)
def _letter_width(letter: str) -> float:
    if letter in _NARROW:
        return 0.38
    if east_asian_width(letter) in "WF" or letter in _WIDE:
        return 1.0
    return 0.72 if letter.isupper() else 0.62
