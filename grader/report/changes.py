"""The changes between two runs or gradebooks, on a terminal and as JSON."""

from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from operator import itemgetter
from typing import Any

from rich.console import Console
from rich.text import Text

from grader.classroom.gradebook.changes import Change, PointsChange
from grader.classroom.gradebook.gradebook import Run
from grader.classroom.lateness import time_text
from grader.grading.criterion import Adjustment
from grader.grading.rubric_changes import RubricChange
from grader.report.console import wrapped
from grader.report.examples import toml_text
from grader.report.json_data import (
    COUNT,
    GRADER,
    HASH,
    POINTS,
    TEXT,
    VALUE,
    Many,
    Record,
    array,
    each,
    exact,
    nullable,
    record,
    rounded,
    schema_key,
    to_json,
)
from grader.report.order import alike
from grader.text import counted, enumerated, format_points, named, printable, signed_points

_MAX_NAMED, _MAX_LINES = 3, 12
Steps = tuple[PointsChange, ...]


def _plain(value: Any) -> Any:
    """Return a value of a rubric as JSON has it."""
    match value:
        case Decimal():
            return exact(value)
        case Adjustment():
            return value._asdict()
        case Mapping():
            return {key: _plain(item) for key, item in value.items()}
        case tuple() | list():
            return [_plain(item) for item in value]
        case None | bool() | int() | float() | str():
            return rounded(value)
    return str(value)


_RUN = Record(
    {
        "run": (COUNT, "id"),
        "started": TEXT,
        "grader": (GRADER, lambda run: {"version": run.version}),
        "rubric": (record({"sha256": HASH}), lambda run: {"sha256": run.rubric}),
    }
)
_SPAN = each(nullable(POINTS), "before after")
_STEP = Record({"id": (TEXT, "criterion"), **_SPAN})
_RUBRIC_CHANGE = Record(
    {
        "id": (TEXT, "criterion"),
        "key": TEXT,
        "before": (VALUE, lambda change: _plain(change.before)),
        "after": (VALUE, lambda change: _plain(change.after)),
    }
)
_CHANGE = Record(
    {
        "id": (TEXT, "key"),
        "name": TEXT,
        **_SPAN,
        "reasons": (array(TEXT), "why"),
        "criteria": (Many(_STEP), "steps"),
        "rubric": Many(_RUBRIC_CHANGE),
    }
)
DIFF = Record(  # of the two runs, and the changes
    {
        **schema_key("grader/diff/v1"),
        "from": (_RUN, itemgetter(0)),
        "to": (_RUN, itemgetter(1)),
        "students": (Many(_CHANGE), itemgetter(2)),
    }
)


def render_changes(changes: Sequence[Change], runs: tuple[Run, Run], console: Console) -> None:
    """Print the two runs, and whose grade changed, by how much, in which criteria, and why.

    Students with the same reason are listed together.
    """
    before, after = (f"run {run.id} of {time_text(run.started)}" for run in runs)
    wrapped(console, Text(printable(f"From {before} to {after}"), style="dim"), 0)
    if not changes:
        wrapped(console, Text("nothing changed"), 0)
    for (reason, *details), found in sorted(alike(changes, _reason), key=_size):
        console.print()
        wrapped(console, Text(printable(f"{reason} ({counted(len(found), 'student')})"), style="bold"), 0)
        for line in details:
            wrapped(console, Text(printable(line)), 2)
        regraded = [change for change in found if change.is_regraded]
        for steps, some in sorted(alike(regraded, lambda change: change.steps), key=_size):
            _show_students(steps, some, console)
        if same := len(found) - len(regraded):
            wrapped(console, Text(f"{counted(same, 'student')} with the same grade, but other points of criteria"), 2)


def _reason(change: Change) -> tuple[str, ...]:
    """Return why a grade changed, and a line for each change of the rubric that concerns it."""
    return "; ".join(change.why) or "unknown reason: please report it", *map(_rubric_line, change.rubric)


def _size(group: tuple[Any, Sequence[Change]]) -> int:
    """Return the key by which the largest group is first; groups of one size are in the order of their students."""
    return -len(group[1])


def _show_students(steps: Steps, changes: Sequence[Change], console: Console) -> None:
    """Print students with the same changes: for one student the name first, for several the changes first."""
    lines = [Text(printable(line)) for line in _lines(steps)]
    totals = [f"{named(change.key, change.name)}: {_total(change)}" for change in changes]
    students = [Text(printable(total), style="bold") for total in totals]
    first, then = (students, lines) if len(changes) == 1 or not steps else (lines, students)
    for text in first:
        wrapped(console, text, 2)
    for text in then:
        wrapped(console, text, 4)


def render_changes_json(changes: Sequence[Change], runs: tuple[Run, Run]) -> str:
    """Return the changes as JSON, schema grader/diff/v1."""
    return to_json(DIFF.data((*runs, changes)))


def _rubric_line(change: RubricChange) -> str:
    """Return what changed in the rubric: box: points 2.5 to 3."""
    name, key, before, after = change
    about = f"{name}: " if name else "rubric: "
    match key:
        case "criterion":
            return about + ("added" if before is None else "removed")
        case "adjust":
            return about + (after.message if isinstance(after, Adjustment) else "no longer adjusted")
        case "bonus":
            return about + ("now extra credit" if after else "no longer extra credit")
    return f"{about}{key} {_value(before)} to {_value(after)}"


def _value(value: object) -> str:
    if isinstance(value, Decimal):
        return format_points(value)
    return "none" if value is None else toml_text(value)


def _total(change: Change) -> str:
    """Return the totals before and after."""
    if change.before != change.after or change.before is None:
        return _span(change.before, change.after)
    return f"{format_points(change.before)} as before"


def _lines(steps: Sequence[PointsChange]) -> Iterator[str]:
    """Yield a line for each criterion, or one for many with the same change, and how many more there are."""
    lines: list[tuple[str, int]] = []
    for span, some in alike(steps, lambda step: (step.before, step.after)):
        names = [step.criterion for step in some]
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
