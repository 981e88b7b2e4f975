"""The pages about one robot: the report for the student, with three views of the robot, and an
inspection.
"""

from base64 import b64encode
from collections.abc import Mapping, Sequence
from itertools import groupby

from markupsafe import Markup

from grader import __version__
from grader.base.text import format_points, printable
from grader.lab.documents.pictures import PDF, EmbeddedPicture
from grader.lab.grading.criterion_pictures import may_have_pictures, pictures_of
from grader.lab.grading.report import Report
from grader.report import content
from grader.report.content import report_sections
from grader.report.criteria import (
    STATUS_WORDS,
    SYMBOLS,
    CriteriaGroup,
    Entry,
    alike,
    earned_text,
    groups,
    is_manual,
    status_of,
)
from grader.report.drawing.picture import Picture, picture_of, plain_picture
from grader.report.inspection import MAX_LISTED, Inspection, effect, lists
from grader.report.locations import diff_lines, location_text, source_lines
from grader.report.pages.shell import Assets, render_page
from grader.report.writers.svg import NO_PICTURE, STYLE, callout_lines, drawing_element

_MAX_PICTURES = 6 * 1024 * 1024  # bytes on a page
_CLASSES = {"clean": "passed", "degraded": "skipped"}  # of verdicts


def render_html(report: Report) -> str:
    """Return the report as a page. Model answers are on it only if the rubric was loaded with
    them.
    """
    picture = picture_of(report) if not report.is_bare else None
    if picture is not None:
        callouts = [callout for callout in picture.callouts if callout.point is not None]
    else:
        callouts = []
    called = {
        result.criterion.id: callout.number for callout in callouts for result in callout.results
    }
    sections = [*report_sections(report).sections]
    by_part = groupby(groups(report) if not report.is_bare else (), key=lambda group: group.part)
    values = {
        "version": report.version,
        "title": printable(
            f"{report.student or content.graded_line(report)}: {content.score_text(report)}"
        ),
        "report": report,
        "content": content,
        "head": {
            role: [line.text for line in some]
            for role, some in alike(content.head(report), lambda it: it.role)
        },
        "maximum": format_points(report.max_score) if report.counting is not None else "",
        "symbols": SYMBOLS,
        "status_words": STATUS_WORDS,
        "status_of": status_of,
        "earned_text": earned_text,
        "location_text": location_text,
        "diff_lines": diff_lines,
        "source_lines": source_lines,
        "kind_of": lambda block: type(block).__name__,
        "called": called,
        "sections": sections,
        "cards": {
            one.criterion.id: entry.id
            for part in sections
            for entry in part.entries
            for one in entry.results
        },
        "parts": [_part_card(report.rubric.part(part).title, [*some]) for part, some in by_part],
        "pictures": _pictures(report, [entry for part in sections for entry in part.entries]),
        "no_picture": NO_PICTURE,
    }
    return _render("student.html", values, picture, "student.js", "img-src data:")


def _pictures(report: Report, entries: Sequence[Entry]) -> Mapping[str, list[tuple[str, str]]]:
    """Return the pictures of criteria that need manual grading, each as where it is and its data as
    an address.
    """
    shown: dict[str, list[tuple[str, str]]] = {}
    room = _MAX_PICTURES
    for entry in entries:
        if not is_manual(entry.result) or not may_have_pictures(entry.result):
            continue
        for one in pictures_of(entry.result, report.submission):
            if isinstance(one, EmbeddedPicture) and one.kind is not PDF and len(one.data) <= room:
                room -= len(one.data)
                address = f"data:{one.kind.media_type};base64,{b64encode(one.data).decode()}"
                shown.setdefault(entry.id, []).append((one.where, address))
    return shown


def _part_card(title: str, some: list[CriteriaGroup]) -> tuple[str, str, list[CriteriaGroup]]:
    return title, earned_text(*(result for group in some for result in group.results)), some


def inspection_html(inspection: Inspection) -> str:
    """Return the inspection as an HTML page, with the joints at the given positions."""
    robot = inspection.robot
    values = {
        "version": __version__,
        "title": printable(robot.robot.name if robot is not None else inspection.path),
        "path": inspection.path,
        "effect": effect(inspection),
        "verdict": _CLASSES.get(inspection.verdict or "clean", "failed"),
        "problems": [
            (
                problem.severity,
                content.problem_line(problem),
                source_lines(problem.location, inspection.source),
            )
            for problem in inspection.problems[:MAX_LISTED]
        ],
        "lists": lists(inspection),
    }
    return _render("inspection.html", values, plain_picture(robot, inspection.relative_to))


def _render(
    template: str,
    values: Mapping[str, object],
    picture: Picture | None,
    script: str = "",
    sources: str = "",
) -> str:
    """Return a page about the robot of a picture, if there is one."""
    drawn = drawing_element(picture, legend=False) if picture is not None else ""
    views = Markup(drawn)  # noqa: S704  an element, whose text is escaped
    assets = Assets("text.css robot.css student.css", script, STYLE if drawn else "", sources)
    legend = callout_lines(picture) if picture is not None else []
    return render_page(
        template, {**values, "picture": picture, "views": views, "legend": legend}, {}, assets
    )
