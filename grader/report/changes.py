"""What changed between two runs or gradebooks, for a person and for programs."""

from collections.abc import Sequence
from decimal import Decimal
from typing import Any

from rich.console import Console
from rich.text import Text

from grader.classroom.changes import Change, Step
from grader.classroom.gradebook import Run
from grader.report.layout import wrapped
from grader.report.plain import exact, to_json
from grader.report.points import points_words
from grader.report.text import printable


def render_changes(changes: Sequence[Change], runs: tuple[Run, Run], console: Console) -> None:
    """Print which runs are compared, who changed, by how much, in which criteria, and why."""
    before, after = (f"run {run.id} of {run.started}" for run in runs)
    wrapped(console, Text(printable(f"From {before} to {after}"), style="dim"), 0)
    if not changes:
        wrapped(console, Text("nothing changed"), 0)
    for change in changes:
        wrapped(console, Text(printable(f"{change.key}: {_span(change.before, change.after)}"), style="bold"), 0)
        wrapped(console, Text(printable("; ".join(change.why) or "nobody knows why: please report it")), 2)
        for step in change.steps:
            wrapped(console, Text(printable(_step(step))), 4)


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


def _step(step: Step) -> str:
    return f"{step.criterion}: {_span(step.before, step.after)}"


def _span(before: Decimal | None, after: Decimal | None) -> str:
    off = "" if before is None or after is None else f" ({_signed(after - before)})"
    return f"{_words(before)} to {_words(after)}{off}"


def _signed(points: Decimal) -> str:
    return f"{'+' if points >= 0 else '-'}{points_words(abs(points))}"


def _words(points: Decimal | None) -> str:
    return "none" if points is None else points_words(points)


def _number(points: Decimal | None) -> int | float | None:
    return None if points is None else exact(points)
