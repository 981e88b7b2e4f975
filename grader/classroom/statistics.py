"""What a class did and did not understand: the marks, each criterion's difficulty and discrimination, the commonest failures."""

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from math import sqrt

from grader.classroom.gradebook import Gradebook
from grader.classroom.work import UNITS
from grader.grading.rubric import Criterion, Rubric

_BINS = 10
_MOST_FAILURES = 20
_EARNED = {"p": 1.0, "f": 0.0, "s": 0.0}


@dataclass(frozen=True, slots=True)
class CriterionStatistics:
    """How a criterion went. `passed` of `decided` got it; the others are counted by what became of it.

    `share` is the mean share of its points that was earned (the lower, the harder). `discrimination` is the correlation of
    that share with the points in all other criteria: below about 0.2 it tells little of a student, below 0 it may be
    wrong; None where everyone did alike.
    """

    criterion: Criterion
    decided: int
    passed: int
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
    """A class at a glance. `scores` are of those who are graded, as points; `verdicts` counts everyone.

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
    """Sums over students of the share x earned of one criterion, and of the points r earned in all others."""

    def __init__(self) -> None:
        self.signs: Counter[str] = Counter()
        self.count = 0
        self.x = self.r = self.xx = self.rr = self.xr = 0.0

    def add(self, sign: str, share: float | None, rest: float, count: int) -> None:
        self.signs[sign] += count
        if share is None:
            return
        self.count += count
        self.x += share * count
        self.r += rest * count
        self.xx += share * share * count
        self.rr += rest * rest * count
        self.xr += share * rest * count

    def correlation(self) -> float | None:
        spread_x = self.count * self.xx - self.x * self.x
        spread_r = self.count * self.rr - self.r * self.r
        if spread_x <= 1e-9 or spread_r <= 1e-9:
            return None
        return (self.count * self.xr - self.x * self.r) / sqrt(spread_x * spread_r)


def statistics(book: Gradebook, rubric: Rubric) -> ClassStatistics:
    """The statistics of everyone's newest hand-in, as far as it was graded by this rubric; marks by hand are in them."""
    verdicts = {
        str(name): int(count) for name, count in book.rows("SELECT verdict, count(*) FROM grade GROUP BY verdict")
    }
    scores: Counter[int] = Counter()
    tallies = [_Tally() for _ in rubric.criteria]
    pending = 0
    for signs, rulings, score, waits, count in _patterns(book, rubric):
        scores[score] += count
        pending += count * waits
        _count(rubric, tallies, signs, rulings, count)
    values = sorted(scores.items())
    graded = scores.total()
    mean = sum(score * count for score, count in values) / graded / UNITS if graded else 0.0
    variance = sum((score / UNITS - mean) ** 2 * count for score, count in values) / graded if graded else 0.0
    criteria = tuple(_of(criterion, tally) for criterion, tally in zip(rubric.criteria, tallies, strict=True))
    return ClassStatistics(
        verdicts, rubric.points, graded, pending, mean, sqrt(variance), _at(values, 0), _at(values, (graded - 1) // 2),
        _at(values, graded - 1), _bins(values, rubric.points), criteria, _failures(book, rubric),
    )  # fmt: skip


def _patterns(book: Gradebook, rubric: Rubric) -> Iterator[tuple[str, dict[str, float], int, bool, int]]:
    """How the criteria went, and how many have it like that: signs, shares by hand, score, whether something waits, count."""
    where = "FROM grade WHERE verdict = 'graded' AND rubric = ?"
    alike = f"SELECT signs, score, pending > 0, count(*) {where} AND marks = 0 GROUP BY signs, score, pending > 0"
    for signs, score, waits, count in book.rows(alike, rubric.sha256):
        yield signs, {}, score, bool(waits), count
    points = {criterion.id: int(criterion.points * UNITS) for criterion in rubric.criteria}
    for student, signs, score, waits in book.rows(
        f"SELECT id, signs, score, pending > 0 {where} AND marks", rubric.sha256
    ):
        given = book.rows("SELECT criterion, points FROM ruling WHERE student = ?", student)
        shares = {name: value / points[name] if points[name] else 0.0 for name, value in given if name in points}
        yield signs, shares, score, bool(waits), 1


def _count(rubric: Rubric, tallies: list[_Tally], signs: str, rulings: dict[str, float], count: int) -> None:
    shares = [
        rulings.get(criterion.id, _EARNED.get(sign)) for criterion, sign in zip(rubric.criteria, signs, strict=True)
    ]
    earned = [float(each.points) * (share or 0.0) for each, share in zip(rubric.criteria, shares, strict=True)]
    total = sum(earned)
    for tally, sign, share, own in zip(tallies, signs, shares, earned, strict=True):
        tally.add(sign, share, total - own, count)


def _of(criterion: Criterion, tally: _Tally) -> CriterionStatistics:
    passed, failed, skipped, pending, errored = (tally.signs[sign] for sign in "pfs?!")
    share = tally.x / tally.count if tally.count else None
    return CriterionStatistics(
        criterion, tally.count, passed, failed, skipped, pending, errored, share, tally.correlation()
    )


def _at(values: list[tuple[int, int]], place: int) -> Decimal:
    """The score at a place among all, counted from 0."""
    for score, count in values:
        place -= count
        if place < 0:
            return Decimal(score) / UNITS
    return Decimal(0)


def _bins(values: list[tuple[int, int]], out_of: Decimal) -> tuple[int, ...]:
    bins = [0] * _BINS
    most = int(out_of * UNITS) or 1
    for score, count in values:
        bins[max(0, min(_BINS - 1, score * _BINS // most))] += count
    return tuple(bins)


def _failures(book: Gradebook, rubric: Rubric) -> tuple[Failure, ...]:
    """The commonest failures, as their checks put them."""
    counted: Counter[tuple[int, str]] = Counter()
    query = "SELECT misses, count(*) FROM grade WHERE verdict = 'graded' AND rubric = ? GROUP BY misses"
    for misses, count in book.rows(query, rubric.sha256):
        for index, message in json.loads(misses):
            counted[index, message] += count
    ranked = sorted(counted.items(), key=lambda each: (-each[1], each[0]))
    return tuple(Failure(rubric.criteria[index], message, count) for (index, message), count in ranked[:_MOST_FAILURES])
