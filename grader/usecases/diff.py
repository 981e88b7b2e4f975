"""Compare two runs of a gradebook, or two gradebooks."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from decimal import Decimal
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.text import Text

from grader.classroom.gradebook.changes import Change, PointsChange, changes, last_two, newest
from grader.classroom.gradebook.gradebook import Gradebook, Run
from grader.errors import GraderError
from grader.report.console import wrapped
from grader.report.formats import OutputFormat
from grader.report.json_data import exact, to_json
from grader.report.screen import Screen, draw
from grader.text import enumerated, format_points, printable, signed_points

_MAX_NAMED, _MAX_LINES = 3, 12


def diff(
    gradebook: Path, other: Path | None, before: int | None, after: int | None, kind: OutputFormat, screen: Screen
) -> str:
    """Return whose grade changed between two runs, by how much, and why. Raises GraderError."""
    if other is not None and (before or after):
        raise GraderError("--from and --to choose runs of one gradebook: give one gradebook, or omit them")
    with ExitStack() as opened:
        book = opened.enter_context(Gradebook(gradebook))
        if other is None:
            sides = last_two(book, before, after)
        else:
            sides = newest(book), newest(opened.enter_context(Gradebook(other)))
        found = changes(*sides)
        runs = sides[0].newest_run, sides[1].newest_run
    if kind is OutputFormat.JSON:
        return _changes_json(found, runs)
    return draw(partial(_render_changes, found, runs), screen)


def _render_changes(changes: Sequence[Change], runs: tuple[Run, Run], console: Console) -> None:
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


def _changes_json(changes: Sequence[Change], runs: tuple[Run, Run]) -> str:
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
