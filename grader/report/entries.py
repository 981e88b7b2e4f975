"""A criterion on a terminal: what it costs, what is wrong and where, the answer, what to do."""

from collections.abc import Iterator

from rich.text import Text

from grader.grading.report import Report
from grader.report.blocks import Answer, Block, Diff, Entry, Line
from grader.report.console import INDENT, LOOKS, Page, Room, block, excerpt_block
from grader.report.details import STYLES, hint_text
from grader.report.locations import diff_lines, location_text
from grader.report.order import is_failure, points_of
from grader.source import Location
from grader.text import counted, printable

_DIFF_STYLES = {"-": "red", "+": "green"}
_MAX_FIRST = 3  # failures with their source line
_MAX_ROWS, _MAX_REASON = 4, 2  # rows of a message, and of a reason; a hint has fewer than a message


def show_entry(entry: Entry, report: Report, page: Page, number: int = 0) -> None:
    """Print a criterion; `number` counts failures, of which a short report has only the first with all blocks."""
    head, message, source_of = _head(entry, page), Text(" ".join(entry.texts("finding"))), report.submission.source
    if page.is_tight:
        most = _MAX_ROWS if number < _MAX_FIRST else _MAX_REASON
        page.inset(Text(": ").join((head, message)), head=Text(), most=most)
    else:
        page.line(head)
        page.inset(message)
    for part in entry.blocks if page.is_whole else _shortened(entry, page, is_first=number < _MAX_FIRST):
        match part:
            case Line(role, text) if role != "finding":
                is_cut = page.is_tight and role in ("feedback", "expected")
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
    advice = entry.texts("hint", "feedback")
    is_clear = entry.result.outcome.expected is not None or (page.is_tight and bool(advice))
    has_reasons = is_first or not page.is_tight
    for part in entry.blocks:
        match part:
            case Location() if is_first:
                yield part
            case Line("hint", text):
                yield Line("hint", _short_hint(entry, text, page))
            case Line("comment" | "alike"):
                yield part
            case Answer() if not is_failure(entry.result):
                yield part
            case Line("feedback") if has_reasons:
                yield part
            case Line("expected") if has_reasons and (page.room is Room.EVERYTHING or not is_clear):
                yield part
            case Line("skipped") if not page.is_tight:
                words = f"{counted(len(entry.skipped), 'criterion is', 'criteria are')} skipped because of it"
                yield Line("skipped", f"{words} ({points_of(entry.skipped)}).")


def _short_hint(entry: Entry, text: str, page: Page) -> str:
    """Return the hint, or what is wrong if its edits are too long."""
    rows, hint = block(page.console, Text(text), INDENT).plain.count("\n") + 1, entry.result.hint
    if hint is None or not hint.cause or rows < _MAX_ROWS:
        return text
    return hint_text(entry, f"Wrong: {hint.cause}. --verbose shows the edits.")
