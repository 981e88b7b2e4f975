"""Statistics of a class: the grades as they are published, each criterion, the most common mistakes, the sections."""

from collections import Counter, defaultdict
from collections.abc import Iterable
from decimal import Decimal
from statistics import median
from typing import NamedTuple

from grader.classroom.equal_work import EqualWork, equal_work
from grader.classroom.grade_table import status_of
from grader.classroom.grades import Class, Reason, StudentGrade
from grader.grading.criterion import Criterion
from grader.grading.report import Result
from grader.grading.rubric import Rubric

TENTHS = 10
_MAX_MISTAKES = 20


class Summary(NamedTuple):
    """The grades of some students: their number, mean, median, lowest and highest; None without a grade."""

    students: int
    mean: Decimal | None = None
    median: Decimal | None = None
    lowest: Decimal | None = None
    highest: Decimal | None = None


class CriterionFigures(NamedTuple):
    """The results of a criterion: students by status, those with a mark, and the mean share of its points; None if all are open."""

    criterion: Criterion
    passed: int
    failed: int
    skipped: int
    pending: int
    errored: int
    carried: int
    marked: int
    share: float | None


class Mistake(NamedTuple):
    """A mistake that several students made in a criterion."""

    criterion: Criterion
    message: str
    students: tuple[str, ...]


class Attention(NamedTuple):
    """The students for whom a person is needed for one reason, each with details."""

    reason: Reason
    students: tuple[tuple[str, str], ...]


class ClassStatistics(NamedTuple):
    """The figures of a class. Visitors who are not on the roster count nowhere but in `attention`.

    A grade counts if it is a final mark, or that of a graded submission, after marks, adjustments and the late penalty; points that
    still need manual grading are not in it yet, and `open` is the number of such grades. `tenths` are the keys of the students in each
    tenth of the maximum, which itself is in the last one.
    """

    rubric: Rubric
    statuses: dict[str, int]
    all: Summary
    open: int
    late: int
    tenths: tuple[tuple[str, ...], ...]
    criteria: tuple[CriterionFigures, ...]
    mistakes: tuple[Mistake, ...]
    sections: dict[str, Summary]
    attention: tuple[Attention, ...]
    equal: tuple[EqualWork, ...]


def counts(grade: StudentGrade) -> bool:
    """Return whether a grade is in the figures."""
    is_graded = grade.graded is not None and grade.graded.verdict == "graded"
    is_in = (is_graded and not (grade.is_gone or grade.is_excused)) or grade.published is not None
    return is_in and grade.student.is_on_roster


def statistics(book: Class, grades: Iterable[StudentGrade]) -> ClassStatistics:
    """Return the statistics of the grades of a class."""
    most = sum((row.maximum for row in book.criteria), Decimal(0))
    totals: dict[str, Decimal] = {}
    sections: defaultdict[str, list[Decimal]] = defaultdict(list)
    statuses, tenths = Counter[str](), [list[str]() for _ in range(TENTHS)]
    found: dict[str, Counter[str]] = {row.id: Counter() for row in book.criteria}
    earned: defaultdict[str, Decimal] = defaultdict(Decimal)
    mistakes: defaultdict[tuple[str, str], list[str]] = defaultdict(list)
    attention: defaultdict[Reason, list[tuple[str, str]]] = defaultdict(list)
    late = still_open = 0
    for grade in grades:
        key = grade.student.key
        for reason, detail in grade.concerns:
            attention[reason].append((key, detail))
        if not grade.student.is_on_roster:
            continue
        statuses[status_of(grade)] += 1
        late += grade.late.days > 0
        if not counts(grade) or grade.total is None:
            continue
        still_open += bool(grade.why_open)
        totals[key] = grade.total
        tenths[max(0, min(TENTHS - 1, int(grade.total * TENTHS // (most or 1))))].append(key)
        sections[grade.student.section].append(grade.total)
        for result in grade.report.results if grade.report is not None else ():
            name = result.criterion.id
            if name not in found:  # marked, in a part that is not graded
                continue
            found[name].update(_of(result))
            earned[name] += result.points
            if result.is_lost and result.manual_mark is None and result.outcome.message:
                mistakes[name, result.outcome.message].append(key)
    common = sorted(mistakes.items(), key=lambda item: (-len(item[1]), item[0]))
    by_id = {row.id: row for row in book.rubric.criteria}
    return ClassStatistics(
        book.rubric,
        dict(sorted(statuses.items())),
        summary_of(totals.values()),
        still_open,
        late,
        tuple(map(tuple, tenths)),
        tuple(_figures(row, found[row.id], earned[row.id]) for row in book.criteria),
        tuple(Mistake(by_id[name], message, tuple(keys)) for (name, message), keys in common[:_MAX_MISTAKES]),
        {name: summary_of(values) for name, values in sorted(sections.items())} if len(sections) > 1 else {},
        tuple(Attention(reason, tuple(attention[reason])) for reason in Reason if reason in attention),
        tuple(equal_work((one for one in book.results.all() if one.student in book.run.totals), book.settings.handed_out)),
    )


def summary_of(values: Iterable[Decimal]) -> Summary:
    """Return the figures of some grades."""
    found = sorted(values)
    if not found:
        return Summary(0)
    return Summary(len(found), sum(found) / len(found), median(found), found[0], found[-1])


def _of(result: Result) -> list[str]:
    """Return what a result counts as: a mark, a given point, or the status of the check."""
    if result.manual_mark is not None:
        return ["marked", "decided"]
    if result.carried or result.is_adjusted:
        return ["carried", "decided"]
    status = result.outcome.status
    return [status] if status in ("pending", "errored") else [status, "decided"]


def _figures(row: Criterion, found: Counter[str], earned: Decimal) -> CriterionFigures:
    worth, decided = row.points, found["decided"]
    share = None if not decided else float(earned / worth / decided) if worth else found["passed"] / decided
    counts = [found[name] for name in ("passed", "failed", "skipped", "pending", "errored", "carried", "marked")]
    return CriterionFigures(row, *counts, share)
