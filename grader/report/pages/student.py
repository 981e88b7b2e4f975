"""A report as one HTML page for the student: the score, failures with hints, the robot, and everything else."""

from collections.abc import Collection, Iterator
from decimal import Decimal
from itertools import groupby
from typing import NamedTuple

from grader.drawing.picture import picture_of
from grader.grading.report import Report, Result
from grader.report import content
from grader.report.details import SYMBOLS, skipped_text
from grader.report.order import alike, earned_text, failures, groups, in_order, status_of
from grader.report.pages.criteria import card_of, failure_card
from grader.report.pages.robot import RULES, SCRIPTS, STYLE, robot_view, views
from grader.report.pages.shell import render_page
from grader.text import format_points, printable


class Row(NamedTuple):
    """A criterion in the list of all criteria. `title` is empty unless it passed.

    `card` is the criterion with the card for it: itself, or the one that it is skipped because of; empty if neither has one.
    """

    id: str
    title: str
    status: str
    points: str
    because: str
    card: str


class Rows(NamedTuple):
    """A group of criteria, with the sum of their points."""

    title: str
    points: str
    rows: tuple[Row, ...]
    status: str


def render_html(report: Report) -> str:
    """Return the report as a page. Model answers are on it only if the rubric was loaded with them."""
    picture = picture_of(report)
    callouts = picture.callouts if picture is not None else ()
    placed = [callout for callout in callouts if callout.point is not None]
    called = {result.criterion.id: callout.number for callout in placed for result in callout.results}
    values = {**_summary(report), **_criteria(report), **_others(report), "called": called}
    if picture is None:
        values |= {"robot": None, "views": "", "no_picture": content.why_no_picture(report)}
        return render_page("student.html", values, {}, f"{STYLE} student.css", "student.js")
    robot = robot_view(picture)
    values |= {"robot": robot, "views": views(picture)}
    costly = [called[one.result.criterion.id] for one in failures(report) if one.result.criterion.id in called]
    data = {**robot.data, "costly": costly}
    return render_page(
        "student.html", values, data, f"{STYLE} student.css", f"{SCRIPTS} failures.js student.js", rules=RULES
    )


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


def _criteria(report: Report) -> dict[str, object]:
    order, shown = in_order(report), set[str]()
    skipped = alike(order.skipped, lambda result: result.because or "")
    cards = {result.criterion.id for result in (*(one.result for one in order.failures), *order.pending, *order.marked)}
    return {
        "symbols": SYMBOLS,
        "failures": [failure_card(failure, report, shown) for failure in order.failures],
        "skipped": [skipped_text(cause, some) for cause, some in skipped],
        "sections": [
            (title, [card_of(result, report) for result in results])
            for title, results in (("Needs manual grading", order.pending), *order.remarks)
            if results
        ],
        "parts": [*_parts(report, cards)],
    }


def _others(report: Report) -> dict[str, object]:
    return {
        "evidence": [*content.evidence(report)],
        "problems_title": content.other_problems_title(report),
        "problems": [(problem.severity, content.problem_line(problem)) for problem in content.other_problems(report)],
        "ignored": content.ignored_lines(report),
    }


def _shares(report: Report) -> tuple[float, float]:
    """Return the percentages of the maximum that are earned, and that are earned or need manual grading."""
    whole = report.max_score or Decimal(1)
    counting = report.counting or Decimal(0)
    earned, possible = (float(100 * points / whole) for points in (counting, counting + report.open_points))
    return min(100, round(earned, 2)), min(100, round(possible, 2))


def _parts(report: Report, cards: Collection[str]) -> Iterator[tuple[str, str, list[Rows]]]:
    """Yield the title, the points and the groups of each part."""
    titles = {part.id: part.title for part in report.rubric.parts}
    for part, found in groupby(groups(report), key=lambda group: group.part):
        some = [*found]
        rows = [
            Rows(
                group.title,
                group.points,
                tuple(_row(result, cards) for result in group.results),
                group.status,
            )
            for group in some
        ]
        yield titles[part], earned_text(*(result for group in some for result in group.results)), rows


def _row(result: Result, cards: Collection[str]) -> Row:
    status = status_of(result)
    title = result.criterion.title if status == "passed" else ""
    because = (result.because or "") if result.manual_mark is None and not result.is_adjusted else ""
    card = next((name for name in (result.criterion.id, because) if name in cards), "")
    return Row(result.criterion.id, title, status, earned_text(result), because, card)
