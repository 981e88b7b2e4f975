"""What a class did and did not understand: the marks, each criterion's difficulty and discrimination, the commonest failures."""

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
_BY_HAND = "m"  # in place of a sign, where a person has decided


@dataclass(frozen=True, slots=True)
class CriterionStatistics:
    """How a criterion went. `passed` of `decided` got it by the check, a person has `marked` others; the rest is counted as well.

    `share` is the mean share of its points that was earned (the lower, the harder). `discrimination` is the correlation of
    that share with the points in all other criteria: below about 0.2 it tells little of a student, below 0 it may be
    wrong; None where everyone did alike.
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
    """What several students did alike, and how many they are."""

    criterion: Criterion
    message: str
    count: int


@dataclass(frozen=True, slots=True)
class ClassStatistics:
    """A class at a glance: the marks of those who are graded, before what being late costs; `verdicts` counts everyone.

    `bins` counts the graded by tenths of the points that can be earned; all of them is in the last one.
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
    """Sums over students of what x a criterion earned and of what r all others did, in whole numbers: nothing is rounded."""

    def __init__(self, criterion: Criterion) -> None:
        self.criterion = criterion
        self.units = int(criterion.points * UNITS_PER_POINT)
        self.worth = self.units or 1  # that one without points went well can be told as well
        self.signs: Counter[str] = Counter()
        self.count = self.x = self.r = self.xx = self.rr = self.xr = 0

    def earned(self, sign: str) -> int | None:
        """What it earns by its check; None where that has not decided."""
        return {"p": self.worth, "f": 0, "s": 0}.get(sign)

    def add(self, sign: str, earned: int | None, rest: int, count: int) -> None:
        self.signs[sign] += count
        if earned is None:
            return
        self.count += count
        self.x += earned * count
        self.r += rest * count
        self.xx += earned * earned * count
        self.rr += rest * rest * count
        self.xr += earned * rest * count

    def correlation(self) -> float | None:
        spread_x = self.count * self.xx - self.x * self.x
        spread_r = self.count * self.rr - self.r * self.r
        if not spread_x or not spread_r:
            return None
        return (self.count * self.xr - self.x * self.r) / sqrt(spread_x * spread_r)

    def result(self) -> CriterionStatistics:
        passed, marked, failed, skipped, pending, errored = (self.signs[sign] for sign in f"p{_BY_HAND}fs?!")
        share = self.x / (self.count * self.worth) if self.count else None
        return CriterionStatistics(
            self.criterion, self.count, passed, marked, failed, skipped, pending, errored, share, self.correlation()
        )


def statistics(book: Gradebook, rubric: Rubric) -> ClassStatistics:
    """The statistics of everyone's newest hand-in, as far as it was graded by this rubric; marks by hand are in them."""
    verdicts = {
        str(name): int(count) for name, count in book.rows("SELECT verdict, count(*) FROM grade GROUP BY verdict")
    }
    scores: Counter[int] = Counter()
    failures: Counter[tuple[int, str]] = Counter()
    tallies = [_Tally(criterion) for criterion in rubric.criteria]
    pending = 0
    for alike in _patterns(book, rubric):
        scores[alike.score] += alike.many
        pending += alike.many * alike.waits
        _count(tallies, alike)
    for index, message, count in _misses(book, rubric):
        failures[index, message] += count
    values = sorted(scores.items())
    graded = scores.total()
    mean = sum(score * count for score, count in values) / graded / UNITS_PER_POINT if graded else 0.0
    variance = sum((score / UNITS_PER_POINT - mean) ** 2 * count for score, count in values) / graded if graded else 0.0
    median = (_at(values, (graded - 1) // 2) + _at(values, graded // 2)) / 2
    ranked = sorted(failures.items(), key=lambda each: (-each[1], each[0]))[:_MAX_FAILURES]
    return ClassStatistics(
        verdicts, rubric.points, graded, pending, mean, sqrt(variance), _at(values, 0), median,
        _at(values, graded - 1), _bins(values, rubric.points), tuple(tally.result() for tally in tallies),
        tuple(Failure(rubric.criteria[index], message, count) for (index, message), count in ranked),
    )  # fmt: skip


class _Alike(NamedTuple):
    """How the criteria went, and how many have it like that; `marks` are points by hand, in ten-thousandths."""

    signs: str
    score: int
    waits: bool
    many: int
    marks: Mapping[str, int]


_GRADED = "FROM grade WHERE verdict = 'graded' AND rubric = ?"


def _patterns(book: Gradebook, rubric: Rubric) -> Iterator[_Alike]:
    columns = "signs, score, pending > 0"
    query = f"SELECT {columns}, count(*) {_GRADED} AND marks = 0 GROUP BY {columns}"
    for signs, score, waits, count in book.rows(query, rubric.sha256):
        yield _Alike(signs, score, bool(waits), count, {})
    for student, signs, score, waits in book.rows(f"SELECT id, {columns} {_GRADED} AND marks", rubric.sha256):
        yield _Alike(signs, score, bool(waits), 1, _marks(book, student))


def _marks(book: Gradebook, student: int) -> dict[str, int]:
    return {str(name): int(points) for name, points in book.rows(_MARKS, student)}


_MARKS = "SELECT criterion, points FROM ruling WHERE student = ?"


def _count(tallies: list[_Tally], alike: _Alike) -> None:
    names = [tally.criterion.id for tally in tallies]
    signs = [_BY_HAND if name in alike.marks else sign for name, sign in zip(names, alike.signs, strict=True)]
    earned = [
        alike.marks.get(name, tally.earned(sign)) for tally, name, sign in zip(tallies, names, signs, strict=True)
    ]
    own = [points or 0 if tally.units else 0 for tally, points in zip(tallies, earned, strict=True)]
    total = sum(own)
    for tally, sign, points, part in zip(tallies, signs, earned, own, strict=True):
        tally.add(sign, points, total - part, alike.many)


def _at(values: list[tuple[int, int]], place: int) -> Decimal:
    """The score at a place among all, counted from 0."""
    for score, count in values:
        place -= count
        if place < 0:
            return Decimal(score) / UNITS_PER_POINT
    return Decimal(0)


def _bins(values: list[tuple[int, int]], out_of: Decimal) -> tuple[int, ...]:
    bins = [0] * _BINS
    most = int(out_of * UNITS_PER_POINT) or 1
    for score, count in values:
        bins[max(0, min(_BINS - 1, score * _BINS // most))] += count
    return tuple(bins)


def _misses(book: Gradebook, rubric: Rubric) -> Iterator[tuple[int, str, int]]:
    """What went wrong, as the checks put it, and how often; not where a person has given all points for it."""
    query = f"SELECT misses, count(*) {_GRADED} AND marks = 0 GROUP BY misses"
    for misses, count in book.rows(query, rubric.sha256):
        yield from ((index, message, count) for index, message in json.loads(misses))
    for student, misses in book.rows(f"SELECT id, misses {_GRADED} AND marks", rubric.sha256):
        marks = _marks(book, student)
        for index, message in json.loads(misses):
            criterion = rubric.criteria[index]
            if marks.get(criterion.id) != criterion.points * UNITS_PER_POINT:
                yield index, message, 1
