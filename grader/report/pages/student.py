"""The pages about one robot: the report for the student, with three views of the robot, and an
inspection.
"""

from base64 import b64encode
from collections.abc import Callable, Mapping, Sequence
from itertools import groupby
from typing import Any

from markupsafe import Markup

from grader import __version__
from grader.base.problems import Problem
from grader.base.source import Source
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
from grader.report.drawing.space import space_data
from grader.report.inspection import (
    MAX_LISTED,
    Inspection,
    effect,
    lists,
    look_of,
    robot_line,
)
from grader.report.locations import diff_lines, location_text, source_lines
from grader.report.pages.shell import SPACE_SCRIPTS, Assets, render_page
from grader.report.pages.viewing import SCRIPT, SOURCES, STYLES, ProblemCard, Viewing
from grader.report.writers.svg import NO_PICTURE, STYLE, callout_lines, drawing_element
from grader.ros.urdf.model import Mesh

_MAX_PICTURES = 6 * 1024 * 1024  # bytes on a page
_CLASSES = {"clean": "passed", "degraded": "skipped"}  # of verdicts


def render_html(report: Report, viewing: Viewing | None = None) -> str:
    """Return the report as a page, of `grader view` with `viewing`. Model answers are on it only if
    the rubric was loaded with them.
    """
    picture = picture_of(report) if not report.is_bare else None
    numbers = {}  # of the callouts in the picture, by criterion
    for callout in picture.callouts if picture is not None else ():
        if callout.point is not None:
            for result in callout.results:
                numbers[result.criterion.id] = callout.number
    sections = list(report_sections(report).sections)
    entries = [entry for section in sections for entry in section.entries]
    cards = {}
    for entry in entries:
        for result in entry.results:
            cards[result.criterion.id] = entry.id
    head = {
        role: [line.text for line in lines]
        for role, lines in alike(content.head(report), lambda line: line.role)
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
        "status_of": status_of,
        "earned_text": earned_text,
        "location_text": location_text,
        "diff_lines": diff_lines,
        "source_lines": source_lines,
        "kind_of": lambda block: type(block).__name__,
        "called": numbers,
        "sections": sections,
        "cards": cards,
        "parts": _part_cards(report) if not report.is_bare else [],
        "pictures": _pictures(report, entries),
        "no_picture": NO_PICTURE,
    }
    assets = Assets(scripts="student.js", sources="img-src data:")
    return _render("student.html", values, picture, assets, cards, viewing)


def _pictures(report: Report, entries: Sequence[Entry]) -> Mapping[str, list[tuple[str, str]]]:
    """Return the pictures of criteria that need manual grading, each as where it is and its data as
    an address.
    """
    shown: dict[str, list[tuple[str, str]]] = {}
    room = _MAX_PICTURES
    for entry in entries:
        if not is_manual(entry.result) or not may_have_pictures(entry.result):
            continue
        for picture in pictures_of(entry.result, report.submission):
            if not isinstance(picture, EmbeddedPicture) or picture.kind is PDF:
                continue
            if len(picture.data) <= room:
                room -= len(picture.data)
                data = b64encode(picture.data).decode()
                address = f"data:{picture.kind.media_type};base64,{data}"
                shown.setdefault(entry.id, []).append((picture.where, address))
    return shown


def _part_cards(report: Report) -> list[tuple[str, str, list[CriteriaGroup]]]:
    """Return each part with its title, its points and its groups."""
    cards = []
    for part, part_groups in groupby(groups(report), key=lambda group: group.part):
        members = list(part_groups)
        results = [result for group in members for result in group.results]
        cards.append((report.rubric.part(part).title, earned_text(*results), members))
    return cards


def inspection_html(inspection: Inspection, viewing: Viewing | None = None) -> str:
    """Return the inspection as an HTML page, with the joints at the given positions; of `grader
    view` with `viewing`.
    """
    robot = inspection.robot
    configuration = robot.configuration if robot is not None else None
    path = robot.path if robot is not None else inspection.path
    lines = [(each.path, f": {robot_line(each)}") for each in inspection.robots]
    values = {
        "version": __version__,
        "title": printable(configuration.robot.name if configuration is not None else path),
        "path": path,
        "effect": effect(inspection),
        "extent": inspection.extent.words if inspection.extent is not None else "",
        "verdict": _CLASSES.get(look_of(inspection), "failed"),
        "problems": [
            problem_card(problem, inspection.source) for problem in inspection.problems[:MAX_LISTED]
        ],
        "lists": [("Robots", lines)] if robot is None and lines else lists(robot),
    }
    relative_to = robot.relative_to if robot is not None else None
    meshes = robot.meshes if robot is not None else None
    wheels = robot.wheels if robot is not None else ()
    picture = plain_picture(configuration, relative_to, meshes, wheels)
    return _render("inspection.html", values, picture, Assets(), {}, viewing)


def problem_card(problem: Problem, source_of: Callable[[str], Source | None]) -> ProblemCard:
    """Return a problem with its line, and its place in the source."""
    line = content.problem_line(problem)
    return ProblemCard(problem.severity, line, source_lines(problem.location, source_of))


def _render(
    template: str,
    values: Mapping[str, object],
    picture: Picture | None,
    assets: Assets,
    cards: Mapping[str, str],
    viewing: Viewing | None,
) -> str:
    """Return a page about the robot of a picture, if there is one; `cards` are the entries of its
    criteria.
    """
    drawn = drawing_element(picture, legend=False) if picture is not None else ""
    views = Markup(drawn)  # noqa: S704  an element, whose text is escaped
    meshes: Mapping[Mesh, str] = {}
    if picture is not None and viewing is not None:
        picture, meshes = viewing.with_meshes(picture)
    space = space_data(picture, cards, meshes) if picture is not None else None
    legend = callout_lines(picture) if picture is not None else []
    shown = {"picture": picture, "views": views, "legend": legend, "has_space": space is not None}
    data: dict[str, Any] = {"robot": space} if space is not None else {}
    scripts, styles, rules = assets.scripts, "text.css robot.css student.css", STYLE
    if viewing is not None:  # the same for each version: the policy of a page stays
        scripts, styles = f"{scripts} {SPACE_SCRIPTS} {SCRIPT}", f"{styles} {STYLES}"
        assets = assets._replace(sources=SOURCES)
        data["view"] = viewing.data
    elif space is not None:
        scripts = f"{scripts} {SPACE_SCRIPTS}"
    if not drawn and viewing is None:
        rules = ""
    assets = assets._replace(scripts=scripts, styles=styles, rules=rules)
    return render_page(template, {**values, **shown, "viewing": viewing}, data, assets)
