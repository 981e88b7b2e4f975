"""The drawing of a graded robot as an SVG file."""

from grader.base.text import printable
from grader.lab.grading.report import Report
from grader.report.content import bonus_line, grade_line, notes, score_text, verdict_line
from grader.report.criteria import remarks_on
from grader.report.drawing.graded_picture import draw_report
from grader.report.drawing.three_views import NO_PICTURE, drawing_file


def render_svg(report: Report) -> str:
    """Return the drawing of the graded robot as a file.

    Without a robot, it shows a sentence with the reason.
    """
    words = [grade_line(report), verdict_line(report), bonus_line(report)]
    if report.another_robot:
        words += notes(report)[:1]
    for result in report.results:
        words += [f"{printable(result.id)}: {remark}" for remark in remarks_on(result)]
    return drawing_file(
        draw_report(report), f"{report.rubric.title}: {score_text(report)}", words, NO_PICTURE
    )
