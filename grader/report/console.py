"""The pieces that reports in the terminal are made of: source excerpts, lists of problems, lines that wrap."""

from collections.abc import Callable

from rich.console import Console
from rich.text import Text

from grader.problems import Problem
from grader.report.locations import excerpt
from grader.source import Location, Source
from grader.text import printable

SEVERITY_STYLES = {"error": "bold red", "warning": "yellow", "note": "cyan"}
_MOST_SHOWN = 30


def wrapped(console: Console, text: Text, indent: int, head: Text | None = None) -> None:
    """Print text that keeps its indent when it wraps; `head` stands in the indent of the first line."""
    lines = text.wrap(console, max(8, console.width - indent))
    for line in lines:
        line.rstrip()
    block = Text("\n" + " " * indent).join(lines)  # printed at once: a print costs more than a line
    console.print((head or Text(" " * indent)) + block, overflow="ignore", no_wrap=True, crop=False)


def show_excerpt(console: Console, source: Source, where: Location, indent: int, style: str = "red") -> None:
    """Print the source line of a place, with what is meant underlined."""
    number = str(where.line)
    quoted = excerpt(source, where, max(8, console.width - indent - len(number) - 3))
    mark, bar = ("\u2500", "\u2502") if _unicode(console) else ("-", "|")
    under = " " * quoted.start + mark * quoted.width
    for gutter, text in ((number, Text(quoted.text)), (" " * len(number), Text(under, style=style))):
        start = Text(f"{' ' * indent}{gutter} {bar} ", style="dim")
        console.print(start + text, overflow="ignore", no_wrap=True, crop=False)


def show_problems(
    console: Console, problems: tuple[Problem, ...], source_of: Callable[[str], Source | None], main: str | None
) -> None:
    """Print every problem with its code and place; the errors with their source line.

    `main` is the file that most of them are about: in all others the place names the file, too.
    """
    for problem in problems[:_MOST_SHOWN]:
        style = SEVERITY_STYLES[problem.severity]
        head = Text.assemble("  ", (f"{problem.code} {problem.severity:<7} ", style))
        where = problem.location
        named = f"line {where.line}" if where.path == main else f"{printable(where.path)}:{where.line}"
        place = Text(f"{named}: ", style="dim")
        wrapped(console, place + Text(printable(problem.message)), len(head), head)
        source = source_of(where.path) if problem.severity == "error" else None
        if source is not None:
            show_excerpt(console, source, where, min(len(head), console.width // 5))
    if len(problems) > _MOST_SHOWN:
        wrapped(console, Text(f"... and {len(problems) - _MOST_SHOWN} more"), 2)


def _unicode(console: Console) -> bool:
    return console.encoding.lower().startswith("utf")


def symbol(console: Console, fancy: str, plain: str) -> str:
    """A symbol, or its stand-in where the terminal cannot show it."""
    return fancy if _unicode(console) else plain
