"""The differences between two runs, or two gradebooks: which students, by how much, in which criteria, and why."""

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook, Run
from grader.classroom.gradebook.result import UNITS_PER_POINT, criterion_points, graded_on
from grader.errors import InputError
from grader.text import shell_quoted

_STATES = """
SELECT student.id, student.key, result.statuses, result.verdict, result.digest, result.rubric, result.version
FROM student JOIN submission ON submission.student = student.id AND submission.run =
    (SELECT max(run) FROM submission AS newer WHERE newer.student = student.id AND newer.run <= ?)
JOIN result ON result.id = submission.result ORDER BY student.key
"""
_MARKS = """
SELECT student, criterion, points FROM mark WHERE points IS NOT NULL AND id =
    (SELECT max(id) FROM mark AS newer WHERE newer.student = mark.student AND newer.criterion = mark.criterion AND newer.id <= ?)
"""
_NEWEST = 2**62  # above every id of a run or mark


class Snapshot(NamedTuple):
    """One of the two states that are compared: a gradebook after a run, with the manual marks up to `last_mark`."""

    book: Gradebook
    run: int = _NEWEST
    last_mark: int = _NEWEST

    @property
    def newest_run(self) -> Run:
        """The newest run that is in the snapshot; raises InputError if there is none."""
        runs = [run for run in self.book.runs() if run.id <= self.run]
        if not runs:
            raise self.book.nothing_graded()
        return runs[-1]


class PointsChange(NamedTuple):
    """The points of a criterion before and after; None if it was not graded, or not decided."""

    criterion: str
    before: Decimal | None
    after: Decimal | None


@dataclass(frozen=True, slots=True)
class Change:
    """The changes for one student, and their causes. A score is None if there was none."""

    key: str
    before: Decimal | None
    after: Decimal | None
    steps: tuple[PointsChange, ...]
    why: tuple[str, ...]


class _StudentState(NamedTuple):
    verdict: str
    digest: str
    rubric: str
    version: str
    parts: tuple[str, ...]
    points: Mapping[str, Decimal | None]
    marks: Mapping[str, Decimal]

    @property
    def score(self) -> Decimal:
        return sum((points for points in self.points.values() if points is not None), Decimal(0))


def last_two(book: Gradebook, before: int | None = None, after: int | None = None) -> tuple[Snapshot, Snapshot]:
    """Return the last two runs in a gradebook, or two runs by their numbers; raises InputError.

    The older snapshot has the manual marks from before its run, the newer one also those after its run.
    """
    runs = {run.id: run for run in book.runs()}
    if len(runs) < 2:
        again = f"grader batch PATH --gradebook {shell_quoted(book.shown)}"
        raise InputError(f"there are not two runs to compare: run `{again}` again, or name a second gradebook")
    for run in (before, after):
        if run is not None and run not in runs:
            raise InputError(f"there is no run {run}; the runs are: {', '.join(map(str, runs))}")
    newer = max(runs) if after is None else after
    older = max((run for run in runs if run < newer), default=newer) if before is None else before
    if older >= newer:
        raise InputError(f"run {older} is not before run {newer}")
    later = [run.last_mark for run in runs.values() if run.id > newer]
    return Snapshot(book, older, runs[older].last_mark), Snapshot(book, newer, min(later, default=_NEWEST))


def changes(before: Snapshot, after: Snapshot) -> list[Change]:
    """Return the students for whom something changed, in the order of their keys."""
    old, new = _states(before), _states(after)
    keys = sorted(old.keys() | new.keys())
    return [change for key in keys if (change := _change(key, old.get(key), new.get(key))) is not None]


def _states(snapshot: Snapshot) -> dict[str, _StudentState]:
    marks: dict[int, dict[str, Decimal]] = {}
    for student, criterion, units in snapshot.book.rows(_MARKS, snapshot.last_mark):
        marks.setdefault(student, {})[criterion] = Decimal(units) / UNITS_PER_POINT
    rubric_of = cache(snapshot.book.rubric)
    states: dict[str, _StudentState] = {}
    for student, key, statuses, verdict, digest, rubric, version in snapshot.book.rows(_STATES, snapshot.run):
        own = marks.get(student, {})
        points = criterion_points(rubric_of(rubric), statuses, own)
        parts = graded_on(rubric_of(rubric), statuses)
        states[key] = _StudentState(verdict, digest, rubric, version, parts, points, own)
    return states


def _change(key: str, old: _StudentState | None, new: _StudentState | None) -> Change | None:
    if old is None or new is None:
        why = "first submission" if old is None else "no longer there"
        return Change(key, old.score if old else None, new.score if new else None, (), (why,))
    steps = tuple(
        PointsChange(name, old.points.get(name), new.points.get(name))
        for name in dict.fromkeys((*old.points, *new.points))
        if old.points.get(name) != new.points.get(name)
    )
    if not steps and old.verdict == new.verdict:
        return None
    reasons = (
        (old.digest != new.digest, "the submission changed"),
        (old.rubric != new.rubric, "the rubric changed"),
        (old.version != new.version, "the grader changed"),
        (old.rubric == new.rubric and old.parts != new.parts, "graded on other parts"),
        (old.marks != new.marks, "manual marks changed"),
        (old.verdict != new.verdict, f"it was {old.verdict}, and is {new.verdict}"),
    )
    return Change(key, old.score, new.score, steps, tuple(reason for holds, reason in reasons if holds))
