"""SVG elements: their looks in light and dark mode, curves as path data, text that is only text.

The looks for light mode and print are presentation attributes, which need no style sheet; a style sheet changes the colours of
classes in dark mode.
"""

from collections.abc import Iterable, Mapping, Sequence
from math import atan2, degrees, hypot, isfinite, tau
from typing import Any
from unicodedata import east_asian_width

from lxml import etree

from grader.drawing.curves import Arc, Curve, Line
from grader.drawing.scene import Rgba
from grader.drawing.sheet import Cell, Place
from grader.text import printable

SVG = "http://www.w3.org/2000/svg"
_LINE = {"fill": "none", "stroke-linecap": "round", "stroke-linejoin": "round"}
_TEXT = {"fill": "#1c1f23", "font-size": "12"}
# The looks of each class: presentation attributes, and the colours that dark mode changes. The hues are told apart by
# people with any kind of colour vision (Okabe and Ito, Color Universal Design, 2008), and are never the only sign.
LOOKS: Mapping[str, tuple[Mapping[str, str], Mapping[str, str]]] = {
    "paper": ({"fill": "#ffffff"}, {"fill": "#16191d"}),
    "rule": ({**_LINE, "stroke": "#c9ced6"}, {"stroke": "#3a4048"}),
    "edge": ({**_LINE, "stroke": "#1c1f23", "stroke-width": "1.3"}, {"stroke": "#e8eaed"}),
    "edge-on-light": ({**_LINE, "stroke": "#1c1f23", "stroke-width": "1.3"}, {}),
    "edge-on-dark": ({**_LINE, "stroke": "#e8eaed", "stroke-width": "1.3"}, {}),
    "ground": ({**_LINE, "stroke": "#6b7280", "stroke-width": "1.5"}, {"stroke": "#9aa3af"}),
    "halo": (
        {**_LINE, "stroke": "#ffffff", "stroke-width": "4", "stroke-opacity": "0.75"},
        {"stroke": "#16191d"},
    ),
    "reference": (
        {**_LINE, "stroke": "#a3157f", "stroke-width": "1.8", "stroke-dasharray": "6 3.5"},
        {"stroke": "#ff8fd8"},
    ),
    "axis-x": ({**_LINE, "stroke": "#d01f2e", "stroke-width": "1.8"}, {"stroke": "#ff7b72"}),
    "axis-y": ({**_LINE, "stroke": "#00805c", "stroke-width": "1.8"}, {"stroke": "#3ddc97"}),
    "axis-z": ({**_LINE, "stroke": "#0a5fd0", "stroke-width": "1.8"}, {"stroke": "#79b8ff"}),
    "arrow": ({**_LINE, "stroke": "#1c1f23", "stroke-width": "2.6"}, {"stroke": "#ffffff"}),
    "leader": ({**_LINE, "stroke": "#b3261e", "stroke-width": "1.2"}, {"stroke": "#ff8a80"}),
    "badge": (
        {"fill": "#b3261e", "stroke": "#ffffff", "stroke-width": "1.5"},
        {"fill": "#ff8a80", "stroke": "#16191d"},
    ),
    "number": (
        {"fill": "#ffffff", "font-size": "12", "font-weight": "700", "text-anchor": "middle"},
        {"fill": "#16191d"},
    ),
    "text": (_TEXT, {"fill": "#e8eaed"}),
    "strong": ({**_TEXT, "font-weight": "700"}, {"fill": "#e8eaed"}),
    "title": ({**_TEXT, "font-size": "17", "font-weight": "700"}, {"fill": "#e8eaed"}),
    "faint": ({**_TEXT, "fill": "#4b5563"}, {"fill": "#b6bdc7"}),
    "letter": (
        {
            **_TEXT,
            "font-size": "11",
            "text-anchor": "middle",
            "stroke": "#ffffff",
            "stroke-width": "2.5",
            "paint-order": "stroke",
        },
        {"fill": "#e8eaed", "stroke": "#16191d"},
    ),
}
DARK_RULES = "".join(
    f".drawing .{name}{{{';'.join(f'{key}:{value}' for key, value in dark.items())}}}"
    for name, (_, dark) in LOOKS.items()
    if dark
)


def put(parent: Any, tag: str, look: str = "", attributes: Mapping[str, object] = {}, text: str = "") -> Any:
    """Add an element with the looks of a class, and return it. Its text is printable, whatever a student wrote."""
    looks = {"class": look, **LOOKS[look][0]} if look else {}
    values = {name: number(value) if isinstance(value, float) else str(value) for name, value in attributes.items()}
    element = etree.SubElement(parent, f"{{{SVG}}}{tag}", {**looks, **values})
    if text:
        element.text = printable(text)
    return element


def number(value: float) -> str:
    """Return a length in pixels with two decimals."""
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def colour(rgba: Rgba) -> dict[str, str]:
    """Return the attributes that fill a shape with a colour; a channel that is no number is 0."""
    red, green, blue, alpha = (min(max(value, 0.0), 1.0) if isfinite(value) else 0.0 for value in rgba)
    channels = "".join(f"{round(255.0 * value):02x}" for value in (red, green, blue))
    return {"fill": f"#{channels}", **({"fill-opacity": number(alpha)} if alpha < 1.0 else {})}


def edge_look(rgba: Rgba) -> str:
    """Return the class of edges that are seen on a colour: dark on light ones, light on dark ones."""
    red, green, blue, alpha = (min(max(value, 0.0), 1.0) if isfinite(value) else 0.0 for value in rgba)
    if alpha < 0.5:
        return "edge"
    luminance = (
        0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2
    )  # as WCAG 2.2 defines it, with a plain gamma
    return "edge-on-light" if luminance > 0.18 else "edge-on-dark"


def path_data(cell: Cell, curves: Iterable[Curve], *, closed: bool = False) -> str:
    """Return curves of a view as path data on the sheet; a new piece begins wherever one does not continue the one before."""
    parts: list[str] = []
    last: str | None = None
    for curve in curves:
        start, end = _place(cell, curve.at(0.0)), _place(cell, curve.at(1.0))
        if start != last:
            parts.append(f"M{start}")
        if isinstance(curve, Line):
            if start != end:
                parts.append(f"L{end}")
        else:
            parts += _arc(cell, curve)
        last = end
    return "".join(parts) + ("Z" if closed else "")


def _arc(cell: Cell, arc: Arc) -> list[str]:
    """Return an elliptical arc in commands of at most half a turn; a line if it is seen from its edge."""
    rx, ry = cell.scale * hypot(*arc.major[:2]), cell.scale * hypot(*arc.minor[:2])
    if number(rx) == "0" or number(ry) == "0":
        return [f"L{_place(cell, arc.at(share))}" for share in (0.5, 1.0)]
    tilt = degrees(atan2(-arc.major[1], arc.major[0]))
    turn = (arc.major[0] * arc.minor[1] - arc.major[1] * arc.minor[0]) * (arc.end - arc.start)
    sweep = 0 if turn > 0.0 else 1  # y points down on the sheet
    radii = f"{number(rx)} {number(ry)} {number(tilt)}"
    halves = 2 if abs(arc.end - arc.start) > tau / 2.0 - 1e-6 else 1
    shares = [number_ / halves for number_ in range(1, halves + 1)]
    return [f"A{radii} 0 {sweep} {_place(cell, arc.at(share))}" for share in shares]


def _place(cell: Cell, point: Sequence[float]) -> str:
    x, y = cell.on_sheet((point[0], point[1], 0.0))
    return f"{number(x)} {number(y)}"


def segments(lines: Iterable[tuple[Place, Place]]) -> str:
    """Return straight lines on the sheet as path data."""
    return "".join(f"M{number(a)} {number(b)}L{number(c)} {number(d)}" for (a, b), (c, d) in lines)


def text_width(text: str, size: float = 12.0) -> float:
    """Return about how wide a text is in a sans-serif font; rather too much than too little."""
    return size * sum(1.0 if east_asian_width(letter) in "WF" else 0.57 for letter in text)


def wrapped(text: str, width: float, most: int = 3) -> list[str]:
    """Return a text in at most some lines of a width in pixels; the last one ends with "..." if words are missing."""
    lines = [""]
    room = max(1, int(width / 12.0))  # letters of a name without spaces
    words = (word if text_width(word) <= width else word[:room] for word in printable(text).split(" "))
    for word in words:
        line = f"{lines[-1]} {word}" if lines[-1] else word
        lines = [*lines[:-1], line] if text_width(line) <= width else [*lines, word]
    lines = [line for line in lines if line]
    return lines if len(lines) <= most else [*lines[: most - 1], f"{lines[most - 1][:-4]} ..."]
