"""One criterion in the report for a terminal: a failure with what to do, or what needs manual grading."""

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report, Result
from grader.report import content
from grader.report.console import block, excerpt_block, put, symbol, wrapped
from grader.report.details import SYMBOLS, Details, diff_lines, location_text, result_details, sentence, status_of
from grader.report.order import Failure, hint_of
from grader.text import printable

STYLES = {
    "passed": "green",
    "failed": "bold red",
    "skipped": "yellow",
    "pending": "cyan",
    "errored": "bold magenta",
    "adjusted": "blue",
    "partial": "bold yellow",
}
_ASCII = dict(zip(SYMBOLS, "+X-?!=~", strict=True))  # for a terminal in another encoding
_CHANGES = {"-": "red", "+": "green"}
INDENT = 2
_MAX_FIRST = 3  # failures with their source line
_MAX_ROWS, _MAX_REASON = 4, 2  # rows of a message, and of a reason; a hint has fewer than a message


class Page(NamedTuple):
    """The report, the console, whether everything is shown, the feedback that is printed already, and how roomy it is.

    A page of 24 rows is filled: the `room` is 2 as long as everything fits, then 1 without titles and groups, then 0 without empty rows.
    """

    report: Report
    console: Console
    is_verbose: bool
    shown: set[str]
    room: int

    def leave_row(self) -> None:
        """Print an empty row if there is room for it."""
        if self.room:
            self.console.print()


def mark(status: str, console: Console) -> Text:
    """Return the symbol of a status in its colour."""
    return Text(symbol(console, SYMBOLS[status], _ASCII[status]), STYLES[status])


def show_failure(failure: Failure, page: Page, number: int) -> None:
    """Print a criterion that failed: what it costs, what is and what should be, where, and what to do.

    Unless everything is shown, only the first failures have their source line, and long texts are cut.
    """
    result, console = failure.result, page.console
    details = result_details(result, page.report)
    head, message = _head(failure, details, page), _message(details, result)
    texts = [block(console, head, INDENT, Text()), block(console, message, INDENT)]
    is_first = page.is_verbose or number < _MAX_FIRST
    if not page.room:
        texts = [
            block(console, Text(": ").join((head, message)), INDENT, Text(), _MAX_ROWS if is_first else _MAX_REASON)
        ]
    texts += _excerpt(details, page) if is_first else ()
    texts += [block(console, Text(details.comment, "bold"), INDENT)] if details.comment else []
    texts += _hints(failure, details, page)
    reasons = [*_reasons(details, result, page)] if page.room or is_first else []
    page.shown.update(text.plain for text in reasons)
    skipped = [_skipped(failure)] if failure.skipped and page.room else []
    most = None if page.room else _MAX_REASON - (number > 0)
    texts += [block(console, text, INDENT, most=most) for text in (*reasons, *skipped)]
    page.leave_row()
    put(console, Text("\n").join(texts))


def _head(failure: Failure, details: Details, page: Page) -> Text:
    result = failure.result
    status = {"errored": "errored", "partial": "partial"}.get(status_of(result), "failed")
    text = Text.assemble(mark(status, page.console), " ", (printable(result.criterion.id), "bold"))
    text.append(f"  {content.cost_text(failure)}", STYLES[status])
    if failure.skipped and not page.room:
        text.append(f" with {len(failure.skipped)} skipped", "yellow")
    if details.location is not None:
        where = details.location if page.room else replace(details.location, calls=())
        text.append(f"  {location_text(where)}", "dim")
    return text


def _message(details: Details, result: Result) -> Text:
    """Return the sentences of a failure: a mark and then what the check found, or a fault of the grader, which stands out."""
    styles = ("bold", "dim") if result.manual_mark is not None else ("", "bold")
    if result.outcome.status == "errored" and result.manual_mark is None:
        styles = (STYLES["errored"], "")
    return Text(" ").join(Text(text, style) for text, style in zip(details.sentences, styles, strict=False))


def _excerpt(details: Details, page: Page) -> Iterator[Text]:
    where = details.location
    source = page.report.submission.source(where.path) if where is not None else None
    if where is not None and source is not None and source.line(where.line).strip():
        yield excerpt_block(page.console, source, where, INDENT, is_underlined=bool(page.room))


def _hints(failure: Failure, details: Details, page: Page) -> Iterator[Text]:
    """Yield the first hint, without its edits if it is long; on a full page all hints, with the lines that change."""
    for hint in details.hints[: None if page.is_verbose else 1]:
        whole = block(page.console, Text(hint.message, "bold"), INDENT)
        is_long = not page.is_verbose and hint.action and _height(whole) >= _MAX_ROWS
        if is_long:
            short = hint_of(failure, hint._replace(message=f"{sentence(hint.action)} --verbose shows the edits."))
            whole = block(page.console, Text(short.message, "bold"), INDENT)
        yield whole
        if page.is_verbose:
            lines = diff_lines(hint.edits, page.report.submission.source)
            yield from (block(page.console, Text(line, _CHANGES.get(line[0], "dim")), 2 * INDENT) for line in lines)


def _reasons(details: Details, result: Result, page: Page) -> Iterator[Text]:
    """Yield the feedback where there is no hint, and what should be where the message does not say it; with room for it both."""
    if details.feedback and details.feedback not in page.shown and (page.is_verbose or not details.hints):
        yield Text(details.feedback, "italic")
    is_clear = result.outcome.expected is not None or (not page.room and bool(details.advice))
    if details.expected and (page.room > 1 or not is_clear):
        yield Text(details.expected, "dim")


def _skipped(failure: Failure) -> Text:
    number, points = len(failure.skipped), content.points_of(failure.skipped)
    words = "criterion is" if number == 1 else "criteria are"
    return Text(f"{number} {words} skipped because of it ({points}).", "yellow")


def _height(text: Text) -> int:
    return text.plain.count("\n") + 1


def show_answer(result: Result, page: Page) -> None:
    """Print what needs manual grading, or has a manual mark, with the answer that was found and the model answer."""
    details, console = result_details(result, page.report), page.console
    title = Text.assemble((printable(result.criterion.title), "bold"), (f"  {result.criterion.id}", "dim"))
    title.append(f"  {content.earned_text((result,))}")
    wrapped(console, title, INDENT, mark(status_of(result), console) + Text(" "))
    for text in details.words:
        wrapped(console, Text(text), INDENT)
    for name, lines in (("Found", details.answer), ("Model answer", details.model_answer)):
        if lines:
            wrapped(console, Text(f"{name}:", "bold"), INDENT)
        for line in lines:
            wrapped(console, Text(line), 2 * INDENT)
