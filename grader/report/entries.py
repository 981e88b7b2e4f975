"""One criterion in the report for a terminal: a failure with what to do, or what needs manual grading."""

import sys
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report, Result
from grader.report import content
from grader.report.console import block, excerpt_block, put, symbol, wrapped
from grader.report.details import SYMBOLS, Details, location_text, result_details, short_hint, status_of
from grader.report.diff import diff_lines
from grader.report.order import Failure
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
_MAX_LINES, _MIN_MESSAGE = 9, 2  # lines of a failure, besides the empty one before it, and of its message


class Page(NamedTuple):
    """The report, the console, whether everything is shown, and the feedback that is printed already."""

    report: Report
    console: Console
    is_verbose: bool
    shown: set[str]


def mark(status: str, console: Console) -> Text:
    """Return the symbol of a status in its colour."""
    return Text(symbol(console, SYMBOLS[status], _ASCII[status]), STYLES[status])


def show_failure(failure: Failure, page: Page) -> None:
    """Print a criterion that failed: what it costs, what is and what should be, where, and what to do.

    Unless everything is shown, it takes at most ten lines, with the empty one before it: texts that do not fit are cut, but no hint.
    """
    result, console = failure.result, page.console
    details = result_details(result, page.report)
    head, excerpt = [_head(failure, details, console)], [*_excerpt(details, page)]
    excerpt += [block(console, Text(details.comment, "bold"), INDENT)] if details.comment else []
    skipped = [_skipped(failure, page)] if failure.skipped else []
    room = sys.maxsize if page.is_verbose else _MAX_LINES - _height(*head, *excerpt, *skipped)
    hints = [*_hints(details, room - _MIN_MESSAGE, page)]
    message = _fitted([_message(details, result)], max(room - _height(*hints), _MIN_MESSAGE), console)
    reasons = _fitted(_reasons(details, result, page), room - _height(*hints, *message), console)
    page.shown.update(" ".join(text.plain.split()) for text in reasons)  # one that is cut is shown again
    console.print()
    put(console, Text("\n").join((*head, *message, *excerpt, *hints, *reasons, *skipped)))


def _head(failure: Failure, details: Details, console: Console) -> Text:
    result = failure.result
    status = {"errored": "errored", "partial": "partial"}.get(status_of(result), "failed")
    text = Text.assemble(mark(status, console), " ", (printable(result.criterion.id), "bold"))
    text.append(f"  {content.cost_text(failure)}", STYLES[status])
    if details.location is not None:
        text.append(f"  {location_text(details.location)}", "dim")
    return block(console, text, INDENT, Text())


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
        yield excerpt_block(page.console, source, where, INDENT)


def _hints(details: Details, room: int, page: Page) -> Iterator[Text]:
    """Yield the first hint, without its edits if there is no room for them; on a full page all hints, with the lines that change."""
    for hint in details.hints[: None if page.is_verbose else 1]:
        whole = block(page.console, Text(hint.message, "bold"), INDENT)
        is_short = _height(whole) > room and bool(hint.edits and hint.action)
        yield block(page.console, Text(short_hint(hint), "bold"), INDENT) if is_short else whole
        if page.is_verbose:
            lines = diff_lines(hint.edits, page.report.submission.source)
            yield from (block(page.console, Text(line, _CHANGES.get(line[0], "dim")), 2 * INDENT) for line in lines)


def _reasons(details: Details, result: Result, page: Page) -> Iterator[Text]:
    """Yield the feedback where there is no hint, and what should be where the message does not say it; on a full page both."""
    if details.feedback and details.feedback not in page.shown and (page.is_verbose or not details.hints):
        yield Text(details.feedback, "italic")
    if details.expected and (page.is_verbose or result.outcome.expected is None):
        yield Text(details.expected, "dim")


def _skipped(failure: Failure, page: Page) -> Text:
    number, points = len(failure.skipped), content.points_of(failure.skipped)
    words = "criterion is" if number == 1 else "criteria are"
    return block(page.console, Text(f"{number} {words} skipped because of it ({points}).", "yellow"), INDENT)


def _fitted(texts: Iterable[Text], room: int, console: Console) -> list[Text]:
    """Return texts in as many lines as there is room for; one is cut only if two lines of it remain."""
    fitted: list[Text] = []
    for text in texts:
        left = room - _height(*fitted)
        whole = block(console, text, INDENT)
        if _height(whole) <= left:
            fitted.append(whole)
        elif left > 1:
            fitted.append(block(console, text, INDENT, most=left))
    return fitted


def _height(*texts: Text) -> int:
    return sum(text.plain.count("\n") + 1 for text in texts)


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
