"""A report as one HTML page for the student: the score, failures with hints, the robot, and everything else."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

from grader.drawing.picture import picture_of
from grader.grading.report import Report, Result
from grader.report import content
from grader.report.details import STATUS_WORDS, SYMBOLS, Details, result_details, skipped_text
from grader.report.drawing_words import why_no_picture
from grader.report.locations import SourceLine, diff_lines, location_text, source_lines
from grader.report.order import (
    CriteriaGroup,
    FailedCriterion,
    alike,
    earned_text,
    failures,
    groups,
    in_order,
    status_of,
)
from grader.report.pages.robot import render_robot_page
from grader.text import format_points, printable


class Card(NamedTuple):
    """The content of a criterion: `points` or what it costs, and `diff` has the changed lines of its hint.

    `cause` is equal for criteria that the same edit fixes, or that could not be graded for the same reason. `feedback`
    is the rubric's advice, and `skipped` what is skipped because of it. `also` are the others with the same cause.
    """

    result: Result
    points: str
    details: Details
    source: list[SourceLine]
    diff: list[str]
    cause: str
    skipped: str = ""
    feedback: str = ""
    also: "Sequence[Card]" = ()

    def addresses(self) -> Iterator[tuple[str, str]]:
        """Yield the criteria of the card, each with the criterion whose card shows it."""
        for card in (self, *self.also):
            shown = card if self.details.hint is not None else self
            yield card.result.criterion.id, shown.result.criterion.id


class Share(NamedTuple):
    """A part of the bar from `start` with a `width`, in percent of the maximum, and what it means."""

    name: str
    start: float
    width: float
    words: str


def render_html(report: Report) -> str:
    """Return the report as a page. Model answers are on it only if the rubric was loaded with them."""
    picture = picture_of(report)
    callouts = [callout for callout in picture.callouts if callout.point is not None] if picture is not None else []
    called = {result.criterion.id: callout.number for callout in callouts for result in callout.results}
    costly = [called[failure.id] for failure in failures(report) if failure.id in called]
    values = {**_summary(report), **_criteria(report), **_others(report), "called": called}
    return render_robot_page("student.html", values, picture, {"costly": costly}, "failures.js", "student.js")


def _summary(report: Report) -> dict[str, object]:
    command = content.next_command(report)
    return {
        "version": report.version,
        "title": printable(f"{content.score_text(report)}: {report.rubric.title} ({report.submission.id})"),
        "heading": report.rubric.title,
        "score": content.counting_text(report),
        "maximum": format_points(report.max_score) if report.counting is not None else "",
        "shares": [*_shares(report)],
        "summary": content.summaries(report),
        "pending": content.pending_points(report) if report.open_points else "",
        "notes": content.notes(report),
        "next": command,
        "left": "" if command else content.what_is_left(report),
        "provenance": content.provenance(report),
    }


def _shares(report: Report) -> Iterator[Share]:
    """Yield what is earned, needs manual grading, and is lost; nothing for an excused student."""
    whole, earned, start = report.max_score, report.counting, 0.0
    if not whole or earned is None:
        return
    lost = whole - earned - report.open_points
    names = ("earned", "Earned"), ("pending", "Needs manual grading"), ("lost", "Lost")
    for (name, words), points in zip(names, (earned, report.open_points, lost), strict=True):
        width = min(round(float(100 * points / whole), 2), 100.0 - start)
        if points > 0:
            yield Share(name, start, width, f"{words}: {format_points(points)}")
            start += width


def _criteria(report: Report) -> dict[str, object]:
    order, printed = in_order(report), set[str]()
    skipped = alike(order.skipped, lambda result: result.because or "")
    by_part = groupby(groups(report), key=lambda group: group.part)
    failed = [*_joined(_failure_card(failure, report, printed) for failure in order.failures)]
    sections = [(title, [*_joined(_card(result, report) for result in some)]) for title, some in order.sections]
    cards = [card for some in (failed, *(some for _, some in sections)) for card in some]
    return {
        "symbols": SYMBOLS,
        "status_words": STATUS_WORDS,
        "status_of": status_of,
        "earned_text": earned_text,
        "location_text": location_text,
        "failures": failed,
        "skipped": [skipped_text(cause, some) for cause, some in skipped],
        "sections": sections,
        "cards": dict(item for card in cards for item in card.addresses()),
        "parts": [_part(report.rubric.part(part).title, [*some]) for part, some in by_part],
    }


def _part(title: str, some: list[CriteriaGroup]) -> tuple[str, str, list[CriteriaGroup]]:
    return title, earned_text(*(result for group in some for result in group.results)), some


def _failure_card(failure: FailedCriterion, report: Report, printed: set[str]) -> Card:
    """Return a failed criterion, with what is skipped because of it, and feedback once, only without hints."""
    card = _card(failure.result, report)
    feedback = "" if card.details.hint is not None or card.details.feedback in printed else card.details.feedback
    printed.add(feedback)
    skipped = skipped_text(failure.id, failure.skipped) if failure.skipped else ""
    cause = failure.first or card.cause
    return card._replace(points=failure.cost, cause=cause, skipped=skipped, feedback=feedback)


def _joined(cards: Iterable[Card]) -> Iterator[Card]:
    """Yield the first card of each cause, with the others; all of them where the first one does not show the edit."""
    for cause, (first, *others) in alike(cards, lambda card: card.cause):
        if first.details.hint is None and cause == first.result.criterion.id:
            yield from (first, *others)
        else:
            also = [card._replace(details=card.details._replace(hint=None)) for card in others]
            yield first._replace(also=also)


def _card(result: Result, report: Report) -> Card:
    details, source_of = result_details(result, report), report.submission.source
    where = details.location
    lines = source_lines(where, source_of) if where is not None else []
    diff = diff_lines(details.hint.edits, source_of) if details.hint is not None else []
    is_ungraded = status_of(result) in ("pending", "errored") and not (details.answer or details.comment)
    cause = result.outcome.mistake or result.outcome.message if is_ungraded else result.criterion.id
    return Card(result, earned_text(result), details, lines, diff, cause)


def _others(report: Report) -> dict[str, object]:
    problems = content.other_problems(report)
    return {
        "no_picture": why_no_picture(report),
        "evidence": [*content.evidence(report)],
        "problems_title": content.other_problems_title(report),
        "problems": [(problem.severity, content.problem_line(problem)) for problem in problems],
        "ignored": content.ignored_lines(report),
    }
