"""The description of a picture in words, for screen readers and where a picture is not visible."""

from grader.drawing.picture import Callout, Picture, picture_of
from grader.grading.report import Report
from grader.report.content import points_of
from grader.text import enumerated, printable

_NOWHERE = "not in the picture"


def drawn(report: Report) -> str:
    """Return a description of the drawing of a report; empty if there is no robot."""
    picture = picture_of(report)
    return f"Top, side and front view of the robot. {description(picture)}".strip() if picture is not None else ""


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
