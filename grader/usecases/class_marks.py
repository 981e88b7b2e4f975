"""Manual marks of many students by one command, and a student's own deadline."""

from collections import Counter
from collections.abc import Iterator
from decimal import Decimal
from functools import cache
from pathlib import Path

from grader.classroom.gradebook import marks
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.lateness import read_time
from grader.classroom.tables import SIZE_LIMIT, rows_with_lines
from grader.errors import InputError
from grader.files.reading import read_capped
from grader.grading.criterion import TOTAL
from grader.names import folded
from grader.text import counted, enumerated, first_lines, printable, printable_path
from grader.usecases.manual_marks import MarkRequest, entry_of, give_mark, key_and_name, marked_criterion
from grader.usecases.terminal import Warn

_COLUMNS = ("student", "criterion", "points", "comment")
_MAX_NAMED = 10
_NewMark = tuple[StudentGrade, str, marks.Entry]


def import_marks(gradebook: Path, file: Path, by: str) -> str:
    """Record the marks in a CSV file; return how many. Raises InputError, and records none, if a row is wrong."""
    shown = printable_path(file)
    with Gradebook(gradebook) as book:
        rows = _new_marks(Grades(book), _requests(file, shown), shown)
        with marks.writing(book):
            done = Counter(_record(book, row, by) for row in rows)
    return f"{shown}: {done[True]} recorded, {done[False]} the same as before\n"


def _requests(file: Path, shown: str) -> Iterator[tuple[int, MarkRequest]]:
    """Yield the line of each row with points or a comment, and what it asks for."""
    rows = rows_with_lines(read_capped(file, SIZE_LIMIT, advice=""), shown)
    titles = [folded(title) for title in next(rows, (1, []))[1]]
    if not {*_COLUMNS[:2]} <= {*titles} or {*_COLUMNS[2:]}.isdisjoint(titles):
        raise InputError(f"the first line of {shown} must name the columns {enumerated(_COLUMNS)}")
    for line, cells in rows:
        values = dict(zip(titles, cells, strict=False))
        student, criterion, points, comment = (values.get(column, "") for column in _COLUMNS)
        if points or comment:
            yield line, MarkRequest(student, criterion, points or None, comment)


def _new_marks(grades: Grades, requests: Iterator[tuple[int, MarkRequest]], shown: str) -> list[_NewMark]:
    """Return the marks of all rows; raises InputError with a line for each kind of mistake."""
    find = cache(grades.find)
    wrong: dict[str, list[tuple[int, str]]] = {}
    rows: dict[tuple[int, str], _NewMark] = {}
    for line, request in requests:
        kind = "student"
        try:
            grade = find(request.submission)
            kind = "criterion"
            _, most = marked_criterion(grades, grade, request)
            marks.refuse_unsubmitted(grade, request.criterion)
            kind = "points"
            entry = entry_of(request, most)
            new = grade, request.criterion, entry._replace(comment=request.comment)
            if rows.setdefault((grade.id, request.criterion), new) is not new:
                message = f"{key_and_name(grade.student)} has {request.criterion} twice"
                wrong.setdefault("mark", []).append((line, message))
        except InputError as error:
            wrong.setdefault(kind, []).append((line, str(error)))
    if wrong:
        where = {kind: enumerated([str(line) for line, _ in lines], _MAX_NAMED) for kind, lines in wrong.items()}
        lines = [f"{shown}: wrong {kind} in line {where[kind]}: {found[0][1]}" for kind, found in wrong.items()]
        raise InputError("\n".join(map(printable, lines)))
    return [*rows.values()]


def _record(book: Gradebook, new: _NewMark, by: str) -> bool:
    """Add a mark unless the newest one says the same; return whether it was added."""
    grade, criterion, entry = new
    before = marks.newest_mark(book, grade.id, criterion)
    counting = before.entry if before is not None else marks.WITHDRAWN
    is_same = entry == (counting._replace(kind="comment", points=None) if entry.kind == "comment" else counting)
    if not is_same:
        marks.add_mark(book, grade, criterion, entry, by)
    return not is_same


def mark_missing(gradebook: Path, request: MarkRequest) -> str:
    """Give a final mark to all students on the roster without a submission, a final mark and an excuse."""
    request.check()
    with Gradebook(gradebook) as book, marks.writing(book):
        grades, given = Grades(book), list[str]()
        most = sum((row.points for row in grades.criteria), Decimal(0))
        entry = entry_of(request, most)
        for grade in list(grades.where("is_on_roster = 1 AND result IS NULL AND final IS NULL AND NOT is_excused")):
            before = marks.newest_mark(book, grade.id, TOTAL)
            comment = request.comment or (before.comment if before is not None else "")
            marks.add_mark(book, grade, TOTAL, entry._replace(comment=comment), request.by)
            given.append(f"  {key_and_name(grade.student)}")
    head = f"final mark {request.points} for {counted(len(given), 'student')} on the roster without a submission"
    return "".join(f"{printable(line)}\n" for line in (head, *first_lines(given, _MAX_NAMED)))


def extend_deadline(gradebook: Path, student: str, time: str, by: str, warn: Warn) -> str:
    """Record a student's own deadline, or withdraw it; return what counts for the student now."""
    if time.strip() == marks.TAKE_BACK:
        return give_mark(gradebook, MarkRequest(student, marks.EXTENSION, marks.TAKE_BACK, by=by), warn)
    read_time(time)  # raises InputError
    return give_mark(gradebook, MarkRequest(student, marks.EXTENSION, comment=time.strip(), by=by), warn)
