"""Print parts of a report on a rich console: source excerpts, lists of problems, wrapped text."""

import re
from collections.abc import Iterator, Mapping, Sequence
from enum import Enum, auto
from typing import NamedTuple, get_args

from rich.console import Console
from rich.text import Text

from grader.problems import Problem
from grader.report.blocks import Role
from grader.report.details import ASCII_SYMBOLS, STYLES, SYMBOLS
from grader.report.locations import SourceOf, calls_text, excerpt
from grader.source import Location, Source
from grader.text import first_lines, printable

INDENT = 2
LOOKS: Mapping[Role, str] = {
    **dict.fromkeys(get_args(Role), ""),
    **dict.fromkeys(("pending", "comment", "hint"), "bold"),
    **dict.fromkeys(("provenance", "expected", "part", "ignored"), "dim"),
    **dict.fromkeys(("missing", "skipped", "alike", "warning"), "yellow"),
    "feedback": "italic",
    "error": "bold red",
    "note": "cyan",
}
_MAX_PROBLEMS = 30
_LAST_WORD, _LAST_NUMBER = re.compile(r"\s+\S*$"), re.compile(r"\s+[-+.\d]+$")  # a number keeps its unit


class Room(Enum):
    """What a page has room for: everything in any number of rows, or what fits into 24."""

    ANY = auto()
    EVERYTHING = auto()  # of a short report
    NO_TITLES = auto()  # of what failed, and no groups that passed
    NO_EMPTY_ROWS = auto()  # as well


class Page(NamedTuple):
    """The rows of a report for a console, and how much room there is. All texts are printable."""

    console: Console
    room: Room
    rows: list[Text]

    @property
    def is_whole(self) -> bool:
        """Return whether there is room for everything."""
        return self.room is Room.ANY

    @property
    def is_tight(self) -> bool:
        """Return whether there are no empty rows."""
        return self.room is Room.NO_EMPTY_ROWS

    def leave_row(self) -> None:
        """Add an empty row if there is room for it."""
        if not self.is_tight:
            self.rows.append(Text())

    def title(self, text: str | Text, style: str = "bold") -> None:
        """Add a title below an empty row."""
        self.leave_row()
        self.line(text, style)

    def line(self, text: str | Text, style: str = "") -> None:
        """Add a line, with an indent where it wraps."""
        self.inset(text, style, head=Text())

    def inset(
        self, text: str | Text, style: str = "", indent: int = INDENT, head: Text | None = None, most: int | None = None
    ) -> None:
        """Add a text below a title or an item, of more than `most` rows the first ones."""
        self.rows.append(block(self.console, Text(text, style) if isinstance(text, str) else text, indent, head, most))

    def item(self, status: str, *parts: str | tuple[str, str]) -> None:
        """Add texts, with their styles, behind the symbol of a status."""
        self.inset(Text.assemble(*parts), head=self.mark(status) + Text(" "))

    def mark(self, status: str) -> Text:
        """Return the symbol of a status in its colour."""
        return Text(symbol(self.console, SYMBOLS[status], ASCII_SYMBOLS[status]), STYLES[status])

    def print(self) -> None:
        """Print the rows, all at once: a print costs more than a row."""
        put(self.console, Text("\n").join(self.rows))


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
    """Print lines that are wrapped already."""
    console.print(text, overflow="ignore", no_wrap=True, crop=False)


def excerpt_block(
    console: Console, source: Source, where: Location, indent: int, style: str = "red", *, is_underlined: bool = True
) -> Text:
    """Return the source line of a location, and if wanted a line that underlines the marked part."""
    number = str(where.line)
    before, meant, after = excerpt(source, where, max(8, console.width - indent - len(number) - 3))
    mark, bar = symbol(console, "\u2500", "-"), symbol(console, "\u2502", "|")
    text = Text.assemble((f"{' ' * indent}{number} {bar} ", "dim"), (before + meant + after).rstrip())
    if is_underlined:
        under = " " * len(before) + mark * max(1, len(meant))
        text.append(f"\n{' ' * (indent + len(number))} {bar} ", "dim").append(under, style)
    return text


def problem_rows(
    console: Console, problems: Sequence[Problem], source_of: SourceOf, main: str | None
) -> Iterator[Text]:
    """Yield problems with their code and location, errors with their source line. In `main` only the line is named."""
    for problem in problems[:_MAX_PROBLEMS]:
        where, style = problem.location, LOOKS[problem.severity]
        head = Text.assemble("  ", (f"{problem.code} {problem.severity:<7} ", style))
        named = f"line {where.line}" if where.path == main else f"{printable(where.path)}:{where.line}"
        message = Text.assemble((f"{named}{calls_text(where)}: ", "dim"), printable(problem.message))
        yield block(console, message, len(head), head)
        source = source_of(where.path) if problem.severity == "error" else None
        if source is not None:
            yield excerpt_block(console, source, where, min(len(head), console.width // 5))
    for text in first_lines([problem.code for problem in problems], _MAX_PROBLEMS)[_MAX_PROBLEMS:]:
        yield block(console, Text(text), INDENT)


def symbol(console: Console, fancy: str, plain: str) -> str:
    """Return a symbol, or its ASCII form if the terminal cannot show it."""
    return fancy if console.encoding.lower().startswith("utf") else plain
