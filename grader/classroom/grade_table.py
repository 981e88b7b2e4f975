"""The grades of a class as a table, one row a student: `grades.csv`, and `export csv`, which people may change."""

from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal

from grader.classroom.grades import Class
from grader.classroom.student_grade import StudentGrade
from grader.classroom.tables import CellValue
from grader.grading.criterion import TOTAL
from grader.grading.report import Result
from grader.text import format_points

# Columns before those of the criteria; the last one, `submission`, is the digest of what was graded.
HEADER = (
    *("id", "name", "email", "section", "status", "score", "max_score", "pending"),
    *("late_days", "late_points", "total", "not_final_because"),
)


def grade_table(
    book: Class, grades: Iterable[StudentGrade], *, is_exported: bool = False
) -> tuple[list[str], Iterator[list[CellValue]]]:
    """Return the header, and the rows of grades; what is not decided is empty.

    A table that `is_exported` also says what the cells were that `mark --import` takes for marks.
    """
    criteria = [row.id for row in book.rubric.criteria]
    exported = ["exported"] * is_exported
    return [*HEADER, *criteria, *exported, "submission"], (_row(one, criteria, is_exported) for one in grades)


def status_of(grade: StudentGrade) -> str:
    """Return how the submission went: graded, unreadable, errored, missing or excused."""
    if grade.is_excused:
        return "excused"
    return grade.graded.verdict if grade.graded is not None else "missing"


def _row(grade: StudentGrade, criteria: Iterable[str], is_exported: bool) -> list[CellValue]:
    student, report = grade.student, None if grade.is_excused else grade.report
    numbers: list[CellValue] = [None] * 5
    points = dict[str, Decimal | None].fromkeys(criteria)
    if report is not None:
        numbers = [grade.score, report.max_score, grade.pending, grade.late.days, grade.late.points]
        points |= {row.criterion.id: row.points for row in report.results if not _is_undecided(row)}
    exported = [exported_cell({**points, TOTAL: grade.total})] if is_exported else []
    digest = grade.graded.digest if grade.graded is not None else None
    head: list[CellValue] = [student.key, student.name, student.email, student.section, status_of(grade)]
    return [*head, *numbers, grade.total, grade.why_open, *points.values(), *exported, digest]


def exported_cell(points: Mapping[str, Decimal | None]) -> str:
    """Return the cell of the column `exported`: the points of criteria, as they are in their columns."""
    return " ".join(f"{name}={'' if value is None else format_points(value)}" for name, value in points.items())


def _is_undecided(result: Result) -> bool:
    return result.is_open or (result.outcome.status == "errored" and result.manual_mark is None)
