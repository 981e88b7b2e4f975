"""Pages about a robot: three views of it, and what `grader inspect` shows."""

from collections.abc import Mapping

from markupsafe import Markup

from grader import __version__
from grader.drawing.picture import Picture, plain_picture
from grader.report.content import problem_line
from grader.report.drawing import drawing_element
from grader.report.inspection import MAX_LISTED, Inspection, effect, lists
from grader.report.locations import source_lines
from grader.report.pages.shell import Assets, render_page
from grader.report.signs import STYLE
from grader.text import printable

_CLASSES = {"clean": "passed", "degraded": "skipped"}  # of verdicts


def render_robot_page(template: str, values: Mapping[str, object], picture: Picture | None, script: str = "") -> str:
    """Return a page about the robot of a picture, if there is one."""
    drawn = drawing_element(picture, legend=False) if picture is not None else ""
    views = Markup(drawn)  # noqa: S704  an element, whose text is escaped
    assets = Assets("robot.css student.css", script, STYLE if drawn else "")
    return render_page(template, {**values, "picture": picture, "views": views}, {}, assets)


def inspection_html(inspection: Inspection) -> str:
    """Return the inspection as an HTML page, with the joints at the given positions."""
    reading, robot = inspection.reading, inspection.robot
    sources = {reading.source.path: reading.source}
    values = {
        "version": __version__,
        "title": printable(robot.robot.name if robot is not None else inspection.path),
        "path": inspection.path,
        "effect": effect(inspection),
        "verdict": _CLASSES.get(inspection.verdict, "failed"),
        "problems": [
            (problem.severity, problem_line(problem), source_lines(problem.location, sources.get))
            for problem in reading.problems[:MAX_LISTED]
        ],
        "lists": lists(inspection),
    }
    return render_robot_page("inspection.html", values, plain_picture(robot, inspection.relative_to))
