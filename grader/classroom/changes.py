"""Whose grade changed between two runs, or two gradebooks, by how much, and why."""

from collections.abc import Iterator, Mapping
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from grader.classroom import folder as names
from grader.classroom.grades import Class
from grader.classroom.results import Graded, Results, Run
from grader.errors import InputError
from grader.text import printable_path


class PointsChange(NamedTuple):
    """The points of a criterion before and after; None if it was not graded, or not decided."""

    criterion: str
    before: Decimal | None
    after: Decimal | None


class Change(NamedTuple):
    """The changes for one student: the grade as published, None while there is none; the points of criteria; the reasons."""

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
    run = next((one for one in results.runs if one.run == number), None)
    if run is None:
        raise InputError(f"{printable_path(folder)} has no run {number}: it has 1 to {book.run.run}")
    return Snapshot(run, results, known)


def changes(before: Snapshot, after: Snapshot) -> list[Change]:
    """Return the students for whom something changed, in the order of their keys."""
    keys = sorted({*before.results.students, *after.results.students, *before.run.totals, *after.run.totals})
    found = (_change(key, before, after) for key in keys)
    return [change for change in found if change is not None]


def _change(key: str, before: Snapshot, after: Snapshot) -> Change | None:
    old, new = before.results.of(key), after.results.of(key)
    totals = [None if (text := one.run.totals.get(key)) is None else Decimal(text) for one in (before, after)]
    steps = tuple(_steps(old, new)) if old is not None and new is not None else ()
    why = tuple(_reasons(key, old, new, before, after))
    if totals[0] != totals[1] and not why:
        why = ("marks, the roster or the deadline changed",)
    is_changed = bool(steps or totals[0] != totals[1] or (old is None) != (new is None))
    return Change(key, after.names.get(key, ""), totals[0], totals[1], steps, why) if is_changed else None


def _steps(old: Graded, new: Graded) -> Iterator[PointsChange]:
    for name in dict.fromkeys((*old.results, *new.results)):
        points = [entry[0] if (entry := one.results.get(name)) is not None else None for one in (old, new)]
        if points[0] != points[1]:
            yield PointsChange(name, *(None if one is None else Decimal(str(one)) for one in points))


def _reasons(key: str, old: Graded | None, new: Graded | None, before: Snapshot, after: Snapshot) -> Iterator[str]:
    """Yield what may have changed the points of criteria."""
    if old is None or new is None:
        yield "first submission" if new is not None else "no longer there"
        return
    reasons = (
        (key in before.run.totals and key not in after.run.totals, "no longer there"),
        (old.digest != new.digest, "the submission changed"),
        (before.run.rubric != after.run.rubric, "the rubric changed"),
        (before.run.version != after.run.version, "the grader changed"),
        (old.parts != new.parts, "graded on other parts"),
        (old.verdict != new.verdict, f"it was {old.verdict}, and is {new.verdict}"),
    )
    yield from (reason for holds, reason in reasons if holds)
