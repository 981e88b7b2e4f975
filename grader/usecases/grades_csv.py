"""The current grades as CSV: a row for each student."""

from collections.abc import Sequence

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.remarks import remarks_of
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.lms.spreadsheet import CellValue, write_table
from grader.grading.criterion import Criterion

_STUDENT_COLUMNS = (
    "id", "name", "email", "login", "sis", "status", "score", "max_score", "pending", "late_days", "late_points",
)  # fmt: skip
# After the criteria, so that the columns before them keep their positions.
_MORE_COLUMNS = ("carried", "section", "marker", "submitted", "final_mark", "excused", "comments", "graded_by")


def grades_csv(grades: Grades) -> str:
    """Return a row for each student: the grade, the late penalty, the points of each decided criterion, and who graded."""
    criteria = grades.criteria
    header = [*_STUDENT_COLUMNS, "total", "not_final_because", *(criterion.id for criterion in criteria)]
    return write_table([*header, *_MORE_COLUMNS], (_row(grades, grade, criteria) for grade in grades.all()))


def _row(grades: Grades, grade: StudentGrade, criteria: Sequence[Criterion]) -> list[CellValue]:
    student = grade.student
    about: list[CellValue] = [student.key, student.name, student.email, student.login, student.sis, grade.verdict]
    if grade.result is None:
        numbers: list[CellValue] = [*[None] * 5, grade.final]
    else:
        total = None if grade.is_excused else grade.total
        numbers = [grade.score, grade.out_of, grade.pending, grade.late.days, grade.late.points, total]
    points = grades.points(grade)
    decided = (points.get(criterion.id) for criterion in criteria)
    return [*about, *numbers, grade.why_not_final, *decided, *_more(grades, grade)]


def _more(grades: Grades, grade: StudentGrade) -> list[CellValue]:
    """Return the cells after the criteria."""
    remarks = remarks_of(grades, grade)
    comments = "; ".join(f"{name}: {' '.join(comment.split())}" for name, comment in remarks.comments)
    graders = remarks.graders
    return [
        ", ".join(grades.carried(grade)),
        grade.section,
        grade.marker,
        grade.submitted,
        grade.final,
        "yes" if grade.is_excused else "",
        comments,
        graders.words if graders.is_automatic or graders.is_manual else "",
    ]
