"""Give a manual mark by command."""

from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import TAKE_BACK, WITHDRAWN, Entry, add_mark, criterion_of, read_points
from grader.report.review import mark_text
from grader.text import counted_points, format_points, printable
from grader.usecases import Warn


def give_mark(gradebook: Path, submission: str, criterion: str, points: str, by: str, comment: str, warn: Warn) -> str:
    """Add a manual mark and return the student's new score. Raises InputError."""
    with Gradebook(gradebook) as book:
        grades = Grades(book)
        grade = grades.find(submission)
        rubric = grades.rubric(grade.rubric) if grade.rubric else grades.newest_rubric()
        marked = criterion_of(rubric, criterion)
        if points.strip() == TAKE_BACK:
            entry = WITHDRAWN._replace(comment=comment)
        else:
            entry = Entry("points", read_points(points, marked.id, marked.points), comment)
        before = add_mark(book, grade, marked.id, entry, by).before
        now = grades.find(grade.student.key)
    if before is not None and before.points is not None:
        warn(f"this replaces the newest mark of {marked.id}: {mark_text(before)}")
    rest = f"; needs manual grading: {counted_points(now.pending)}" if now.pending else ""
    return printable(f"{now.student.key}: {format_points(now.score)} of {format_points(now.out_of)} points{rest}")
