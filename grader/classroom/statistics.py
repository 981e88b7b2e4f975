"""Statistics of a class: the grades as they are published, each criterion, the most common mistakes, the sections."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from decimal import Decimal
from statistics import median
from typing import NamedTuple

from grader.classroom.equal_work import EqualWork, equal_work
from grader.classroom.grade_table import status_of
from grader.classroom.grades import Class
from grader.classroom.student_grade import Reason, StudentGrade
from grader.grading.criterion import Criterion
from grader.grading.report import Result
from grader.grading.rubric import Rubric
from grader.text import format_points

COUNTS = ("passed", "failed", "skipped", "pending", "errored", "carried", "marked")
_TENTHS, _MAX_MISTAKES = 10, 20


class Summary(NamedTuple):
    """The grades of some students: their number, mean, median, lowest and highest."""

    students: int
    mean: Decimal
    median: Decimal
    lowest: Decimal
    highest: Decimal


class CriterionFigures(NamedTuple):
    """The students by each of COUNTS, and the mean share of the points that they earned; None if open or adjusted."""

    criterion: Criterion
    counts: Counter[str]
    share: float | None


class Mistake(NamedTuple):
    """A mistake that several students made in a criterion."""

    criterion: str
    message: str
    students: Sequence[str]


class ClassStatistics(NamedTuple):
    """The figures of a class. Visitors who are not on the roster, and what has gone, are in `attention` only.

    A grade counts if it is a final mark, or that of a graded submission, after marks, adjustments and the late penalty;
    points that still need manual grading are not in it yet, and `open` is the number of such grades. `tenths` are the
    keys of the students in each tenth of the maximum, which itself is in the last one. `attention` are those for whom a
    person is needed, each with details; `names` are those of all students by key.
    """

    rubric: Rubric
    maximum: Decimal
    statuses: dict[str, int]
    all: Summary | None
    open: int
    late: int
    tenths: Sequence[Sequence[str]]
    criteria: Sequence[CriterionFigures]
    mistakes: Sequence[Mistake]
    sections: dict[str, Summary]
    attention: dict[Reason, list[tuple[str, str]]]
    equal: Sequence[EqualWork]
    names: dict[str, str]


def counts(grade: StudentGrade) -> bool:
    """Return whether a grade is in the figures."""
    is_graded = grade.graded is not None and grade.graded.verdict == "graded"
    is_in = (is_graded and not (grade.is_gone or grade.is_excused)) or grade.published is not None
    return is_in and grade.student.is_on_roster


def total_text(grade: StudentGrade) -> str:
    """Return the grade, empty where there is none or nothing could be graded."""
    is_ungraded = grade.graded is not None and grade.graded.verdict != "graded" and not grade.total
    return "" if grade.total is None or (is_ungraded and grade.why_open) else format_points(grade.total)


def losses(grade: StudentGrade) -> list[tuple[Decimal, str]]:
    """Return the points that a student lost by mistakes or marks, and the criterion.

    The most points come first, and after all others what was skipped because of another criterion.
    """
    results = grade.report.results if grade.report is not None and not grade.has_final else ()
    lost = [row for row in results if (row.is_lost or row.manual_mark) and row.points < row.criterion.maximum]
    lost.sort(key=lambda row: (row.outcome.status == "skipped", row.points - row.criterion.maximum, row.criterion.id))
    return [(row.criterion.maximum - row.points, row.criterion.id) for row in lost]


def statistics(book: Class, grades: Iterable[StudentGrade]) -> ClassStatistics:
    """Return the statistics of the grades of a class."""
    every = list(grades)
    enrolled = [one for one in every if one.student.is_on_roster and (one.has_final or not one.is_gone)]
    counted = [one for one in enrolled if counts(one)]
    totals = {one.student.key: one.total or Decimal(0) for one in counted}
    most = sum((row.maximum for row in book.criteria), Decimal(0))
    sections: defaultdict[str, list[Decimal]] = defaultdict(list)
    for one in counted:
        sections[one.student.section].append(totals[one.student.key])
    tenths = [list[str]() for _ in range(_TENTHS)]
    for key, total in totals.items():
        tenths[max(0, min(_TENTHS - 1, int(total * _TENTHS // (most or 1))))].append(key)
    attention: dict[Reason, list[tuple[str, str]]] = {reason: [] for reason in Reason}
    for one in every:
        for reason, detail in one.concerns:
            attention[reason].append((one.student.key, detail))
    present = [one.graded for one in every if one.graded is not None and not one.is_gone]
    return ClassStatistics(
        book.rubric,
        most,
        dict(sorted(Counter(map(status_of, enrolled)).items())),
        _summary(totals.values()) if totals else None,
        sum(bool(one.why_open) for one in counted),
        sum(one.late.days > 0 and not one.has_final for one in enrolled),
        tenths,
        *_results(book, counted),
        {name: _summary(values) for name, values in sorted(sections.items())} if len(sections) > 1 else {},
        {reason: those for reason, those in attention.items() if those},
        equal_work(present, book.settings.handed_out),
        {one.student.key: one.student.name for one in every},
    )


def _summary(values: Iterable[Decimal]) -> Summary:
    found = sorted(values)
    return Summary(len(found), sum(found, Decimal(0)) / len(found), median(found), found[0], found[-1])


def _results(book: Class, grades: Iterable[StudentGrade]) -> tuple[list[CriterionFigures], list[Mistake]]:
    """Return the figures of the criteria, and the most common mistakes."""
    found = defaultdict[str, Counter[str]](Counter)
    earned, mistakes = defaultdict[str, Decimal](Decimal), defaultdict[tuple[str, str], list[str]](list)
    for grade in grades:
        for result in grade.report.results if grade.report is not None else ():
            name = result.criterion.id
            counts = found[name]
            for word in _of(result):
                counts[word] += 1
            earned[name] += result.points
            is_mistake = result.is_lost and result.manual_mark is None and not result.criterion.bonus
            if is_mistake and result.outcome.message:
                mistakes[name, result.outcome.message].append(grade.student.key)
    common = sorted(mistakes.items(), key=lambda item: (-len(item[1]), item[0]))[:_MAX_MISTAKES]
    rows = [CriterionFigures(row, found[row.id], _share(row, found[row.id], earned[row.id])) for row in book.criteria]
    return rows, [Mistake(name, message, keys) for (name, message), keys in common]


def _of(result: Result) -> list[str]:
    """Return what a result counts as: a mark, a given point, or the status of the check."""
    if result.manual_mark is not None:
        return ["marked", "decided"]
    if result.carried or result.is_adjusted:
        return ["carried", "decided"]
    status = result.outcome.status
    return [status] if status in ("pending", "errored") else [status, "decided"]


def _share(row: Criterion, found: Counter[str], earned: Decimal) -> float | None:
    decided = found["decided"]
    if not decided or row.adjustment is not None:
        return None
    return float(earned / row.points / decided) if row.points else found["passed"] / decided
