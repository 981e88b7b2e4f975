"""Statistics of a class.

The grades as they are published, each criterion, the most common mistakes, the sections.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from decimal import Decimal
from typing import NamedTuple

from grader.base.quantities import in_millimetres
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.student_grade import Reason, StudentGrade
from grader.classroom.results.equal_work import EqualWork, equal_work
from grader.lab.rubric.criterion import Criterion
from grader.lab.rubric.rubric import Rubric

COUNTS = ("passed", "failed", "skipped", "pending", "errored", "carried", "marked")
_TENTHS = 10
_MAX_MISTAKES = 20
_MAX_CAUSES = 5
_Grades = Iterable[StudentGrade]
_Attention = dict[Reason, list[tuple[str, str]]]  # who, and the detail


class _Mistake(NamedTuple):
    """A mistake of one student."""

    student: str
    message: str
    off: float = 0.0  # by how much, in metres, where this is measured


class Summary(NamedTuple):
    """The grades of some students: their number, mean and median."""

    students: int
    mean: Decimal
    median: Decimal


class CriterionFigures(NamedTuple):
    """The students by each of COUNTS, and the mean share of the points that they earned.

    The share is None if the criterion is open or adjusted.
    """

    criterion: Criterion
    counts: Counter[str]
    share: float | None


class _CommonMistake(NamedTuple):
    """A mistake that several students made in a criterion.

    Of a mistake that is measured, it has how far it is off.
    """

    criterion: str
    message: str
    students: Sequence[str]


class CriterionMistakes(NamedTuple):
    """The mistakes in a criterion.

    It says of how many students and of how many kinds they are, and has the most common ones.
    """

    criterion: str
    students: int
    causes: int
    common: Sequence[_CommonMistake]


class ClassStatistics(NamedTuple):
    """The figures of a class.

    Students who are not on the roster, or whose submission is gone, are in `attention` only.

    A grade counts if it is a final mark, or that of a graded submission, after marks, adjustments
    and the late penalty; points that still need manual grading are not in it yet.
    """

    rubric: Rubric
    maximum: Decimal
    statuses: dict[str, int]  # students by status
    all: Summary | None  # None if no grade counts
    open: int  # grades with points that still need manual grading
    late: int  # students
    # students in each tenth of the maximum, which itself is in the last one
    tenths: Sequence[Sequence[str]]
    criteria: Sequence[CriterionFigures]
    mistakes: Sequence[CriterionMistakes]  # those of most students first
    sections: dict[str, Summary]  # without any if there is only one
    attention: _Attention  # students who need attention, each with details
    equal: Sequence[EqualWork]
    names: dict[str, str]  # of all students, by key

    @property
    def common_mistakes(self) -> list[_CommonMistake]:
        """The most common mistakes of each criterion, one after the other."""
        return [mistake for row in self.mistakes for mistake in row.common]


def statistics(book: Gradebook, grades: _Grades) -> ClassStatistics:
    """Return the statistics of the grades of a class."""
    everyone = list(grades)
    present = [grade.stored for grade in everyone if grade.stored and not grade.is_gone]
    enrolled = _find_enrolled(everyone)
    statuses = Counter(grade.status for grade in enrolled)
    counted = [grade for grade in enrolled if grade.is_counted]
    totals = [grade.total or Decimal(0) for grade in counted]
    criteria, mistakes = _criteria_figures(book, counted)
    return ClassStatistics(
        rubric=book.rubric,
        maximum=book.maximum,
        statuses=dict(sorted(statuses.items())),
        all=summary(totals) if totals else None,
        open=sum(grade.obstacle is not None for grade in counted),
        late=sum(grade.late.days > 0 and not grade.has_final for grade in enrolled),
        tenths=_tenths(counted, book.maximum),
        criteria=criteria,
        mistakes=mistakes,
        sections=_sections(counted),
        attention=_attention(everyone),
        equal=equal_work(present, book.settings.handed_out),
        names={grade.student.key: grade.student.name for grade in everyone},
    )


def _find_enrolled(grades: _Grades) -> list[StudentGrade]:
    """Return the grades of students on the roster, without those whose submission is gone.

    With a final mark, the submission may be gone.
    """
    on_roster = [grade for grade in grades if grade.student.is_on_roster]
    return [grade for grade in on_roster if grade.has_final or not grade.is_gone]


def _tenths(grades: _Grades, maximum: Decimal) -> list[list[str]]:
    """Return the students in each tenth of the maximum; less than nothing is in the first one."""
    tenths = [list[str]() for _ in range(_TENTHS)]
    for grade in grades:
        tenth = int((grade.total or Decimal(0)) * _TENTHS // (maximum or 1))
        tenths[max(0, min(_TENTHS - 1, tenth))].append(grade.student.key)
    return tenths


def _sections(grades: _Grades) -> dict[str, Summary]:
    """Return the figures of each section; of none if there is only one."""
    totals = defaultdict(list)
    for grade in grades:
        totals[grade.student.section].append(grade.total or Decimal(0))
    if len(totals) <= 1:
        return {}
    return {name: summary(section) for name, section in sorted(totals.items())}


def _attention(grades: _Grades) -> _Attention:
    """Return the students who need attention, each with details.

    They are by reason, in the order of urgency.
    """
    concerned = defaultdict(list)
    for grade in grades:
        for reason, detail in grade.concerns.items():
            concerned[reason].append((grade.student.key, detail))
    return {reason: concerned[reason] for reason in Reason if reason in concerned}


def summary(totals: Iterable[Decimal]) -> Summary:
    """Return the figures of some grades, of at least one."""
    values = sorted(totals)
    count = len(values)
    median = (values[(count - 1) // 2] + values[count // 2]) / 2
    return Summary(count, sum(values, Decimal(0)) / count, median)


def _criteria_figures(
    book: Gradebook, grades: _Grades
) -> tuple[list[CriterionFigures], list[CriterionMistakes]]:
    """Return the figures of the criteria, and the most common mistakes."""
    counts = defaultdict[str, Counter[str]](Counter)
    earned = defaultdict[str, Decimal](Decimal)
    # By criterion and message; what is measured has a message of its own for each student.
    mistakes = defaultdict(list)
    for grade in grades:
        for result in grade.results:
            if grade.has_final and result.is_open:
                continue
            name = result.criterion.id
            counts[name].update(result.kinds)
            earned[name] += result.points
            if not result.mistake:
                continue
            measured = result.outcome.measured
            if isinstance(measured, float | int):
                mistake = _Mistake(grade.student.key, result.mistake, measured)
                mistakes[name, ""].append(mistake)
            else:
                mistake = _Mistake(grade.student.key, result.mistake)
                mistakes[name, result.mistake].append(mistake)
    rows = []
    for criterion in book.criteria:
        share = _share(criterion, counts[criterion.id], earned[criterion.id])
        rows.append(CriterionFigures(criterion, counts[criterion.id], share))
    by_number = sorted(mistakes.items(), key=lambda item: (-len(item[1]), item[0]))
    causes = defaultdict(list)
    for (name, _), equal in by_number:
        students = sorted(mistake.student for mistake in equal)
        causes[name].append(_CommonMistake(name, _words(equal), students))
    common = []
    for name, own_causes in causes.items():
        count = sum(len(cause.students) for cause in own_causes)
        common.append(CriterionMistakes(name, count, len(own_causes), own_causes[:_MAX_CAUSES]))
    common.sort(key=lambda one: (-one.students, one.criterion))
    return rows, common[:_MAX_MISTAKES]


def _words(mistakes: Sequence[_Mistake]) -> str:
    """Return what students did wrong: in the same words, or how far they are off."""
    if len({mistake.message for mistake in mistakes}) == 1:
        return mistakes[0].message
    distances = [mistake.off for mistake in mistakes]
    least = in_millimetres(min(distances))
    most = in_millimetres(max(distances))
    if least == most:
        return f"{most} off"
    return f"{least.removesuffix(' mm')} to {most} off"


def _share(criterion: Criterion, counts: Counter[str], earned: Decimal) -> float | None:
    decided = counts["decided"]
    if not decided or criterion.adjustment:
        return None
    if criterion.points:
        return float(earned / criterion.points / decided)
    return counts["passed"] / decided
