"""Give, withdraw or undo a manual mark by command."""

from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from grader.classroom.gradebook import marks
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import COMMENT_NUMBER, numbered_comments
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.students import Student
from grader.classroom.typed_names import criterion_of, read_points
from grader.errors import InputError
from grader.grading.criterion import TOTAL, Criterion
from grader.report.review import mark_text
from grader.text import counted_points, format_points, named, people_text, printable
from grader.usecases.terminal import Warn

_NOT_COUNTED = "{} is corrected after grading, by [adjust] in the rubric: its manual marks do not count"
_MAX_NAMED = 10
# The students whose newest submission has the same files in the same class.
_SAME_SUBMISSION = """
SELECT id, key, name FROM grade WHERE id <> ? AND result IS NOT NULL AND (source, json_extract(files, '$[0]')) =
    (SELECT source, json_extract(files, '$[0]') FROM grade WHERE id = ?) ORDER BY key
"""


class MarkRequest(NamedTuple):
    """What `grader mark` records for a criterion or the whole submission. `points` is None without POINTS."""

    submission: str
    criterion: str
    points: str | None = None
    comment: str = ""
    by: str = ""
    excused: bool = False
    undo: bool = False
    second: bool = False
    list_comments: bool = False
    missing: bool = False

    @property
    def is_total(self) -> bool:
        """Return whether it is about the whole submission."""
        return self.criterion == TOTAL

    @property
    def is_points(self) -> bool:
        """Return whether it gives points, and does not withdraw them."""
        return self.points is not None and self.points.strip() != marks.TAKE_BACK

    def check(self) -> None:
        """Raise InputError if the options contradict each other, or say nothing."""
        has_points = self.points is not None
        has_entry = bool(has_points or self.comment or self.excused or self.second)
        rules = (
            (self.list_comments and (has_entry or self.undo), "--list-comments records nothing: use it alone"),
            (not (self.submission or self.missing) or not self.criterion, "name a STUDENT and a CRITERION"),
            (self.missing and not (self.is_total and self.is_points), f"write it as --missing {TOTAL} POINTS"),
            (self.undo and has_entry, "--undo takes no POINTS and no other option but --by"),
            (self.excused and has_points, "--excused has no POINTS"),
            (self.excused and self.second, "--second cannot be used with --excused"),
            (self.excused and not self.is_total, f"--excused is for the whole submission: use `{TOTAL}` as CRITERION"),
            (self.second and self.is_total, "--second is for one criterion, not for the whole submission"),
            (self.second and not has_points, "--second needs POINTS"),
            (self.second and not self.by, "--second needs --by, your name"),
            (not (has_entry or self.undo or self.list_comments), "give POINTS, --comment, --excused or --undo"),
        )
        for is_broken, message in rules:
            if is_broken:
                raise InputError(message)


def give_mark(gradebook: Path, request: MarkRequest, warn: Warn) -> str:
    """Record a manual mark and return what counts for the student now; or list comments. Raises InputError."""
    request.check()
    with Gradebook(gradebook) as book:
        grades = Grades(book)
        grade = grades.find(request.submission)
        criterion, most = marked_criterion(grades, grade, request)
        if request.list_comments:
            comments = numbered_comments(book, request.criterion).items()
            lines = (printable(f"#{number} {' '.join(comment.split())}") for number, comment in comments)
            return "".join(f"{line}\n" for line in lines) or "no comments yet\n"
        with marks.writing(book):  # what cannot be reported is not saved
            before = _record(book, grade, request, most, warn)
            now = grades.find(grade.student.key)
            whole = sum((row.maximum for row in grades.criteria), Decimal(0))
            is_alone = request.second or request.is_total
            others = [] if is_alone else list(_unmarked_members(book, now, request.criterion))
    _report_replaced(before, criterion, request, warn)
    if others:
        warn(f"the same submission counts for {people_text(others, _MAX_NAMED)}: mark them as well")
    text = _grade_text(now, whole)
    if request.second:
        text = f"second opinion on {request.criterion}; the grade stays the same"
    elif request.criterion == marks.EXTENSION:
        deadline = f"deadline {request.comment}" if request.comment else "no deadline of their own"
        text = "; ".join(filter(None, (deadline, now.late.reason, text)))
    return printable(f"{key_and_name(now.student)}: {text}") + "\n"


def marked_criterion(grades: Grades, grade: StudentGrade, request: MarkRequest) -> tuple[Criterion | None, Decimal]:
    """Return the criterion to mark, None for the whole submission, and the most points. Raises InputError."""
    if request.criterion in (TOTAL, marks.EXTENSION):
        return None, sum((row.points for row in grades.criteria), Decimal(0))
    criterion = criterion_of(grades.rubric(grade.rubric) if grade.rubric else grades.newest_rubric(), request.criterion)
    if request.is_points and criterion.adjustment is not None and not criterion.points:
        raise InputError(_NOT_COUNTED.format(criterion.id))
    return criterion, criterion.points


def _unmarked_members(book: Gradebook, grade: StudentGrade, criterion: str) -> Iterator[str]:
    """Yield the other members of a team whose newest mark of a criterion is not the same."""
    mark = marks.newest_mark(book, grade.id, criterion)
    for student, key, name in list(book.rows(_SAME_SUBMISSION, grade.id, grade.id)):
        other = marks.newest_mark(book, student, criterion)
        if mark is not None and (marks.WITHDRAWN if other is None else other.entry) != mark.entry:
            yield printable(named(key, name))


def key_and_name(student: Student) -> str:
    """Return who was found: "12280, Doe, Jane"."""
    return student.key if student.name in ("", student.key) else f"{student.key}, {student.name}"


def _record(book: Gradebook, grade: StudentGrade, request: MarkRequest, most: Decimal, warn: Warn) -> marks.Mark | None:
    """Write what is requested, and return the mark that was the newest before."""
    if request.undo:
        return marks.undo_mark(book, grade, request.criterion, request.by)
    first = marks.newest_mark(book, grade.id, request.criterion) if request.second else None
    if first is not None and first.points is not None and first.by == request.by:
        mark = f"the mark of {request.criterion} is by {request.by}"
        raise InputError(f"{mark}: a second opinion must be given by another person")
    comment = _comment(book, request, warn)
    entry = entry_of(request, most)
    return marks.add_mark(book, grade, request.criterion, entry._replace(comment=comment), request.by).before


def entry_of(request: MarkRequest, most: Decimal) -> marks.Entry:
    """Return the entry of a request, without its comment. Raises InputError for points out of range."""
    match request:
        case MarkRequest(excused=True):
            return marks.Entry("excused")
        case MarkRequest(points=None):
            return marks.Entry("comment")
        case MarkRequest(is_points=False):
            return marks.WITHDRAWN_SECOND if request.second else marks.WITHDRAWN
    points = read_points(request.points or "", request.criterion, most)
    return marks.Entry("second" if request.second else "points", points)


def _comment(book: Gradebook, request: MarkRequest, warn: Warn) -> str:
    """Return the comment; `#2` is an earlier one, which is repeated on standard error."""
    number = COMMENT_NUMBER.fullmatch(request.comment.strip())
    if number is None:
        return request.comment
    comment = numbered_comments(book, request.criterion).get(int(number[1]))
    if comment is None:
        raise InputError(
            f"{request.criterion} has no comment {number[0]}: "
            f"`grader mark STUDENT {request.criterion} --list-comments` lists the earlier comments"
        )
    warn(printable(f"comment {number[0]}: {' '.join(comment.split())}"))
    return comment


def _report_replaced(before: marks.Mark | None, criterion: Criterion | None, request: MarkRequest, warn: Warn) -> None:
    name = request.criterion
    is_withdrawn = before is None or before.entry.kind == "withdrawn" or before.entry == marks.WITHDRAWN_SECOND
    if before is not None and not is_withdrawn:
        what = "second opinion" if request.second else "comment" if before.entry.kind == "comment" else "mark"
        is_mark = name != marks.EXTENSION
        newest = f"newest {what} of {name}: {mark_text(before)}" if is_mark else f"deadline {before.comment}"
        warn(f"this {'undoes' if request.undo else 'replaces'} the {newest}")
    elif request.points is not None and not request.is_points:
        warn(f"there was no {name if name == marks.EXTENSION else f'mark of {name}'} to withdraw")
    if criterion is not None and criterion.adjustment is not None:
        warn(_NOT_COUNTED.format(name))


def _grade_text(grade: StudentGrade, whole: Decimal) -> str:
    """Return what counts: an excuse, a final mark, or the points of the criteria."""
    of_criteria = f"{format_points(grade.score)} of {format_points(grade.out_of)} points"
    if grade.is_excused:
        return "excused"
    if grade.final is not None:
        not_counted = f"; the criteria give {of_criteria}" if grade.result is not None else ""
        return f"final mark {format_points(grade.final)} of {format_points(whole)} points{not_counted}"
    if grade.result is None:
        return "no submission"
    late = f"; {format_points(grade.total)} after the late penalty" if grade.late.points else ""
    return of_criteria + late + (f"; needs manual grading: {counted_points(grade.pending)}" if grade.pending else "")
