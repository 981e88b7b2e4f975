"""The final mark, excuse and comments of a student, and who graded: the checks or a person."""

from typing import NamedTuple

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import Mark, current_marks
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.grading.criterion import TOTAL
from grader.text import by_name, counted_points, enumerated


class Graders(NamedTuple):
    """Who graded: `is_automatic` if a check decided points, `is_manual` if a person did; `names` are from `--by`."""

    is_automatic: bool
    is_manual: bool
    names: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """How it was graded: "automatically, and manually by Kim"."""
        if not self.is_manual:
            return "automatically"
        manually = f"manually{by_name(enumerated(self.names))}"
        return f"automatically, and {manually}" if self.is_automatic else manually


class Remarks(NamedTuple):
    """The entries of graders that count: those of criteria, in the rubric's order, and that of the whole submission."""

    criteria: dict[str, Mark]
    whole: Mark | None
    graders: Graders

    @property
    def notes(self) -> list[str]:
        """The sentences of a report about the whole submission."""
        mark = self.whole
        if mark is None:
            return []
        words = " ".join(mark.comment.split())
        by, comment = by_name(mark.by), f" {words}" if words else ""
        if mark.points is not None:
            giver = by or " manually"
            head = f"Final mark: {counted_points(mark.points)}, given{giver} instead of the sum of the criteria."
            return [head + comment]
        return [f"Excused{by}.{comment}" if mark.entry.kind == "excused" else f"Comment{by}:{comment}"]

    @property
    def graded(self) -> list[str]:
        """Who graded, as a sentence; empty if nothing is graded yet."""
        return [f"Graded {self.graders.words}."] if self.graders.is_automatic or self.graders.is_manual else []

    @property
    def comments(self) -> list[tuple[str, str]]:
        """All comments with what they are about: the id of a criterion, or `total`."""
        marks = [*self.criteria.items(), *([(TOTAL, self.whole)] if self.whole is not None else [])]
        return [(name, mark.comment) for name, mark in marks if mark.comment]


def remarks_of(grades: Grades, grade: StudentGrade) -> Remarks:
    """Return the remarks that count under the rubric of the student's result."""
    marks = current_marks(grades.book, grade.id)
    rubric = grades.rubric(grade.rubric) if grade.rubric else None
    rows = [row for row in rubric.criteria if row.adjustment is None] if rubric is not None else []
    criteria = {row.id: marks[row.id] for row in rows if row.id in marks}
    counting = {name: mark for name, mark in criteria.items() if mark.points is not None}
    automatic = grades.points(grade, automatic=True)
    is_automatic = any(row.id in automatic and row.id not in counting for row in rows)
    if grade.final is not None:
        is_automatic, counting = False, {TOTAL: marks[TOTAL]}
    names = sorted({mark.by for mark in counting.values() if mark.by})
    return Remarks(criteria, marks.get(TOTAL), Graders(is_automatic, bool(counting), tuple(names)))
