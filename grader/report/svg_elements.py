"""SVG elements as text: their looks in light and dark mode, lines and labels. Every text is escaped here."""

from collections.abc import Sequence
from html import escape

from grader.drawing.views import Place
from grader.text import printable

_FONT = "12px system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif"
RADIUS = 9.0  # of a number, in pixels
_AXES = (("x", "#d01f2e", "#ff7b72"), ("y", "#00805c", "#3ddc97"), ("z", "#0a5fd0", "#79b8ff"))
# The rules of each class, and the colours in dark mode. No sign depends on colour alone.
_LOOKS: dict[str, tuple[str, str]] = {
    "paper": ("fill:#fff", "fill:#16191d"),
    "rule": ("stroke:#c9ced6", "stroke:#3a4048"),
    "hidden": ("stroke:#1c1f23;stroke-opacity:.35", "stroke:#e8eaed"),
    "ground": ("stroke:#6b7280;stroke-width:1.5", "stroke:#9aa3af"),
    "halo": ("stroke:#fff;stroke-width:5;stroke-opacity:.75", "stroke:#16191d"),
    "reference": ("stroke:#a3157f;stroke-width:1.8;stroke-dasharray:6 3.5", "stroke:#ff8fd8"),
    **{f"axis-{name}": (f"stroke:{light};stroke-width:1.8", f"stroke:{dark}") for name, light, dark in _AXES},
    **{f"dot-{name}": (f"fill:{light}", f"fill:{dark}") for name, light, dark in _AXES},
    "arrow": ("stroke:#1c1f23;stroke-width:2.6", "stroke:#fff"),
    "leader": ("stroke:#b3261e;stroke-width:1.2", "stroke:#ff8a80"),
    "badge": ("fill:#b3261e", "fill:#ff8a80"),
    "number": ("fill:#fff;font-weight:700;text-anchor:middle", "fill:#16191d"),
    "text": ("fill:#1c1f23", "fill:#e8eaed"),
    "strong": ("fill:#1c1f23;font-weight:700", "fill:#e8eaed"),
    "title": ("fill:#1c1f23;font-size:17px;font-weight:700", "fill:#e8eaed"),
    "faint": ("fill:#4b5563", "fill:#b6bdc7"),
    "letter": (
        "fill:#1c1f23;stroke:#fff;stroke-width:2.5;paint-order:stroke;font-size:11px;text-anchor:middle",
        "fill:#e8eaed;stroke:#16191d",
    ),
}
_LIGHT, _DARK = ("".join(f".drawing .{name}{{{looks[dark]}}}" for name, looks in _LOOKS.items()) for dark in (0, 1))
STYLE = (
    f".drawing{{font:{_FONT}}}.drawing path{{fill:none;stroke-linecap:round;stroke-linejoin:round}}"
    f"{_LIGHT}@media screen and (prefers-color-scheme:dark){{{_DARK}}}"
)


def escaped(text: str) -> str:
    """Return text as SVG shows it, printable."""
    return escape(printable(text))


def text(look: str, place: Place, text: str) -> str:
    """Return a label; its place is on its base line."""
    return f'<text class="{look}" x="{number(place[0])}" y="{number(place[1])}">{escaped(text)}</text>'


def number(value: float) -> str:
    """Return a length in pixels with one decimal."""
    return f"{round(value, 1) + 0.0:g}"


def segment(start: Place, end: Place) -> str:
    """Return the path data of a straight line."""
    return f"M{number(start[0])} {number(start[1])}L{number(end[0])} {number(end[1])}"


def circle(centre: Place, radius: float) -> str:
    """Return the path data of a circle."""
    half = f"a{number(radius)} {number(radius)} 0 1 1"
    return (
        f"M{number(centre[0] - radius)} {number(centre[1])}{half} {number(2 * radius)} 0{half} {number(-2 * radius)} 0"
    )


def polygon(corners: Sequence[Place]) -> str:
    """Return the path data of a closed outline."""
    return f"M{'L'.join(f'{number(x)} {number(y)}' for x, y in corners)}Z"


def badge(centre: Place, count: int) -> str:
    """Return a number in a disc."""
    return path("badge", circle(centre, RADIUS)) + text("number", (centre[0], centre[1] + 4.2), str(count))


def path(look: str, data: str) -> str:
    """Return lines with the look of a class."""
    return f'<path class="{look}" d="{data}"/>'
