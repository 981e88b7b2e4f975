"""Fill a gradebook that was exported from Canvas with the totals, for Grades > Import.

How Canvas imports it is in lib/gradebook_importer.rb: it finds the student by ID, SIS User ID, SIS Login ID, then name; a cell that
differs from the gradebook is a change, an empty one too; the row of points possible sets the assignment's points. So rows without a
new grade are removed, and the rest of the file stays as it was exported.
"""

import re
from collections.abc import Iterator, Sequence
from decimal import Decimal

from grader.classroom.lms.canvas_columns import CanvasColumns, find_columns, is_student, names_rubric
from grader.classroom.lms.filling import check_maximum, fill_rows, with_points
from grader.classroom.lms.grades import LmsGrade, exact_text, has_decimal_comma, read_points
from grader.classroom.lms.matching import LmsStudent
from grader.classroom.lms.preflight import Filled, Preflight
from grader.classroom.lms.tables import Table, TableRow, read_table
from grader.classroom.students import Student

_QUOTED = re.compile(r'="(.*)"', re.DOTALL)  # gradebook_exporter.rb writes names that begin with = like this
_TEST_STUDENT = frozenset({"student, test", "test student"})
_NO_GRADE = {"ex": "is excused in Canvas", "n/a": "is not assigned this assignment in Canvas"}


def fill_gradebook(
    data: bytes,
    grades: Sequence[LmsGrade],
    *,
    out_of: Decimal,
    rubric_names: tuple[str, ...] = (),
    column: str = "",
    any_maximum: bool = False,
    shown: str = "the gradebook",
) -> Filled:
    """Return an exported gradebook with the totals in one assignment's column, and what importing it changes.

    The column is found by `rubric_names`, or is the one with the title or number `column`. Raises InputError if the file is not a
    gradebook, if the column is ambiguous, and, unless `any_maximum`, if its points possible are not `out_of`.
    """
    table = read_table(data, shown)
    columns = find_columns(table, column, rubric_names, shown)
    possible = columns.points_possible.value(columns.grade) if columns.points_possible is not None else ""
    if not any_maximum and columns.points_possible is not None:
        check_maximum(f"Canvas' Points Possible of {columns.title!r}", [possible], out_of)
    preflight = Preflight(columns.title)

    def fill_row(row: TableRow, _: LmsGrade, total: Decimal, who: str) -> TableRow | str:
        no_grade = _NO_GRADE.get(row.value(columns.grade).casefold())
        comma = has_decimal_comma(possible)
        return no_grade or with_points(table, row, columns.grade, total, who, preflight, comma=comma)

    students = [_student(row, columns) for row in table.rows if is_student(row)]
    filled = fill_rows(table, students, grades, preflight, fill_row)
    preflight.unknown = [note for note in preflight.unknown if note.who.casefold() not in _TEST_STUDENT]
    preflight.warnings += _warnings(table, columns, out_of, rubric_names if not column else ())
    return filled


def _student(row: TableRow, columns: CanvasColumns) -> LmsStudent:
    value = row.value
    quoted = _QUOTED.fullmatch(value(columns.name))
    name = quoted[1] if quoted else value(columns.name)
    if columns.first_name is not None:
        name = f"{name}, {value(columns.first_name)}"
    student = Student("", name, login=value(columns.login), sis=value(columns.sis), canvas=value(columns.id))
    return LmsStudent(row.number, name, student)


def _warnings(table: Table, columns: CanvasColumns, out_of: Decimal, rubric_names: tuple[str, ...]) -> Iterator[str]:
    title = repr(columns.title)
    if columns.points_possible is None:
        yield "the file has no row Points Possible: the maximum in Canvas is unknown"
    elif read_points(possible := columns.points_possible.value(columns.grade)) != out_of:
        yield f"{title} has {possible or 'no'} points possible in Canvas, and {exact_text(out_of)} here"
    if rubric_names and not names_rubric(columns.title, rubric_names):
        yield f"{title} is the only assignment in the file, but its title does not contain {rubric_names[-1]!r}"
    if columns.titles.count("Section") > 1:
        yield "the file has more than one column Section: Canvas reads the first one's place"
    if columns.others:
        yield f"the file has {columns.others} more assignments: importing it resets them to their values at the time of the export"
    if table.delimiter == "\t" or table.encoding != "utf-8":
        yield "Canvas reads commas and semicolons in UTF-8, but this file has another format"
