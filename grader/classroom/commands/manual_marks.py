"""Give and withdraw marks by command.

They are those of one student, of all who submitted nothing, or of a CSV file.
"""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from grader.base.errors import InputError
from grader.base.text import (
    by_name,
    counted,
    counted_points,
    format_points,
    named,
    people_text,
    printable,
    printable_path,
)
from grader.classroom.gradebook.gradebook import Gradebook, list_points
from grader.classroom.gradebook.grades_file import write_grades_with
from grader.classroom.gradebook.review_items import review_items
from grader.classroom.gradebook.student_grade import Reason, StudentGrade
from grader.classroom.marks import gradebook_folder as names
from grader.classroom.marks.mark_import import MarkImport
from grader.classroom.marks.marks import (
    COLUMNS,
    SURPLUS,
    WITHDRAWN,
    Cells,
    Mark,
    append_marks,
    mark_file,
    marked_name,
)
from grader.classroom.tables import SIZE_LIMIT
from grader.files.reading import read_capped
from grader.lab.rubric.criterion import DEADLINE, GRADE
from grader.report.writing import Warn

_NO_TIME = (
    "the new deadline has no effect: the time of the submission is unknown; add a column "
    "`submitted` to the roster"
)
_EMPTY = dict.fromkeys((*COLUMNS, SURPLUS), "")


def give_mark(gradebook: Path, row: Cells, warn: Warn) -> str:
    """Append the mark in a row to the file of its grader.

    Return what counts for the student now.

    Raises InputError.
    """
    if not (row["student"] and row["criterion"] and (row["points"] or row["comment"])):
        raise InputError("name a STUDENT and a CRITERION, and give POINTS or --comment")
    book = Gradebook(gradebook)
    [mark] = _mark_import(book).marks_in({**_EMPTY, **row})
    now = _append_marks(book, [mark], row["by"], warn)
    for line in _warnings(book, mark):
        warn(printable(line))
    grade = now.grade(mark.student)
    late = ""
    if mark.criterion == DEADLINE:
        late = f"; {grade.late.reason}" if grade.late.reason else ""
        if mark.value != WITHDRAWN and grade.late.days and not grade.late.is_timed:
            warn(_NO_TIME)
    line = f"{named(mark.student, grade.student.name)}: {_grade_text(now, grade)}{late}"
    return f"{printable(line)}\n"


def mark_missing(gradebook: Path, row: Cells, warn: Warn) -> str:
    """Give a final mark to all students who submitted nothing and have none; return how many.

    Raises InputError.
    """
    if marked_name(row["criterion"]) != GRADE or row["points"] in ("", WITHDRAWN):
        raise InputError(f"write it as --missing {GRADE} POINTS")
    book = Gradebook(gradebook)
    reader = _mark_import(book)
    grades = list(book)
    missing = [one.student.key for one in grades if Reason.MISSING in one.concerns]
    marks = [mark for key in missing for mark in reader.marks_in({**_EMPTY, **row, "student": key})]
    if marks:
        _append_marks(book, marks, row["by"], warn)
    for line in _unassigned(grades):
        warn(printable(line))
    return (
        f"final mark {row['points']} for {len(missing)} of {counted(len(book.keys), 'student')}\n"
    )


def _unassigned(grades: Sequence[StudentGrade]) -> Iterator[str]:
    """Yield which submissions have no student for certain.

    One of them may be that of a student who has none.
    """
    visitors = (
        one.stored for one in grades if Reason.NOT_ON_ROSTER in one.concerns and not one.is_gone
    )
    if paths := [stored.paths[0] for stored in visitors if stored and stored.paths]:
        yield (
            f"still unassigned: {people_text(paths)}: a student with this mark may "
            "have submitted it"
        )
    unclear = [one.student.label for one in grades if Reason.UNCLEAR in one.concerns]
    if unclear:
        yield f"no mark for {people_text(unclear)}: {Reason.UNCLEAR}"


def import_marks(gradebook: Path, file: Path, by: str, warn: Warn) -> str:
    """Append the marks in a CSV file; return how many.

    Raises InputError, and records none, if a row is wrong.
    """
    book = Gradebook(gradebook)
    answers = {}
    for place, item in review_items(book, with_final=True).items():
        answers[place] = [member.student.key for member in item.members]
    points = {grade.student.key: list_points(book, grade) for grade in book}
    reader = _mark_import(book)._replace(answers=answers, points=points)
    new, same = reader.read(read_capped(file, SIZE_LIMIT, advice=""), printable_path(file))
    _append_marks(book, new, by, warn)
    return f"{printable_path(file)}: {len(new)} recorded, {same} the same as before\n"


def _mark_import(book: Gradebook) -> MarkImport:
    graded = {one.student: one for one in book.results.all()}
    students = [book.student(key, graded.get(key)) for key in book.keys]
    return MarkImport(
        students, book.rubric, book.marks, {key: one.digest for key, one in graded.items()}
    )


def _append_marks(book: Gradebook, marks: Iterable[Mark], by: str, warn: Warn) -> Gradebook:
    """Append marks to the file of a grader, and return the class with them.

    Its grades are written.
    """
    new = [
        one._replace(by=one.by or by, time=book.marks.next_time((one.student, one.criterion)))
        for one in marks
    ]
    names.warn_without_locks(book.folder, warn)
    if new:
        append_marks(mark_file(book.folder / names.MARKS, by), new)
    now = Gradebook(book.folder)
    write_grades_with(len(new), now)
    return now


def _warnings(before: Gradebook, mark: Mark) -> Iterator[str]:
    """Yield what a mark replaced, and that it does not count."""
    criterion = mark.criterion
    marks = before.marks
    if old := marks.counting.get((mark.student, criterion)) or marks.comments.get(
        (mark.student, criterion)
    ):
        what = "mark" if old.value else "comment"
        words = f"{old.value}{by_name(old.by)}: {' '.join(old.comment.split())}".strip(": ")
        change = "withdrawn:" if mark.value == WITHDRAWN else "this replaces"
        yield f"{change} the {what} of {criterion} in {old.place}: {words}"
    elif mark.value == WITHDRAWN:
        yield f"there was no mark of {criterion} to withdraw"
    if any(row.id == criterion and row.adjustment is not None for row in before.rubric.criteria):
        yield (
            f"{criterion} is corrected after grading, by [adjust] in the rubric: its marks do "
            "not count"
        )


def _grade_text(book: Gradebook, grade: StudentGrade) -> str:
    """Return what counts: an excuse, a final mark, or the points of the criteria."""
    if grade.total is None:
        return "excused" if grade.is_excused else "no submission"
    points = format_points(grade.total)
    if grade.has_final:
        text = f"final mark {points} of {format_points(book.maximum)} points"
    else:  # also with marks of parts that are not graded
        text = f"{points} of {format_points(grade.report.max_score)} points"
    if grade.late.points:
        text += f" after the late penalty of {format_points(-grade.late.points)}"
    if grade.pending:
        text += f"; needs manual grading: {counted_points(grade.pending)}"
    return text
