"""Fill a gradebook that was exported from Canvas with the totals, for Grades > Import.

How Canvas imports it is in lib/gradebook_importer.rb: it finds the student by ID, SIS User ID, SIS Login ID, then name; a cell that
differs from the gradebook is a change, an empty one too; the row of points possible sets the assignment's points. So rows without a
new grade are removed, and the rest of the file stays as it was exported. The columns are detected as Canvas does: it does not
translate these headers; a new export may have LastName and FirstName instead of Student (lib/gradebook_exporter.rb).
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal

from grader.classroom.lms.filling import Filled, LmsStudent, Preflight, check_maximum, fill_rows, with_points
from grader.classroom.lms.grades import LmsGrade, read_points
from grader.classroom.lms.tables import Table, TableRow, read_table
from grader.classroom.students import Student
from grader.errors import InputError
from grader.text import enumerated, format_points

_IDENTITY = frozenset(
    {
        "Student", "LastName", "FirstName", "ID", "SIS User ID", "SIS Login ID", "Section", "Integration ID", "Root Account",
    }
)  # fmt: skip
_COMPUTED = re.compile(r"(Current|Final) (Score|Points|Grade)|Override (Score|Grade|Status)")
_READ_ONLY = re.compile(r"\(.+\)")  # "(read only)", in the user's language
_TITLE_AND_ID = re.compile(r"(.*)\s\(([0-9]+)\)", re.DOTALL)
_NOT_A_STUDENT = re.compile(r"\s*(muted|manual posting.*)?\s*", re.IGNORECASE)
_MAX_LISTED = 20
_QUOTED = re.compile(r'="(.*)"', re.DOTALL)  # gradebook_exporter.rb writes names that begin with = like this
_TEST_STUDENT = frozenset({"student, test", "test student"})
_NO_GRADE = {"ex": "is excused in Canvas", "n/a": "is not assigned this assignment in Canvas"}


@dataclass(frozen=True, slots=True)
class _Columns:
    """The columns by index, None where the export lacks them, and the row of the points possible, if there is one.

    `others` is the number of other assignments.
    """

    titles: tuple[str, ...]
    name: int
    first_name: int | None
    id: int
    sis: int | None
    login: int | None
    grade: int
    others: int
    points_possible: TableRow | None

    @property
    def title(self) -> str:
        """The header of the column that is filled."""
        return self.titles[self.grade]


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
    columns = _find_columns(table, column, rubric_names, shown)
    possible = columns.points_possible.value(columns.grade) if columns.points_possible is not None else ""
    if not any_maximum and columns.points_possible is not None:
        check_maximum(f"Canvas' Points Possible of {columns.title!r}", [possible], out_of)
    preflight = Preflight(columns.title)

    def fill_row(row: TableRow, _: LmsGrade, total: Decimal, who: str) -> TableRow | str:
        no_grade = _NO_GRADE.get(row.value(columns.grade).casefold())
        return no_grade or with_points(table, row, columns.grade, total, who, preflight, possible)

    students = [_student(row, columns) for row in table.rows if _is_student(row)]
    filled = fill_rows(table, students, grades, preflight, fill_row)
    preflight.unknown = [note for note in preflight.unknown if note.who.casefold() not in _TEST_STUDENT]
    preflight.warnings += _warnings(table, columns, out_of, rubric_names if not column else ())
    return filled


def _is_student(row: TableRow) -> bool:
    """Return whether a row is a student's: not blank, not points possible, not "Manual Posting" of assignments with hidden grades."""
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


def _warnings(table: Table, columns: _Columns, out_of: Decimal, rubric_names: tuple[str, ...]) -> Iterator[str]:
    title = repr(columns.title)
    if columns.points_possible is None:
        yield "the file has no row Points Possible: the maximum in Canvas is unknown"
    elif read_points(possible := columns.points_possible.value(columns.grade)) != out_of:
        yield f"{title} has {possible or 'no'} points possible in Canvas, and {format_points(out_of)} here"
    if rubric_names and not _names_rubric(columns.title, rubric_names):
        yield f"{title} is the only assignment in the file, but its title does not contain {rubric_names[-1]!r}"
    if columns.titles.count("Section") > 1:
        yield "the file has more than one column Section: Canvas reads the first one's place"
    if columns.others:
        yield f"the file has {columns.others} more assignments: importing it resets them to their values at the time of the export"
    if table.delimiter == "\t" or table.encoding != "utf-8":
        yield "Canvas reads commas and semicolons in UTF-8, but this file has another format"


def _find_columns(table: Table, column: str, rubric_names: tuple[str, ...], shown: str) -> _Columns:
    """Return the columns of an exported gradebook; `column` is a title or the number in its parentheses.

    Raises InputError if it is not a gradebook, or if the column for the grade is ambiguous.
    """
    titles = table.titles
    first = {title: index for index, title in reversed(list(enumerate(titles)))}
    name = first.get("Student", first.get("LastName"))
    if name is None or "ID" not in first or "Section" not in first:
        found = ", ".join(map(repr, titles[:10])) or "nothing"
        raise InputError(
            f"{shown} is not a gradebook exported from Canvas: its first row has no Student, ID and Section, but {found}"
        )
    points = next((row for row in table.rows[1:] if "Points Possible" in row.value(0)), None)
    writable = [
        index
        for index, title in enumerate(titles)
        if title not in _IDENTITY
        and not _COMPUTED.search(title)
        and not (points and _READ_ONLY.fullmatch(points.value(index)))
    ]
    grade = _named(titles, writable, column, shown) if column else _detected(titles, writable, rubric_names, shown)
    others = sum(index != grade and _TITLE_AND_ID.fullmatch(titles[index]) is not None for index in writable)
    first_name = first.get("FirstName") if "Student" not in first else None
    sis, login = first.get("SIS User ID"), first.get("SIS Login ID")
    return _Columns(titles, name, first_name, first["ID"], sis, login, grade, others, points)


def _named(titles: Sequence[str], writable: Sequence[int], column: str, shown: str) -> int:
    """Return the column with this title, number, or title without the number."""
    column = column.strip()
    exact = [index for index in writable if titles[index] == column]
    found = exact or [index for index in writable if column in _split(titles[index])]
    if len(found) != 1:
        which = "more than one column" if found else "no writable column"
        raise InputError(f"{shown} has {which} {column!r}; the columns are: {_list(titles, found or writable)}")
    return found[0]


def _detected(titles: Sequence[str], writable: Sequence[int], rubric_names: tuple[str, ...], shown: str) -> int:
    """Return the one assignment whose title is a name of the rubric, else contains or is part of one, else the only assignment."""
    assignments = [index for index in writable if _TITLE_AND_ID.fullmatch(titles[index])]
    joined = {"".join(_words(name)) for name in rubric_names} - {""}
    same = [index for index in assignments if "".join(_words(_split(titles[index])[0])) in joined]
    similar = [index for index in assignments if _names_rubric(titles[index], rubric_names)]
    candidates = same or similar or assignments
    if len(candidates) == 1:
        return candidates[0]
    if not candidates:
        raise InputError(
            f"{shown} has no column of an assignment, such as 'Lab 6 (98765)', but: {_list(titles, writable)};"
            " create the assignment in Canvas, and export again"
        )
    raise InputError(f"{shown} has several possible columns, choose one with --column: {_list(titles, candidates)}")


def _names_rubric(title: str, rubric_names: tuple[str, ...]) -> bool:
    """Return whether an assignment's title contains a name of the rubric, or is part of one."""
    words = _words(_split(title)[0])
    return any(_is_similar(words, _words(name)) for name in rubric_names)


def _split(title: str) -> tuple[str, str]:
    found = _TITLE_AND_ID.fullmatch(title)
    return (found[1].strip(), found[2]) if found else (title, title)


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W\d_]+|\d+", text.casefold())


def _is_similar(left: list[str], right: list[str]) -> bool:
    """Return whether one has all words of the other, side by side: Lab 6 and lab6, Lab 6: wheeled base, not Lab 61."""
    short, long = sorted((left, right), key=len)
    return bool(short) and any(long[at : at + len(short)] == short for at in range(len(long) - len(short) + 1))


def _list(titles: Sequence[str], indices: Sequence[int]) -> str:
    return enumerated([repr(titles[index]) for index in indices], _MAX_LISTED) or "none"
