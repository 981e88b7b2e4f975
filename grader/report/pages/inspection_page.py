"""The page of an inspection."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from grader import __version__
from grader.base.problems import Problem
from grader.base.source import SourceOf
from grader.base.text import printable
from grader.report.drawing.picture import plain_picture
from grader.report.inspection import (
    MAX_LISTED,
    NO_FAILURE,
    Inspection,
    choose_look,
    effect,
    lists,
    log_line,
    robot_line,
)
from grader.report.locations import source_lines
from grader.report.pages.robot_page import render_robot_page
from grader.report.pages.shell import Assets
from grader.report.pages.viewing import LogCard, ProblemCard, Viewing
from grader.report.readings import problem_line

if TYPE_CHECKING:
    from grader.workspace.api import LogAnswer

_CLASSES = {"clean": "passed", "degraded": "skipped"}  # of verdicts


def inspection_html(inspection: Inspection, viewing: Viewing | None = None) -> str:
    """Return the inspection as an HTML page, with the joints at the given positions.

    With `viewing`, it is that of `grader view`.
    """
    robot = inspection.robot
    configuration = robot.configuration if robot else None
    path = robot.path if robot else inspection.path
    lines = [(each.path, f": {robot_line(each)}") for each in inspection.robots]
    values = {
        "version": __version__,
        "title": printable(configuration.robot.name if configuration is not None else path),
        "path": path,
        "effect": effect(inspection),
        "extent": inspection.extent.words if inspection.extent else "",
        "verdict": _CLASSES.get(choose_look(inspection), "failed"),
        "problems": [
            problem_card(problem, inspection.source) for problem in inspection.problems[:MAX_LISTED]
        ],
        "lists": [("Robots", lines)] if not robot and lines else lists(robot),
    }
    if robot:
        picture = plain_picture(configuration, robot.relative_to, robot.meshes, robot.wheels)
    else:
        picture = plain_picture(configuration, None, None, ())
    return render_robot_page("inspection.html", values, picture, Assets(), {}, viewing)


def log_cards(answers: "Iterable[LogAnswer]", source_of: SourceOf) -> list[LogCard]:
    """Return what is said of the messages of a log, what the files explain first."""
    cards = []
    for answer in answers:
        at = answer.location
        lines = source_lines(at, source_of) if at else ()
        cards.append(LogCard(log_line(answer), at is not None, lines))
    return cards or [LogCard(NO_FAILURE, is_explained=False)]


def problem_card(problem: Problem, source_of: SourceOf) -> ProblemCard:
    """Return a problem with its line, and its place in the source."""
    line = problem_line(problem)
    return ProblemCard(problem.severity, line, source_lines(problem.location, source_of))
