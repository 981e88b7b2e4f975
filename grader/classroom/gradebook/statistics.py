"""Statistics of a class: the grades as they are published, each criterion, the most common
mistakes, the sections.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.student_grade import Reason, StudentGrade
from grader.classroom.results.equal_work import EqualWork, equal_work
from grader.lab.checks.outcome import in_millimetres
from grader.lab.rubric.criterion import Criterion
from grader.lab.rubric.rubric import Rubric

COUNTS = ("passed", "failed", "skipped", "pending", "errored", "carried", "marked")
_TENTHS, _MAX_MISTAKES = 10, 20


class _Summary(NamedTuple):
    """The grades of some students: their number, mean and median."""

    students: int
    mean: Decimal
    median: Decimal


class CriterionFigures(NamedTuple):
    """The students by each of COUNTS, and the mean share of the points that they earned; None if
    open or adjusted.
    """

    criterion: Criterion
    counts: Counter[str]
    share: float | None


class _CommonMistake(NamedTuple):
    """A mistake that several students made in a criterion; of one that is measured, how far it is
    off.
    """

    criterion: str
    message: str
    students: Sequence[str]


class ClassStatistics(NamedTuple):
    """The figures of a class. Students who are not on the roster, or whose submission is gone, are
    in `attention` only.

    A grade counts if it is a final mark, or that of a graded submission, after marks, adjustments
    and the late penalty; points that still need manual grading are not in it yet.
    """

    rubric: Rubric
    maximum: Decimal
    statuses: dict[str, int]  # students by status
    all: _Summary | None  # None if no grade counts
    open: int  # grades with points that still need manual grading
    late: int  # students
    tenths: Sequence[
        Sequence[str]
    ]  # students in each tenth of the maximum, which itself is in the last one
    criteria: Sequence[CriterionFigures]
    mistakes: Sequence[_CommonMistake]
    sections: dict[str, _Summary]  # without any if there is only one
    attention: dict[Reason, list[tuple[str, str]]]  # students who need attention, each with details
    equal: Sequence[EqualWork]
    names: dict[str, str]  # of all students, by key


def statistics(book: Gradebook, grades: Iterable[StudentGrade]) -> ClassStatistics:
    """Return the statistics of the grades of a class."""
    every = list(grades)
    enrolled = [
        one for one in every if one.student.is_on_roster and (one.has_final or not one.is_gone)
    ]
    counted = [one for one in enrolled if one.is_counted]
    most = book.maximum
    sections, tenths = defaultdict[str, list[Decimal]](list), [list[str]() for _ in range(_TENTHS)]
    for one in counted:
        total = one.total or Decimal(0)
        sections[one.student.section].append(total)
        tenths[max(0, min(_TENTHS - 1, int(total * _TENTHS // (most or 1))))].append(
            one.student.key
        )
    attention: dict[Reason, list[tuple[str, str]]] = {reason: [] for reason in Reason}
    for one in every:
        for reason, detail in one.concerns.items():
            attention[reason].append((one.student.key, detail))
    present = [one.stored for one in every if one.stored is not None and not one.is_gone]
    return ClassStatistics(
        book.rubric,
        most,
        dict(sorted(Counter(one.status for one in enrolled).items())),
        summary(one.total or Decimal(0) for one in counted) if counted else None,
        sum(one.obstacle is not None for one in counted),
        sum(one.late.days > 0 and not one.has_final for one in enrolled),
        tenths,
        *_criteria_figures(book, counted),
        {name: summary(values) for name, values in sorted(sections.items())}
        if len(sections) > 1
        else {},
        {reason: those for reason, those in attention.items() if those},
        equal_work(present, book.settings.handed_out),
        {one.student.key: one.student.name for one in every},
    )


def summary(totals: Iterable[Decimal]) -> _Summary:
    """Return the figures of some grades, of at least one."""
    found = sorted(totals)
    count = len(found)
    return _Summary(
        count, sum(found, Decimal(0)) / count, (found[(count - 1) // 2] + found[count // 2]) / 2
    )


def _criteria_figures(
    book: Gradebook, grades: Iterable[StudentGrade]
) -> tuple[list[CriterionFigures], list[_CommonMistake]]:
    """Return the figures of the criteria, and the most common mistakes."""
    counts, earned = defaultdict[str, Counter[str]](Counter), defaultdict[str, Decimal](Decimal)
    mistakes = defaultdict[tuple[str, str], list[tuple[str, str, float]]](list)
    for grade in grades:
        for result in grade.results:
            name = result.criterion.id
            for kind in result.kinds:
                counts[name][kind] += 1
            earned[name] += result.points
            if result.mistake:
                off = result.outcome.measured
                if isinstance(off, float | int):
                    mistakes[name, ""].append((grade.student.key, result.mistake, off))
                else:
                    mistakes[name, result.mistake].append((grade.student.key, result.mistake, 0))
    common = sorted(mistakes.items(), key=lambda item: (-len(item[1]), item[0]))[:_MAX_MISTAKES]
    rows = [
        CriterionFigures(row, counts[row.id], _share(row, counts[row.id], earned[row.id]))
        for row in book.criteria
    ]
    return rows, [
        _CommonMistake(name, _words(those), sorted(key for key, *_ in those))
        for (name, _), those in common
    ]


def _words(those: Sequence[tuple[str, str, float]]) -> str:
    """Return what students did wrong: in the same words, or how far they are off."""
    if len({words for _, words, _ in those}) == 1:
        return those[0][1]
    least, most = (in_millimetres(pick(off for *_, off in those)) for pick in (min, max))
    if least == most:
        return f"{most} off"
    return f"{least.removesuffix(' mm')} to {most} off"


def _share(row: Criterion, found: Counter[str], earned: Decimal) -> float | None:
    decided = found["decided"]
    if not decided or row.adjustment is not None:
        return None
    if row.points:
        return float(earned / row.points / decided)
    return found["passed"] / decided
