"""The differences between two runs, or two gradebooks: which students, by how much, in which criteria, and why."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook, Run
from grader.classroom.gradebook.lateness import SubmissionTimes, lateness, read_time
from grader.classroom.gradebook.result import criterion_points, points_of
from grader.errors import InputError
from grader.grading.criterion import TOTAL
from grader.grading.rubric import Rubric
from grader.grading.rubric_changes import RubricChange, concerning, rubric_changes
from grader.text import format_points, shell_quoted

_STATES = """
SELECT student.id, student.key, student.name, result.id, result.verdict, result.parts, result.digest, result.rubric,
    result.version, submission.is_late, submission.submitted, student.deadline, student.extension, student.days_late
FROM student LEFT JOIN submission ON submission.student = student.id AND submission.run =
    (SELECT max(run) FROM submission AS newer WHERE newer.student = student.id AND newer.run <= ?)
LEFT JOIN result ON result.id = submission.result ORDER BY student.key
"""
_MARKS = """
SELECT student, criterion, points FROM mark WHERE kind IN ('points', 'excused') AND id =
    (SELECT max(id) FROM mark AS newer WHERE newer.student = mark.student AND newer.criterion = mark.criterion
        AND newer.kind <> 'second' AND newer.id <= ?)
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
    """The changes for one student, and their causes. A grade that counts is None if there was none.

    `is_regraded` is False if only points of criteria changed, and the grade did not. `rubric` are the changes of the
    rubric that concern the criteria in `steps`.
    """

    key: str
    before: Decimal | None
    after: Decimal | None
    steps: tuple[PointsChange, ...]
    why: tuple[str, ...]
    name: str = ""
    rubric: tuple[RubricChange, ...] = ()
    is_regraded: bool = True


class _StudentState(NamedTuple):
    """A student in a snapshot. `verdict` is empty without a submission, `final` is None without a final mark."""

    name: str
    verdict: str
    digest: str
    sha256: str
    rubric: Rubric | None
    version: str
    points: Mapping[str, Decimal | None]
    parts: str
    marks: Mapping[str, Decimal | None]
    times: SubmissionTimes = SubmissionTimes()
    deadline: str = ""

    @property
    def late(self) -> Decimal:
        """The late penalty, 0 or less; a final mark and an excuse have none."""
        if self.rubric is None or TOTAL in self.marks:
            return Decimal(0)
        return lateness(self.rubric, self.times, self.score, read_time(self.deadline) if self.deadline else None).points

    @property
    def score(self) -> Decimal:
        """The points of all criteria."""
        return sum((points for points in self.points.values() if points is not None), Decimal(0))

    @property
    def final(self) -> Decimal | None:
        return self.marks.get(TOTAL)

    @property
    def is_excused(self) -> bool:
        return TOTAL in self.marks and self.final is None

    @property
    def total(self) -> Decimal | None:
        """The grade that counts: the final mark, else the points with the late penalty."""
        return self.final if self.final is not None or not self.verdict else self.score + self.late

    @property
    def uncounted(self) -> set[str]:
        """The criteria whose manual marks do not count, and the whole submission."""
        criteria = self.rubric.criteria if self.rubric is not None else ()
        return {TOTAL, *(row.id for row in criteria if row.adjustment is not None)}


_NOBODY = _StudentState("", "", "", "", None, "", {}, "", {})
_Comparison = Callable[[str, str, tuple[str, ...]], tuple[RubricChange, ...]]


def last_two(book: Gradebook, before: int | None = None, after: int | None = None) -> tuple[Snapshot, Snapshot]:
    """Return the last two finished runs in a gradebook, or two runs by their numbers; raises InputError.

    An interrupted run has only a part of the class: the run after it would differ from it only in the rest. The older
    snapshot has the manual marks from before its run, the newer one also those after its run.
    """
    runs = {run.id: run for run in book.runs()}
    for run in (before, after):
        if run is not None and run not in runs:
            raise InputError(f"there is no run {run}; the runs are: {', '.join(map(str, runs)) or 'none'}")
    finished = [run.id for run in runs.values() if run.finished]
    if len({*finished, before, after} - {None}) < 2:
        again = f"grader batch PATH --gradebook {shell_quoted(book.shown)}"
        raise InputError(f"there are not two runs to compare: run `{again}` again, or name a second gradebook")
    newer = max(finished) if after is None else after
    older = max((run for run in finished if run < newer), default=newer) if before is None else before
    if older >= newer:
        raise InputError(f"run {older} is not before run {newer}")
    later = [run.last_mark for run in runs.values() if run.id > newer]
    return Snapshot(book, older, runs[older].last_mark), Snapshot(book, newer, min(later, default=_NEWEST))


def changes(before: Snapshot, after: Snapshot) -> list[Change]:
    """Return the students for whom something changed, in the order of their keys."""
    old, new = _states(before), _states(after)
    rubrics = {state.sha256: state.rubric for state in (*old.values(), *new.values()) if state.rubric is not None}

    @cache
    def changed(before: str, after: str) -> Mapping[str, tuple[RubricChange, ...]]:
        return rubric_changes(rubrics[before], rubrics[after])

    @cache
    def comparison(before: str, after: str, names: tuple[str, ...]) -> tuple[RubricChange, ...]:
        return tuple(concerning(names, changed(before, after), rubrics[before], rubrics[after]))

    keys = sorted(old.keys() | new.keys())
    found = (_change(key, old.get(key, _NOBODY), new.get(key, _NOBODY), comparison) for key in keys)
    return [change for change in found if change is not None]


def _states(snapshot: Snapshot) -> dict[str, _StudentState]:
    marks: dict[int, dict[str, Decimal | None]] = {}
    for student, criterion, units in snapshot.book.rows(_MARKS, snapshot.last_mark):
        marks.setdefault(student, {})[criterion] = None if units is None else points_of(units)
    rubric_of, deadline = cache(snapshot.book.rubric), snapshot.newest_run.deadline
    states: dict[str, _StudentState] = {}
    for student, key, name, result, verdict, parts, digest, sha256, version, *times in snapshot.book.rows(
        _STATES, snapshot.run
    ):
        own = marks.get(student, {})
        if verdict is None:
            states[key] = _NOBODY._replace(name=name, marks=own)
            continue
        rubric = rubric_of(sha256)
        given = {name: points for name, points in own.items() if points is not None}
        points = criterion_points(rubric, snapshot.book.outcomes(result), given)
        is_late, submitted, due, extension, days = times
        found = SubmissionTimes(bool(is_late), submitted or "", due, float(extension or 0), days)
        states[key] = _StudentState(name, verdict, digest, sha256, rubric, version, points, parts, own, found, deadline)
    return states


def _change(key: str, old: _StudentState, new: _StudentState, comparison: _Comparison) -> Change | None:
    whole = (key, old.total, new.total)
    name = new.name or old.name
    final = tuple(_final_mark(old, new))
    if not (old.verdict and new.verdict):
        why = (*_moved(old, new), *final)
        return Change(*whole, (), why, name) if why else None
    steps = tuple(_steps(old, new))
    removed = tuple(name for name in old.points if name in new.marks and name not in new.points)
    late = tuple(_late_penalty(old, new))
    is_other = bool(final or removed) or old.verdict != new.verdict
    if not (steps or late or is_other):
        return None
    why = (*_reasons(old, new), *late, *final)
    why += tuple(f"the manual mark of {name} no longer counts: the rubric no longer has it" for name in removed)
    names = (*(step.criterion for step in steps), *removed) or ("",) * bool(late)
    found = comparison(old.sha256, new.sha256, names) if old.sha256 != new.sha256 else ()
    return Change(*whole, steps, why, name, found, is_other or old.total != new.total)


def _moved(old: _StudentState, new: _StudentState) -> Iterator[str]:
    """Yield that a student has a submission in one of two runs only."""
    if new.verdict:
        yield "first submission"
    elif old.verdict:
        yield "no longer there"


def _late_penalty(old: _StudentState, new: _StudentState) -> Iterator[str]:
    if old.late != new.late:
        yield f"late penalty: {format_points(-old.late)} to {format_points(-new.late)}"


def _steps(old: _StudentState, new: _StudentState) -> Iterator[PointsChange]:
    for name in dict.fromkeys((*old.points, *new.points)):
        before, after = old.points.get(name), new.points.get(name)
        if before != after:
            yield PointsChange(name, before, after)


def _reasons(old: _StudentState, new: _StudentState) -> Iterator[str]:
    """Yield what may have changed the points of criteria."""
    reasons = (
        (old.digest != new.digest, "the submission changed"),
        (old.sha256 != new.sha256, "the rubric changed"),
        (old.version != new.version, "the grader changed"),
        (old.sha256 == new.sha256 and old.parts != new.parts, "graded on other parts"),
        (_has_other_marks(old, new), "manual marks changed"),
        (old.verdict != new.verdict, f"it was {old.verdict}, and is {new.verdict}"),
    )
    yield from (reason for holds, reason in reasons if holds)


def _has_other_marks(old: _StudentState, new: _StudentState) -> bool:
    changed = {name for name, _ in old.marks.items() ^ new.marks.items()}
    return bool(changed and changed - old.uncounted - new.uncounted)


def _final_mark(old: _StudentState, new: _StudentState) -> Iterator[str]:
    """Yield what changed in the final mark and the excuse, in words."""
    if old.final != new.final:
        before, after = ("none" if one.final is None else format_points(one.final) for one in (old, new))
        yield f"final mark: {before} to {after}"
    if old.is_excused != new.is_excused:
        yield "excused" if new.is_excused else "no longer excused"
