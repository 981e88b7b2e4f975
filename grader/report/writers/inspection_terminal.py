"""An inspection on a terminal. Text of files is never interpreted as markup or control codes."""

from collections.abc import Iterator

from rich.console import Console
from rich.text import Text

from grader.base.text import printable
from grader.report.inspection import EFFECTS, Inspection, effect, lists
from grader.report.locations import calls_text
from grader.report.writers.terminal import INDENT, LOOKS, Page, block, excerpt_block

_MAX_PROBLEMS = 30
_STYLES = dict(zip(EFFECTS, ("green", "yellow", "bold red", "bold red"), strict=True))


def inspection_terminal(inspection: Inspection, console: Console) -> None:
    """Print the inspection."""
    page = Page(console, [])
    robot = inspection.robot
    name = f"robot {robot.robot.name!r}" if robot is not None else "no robot"
    verdict = (effect(inspection), _STYLES[inspection.verdict or "clean"])
    page.inset(
        Text.assemble((printable(inspection.path), "bold"), ": ", verdict, f", {printable(name)}"),
        indent=0,
    )
    if inspection.problems:
        page.title("Problems")
        page.rows.extend(_problem_rows(console, inspection))
    for title, rows in lists(inspection):
        page.title(title)
        for name, words in rows:
            page.inset(Text.assemble(name, (words, "dim")))
    page.print()


def _problem_rows(console: Console, inspection: Inspection) -> Iterator[Text]:
    """Yield problems with their code and location, errors with their source line."""
    urdf = inspection.reading.source.path if inspection.reading is not None else ""
    for problem in inspection.problems[:_MAX_PROBLEMS]:
        where = problem.location
        name = f"{problem.code} {problem.severity:<7} "
        head = Text.assemble("  ", (name, LOOKS[problem.severity]))
        file = "line " if where.path == urdf else f"{printable(where.path)}:"
        place = f"{file}{where.line}{calls_text(where)}: "
        message = Text.assemble((place, "dim"), printable(problem.message))
        yield block(console, message, len(head), head)
        source = inspection.source(where.path) if problem.severity == "error" else None
        if source is not None:
            yield excerpt_block(console, source, where, min(len(head), console.width // 5))
    rest = len(inspection.problems) - _MAX_PROBLEMS
    if rest > 0:
        yield block(console, Text(f"... and {rest} more"), INDENT)
