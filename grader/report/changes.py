"""The changes between two runs or gradebooks, on a terminal and as JSON."""

from collections.abc import Sequence
from operator import itemgetter

from rich.console import Console
from rich.text import Text

from grader.classroom.grade_changes import Change, PointsChange
from grader.classroom.lateness import time_text
from grader.classroom.results import Run
from grader.report.console import Page
from grader.report.criteria import alike
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
from grader.text import counted, first_lines, format_points, named, printable, signed_points

_MAX_NAMED = 5  # criteria of a student
_RUN = Record(
    {
        "run": COUNT,
        "time": TEXT,
        "grader": (GRADER, lambda run: {"version": run.version}),
        "rubric": (record({"sha256": HASH}), lambda run: {"sha256": run.rubric}),
    }
)
_SPAN = each(nullable(POINTS), "before after")
_STEP = Record({"id": TEXT, **_SPAN})
_CHANGE = Record({"id": (TEXT, "key"), "name": TEXT, **_SPAN, "reasons": (array(TEXT), "why"), "criteria": Many(_STEP)})
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
    """Print the two runs, and by reason whose grade changed, by how much, and in which criteria."""
    before, after = (f"run {run.run} of {time_text(run.time)}" for run in runs)
    page = Page(console, [])
    page.inset(printable(f"From {before} to {after}"), "dim", 0)
    if not changes:
        page.inset("nothing changed", indent=0)
    for why, found in sorted(alike(changes, lambda change: change.why), key=lambda group: -len(group[1])):
        page.leave_row()
        page.inset(printable(f"{'; '.join(why)} ({counted(len(found), 'student')})"), "bold", 0)
        for one in found:
            steps = [f"{step.id} {_span(step, 'none')}" for step in one.criteria]
            total = f"{named(one.key, one.name)}: {_span(one, 'not final')}"
            page.inset(printable("; ".join([total, *first_lines(steps, _MAX_NAMED)])), indent=4, head=Text("  "))
    page.print()


def _span(change: Change | PointsChange, nothing: str) -> str:
    """Return points before and after: "50 to 60 (+10)"."""
    before, after = change.before, change.after
    first, last = (nothing if points is None else format_points(points) for points in (before, after))
    more = f" ({signed_points(after - before)})" if before is not None and after is not None else ""
    return f"{first}, as before" if first == last else f"{first} to {last}{more}"
