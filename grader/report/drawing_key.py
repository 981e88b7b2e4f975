"""The words of a drawing: the key of its signs, the failed criteria, a description for screen readers."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

from grader.drawing.picture import Callout, Picture, picture_of
from grader.drawing.sheet import WIDTH, Place, Sheet
from grader.grading.report import Report
from grader.report.drawing_signs import Signs, lifted_ground, wheel_sign
from grader.report.order import points_of
from grader.report.svg_elements import circle, put, put_lines, segments
from grader.robot.transforms import Vector
from grader.submission.urdf import Absent
from grader.text import counted_points, enumerated, printable

_NOWHERE = "not in the picture"


def alt_text(report: Report) -> str:
    """Return a description of the drawing of a report; empty if there is no robot."""
    picture = picture_of(report)
    return f"Top, side and front view of the robot. {description(picture)}".strip() if picture is not None else ""


def why_no_picture(report: Report) -> str:
    """Return why a report has no picture of the robot."""
    submission = report.submission
    urdf = submission.originals.urdf if submission.originals is not None else Absent()
    if submission.has_urdf and isinstance(urdf, Absent):
        return "No picture: the submission has changed or moved since it was graded."
    if submission.robot is None or not submission.robot.links:
        return "No picture: no robot could be read from the submission."
    return "No picture: no link of the robot has a pose."


def heading(callout: Callout) -> str:
    """Return the link of a callout, the lost points, and a remark if it is not in the picture."""
    words = f"{callout.link or 'The robot'}: {points_of(callout.results)} lost"
    return words if callout.point is not None else f"{words} ({_NOWHERE})"


def description(picture: Picture) -> str:
    """Return a description of the callouts of a picture, and of what it does not show."""
    called = [
        f"{callout.number}: {heading(callout)}, {enumerated([result.criterion.id for result in callout.results])}."
        for callout in picture.callouts
    ]
    return printable(" ".join((*called, *picture.scene.missing)))


_ROW = 18.0
_SIGN = 34.0  # pixels left of the text of a row
_LEFT = 14.0
_INDENT = 26.0
_Draw = Callable[[Signs, Place], None]


def put_key(group: Any, sheet: Sheet, picture: Picture, *, legend: bool) -> None:
    """Add the scale bar, and the meaning of each sign; with a `legend` the criteria are listed below it."""
    left, top = sheet.key[0] + 8.0, sheet.key[1] + 20.0
    signs = Signs()
    length, words = sheet.bar
    ends = (((x, top - 4.0), (x, top + 4.0)) for x in (left, left + length))
    signs.line("ground", segments([((left, top), (left + length, top)), *ends]))
    signs.text("text", (left + length + 8.0, top + 4.0), words)
    for row, (draw, meaning) in enumerate(_meanings(picture, legend=legend), 1):
        place = left, top + 6.0 + row * _ROW
        draw(signs, place)
        signs.text("faint", (left + _SIGN, place[1] + 4.0), meaning)
    signs.put(group)


def _meanings(picture: Picture, *, legend: bool) -> Iterator[tuple[_Draw, str]]:
    """Yield the signs of a drawing with their meanings."""
    travels = [wheel.travel is not None for wheel in picture.scene.wheels]
    if any(callout.point is not None for callout in picture.callouts):
        yield lambda signs, at: signs.badge((at[0] + 12.0, at[1]), 1), f"points lost{': see below' if legend else ''}"
    if picture.outlines or picture.frames or lifted_ground(picture) is not None:
        yield partial(_draw_line, "reference"), "reference solution"
    if any(travels):
        yield partial(_draw_wheel, -3.0, (1.0, 0.0, 0.0)), "driving direction, positive turn"
    if not all(travels):
        yield partial(_draw_wheel, 12.0, None), "wheel does not roll"
    yield _draw_axes, "frame of a link: x, y, z"
    if len(picture.scene.bodies) > 1:
        yield partial(_draw_line, "hidden"), "hidden edge"


def _draw_wheel(left: float, travel: Vector | None, signs: Signs, at: Place) -> None:
    signs.line("arrow", wheel_sign((at[0] + left, at[1]), travel))


def _draw_line(look: str, signs: Signs, at: Place) -> None:
    signs.line(look, segments([(at, (at[0] + 26.0, at[1]))]))


def _draw_axes(signs: Signs, at: Place) -> None:
    x, y = at[0] + 6.0, at[1] + 5.0
    signs.line("axis-x", segments([((x, y), (x + 14.0, y))]))
    signs.line("axis-z", segments([((x, y), (x, y - 14.0))]))
    signs.line("axis-y", circle((x, y), 2.5))


def put_legend(root: Any, top: float, callouts: Sequence[Callout], notes: Sequence[str]) -> float:
    """Add the failed criteria of each callout, and notes, below `top`; return where they end, in pixels."""
    if not callouts and not notes:
        return top
    put(root, "path", "rule", {"d": segments([((_LEFT, top + 8.0), (WIDTH - _LEFT, top + 8.0))])})
    badges, strong, plain = Signs(), put(root, "g", "strong"), put(root, "g", "text")
    left, width, y = _LEFT + _INDENT, WIDTH - 2.0 * _LEFT - _INDENT, top + 28.0
    for callout in callouts:
        badges.badge((_LEFT + 9.0, y - 4.0), callout.number)
        y = put_lines(strong, left, y, width, heading(callout))
        for result in callout.results:
            criterion = result.criterion
            words = f"{criterion.id} ({counted_points(criterion.points)}): {result.outcome.message}"
            y = put_lines(plain, left, y, width, words)
        y += 6.0
    for sentence in notes:
        y = put_lines(plain, left, y, width, sentence)
    badges.put(root)
    return y + 2.0
