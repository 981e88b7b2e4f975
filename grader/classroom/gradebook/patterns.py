"""The combinations of results in a class, so that statistics add up few rows instead of all students."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

from grader.checks.manual import MANUAL_CHECKS
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.reasons import GRADED, manual_units
from grader.classroom.gradebook.result import EARNED, NOT_GRADED, UNITS_PER_POINT
from grader.grading.rubric import Criterion, Rubric

COLUMNS = "statuses, score, out_of, pending"


class Pattern(NamedTuple):
    """A combination of results, and how many students have it.

    `marks` are manual points in ten-thousandths, `earned` those of each criterion, None where it is not decided; a criterion without
    points has 1 if it passed, so that it has a share and a discrimination as well. `total` is the sum over the others. `undecided`
    are the automatic points that need manual grading, of `automatic`.
    """

    statuses: str
    score: int
    out_of: int
    pending: int
    students: int
    marks: Mapping[str, int]
    earned: Sequence[int | None]
    total: int
    undecided: int
    automatic: int

    @property
    def counts(self) -> bool:
        """Return whether it has a grade: points are decided, and not most of the automatic ones undecided."""
        return self.decided > 0 and 2 * self.undecided <= self.automatic

    @property
    def decided(self) -> int:
        """The points that need no manual grading any more."""
        return self.out_of - self.pending

    def grade(self, most: int) -> int:
        """Return the share that was earned of the decided points, times the maximum."""
        return round(self.score * most / self.decided)


def patterns_of(book: Gradebook, rubric: Rubric) -> Iterator[Pattern]:
    """Yield the combinations of results among the newest submissions; each student with a manual mark is one."""
    unmarked = book.rows(f"SELECT {COLUMNS}, count(*), 0 {GRADED} AND marks = 0 GROUP BY {COLUMNS}", rubric.sha256)
    marked = book.rows(f"SELECT {COLUMNS}, 1, id {GRADED} AND marks", rubric.sha256)
    for statuses, score, out_of, pending, students, student in chain(unmarked, marked):
        yield pattern_of(rubric, (statuses, score, out_of, pending), manual_units(book, student), students)


def pattern_of(
    rubric: Rubric, columns: tuple[str, int, int, int], marks: Mapping[str, int], students: int = 1
) -> Pattern:
    """Return the combination of results in some COLUMNS of the gradebook, with these manual marks."""
    statuses = columns[0]
    earned = [
        marks.get(criterion.id, (units_of(criterion) or 1) * EARNED[status] if status in EARNED else None)
        for criterion, status in zip(rubric.criteria, statuses, strict=True)
    ]
    total = sum(units or 0 for units, criterion in zip(earned, rubric.criteria, strict=True) if criterion.points)
    graded = [
        row
        for row in rubric.criteria
        if row.check.function not in MANUAL_CHECKS and statuses[row.position] != NOT_GRADED
    ]
    undecided = sum(units_of(row) for row in graded if statuses[row.position] == "?" and row.id not in marks)
    return Pattern(*columns, students, marks, earned, total, undecided, sum(map(units_of, graded)))


def units_of(criterion: Criterion) -> int:
    """Return the points of a criterion in ten-thousandths."""
    return int(criterion.points * UNITS_PER_POINT)
