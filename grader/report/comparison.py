"""The changes of a report since the submission was last graded, as plain lines."""

from collections.abc import Iterator, Sequence
from decimal import Decimal

from grader.grading.report import Report, Result
from grader.text import format_points, printable, signed_points

_STATUSES = {
    "passed": "now passed",
    "failed": "now failed",
    "skipped": "now skipped",
    "pending": "now needs manual grading",
    "errored": "now errored",
}
_MAX_NAMED = 8
PointsChange = tuple[str, Decimal]  # a criterion, and the change of its points


def comparison_lines(before: Report, after: Report) -> list[str]:
    """Return the score, then the criteria whose status, points or message changed."""
    rows = list(_rows(before, after))
    score = _score(before, after)
    if not rows:
        return [f"{score}; only other parts of the report changed"]
    return [score, *(f"{change}: {_criteria_text(criteria)}" for change, criteria in rows)]


def unchanged_line(report: Report) -> str:
    """Return the line for a report that is the same as before."""
    return f"nothing has changed: {_of(report)} points"


def _rows(before: Report, after: Report) -> Iterator[tuple[str, Sequence[PointsChange]]]:
    """Yield each kind of change with its criteria, those that pass now first."""
    old = {result.criterion.id: result for result in before.results}
    new = {result.criterion.id: result for result in after.results}
    found: dict[str, list[PointsChange]] = {change: [] for change in _STATUSES.values()}
    for name, result in new.items():
        change = _change(old.get(name), result)
        if change is not None:
            was = old[name].points if name in old else Decimal(0)
            found.setdefault(change, []).append((name, result.points - was))
    removed = [(name, -result.points) for name, result in old.items() if name not in new]
    yield from ((change, criteria) for change, criteria in [*found.items(), ("removed", removed)] if criteria)


def _change(old: Result | None, new: Result) -> str | None:
    """Return how a criterion changed, None if it did not."""
    if old is None or (old.outcome.status != new.outcome.status and not new.is_adjusted):
        return _STATUSES[new.outcome.status]
    if (old.points, old.criterion.points) != (new.points, new.criterion.points):
        return "with other points"
    has_message = new.outcome.status != "passed" and old.outcome.message != new.outcome.message
    return "with another message" if has_message else None


def _score(before: Report, after: Report) -> str:
    if (before.score, before.max_score) == (after.score, after.max_score):
        return f"{_of(after)} points, as before"
    was = format_points(before.score) if before.max_score == after.max_score else _of(before)
    return f"{was} -> {_of(after)} points{_in_brackets(after.score - before.score)}"


def _of(report: Report) -> str:
    return f"{format_points(report.score)} of {format_points(report.max_score)}"


def _criteria_text(criteria: Sequence[PointsChange]) -> str:
    """Return the criteria with the change of their points; of many the first, and how many more there are."""
    named = [f"{printable(name)}{_in_brackets(points)}" for name, points in criteria[:_MAX_NAMED]]
    rest = criteria[_MAX_NAMED:]
    if rest:
        named.append(f"and {len(rest)} more{_in_brackets(sum((points for _, points in rest), Decimal(0)))}")
    return ", ".join(named)


def _in_brackets(points: Decimal) -> str:
    return f" ({signed_points(points)})" if points else ""
