"""The graded students of a class, each with the points of every criterion, and the failures that several share."""

import json
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from math import acos, degrees, radians
from typing import Any, NamedTuple

from grader.checks.manual import MANUAL_CHECKS
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import StoredOutcome, units_of
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric

_GRADED = """
SELECT id, key, result, score, out_of, pending, final FROM grade
WHERE verdict = 'graded' AND NOT is_excused AND rubric = ? ORDER BY id
"""
_MARKS = "SELECT student, criterion, points FROM manual_mark"
_FINEST = 1e-6  # the digits of a measured value
_NEIGHBOURS = (0, -1, 1)


class Failure(NamedTuple):
    """One failed criterion: its position, and the mistake in words.

    `measured` are the measured numbers and then the expected ones, empty if something else than numbers was compared.
    """

    position: int
    mistake: str
    measured: tuple[float, ...] = ()
    tolerance: float = 0.0
    unit: str = ""


@dataclass(slots=True)
class GradedStudent:
    """A student with a graded submission, in ten-thousandths of a point, with manual marks.

    `statuses` and `earned` are by the position of the criterion; `earned` is None if it is undecided or adjusted. A
    criterion without points has 1 if it passed, so that it has a share and a discrimination as well. `marked` are the
    positions of manual marks. `final` is a final mark, which replaces the grade. `decided` are the points of the
    maximum that are decided, `bonus` is the extra credit in the score. `undecided` are the automatic points that need
    grading, of `automatic`, and `reasons` why, with their points.
    """

    id: int
    key: str
    score: int
    out_of: int
    pending: int
    final: int | None
    statuses: list[str]
    earned: list[int | None]
    marked: tuple[int, ...] = ()
    decided: int = 0
    undecided: int = 0
    automatic: int = 0
    bonus: int = 0
    reasons: Counter[str] = field(default_factory=Counter)
    failures: list[Failure] = field(default_factory=list)

    @property
    def counts(self) -> bool:
        """Return whether there is a grade: a final mark, or decided points, and not most automatic ones undecided."""
        return self.final is not None or (self.decided > 0 and 2 * self.undecided <= self.automatic)

    def grade(self, most: int) -> int:
        """Return the final mark, else the share of the decided points times the maximum, with extra credit."""
        share = round((self.score - self.bonus) * most / self.decided) if self.decided else 0
        return self.final if self.final is not None else share + self.bonus


def graded_students(book: Gradebook, rubric: Rubric) -> Iterator[GradedStudent]:
    """Yield the students whose newest submission was graded with a rubric, without those who are excused."""
    marks = manual_units(book)
    full: list[int | None] = [full_units(row) for row in rubric.criteria]
    automatic = sum(units_of(row.maximum) for row in rubric.criteria if _is_automatic(row))
    bonus = [row.position for row in rubric.criteria if row.bonus and row.points]
    known: dict[tuple[Any, ...], list[Any]] = {}  # most of 100,000 students have the results of others
    adjusted = [row.position for row in rubric.criteria if row.adjustment is not None]
    for number, key, result, score, out_of, pending, final in book.rows(_GRADED, rubric.sha256):
        statuses = ["passed"] * len(full)
        student = GradedStudent(
            number, key, score, out_of, pending, final, statuses, full[:], decided=out_of, automatic=automatic
        )
        for position, outcome in book.outcomes(result).items():
            _add_outcome(student, rubric.criteria[position], outcome, marks[number])
        for row in rubric.criteria if marks[number] else ():
            if row.id in marks[number] and row.adjustment is None:
                student.marked += (row.position,)
                student.earned[row.position] = marks[number][row.id]
        student.bonus = sum(student.earned[position] or 0 for position in bonus)
        for position in adjusted:
            student.earned[position] = None
        student.statuses, student.earned, student.failures = (
            known.setdefault(tuple(values), values) for values in (student.statuses, student.earned, student.failures)
        )
        yield student


def manual_units(book: Gradebook) -> defaultdict[int, dict[str, int]]:
    """Return the manual marks of each student by criterion, in ten-thousandths of a point."""
    marks: defaultdict[int, dict[str, int]] = defaultdict(dict)
    for student, criterion, units in book.rows(_MARKS):
        marks[student][criterion] = units
    return marks


def full_units(criterion: Criterion) -> int:
    """Return what a criterion is worth in `earned`."""
    return units_of(criterion.points) or 1


def _add_outcome(
    student: GradedStudent, criterion: Criterion, outcome: StoredOutcome, marks: Mapping[str, int]
) -> None:
    mark, position = marks.get(criterion.id), criterion.position
    student.statuses[position], student.earned[position] = outcome.status, outcome.points
    if outcome.status in ("carried", "adjusted"):
        student.earned[position] = full_units(criterion)
    elif outcome.status == "failed" and not criterion.bonus and mark != units_of(criterion.points):
        student.failures.append(stored_failure(outcome))
    elif outcome.status == "ungraded" and _is_automatic(criterion):
        student.automatic -= units_of(criterion.maximum)
    elif outcome.status == "pending" and mark is None:
        student.decided -= (maximum := units_of(criterion.maximum))
        if _is_automatic(criterion):
            student.undecided += maximum
            student.reasons[outcome.cause] += units_of(criterion.points)


@lru_cache(maxsize=4096)  # students make the same mistakes
def stored_failure(outcome: StoredOutcome) -> Failure:
    """Return the failure that an outcome of the gradebook is."""
    if outcome.measured is None:
        return Failure(outcome.position, outcome.cause)
    compared = json.loads(outcome.measured)
    return Failure(outcome.position, outcome.cause, tuple(compared["numbers"]), compared["tolerance"], compared["unit"])


def _is_automatic(criterion: Criterion) -> bool:
    return criterion.check.function not in MANUAL_CHECKS


def grouped(failures: Mapping[Failure, int]) -> list[tuple[Failure, int]]:
    """Return each cause once, by its most frequent failure, with the number of failures; the most frequent first."""
    counts: Counter[Failure] = Counter()
    for failure, group in groups_of(failures).items():
        counts[group] += failures[failure]
    return sorted(counts.items(), key=lambda item: (-item[1], item[0]))


def groups_of(failures: Mapping[Failure, int]) -> dict[Failure, Failure]:
    """Return the cause of each failure, given as the most frequent failure that has it.

    A measured failure belongs to the first group whose values are within the tolerance, any other to the group with the
    same message.
    """
    found: dict[Failure, Failure] = {}
    cells: dict[tuple[object, ...], list[Failure]] = {}
    for failure, _ in sorted(failures.items(), key=lambda item: (-item[1], item[0])):
        first, *others = _cells(failure)
        near = (group for cell in (first, *others) for group in cells.get(cell, ()))
        group = next((group for group in near if _is_same(failure, group)), None)
        if group is None:
            cells.setdefault(first, []).append(failure)
        found[failure] = group or failure
    return found


def _cells(failure: Failure) -> Iterable[tuple[object, ...]]:
    """Return where groups that a failure may belong to are kept, its own place first."""
    position, mistake, measured, tolerance, unit = failure
    if not measured:
        return [(position, mistake)]
    size = (radians(tolerance) if _is_direction(failure) else tolerance) or _FINEST
    cell = sum(measured) // (size * len(measured))  # the sums of two groups that are the same differ by less
    return [(position, unit, len(measured), cell + step) for step in _NEIGHBOURS]


def _is_same(one: Failure, other: Failure) -> bool:
    if not one.measured:
        return one.mistake == other.mistake
    if _is_direction(one):
        cosine = sum(a * b for a, b in zip(one.measured[:3], other.measured[:3], strict=True))
        return degrees(acos(max(-1.0, min(1.0, cosine)))) <= one.tolerance
    return all(abs(a - b) <= one.tolerance for a, b in zip(one.measured, other.measured, strict=True))


def _is_direction(failure: Failure) -> bool:
    """Return whether a unit vector was compared with another, with a tolerance in degrees."""
    return failure.unit == "deg" and len(failure.measured) == len("xyzxyz")
