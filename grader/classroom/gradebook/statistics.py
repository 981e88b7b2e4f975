"""Statistics of a class: the distribution of scores, each criterion's difficulty and discrimination, the most common failures."""

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from math import sqrt
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import UNITS_PER_POINT
from grader.grading.rubric import Criterion, Rubric

_BINS = 10
_MAX_FAILURES = 20
_MARKED = "m"  # in place of a status letter, for a criterion with a manual mark
_VERDICTS = "SELECT verdict, count(*) FROM grade GROUP BY verdict"
_GRADED = "FROM grade WHERE verdict = 'graded' AND rubric = ?"


@dataclass(frozen=True, slots=True)
class CriterionStatistics:
    """The results of a criterion. The check passed for `passed` of `decided` students, `marked` have a manual mark.

    `share` is the mean share of its points that was earned (the lower, the harder). `discrimination` is the correlation of that
    share with the points of all other criteria: below about 0.2 the criterion says little about a student, below 0 it may be wrong.
    It is None if all students have the same result.
    """

    criterion: Criterion
    decided: int
    passed: int
    marked: int
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


class _Tally:
    """Sums over students of a criterion's points x and the points r of all other criteria, as integers without rounding."""

    def __init__(self, criterion: Criterion) -> None:
        self.criterion = criterion
        self.units = int(criterion.points * UNITS_PER_POINT)
        self.weight = self.units or 1  # a criterion without points has a share and a discrimination as well
        self.statuses: Counter[str] = Counter()
        self.count = self.x = self.r = self.xx = self.rr = self.xr = 0

    def add(self, status: str, earned: int | None, rest: int, count: int) -> None:
        self.statuses[status] += count
        if earned is None:
            return
        self.count += count
        self.x += earned * count
        self.r += rest * count
        self.xx += earned * earned * count
        self.rr += rest * rest * count
        self.xr += earned * rest * count

    def result(self) -> CriterionStatistics:
        variances = (self.count * self.xx - self.x * self.x) * (self.count * self.rr - self.r * self.r)
        correlation = (self.count * self.xr - self.x * self.r) / sqrt(variances) if variances else None
        share = self.x / (self.count * self.weight) if self.count else None
        passed, marked, failed, skipped, pending, errored = (self.statuses[status] for status in f"p{_MARKED}fs?!")
        return CriterionStatistics(
            self.criterion, self.count, passed, marked, failed, skipped, pending, errored, share, correlation
        )


class _Pattern(NamedTuple):
    """A combination of results, and how many students have it; `marks` are manual points in ten-thousandths."""

    statuses: str
    score: int
    is_pending: int
    students: int
    marks: Mapping[str, int]


def statistics(book: Gradebook, rubric: Rubric) -> ClassStatistics:
    """Return the statistics of the newest submissions that were graded with this rubric, with their manual marks."""
    scores: Counter[int] = Counter()
    tallies = [_Tally(criterion) for criterion in rubric.criteria]
    pending = 0
    for pattern in _patterns(book, rubric):
        scores[pattern.score] += pattern.students
        pending += pattern.students * pattern.is_pending
        _count(tallies, pattern)
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
        pending=pending,
        mean=mean,
        deviation=sqrt(squares / graded) if graded else 0.0,
        lowest=_ranked_score(values, 0),
        median=(_ranked_score(values, (graded - 1) // 2) + _ranked_score(values, graded // 2)) / 2,
        highest=_ranked_score(values, graded - 1),
        bins=_bins(values, rubric.points),
        criteria=tuple(tally.result() for tally in tallies),
        failures=tuple(Failure(rubric.criteria[index], message, count) for (index, message), count in ranked),
    )


def _patterns(book: Gradebook, rubric: Rubric) -> Iterator[_Pattern]:
    columns = "statuses, score, pending > 0"
    query = f"SELECT {columns}, count(*) {_GRADED} AND marks = 0 GROUP BY {columns}"
    for row in book.rows(query, rubric.sha256):
        yield _Pattern._make((*row, {}))
    for *results, student in book.rows(f"SELECT {columns}, 1, id {_GRADED} AND marks", rubric.sha256):
        yield _Pattern._make((*results, _marks(book, student)))


def _marks(book: Gradebook, student: int) -> dict[str, int]:
    query = "SELECT criterion, points FROM manual_mark WHERE student = ?"
    return {str(name): int(points) for name, points in book.rows(query, student)}


def _count(tallies: list[_Tally], pattern: _Pattern) -> None:
    earned: list[int | None] = []
    for tally, status in zip(tallies, pattern.statuses, strict=True):
        automatic = {"p": tally.weight, "f": 0, "s": 0}.get(status)
        earned.append(pattern.marks.get(tally.criterion.id, automatic))
    own = [points or 0 if tally.units else 0 for tally, points in zip(tallies, earned, strict=True)]
    for tally, status, points, part in zip(tallies, pattern.statuses, earned, own, strict=True):
        shown = _MARKED if tally.criterion.id in pattern.marks else status
        tally.add(shown, points, sum(own) - part, pattern.students)


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
    query = f"SELECT failures, count(*) {_GRADED} AND marks = 0 GROUP BY failures"
    for failures, count in book.rows(query, rubric.sha256):
        yield from ((index, message, count) for index, message in json.loads(failures))
    for student, failures in book.rows(f"SELECT id, failures {_GRADED} AND marks", rubric.sha256):
        marks = _marks(book, student)
        for index, message in json.loads(failures):
            criterion = rubric.criteria[index]
            if marks.get(criterion.id) != criterion.points * UNITS_PER_POINT:
                yield index, message, 1
