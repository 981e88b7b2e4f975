"""Give and withdraw marks by command: of one student, of all who submitted nothing, and of a CSV file."""

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from decimal import Decimal
from getpass import getuser
from pathlib import Path

from grader.classroom import folder as names
from grader.classroom.grades import Class, StudentGrade
from grader.classroom.mark_files import COLUMNS, SURPLUS, WITHDRAWN, mark_file
from grader.classroom.mark_import import MarkImport
from grader.classroom.marks import Key, Mark, append_marks
from grader.classroom.tables import SIZE_LIMIT
from grader.classroom.typed_names import find_typed
from grader.errors import InputError
from grader.files.reading import read_capped
from grader.grading.criterion import DEADLINE, TOTAL
from grader.text import by_name, counted_points, format_points, named, people_text, printable, printable_path
from grader.usecases.grade_class import write_grades
from grader.usecases.terminal import Warn

_MAX_NAMED = 10


@dataclass(frozen=True, slots=True)
class MarkRequest:
    """What `grader mark` records: `points` is what a person typed, empty for a comment alone."""

    student: str
    criterion: str
    points: str = ""
    comment: str = ""
    by: str = ""


def give_mark(gradebook: Path, request: MarkRequest, warn: Warn) -> str:
    """Append a mark to the file of its grader, and return what counts for the student now. Raises InputError."""
    if not (request.student and request.criterion and (request.points or request.comment)):
        raise InputError("name a STUDENT and a CRITERION, and give POINTS or --comment")
    book = Class(gradebook)
    reader, advice = _reader(book), f"; {printable_path(gradebook / names.GRADES)} lists all students"
    exact = [one for one in reader.students if one.key == request.student]
    student = exact[0] if exact else find_typed(reader.students, request.student, advice)
    key = student.key, request.criterion
    before = book.marks.counting.get(key) or book.marks.comments.get(key)
    append_marks(_file(book, request.by), _given(reader, [student.key], request))
    now = Class(gradebook)
    write_grades(now)
    for line in _warnings(now, key, request, before):
        warn(printable(line))
    grade = now.grade(student.key)
    late = f"; {grade.late.reason}" if request.criterion == DEADLINE and grade.late.reason else ""
    return f"{printable(f'{named(student.key, student.name)}: {_grade_text(now, grade)}{late}')}\n"


def mark_missing(gradebook: Path, request: MarkRequest) -> str:
    """Give all who certainly submitted nothing, and have no final mark, one; return how many. Raises InputError."""
    if request.criterion != TOTAL or not request.points or request.points == WITHDRAWN:
        raise InputError(f"write it as --missing {TOTAL} POINTS")
    book = Class(gradebook)
    missing = [one.student.key for one in book if one.graded is None and not (one.is_unclear or one.has_final)]
    append_marks(_file(book, request.by), _given(_reader(book), missing, request))
    write_grades(Class(gradebook))
    return f"{len(missing)} of {len(book.keys)} submitted nothing, and have the final mark {request.points} now\n"


def import_marks(gradebook: Path, file: Path, by: str) -> str:
    """Append the marks in a CSV file; return how many. Raises InputError, and records none, if a row is wrong."""
    from grader.classroom.review_items import answers_of

    book = Class(gradebook)
    reader = _reader(book)._replace(answers=answers_of(book))
    new, same = reader.read(read_capped(file, SIZE_LIMIT, advice=""), printable_path(file), by)
    append_marks(_file(book, by), new)
    write_grades(Class(gradebook))
    return f"{printable_path(file)}: {len(new)} recorded, {same} the same as before\n"


def _reader(book: Class) -> MarkImport:
    graded = {one.student: one for one in book.results.all()}
    students = [book.student(key, graded.get(key)) for key in book.keys]
    return MarkImport(students, book.rubric, book.marks, {key: one.digest for key, one in graded.items()})


def _given(reader: MarkImport, keys: Iterable[str], request: MarkRequest) -> list[Mark]:
    """Return the mark of a request for each student, given for the submission as it is now. Raises InputError."""
    cells = {**dict.fromkeys((*COLUMNS, SURPLUS), ""), "by": request.by, "criterion": request.criterion}
    cells |= {"points": request.points, "comment": request.comment}
    marks = [mark for key in keys for mark in reader.marks_in({**cells, "student": key})]
    return [mark._replace(time=reader.marks.next_time((mark.student, mark.criterion))) for mark in marks]


def _file(book: Class, by: str) -> Path:
    """Return the file of a grader, without a name that of the account: the files of two gradebooks can be merged."""
    with suppress(OSError, KeyError):  # of an account without a name
        by = by or getuser()
    return mark_file(book.folder / names.MARKS, by)


def _warnings(book: Class, key: Key, request: MarkRequest, before: Mark | None) -> Iterator[str]:
    """Yield what a mark replaced, that it does not count, and whom else the same submission counts for."""
    criterion = key[1]
    if before is not None:
        what = "mark" if before.value else "comment"
        words = f"{before.value}{by_name(before.by)}: {' '.join(before.comment.split())}".strip(": ")
        yield f"this replaces the {what} of {criterion} in {before.place}: {words}"
    elif request.points == WITHDRAWN:
        yield f"there was no mark of {criterion} to withdraw"
    if any(row.id == criterion and row.adjustment is not None for row in book.rubric.criteria):
        yield f"{criterion} is corrected after grading, by [adjust] in the rubric: its marks do not count"
    if criterion not in (TOTAL, DEADLINE) and (others := [*_unmarked_members(book, key)]):
        yield f"the same submission counts for {people_text(others, _MAX_NAMED)}: mark them as well"


def _unmarked_members(book: Class, key: Key) -> Iterator[str]:
    """Yield the other students of the same submission whose mark of a criterion is not the same."""
    own, mark = book.results.of(key[0]), book.marks.counting.get(key)
    for other in book.results.all() if own is not None else ():
        if other.student != key[0] and own is not None and (other.root, other.paths) == (own.root, own.paths):
            theirs = book.marks.counting.get((other.student, key[1]))
            if (theirs.value if theirs else "") != (mark.value if mark else ""):
                yield named(other.student, book.student(other.student, other).name)


def _grade_text(book: Class, grade: StudentGrade) -> str:
    """Return what counts: an excuse, a final mark, or the points of the criteria."""
    if grade.is_excused:
        return "excused"
    if grade.final_points is not None:
        whole = sum((row.maximum for row in book.criteria), Decimal(0))
        return f"final mark {format_points(grade.final_points)} of {format_points(whole)} points"
    if grade.report is None or grade.total is None:
        return "no submission"
    total = f"{format_points(grade.total)} of {format_points(grade.report.max_score)} points"
    late = f" after the late penalty of {format_points(-grade.late.points)}" if grade.late.points else ""
    return total + late + (f"; needs manual grading: {counted_points(grade.pending)}" if grade.pending else "")
