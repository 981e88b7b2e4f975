"""A report as one HTML page for the student: the score, failures with hints, the robot, and everything else."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

from grader.drawing.picture import picture_of
from grader.grading.report import Report
from grader.report import content
from grader.report.criteria import CriteriaGroup, Entry, earned_text, groups, status_of
from grader.report.details import STATUS_WORDS, SYMBOLS
from grader.report.document import document
from grader.report.drawing import why_no_picture
from grader.report.locations import diff_lines, location_text, source_lines
from grader.report.pages.robot import render_robot_page
from grader.text import format_points, printable


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
    sections = [part._replace(entries=tuple(_nested(part.entries))) for part in document(report).sections]
    by_part = groupby(groups(report), key=lambda group: group.part)
    values = {
        "version": report.version,
        "title": printable(f"{content.score_text(report)}: {report.rubric.title} ({report.submission.id})"),
        "report": report,
        "content": content,
        "maximum": format_points(report.max_score) if report.counting is not None else "",
        "shares": [*_shares(report)],
        "symbols": SYMBOLS,
        "status_words": STATUS_WORDS,
        "status_of": status_of,
        "earned_text": earned_text,
        "location_text": location_text,
        "diff_lines": diff_lines,
        "source_lines": source_lines,
        "kind_of": lambda block: type(block).__name__,
        "called": called,
        "sections": sections,
        "cards": dict(item for section in sections for entry in section.entries for item in _addresses(entry)),
        "parts": [_part(report.rubric.part(part).title, [*some]) for part, some in by_part],
        "no_picture": why_no_picture(report),
    }
    return render_robot_page("student.html", values, picture, "student.js")


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


def _part(title: str, some: list[CriteriaGroup]) -> tuple[str, str, list[CriteriaGroup]]:
    return title, earned_text(*(result for group in some for result in group.results)), some


def _nested(entries: Sequence[Entry]) -> Iterator[Entry]:
    """Yield the entries, those that one edit fixes inside the one that shows it."""
    shown = {entry.id for entry in entries if entry.texts("hint") and not entry.first}
    for entry in entries:
        others = tuple(one for one in entries if one.first == entry.id in shown)
        if entry.first not in shown:
            yield entry if entry.texts("alike") else entry._replace(also=others)


def _addresses(entry: Entry) -> Iterator[tuple[str, str]]:
    """Yield the criteria of a card, each with the criterion whose card shows it."""
    for one in (entry, *entry.also):
        yield one.id, one.id if one.first else entry.id
