"""A URDF as one HTML page: its problems, its tree, its poses, and the robot in 3-D."""

from itertools import islice

from grader import __version__
from grader.drawing.picture import plain_picture
from grader.report.content import problem_line
from grader.report.inspection import Inspection, effect, tree
from grader.report.pages.criteria import SourceLines, source_lines
from grader.report.pages.robot import RULES, SCRIPTS, STYLE, robot_view, views
from grader.report.pages.shell import render_page
from grader.text import first_lines, printable

_MAX_SHOWN = 500  # links of the tree, and problems


def inspection_html(inspection: Inspection) -> str:
    """Return the inspection as an HTML page, with the joints at the given positions."""
    reading, robot = inspection.reading, inspection.robot
    picture = plain_picture(robot, inspection.relative_to)
    view = robot_view(picture) if picture is not None else None
    values = {
        "version": __version__,
        "title": printable(robot.robot.name if robot is not None else inspection.path),
        "path": inspection.path,
        "effect": effect(reading),
        "verdict": {"clean": "passed", "degraded": "skipped"}.get(
            reading.verdict if reading.is_decided else "", "failed"
        ),
        "problems": _problems(inspection),
        "tree": first_lines([*islice(map("  ".join, _lines(inspection)), _MAX_SHOWN + 1)], _MAX_SHOWN),
        "robot": view,
        "views": views(picture) if picture is not None else "",
    }
    data, scripts = (view.data, SCRIPTS) if view is not None else ({}, "")
    return render_page("inspection.html", values, data, f"{STYLE} student.css", scripts, rules=RULES)


def _problems(inspection: Inspection) -> list[tuple[str, str, SourceLines | None]]:
    """Return the severity, the words and the source of each problem."""
    source = inspection.reading.source
    return [
        (
            problem.severity,
            problem_line(problem),
            source_lines(source, problem.location) if problem.location.path == source.path else None,
        )
        for problem in inspection.reading.problems[:_MAX_SHOWN]
    ]


def _lines(inspection: Inspection) -> list[tuple[str, str]]:
    found = tree(inspection.robot) if inspection.robot is not None else ()
    return [(f"{indent}{link}", joint) for indent, link, joint in found]
