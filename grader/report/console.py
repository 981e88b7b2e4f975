"""A report on a rich console: rows of wrapped text, criteria with all that is said about them, source lines."""

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple, get_args

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report
from grader.report.criteria import Answer, Block, Diff, Entry, Line, Role, is_failure, points_of
from grader.report.details import ASCII_SYMBOLS, STYLES, SYMBOLS, hint_text
from grader.report.locations import diff_lines, excerpt, location_text
from grader.source import Location, Source
from grader.text import counted, printable

if TYPE_CHECKING:
    from rich.table import Table

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
_DIFF_STYLES = {"-": "red", "+": "green"}
_MAX_FIRST = 3  # failures with their source line
_MAX_ROWS, _MAX_REASON = 4, 2  # rows of a message, and of a reason; a hint has fewer than a message
_MOST_ROWS = 10  # of a message in a report of more than 24 rows
_LAST_WORD, _LAST_NUMBER = re.compile(r"\s+\S*$"), re.compile(r"\s+[-+.\d]+$")  # a number keeps its unit


class Page(NamedTuple):
    """The rows of a report for a console. All texts are printable.

    A page that is not `is_whole` is a short report; without empty rows if `is_tight`, with short texts if `is_cut`.
    """

    console: Console
    rows: list[Text]
    is_whole: bool = True
    is_tight: bool = False
    is_cut: bool = False

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

    def table(self, table: "Table") -> None:
        """Add a table, which a terminal may be too narrow for."""
        self.print()
        self.console.print(table)

    def print(self) -> None:
        """Print the rows so far, all at once: a print costs more than a row."""
        self.console.print(Text("\n").join(self.rows), overflow="ignore", no_wrap=True, crop=False)
        self.rows.clear()


def show_entry(entry: Entry, report: Report, page: Page, number: int = 0) -> None:
    """Add a criterion; `number` counts failures, of which a short report has only the first with all blocks."""
    head, message, source_of = _head(entry, page), Text(" ".join(entry.texts("finding"))), report.submission.source
    if page.is_tight:
        most = _MOST_ROWS if not page.is_cut else _MAX_ROWS if number < _MAX_FIRST else _MAX_REASON
        page.inset(Text(": ").join((head, message)), head=Text(), most=most)
    else:
        page.line(head)
        page.inset(message)
    for part in entry.blocks if page.is_whole else _shortened(entry, page, is_first=number < _MAX_FIRST):
        match part:
            case Line(role, text) if role != "finding":
                is_cut = page.is_cut and role in ("feedback", "expected")
                page.inset(text, LOOKS[role], most=_MAX_REASON - (number > 0) if is_cut else None)
            case Location():
                source = source_of(part.path)
                if source is not None and source.line(part.line).strip():
                    page.rows.append(excerpt_block(page.console, source, part, INDENT, is_underlined=not page.is_tight))
            case Answer(title, lines):
                page.inset(f"{title}:", "bold")
                for line in lines:
                    page.inset(line, indent=2 * INDENT)
            case Diff(edits):
                for line in diff_lines(edits, source_of):
                    page.inset(line, _DIFF_STYLES.get(line[0], "dim"), 2 * INDENT)


def _head(entry: Entry, page: Page) -> Text:
    """Return the name of a failure, its cost and place, or the title, name and points of another criterion."""
    name, mark = printable(entry.id), page.mark(entry.status)
    if not is_failure(entry.result):
        title = printable(entry.result.criterion.title)
        return Text.assemble(mark, " ", (title, "bold"), (f"  {name}", "dim"), f"  {entry.points}")
    text = Text.assemble(mark, " ", (name, "bold"), (f"  {entry.points}", STYLES[entry.status]))
    if entry.location is not None:
        where = entry.location._replace(calls=()) if page.is_tight else entry.location
        text.append(f"  {location_text(where)}", "dim")
    return text


def _shortened(entry: Entry, page: Page, *, is_first: bool) -> Iterator[Block]:
    """Yield the blocks for which a short report has room."""
    is_failed, is_loose = is_failure(entry.result), not page.is_tight
    is_clear = entry.result.outcome.expected is not None or bool(entry.texts("hint", "feedback"))
    for part in entry.blocks:
        match part:
            case Line("hint", text):
                yield Line("hint", _short_hint(entry, text, page))
            case Line("skipped") if is_loose:
                words = f"{counted(len(entry.skipped), 'criterion is', 'criteria are')} skipped because of it"
                yield Line("skipped", f"{words} ({points_of(entry.skipped)}).")
            case Line("comment" | "alike"):
                yield part
            case Location() if is_first:
                yield part
            case Answer() if not is_failed:
                yield part
            case Line("feedback") if is_first or is_loose:
                yield part
            case Line("expected") if not is_clear and (is_first or is_loose):
                yield part


def _short_hint(entry: Entry, text: str, page: Page) -> str:
    """Return the hint, or what is wrong if its edits are too long."""
    rows, hint = block(page.console, Text(text), INDENT).plain.count("\n") + 1, entry.result.hint
    if hint is None or not hint.cause or rows < _MAX_ROWS:
        return text
    return hint_text(entry, f"Wrong: {hint.cause}. --verbose shows the edits.")


def block(console: Console, text: Text, indent: int, head: Text | None = None, most: int | None = None) -> Text:
    """Return text that keeps its indent when it wraps; `head` is in place of the indent of the first line.

    Of more than `most` lines it is the first ones, with an ellipsis.
    """
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


def symbol(console: Console, fancy: str, plain: str) -> str:
    """Return a symbol, or its ASCII form if the terminal cannot show it."""
    return fancy if console.encoding.lower().startswith("utf") else plain
