"""SVG elements: their looks in light and dark mode, curves as path data, escaped text and its estimated width.

The looks for light mode and print are presentation attributes, which need no style sheet; a style sheet changes the
colours of classes in dark mode.
"""

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
# The looks of each class: presentation attributes, and the colours in dark mode. No sign depends on colour alone.
LOOKS: Mapping[str, tuple[Mapping[str, str], Mapping[str, str]]] = {
    "paper": ({"fill": _PAPER}, {"fill": _DARK_PAPER}),
    "rule": ({**_LINE, "stroke": "#c9ced6"}, {"stroke": "#3a4048"}),
    "edge": ({**_LINE, "stroke": _INK}, {"stroke": _DARK_INK}),
    "edge-on-light": ({**_LINE, "stroke": _INK}, {}),
    "edge-on-dark": ({**_LINE, "stroke": _DARK_INK}, {}),
    "hidden": ({**_LINE, "stroke": _INK, "stroke-opacity": "0.5"}, {"stroke": _DARK_INK}),
    "ground": ({**_LINE, "stroke": "#6b7280", "stroke-width": "1.5"}, {"stroke": "#9aa3af"}),
    "halo": (
        {**_LINE, "stroke": _PAPER, "stroke-width": "5", "stroke-opacity": "0.75"},
        {"stroke": _DARK_PAPER},
    ),
    "reference": (
        {**_LINE, "stroke": "#a3157f", "stroke-width": "1.8", "stroke-dasharray": "6 3.5"},
        {"stroke": "#ff8fd8"},
    ),
    "axis-x": ({**_AXIS, "stroke": "#d01f2e"}, {"stroke": "#ff7b72"}),
    "axis-y": ({**_AXIS, "stroke": "#00805c"}, {"stroke": "#3ddc97"}),
    "axis-z": ({**_AXIS, "stroke": "#0a5fd0"}, {"stroke": "#79b8ff"}),
    "dot-x": ({"fill": "#d01f2e"}, {"fill": "#ff7b72"}),
    "dot-y": ({"fill": "#00805c"}, {"fill": "#3ddc97"}),
    "dot-z": ({"fill": "#0a5fd0"}, {"fill": "#79b8ff"}),
    "arrow": ({**_LINE, "stroke": _INK, "stroke-width": "2.6"}, {"stroke": "#ffffff"}),
    "leader": ({**_LINE, "stroke": "#b3261e", "stroke-width": "1.2"}, {"stroke": "#ff8a80"}),
    "badge": ({"fill": "#b3261e"}, {"fill": "#ff8a80"}),
    "number": ({"fill": _PAPER, "font-weight": "700", "text-anchor": "middle"}, {"fill": _DARK_PAPER}),
    "text": ({"fill": _INK}, {"fill": _DARK_INK}),
    "strong": ({"fill": _INK, "font-weight": "700"}, {"fill": _DARK_INK}),
    "title": ({"fill": _INK, "font-size": "17", "font-weight": "700"}, {"fill": _DARK_INK}),
    "faint": ({"fill": "#4b5563"}, {"fill": "#b6bdc7"}),
    "letter": (
        {
            "fill": _INK,
            "font-size": "11",
            "text-anchor": "middle",
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
    luminance = (
        0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2
    )  # as WCAG 2.2 defines it, with a plain gamma
    return "edge-on-light" if luminance > 0.18 else "edge-on-dark"


def path_data(cell: Panel, curves: Iterable[Curve], *, closed: bool = False) -> str:
    """Return curves of a view as path data on the sheet; one that does not continue the one before begins a subpath."""
    parts: list[str] = []
    last: _Point | None = None
    for curve in curves:
        start = _point(cell, curve.at(0.0))
        if start != last:
            parts.append(f"M{start[0]} {start[1]}")
        halves = 2 if isinstance(curve, Arc) and abs(curve.end - curve.start) > tau / 2.0 - 1e-6 else 1
        for half in range(1, halves + 1):
            end = _point(cell, curve.at(half / halves))
            parts.append(_line(start, end) if isinstance(curve, Line) else _arc(cell, curve, start, end))
            start = end
        last = start
    return "".join(parts) + ("Z" if closed else "")


def _line(start: _Point, end: _Point) -> str:
    if start[1] == end[1]:
        return f"H{end[0]}" if start != end else ""
    return f"V{end[1]}" if start[0] == end[0] else f"L{end[0]} {end[1]}"


def _arc(cell: Panel, arc: Arc, start: _Point, end: _Point) -> str:
    """Return an elliptical arc of at most half a turn; a line if it is seen edge-on."""
    rx, ry = (number(cell.scale * hypot(*radius[:2])) for radius in (arc.major, arc.minor))
    if "0" in (rx, ry):
        return _line(start, end)
    tilt = number(degrees(atan2(-arc.major[1], arc.major[0]))) if rx != ry else "0"
    turn = (arc.major[0] * arc.minor[1] - arc.major[1] * arc.minor[0]) * (arc.end - arc.start)
    return f"A{rx} {ry} {tilt} 0 {0 if turn > 0.0 else 1} {end[0]} {end[1]}"  # y points down on the sheet


def _point(cell: Panel, point: Vector) -> _Point:
    x, y = cell.on_sheet(point)
    return number(x), number(y)


def segments(lines: Iterable[tuple[Place, Place]]) -> str:
    """Return straight lines on the sheet as path data."""
    ends = (((number(a), number(b)), (number(c), number(d))) for (a, b), (c, d) in lines)
    return "".join(f"M{start[0]} {start[1]}{_line(start, end)}" for start, end in ends)


def circle(centre: Place, radius: float) -> str:
    """Return a circle on the sheet as path data."""
    start = f"M{number(centre[0] - radius)} {number(centre[1])}"
    half = f"a{number(radius)} {number(radius)} 0 1 1"
    return f"{start}{half} {number(2 * radius)} 0{half} {number(-2 * radius)} 0"


SIZE = 12.0  # pixels
LINE = 15.0  # from one line to the next
_NARROW, _WIDE = frozenset(" .,:;'|!ijlt()[]fr-"), frozenset("mwMW@%")
_MAX_LINES = 3
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
    for word in printable(text[:_MAX_LENGTH]).split():
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
    while text and text_width(text) > width - SIZE:
        text = text[:-1]
    return f"{text.rstrip(' .,;:')}..."


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
