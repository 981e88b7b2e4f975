"""A report as an SVG: three views of the graded robot, with its failed criteria."""

from collections.abc import Iterable

from lxml import etree

from grader.drawing.picture import Picture, picture_of, plain_picture
from grader.drawing.sheet import WIDTH
from grader.grading.report import Report
from grader.report.content import bonus_line, grade_line, score_text, summary, why_no_picture
from grader.report.details import result_details
from grader.report.drawing import drawing_element, empty_element
from grader.report.inspection import Inspection, effect
from grader.report.svg_elements import DARK_RULES, SVG, put
from grader.report.svg_text import LINE, put_lines, wrapped
from grader.text import printable

_STYLE = f"svg{{max-width:100%;height:auto}}@media screen and (prefers-color-scheme:dark){{{DARK_RULES}}}"
_LEFT, _TITLE = 14.0, 28.0  # pixels
_WIDTH = WIDTH - 2.0 * _LEFT


def render_svg(report: Report) -> str:
    """Return the drawing of the graded robot as a file; without a robot, a sentence with the reason."""
    words = (grade_line(report), summary(report), bonus_line(report), *_remark_lines(report))
    return _file(picture_of(report), f"{report.rubric.title}: {score_text(report)}", words, why_no_picture(report))


def _remark_lines(report: Report) -> list[str]:
    """Return the adjustments and comments, a line for each."""
    lines: list[str] = []
    for result in report.results:
        details, name = result_details(result, report), printable(result.criterion.id)
        lines += [
            f"{name}: {text}" for text in (*(details.sentences if result.is_adjusted else ()), details.comment) if text
        ]
    return lines


def inspection_svg(inspection: Inspection) -> str:
    """Return the drawing of an inspected robot as a file, with its joints at the given positions."""
    robot = inspection.robot
    picture = plain_picture(robot, inspection.relative_to)
    name = robot.robot.name if robot is not None else inspection.path
    positions = ", ".join(f"{joint} = {position}" for joint, position in robot.positions.items()) if robot else ""
    words = f"{inspection.path}: {effect(inspection.reading)}{f'; {positions}' if positions else ''}"
    return _file(picture, name or inspection.path, (words,), "No picture: no robot could be read from the file.")


def _file(picture: Picture | None, title: str, words: Iterable[str], reason: str) -> str:
    lines = [line for text in filter(None, words) for line in wrapped(text, _WIDTH)]
    lines += [] if picture is not None else ["", *wrapped(reason, _WIDTH)]
    top = _TITLE + LINE * len(lines) + 8.0
    root = drawing_element(picture, title, top) if picture is not None else empty_element(title, reason, top)
    put_lines(put(root, "g", "title"), _LEFT, _TITLE - 2.0, _WIDTH / 1.5, title, 1)
    faint = put(root, "g", "faint")
    for number, line in enumerate(lines, 1):
        put(faint, "text", "", {"x": _LEFT, "y": _TITLE + LINE * number}, line)
    style = etree.Element(f"{{{SVG}}}style")
    style.text = _STYLE
    root.find(f"{{{SVG}}}rect").addprevious(style)
    return etree.tostring(root, encoding="unicode") + "\n"
