"""The grades of a class as a table: one row a student. It is `grades.csv`, and `export csv`, whose cells people may change."""

from collections.abc import Iterable, Iterator

from grader.classroom.grades import Class, StudentGrade
from grader.classroom.tables import CellValue

# Columns before those of the criteria. `submission` is the digest of what was graded.
HEADER = (
    *("id", "name", "email", "section", "status", "score", "max_score", "pending"),
    *("late_days", "late_points", "total", "not_final_because", "submission"),
)


def grade_table(book: Class, grades: Iterable[StudentGrade]) -> tuple[list[str], Iterator[list[CellValue]]]:
    """Return the header, and the rows of grades; what is not decided is empty."""
    criteria = [row.id for row in book.rubric.criteria]
    return [*HEADER, *criteria], (_row(one, criteria) for one in grades)


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
    of = {row.criterion.id: row for row in report.results} if report is not None else {}
    points = [None if name not in of or of[name].is_open or _failed(of[name].outcome.status, of[name].manual_mark) else of[name].points for name in criteria]
    return [*head, *numbers, grade.total, grade.why_open, digest, *points]


def _failed(status: str, mark: object) -> bool:
    return status == "errored" and mark is None
