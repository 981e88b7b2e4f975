"""Our totals in a gradebook that was exported from Canvas, for Grades > Import.

What Canvas does with the file is in lib/gradebook_importer.rb: it finds the student by ID, SIS User ID, SIS Login ID, then name;
a cell that differs from the gradebook is a change, an empty one too; the row of points possible sets the assignment's points.
So rows without a grade of ours are left out, and the rest of the file stays as it was exported.
"""

import re
from collections.abc import Sequence
from decimal import Decimal

from grader.classroom.lms.canvas_columns import CanvasColumns, find_columns, is_student, names_rubric
from grader.classroom.lms.filling import Filling, same_maximum
from grader.classroom.lms.grades import LmsGrade, exact_words, has_decimal_comma, points_text, read_points
from grader.classroom.lms.matching import LmsStudent, join
from grader.classroom.lms.preflight import Filled
from grader.classroom.lms.tables import Table, TableRow, read_table
from grader.classroom.students import Student

_QUOTED = re.compile(r'="(.*)"', re.DOTALL)  # gradebook_exporter.rb: so are names that begin with =
_TEST_STUDENT = frozenset({"student, test", "test student"})
_NOT_OURS = {"ex": "is excused in Canvas", "n/a": "is not given this assignment in Canvas"}


def fill_gradebook(
    data: bytes,
    grades: Sequence[LmsGrade],
    *,
    out_of: Decimal,
    wanted: tuple[str, ...] = (),
    column: str = "",
    any_maximum: bool = False,
    shown: str = "the gradebook",
) -> Filled:
    """An exported gradebook with our totals in one assignment's column, and what that changes.

    `wanted` are names of the rubric, by which the column is found; `column` names it outright, by title or number. Raises
    InputError where the file is no gradebook, where it is not plain which column is meant, and, unless `any_maximum`, where
    its points possible are not `out_of`.
    """
    table = read_table(data, shown)
    columns = find_columns(table, column, wanted, shown)
    if not any_maximum and columns.points_possible is not None:
        possible = columns.points_possible.value(columns.grade)
        same_maximum(f"Canvas' Points Possible of {columns.title!r}", [possible], out_of)
    people = {row.number: _person(row, columns) for row in table.rows if is_student(row)}
    filling = Filling(columns.title, join(list(people.values()), grades))
    comma = columns.points_possible is not None and has_decimal_comma(columns.points_possible.value(columns.grade))
    rows = []
    for row in table.rows:
        person = people.get(row.number)
        kept = _filled(table, row, columns, person.who, filling, comma) if person else row
        rows += [kept] if kept else []
    filling.unknown = tuple(left for left in filling.unknown if left.who.casefold() not in _TEST_STUDENT)
    filling.warnings += _warnings(table, columns, out_of, wanted if not column else ())
    return filling.result(table, rows)


def _filled(
    table: Table, row: TableRow, columns: CanvasColumns, who: str, filling: Filling, comma: bool
) -> TableRow | None:
    """A student's row with the grade, or None where it is to be left out."""
    grade = filling.grade_of(row, who, len(columns.titles))
    if grade is None or grade.total is None:
        return None
    old = row.value(columns.grade)
    if old.casefold() in _NOT_OURS:
        filling.leave(row, who, _NOT_OURS[old.casefold()])
        return None
    new = points_text(grade.total, comma=comma)
    if read_points(old) == read_points(new):
        filling.unchanged += 1
        return row
    if old not in {"", "-"}:
        filling.overwrite(row, who, old, new)
    filling.filled += 1
    return table.changed(row, columns.grade, new)


def _person(row: TableRow, columns: CanvasColumns) -> LmsStudent:
    written = row.value(columns.name)
    quoted = _QUOTED.fullmatch(written)
    name = quoted[1] if quoted else written
    if columns.first_name is not None:
        name = f"{name}, {row.value(columns.first_name)}"
    value = row.value
    student = Student("", name, login=value(columns.login), sis=value(columns.sis), canvas=value(columns.id))
    return LmsStudent(row.number, name, student)


def _warnings(table: Table, columns: CanvasColumns, out_of: Decimal, wanted: tuple[str, ...]) -> list[str]:
    warnings = []
    if columns.points_possible is None:
        warnings.append("the file has no row Points Possible: nobody can tell whether Canvas counts in the same points")
    elif read_points(possible := columns.points_possible.value(columns.grade)) != out_of:
        warnings.append(
            f"{columns.title!r} has {possible or 'no'} points possible in Canvas, and {exact_words(out_of)} here"
        )
    if wanted and not names_rubric(columns.title, wanted):
        warnings.append(
            f"{columns.title!r} is the only assignment in the file, and its title does not name {wanted[-1]!r}"
        )
    if columns.titles.count("Section") > 1:
        warnings.append("the file has more than one column Section: Canvas reads the first one's place")
    if columns.others:
        warnings.append(
            f"the file has {columns.others} more assignments: importing it sets them back to what they were when it was exported"
        )
    if table.delimiter == "\t" or table.encoding != "utf-8":
        warnings.append("Canvas reads commas and semicolons in UTF-8, and this file is written in another way")
    return warnings
