"""Statistics of a class: distribution of scores, difficulty and discrimination of criteria, most common failures."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from math import sqrt
from typing import Any, NamedTuple

from grader.classroom.gradebook.criterion_statistics import CriterionStatistics, criteria_statistics
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.graded_students import GradedStudent, full_units, graded_students, grouped, groups_of
from grader.classroom.gradebook.result import UNITS_PER_POINT, points_from_units, units_of
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric

_BINS = 10
_MAX_FAILURES = 20
_VERDICTS = "SELECT verdict, is_excused, count(*), count(final) FROM grade GROUP BY verdict, is_excused"


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

    `verdicts` counts all students but the `excused`. `final` students have a final mark, which replaces the score; only
    those with a graded submission, `final_graded`, are in the statistics.

    `mean` and the figures below it are over decided points: the grade of a student is the share that was earned of the
    points that are decided, times the maximum of a submission, `out_of`. Students most of whose automatic points are
    undecided, `undecided`, are not in them. `pending` counts students with points that need manual grading, `reasons`
    why automatic points do, the most frequent first. `bins` counts grades by tenths of the maximum; the maximum itself
    is in the last bin.
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
    students = list(graded_students(book, rubric))
    most = max((student.out_of for student in students), default=units_of(rubric.points))
    values = sorted(Counter(student.grade(most) for student in students if student.counts).items())
    decided = sum(count for _, count in values)
    causes = grouped(Counter(failure for student in students for failure in student.failures))
    verdicts = list(book.rows(_VERDICTS))
    return ClassStatistics(
        verdicts={str(verdict): int(count) for verdict, is_excused, count, _ in verdicts if not is_excused},
        excused=sum(count for _, is_excused, count, _ in verdicts if is_excused),
        final=sum(final for *_, final in verdicts),
        final_graded=sum(student.final is not None for student in students),
        out_of=points_from_units(most),
        graded=len(students),
        pending=sum(student.pending > 0 for student in students),
        undecided=len(students) - decided,
        points=_totals(students),
        reasons=_reasons(students),
        **_figures(values, decided),
        bins=_bins(values, most),
        criteria=tuple(criteria_statistics(rubric, students)),
        failures=tuple(
            CommonFailure(rubric.criteria[cause.position], cause.mistake, count)
            for cause, count in causes[:_MAX_FAILURES]
        ),
    )


def _figures(values: list[tuple[int, int]], total: int) -> dict[str, Any]:
    """Return the figures in points of scores in units, in order with their counts, which are `total` altogether."""
    mean = sum(score * count for score, count in values) / max(total, 1) / UNITS_PER_POINT
    squares = sum((score / UNITS_PER_POINT - mean) ** 2 * count for score, count in values)
    return {
        "mean": mean,
        "deviation": sqrt(squares / max(total, 1)),
        "lowest": _ranked_score(values, 0),
        "median": (_ranked_score(values, (total - 1) // 2) + _ranked_score(values, total // 2)) / 2,
        "highest": _ranked_score(values, total - 1),
    }


class Member(NamedTuple):
    """The figures in which a graded student is counted.

    `tenth` is None for a grade that is not in the statistics; `lost` are the positions of criteria with fewer points
    than the maximum, `mistakes` those of the common mistakes.
    """

    tenth: int | None
    lost: tuple[int, ...]
    mistakes: tuple[int, ...]


def members(book: Gradebook, rubric: Rubric, found: ClassStatistics) -> Mapping[str, Member]:
    """Return the figures in which each student is counted in the statistics of a rubric, by key."""
    students, most = list(graded_students(book, rubric)), units_of(found.out_of)
    counts = Counter(failure for student in students for failure in student.failures)
    causes = groups_of(counts)
    numbers = {cause: number for number, (cause, _) in enumerate(grouped(counts)[: len(found.failures)])}
    full = [full_units(row) for row in rubric.criteria]
    members = {}
    for student in sorted(students, key=lambda student: student.key):
        own = dict.fromkeys(causes[failure] for failure in student.failures)
        members[student.key] = Member(
            tenth_of(student.grade(most), most) if student.counts else None,
            tuple(at for at, earned in enumerate(student.earned) if earned is not None and earned < full[at]),
            tuple(numbers[cause] for cause in own if cause in numbers),
        )
    return members


def _reasons(students: Iterable[GradedStudent]) -> tuple[tuple[str, int], ...]:
    """Return the reason for most points of each student that need manual grading, the most frequent first, counted."""
    waiting = [student.reasons for student in students if student.reasons and student.pending]
    found = Counter(max(reasons, key=lambda reason: (reasons[reason], reason)) for reasons in waiting)
    return tuple(sorted(found.items(), key=lambda item: (-item[1], item[0])))


def _totals(students: Iterable[GradedStudent]) -> PointTotals:
    earned = pending = lost = 0
    for student in students:
        earned += student.score
        pending += student.pending
        lost += max(0, student.decided - (student.score - student.bonus))  # a mark may exceed the maximum
    return PointTotals(points_from_units(earned), points_from_units(lost), points_from_units(pending))


def _ranked_score(values: list[tuple[int, int]], rank: int) -> Decimal:
    """Return the score at a rank, counted from 0, in sorted pairs of score and count."""
    for score, count in values:
        rank -= count
        if rank < 0:
            return points_from_units(score)
    return Decimal(0)


def _bins(values: list[tuple[int, int]], most: int) -> tuple[int, ...]:
    bins = [0] * _BINS
    for score, count in values:
        bins[tenth_of(score, most)] += count
    return tuple(bins)


def tenth_of(score: int, most: int) -> int:
    """Return in which tenth of the maximum a grade is, from 0 to 9."""
    return max(0, min(_BINS - 1, score * _BINS // (most or 1)))
