"""Read a grade file of an LMS: its columns, that of the lab, and the rows of its students."""

import re
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.lms.forms import Form
from grader.classroom.roster import Student
from grader.classroom.tables import Table, TableRow, read_table
from grader.errors import InputError
from grader.text import enumerated

_IDS = ("login", "sis", "email", "canvas", "moodle")
_WHO = ("name", "last", "first", *_IDS)
_READ_ONLY = re.compile(r"\(.+\)")  # "(read only)" as the points possible in Canvas, in the user's language
_PARTICIPANT = re.compile(r"[^\d\s]\D*\d+")
_ADDRESS = re.compile(r"[^@\s]+@[^@\s]+")
_NUMBER = re.compile(r"-?[0-9][0-9.,]*")
_MAX_LISTED, _MAX_USER_DATA = 20, 40  # columns


class FillOptions(NamedTuple):
    """How a file is filled: `names` are the lab's, the best first (title, id), `shown` is the file's in messages."""

    out_of: Decimal
    names: Sequence[str]
    column: str = ""
    comment_column: str = ""
    any_maximum: bool = False
    only: bool = False
    shown: str = "the file"


class StudentRow(NamedTuple):
    """A student's row: the name in messages, the data in it, and whether it is the LMS' own test student."""

    row: TableRow
    who: str
    student: Student
    is_test: bool


class GradeFile(NamedTuple):
    """A grade file: the columns by role, the place, header and maximum of the lab's, and the number of other ones."""

    table: Table
    roles: dict[str, int]
    grade: int
    header: str
    maximum: str
    others: int
    students: list[StudentRow]


def read_grade_file(data: bytes, form: Form, options: FillOptions) -> GradeFile:
    """Return a grade file; raises InputError if it is another file, or if the column of the lab is ambiguous."""
    table = read_table(data, options.shown)
    roles, has = _roles(table, form), _list(table.titles) or "nothing"
    for needed in form.needed:
        if not roles.keys() & set(needed.split(" | ")):
            what = " or ".join(form.columns[role].partition(" | ")[0] for role in needed.split(" | "))
            raise InputError(f"{options.shown} is not a grade file of {form.lms}, with {what}: its first row has {has}")
    if comment := options.comment_column.strip():
        if comment not in table.titles:
            raise InputError(f"{options.shown} has no column {comment!r}; its first row has {has}")
        roles["comment"] = table.titles.index(comment)
    points = next((row for row in table.rows[1:] if form.points_row and form.points_row in row.value(0)), None)
    columns = {at: found for at, title in enumerate(table.titles) if (found := form.grade.fullmatch(title))}
    if points is not None:
        columns = {at: found for at, found in columns.items() if not _READ_ONLY.fullmatch(points.value(at))}
    grade = _choose(columns, roles, form, options)
    maximum = columns[grade].groupdict().get("maximum") or (points.value(grade) if points else "")
    rows = [row for row in table.rows[1:] if row is not points and any(row.value(roles.get(role)) for role in _WHO)]
    if form.is_maximum_next:
        maximum = next(filter(None, (row.value(grade + 1) for row in rows)), "")
    others = 0 if form.is_maximum_next else len(columns) - 1
    students = [_student_row(row, roles, form) for row in rows]
    return GradeFile(table, roles, grade, table.titles[grade], maximum, others, students)


def read_points(text: str) -> Decimal | None:
    """Return the points in a cell, or None; the last comma or point is decimal (Canvas gradebook_importer.rb)."""
    text = re.sub(r"\s", "", text)
    if not _NUMBER.fullmatch(text):
        return None
    *whole, last = re.split("[.,]", text)
    return Decimal("".join(whole) + "." + (last or "0") if whole else last)


def _roles(table: Table, form: Form) -> dict[str, int]:
    """Return the first column of each role; in a worksheet, the user's data are recognised in any language."""
    role_of = {header: role for role, headers in form.columns.items() for header in headers.split(" | ")}
    titles = [*enumerate(table.titles)]
    roles = {role: index for index, title in reversed(titles) if (role := role_of.get(title.casefold()))}
    if form.is_maximum_next:
        first = roles.pop("moodle", 0)
        roles |= {"moodle": first} if _have(table, first, _PARTICIPANT) else {}
        addresses = [index for index, _ in titles[:_MAX_USER_DATA] if _have(table, index, _ADDRESS)]
        roles |= {"email": addresses[0]} if addresses else {}
        if first + 1 not in roles.values() and first + 2 != roles.get("maximum"):
            roles["name"] = first + 1
    return roles


def _have(table: Table, column: int, pattern: re.Pattern[str]) -> bool:
    """Return whether all values in a column match a pattern, and there is at least one."""
    values = [value for row in table.rows[1:] if (value := row.value(column))]
    return bool(values) and all(map(pattern.fullmatch, values))


def _student_row(row: TableRow, roles: dict[str, int], form: Form) -> StudentRow:
    value = {role: form.clean(row.value(roles.get(role))) for role in _WHO}
    name = value["name"] or ", ".join(filter(None, (value["last"], value["first"])))
    who = name or next(filter(None, (value[role] for role in _IDS)), "")
    number = re.split(r"\D", value["moodle"])[-1]
    student = Student("", name, value["email"], value["login"], value["sis"], value["canvas"], number)
    is_test = any(re.fullmatch(form.test_student, word.casefold()) for word in (name, student.login))
    return StudentRow(row, f"row {row.number}, {who}", student, is_test)


def _choose(columns: Mapping[int, re.Match[str]], roles: dict[str, int], form: Form, options: FillOptions) -> int:
    """Return the column that is named, else the one whose title is most like the title or the id of the lab."""
    wanted = options.column.strip()
    if wanted:
        parts = {at: found.groupdict() | {"maximum": ""} for at, found in columns.items()}
        ranks = {at: [wanted == found[0], wanted in parts[at].values()] for at, found in columns.items()}
    elif form.is_maximum_next:
        ranks = {at: [at + 1 == roles.get("maximum")] for at in columns}
    else:
        ranks = {at: _likeness(found["title"], options.names) for at, found in columns.items()}
    best = max(ranks.values(), default=[])
    found = [at for at, rank in ranks.items() if rank == best and any(rank)]
    if len(found) == 1:
        return found[0]
    listed = _list([columns[at][0] for at in found or columns])
    advice = f"choose one with --column: {listed}" if listed else f"create it in {form.lms}, and export again"
    what = repr(wanted) if wanted else f"for {' or '.join(map(repr, options.names))}"
    raise InputError(f"{options.shown} has {'several columns' if found else 'no column'} {what}; {advice}")


def _likeness(title: str, names: Sequence[str]) -> list[bool]:
    """Return whether a title is, or contains, each of some names, in this order; last, whether it is part of one."""
    words, known = _words(title), [_words(name) for name in names]
    tests = [test for name in known for test in ("".join(words) == "".join(name) != "", _contains(words, name))]
    return [*tests, any(_contains(name, words) for name in known)]


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W\d_]+|\d+", text.casefold())


def _contains(long: list[str], short: list[str]) -> bool:
    """Return whether words contain others side by side: Lab 6: wheeled base contains lab6, Lab 61 does not."""
    return bool(short) and any(long[at : at + len(short)] == short for at in range(len(long)))


def _list(headers: Sequence[str]) -> str:
    return enumerated([repr(header) for header in headers], _MAX_LISTED)
