"""The grades of a class as a table: one row a student. It is `grades.csv`, and `export csv`, whose cells people may change."""

from collections.abc import Iterable, Iterator
from decimal import Decimal

from grader.classroom.grades import Class, StudentGrade
from grader.classroom.mark_import import exported_cell
from grader.classroom.tables import CellValue
from grader.grading.criterion import TOTAL
from grader.grading.report import Result
from grader.text import format_points

# Columns before those of the criteria; the last one, `submission`, is the digest of what was graded.
HEADER = (
    *("id", "name", "email", "section", "status", "score", "max_score", "pending"),
    *("late_days", "late_points", "total", "not_final_because"),
)


def grade_table(book: Class, grades: Iterable[StudentGrade]) -> tuple[list[str], Iterator[list[CellValue]]]:
    """Return the header, and the rows of grades; what is not decided is empty."""
    criteria = [row.id for row in book.rubric.criteria]
    return [*HEADER, *criteria, "submission"], (_row(one, criteria) for one in grades)


def status_of(grade: StudentGrade) -> str:
    """Return how the submission went: graded, unreadable, errored, missing or excused."""
    if grade.is_excused:
        return "excused"
    return grade.graded.verdict if grade.graded is not None else "missing"


def _row(grade: StudentGrade, criteria: Iterable[str]) -> list[CellValue]:
    student, report = grade.student, None if grade.is_excused else grade.report
    head: list[CellValue] = [student.key, student.name, student.email, student.section, status_of(grade)]
    numbers: list[CellValue] = [None] * 5
    if report is not None:
        numbers = [report.score, report.max_score, grade.pending, grade.late.days, grade.late.points]
    digest = grade.graded.digest if grade.graded is not None else None
    return [*head, *numbers, grade.total, grade.why_open, *points_of(grade, criteria).values(), digest]


def points_of(grade: StudentGrade, criteria: Iterable[str]) -> dict[str, Decimal | None]:
    """Return the points of criteria; None for what is open, excused or not graded."""
    report = None if grade.is_excused else grade.report
    of = {row.criterion.id: row for row in report.results} if report is not None else {}
    return {name: of[name].points if name in of and not _is_undecided(of[name]) else None for name in criteria}


def _is_undecided(result: Result) -> bool:
    return result.is_open or (result.outcome.status == "errored" and result.manual_mark is None)


def export_table(book: Class, grades: Iterable[StudentGrade]) -> tuple[list[str], Iterator[list[CellValue]]]:
    """Return the same table with a last column, which says what the cells were that `mark --import` takes for marks."""
    header, _ = grade_table(book, ())
    criteria = [row.id for row in book.rubric.criteria]

    def rows() -> Iterator[list[CellValue]]:
        for one in grades:
            points = points_of(one, criteria) | {TOTAL: one.total}
            texts = {name: "" if value is None else format_points(value) for name, value in points.items()}
            *cells, digest = _row(one, criteria)
            yield [*cells, exported_cell(texts), digest]

    return [*header[:-1], "exported", "submission"], rows()
