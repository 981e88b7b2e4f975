"""What changed between two runs or gradebooks, for a person and for programs."""

from collections.abc import Iterator, Sequence
from decimal import Decimal
from typing import Any

from rich.console import Console
from rich.text import Text

from grader.classroom.gradebook.changes import Change, Step
from grader.classroom.gradebook.gradebook import Run
from grader.report.console import wrapped
from grader.report.json_data import exact, to_json
from grader.text import format_points, printable

_MOST_NAMED, _MOST_LINES = 3, 12


def render_changes(changes: Sequence[Change], runs: tuple[Run, Run], console: Console) -> None:
    """Print which runs are compared, who changed, by how much, in which criteria, and why."""
    before, after = (f"run {run.id} of {run.started}" for run in runs)
    wrapped(console, Text(printable(f"From {before} to {after}"), style="dim"), 0)
    if not changes:
        wrapped(console, Text("nothing changed"), 0)
    for change in changes:
        wrapped(console, Text(printable(f"{change.key}: {_score(change)}"), style="bold"), 0)
        wrapped(console, Text(printable("; ".join(change.why) or "nobody knows why: please report it")), 2)
        for line in _lines(change.steps):
            wrapped(console, Text(printable(line)), 4)


def render_changes_json(changes: Sequence[Change], runs: tuple[Run, Run]) -> str:
    """The same as JSON, schema grader/diff/v1."""
    listed = [
        {
            "id": change.key,
            "before": _number(change.before),
            "after": _number(change.after),
            "because": list(change.why),
            "criteria": [
                {"id": step.criterion, "before": _number(step.before), "after": _number(step.after)}
                for step in change.steps
            ],
        }
        for change in changes
    ]
    before, after = (_run(run) for run in runs)
    return to_json({"schema": "grader/diff/v1", "from": before, "to": after, "students": listed})


def _run(run: Run) -> dict[str, Any]:
    return {"run": run.id, "started": run.started, "grader": {"version": run.version}, "rubric": {"sha256": run.rubric}}


def _score(change: Change) -> str:
    if change.steps or change.before is None or change.after is None:
        return _span(change.before, change.after)
    return f"{_words(change.after)} as before, only the verdict changed"


def _lines(steps: Sequence[Step]) -> Iterator[str]:
    """A line for each criterion, one for those that took the same step if they are many, and an end."""
    alike: dict[tuple[Decimal | None, Decimal | None], list[str]] = {}
    for step in steps:
        alike.setdefault((step.before, step.after), []).append(step.criterion)
    lines: list[tuple[str, int]] = []
    for span, names in alike.items():
        if len(names) <= _MOST_NAMED:
            lines += [(f"{name}: {_span(*span)}", 1) for name in names]
        else:
            more = len(names) - _MOST_NAMED
            lines.append((f"{', '.join(names[:_MOST_NAMED])} and {more} more: {_span(*span)} each", len(names)))
    yield from (line for line, _ in lines[:_MOST_LINES])
    if len(lines) > _MOST_LINES:
        yield f"... and {sum(count for _, count in lines[_MOST_LINES:])} more"


def _span(before: Decimal | None, after: Decimal | None) -> str:
    off = "" if before is None or after is None else f" ({_signed(after - before)})"
    return f"{_words(before)} to {_words(after)}{off}"


def _signed(points: Decimal) -> str:
    return f"{'+' if points >= 0 else '-'}{format_points(abs(points))}"


def _words(points: Decimal | None) -> str:
    return "none" if points is None else format_points(points)


def _number(points: Decimal | None) -> int | float | None:
    return None if points is None else exact(points)
