"""An inspection on a terminal. Text of files is never interpreted as markup or control codes."""

from collections.abc import Iterator

from rich.console import Console
from rich.text import Text

from grader.base.text import printable
from grader.report.inspection import (
    EFFECTS,
    Inspection,
    effect,
    lists,
    look_of,
    robot_line,
)
from grader.report.locations import calls_text
from grader.report.writers.terminal_page import INDENT, SEVERITY_LOOKS, Page, block, excerpt_block

_MAX_PROBLEMS = 30
_STYLES = dict(zip(EFFECTS, ("green", "yellow", "bold red", "bold red"), strict=True))


def inspection_terminal(inspection: Inspection, console: Console) -> None:
    """Print the inspection."""
    page = Page(console, [])
    shown = inspection.robot
    name = f", {printable(shown.name)}" if shown is not None else ""
    verdict = (effect(inspection), _STYLES[look_of(inspection)])
    path = shown.path if shown is not None else inspection.path
    page.inset(Text.assemble((printable(path), "bold"), ": ", verdict, name), indent=0)
    for remark in _remarks_on(inspection):
        page.inset(Text(remark, "dim"), indent=0)
    if len(inspection.robots) > 1:
        page.title("Robots")
        for robot in inspection.robots:
            line = (robot_line(robot), _STYLES[robot.verdict])
            page.inset(Text.assemble(printable(robot.path), ": ", line))
    if inspection.problems:
        page.title("Problems")
        page.rows.extend(_problem_rows(console, inspection))
    for title, rows in lists(shown):
        page.title(title)
        for name, words in rows:
            page.inset(Text.assemble(name, (words, "dim")))
    page.print()


def _remarks_on(inspection: Inspection) -> Iterator[str]:
    """Yield what is known of releases and of driving, and how many problems are ignored."""
    shown = inspection.robot
    if inspection.extent is not None:
        yield inspection.extent.words
    if shown is not None and shown.driving:
        yield printable(shown.driving)
    if inspection.ignored:
        yield f"{inspection.ignored} ignored"


def _problem_rows(console: Console, inspection: Inspection) -> Iterator[Text]:
    """Yield problems with their code and location, errors with their source line."""
    shown = inspection.robot
    urdf = shown.reading.source.path if shown is not None else ""
    for problem in inspection.problems[:_MAX_PROBLEMS]:
        where = problem.location
        name = f"{problem.code} {problem.severity:<7} "
        head = Text.assemble("  ", (name, SEVERITY_LOOKS[problem.severity]))
        file = "line " if where.path == urdf else f"{printable(where.path)}:"
        place = f"{file}{where.line}{calls_text(where)}: "
        message = Text.assemble((place, "dim"), printable(problem.message))
        yield block(console, message, len(head), head)
        source = inspection.source(where.path) if problem.severity == "error" else None
        if source is not None:
            yield excerpt_block(console, source, where, min(len(head), console.width // 5))
    rest = len(inspection.problems) - _MAX_PROBLEMS
    if rest > 0:
        yield block(console, Text(f"... and {rest} more (--format concise lists all)"), INDENT)
