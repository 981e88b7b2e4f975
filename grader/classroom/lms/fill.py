"""Fill a grade file of an LMS with the grades of a class, and say what importing it changes.

Only the cells of the grade, and Moodle's comments, are written; every other byte stays. An empty cell may be imported
as a change, and Moodle's worksheets have rounded grades. So rows of students without a grade are removed.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from decimal import ROUND_FLOOR, Decimal
from typing import NamedTuple

from grader.classroom.lms.comments import is_own_comment
from grader.classroom.lms.forms import Form
from grader.classroom.lms.grade_file import FillOptions, GradeFile, StudentRow, read_grade_file, read_points
from grader.classroom.lms.owners import AMBIGUOUS, MISSING, UNKNOWN, ClassGrade, Note, match_rows
from grader.classroom.tables import TableRow
from grader.errors import InputError
from grader.text import first_lines, format_points, people_text, printable

_OPEN, _EXCUSED, _KEPT = "without a grade", "excused", "kept the comment"
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


@dataclass(slots=True)
class _Filling:
    """What was filled so far."""

    form: Form
    file: GradeFile
    notes: list[Note]
    changes: list[str] = field(default_factory=list)
    filled: int = 0
    unchanged: int = 0

    def row(self, one: StudentRow, grade: ClassGrade) -> TableRow | None:
        """Return a row with the grade and the comment; None, with a note, if it cannot be filled."""
        new = self.form.excuse
        if grade.total is not None:
            new = _points_text(grade.total, like=self.file.maximum)
        if why := self._why_not(one.row, grade):
            self.notes.append(Note(_OPEN, one.who, why))
            return None
        if self.form.above and (read_points(new) or 0) > (read_points(self.file.maximum) or 0):
            why = f"{new} points are above the maximum of {self.file.maximum}: {self.form.above}"
            self.notes.append(Note(_REFUSED, one.who, why))
            return None
        if grade.total is None:
            self.notes.append(Note(_EXCUSED, one.who, f"{new} in the file"))
        row = self._with_comment(self._with_grade(one, new), one, grade.comment)
        self.filled += row is not one.row
        self.unchanged += row is one.row
        return row

    def _why_not(self, row: TableRow, grade: ClassGrade) -> str:
        """Return why a row gets no grade; empty if it gets one."""
        if grade.total is None and not grade.is_excused:
            return grade.why_open or "has no grade"
        titles = self.file.table.titles
        if len(row.cells) != len(titles):
            return f"the row has {len(row.cells)} cells and the header {len(titles)}"
        for role, words in self.form.locked.items():
            column = self.file.roles.get(role)
            is_same = grade.is_excused and row.value(column).casefold() == self.form.excuse.casefold()
            if column is not None and row.value(column).casefold() in words and not is_same:
                return f"{titles[column]!r} is {row.value(column)!r} in {self.form.lms}"
        return ""

    def _with_grade(self, one: StudentRow, new: str) -> TableRow:
        column = self.file.roles["grade"]
        old = one.row.value(column)
        if old.casefold() == new.casefold() or (read_points(old) is not None and read_points(old) == read_points(new)):
            return one.row
        if old.casefold() not in _NOT_GRADED:
            self.changes.append(f"{one.who}: was {old}, becomes {new}")
        return self.file.table.changed(one.row, column, new)

    def _with_comment(self, row: TableRow, one: StudentRow, new: str) -> TableRow:
        column = self.file.roles.get("comment")
        old = row.value(column)
        if column is None or not new or old == new:
            return row
        if old and not is_own_comment(old):
            self.notes.append(Note(_KEPT, one.who, f"a person wrote or changed it in {self.form.lms}"))
            return row
        return self.file.table.changed(row, column, new)


def fill(data: bytes, grades: Sequence[ClassGrade], form: Form, options: FillOptions) -> Filled:
    """Return a grade file with the grades in the column of the lab; raises InputError if it is not such a file."""
    file = read_grade_file(data, form, options)
    header = file.table.titles[file.roles["grade"]]
    warnings = _check_maximum(file.maximum, f"{header!r} in {form.lms}", options)
    known = [grade if form.excuse else grade._replace(is_excused=False) for grade in grades]
    found, notes = match_rows(file.students, known, form.lms)
    filling, students = _Filling(form, file, notes), {one.row.number: one for one in file.students}
    rows = list[TableRow]()
    for row in file.table.rows:
        grade = found.get(row.number)
        new = filling.row(students[row.number], grade) if grade else None if row.number in students else row
        rows += [new] if new else []
    table = replace(file.table, rows=tuple(rows))
    if options.only and "maximum" not in file.roles:
        table = table.with_columns([*{*file.roles.values()}])
    lines = [
        f"column {header!r}: {filling.filled} filled in, {filling.unchanged} already the same",
        *first_lines(filling.changes, _MAX_CHANGES),
        *by_reason(notes),
        *warnings,
    ]
    return Filled(table.encoded(), [*map(printable, lines)], not any(note.kind in _INCOMPLETE for note in notes))


def participants(data: bytes, grades: Sequence[ClassGrade], form: Form, options: FillOptions) -> dict[str, str]:
    """Return the students' numbers in a worksheet of Moodle by key; raises InputError if it is none."""
    file = read_grade_file(data, form, options)
    found, _ = match_rows(file.students, grades, form.lms)
    return {found[one.row.number].student.key: one.student.moodle for one in file.students if one.row.number in found}


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
