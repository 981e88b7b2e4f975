"""Our totals and comments in a grading worksheet that was downloaded from Moodle, for "Upload grading worksheet".

What Moodle does with the file is in mod/assign/feedback/offline (locallib.php, importgradeslib.php): it finds the student by
the number in Identifier; it skips a grade that is empty, equal, above the maximum, locked, or changed in Moodle since the
download; it writes every comment that differs, an empty one too. A worksheet shows grades rounded, so that a row that went
back unchanged could still change one. So rows without a grade of ours are left out: whoever is not in the file keeps all.
"""

import html
import re
from collections.abc import Sequence
from decimal import Decimal

from grader.classroom.lms.feedback import is_our_feedback
from grader.classroom.lms.filling import Filling, same_maximum
from grader.classroom.lms.grades import LmsGrade, cut, exact_words, has_decimal_comma, points_text, read_points
from grader.classroom.lms.matching import LmsStudent, join
from grader.classroom.lms.moodle_columns import MoodleColumns, find_columns, people_rows
from grader.classroom.lms.moodle_headers import NO
from grader.classroom.lms.preflight import Filled
from grader.classroom.lms.spreadsheet import neutral
from grader.classroom.lms.tables import Table, TableRow, read_table
from grader.classroom.students import Student

_TAG = re.compile(r"<[^>]*+>")  # gradingtable.php puts the name of a suspended student into a span, with a picture
_NUMBER = re.compile(r"\d+$")


def fill_worksheet(
    data: bytes,
    grades: Sequence[LmsGrade],
    *,
    out_of: Decimal,
    column: str = "",
    feedback_column: str = "",
    any_maximum: bool = False,
    shown: str = "the worksheet",
) -> Filled:
    """A downloaded grading worksheet with our totals and comments, and what that changes.

    `column` and `feedback_column` name the two columns by their headers, where they cannot be told. A comment that is not ours
    as it was made is a person's: it stays, and is reported. Raises InputError where the file is no worksheet with points, and, unless
    `any_maximum`, where its maximum grade is not `out_of`.
    """
    table = read_table(data, shown)
    columns = find_columns(table, column, feedback_column, shown)
    if not any_maximum:
        same_maximum(f"Moodle's {columns.titles[columns.maximum]!r}", sorted(_maxima(table, columns)), out_of)
    people = {row.number: _person(row, columns) for row in people_rows(table)}
    filling = Filling(columns.title, join(list(people.values()), grades))
    rows = []
    for row in table.rows:
        person = people.get(row.number)
        kept = _filled(table, row, columns, person.who, filling) if person else row
        rows += [kept] if kept else []
    filling.warnings += _warnings(table, columns, out_of, filling)
    if columns.feedback is None and any(grade.feedback for grade in grades):
        filling.warnings.append("the file has no column for feedback comments that is known: no comment is written")
    return filling.result(table, rows)


def _filled(table: Table, row: TableRow, columns: MoodleColumns, who: str, filling: Filling) -> TableRow | None:
    """A student's row with grade and comment, or None where it is to be left out."""
    grade = filling.grade_of(row, who, len(columns.titles))
    if grade is None or grade.total is None:
        return None
    maximum = read_points(row.value(columns.maximum))
    if row.value(columns.changeable).casefold() in NO:
        filling.leave(row, who, "has a grade that is locked in Moodle")
        return None
    if maximum is not None and cut(grade.total) > maximum:
        filling.leave(
            row, who, f"has {points_text(grade.total)} points, and Moodle takes {exact_words(maximum)} at most"
        )
        return None
    new = _with_comment(
        table, _with_points(table, row, columns, who, grade.total, filling), columns, who, grade, filling
    )
    filling.unchanged += new is row
    filling.filled += new is not row
    return new


def _with_points(
    table: Table, row: TableRow, columns: MoodleColumns, who: str, total: Decimal, filling: Filling
) -> TableRow:
    old = row.value(columns.grade)
    new = points_text(total, comma=has_decimal_comma(row.value(columns.maximum)))
    if read_points(old) == read_points(new):
        return row
    if old not in {"", "-"}:
        filling.overwrite(row, who, old, new)
    return table.changed(row, columns.grade, new)


def _with_comment(
    table: Table, row: TableRow, columns: MoodleColumns, who: str, grade: LmsGrade, filling: Filling
) -> TableRow:
    old, new = row.value(columns.feedback), neutral(grade.feedback)
    if columns.feedback is None or not new or old == new:
        return row
    if old and not is_our_feedback(old):
        filling.keep_feedback(row, who, "has a comment in Moodle that was written or changed by a person")
        return row
    return table.changed(row, columns.feedback, new)


def _person(row: TableRow, columns: MoodleColumns) -> LmsStudent:
    name = " ".join(html.unescape(_TAG.sub(" ", row.value(columns.name))).split())
    identifier = row.value(columns.identifier)
    number = _NUMBER.search(identifier)
    student = Student("", name, row.value(columns.email), moodle=number[0] if number else "")
    return LmsStudent(row.number, name or identifier, student, tuple(row.value(index) for index in columns.numbers))


def _maxima(table: Table, columns: MoodleColumns) -> set[str]:
    return {row.value(columns.maximum) for row in people_rows(table) if len(row.cells) == len(columns.titles)}


def _warnings(table: Table, columns: MoodleColumns, out_of: Decimal, filling: Filling) -> list[str]:
    warnings = []
    maxima = _maxima(table, columns)
    if any(read_points(maximum) != out_of for maximum in maxima):
        warnings.append(f"Moodle counts to {', '.join(sorted(maxima))} points, and the rubric to {exact_words(out_of)}")
    if not columns.has_modified:
        warnings.append(
            'the file has no column "Last modified (grade)" that is known: Moodle refuses a worksheet without it'
        )
    if filling.conflicts:
        warnings.append(
            "Moodle skips a grade that was changed there after the download, and in some languages every grade that is there"
            ' already, unless "Allow updating records that have been modified more recently" is ticked'
        )
    if table.delimiter != "," or not table.encoding.startswith("utf-8"):
        name = {",": "comma", ";": "semicolon", "\t": "tab"}[table.delimiter]
        warnings.append(f"choose {name} and {table.encoding.upper()} where the file is uploaded: so it is written")
    return warnings
