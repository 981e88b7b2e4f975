"""What has changed since a submission was graded the last time: two reports in, plain lines out."""

from collections.abc import Iterator, Sequence
from decimal import Decimal

from grader.grading.report import Report, Result
from grader.report.points import points_words
from grader.text import printable

_STATUSES = {
    "passed": "now passed",
    "failed": "now failed",
    "skipped": "now skipped",
    "pending": "now waiting for a person",
    "errored": "now errored",
}
_MOST_NAMED = 8
Step = tuple[str, Decimal]  # a criterion, and by how much its points have changed


def lines_since(before: Report, after: Report) -> list[str]:
    """The score first, then which criteria have another status, other points, or another message than before."""
    rows = list(_rows(before, after))
    score = _score(before, after)
    if not rows:
        return [f"{score}; only the rest of the report has changed"]
    return [score, *(f"{words}: {_named(steps)}" for words, steps in rows)]


def nothing_since(report: Report) -> str:
    """What to say where a report is what it was."""
    return f"nothing has changed: {_of(report)} points"


def _rows(before: Report, after: Report) -> Iterator[tuple[str, Sequence[Step]]]:
    """What has become of criteria, and of which: those that pass now first."""
    old = {each.criterion.id: each for each in before.results}
    new = {each.criterion.id: each for each in after.results}
    found: dict[str, list[Step]] = {words: [] for words in _STATUSES.values()}
    for name, result in new.items():
        words = _step(old.get(name), result)
        if words is not None:
            was = old[name].points if name in old else Decimal(0)
            found.setdefault(words, []).append((name, result.points - was))
    gone = [(name, -result.points) for name, result in old.items() if name not in new]
    yield from ((words, steps) for words, steps in [*found.items(), ("no longer asked", gone)] if steps)


def _step(old: Result | None, new: Result) -> str | None:
    """What has become of a criterion, if anything has."""
    if old is None or old.outcome.status != new.outcome.status:
        return _STATUSES[new.outcome.status]
    if (old.points, old.criterion.points) != (new.points, new.criterion.points):
        return "worth something else"
    says_so = new.outcome.status != "passed" and old.outcome.message != new.outcome.message
    return "with another message" if says_so else None


def _score(before: Report, after: Report) -> str:
    if (before.score, before.max_score) == (after.score, after.max_score):
        return f"{_of(after)} points, as before"
    was = points_words(before.score) if before.max_score == after.max_score else _of(before)
    return f"{was} -> {_of(after)} points{_change(after.score - before.score)}"


def _of(report: Report) -> str:
    return f"{points_words(report.score)} of {points_words(report.max_score)}"


def _named(steps: Sequence[Step]) -> str:
    """The criteria by their names with what they bring or cost; of many the first, and how many more there are."""
    shown = [f"{printable(name)}{_change(points)}" for name, points in steps[:_MOST_NAMED]]
    rest = steps[_MOST_NAMED:]
    if rest:
        shown.append(f"and {len(rest)} more{_change(sum((points for _, points in rest), Decimal(0)))}")
    return ", ".join(shown)


def _change(points: Decimal) -> str:
    return f" ({'+' if points > 0 else '-'}{points_words(abs(points))})" if points else ""
