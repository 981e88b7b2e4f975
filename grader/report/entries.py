"""The criteria in the report for a terminal: a failure with what to do, what needs manual grading, lists."""

from collections.abc import Iterator
from enum import Enum, auto
from typing import NamedTuple

from rich.console import Console
from rich.text import Text

from grader.grading.report import Report, Result
from grader.report.console import block, excerpt_block, put, symbol, wrapped
from grader.report.details import ASCII_SYMBOLS, STYLES, SYMBOLS, Details, hint_of, result_details
from grader.report.locations import diff_lines, location_text
from grader.report.order import CriteriaGroup, FailedCriterion, earned_text, points_of, status_of
from grader.text import printable

_DIFF_STYLES = {"-": "red", "+": "green"}
INDENT = 2
_MAX_FIRST = 3  # failures with their source line
_MAX_ROWS, _MAX_REASON = 4, 2  # rows of a message, and of a reason; a hint has fewer than a message


class Room(Enum):
    """What a page of 24 rows has room for."""

    EVERYTHING = auto()
    NO_TITLES = auto()  # of what failed, and no groups that passed
    NO_EMPTY_ROWS = auto()  # as well


class Page(NamedTuple):
    """The report, the console, whether all is printed, the feedback that is printed already, and how roomy it is."""

    report: Report
    console: Console
    is_verbose: bool
    printed: set[str]
    room: Room

    @property
    def is_tight(self) -> bool:
        """Return whether there are no empty rows."""
        return self.room is Room.NO_EMPTY_ROWS

    def leave_row(self) -> None:
        """Print an empty row if there is room for it."""
        if not self.is_tight:
            self.console.print()

    def title(self, text: str, style: str = "bold") -> None:
        """Print a title."""
        wrapped(self.console, Text(text, style), 0)

    def line(self, text: str, style: str = "") -> None:
        """Print a line of its own, with an indent where it wraps."""
        wrapped(self.console, Text(text, style), INDENT, Text())

    def inset(self, text: str, style: str = "", levels: int = 1) -> None:
        """Print a text below a title or an item."""
        wrapped(self.console, Text(text, style), levels * INDENT)

    def item(self, status: str, *parts: str | tuple[str, str]) -> None:
        """Print texts, with their styles, behind the symbol of a status."""
        wrapped(self.console, Text.assemble(*parts), INDENT, self.mark(status) + Text(" "))

    def mark(self, status: str) -> Text:
        """Return the symbol of a status in its colour."""
        return Text(symbol(self.console, SYMBOLS[status], ASCII_SYMBOLS[status]), STYLES[status])


def show_failure(failure: FailedCriterion, page: Page, number: int) -> None:
    """Print a criterion that failed: what it costs, what is and what should be, where, and what to do.

    Unless everything is printed, only the first failures have their source line, and long texts are cut.
    """
    console, details = page.console, result_details(failure.result, page.report)
    is_first = page.is_verbose or number < _MAX_FIRST
    head, message = _head(failure, details, page), _message(details, failure.result)
    if not page.is_tight:
        texts = [block(console, head, INDENT, Text()), block(console, message, INDENT)]
    else:
        most = _MAX_ROWS if is_first else _MAX_REASON
        texts = [block(console, Text(": ").join((head, message)), INDENT, Text(), most)]
    texts += _excerpt(details, page) if is_first else ()
    texts += [block(console, Text(details.comment, "bold"), INDENT)] if details.comment else []
    texts += _hint(failure, details, page)
    reasons = [*_reasons(details, failure.result, page)] if not page.is_tight or is_first else []
    page.printed.update(text.plain for text in reasons)
    reasons += () if page.is_tight else _consequence(failure)
    most_reasons = _MAX_REASON - (number > 0) if page.is_tight else None
    texts += [block(console, text, INDENT, most=most_reasons) for text in reasons]
    page.leave_row()
    put(console, Text("\n").join(texts))


def _head(failure: FailedCriterion, details: Details, page: Page) -> Text:
    status = status_of(failure.result)
    text = Text.assemble(page.mark(status), " ", (printable(failure.id), "bold"))
    text.append(f"  {failure.cost}", STYLES[status])
    if details.location is not None:
        where = details.location._replace(calls=()) if page.is_tight else details.location
        text.append(f"  {location_text(where)}", "dim")
    return text


def _message(details: Details, result: Result) -> Text:
    """Return the sentences of a failure: a mark and what the check found, or a fault of the grader."""
    styles = ("bold", "dim") if result.manual_mark is not None else ("", "bold")
    if status_of(result) == "errored":
        styles = (STYLES["errored"], "")
    return Text(" ").join(Text(text, style) for text, style in zip(details.sentences, styles, strict=False))


def _excerpt(details: Details, page: Page) -> Iterator[Text]:
    where = details.location
    source = page.report.submission.source(where.path) if where is not None else None
    if where is not None and source is not None and source.line(where.line).strip():
        yield excerpt_block(page.console, source, where, INDENT, is_underlined=not page.is_tight)


def _hint(failure: FailedCriterion, details: Details, page: Page) -> Iterator[Text]:
    """Yield the hint, without its edits if it is long; on a full page with the lines that change."""
    hint = details.hint
    if hint is None:
        return
    whole = block(page.console, Text(hint.message, "bold"), INDENT)
    is_long = not page.is_verbose and hint.cause and whole.plain.count("\n") + 1 >= _MAX_ROWS
    if is_long:
        short = hint_of(failure, hint._replace(message=f"Wrong: {hint.cause}. --verbose shows the edits."))
        whole = block(page.console, Text(short.message, "bold"), INDENT)
    yield whole
    for line in diff_lines(hint.edits, page.report.submission.source) if page.is_verbose else ():
        yield block(page.console, Text(line, _DIFF_STYLES.get(line[0], "dim")), 2 * INDENT)


def _reasons(details: Details, result: Result, page: Page) -> Iterator[Text]:
    """Yield the feedback where there is no hint, and what should be where the message does not say it.

    With room for it, both.
    """
    if details.feedback and details.feedback not in page.printed and (page.is_verbose or details.hint is None):
        yield Text(details.feedback, "italic")
    is_clear = result.outcome.expected is not None or (page.is_tight and bool(details.advice))
    if details.expected and (page.room is Room.EVERYTHING or not is_clear):
        yield Text(details.expected, "dim")


def _consequence(failure: FailedCriterion) -> Iterator[Text]:
    if failure.skipped:
        words = "criterion is" if len(failure.skipped) == 1 else "criteria are"
        points = points_of(failure.skipped)
        yield Text(f"{len(failure.skipped)} {words} skipped because of it ({points}).", "yellow")


def show_answer(result: Result, page: Page) -> None:
    """Print what needs manual grading, or has a manual mark, with the answer that was found and the model answer."""
    details, criterion = result_details(result, page.report), result.criterion
    name = ((printable(criterion.title), "bold"), (f"  {criterion.id}", "dim"))
    page.item(status_of(result), *name, f"  {earned_text(result)}")
    for text in details.words:
        page.inset(text)
    for title, lines in (("Found", details.answer), ("Model answer", details.model_answer)):
        if lines:
            page.inset(f"{title}:", "bold")
        for line in lines:
            page.inset(line, levels=2)


def show_criteria(group: CriteriaGroup, page: Page, *, has_title: bool) -> None:
    """Print the criteria of a group, a line for each."""
    if has_title:
        page.console.print()
        wrapped(page.console, Text.assemble((printable(group.title), "bold"), (f"  {group.points}", "dim")), 0)
    for result in group.results:
        start = Text.assemble("  ", page.mark(status_of(result)), f" {earned_text(result):<5} ")
        wrapped(page.console, _line(result), len(start), start)


def _line(result: Result) -> Text:
    """Return a criterion in a line: its title if it passed, else its name, because a title would read as a fact."""
    status = status_of(result)
    if status == "passed":
        return Text(printable(result.criterion.title))
    is_consequence = status == "skipped" and result.because is not None
    reason = f"  skipped because {printable(result.because or '')} failed" if is_consequence else ""
    return Text.assemble(printable(result.criterion.id), (reason, "dim"))
