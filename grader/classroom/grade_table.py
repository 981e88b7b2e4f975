"""The grades of a class as a table, one row a student: `grades.csv`, and `export csv`, which people may change."""

from collections.abc import Iterable, Iterator, Sequence

from grader.classroom.grades import Class
from grader.classroom.student_grade import StudentGrade
from grader.classroom.tables import CellValue
from grader.grading.criterion import TOTAL
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

    A table that `is_exported` has a column with the values that `mark --import` takes for marks, so that it knows which
    of them a person changed.
    """
    criteria = [row.id for row in book.rubric.criteria]
    exported = ["exported"] * is_exported
    return [*HEADER, *criteria, *exported, "submission"], (_row(one, criteria, is_exported) for one in grades)


def _row(grade: StudentGrade, criteria: Sequence[str], is_exported: bool) -> list[CellValue]:
    student, report, late = grade.student, grade.report, grade.late
    row: list[CellValue] = [student.key, student.name or None, student.email or None, student.section or None]
    points: dict[str, str | None] = dict.fromkeys(criteria)
    numbers: list[CellValue] = [None] * 5
    if grade.status not in ("missing", "excused"):
        numbers = [grade.score, report.max_score, grade.pending, late.days, late.points]
        points |= {one.criterion.id: one.cell for one in grade.results}
    row += [grade.status, *numbers, grade.total, grade.why_open or None, *points.values()]
    if is_exported:
        points[TOTAL] = format_points(grade.total) if grade.total is not None else None
        row.append(" ".join(f"{name}={text or ''}" for name, text in points.items()))
    return [*row, grade.graded.digest if grade.graded is not None else None]
