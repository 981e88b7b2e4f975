"""The drawing of a robot as SVG.

It has three views at one scale, a key of the signs, and the failed criteria.

It needs no script or other file. A page that contains it adds `STYLE` to its own rules. The signs
are shapes, ground, frames, driving directions, outlines of the reference, and numbers. Every text
is escaped here.
"""

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from html import escape
from math import cos, hypot, sin, tau
from textwrap import wrap

from grader.base.grouping import Strings
from grader.base.text import enumerated, printable
from grader.base.transforms import AXES, Z_AXIS, Transform
from grader.report.drawing.picture import Body, Picture, Wheel
from grader.report.drawing.views import (
    PANEL,
    WIDTH,
    FreePlaces,
    Panel,
    Place,
    from_back_to_front,
    list_frames,
    make_panels,
)

_Drawn = Iterator[tuple[str, str]]  # looks or signs, each with a path or a meaning

_LEFT, _LINE = 14.0, 15.0  # pixels
_LETTER_WIDTH = 6.8  # pixels, on average, of a font that is wider than most
_WIDTH = WIDTH - 2.0 * _LEFT
_MAX_TITLE = 200
_MAX_TEXT = 1000
_MAX_LINES = 6
NO_PICTURE = "No picture: no robot can be read."
_NO_SHAPES = "No visual can be drawn: only frames of links are shown."
_FONT = "12px system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif"
_LOOKS = {
    "paper": "fill:#fff",
    "edge": "stroke:#4b5563",
    "hidden": "stroke:#1c1f23;stroke-opacity:.35",
    "ground": "stroke:#6b7280;stroke-width:1.5",
    "halo": "stroke:#fff;stroke-width:5;stroke-opacity:.75",
    "reference": "stroke:#a3157f;stroke-width:1.8;stroke-dasharray:6 3.5",
    "dashed": "stroke-dasharray:6 3.5",
    "axis-x": "stroke:#d01f2e;stroke-width:1.8",
    "axis-y": "stroke:#00805c;stroke-width:1.8",
    "axis-z": "stroke:#0a5fd0;stroke-width:1.8",
    "small": "stroke-width:1.3",
    "tiny": "stroke-width:.9",
    "small-halo": "stroke-width:2.6",
    "arrow": "stroke:#1c1f23;stroke-width:2.6",
    "leader": "stroke:#b3261e;stroke-width:1.2",
    "badge": "fill:#b3261e",
    "number": "fill:#fff;font-weight:700;text-anchor:middle",
    "text": "fill:#1c1f23",
    "title": "fill:#1c1f23;font-size:17px;font-weight:700",
    "faint": "fill:#4b5563",
    "letter": (
        "fill:#1c1f23;stroke:#fff;stroke-width:2.5;paint-order:stroke;font-size:11px;text-anchor:middle"
    ),
}
STYLE = (
    f".drawing{{font:{_FONT}}}.drawing path{{fill:none;stroke-linecap:round;stroke-linejoin:round}}"
    f"{''.join(f'.drawing .{name}{{{rules}}}' for name, rules in _LOOKS.items())}"
)
_RADIUS = 9.0  # of a number, in pixels
_AXIS, _LONG_AXIS, _ARROW = 20.0, 32.0, 30.0  # pixels
# The axes of a link's frame leave its shapes visible: the least size of these in pixels, the look
# of the axes, and their length in pixels. Tiny axes have no white edge.
_AXES_BY_ROOM = ((15.0, "", _AXIS), (8.0, " small", 14.0), (0.0, " tiny", 9.0))
_HALOS = {"small": "halo small-halo", "tiny": ""}  # by size
_END_ON = 0.2  # of its length: an axis or arrow that appears shorter is not drawn as one
_BADGE = 2.0 * _RADIUS + 2.0, 2.0 * _RADIUS + 2.0  # the room of one
_RINGS = (22.0, 30.0, 40.0, 52.0, 66.0, 84.0, 106.0, 132.0)  # pixels from what a number labels
_AROUND = [
    (ring * cos(tau * n / 16), -ring * sin(tau * n / 16)) for ring in _RINGS for n in range(2, 18)
]
_MAX_NAME = 60
_ROW = 18.0
_MAX_OUTLINES = 1024  # that are kept


def drawing_element(
    picture: Picture, title: str = "", *, legend: bool = True, above: Sequence[str] = ()
) -> str:
    """Return the drawing of a robot as an SVG element.

    `above` are lines above it, `legend` lists the callouts below.

    Screen readers read the title and the same list.
    """
    panels = make_panels(picture, _height(above) if title else 0.0)
    parts = _headline(title, above) if title else []
    for panel in panels:
        parts.append(f"<g>{''.join(_view(panel, picture))}</g>")
    parts += _key(picture, panels[0].top)
    height = panels[-1].top + panels[-1].height
    callouts = callout_lines(picture)
    lines = _wrapped_lines(callouts) if legend else []
    if lines:
        parts += _lines_of_text("text", lines, height)
        height += _LINE * len(lines) + 6.0
    return _svg(title or "Three views of the robot", " ".join(callouts), height, parts)


def _lines_of_text(look: str, lines: Sequence[str], top: float) -> list[str]:
    """Return lines below a height."""
    return [
        _text(look, (_LEFT, top + _LINE * number), line) for number, line in enumerate(lines, 1)
    ]


def _svg(title: str, words: str, height: float, parts: Iterable[str]) -> str:
    size = f'width="{WIDTH:g}" height="{height:.0f}"'
    said = f"<title>{_escaped(title[:_MAX_TITLE])}</title><desc>{_escaped(words)}</desc>"
    start = (
        '<svg xmlns="http://www.w3.org/2000/svg" class="drawing" role="img" viewBox="0 0 '
        f'{WIDTH:g} {height:.0f}"'
    )
    return f'{start} {size}>{said}<rect class="paper" {size}/>{"".join(parts)}</svg>'


def callout_lines(picture: Picture) -> list[str]:
    """Return what each callout of a picture is about, and what is not shown."""
    lines = []
    for callout in picture.callouts:
        place = "" if callout.point is not None else " (not in the picture)"
        what = f"{callout.number}: {callout.link or 'the robot'}"
        lines.append(f"{what}: {callout.cost} lost{place}, {enumerated(callout.names)}.")
    lines += picture.scene.remarks
    if not picture.scene.bodies:
        lines.append(_NO_SHAPES)
    return [printable(line) for line in lines]


def _wrapped(words: str, width: float) -> list[str]:
    """Return a text in lines of a width in pixels; of a long text the first."""
    text = printable(words[:_MAX_TEXT])
    most = int(width / _LETTER_WIDTH)
    return wrap(text, most, max_lines=_MAX_LINES, placeholder=" ...", break_on_hyphens=False)


def _wrapped_lines(texts: Iterable[str]) -> list[str]:
    """Return texts in lines of the width of the drawing."""
    return [line for text in texts for line in _wrapped(text, _WIDTH)]


def drawing_file(picture: Picture | None, title: str, words: Iterable[str], reason: str) -> str:
    """Return a drawing as the text of an SVG file, with words below its title.

    Without a picture, it shows the reason.
    """
    above = _wrapped_lines(filter(None, words))
    if picture:
        drawn = drawing_element(picture, title, above=above)
    else:
        above += ["", *_wrapped(reason, _WIDTH)]
        drawn = _svg(title, reason, _height(above), _headline(title, above))
    style = f"<style>svg{{max-width:100%;height:auto}}{STYLE}</style>"
    return drawn.replace("<title>", f"{style}<title>", 1) + "\n"


def _headline(title: str, above: Sequence[str]) -> list[str]:
    shown = [_text("title", (_LEFT, 26.0), line) for line in _wrapped(title, _WIDTH / 1.5)[:1]]
    return shown + _lines_of_text("faint", above, 2.0 * _LEFT)


def _height(above: Sequence[str]) -> float:
    return 2.0 * _LEFT + _LINE * len(above) + 8.0


def _view(panel: Panel, picture: Picture) -> Iterator[str]:
    """Yield a view: the ground, the shapes from back to front, then the signs."""
    places = FreePlaces(panel)
    yield _text("faint", (panel.left + 14.0, panel.top + 14.0), panel.title)
    yield from _ground(panel, picture, places)
    outlines = []
    for body in from_back_to_front(picture.scene.bodies, panel):
        outline = _outline(panel, body)
        outlines.append(_polygon(outline))
        yield _shape(body, outline)
    if len(outlines) > 1:  # what a shape hides shows through
        yield _path("hidden", "".join(outlines))
    lines = dict.fromkeys(_lines(panel, picture))  # each once
    by_halo: dict[str, list[str]] = {}
    for look, data in lines:
        halo = _HALOS.get(look.rpartition(" ")[2], "halo")
        by_halo.setdefault(halo, []).append(data)
    by_halo.pop("", None)
    for halo, around in by_halo.items():
        yield _path(halo, "".join(around))
    for look, data in lines:
        yield _path(look, data)
    yield from _numbers(panel, picture, places)


def _lines(panel: Panel, picture: Picture) -> _Drawn:
    """Yield the look and the path of each line over the shapes.

    These are the outlines and frames of the reference, the frames of the robot, and the driving
    directions.
    """
    for body in picture.outlines:
        yield "reference", _polygon(_outline(panel, body))
    for frame in list_frames(picture):
        room = frame.size * panel.scale if frame.size is not None else _AXIS
        fitting = (row for row in _AXES_BY_ROOM if room >= row[0])
        _, size, length = next(fitting)
        yield from _axes(panel, size, length, frame.pose)
    for pose in picture.frames:
        yield from _axes(panel, " dashed", _LONG_AXIS, pose)
    for wheel in picture.scene.wheels:
        for data in _travel(panel, wheel):
            yield "arrow", data


def _ground(panel: Panel, picture: Picture, places: FreePlaces) -> Iterator[str]:
    """Yield the ground where it is seen edge-on and is level."""
    ground = picture.scene.ground
    if not ground or abs(panel.direction(ground.rotate(Z_AXIS))[1] + 1.0) > 1e-3:
        return
    y = panel.place(ground.translation)[1]
    if places.take([(panel.left + PANEL / 2.0, y)], (PANEL, 1.0)):
        yield _path("ground", _segment((panel.left + 6.0, y), (panel.left + PANEL - 6.0, y)))
        places.take([(panel.left + 28.0, y + 9.0)], (44.0, 12.0))
        yield _text("letter", (panel.left + 28.0, y + 12.0), "ground")


@lru_cache(_MAX_OUTLINES)  # in a class many robots have the same parts
def _outline(panel: Panel, body: Body) -> Strings:
    """Return the corners of the outline of a body as SVG has them."""
    return tuple(f"{_number(x)} {_number(y)}" for x, y in panel.outline(body))


def _shape(body: Body, outline: Sequence[str]) -> str:
    *rgb, alpha = body.rgba
    fill = "".join(f"{round(255.0 * channel):02x}" for channel in rgb)
    looks = f'class="edge" fill="#{fill}"'
    if alpha < 1.0:
        looks += f' fill-opacity="{alpha:.2g}"'
    name = _escaped(body.link[:_MAX_NAME])
    return f'<polygon {looks} points="{" ".join(outline)}"><title>{name}</title></polygon>'


def _axes(panel: Panel, look: str, length: float, pose: Transform) -> _Drawn:
    """Yield the look and the path of each axis of a frame.

    Axes that point to the viewer or away are not among them.
    """
    x, y = panel.place(pose.translation)
    for name, axis in zip("xyz", AXES, strict=True):
        across, down, _ = panel.direction(pose.rotate(axis))
        if hypot(across, down) > _END_ON:
            end = x + length * across, y + length * down
            yield f"axis-{name}{look}", _segment((x, y), end)


def _travel(panel: Panel, wheel: Wheel) -> Iterator[str]:
    """Yield the path of the driving direction.

    It keeps to the right of the wheel's centre, so that two are visible.
    """
    across, down, _ = panel.direction(wheel.travel)
    if hypot(across, down) > _END_ON:
        x, y = panel.place(wheel.centre)
        yield _arrow((x - 7.0 * down, y + 7.0 * across), across, down)


def _arrow(start: Place, across: float, down: float) -> str:
    """Return the path data of an arrow in a direction on the sheet."""
    tip = x, y = start[0] + _ARROW * across, start[1] + _ARROW * down
    data = _segment(start, tip)
    for side in (4.2, -4.2):
        barb = x - 6.0 * across - side * down, y - 6.0 * down + side * across
        data += _segment(tip, barb)
    return data


def _numbers(panel: Panel, picture: Picture, places: FreePlaces) -> Iterator[str]:
    """Yield the numbers of callouts beside their points, with lines to them."""
    for callout in picture.callouts:
        if callout.point is not None:
            x, y = panel.place(callout.point)
            around = [(x + across, y + down) for across, down in _AROUND]
            centre = places.take(around, _BADGE) or (x, y)
            yield _path("leader", _segment((x, y), centre)) + _badge(centre, callout.number)


def _key(picture: Picture, top: float) -> Iterator[str]:
    """Yield the meaning of each sign that a drawing has, beside the view from above."""
    for row, (sign, meaning) in enumerate(_signs(picture), 1):
        at = f"{PANEL + 26.0:g} {_number(top + row * _ROW)}"
        yield f'<g transform="translate({at})">{sign}{_text("faint", (34.0, 4.0), meaning)}</g>'


def _signs(picture: Picture) -> _Drawn:
    """Yield each sign that a drawing has, with its meaning."""
    if any(callout.point is not None for callout in picture.callouts):
        yield _badge((12.0, 0.0), 1), "points lost"
    if picture.outlines or picture.frames:
        yield _path("reference", "M0 0L26 0"), "reference solution"
    if picture.scene.wheels:
        yield _path("arrow", _arrow((-3.0, 0.0), 1.0, 0.0)), "driven so by a positive rotation"
    axes = (_path(f"axis-{name}", f"M{x} -5L{x} 5") for name, x in (("x", 5), ("y", 13), ("z", 21)))
    yield "".join(axes), "axes of a frame: x red, y green, z blue"
    if len(picture.scene.bodies) > 1:
        yield _path("hidden", "M0 0L26 0"), "hidden edge"


def _escaped(words: str) -> str:
    """Return text as SVG shows it, printable."""
    return escape(printable(words))


def _text(look: str, place: Place, words: str) -> str:
    """Return a label; its place is on its base line."""
    return (
        f'<text class="{look}" x="{_number(place[0])}" '
        f'y="{_number(place[1])}">{_escaped(words)}</text>'
    )


def _number(value: float) -> str:
    """Return a length in pixels with one decimal."""
    return f"{round(value, 1) + 0.0:g}"


def _segment(start: Place, end: Place) -> str:
    """Return the path data of a straight line."""
    return f"M{_number(start[0])} {_number(start[1])}L{_number(end[0])} {_number(end[1])}"


def _polygon(corners: Sequence[str]) -> str:
    return f"M{'L'.join(corners)}Z"


def _badge(centre: Place, count: int) -> str:
    """Return a number in a disc."""
    disc = (
        f'<circle class="badge" cx="{_number(centre[0])}" cy="{_number(centre[1])}" '
        f'r="{_RADIUS:g}"/>'
    )
    return disc + _text("number", (centre[0], centre[1] + 4.2), str(count))


def _path(look: str, data: str) -> str:
    """Return lines with the look of a class."""
    return f'<path class="{look}" d="{data}"/>'
