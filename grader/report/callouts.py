"""What a picture shows, in words: for screen readers, and where a picture cannot be seen."""

from grader.drawing.picture import Callout, Picture, picture_of
from grader.grading.report import Report
from grader.report.content import points_of
from grader.text import enumerated, printable

_NOWHERE = "not in the picture"


def drawn(report: Report) -> str:
    """Return in words what the drawing of a report shows; empty if there is no robot."""
    picture = picture_of(report)
    return f"Top, side and front view of the robot. {description(picture)}".strip() if picture is not None else ""


def heading(callout: Callout) -> str:
    """Return the link of a callout, the points that its criteria cost, and whether it has no place in the picture."""
    words = f"{callout.link or 'The robot'}: {points_of(callout.results)} lost"
    return words if callout.point is not None else f"{words} ({_NOWHERE})"


def description(picture: Picture) -> str:
    """Return in words what a picture calls out and what it does not show."""
    called = [
        f"{callout.number}: {heading(callout)}, {enumerated([result.criterion.id for result in callout.results])}."
        for callout in picture.callouts
    ]
    return printable(" ".join((*called, *picture.scene.missing)))
