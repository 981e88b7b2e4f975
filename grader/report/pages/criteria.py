"""The content of one criterion on a page: what is wrong, where, what to do. All of it is text, which the template escapes."""

from typing import NamedTuple

from grader.grading.report import Report, Result
from grader.report.details import Details, result_details, skipped_text
from grader.report.locations import diff_lines, excerpt, location_text, width_of
from grader.report.order import Failure, earned_text, status_of
from grader.source import Location, Source
from grader.text import printable

_AROUND = 2  # lines of the source before and after the marked one
_MAX_WIDTH = 160  # characters of a line


class SourceLines(NamedTuple):
    """The lines of a file around a location, each with its number; one line has a marked part."""

    before: tuple[tuple[int, str], ...]
    number: int
    start: str
    meant: str
    end: str
    after: tuple[tuple[int, str], ...]


class Change(NamedTuple):
    """A hint: a sentence, and the lines of its diff if the hint level shows them."""

    message: str
    lines: tuple[str, ...]


class Card(NamedTuple):
    """The content of a criterion. `cost` is empty unless it lost points; `feedback` is the rubric's advice."""

    id: str
    title: str
    status: str
    cost: str
    points: str
    details: Details
    where: str
    source: SourceLines | None
    changes: tuple[Change, ...]
    skipped: str = ""
    feedback: str = ""


def failure_card(failure: Failure, report: Report, shown: set[str]) -> Card:
    """Return a failed criterion, with what is skipped because of it. Feedback is included once, and only without hints."""
    result, skipped, *_ = failure
    card = card_of(result, report)
    feedback = "" if card.details.hints or card.details.feedback in shown else card.details.feedback
    shown.add(feedback)
    return card._replace(
        cost=failure.cost,
        skipped=skipped_text(result.criterion.id, skipped) if skipped else "",
        feedback=feedback,
    )


def card_of(result: Result, report: Report) -> Card:
    """Return a criterion of any status."""
    details = result_details(result, report)
    criterion, where = result.criterion, details.location
    source = report.submission.source(where.path) if where is not None else None
    return Card(
        criterion.id,
        criterion.title,
        status_of(result),
        "",
        earned_text(result),
        details,
        location_text(where) if where is not None else "",
        source_lines(source, where) if where is not None and source is not None else None,
        tuple(Change(hint.message, tuple(diff_lines(hint.edits, report.submission.source))) for hint in details.hints),
    )


def source_lines(source: Source, where: Location) -> SourceLines | None:
    """Return the lines around a location, without their common indentation; None if its line is empty.

    For a very long line, it returns the part around the marked text.
    """
    line = source.line(where.line)
    if not line.strip():
        return None
    if len(line) > _MAX_WIDTH:
        cut = excerpt(source, where, _MAX_WIDTH)
        middle = cut.start + cut.width
        return SourceLines((), where.line, cut.text[: cut.start], cut.text[cut.start : middle], cut.text[middle:], ())
    around = {number: source.line(number) for number in range(max(1, where.line - _AROUND), where.line + _AROUND + 1)}
    indent = min(len(text) - len(text.lstrip()) for text in around.values() if text.strip())
    start = where.column - 1
    end = start + width_of(line, where.column)
    shown = tuple((number, printable(text[indent:][:_MAX_WIDTH])) for number, text in around.items())
    last = max((number for number, text in around.items() if text.strip()), default=where.line)
    return SourceLines(
        tuple(pair for pair in shown if pair[0] < where.line),
        where.line,
        line[min(indent, start) : start],
        line[start:end],
        line[end:],
        tuple(pair for pair in shown if where.line < pair[0] <= last),
    )
