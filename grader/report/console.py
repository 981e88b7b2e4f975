"""Print parts of a report on a rich console: source excerpts, lists of problems, wrapped text."""

import re
from collections.abc import Callable

from rich.console import Console
from rich.text import Text

from grader.problems import Problem
from grader.report.locations import calls_text, excerpt
from grader.source import Location, Source
from grader.text import first_lines, printable

SEVERITY_STYLES = {"error": "bold red", "warning": "yellow", "note": "cyan"}
_MAX_PROBLEMS = 30
_LAST_WORD, _LAST_NUMBER = re.compile(r"\s+\S*$"), re.compile(r"\s+[-+.\d]+$")  # a number keeps its unit


def wrapped(console: Console, text: Text, indent: int, head: Text | None = None) -> None:
    """Print text that keeps its indent when it wraps; `head` replaces the indent of the first line."""
    put(console, block(console, text, indent, head))


def block(console: Console, text: Text, indent: int, head: Text | None = None, most: int | None = None) -> Text:
    """Return text that keeps its indent when it wraps; of more than `most` lines the first ones, with an ellipsis."""
    lines = text.wrap(console, max(8, console.width - indent))
    for line in lines:
        line.rstrip()
    kept = lines[:most]
    if len(kept) < len(lines):
        ellipsis = symbol(console, "\u2026", "...")
        room = max(8, console.width - indent) - len(ellipsis)
        words = kept[-1].plain if kept[-1].cell_len <= room else _LAST_WORD.sub("", kept[-1].plain)
        kept[-1].truncate(min(room, len(_LAST_NUMBER.sub("", words))))
        kept[-1].append(ellipsis)
    return (Text(" " * indent) if head is None else head) + Text("\n" + " " * indent).join(kept)


def put(console: Console, text: Text) -> None:
    """Print lines that are wrapped already, all at once: a print costs more than a line."""
    console.print(text, overflow="ignore", no_wrap=True, crop=False)


def excerpt_block(
    console: Console, source: Source, where: Location, indent: int, style: str = "red", *, is_underlined: bool = True
) -> Text:
    """Return the source line of a location, and if wanted a line that underlines the marked part."""
    number = str(where.line)
    line = excerpt(source, where, max(8, console.width - indent - len(number) - 3))
    mark, bar = symbol(console, "\u2500", "-"), symbol(console, "\u2502", "|")
    text = Text.assemble((f"{' ' * indent}{number} {bar} ", "dim"), line.text)
    if is_underlined:
        under = " " * line.start + mark * line.width
        text.append(f"\n{' ' * (indent + len(number))} {bar} ", "dim").append(under, style)
    return text


def show_problems(
    console: Console, problems: tuple[Problem, ...], source_of: Callable[[str], Source | None], main: str | None
) -> None:
    """Print problems with their code and location, errors with their source line. In `main` only the line is named."""
    for problem in problems[:_MAX_PROBLEMS]:
        style = SEVERITY_STYLES[problem.severity]
        head = Text.assemble("  ", (f"{problem.code} {problem.severity:<7} ", style))
        where = problem.location
        named = f"line {where.line}" if where.path == main else f"{printable(where.path)}:{where.line}"
        prefix = Text(f"{named}{calls_text(where)}: ", style="dim")
        wrapped(console, prefix + Text(printable(problem.message)), len(head), head)
        source = source_of(where.path) if problem.severity == "error" else None
        if source is not None:
            put(console, excerpt_block(console, source, where, min(len(head), console.width // 5)))
    for text in first_lines([problem.code for problem in problems], _MAX_PROBLEMS)[_MAX_PROBLEMS:]:
        wrapped(console, Text(text), 2)


def symbol(console: Console, fancy: str, plain: str) -> str:
    """Return a symbol, or its ASCII form if the terminal cannot show it."""
    return fancy if console.encoding.lower().startswith("utf") else plain
