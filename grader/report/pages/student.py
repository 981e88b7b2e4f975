"""A report as one HTML page for the student: the score, failures with hints, the robot, and everything else."""

from decimal import Decimal
from itertools import groupby
from typing import NamedTuple

from grader.drawing.picture import picture_of
from grader.grading.report import Report, Result
from grader.report import content
from grader.report.details import SYMBOLS, Details, result_details, skipped_text
from grader.report.drawing_key import why_no_picture
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

    `feedback` is the rubric's advice, and `skipped` what is skipped because of it.
    """

    result: Result
    points: str
    details: Details
    source: list[SourceLine]
    diff: list[str]
    skipped: str = ""
    feedback: str = ""


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
        "title": f"{content.score_text(report)}: {printable(report.rubric.title)}",
        "heading": report.rubric.title,
        "score": content.counting_text(report),
        "maximum": format_points(report.max_score) if report.counting is not None else "",
        "shares": _shares(report),
        "summary": content.summaries(report),
        "pending": content.pending_line(report),
        "notes": content.notes(report),
        "next": command,
        "left": "" if command else content.what_is_left(report),
        "provenance": content.provenance(report),
    }


def _shares(report: Report) -> tuple[float, float]:
    """Return the percentages of the maximum that are earned, and that are earned or need manual grading."""
    whole, counting = report.max_score or Decimal(1), report.counting or Decimal(0)
    earned, possible = (float(100 * points / whole) for points in (counting, counting + report.open_points))
    return min(100, round(earned, 2)), min(100, round(possible, 2))


def _criteria(report: Report) -> dict[str, object]:
    order, printed = in_order(report), set[str]()
    skipped = alike(order.skipped, lambda result: result.because or "")
    by_part = groupby(groups(report), key=lambda group: group.part)
    results = (*(failure.result for failure in order.failures), *order.pending, *order.marked)
    return {
        "symbols": SYMBOLS,
        "status_of": status_of,
        "earned_text": earned_text,
        "location_text": location_text,
        "failures": [_failure_card(failure, report, printed) for failure in order.failures],
        "skipped": [skipped_text(cause, some) for cause, some in skipped],
        "sections": [(title, [_card(result, report) for result in some]) for title, some in order.sections],
        "cards": {result.criterion.id for result in results},  # that others refer to
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
    return card._replace(points=failure.cost, skipped=skipped, feedback=feedback)


def _card(result: Result, report: Report) -> Card:
    details, source_of = result_details(result, report), report.submission.source
    where = details.location
    lines = source_lines(where, source_of) if where is not None else []
    diff = diff_lines(details.hint.edits, source_of) if details.hint is not None else []
    return Card(result, earned_text(result), details, lines, diff)


def _others(report: Report) -> dict[str, object]:
    problems = content.other_problems(report)
    return {
        "no_picture": why_no_picture(report),
        "evidence": [*content.evidence(report)],
        "problems_title": content.other_problems_title(report),
        "problems": [(problem.severity, content.problem_line(problem)) for problem in problems],
        "ignored": content.ignored_lines(report),
    }
