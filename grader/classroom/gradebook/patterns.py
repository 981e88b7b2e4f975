"""The combinations of results in a class, so that statistics add up few rows instead of all, and why points were lost or are undecided."""

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import Any, NamedTuple

from grader.checks.manual import MANUAL_CHECKS
from grader.classroom.gradebook.failures import Failure
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import EARNED, NOT_GRADED, UNITS_PER_POINT
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric

GRADED = "FROM grade WHERE verdict = 'graded' AND NOT is_excused AND rubric = ?"
_MARKS = "SELECT criterion, points FROM manual_mark WHERE student = ?"


def manual_units(book: Gradebook, student: int) -> dict[str, int]:
    """Return the manual marks of a student in ten-thousandths of a point; none for student 0."""
    return {str(name): int(points) for name, points in book.rows(_MARKS, student)} if student else {}


def failure_counts(book: Gradebook, rubric: Rubric) -> Counter[Failure]:
    """Return the failures and their counts, except where a manual mark gives all points."""
    found: Counter[Failure] = Counter()
    unmarked = book.rows(f"SELECT failures, count(*), 0 {GRADED} AND marks = 0 GROUP BY failures", rubric.sha256)
    marked = book.rows(f"SELECT failures, 1, id {GRADED} AND marks", rubric.sha256)
    for failures, count, student in chain(unmarked, marked):
        for failure in failures_in(failures, rubric, manual_units(book, student)):
            found[failure] += count
    return found


def failures_in(failures: str, rubric: Rubric, marks: Mapping[str, int]) -> Iterator[Failure]:
    """Yield the failures of a submission that are stored as JSON, except of extra credit, or where a mark gives all points."""
    for failure in map(Failure.from_json, json.loads(failures)):
        criterion = rubric.criteria[failure.position]
        is_full = marks.get(criterion.id) == int(criterion.points * UNITS_PER_POINT)
        if not (is_full or criterion.bonus):
            yield failure


def undecided_reasons(book: Gradebook, rubric: Rubric) -> tuple[tuple[str, int], ...]:
    """Return why automatic points need manual grading and how many submissions it affects, the most frequent reason first."""
    automatic = {row.position: row.id for row in rubric.criteria if row.check.function not in MANUAL_CHECKS}
    rows = book.rows(f"SELECT id, marks, undecided, statuses {GRADED} AND undecided <> '' AND pending", rubric.sha256)
    found: Counter[str] = Counter()
    for student, has_marks, reason, statuses in rows:
        marks = manual_units(book, student) if has_marks else {}
        found[reason] += any(statuses[index] == "?" and name not in marks for index, name in automatic.items())
    return tuple(sorted((+found).items(), key=lambda item: (-item[1], item[0])))


COLUMNS = "statuses, score, out_of, pending, final"


class Pattern(NamedTuple):
    """A combination of results, and how many students have it.

    `marks` are manual points in ten-thousandths. `earned` are the points of each criterion, None if it is undecided or
    adjusted; a criterion without points has 1 if it passed, so that it has a share and a discrimination as well. `total` is the
    sum over the others. `undecided` are the automatic points that need manual grading, of `automatic`. `decided` are the points
    of the maximum that are decided. `bonus` is the extra credit in the score. `final` is a final mark, which replaces the
    grade.
    """

    statuses: str
    score: int
    out_of: int
    pending: int
    final: int | None
    students: int
    marks: Mapping[str, int]
    earned: Sequence[int | None]
    total: int
    undecided: int
    automatic: int
    decided: int
    bonus: int

    @property
    def counts(self) -> bool:
        """Return whether it has a grade: a final one, or points are decided, and not most of the automatic ones undecided."""
        return self.final is not None or (self.decided > 0 and 2 * self.undecided <= self.automatic)

    def grade(self, most: int) -> int:
        """Return the final mark, else the share that was earned of the decided points, times the maximum, with extra credit."""
        share = round((self.score - self.bonus) * most / self.decided) if self.decided else 0
        return self.final if self.final is not None else share + self.bonus


def patterns_of(book: Gradebook, rubric: Rubric) -> Iterator[Pattern]:
    """Yield the combinations of results among the newest submissions; each student with a manual mark is one."""
    unmarked = book.rows(f"SELECT count(*), 0, {COLUMNS} {GRADED} AND marks = 0 GROUP BY {COLUMNS}", rubric.sha256)
    marked = book.rows(f"SELECT 1, id, {COLUMNS} {GRADED} AND marks", rubric.sha256)
    for students, student, *columns in chain(unmarked, marked):
        yield pattern_of(rubric, tuple(columns), manual_units(book, student), students)


def pattern_of(rubric: Rubric, columns: tuple[Any, ...], marks: Mapping[str, int], students: int = 1) -> Pattern:
    """Return the combination of results in some COLUMNS of the gradebook, with these manual marks."""
    statuses, score, out_of, pending, final = columns
    marks = {row.id: marks[row.id] for row in rubric.criteria if row.id in marks and row.adjustment is None}
    given = [
        marks.get(criterion.id, (units_of(criterion) or 1) * EARNED[status] if status in EARNED else None)
        for criterion, status in zip(rubric.criteria, statuses, strict=True)
    ]
    earned = [given[row.position] if row.adjustment is None else None for row in rubric.criteria]
    total = sum(units or 0 for units, criterion in zip(earned, rubric.criteria, strict=True) if criterion.points)
    automatic = (row for row in rubric.criteria if row.check.function not in MANUAL_CHECKS)
    graded = [row for row in automatic if statuses[row.position] != NOT_GRADED]
    waiting = [row for row in rubric.criteria if statuses[row.position] == "?" and row.id not in marks]
    return Pattern(
        statuses,
        score,
        out_of,
        pending,
        final,
        students,
        marks,
        earned,
        total,
        sum(_maximum(row) for row in waiting if row.check.function not in MANUAL_CHECKS),
        sum(map(_maximum, graded)),
        out_of - sum(map(_maximum, waiting)),
        sum(given[row.position] or 0 for row in rubric.criteria if row.bonus and row.points),
    )


def units_of(criterion: Criterion) -> int:
    """Return the points of a criterion in ten-thousandths."""
    return int(criterion.points * UNITS_PER_POINT)


def _maximum(criterion: Criterion) -> int:
    return int(criterion.maximum * UNITS_PER_POINT)
