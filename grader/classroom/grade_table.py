"""The grades of a class as a table, one row a student: `grades.csv`, and `export csv`, which people may change."""

from collections.abc import Iterable, Iterator, Sequence

from grader.classroom.grades import Class
from grader.classroom.student_grade import StudentGrade, is_faulty
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
    student, report = grade.student, None if grade.is_excused else grade.report
    row: list[CellValue] = [student.key, student.name, student.email, student.section, grade.status]
    points = dict.fromkeys(criteria, "")
    if report is None:
        row += [None] * 5
    else:
        row += [grade.score, report.max_score, grade.pending, grade.late.days, grade.late.points]
        decided = (one for one in report.results if not (one.is_open or is_faulty(one)))
        points |= {one.criterion.id: format_points(one.points) for one in decided}
    row += [grade.total, grade.why_open, *points.values()]
    if is_exported:
        points[TOTAL] = format_points(grade.total) if grade.total is not None else ""
        row.append(" ".join(f"{name}={text}" for name, text in points.items()))
    return [*row, grade.graded.digest if grade.graded is not None else None]
