"""Compare the sections of a class, or each marker's students: grades, lateness, the criteria that differ most."""

from collections import defaultdict
from collections.abc import Sequence
from decimal import Decimal
from statistics import fmean, median
from typing import Literal, NamedTuple

from grader.classroom.gradebook.graded_students import GradedStudent, full_units, graded_students
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.result import UNITS_PER_POINT, points_from_units, units_of
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.grading.criterion import Criterion

Grouping = Literal["section", "marker"]
_MAX_CRITERIA = 5
_MIN_DIFFERENCE = 0.005  # of a share: what is shown as one percent


class Section(NamedTuple):
    """The students of one section. `name` is empty for those without one.

    `mean` and `median` are those of the `graded` students' grades over decided points, without late penalties; None
    without any. `late_points` are the late penalties of `late` students. `shares` are the mean shares of each
    criterion's points that were earned, None if nothing is decided.
    """

    name: str
    students: int
    graded: int
    mean: float | None
    median: float | None
    late: int
    late_points: Decimal
    shares: tuple[float | None, ...]


class SectionComparison(NamedTuple):
    """The sections side by side, in the order of their names, and the positions of the criteria that differ most."""

    by: Grouping
    out_of: Decimal
    criteria: tuple[Criterion, ...]
    sections: tuple[Section, ...]
    differing: tuple[int, ...]


def compare_sections(grades: Grades, by: Grouping) -> SectionComparison:
    """Return the sections, or each marker's students, side by side; raises InputError if nothing was graded."""
    rubric, book = grades.newest_rubric(), grades.book
    students = {student.id: student for student in graded_students(book, rubric)}
    groups: dict[str, list[StudentGrade]] = defaultdict(list)
    for grade in grades.all():
        groups[getattr(grade, by)].append(grade)
    most = max((student.out_of for student in students.values()), default=units_of(rubric.points))
    sections = tuple(_section(name, groups[name], students, most, rubric.criteria) for name in sorted(groups))
    differing = _differing([section for section in sections if section.name])
    return SectionComparison(by, points_from_units(most), rubric.criteria, sections, differing)


def _section(
    name: str,
    grades: Sequence[StudentGrade],
    students: dict[int, GradedStudent],
    most: int,
    criteria: Sequence[Criterion],
) -> Section:
    found = [students[grade.id] for grade in grades if grade.id in students]
    totals = [student.grade(most) / UNITS_PER_POINT for student in found if student.counts]
    late = [grade for grade in grades if grade.late.days and not grade.has_final]
    return Section(
        name,
        len(grades),
        len(totals),
        fmean(totals) if totals else None,
        median(totals) if totals else None,
        len(late),
        sum((-grade.late.points for grade in late), Decimal(0)),
        tuple(_share(criterion, found) for criterion in criteria),
    )


def _share(criterion: Criterion, students: Sequence[GradedStudent]) -> float | None:
    """Return the mean share of a criterion's points that was earned; None if it is decided for no student."""
    earned = [units for student in students if (units := student.earned[criterion.position]) is not None]
    return fmean(earned) / full_units(criterion) if earned else None


def _differing(sections: Sequence[Section]) -> tuple[int, ...]:
    """Return the positions of the criteria whose shares differ most between sections, the largest difference first."""
    differences = []
    for position, shares in enumerate(zip(*(section.shares for section in sections), strict=True)):
        known = [share for share in shares if share is not None]
        if known and max(known) - min(known) >= _MIN_DIFFERENCE:
            differences.append((min(known) - max(known), position))
    return tuple(position for _, position in sorted(differences)[:_MAX_CRITERIA])
