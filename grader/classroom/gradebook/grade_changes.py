"""Whose grade changed between two runs, or two gradebooks, by how much, and why."""

from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.text import printable_path
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.student_grade import Reason, pending_words
from grader.classroom.marks import gradebook_folder as names
from grader.classroom.marks.marks import EXCUSED
from grader.classroom.results.results import Results, Run, RunGrade, StoredResult
from grader.classroom.roster.typed_names import number_in
from grader.lab.rubric.criterion import GRADE


class _PointsChange(NamedTuple):
    """The points of a criterion before and after; None if it was not graded, or not decided."""

    id: str
    before: Decimal | None
    after: Decimal | None


class Change(NamedTuple):
    """The grade of a student before and after, the criteria whose points changed, and why."""

    key: str
    name: str
    old: RunGrade
    new: RunGrade
    criteria: list[_PointsChange]
    why: Sequence[str]

    @property
    def before(self) -> Decimal | None:
        """The points before; None without a grade."""
        return _points(self.old.total)

    @property
    def after(self) -> Decimal | None:
        """The points after."""
        return _points(self.new.total)


class Snapshot(NamedTuple):
    """A run of a gradebook: its grades and the newest results until then.

    The names of students are those of now.
    """

    run: Run
    results: Results
    names: Mapping[str, str]
    early: frozenset[str]  # the students with a final mark from before there was a submission
    is_recorded: bool  # whether the run has these grades, and not only the gradebook


def snapshot(folder: Path, number: int | None) -> Snapshot:
    """Return a run of a gradebook, by default the newest one with the current grades.

    Raises InputError.
    """
    book = Gradebook(folder)
    student_names = {}
    grades = {}
    early = set()
    for grade in book:
        key = grade.student.key
        student_names[key], grades[key] = grade.student.name, book.run_grade(grade)
        if grade.is_marked_early:
            early.add(key)
    results = book.results
    run = book.run_with(grades)
    is_recorded = not results.unfinished and run.has_equal_grades(book.run)
    if number is not None:
        if not 0 < number <= run.run:
            raise InputError(f"{printable_path(folder)} has no run {number}: it has 1 to {run.run}")
        results = Results(folder / names.RESULTS, number)
        is_recorded = True
        run = results.runs[-1]
    return Snapshot(run, results, student_names, frozenset(early), is_recorded)


def newest_changes(folder: Path, number: int | None) -> tuple[Snapshot, Snapshot, list[Change]]:
    """Return the newest run with other grades, the one to compare, and what changed.

    The newest run is one before another one, by default before now, which comes second. Raises
    InputError.

    If no run has other grades, the first one is returned.
    """
    new = snapshot(folder, number)
    earlier = [turn - 1 for turn in new.results.turns if turn > 1]
    if not new.is_recorded:
        earlier.append(new.run.run)
    elif new.run.run == 1:
        raise InputError(
            f"{printable_path(folder)} has one run: grade the class again, and compare then"
        )
    for run in reversed(earlier):
        old = snapshot(folder, run)
        changed = list(changes(old, new))
        if changed:
            return old, new, changed
    return snapshot(folder, 1), new, []


def changes(before: Snapshot, after: Snapshot) -> Iterator[Change]:
    """Yield the students for whom something changed, in the order of their keys."""
    keys = {*before.results.students, *after.results.students}
    keys.update(before.run.students, after.run.students)
    order = sorted(keys)
    results = zip(order, before.results.each(order), after.results.each(order), strict=True)
    for key, old, new in results:
        first = before.run.grade(key)
        last = after.run.grade(key)
        criteria = list[_PointsChange]()
        if old is not None and new is not None:
            criteria += _points_changes(old, new, first, last)
        is_changed = first != last or (old is None) != (new is None)
        if criteria or is_changed:
            name = after.names.get(key) or before.names.get(key, "")
            change = Change(key, name, first, last, criteria, ())
            yield change._replace(why=_why(change, (old, new), before, after))


def _why(
    change: Change,
    stored: tuple[StoredResult | None, StoredResult | None],
    before: Snapshot,
    after: Snapshot,
) -> Sequence[str]:
    """Return why a grade changed, at least one reason."""
    reasons = list(_reasons(*stored, before.run, after.run))
    reasons += _reasons_beside(change.old, change.new, before.run, after.run)
    if change.key in after.early:
        reasons.append(Reason.EARLY_MARK)
    if not reasons:
        reasons.append(_guessed_reason(change.old, change.new, change.criteria))
    return tuple(reasons)


def why_open(grade: RunGrade) -> str:
    """Return why a grade is not final; empty if it is."""
    if grade.pending:
        return pending_words(Decimal(grade.pending))
    if grade.obstacle in Reason.__members__:
        return Reason[grade.obstacle]
    return ""


def _points(value: float | str | None) -> Decimal | None:
    if value is None:
        return None
    return Decimal(str(value))


def _counted_points(stored: StoredResult, grade: RunGrade, name: str) -> Decimal | None:
    """Return the points of a criterion; None if it was not graded, or not decided."""
    if name in grade.marks:
        return number_in(grade.marks[name])
    if name in stored.results:
        return _points(stored.results[name][0])
    return None


def _points_changes(
    old: StoredResult, new: StoredResult, first: RunGrade, last: RunGrade
) -> Iterator[_PointsChange]:
    marked = {**first.marks, **last.marks}
    marked.pop(GRADE, None)
    for name in dict.fromkeys((*old.results, *new.results, *marked)):
        before = _counted_points(old, first, name)
        after = _counted_points(new, last, name)
        if before != after:
            yield _PointsChange(name, before, after)


def _reasons(
    old: StoredResult | None, new: StoredResult | None, before: Run, after: Run
) -> Iterator[str]:
    """Yield what may have changed the points of the checks."""
    if old is None or new is None:
        if old:
            yield "no longer there"
        if new:
            yield (
                "first submission"
                if new.student not in before.totals
                else "its older result was damaged"
            )
        return
    if old.student in before.totals and old.student not in after.totals:
        yield "no longer there"
    if old.digest != new.digest:
        yield "the submission changed"
    if before.rubric != after.rubric:
        yield "the rubric changed"
    if before.version != after.version:
        yield "the grader changed"
    is_same_grader = (before.rubric, before.version) == (after.rubric, after.version)
    if is_same_grader and old.context != new.context:
        yield "the parts, the reference, xacro arguments or limits changed"


def _reasons_beside(first: RunGrade, last: RunGrade, before: Run, after: Run) -> Iterator[str]:
    """Yield what changed besides the points of the checks: marks and deadlines."""
    changed = set()
    for name in {*first.marks, *last.marks}:
        if first.marks.get(name) != last.marks.get(name):
            changed.add(last.marks.get(name))
    if EXCUSED in changed:
        yield "excused"
    if None in changed:
        yield "a mark was withdrawn"
    if changed - {EXCUSED, None}:
        yield "manual mark"
    if first.deadline != last.deadline:
        yield "the student's deadline changed"
    elif first.days_late != last.days_late and before.due != after.due:
        yield "the deadline changed"


def _guessed_reason(first: RunGrade, last: RunGrade, criteria: Sequence[_PointsChange]) -> str:
    """Return the reason for a change that no file states."""
    if first.days_late != last.days_late:
        return "the time of the submission changed"
    if criteria:
        return "it was graded again"
    if first.obstacle != last.obstacle and why_open(last):
        return why_open(last)
    return "marks, the roster or the deadline changed"
