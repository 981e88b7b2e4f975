"""Statistics of the criteria of a class: how many passed each, its difficulty, discrimination, usual deductions."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from math import sqrt
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.graded_students import GradedStudent, full_units
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric

_SEPARATOR = re.compile(r"\s*[;\n]\s*")  # of the comments in one


@dataclass(frozen=True, slots=True)
class CriterionStatistics:
    """The results of a criterion. The check passed for `passed` of `decided` students, `manual_marks` have one.

    For `carried` students it failed because of an earlier mistake alone: they have the points.

    `share` is the mean share of its points that was earned (the lower, the harder). `discrimination` is the correlation
    of that share with the points of all other criteria: below about 0.2 the criterion says little about a student,
    below 0 it may be wrong. It is None if all students have the same result.
    """

    criterion: Criterion
    decided: int
    passed: int
    manual_marks: int
    carried: int
    failed: int
    skipped: int
    pending: int
    errored: int
    share: float | None
    discrimination: float | None

    @property
    def of(self) -> int:
        """The number of students for whom it was graded, or needs manual grading."""
        return self.decided + self.pending + self.errored


class _Pattern(NamedTuple):
    """The results that some students have in common; `total` are the points of all criteria."""

    statuses: tuple[str, ...]
    earned: tuple[int | None, ...]
    marked: tuple[int, ...]
    total: int


def criteria_statistics(rubric: Rubric, students: Sequence[GradedStudent]) -> Iterator[CriterionStatistics]:
    """Yield the figures of the criteria that were graded; of all, if none was."""
    # Most students have the same results as others: the figures of criteria add up these few rows.
    worth = [row.position for row in rubric.criteria if row.points]
    patterns = Counter(
        _Pattern(tuple(it.statuses), tuple(it.earned), it.marked, sum(it.earned[position] or 0 for position in worth))
        for it in students
    )
    graded = {at for pattern in patterns for at, status in enumerate(pattern.statuses) if status != "ungraded"}
    criteria = [row for row in rubric.criteria if row.position in graded]
    yield from (_criterion(criterion, patterns) for criterion in criteria or rubric.criteria)


def _criterion(criterion: Criterion, patterns: Mapping[_Pattern, int]) -> CriterionStatistics:
    """Return the statistics from sums over its points x and the other criteria's points r: integers, so exact."""
    found: Counter[str] = Counter()
    position = criterion.position
    count = x = r = xx = rr = xr = 0
    for pattern, number in patterns.items():
        found["manual_marks" if position in pattern.marked else pattern.statuses[position]] += number
        earned = pattern.earned[position]
        if earned is not None:
            rest = pattern.total - (earned if criterion.points else 0)
            count += number
            x += earned * number
            r += rest * number
            xx += earned * earned * number
            rr += rest * rest * number
            xr += earned * rest * number
    variances = (count * xx - x * x) * (count * rr - r * r)
    return CriterionStatistics(
        criterion,
        decided=count,
        passed=found["passed"],
        manual_marks=found["manual_marks"],
        carried=found["carried"] + found["adjusted"],
        failed=found["failed"],
        skipped=found["skipped"],
        pending=found["pending"],
        errored=found["errored"],
        share=x / (count * full_units(criterion)) if count else None,
        discrimination=(count * xr - x * r) / sqrt(variances) if variances else None,
    )


class ChoiceCount(NamedTuple):
    """A usual deduction of a criterion, its points below 0, and the number of students whose mark has its comment."""

    criterion: Criterion
    text: str
    points: Decimal
    students: int


def choice_counts(book: Gradebook, rubric: Rubric) -> tuple[ChoiceCount, ...]:
    """Return how often each usual deduction was given, in the order of the rubric."""
    criteria = [row for row in rubric.criteria if row.choices]
    counts = Counter(
        (str(name), text)
        for name, comment in (book.rows("SELECT criterion, comment FROM manual_mark") if criteria else ())
        for text in set(_SEPARATOR.split(comment.strip()))
    )
    return tuple(
        ChoiceCount(row, text, points, counts[row.id, text]) for row in criteria for text, points in row.choices.items()
    )
