"""The page of a report for the student, with three views of the robot."""

from base64 import b64encode
from collections.abc import Mapping, Sequence
from itertools import groupby

from grader.base.text import format_points, printable
from grader.lab.checks.registry import GRAPH_CHECKS
from grader.lab.documents.pictures import PDF, EmbeddedPicture
from grader.lab.grading.criterion_pictures import find_pictures, may_have_pictures
from grader.lab.grading.report import Report
from grader.report import content
from grader.report.content import report_sections
from grader.report.criteria import (
    CriteriaGroup,
    Entry,
    alike,
    earned_text,
    groups,
    is_manual,
    name_status,
)
from grader.report.drawing.graded_picture import draw_report
from grader.report.drawing.three_views import NO_PICTURE
from grader.report.locations import diff_lines, location_text, source_lines
from grader.report.pages.graph_page import GraphDrawing, fitting_drawing
from grader.report.pages.robot_page import render_robot_page
from grader.report.pages.shell import Assets
from grader.report.pages.viewing import Viewing
from grader.report.statuses import STATUS_WORDS, SYMBOLS
from grader.workspace.api import launch_files, launch_graph

_MAX_PICTURES = 6 * 1024 * 1024  # bytes on a page


def render_html(report: Report, viewing: Viewing | None = None) -> str:
    """Return the report as a page, of `grader view` with `viewing`.

    Model answers are on it only if the rubric was loaded with them.
    """
    picture = draw_report(report) if not report.is_bare else None
    numbers = {}  # of the callouts in the picture, by criterion
    for callout in picture.callouts if picture else ():
        if callout.point is not None:
            numbers.update(dict.fromkeys(callout.names, callout.number))
    described = report_sections(report)
    sections = list(described.sections)
    entries = [entry for section in sections for entry in section.entries]
    cards = {}
    for entry in entries:
        for result in entry.results:
            cards[result.id] = entry.id
    head = {
        role: [line.text for line in lines]
        for role, lines in alike(content.head(report, described), lambda line: line.role)
    }
    maximum = ""
    if report.counting is not None:
        maximum = format_points(report.max_score)
    what = report.student or content.graded_line(report)
    values = {
        "version": report.version,
        "title": printable(f"{what}: {content.score_text(report)}"),
        "report": report,
        "content": content,
        "head": head,
        "maximum": maximum,
        "symbols": SYMBOLS,
        "status_words": STATUS_WORDS,
        "status_of": name_status,
        "earned_text": earned_text,
        "location_text": location_text,
        "diff_lines": diff_lines,
        "source_lines": source_lines,
        "kind_of": lambda block: type(block).__name__,
        "called": numbers,
        "sections": sections,
        "next_command": content.next_command(report, described),
        "cards": cards,
        "parts": _part_cards(report) if not report.is_bare else [],
        "pictures": _pictures(report, entries),
        "no_picture": NO_PICTURE,
    }
    graph_of, graph = _choose_graph(report)
    values |= {"graph": graph, "graph_of": graph_of}
    styles = "graph.css" if graph else ""
    assets = Assets(styles=styles, scripts="student.js", sources="img-src data:")
    return render_robot_page("student.html", values, picture, assets, cards, viewing)


def _pictures(report: Report, entries: Sequence[Entry]) -> Mapping[str, list[tuple[str, str]]]:
    """Return the pictures of criteria that need manual grading.

    Each is where it is and its data as an address.
    """
    shown: dict[str, list[tuple[str, str]]] = {}
    room = _MAX_PICTURES
    for entry in entries:
        if not is_manual(entry.result) or not may_have_pictures(entry.result):
            continue
        for picture in find_pictures(entry.result, report.submission):
            if not isinstance(picture, EmbeddedPicture) or picture.kind is PDF:
                continue
            if len(picture.data) <= room:
                room -= len(picture.data)
                data = b64encode(picture.data).decode()
                address = f"data:{picture.kind.media_type};base64,{data}"
                shown.setdefault(entry.id, []).append((picture.where, address))
    return shown


def _choose_graph(report: Report) -> tuple[str, GraphDrawing | None]:
    """Return the launch file whose graph criteria ask about, and the drawing of that; or none."""
    asking = [
        each.criterion for each in report.results if each.criterion.check.name in GRAPH_CHECKS
    ]
    if report.is_bare or not asking or not report.submission.packages:
        return "", None
    launches = launch_files(report.submission.workspace)
    named = [f"/{criterion.arguments.get('launch')}" for criterion in asking]
    asked = [path for path in launches if f"/{path}".endswith(tuple(named))]
    path = next(iter(asked + launches), "")
    if not path:
        return "", None
    return path, fitting_drawing(launch_graph(report.submission.workspace, path))


def _part_cards(report: Report) -> list[tuple[str, str, list[CriteriaGroup]]]:
    """Return each part with its title, its points and its groups."""
    cards = []
    for part, part_groups in groupby(groups(report), key=lambda group: group.part):
        members = list(part_groups)
        results = [result for group in members for result in group.results]
        cards.append((report.rubric.part(part).title, earned_text(*results), members))
    return cards
