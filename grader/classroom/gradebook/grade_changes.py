"""Whose grade changed between two runs, or two gradebooks, by how much, and why."""

from collections.abc import Iterator, Mapping
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.text import printable_path
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.student_grade import Reason
from grader.classroom.marks import gradebook_folder as names
from grader.classroom.results.results import Results, Run, StoredResult


class PointsChange(NamedTuple):
    """The points of a criterion before and after; None if it was not graded, or not decided."""

    id: str
    before: Decimal | None
    after: Decimal | None


class Change(NamedTuple):
    """The published grade of a student, None while there is none, the criteria whose points
    changed, and why.
    """

    key: str
    name: str
    before: Decimal | None
    after: Decimal | None
    criteria: list[PointsChange]
    why: tuple[str, ...]


class _Snapshot(NamedTuple):
    """A run of a gradebook: its totals and the newest results until then; the names of students are
    those of now.
    """

    run: Run
    results: Results
    names: Mapping[str, str]
    early: frozenset[str]  # the students with a final mark from before there was a submission


def snapshot(folder: Path, number: int | None) -> _Snapshot:
    """Return a run of a gradebook, by default the newest one with the current grades. Raises
    InputError.
    """
    book = Gradebook(folder)
    student_names, published, early = dict[str, str](), dict[str, Decimal | None](), set[str]()
    for grade in book:
        key = grade.student.key
        student_names[key], published[key] = grade.student.name, grade.published
        if grade.is_marked_early:
            early.add(key)
    results, run = book.results, book.run_with(published)
    if number is not None:
        if not 0 < number <= run.run:
            raise InputError(f"{printable_path(folder)} has no run {number}: it has 1 to {run.run}")
        results = Results(folder / names.RESULTS, number)
        run = results.runs[-1]
    return _Snapshot(run, results, student_names, frozenset(early))


def changes(before: _Snapshot, after: _Snapshot) -> Iterator[Change]:
    """Yield the students for whom something changed, in the order of their keys."""
    keys = {*before.results.students, *after.results.students}
    keys.update(before.run.students, after.run.students)
    order = sorted(keys)
    results = zip(order, before.results.each(order), after.results.each(order), strict=True)
    for key, old, new in results:
        first, last = _points(before.run.total(key)), _points(after.run.total(key))
        criteria = list[PointsChange]()
        if old is not None and new is not None:
            criteria += _points_changes(old, new)
        why = list[str]()
        if criteria or first != last or (old is None) != (new is None):
            why += _reasons(old, new, before.run, after.run)
            if not why and criteria:
                why.append("it was graded again")
            elif not why:
                why.append("marks, the roster or the deadline changed")
        if key in after.early:
            why.append(Reason.EARLY_MARK)
        if why:
            yield Change(key, after.names.get(key, ""), first, last, criteria, tuple(why))


def _points(value: float | str | None) -> Decimal | None:
    if value is None:
        return None
    return Decimal(str(value))


def _stored_points(stored: StoredResult, name: str) -> Decimal | None:
    """Return the points of a criterion; None if it was not graded, or not decided."""
    if name in stored.results:
        return _points(stored.results[name][0])
    return None


def _points_changes(old: StoredResult, new: StoredResult) -> Iterator[PointsChange]:
    for name in dict.fromkeys((*old.results, *new.results)):
        before, after = _stored_points(old, name), _stored_points(new, name)
        if before != after:
            yield PointsChange(name, before, after)


def _reasons(
    old: StoredResult | None, new: StoredResult | None, before: Run, after: Run
) -> Iterator[str]:
    """Yield what may have changed a grade."""
    if old is None or new is None:
        if old is not None:
            yield "no longer there"
        if new is not None:
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
