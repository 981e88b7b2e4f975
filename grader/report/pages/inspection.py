"""A URDF as one HTML page: its problems, its tree, its poses, and the robot in 3-D."""

from itertools import islice

from grader import __version__
from grader.drawing.picture import plain_picture
from grader.report.content import problem_line
from grader.report.inspection import Inspection, effect, tree
from grader.report.locations import source_lines
from grader.report.pages.robot import render_robot_page
from grader.text import first_lines, printable

_MAX_SHOWN = 500  # links of the tree, and problems
_CLASSES = {"clean": "passed", "degraded": "skipped"}  # of verdicts


def inspection_html(inspection: Inspection) -> str:
    """Return the inspection as an HTML page, with the joints at the given positions."""
    reading, robot = inspection.reading, inspection.robot
    sources = {reading.source.path: reading.source}
    lines = (f"{indent}{link}  {joint}" for indent, link, joint in (tree(robot) if robot is not None else ()))
    values = {
        "version": __version__,
        "title": printable(robot.robot.name if robot is not None else inspection.path),
        "path": inspection.path,
        "effect": effect(reading),
        "verdict": _CLASSES.get(reading.verdict if reading.is_decided else "", "failed"),
        "problems": [
            (problem.severity, problem_line(problem), source_lines(problem.location, sources.get))
            for problem in reading.problems[:_MAX_SHOWN]
        ],
        "tree": first_lines([*islice(lines, _MAX_SHOWN + 1)], _MAX_SHOWN),
    }
    return render_robot_page("inspection.html", values, plain_picture(robot, inspection.relative_to), {})
