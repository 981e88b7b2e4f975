"""The words of a drawing: the key of its signs with the scale bar, and the criteria that it calls out."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from grader.drawing.picture import Callout, Picture
from grader.drawing.sheet import WIDTH, Place, Sheet
from grader.report.content import points_of
from grader.report.drawing_signs import put_badge, put_wheel
from grader.report.svg_elements import put, segments, wrapped
from grader.text import enumerated, printable

_ROW = 18.0
_LINE = 15.0
_SIGN = 34.0  # pixels left of the text of a row
_LEFT = 14.0
_NOWHERE = "not in the picture"
_Sign = Callable[[Any, Place], None]


def put_key(group: Any, sheet: Sheet, picture: Picture) -> None:
    """Add the scale bar, and each sign that the drawing has with its meaning."""
    left, top = sheet.key[0] + 8.0, sheet.key[1] + 20.0
    length, text = sheet.bar
    bar = [((left, top), (left + length, top)), *(((x, top - 4.0), (x, top + 4.0)) for x in (left, left + length))]
    put(group, "path", "ground", {"d": segments(bar)})
    put(group, "text", "text", {"x": left + length + 8.0, "y": top + 4.0}, text)
    for row, (sign, meaning) in enumerate(_signs(picture), 1):
        y = top + 6.0 + row * _ROW
        sign(group, (left, y))
        put(group, "text", "faint", {"x": left + _SIGN, "y": y + 4.0, "font-size": 11}, meaning)


def _signs(picture: Picture) -> Iterator[tuple[_Sign, str]]:
    if any(callout.point is not None for callout in picture.callouts):
        yield lambda group, at: put_badge(group, (at[0] + 12.0, at[1]), 1), "points lost: see below"
    if picture.outlines or picture.frames:
        yield partial(_put_line, "reference"), "reference solution"
    if any(wheel.travel is not None for wheel in picture.scene.wheels):
        yield lambda group, at: put_wheel(group, (at[0] - 3.0, at[1]), (1.0, 0.0, 0.0)), "a positive turn drives so"
    if any(wheel.travel is None for wheel in picture.scene.wheels):
        yield lambda group, at: put_wheel(group, (at[0] + 12.0, at[1]), None), "does not roll when turned"
    if picture.scene.poses:
        yield _put_axes, "frame of a link: x, y, z"
    if len(picture.scene.bodies) > 1:
        yield partial(_put_line, "edge"), "hidden edge"


def _put_line(look: str, group: Any, at: Place) -> None:
    line = put(group, "path", look, {"d": segments([(at, (at[0] + 26.0, at[1]))])})
    if look == "edge":
        line.set("stroke-opacity", "0.4")


def _put_axes(group: Any, at: Place) -> None:
    x, y = at[0] + 6.0, at[1] + 5.0
    put(group, "path", "axis-x", {"d": segments([((x, y), (x + 14.0, y))])})
    put(group, "path", "axis-z", {"d": segments([((x, y), (x, y - 14.0))])})
    put(group, "circle", "axis-y", {"cx": x, "cy": y, "r": 2.5})


def put_legend(group: Any, top: float, picture: Picture) -> float:
    """Add the criteria that are called out and what is not shown, below `top`; return where they end, in pixels."""
    y = top + 8.0
    if picture.callouts or picture.scene.missing:
        put(group, "path", "rule", {"d": segments([((_LEFT, y), (WIDTH - _LEFT, y))])})
        y += 20.0
    for callout in picture.callouts:
        y = _put_callout(group, y, callout)
    for sentence in picture.scene.missing:
        y = _put_lines(group, "faint", y, sentence)
    return y + 4.0


def _put_callout(group: Any, y: float, callout: Callout) -> float:
    put_badge(group, (_LEFT + 9.0, y - 4.0), callout.number)
    y = _put_lines(group, "strong", y, heading(callout))
    for result in callout.results:
        y = _put_lines(group, "text", y, f"{result.criterion.id}: {result.outcome.message}")
    return y + 6.0


def heading(callout: Callout) -> str:
    """Return the link of a callout, the points that its criteria cost, and whether it has no place in the picture."""
    words = f"{callout.link or 'The robot'}: {points_of(callout.results)} lost"
    return words if callout.point is not None else f"{words} ({_NOWHERE})"


def _put_lines(group: Any, look: str, y: float, text: str) -> float:
    left = _LEFT + 26.0
    for line in wrapped(text, WIDTH - left - _LEFT):
        put(group, "text", look, {"x": left, "y": y}, line)
        y += _LINE
    return y


def description(picture: Picture) -> str:
    """Return in words what a picture calls out and what it does not show."""
    called = [
        f"{callout.number}: {heading(callout)}, {enumerated([result.criterion.id for result in callout.results])}."
        for callout in picture.callouts
    ]
    return printable(" ".join((*called, *picture.scene.missing)))
