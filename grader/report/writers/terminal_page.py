"""The rows of a report, an inspection or a table on a terminal."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from rich.console import Console
from rich.text import Text

from grader.base.problems import Severity
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.report.locations import excerpt
from grader.report.statuses import ASCII_SYMBOLS, STYLES, SYMBOLS

if TYPE_CHECKING:
    from rich.table import Table

INDENT = 2
SEVERITY_LOOKS: Mapping[Severity, str] = {
    "error": "bold red",
    "warning": "yellow",
    "note": "cyan",
}


class Page(Named):
    """The rows of a report for a console. All texts are printable."""

    console: Console
    rows: list[Text]

    @property
    def height(self) -> int:
        """The number of rows so far that are not empty."""
        return sum(count_rows(row) for row in self.rows if row.plain)

    def close_up(self, most: int) -> None:
        """Remove empty rows, the last ones first, until there are at most so many rows.

        Nothing is removed if they are too many without.
        """
        empty = [index for index, row in enumerate(self.rows) if not row.plain]
        excess = self.height + len(empty) - most
        if 0 < excess <= len(empty):
            for index in reversed(empty[-excess:]):
                del self.rows[index]

    def leave_row(self) -> None:
        """Add an empty row."""
        self.rows.append(Text())

    def title(self, text: str | Text, style: str = "bold") -> None:
        """Add a title below an empty row."""
        self.leave_row()
        self.line(text, style)

    def line(self, text: str | Text, style: str = "") -> None:
        """Add a line, with an indent where it wraps."""
        self.inset(text, style, head=Text())

    def inset(
        self, text: str | Text, style: str = "", indent: int = INDENT, head: Text | None = None
    ) -> None:
        """Add a text below a title or an item."""
        self.rows.append(
            block(self.console, Text(text, style) if isinstance(text, str) else text, indent, head)
        )

    def item(self, status: str, *parts: str | tuple[str, str]) -> None:
        """Add texts, with their styles, behind the symbol of a status."""
        self.inset(Text.assemble(*parts), head=self.mark(status) + Text(" "))

    def mark(self, status: str) -> Text:
        """Return the symbol of a status in its colour."""
        return Text(_symbol(self.console, SYMBOLS[status], ASCII_SYMBOLS[status]), STYLES[status])

    def table(self, table: "Table") -> None:
        """Add a table, which a terminal may be too narrow for."""
        self.print()
        self.console.print(table)

    def print(self) -> None:
        """Print the rows so far, all at once: a print costs more than a row."""
        self.console.print(Text("\n").join(self.rows), overflow="ignore", no_wrap=True, crop=False)
        self.rows.clear()


def block(console: Console, text: Text, indent: int, head: Text | None = None) -> Text:
    """Return text that keeps its indent when it wraps.

    `head` is in place of the indent of the first line.
    """
    lines = text.wrap(console, max(8, console.width - indent))
    for line in lines:
        line.rstrip()
    return (Text(" " * indent) if head is None else head) + Text("\n" + " " * indent).join(lines)


def shortened(console: Console, text: Text) -> Text:
    """Return a text in one row: one that is too long ends with points."""
    if len(text) <= console.width:
        return text
    points = "..."
    return text[: console.width - len(points)].append(points)


def excerpt_block(console: Console, source: Source, where: Location, indent: int) -> Text:
    """Return the source line of a location, and a line that underlines the marked part."""
    number = str(where.line)
    before, meant, after = excerpt(source, where, max(8, console.width - indent - len(number) - 3))
    mark = _symbol(console, "\u2500", "-")
    bar = _symbol(console, "\u2502", "|")
    text = Text.assemble(
        (f"{' ' * indent}{number} {bar} ", "dim"), (before + meant + after).rstrip()
    )
    under = " " * len(before) + mark * max(1, len(meant))
    return text.append(f"\n{' ' * (indent + len(number))} {bar} ", "dim").append(under, "red")


def _symbol(console: Console, fancy: str, plain: str) -> str:
    """Return a symbol, or its ASCII form if the terminal cannot show it."""
    if console.encoding.lower().startswith("utf"):
        return fancy
    return plain


def count_rows(text: Text) -> int:
    """Return how many rows a text has."""
    return text.plain.count("\n") + 1
