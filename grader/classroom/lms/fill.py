"""Fill a grade file of an LMS with the grades of a class, and say what importing it changes.

Only the cells of the grade, and Moodle's comments, are written; every other byte stays. An empty cell may be imported
as a change, and Moodle's worksheets have rounded grades. So rows of students without a grade are removed.
"""

import re
from collections.abc import Iterable, Sequence
from decimal import ROUND_FLOOR, Decimal
from typing import NamedTuple

from grader.classroom.lms.comments import is_own_comment
from grader.classroom.lms.forms import Form
from grader.classroom.lms.grade_file import FillOptions, GradeFile, StudentRow, read_grade_file, read_points
from grader.classroom.lms.owners import AMBIGUOUS, MISSING, UNKNOWN, ClassGrade, Note, match_rows
from grader.classroom.tables import TableRow
from grader.errors import InputError
from grader.text import first_lines, format_points, people_text, printable

_OPEN, _KEPT = "without a grade", "kept the comment"
_REFUSED = "the LMS would refuse the grade"
_INCOMPLETE = frozenset({_REFUSED, UNKNOWN, MISSING, AMBIGUOUS})
_NOT_GRADED = frozenset({"", "-", "needs grading"})  # the last in Blackboard
_COMMA = re.compile(r"[0-9],[0-9]{1,2}$")
_MAX_CHANGES, _MAX_REASONS, _MAX_NAMED = 40, 50, 3


class Filled(NamedTuple):
    """A filled file and what importing it does; it is complete if each row has its student, and each grade its row."""

    data: bytes
    lines: list[str]
    is_complete: bool


def fill(data: bytes, grades: Sequence[ClassGrade], form: Form, options: FillOptions) -> Filled:
    """Return a grade file with the grades in the column of the lab; raises InputError if it is not such a file."""
    file = read_grade_file(data, form, options)
    header = file.table.titles[file.roles["grade"]]
    warnings = _check_maximum(file.maximum, f"{header!r} in {form.lms}", options)
    known = [grade if form.excuse else grade._replace(is_excused=False) for grade in grades]
    found, notes = match_rows([*file.students.values()], known, form.lms)
    rows, changes, filled, unchanged = list[TableRow](), list[str](), 0, 0
    for row in file.table.rows:
        grade, one = found.get(row.number), file.students.get(row.number)
        new = form.excuse if grade is None or grade.total is None else _points_text(grade.total, like=file.maximum)
        if one is None:
            rows.append(row)
        elif grade is not None and (note := _why_not(file, form, row, grade, new)):
            notes.append(Note(note[0], one.who, note[1]))
        elif grade is not None:
            rows.append(_with_grade(file, one, new, changes))
            if (comment := _with_comment(file, rows[-1], grade.comment)) is None:
                notes.append(Note(_KEPT, one.who, f"a person wrote or changed it in {form.lms}"))
            rows[-1] = comment or rows[-1]
            filled += rows[-1] is not row
            unchanged += rows[-1] is row
    table = file.table._replace(rows=tuple(rows))
    if options.only and "maximum" not in file.roles:
        table = table.with_columns([*{*file.roles.values()}])
    count = f"column {header!r}: {filled} filled in, {unchanged} already the same"
    lines = [count, *first_lines(changes, _MAX_CHANGES), *by_reason(notes), *warnings]
    return Filled(table.encoded(), [*map(printable, lines)], not any(note.kind in _INCOMPLETE for note in notes))


def _why_not(file: GradeFile, form: Form, row: TableRow, grade: ClassGrade, new: str) -> tuple[str, str] | None:
    """Return why a row does not get a grade: the kind of the reason, and the reason."""
    titles = file.table.titles
    if grade.total is None and not grade.is_excused:
        return _OPEN, grade.why_open or "has no grade"
    if len(row.cells) != len(titles):
        return _OPEN, f"the row has {len(row.cells)} cells and the header {len(titles)}"
    for role, words in form.locked.items():
        cell = row.value(file.roles.get(role))
        if cell.casefold() in words and cell.casefold() != new.casefold():
            return _OPEN, f"{titles[file.roles[role]]!r} is {cell!r} in {form.lms}"
    if form.above and (read_points(new) or 0) > (read_points(file.maximum) or 0):
        return _REFUSED, f"{new} points are above the maximum of {file.maximum}: {form.above}"
    return None


def _with_grade(file: GradeFile, one: StudentRow, new: str, changes: list[str]) -> TableRow:
    """Return a row with a grade, and add a line to the changes if it replaces another one."""
    old = one.row.value(file.roles["grade"])
    if old.casefold() == new.casefold() or (read_points(old) is not None and read_points(old) == read_points(new)):
        return one.row
    if old.casefold() not in _NOT_GRADED:
        changes.append(f"{one.who}: was {old}, becomes {new}")
    return file.table.changed(one.row, file.roles["grade"], new)


def _with_comment(file: GradeFile, row: TableRow, new: str) -> TableRow | None:
    """Return a row with a comment; None if there is one of a person."""
    column = file.roles.get("comment")
    old = row.value(column)
    if column is None or not new or old == new:
        return row
    return file.table.changed(row, column, new) if not old or is_own_comment(old) else None


def participants(data: bytes, grades: Sequence[ClassGrade], form: Form, options: FillOptions) -> dict[str, str]:
    """Return the students' numbers in a worksheet of Moodle by key; raises InputError if it is none."""
    file = read_grade_file(data, form, options)
    found, _ = match_rows([*file.students.values()], grades, form.lms)
    return {grade.student.key: file.students[number].student.moodle for number, grade in found.items()}


def by_reason(notes: Iterable[Note]) -> list[str]:
    """Return a line for each reason: who has it, of several how many and the first of them."""
    names: dict[tuple[str, str], list[str]] = {}
    for note in notes:
        names.setdefault((note.kind, note.why), []).append(note.who)
    groups = (
        (*key, f"{len(who)} ({people_text(who, _MAX_NAMED)})" if who[1:] else who[0]) for key, who in names.items()
    )
    return first_lines([f"{kind}: {who}: {why}" for kind, why, who in groups], _MAX_REASONS)


def _points_text(points: Decimal, like: str) -> str:
    """Return points with two decimals, rounded down, for 99.996 of 100 is not the maximum; `like` may have a comma."""
    text = format(points.quantize(Decimal("0.01"), ROUND_FLOOR), "f")
    return text.replace(".", ",") if _COMMA.search(like) else text


def _check_maximum(text: str, what: str, options: FillOptions) -> list[str]:
    """Return a warning about an unknown maximum; raises InputError for another one: 9.33 of 100 is not 9.33 of 10."""
    maximum = read_points(text)
    if maximum is not None and maximum != options.out_of and not options.any_maximum:
        others = f"{format_points(maximum)}, but that of the rubric is {format_points(options.out_of)}"
        advice = "change it in the LMS and export again, or pass --any-maximum to write the points unchanged"
        raise InputError(f"the maximum of {what} is {others}: {advice}")
    return [] if maximum is not None else [f"the file does not state the maximum of {what}"]
