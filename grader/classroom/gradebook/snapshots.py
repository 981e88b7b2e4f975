"""The state of a class after a run: the points, marks and times of each student."""

from collections.abc import Mapping
from decimal import Decimal
from functools import cache
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook, Run
from grader.classroom.gradebook.marks import EXTENSION
from grader.classroom.gradebook.result import criterion_points, points_from_units
from grader.classroom.lateness import SubmissionTimes, lateness, read_time
from grader.errors import InputError
from grader.grading.criterion import TOTAL
from grader.grading.rubric import Rubric
from grader.text import shell_quoted

_STATES = f"""
SELECT student.id, student.key, student.name, result.id, result.verdict, result.parts, result.digest, result.rubric,
    result.version, coalesce((SELECT comment FROM mark WHERE student = student.id AND criterion = '{EXTENSION}'
    AND id <= ?2 ORDER BY id DESC LIMIT 1), ''), submission.is_late, submission.submitted,
    student.deadline, student.extension, student.days_late
FROM student LEFT JOIN submission ON submission.student = student.id AND submission.run =
    (SELECT max(run) FROM submission AS newer WHERE newer.student = student.id AND newer.run <= ?1)
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


class StudentState(NamedTuple):
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
        """The final mark."""
        return self.marks.get(TOTAL)

    @property
    def is_excused(self) -> bool:
        """Return whether the student is excused."""
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


NOBODY = StudentState("", "", "", "", None, "", {}, "", {})


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


def states_of(snapshot: Snapshot) -> dict[str, StudentState]:
    """Return the students in a snapshot, by key."""
    marks: dict[int, dict[str, Decimal | None]] = {}
    for student, criterion, units in snapshot.book.rows(_MARKS, snapshot.last_mark):
        marks.setdefault(student, {})[criterion] = None if units is None else points_from_units(units)
    rubric_of, deadline = cache(snapshot.book.rubric), snapshot.newest_run.deadline
    states: dict[str, StudentState] = {}
    for student, key, name, result, verdict, parts, digest, sha256, version, extended, *times in snapshot.book.rows(
        _STATES, snapshot.run, snapshot.last_mark
    ):
        own = marks.get(student, {})
        if verdict is None:
            states[key] = NOBODY._replace(name=name, marks=own)
            continue
        rubric = rubric_of(sha256)
        given = {name: points for name, points in own.items() if points is not None}
        points = criterion_points(rubric, snapshot.book.outcomes(result), given)
        is_late, submitted, due, extension, days = times
        found = SubmissionTimes(bool(is_late), submitted or "", due, float(extension or 0), days).extended(extended)
        states[key] = StudentState(name, verdict, digest, sha256, rubric, version, points, parts, own, found, deadline)
    return states
