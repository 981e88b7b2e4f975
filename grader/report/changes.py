"""The changes between two runs or gradebooks, on a terminal and as JSON."""

from collections.abc import Iterator, Sequence
from decimal import Decimal
from typing import Any

from rich.console import Console
from rich.text import Text

from grader.classroom.gradebook.changes import Change, PointsChange
from grader.classroom.gradebook.gradebook import Run
from grader.report.console import wrapped
from grader.report.json_data import exact, to_json
from grader.text import enumerated, format_points, printable, signed_points

_MAX_NAMED, _MAX_LINES = 3, 12


def render_changes(changes: Sequence[Change], runs: tuple[Run, Run], console: Console) -> None:
    """Print the two runs, whose grade changed, by how much, in which criteria, and why."""
    before, after = (f"run {run.id} of {run.started}" for run in runs)
    wrapped(console, Text(printable(f"From {before} to {after}"), style="dim"), 0)
    if not changes:
        wrapped(console, Text("nothing changed"), 0)
    for change in changes:
        wrapped(console, Text(printable(f"{change.key}: {_score(change)}"), style="bold"), 0)
        wrapped(console, Text(printable("; ".join(change.why) or "unknown reason: please report it")), 2)
        for line in _lines(change.steps):
            wrapped(console, Text(printable(line)), 4)


def render_changes_json(changes: Sequence[Change], runs: tuple[Run, Run]) -> str:
    """Return the changes as JSON, schema grader/diff/v1."""
    listed = [
        {
            "id": change.key,
            "before": exact(change.before),
            "after": exact(change.after),
            "because": list(change.why),
            "criteria": [
                {"id": step.criterion, "before": exact(step.before), "after": exact(step.after)}
                for step in change.steps
            ],
        }
        for change in changes
    ]
    before, after = map(_run, runs)
    return to_json({"schema": "grader/diff/v1", "from": before, "to": after, "students": listed})


def _run(run: Run) -> dict[str, Any]:
    return {"run": run.id, "started": run.started, "grader": {"version": run.version}, "rubric": {"sha256": run.rubric}}


def _score(change: Change) -> str:
    if change.steps or change.before is None or change.after is None:
        return _span(change.before, change.after)
    return f"{format_points(change.after)} as before, only the status changed"


def _lines(steps: Sequence[PointsChange]) -> Iterator[str]:
    """Yield a line for each criterion, or one for all with the same change if they are many, and how many more there are."""
    alike: dict[tuple[Decimal | None, Decimal | None], list[str]] = {}
    for step in steps:
        alike.setdefault((step.before, step.after), []).append(step.criterion)
    lines: list[tuple[str, int]] = []
    for span, names in alike.items():
        if len(names) <= _MAX_NAMED:
            lines += [(f"{name}: {_span(*span)}", 1) for name in names]
        else:
            lines.append((f"{enumerated(names, _MAX_NAMED)}: {_span(*span)} each", len(names)))
    yield from (line for line, _ in lines[:_MAX_LINES])
    if len(lines) > _MAX_LINES:
        yield f"... and {sum(count for _, count in lines[_MAX_LINES:])} more"


def _span(before: Decimal | None, after: Decimal | None) -> str:
    difference = "" if before is None or after is None else f" ({signed_points(after - before)})"
    return f"{_points(before)} to {_points(after)}{difference}"


def _points(points: Decimal | None) -> str:
    return "none" if points is None else format_points(points)
