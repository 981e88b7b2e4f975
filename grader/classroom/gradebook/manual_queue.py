"""What needs manual grading in a class, and the marks and comments that it has so far."""

from dataclasses import dataclass
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import Mark, newest_mark
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.grading.report import Result


class QueuedCriterion(NamedTuple):
    """A student's key and a criterion that needed manual grading when the queue was made."""

    key: str
    criterion: str


@dataclass(frozen=True, slots=True)
class QueuedResult:
    """A queued criterion in its current state, with its newest mark, which may take an earlier one back."""

    grade: StudentGrade
    result: Result
    mark: Mark | None = None

    @property
    def newest(self) -> int:
        """The id of the newest mark, 0 if there is none."""
        return self.mark.id if self.mark is not None else 0


def manual_grading_queue(grades: Grades, criterion: str = "") -> list[QueuedCriterion]:
    """Return what needs manual grading, one criterion after the other, so that similar answers are adjacent.

    Unreadable submissions are not in it: they need a fix, not points.
    """
    rubric = grades.newest_rubric()
    query = (
        "SELECT key FROM grade WHERE verdict <> 'unreadable' AND rubric = ? AND substr(statuses, ?, 1) = '?' AND NOT EXISTS"
        " (SELECT 1 FROM manual_mark WHERE student = grade.id AND criterion = ?) ORDER BY key"
    )
    return [
        QueuedCriterion(str(key), row.id)
        for position, row in enumerate(rubric.criteria)
        if criterion in ("", row.id) and row.adjustment is None
        for (key,) in grades.book.rows(query, rubric.sha256, position + 1, row.id)
    ]


def queued_result(grades: Grades, queued: QueuedCriterion) -> QueuedResult | None:
    """Return a queued criterion in its current state; None if it is no longer graded."""
    grade = grades.find(queued.key)
    # Before the report, so that no later mark counts as shown.
    newest = newest_mark(grades.book, grade.id, queued.criterion)
    for result in grades.report(grade).results:
        if result.criterion.id == queued.criterion:
            return QueuedResult(grade, result, newest)
    return None


def reusable_comments(book: Gradebook, criterion: str, most: int, *, second: bool = False) -> list[str]:
    """Return the comments of a criterion's marks, or of its second opinions, without duplicates, the most frequent first."""
    table = "second_mark" if second else "current_mark"
    query = f"SELECT comment FROM {table} WHERE criterion = ? AND comment <> '' GROUP BY comment"
    rows = book.rows(f"{query} ORDER BY count(*) DESC, min(id) LIMIT ?", criterion, most)
    return [str(comment) for (comment,) in rows]


def numbered_comments(book: Gradebook, criterion: str, *, second: bool = False) -> dict[int, str]:
    """Return all comments ever given on a criterion, or in second opinions on it, in the order of their first use.

    The numbers from 1 never change, because no mark is ever deleted.
    """
    query = "SELECT comment FROM mark WHERE criterion = ? AND comment <> '' AND (kind = 'second') = ? GROUP BY comment"
    rows = book.rows(f"{query} ORDER BY min(id)", criterion, second)
    return {number: str(comment) for number, (comment,) in enumerate(rows, 1)}
