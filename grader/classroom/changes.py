"""Whose grade changed between two runs, or two gradebooks, by how much, and why."""

from collections.abc import Iterator, Mapping
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from grader.classroom import folder as names
from grader.classroom.graded import Graded, Run
from grader.classroom.grades import Class
from grader.classroom.results import Results
from grader.errors import InputError
from grader.text import printable_path


class PointsChange(NamedTuple):
    """The points of a criterion before and after; None if it was not graded, or not decided."""

    criterion: str
    before: Decimal | None
    after: Decimal | None


class Change(NamedTuple):
    """The published grade of a student, None while there is none, the points of criteria that changed, and why."""

    key: str
    name: str
    before: Decimal | None
    after: Decimal | None
    steps: tuple[PointsChange, ...]
    why: tuple[str, ...]


class Snapshot(NamedTuple):
    """A run of a gradebook: its totals, and the newest results until then."""

    run: Run
    results: Results
    names: Mapping[str, str]


def snapshot(folder: Path, number: int | None) -> Snapshot:
    """Return a run of a gradebook, by default the newest one with the grades of now. Raises InputError."""
    book = Class(folder)
    students = {grade.student.key: (grade.student.name, grade.published) for grade in book}
    known = {key: name for key, (name, _) in students.items()}
    if number is None:
        totals = {key: None if total is None else str(total) for key, (_, total) in students.items()}
        return Snapshot(book.run._replace(totals=totals), book.results, known)
    results = Results(folder / names.RESULTS, number)
    if not 0 < number <= book.run.run:
        raise InputError(f"{printable_path(folder)} has no run {number}: it has 1 to {book.run.run}")
    return Snapshot(results.runs[-1], results, known)


def changes(before: Snapshot, after: Snapshot) -> Iterator[Change]:
    """Yield the students for whom something changed, in the order of their keys."""
    for key in sorted({*before.results.students, *after.results.students, *before.run.totals, *after.run.totals}):
        old, new = before.results.of(key), after.results.of(key)
        texts = [one.run.totals.get(key) for one in (before, after)]
        first, last = (None if text is None else Decimal(text) for text in texts)
        steps: tuple[PointsChange, ...] = ()
        why: tuple[str, ...] = ()
        if old is None or new is None:
            why = ("no longer there",) if old is not None else ("first submission",) if new is not None else ()
        else:
            is_gone = key in before.run.totals and key not in after.run.totals
            steps, why = tuple(_steps(old, new)), tuple(_reasons(old, new, before.run, after.run, is_gone=is_gone))
        if steps or first != last or (old is None) != (new is None):
            others = "it was graded again" if steps else "marks, the roster or the deadline changed"
            yield Change(key, after.names.get(key, ""), first, last, steps, why or (others,))


def _steps(old: Graded, new: Graded) -> Iterator[PointsChange]:
    for name in dict.fromkeys((*old.results, *new.results)):
        points = [entry[0] if (entry := one.results.get(name)) is not None else None for one in (old, new)]
        if points[0] != points[1]:
            yield PointsChange(name, *(None if one is None else Decimal(str(one)) for one in points))


def _reasons(old: Graded, new: Graded, before: Run, after: Run, *, is_gone: bool) -> Iterator[str]:
    """Yield what may have changed the points of criteria."""
    is_same = (before.rubric, before.version, old.parts) == (after.rubric, after.version, new.parts)
    reasons = (
        (is_gone, "no longer there"),
        (old.digest != new.digest, "the submission changed"),
        (before.rubric != after.rubric, "the rubric changed"),
        (before.version != after.version, "the grader changed"),
        (old.parts != new.parts, "graded on other parts"),
        (is_same and old.context != new.context, "the reference, xacro arguments or limits changed"),
        (old.verdict != new.verdict, f"it was {old.verdict}, and is {new.verdict}"),
    )
    yield from (reason for holds, reason in reasons if holds)
