"""The changes between two runs or gradebooks, on a terminal and as JSON."""

from collections.abc import Iterator, Sequence
from decimal import Decimal
from operator import itemgetter

from rich.console import Console
from rich.text import Text

from grader.classroom.changes import Change, PointsChange
from grader.classroom.graded import Run
from grader.classroom.lateness import time_text
from grader.report.console import wrapped
from grader.report.json_data import (
    COUNT,
    GRADER,
    HASH,
    POINTS,
    TEXT,
    Many,
    Record,
    array,
    each,
    nullable,
    record,
    schema_key,
    to_json,
)
from grader.report.order import alike
from grader.text import counted, enumerated, first_lines, format_points, named, printable, signed_points

_MAX_NAMED, _MAX_LINES = 3, 12
_RUN = Record(
    {
        "run": COUNT,
        "time": TEXT,
        "grader": (GRADER, lambda run: {"version": run.version}),
        "rubric": (record({"sha256": HASH}), lambda run: {"sha256": run.rubric}),
    }
)
_SPAN = each(nullable(POINTS), "before after")
_STEP = Record({"id": (TEXT, "criterion"), **_SPAN})
_CHANGE = Record(
    {"id": (TEXT, "key"), "name": TEXT, **_SPAN, "reasons": (array(TEXT), "why"), "criteria": (Many(_STEP), "steps")}
)
DIFF = Record(  # of the two runs, and the changes
    {
        **schema_key("grader/diff/v1"),
        "from": (_RUN, itemgetter(0)),
        "to": (_RUN, itemgetter(1)),
        "students": (Many(_CHANGE), itemgetter(2)),
    }
)


def render_changes_json(changes: Sequence[Change], runs: tuple[Run, Run]) -> str:
    """Return the changes as JSON, schema grader/diff/v1."""
    return to_json(DIFF.data((*runs, changes)))


def render_changes(changes: Sequence[Change], runs: tuple[Run, Run], console: Console) -> None:
    """Print the two runs, and whose grade changed, by how much, in which criteria, and why.

    Students with the same reason and the same changes of criteria are listed together.
    """
    before, after = (f"run {run.run} of {time_text(run.time)}" for run in runs)
    wrapped(console, Text(printable(f"From {before} to {after}"), style="dim"), 0)
    if not changes:
        wrapped(console, Text("nothing changed"), 0)
    for why, found in sorted(alike(changes, lambda change: change.why), key=lambda group: -len(group[1])):
        console.print()
        heading = f"{'; '.join(why)} ({counted(len(found), 'student')})"
        wrapped(console, Text(printable(heading), style="bold"), 0)
        for steps, some in sorted(alike(found, lambda change: change.steps), key=lambda group: -len(group[1])):
            for line in first_lines([*_lines(steps)], _MAX_LINES):
                wrapped(console, Text(printable(line)), 2)
            for one in some:
                total = f"{named(one.key, one.name)}: {_span(one.before, one.after, 'not final')}"
                wrapped(console, Text(printable(total), style="bold"), 4)


def _lines(steps: Sequence[PointsChange]) -> Iterator[str]:
    """Yield a line for the criteria with the same change."""
    for span, some in alike(steps, lambda step: (step.before, step.after)):
        names = enumerated([step.criterion for step in some], _MAX_NAMED)
        yield f"{names}: {_span(*span)}{' each' * (len(some) > 1)}"


def _span(before: Decimal | None, after: Decimal | None, nothing: str = "none") -> str:
    """Return points before and after: "50 to 60 (+10)"."""
    first, last = (nothing if points is None else format_points(points) for points in (before, after))
    if first == last:
        return f"{first}, as before"
    words = f"{first} to {last}"
    return words if before is None or after is None else f"{words} ({signed_points(after - before)})"
