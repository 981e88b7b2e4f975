"""Fill a grading worksheet that was downloaded from Moodle with totals and comments, for "Upload grading worksheet".

How Moodle imports it is in mod/assign/feedback/offline (locallib.php, importgradeslib.php): it finds the student by the
number in Identifier; it skips a grade that is empty, equal, above the maximum, locked, or changed in Moodle since the
download; it writes every comment that differs, an empty one too. A worksheet shows rounded grades, so that even an
unchanged row could change one. So rows without a new grade are removed: a student who is not in the file keeps
everything.
"""

import html
import re
from collections.abc import Iterator, Sequence
from decimal import Decimal

from grader.classroom.lms.feedback import is_own_feedback
from grader.classroom.lms.filling import Filling, FillOptions, LmsStudent, check_maximum
from grader.classroom.lms.grades import LmsGrade, points_text, read_lms_points, rounded_down
from grader.classroom.lms.moodle_columns import MoodleColumns, find_columns, student_rows
from grader.classroom.lms.preflight import Filled, Preflight, RowNote
from grader.classroom.students import Student
from grader.classroom.tables import Table, TableRow, neutral, read_table
from grader.text import format_points

_TAG = re.compile(r"<[^>]*+>")  # gradingtable.php puts the name of a suspended student into a span, with a picture
_NUMBER = re.compile(r"\d+$")
_NO = frozenset({"no", "nein", "non", "não", "nee"})  # in the languages of `moodle_columns`


def fill_worksheet(data: bytes, grades: Sequence[LmsGrade], options: FillOptions) -> Filled:
    """Return a downloaded grading worksheet with the totals and comments, and what importing it changes.

    A comment that a person wrote or changed stays, and is reported. Raises InputError if the file is not a worksheet
    with points, and, unless any maximum is allowed, if its maximum grade is not that of the rubric.
    """
    table, columns = read_worksheet(data, options)
    maxima = sorted({row.value(columns.maximum) for row in student_rows(table) if len(row.cells) == len(table.titles)})
    if not options.any_maximum:
        check_maximum(f"Moodle's {table.titles[columns.maximum]!r}", maxima, options.out_of)
    filling = Filling(table, table.titles[columns.grade], students_of(table, columns))

    def fill_row(row: TableRow, grade: LmsGrade, total: Decimal) -> TableRow | str | RowNote:
        maximum = read_lms_points(row.value(columns.maximum))
        if row.value(columns.changeable).casefold() in _NO:
            return "has a grade that is locked in Moodle"
        if maximum is not None and rounded_down(total) > maximum:
            why = f"{points_text(total)} points are above the maximum of {format_points(maximum)}"
            return filling.note(row, f"{why}: raise the maximum there, or give a final mark")
        row = filling.with_points(row, columns.grade, total, row.value(columns.maximum))
        return _with_comment(filling, row, columns.feedback, neutral(grade.feedback))

    filled, preflight = filling.fill(grades, fill_row), filling.preflight
    preflight.warnings += _warnings(table, columns, options.out_of, maxima, preflight)
    if columns.feedback is None and any(grade.feedback for grade in grades):
        preflight.warnings.append("the file has no known column for feedback comments: no comment is written")
    return filled


def read_worksheet(data: bytes, options: FillOptions) -> tuple[Table, MoodleColumns]:
    """Return a grading worksheet and its columns; raises InputError if it is none."""
    table = read_table(data, options.shown)
    return table, find_columns(table, options.column, options.feedback_column, options.shown)


def students_of(table: Table, columns: MoodleColumns) -> list[LmsStudent]:
    """Return the students in a worksheet; `moodle` is the number of the participant."""
    return [_student(row, columns) for row in student_rows(table)]


def _with_comment(filling: Filling, row: TableRow, column: int | None, new: str) -> TableRow:
    old = row.value(column)
    if column is None or not new or old == new:
        return row
    if old and not is_own_feedback(old):
        why = "has a comment in Moodle that was written or changed by a person"
        filling.preflight.kept_feedback.append(filling.note(row, why))
        return row
    return filling.table.changed(row, column, new)


def _student(row: TableRow, columns: MoodleColumns) -> LmsStudent:
    name = " ".join(html.unescape(_TAG.sub(" ", row.value(columns.name))).split())
    identifier = row.value(columns.identifier)
    number = _NUMBER.search(identifier)
    student = Student("", name, row.value(columns.email), moodle=number[0] if number else "")
    return LmsStudent(row.number, name or identifier, student, tuple(row.value(index) for index in columns.numbers))


def _warnings(
    table: Table, columns: MoodleColumns, out_of: Decimal, maxima: Sequence[str], preflight: Preflight
) -> Iterator[str]:
    if any(read_lms_points(maximum) != out_of for maximum in maxima):
        yield f"the maximum in Moodle is {', '.join(maxima)} points, and that of the rubric {format_points(out_of)}"
    if not columns.has_modified:
        yield 'the file has no known column "Last modified (grade)": Moodle refuses a worksheet without it'
    if preflight.conflicts:
        yield (
            "Moodle skips a grade that was changed there after the download, and in some languages "
            'every existing grade, unless "Allow updating records that have been modified more recently" is ticked'
        )
    if table.delimiter != "," or not table.encoding.startswith("utf-8"):
        name = {",": "comma", ";": "semicolon", "\t": "tab"}[table.delimiter]
        yield f"when you upload the file, choose {name} and {table.encoding.upper()}"
