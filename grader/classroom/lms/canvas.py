"""Fill a gradebook that was exported from Canvas with the totals, for Grades > Import.

How Canvas imports it is in lib/gradebook_importer.rb: it finds the student by ID, SIS User ID, SIS Login ID, then name;
a cell that differs from the gradebook is a change, an empty one too, and EX is an excuse; the row of points possible
sets the assignment's points. A column that is not in the file does not change. So rows without a new grade are removed,
and the rest of the file does not change. The columns are detected as Canvas does: it does not translate these headers.
A new export may have LastName and FirstName instead of Student (lib/gradebook_exporter.rb).
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal

from grader.classroom.lms.assignments import GradeColumn, assignment_warnings, find_assignment
from grader.classroom.lms.filling import Filling, FillOptions, LmsStudent, check_maximum, first_of_each
from grader.classroom.lms.grades import LmsGrade, read_lms_points
from grader.classroom.lms.preflight import Filled
from grader.classroom.students import CANVAS_TEST_STUDENT, Student
from grader.classroom.tables import Table, TableRow, read_table
from grader.errors import InputError
from grader.text import format_points

_IDENTITY = frozenset(
    {
        "Student", "LastName", "FirstName", "ID", "SIS User ID", "SIS Login ID", "Section", "Integration ID",
        "Root Account",
    }
)  # fmt: skip
_COMPUTED = re.compile(r"(Current|Final) (Score|Points|Grade)|Override (Score|Grade|Status)")
_READ_ONLY = re.compile(r"\(.+\)")  # "(read only)", in the user's language
_TITLE_AND_ID = re.compile(r"(.*)\s\(([0-9]+)\)", re.DOTALL)
_NOT_A_STUDENT = re.compile(r"\s*(muted|manual posting.*)?\s*", re.IGNORECASE)
_QUOTED = re.compile(r'="(.*)"', re.DOTALL)  # gradebook_exporter.rb writes names that begin with = like this
_EXCUSE = "EX"
_NO_GRADE = {"ex": "is excused in Canvas", "n/a": "is not assigned this assignment in Canvas"}


@dataclass(frozen=True, slots=True)
class _Columns:
    """The columns by index, None where the export lacks them, and the row of the points possible, if there is one."""

    titles: tuple[str, ...]
    name: int
    first_name: int | None
    id: int
    sis: int | None
    login: int | None
    writable: tuple[GradeColumn, ...]
    grade: GradeColumn
    points_possible: TableRow | None


def fill_gradebook(data: bytes, grades: Sequence[LmsGrade], options: FillOptions) -> Filled:
    """Return an exported gradebook with the totals in one assignment's column, and what importing it changes.

    With `options.only` it has no other assignment. Raises InputError if the file is not a gradebook, if the column is
    ambiguous, and, unless any maximum is allowed, if its points possible are not those of the rubric.
    """
    table = read_table(data, options.shown)
    columns = _find_columns(table, options)
    grade, points = columns.grade, columns.points_possible
    possible = points.value(grade.index) if points is not None else ""
    if not options.any_maximum and points is not None:
        check_maximum(f"Canvas' Points Possible of {grade.header!r}", [possible], options.out_of)
    filling = Filling(table, grade.header, [_student(row, columns) for row in table.rows if _is_student(row)])

    def fill_row(row: TableRow, _: LmsGrade, total: Decimal) -> TableRow | str:
        no_grade = _NO_GRADE.get(row.value(grade.index).casefold())
        return no_grade or filling.with_points(row, grade.index, total, possible)

    def fill_excuse(row: TableRow) -> TableRow | str:
        if row.value(grade.index).casefold() == "n/a":
            return _NO_GRADE["n/a"]
        return filling.with_value(row, grade.index, _EXCUSE)

    kept = [*first_of_each(table.titles, _IDENTITY), grade.index] if options.only else None
    filled = filling.fill(grades, fill_row, fill_excuse=fill_excuse, kept=kept)
    preflight = filling.preflight
    preflight.unknown = [note for note in preflight.unknown if note.who.casefold() not in CANVAS_TEST_STUDENT]
    preflight.warnings += _warnings(table, columns, options)
    return filled


def _is_student(row: TableRow) -> bool:
    """Return whether a row is a student's: not blank, no points possible, no "Manual Posting" (of hidden grades)."""
    if row.number == 1 or "Points Possible" in row.value(0):
        return False
    return not all(_NOT_A_STUDENT.fullmatch(cell.value) for cell in row.cells)


def _student(row: TableRow, columns: _Columns) -> LmsStudent:
    value = row.value
    quoted = _QUOTED.fullmatch(value(columns.name))
    name = quoted[1] if quoted else value(columns.name)
    if columns.first_name is not None:
        name = f"{name}, {value(columns.first_name)}"
    student = Student("", name, login=value(columns.login), sis=value(columns.sis), canvas=value(columns.id))
    return LmsStudent(row.number, name, student)


def _warnings(table: Table, columns: _Columns, options: FillOptions) -> Iterator[str]:
    grade, points = columns.grade, columns.points_possible
    if points is None:
        yield "the file has no row Points Possible: the maximum in Canvas is unknown"
    elif read_lms_points(possible := points.value(grade.index)) != options.out_of:
        maximum = format_points(options.out_of)
        yield f"{grade.header!r} has {possible or 'no'} points possible in Canvas, but the rubric has {maximum}"
    if columns.titles.count("Section") > 1 and not options.only:
        yield "the file has more than one column Section: Canvas reads the first one's place"
    yield from assignment_warnings(columns.writable, grade, options)
    if table.delimiter == "\t" or table.encoding != "utf-8":
        yield "Canvas reads commas and semicolons in UTF-8, but this file has another format"


def _find_columns(table: Table, options: FillOptions) -> _Columns:
    """Return the columns of an exported gradebook.

    Raises InputError if it is not a gradebook, or if the column for the grade is ambiguous.
    """
    titles = table.titles
    first = {title: index for index, title in reversed(list(enumerate(titles)))}
    name = first.get("Student", first.get("LastName"))
    if name is None or "ID" not in first or "Section" not in first:
        found = ", ".join(map(repr, titles[:10])) or "nothing"
        raise InputError(
            f"{options.shown} is not a gradebook exported from Canvas: "
            f"its first row has no Student, ID and Section, but {found}"
        )
    points = next((row for row in table.rows[1:] if "Points Possible" in row.value(0)), None)
    writable = tuple(
        _grade_column(index, title)
        for index, title in enumerate(titles)
        if title not in _IDENTITY
        and not _COMPUTED.search(title)
        and not (points and _READ_ONLY.fullmatch(points.value(index)))
    )
    grade = find_assignment(writable, options, "Canvas", "Lab 6 (98765)")
    first_name = first.get("FirstName") if "Student" not in first else None
    sis, login = first.get("SIS User ID"), first.get("SIS Login ID")
    return _Columns(titles, name, first_name, first["ID"], sis, login, writable, grade, points)


def _grade_column(index: int, header: str) -> GradeColumn:
    found = _TITLE_AND_ID.fullmatch(header)
    return GradeColumn(index, header, found[1].strip(), found[2]) if found else GradeColumn(index, header)
