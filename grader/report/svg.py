"""A report as a picture: SVG with the three views of the graded robot, and the criteria that failed where they did."""

from collections.abc import Sequence
from typing import Any

from lxml import etree

from grader.drawing.picture import Picture, picture_of
from grader.drawing.scene import scene_of
from grader.drawing.sheet import WIDTH
from grader.grading.report import Report
from grader.report.content import score_text, summary
from grader.report.drawing import drawing_element, empty_element
from grader.report.inspection import Inspection
from grader.report.svg_elements import DARK_RULES, SVG, put, wrapped

_STYLE = f"svg{{max-width:100%;height:auto}}@media screen and (prefers-color-scheme:dark){{{DARK_RULES}}}"
_LEFT, _TITLE, _LINE = 14.0, 28.0, 15.0


def render_svg(report: Report) -> str:
    """Return the drawing of the graded robot as a file; without a robot it says why in a line."""
    submission = report.submission
    reason = "No picture: no robot could be read from the submission."
    if submission.has_urdf and submission.robot is not None and submission.robot.links:
        reason = "No picture: no link of the robot has a place."
    return _file(picture_of(report), f"{report.rubric.title}: {score_text(report)}", summary(report), reason)


def inspection_svg(inspection: Inspection) -> str:
    """Return the drawing of an inspected robot as a file, with its joints at the given positions."""
    robot = inspection.robot
    picture = None
    if robot is not None and inspection.relative_to is not None:
        picture = Picture(scene_of(robot, inspection.relative_to), None, (), (), ())
    name = robot.robot.name if robot is not None else inspection.path
    positions = ", ".join(f"{joint} = {position}" for joint, position in robot.positions.items()) if robot else ""
    words = f"{inspection.path}{f'; {positions}' if positions else ''}"
    return _file(picture, name or inspection.path, words, "No picture: no robot could be read from the file.")


def _file(picture: Picture | None, title: str, words: str, reason: str) -> str:
    lines = wrapped(words, WIDTH - 2.0 * _LEFT)
    top = _TITLE + _LINE * len(lines) + 8.0
    if picture is not None:
        root = drawing_element(picture, title, top)
    else:
        root = empty_element(title, reason, top + 2.0 * _LINE)
        lines.append(reason)
    _add_heading(root, title, lines)
    style = etree.Element(f"{{{SVG}}}style")
    style.text = _STYLE
    root.insert(1, style)
    return etree.tostring(root, encoding="unicode") + "\n"


def _add_heading(root: Any, title: str, lines: Sequence[str]) -> None:
    group = put(root, "g")
    put(group, "text", "title", {"x": _LEFT, "y": _TITLE - 2.0}, next(iter(wrapped(title, WIDTH / 1.45, 1)), ""))
    for number, line in enumerate(lines, 1):
        put(group, "text", "faint", {"x": _LEFT, "y": _TITLE + _LINE * number}, line)
