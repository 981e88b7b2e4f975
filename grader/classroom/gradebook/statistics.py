"""Statistics of a class: the distribution of scores, each criterion's difficulty and discrimination, the most common failures."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from math import sqrt
from typing import NamedTuple

from grader.classroom.gradebook.failures import grouped
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.patterns import Pattern, failure_counts, patterns_of, undecided_reasons, units_of
from grader.classroom.gradebook.result import SETTLED, UNITS_PER_POINT
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric

_BINS = 10
_MAX_FAILURES = 20
_MARKED = "m"  # in place of a status letter, for a criterion with a manual mark
_VERDICTS = "SELECT verdict, is_excused, count(*), count(final) FROM grade GROUP BY verdict, is_excused"


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

    @property
    def of(self) -> int:
        """The number of students for whom it was graded, or needs manual grading."""
        return self.decided + self.pending + self.errored


@dataclass(frozen=True, slots=True)
class CommonFailure:
    """A failure that several students have in common, and their number."""

    criterion: Criterion
    message: str
    count: int


class PointTotals(NamedTuple):
    """The points of all graded submissions: earned, lost, and not decided yet."""

    earned: Decimal
    lost: Decimal
    pending: Decimal


@dataclass(frozen=True, slots=True)
class ClassStatistics:
    """The statistics of a class: the scores of graded submissions without late penalties.

    `verdicts` counts all students but the `excused`. `final` students have a final mark, which replaces the score; only those
    with a graded submission, `final_graded`, are in the statistics.

    `mean` and the figures below it are over decided points: the grade of a student is the share that was earned of the points that
    are decided, times the maximum of a submission, `out_of`. Students most of whose automatic points are undecided, `undecided`,
    are not in them.
    `pending` counts students with points that need manual grading, `reasons` why automatic points do, the most frequent first.
    `bins` counts grades by tenths of the maximum; the maximum itself is in the last bin.
    """

    verdicts: Mapping[str, int]
    out_of: Decimal
    excused: int
    final: int
    final_graded: int
    graded: int
    pending: int
    undecided: int
    points: PointTotals
    reasons: tuple[tuple[str, int], ...]
    mean: float
    deviation: float
    lowest: Decimal
    median: Decimal
    highest: Decimal
    bins: tuple[int, ...]
    criteria: tuple[CriterionStatistics, ...]
    failures: tuple[CommonFailure, ...]


def statistics(book: Gradebook, rubric: Rubric) -> ClassStatistics:
    """Return the statistics of the newest submissions that were graded with this rubric, with their manual marks."""
    patterns = list(patterns_of(book, rubric))
    most = max((pattern.out_of for pattern in patterns), default=int(rubric.points * UNITS_PER_POINT))
    scores: Counter[int] = Counter()
    for pattern in patterns:
        if pattern.counts:
            scores[pattern.grade(most)] += pattern.students
    values, decided = sorted(scores.items()), scores.total()
    graded = sum(pattern.students for pattern in patterns)
    mean = sum(score * count for score, count in values) / decided / UNITS_PER_POINT if decided else 0.0
    squares = sum((score / UNITS_PER_POINT - mean) ** 2 * count for score, count in values)
    graded_letters = {(index, status) for pattern in patterns for index, status in enumerate(pattern.statuses)}
    letters = f"pfs?!{SETTLED}"
    criteria = [row for row in rubric.criteria if any((row.position, letter) in graded_letters for letter in letters)]
    failures = grouped(failure_counts(book, rubric))[:_MAX_FAILURES]
    verdicts = list(book.rows(_VERDICTS))
    return ClassStatistics(
        verdicts={str(verdict): int(count) for verdict, is_excused, count, _ in verdicts if not is_excused},
        excused=sum(count for _, is_excused, count, _ in verdicts if is_excused),
        final=sum(final for *_, final in verdicts),
        final_graded=sum(pattern.students for pattern in patterns if pattern.final is not None),
        out_of=_points(most),
        graded=graded,
        pending=sum(pattern.students for pattern in patterns if pattern.pending),
        undecided=graded - decided,
        points=_totals(patterns),
        reasons=undecided_reasons(book, rubric),
        mean=mean,
        deviation=sqrt(squares / decided) if decided else 0.0,
        lowest=_ranked_score(values, 0),
        median=(_ranked_score(values, (decided - 1) // 2) + _ranked_score(values, decided // 2)) / 2,
        highest=_ranked_score(values, decided - 1),
        bins=_bins(values, most),
        criteria=tuple(_criterion(criterion, patterns) for criterion in criteria or rubric.criteria),
        failures=tuple(CommonFailure(rubric.criteria[kind.position], kind.mistake, count) for kind, count in failures),
    )


def _totals(patterns: Iterable[Pattern]) -> PointTotals:
    earned = pending = lost = 0
    for pattern in patterns:
        earned += pattern.score * pattern.students
        pending += pattern.pending * pattern.students
        without_bonus = pattern.score - pattern.bonus
        lost += max(0, pattern.decided - without_bonus) * pattern.students  # a mark may exceed the maximum
    return PointTotals(_points(earned), _points(lost), _points(pending))


def _points(units: int) -> Decimal:
    return Decimal(units) / UNITS_PER_POINT


def _criterion(criterion: Criterion, patterns: Iterable[Pattern]) -> CriterionStatistics:
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
    share = x / (count * (units_of(criterion) or 1)) if count else None
    passed, marked, carried, failed, skipped, pending, errored = (statuses[s] for s in f"p{_MARKED}{SETTLED}fs?!")
    counts = count, passed, marked, carried, failed, skipped, pending, errored
    return CriterionStatistics(criterion, *counts, share, correlation)


def _ranked_score(values: list[tuple[int, int]], rank: int) -> Decimal:
    """Return the score at a rank, counted from 0, in sorted pairs of score and count."""
    for score, count in values:
        rank -= count
        if rank < 0:
            return _points(score)
    return Decimal(0)


def _bins(values: list[tuple[int, int]], most: int) -> tuple[int, ...]:
    bins = [0] * _BINS
    for score, count in values:
        bins[tenth_of(score, most)] += count
    return tuple(bins)


def tenth_of(score: int, most: int) -> int:
    """Return in which tenth of the maximum a grade is, from 0 to 9."""
    return max(0, min(_BINS - 1, score * _BINS // (most or 1)))
