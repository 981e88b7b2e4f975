"""Which students the figures of a class count: those with a grade in a tenth, with lost points in a criterion, with a mistake."""

from collections.abc import Mapping
from typing import NamedTuple

from grader.classroom.gradebook.failures import grouped, groups_of
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.patterns import (
    COLUMNS,
    GRADED,
    failure_counts,
    failures_in,
    manual_units,
    pattern_of,
    units_of,
)
from grader.classroom.gradebook.result import UNITS_PER_POINT
from grader.classroom.gradebook.statistics import ClassStatistics, tenth_of
from grader.grading.rubric import Rubric


class Member(NamedTuple):
    """The figures in which a graded student is counted.

    `tenth` is None for a grade that is not in the statistics; `lost` are the positions of criteria with fewer points than the maximum,
    `mistakes` those of the common mistakes.
    """

    tenth: int | None
    lost: tuple[int, ...]
    mistakes: tuple[int, ...]


def members(book: Gradebook, rubric: Rubric, statistics: ClassStatistics) -> Mapping[str, Member]:
    """Return the figures in which each student is counted in the statistics of a rubric, by key."""
    most = int(statistics.out_of * UNITS_PER_POINT)
    counts = failure_counts(book, rubric)
    causes = groups_of(counts)
    ranked = grouped(counts)[: len(statistics.failures)]
    numbers = {cause: number for number, (cause, _) in enumerate(ranked)}
    found = {}
    for key, student, has_marks, failures, *columns in book.rows(
        f"SELECT key, id, marks, failures, {COLUMNS} {GRADED} ORDER BY key", rubric.sha256
    ):
        marks = manual_units(book, student) if has_marks else {}
        pattern = pattern_of(rubric, tuple(columns), marks)
        own = dict.fromkeys(causes[failure] for failure in failures_in(failures, rubric, marks))
        found[str(key)] = Member(
            tenth_of(pattern.grade(most), most) if pattern.counts else None,
            tuple(
                row.position
                for row, earned in zip(rubric.criteria, pattern.earned, strict=True)
                if earned is not None and earned < (units_of(row) or 1)
            ),
            tuple(numbers[cause] for cause in own if cause in numbers),
        )
    return found
