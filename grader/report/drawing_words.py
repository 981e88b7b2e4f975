"""The words of a drawing: the heading of a callout, and what is said instead of a picture or for screen readers."""

from grader.drawing.picture import Callout, Picture, picture_of
from grader.grading.report import Report
from grader.report.criteria import points_of
from grader.submission.urdf import Absent
from grader.text import enumerated, printable


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
    return words if callout.point is not None else f"{words} (not in the picture)"


def description(picture: Picture) -> str:
    """Return a description of the callouts of a picture, and of what it does not show."""
    called = [
        f"{callout.number}: {heading(callout)}, {enumerated([result.criterion.id for result in callout.results])}."
        for callout in picture.callouts
    ]
    return printable(" ".join((*called, *picture.scene.missing)))
