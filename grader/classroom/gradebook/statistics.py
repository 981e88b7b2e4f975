"""Statistics of a class: the distribution of scores, each criterion's difficulty and discrimination, the most common failures."""

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import chain
from math import sqrt
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import CARRIED, EARNED, UNITS_PER_POINT
from grader.grading.rubric import Criterion, Rubric

_BINS = 10
_MAX_FAILURES = 20
_MARKED = "m"  # in place of a status letter, for a criterion with a manual mark
_VERDICTS = "SELECT verdict, count(*) FROM grade GROUP BY verdict"
_GRADED = "FROM grade WHERE verdict = 'graded' AND rubric = ?"


@dataclass(frozen=True, slots=True)
class CriterionStatistics:
    """The results of a criterion. The check passed for `passed` of `decided` students, `marked` have a manual mark.

    For `carried` students it failed because of an earlier mistake alone: they have the points.

    `share` is the mean share of its points that was earned (the lower, the harder). `discrimination` is the correlation of that
    share with the points of all other criteria: below about 0.2 the criterion says little about a student, below 0 it may be wrong.
    It is None if all students have the same result.
    """

    criterion: Criterion
    decided: int
    passed: int
    marked: int
    carried: int
    failed: int
    skipped: int
    pending: int
    errored: int
    share: float | None
    discrimination: float | None


@dataclass(frozen=True, slots=True)
class Failure:
    """A failure that several students have in common, and their number."""

    criterion: Criterion
    message: str
    count: int


@dataclass(frozen=True, slots=True)
class ClassStatistics:
    """A class at a glance: the scores of graded submissions without late penalties; `verdicts` counts all students.

    `bins` counts scores by tenths of the maximum; the maximum itself is in the last bin.
    """

    verdicts: Mapping[str, int]
    out_of: Decimal
    graded: int
    pending: int
    mean: float
    deviation: float
    lowest: Decimal
    median: Decimal
    highest: Decimal
    bins: tuple[int, ...]
    criteria: tuple[CriterionStatistics, ...]
    failures: tuple[Failure, ...]


class _Pattern(NamedTuple):
    """A combination of results, and how many students have it.

    `marks` are manual points in ten-thousandths, `earned` those of each criterion, None where it is not decided; a criterion without
    points has 1 if it passed, so that it has a share and a discrimination as well. `total` is the sum over the others.
    """

    statuses: str
    score: int
    is_pending: int
    students: int
    marks: Mapping[str, int]
    earned: Sequence[int | None]
    total: int


def statistics(book: Gradebook, rubric: Rubric) -> ClassStatistics:
    """Return the statistics of the newest submissions that were graded with this rubric, with their manual marks."""
    scores: Counter[int] = Counter()
    patterns = list(_patterns(book, rubric))
    for pattern in patterns:
        scores[pattern.score] += pattern.students
    failures: Counter[tuple[int, str]] = Counter()
    for index, message, count in _failures(book, rubric):
        failures[index, message] += count
    ranked = sorted(failures.items(), key=lambda item: (-item[1], item[0]))[:_MAX_FAILURES]
    values = sorted(scores.items())
    graded = scores.total()
    mean = sum(score * count for score, count in values) / graded / UNITS_PER_POINT if graded else 0.0
    squares = sum((score / UNITS_PER_POINT - mean) ** 2 * count for score, count in values)
    return ClassStatistics(
        verdicts={str(verdict): int(count) for verdict, count in book.rows(_VERDICTS)},
        out_of=rubric.points,
        graded=graded,
        pending=sum(pattern.students * pattern.is_pending for pattern in patterns),
        mean=mean,
        deviation=sqrt(squares / graded) if graded else 0.0,
        lowest=_ranked_score(values, 0),
        median=(_ranked_score(values, (graded - 1) // 2) + _ranked_score(values, graded // 2)) / 2,
        highest=_ranked_score(values, graded - 1),
        bins=_bins(values, rubric.points),
        criteria=tuple(_criterion(criterion, patterns) for criterion in rubric.criteria),
        failures=tuple(Failure(rubric.criteria[index], message, count) for (index, message), count in ranked),
    )


def _patterns(book: Gradebook, rubric: Rubric) -> Iterator[_Pattern]:
    columns = "statuses, score, pending > 0"
    unmarked = book.rows(f"SELECT {columns}, count(*), 0 {_GRADED} AND marks = 0 GROUP BY {columns}", rubric.sha256)
    marked = book.rows(f"SELECT {columns}, 1, id {_GRADED} AND marks", rubric.sha256)
    for statuses, score, is_pending, students, student in chain(unmarked, marked):
        marks = _marks(book, student) if student else {}
        earned = [
            marks.get(criterion.id, (_units(criterion) or 1) * EARNED[status] if status in EARNED else None)
            for criterion, status in zip(rubric.criteria, statuses, strict=True)
        ]
        total = sum(units or 0 for units, criterion in zip(earned, rubric.criteria, strict=True) if criterion.points)
        yield _Pattern(statuses, score, is_pending, students, marks, earned, total)


def _units(criterion: Criterion) -> int:
    return int(criterion.points * UNITS_PER_POINT)


def _marks(book: Gradebook, student: int) -> dict[str, int]:
    query = "SELECT criterion, points FROM manual_mark WHERE student = ?"
    return {str(name): int(points) for name, points in book.rows(query, student)}


def _criterion(criterion: Criterion, patterns: Iterable[_Pattern]) -> CriterionStatistics:
    """Return the statistics from sums over its points x and the points r of all other criteria, integers without rounding."""
    statuses: Counter[str] = Counter()
    count = x = r = xx = rr = xr = 0
    for pattern in patterns:
        number = pattern.students
        statuses[_MARKED if criterion.id in pattern.marks else pattern.statuses[criterion.position]] += number
        earned = pattern.earned[criterion.position]
        if earned is not None:
            rest = pattern.total - (earned if criterion.points else 0)
            count += number
            x += earned * number
            r += rest * number
            xx += earned * earned * number
            rr += rest * rest * number
            xr += earned * rest * number
    variances = (count * xx - x * x) * (count * rr - r * r)
    correlation = (count * xr - x * r) / sqrt(variances) if variances else None
    share = x / (count * (_units(criterion) or 1)) if count else None
    passed, marked, carried, failed, skipped, pending, errored = (statuses[s] for s in f"p{_MARKED}{CARRIED}fs?!")
    counts = count, passed, marked, carried, failed, skipped, pending, errored
    return CriterionStatistics(criterion, *counts, share, correlation)


def _ranked_score(values: list[tuple[int, int]], rank: int) -> Decimal:
    """Return the score at a rank, counted from 0, in sorted pairs of score and count."""
    for score, count in values:
        rank -= count
        if rank < 0:
            return Decimal(score) / UNITS_PER_POINT
    return Decimal(0)


def _bins(values: list[tuple[int, int]], out_of: Decimal) -> tuple[int, ...]:
    bins = [0] * _BINS
    maximum = int(out_of * UNITS_PER_POINT) or 1
    for score, count in values:
        bins[max(0, min(_BINS - 1, score * _BINS // maximum))] += count
    return tuple(bins)


def _failures(book: Gradebook, rubric: Rubric) -> Iterator[tuple[int, str, int]]:
    """Yield the position of a criterion, the failure and a count, except where a manual mark gives all points."""
    unmarked = book.rows(f"SELECT failures, count(*), 0 {_GRADED} AND marks = 0 GROUP BY failures", rubric.sha256)
    marked = book.rows(f"SELECT failures, 1, id {_GRADED} AND marks", rubric.sha256)
    for failures, count, student in chain(unmarked, marked):
        marks = _marks(book, student) if student else {}
        for index, message in json.loads(failures):
            if marks.get(rubric.criteria[index].id) != _units(rubric.criteria[index]):
                yield index, message, count
