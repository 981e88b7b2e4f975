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
_NUMBER = re.compile(r"-?[0-9][0-9.,]*")
_MAX_LISTED = 20  # columns


class FillOptions(NamedTuple):
    """How a file is filled: `names` are the lab's, the best first (title, id), `shown` is the file's in messages."""

    out_of: Decimal
    names: Sequence[str]
    column: str = ""
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
    """A grade file: the columns by role (`grade` is that of the lab), and the maximum of the lab, as it is written."""

    table: Table
    roles: dict[str, int]
    maximum: str
    students: dict[int, StudentRow]  # by the number of the row


def read_grade_file(data: bytes, form: Form, options: FillOptions) -> GradeFile:
    """Return a grade file; raises InputError if it is another file, or if the column of the lab is ambiguous."""
    table = read_table(data, options.shown)
    role_of = {header: role for role, headers in form.columns.items() for header in headers.split(" | ")}
    titles = [*enumerate(table.titles)]
    roles = {role: at for at, title in reversed(titles) if (role := role_of.get(title.casefold()))}
    for needed in form.needed:
        if roles.keys().isdisjoint(needed.split(" | ")):
            what = " or ".join(form.columns[role].partition(" | ")[0] for role in needed.split(" | "))
            has = _list(table.titles) or "nothing"
            raise InputError(f"{options.shown} is not a grade file of {form.lms}, with {what}: its first row has {has}")
    points = next((row for row in table.rows[1:] if form.points_row and form.points_row in row.value(0)), None)
    columns = {at: found for at, title in titles if (found := form.grade.fullmatch(title))}
    if "maximum" in roles:
        columns = {at: found for at, found in columns.items() if at + 1 == roles["maximum"]}
    if points is not None:
        columns = {at: found for at, found in columns.items() if not _READ_ONLY.fullmatch(points.value(at))}
    grade = roles["grade"] = _choose(columns, form, options)
    rows = [row for row in table.rows[1:] if row is not points and any(row.value(roles.get(role)) for role in _WHO)]
    maximum = columns[grade].groupdict().get("maximum") or (points.value(grade) if points else "")
    maximum = maximum or next(filter(None, (row.value(roles.get("maximum")) for row in rows)), "")
    return GradeFile(table, roles, maximum, {row.number: _student_row(row, roles, form) for row in rows})


def read_points(text: str) -> Decimal | None:
    """Return the points in a cell, or None; the last comma or point is decimal (Canvas gradebook_importer.rb)."""
    text = re.sub(r"\s", "", text)
    if not _NUMBER.fullmatch(text):
        return None
    *whole, last = re.split("[.,]", text)
    return Decimal("".join(whole) + "." + (last or "0") if whole else last)


def _student_row(row: TableRow, roles: dict[str, int], form: Form) -> StudentRow:
    value = {role: form.clean(row.value(roles.get(role))) for role in _WHO}
    name = value["name"] or ", ".join(filter(None, (value["last"], value["first"])))
    who = name or next(filter(None, (value[role] for role in _IDS)), "")
    number = re.split(r"\D", value["moodle"])[-1]  # of Participant 123, in any language
    student = Student("", name, value["email"], value["login"], value["sis"], value["canvas"], number)
    is_test = any(re.fullmatch(form.test_student, word.casefold()) for word in (name, student.login))
    return StudentRow(row, f"row {row.number}, {who}", student, is_test)


def _choose(columns: Mapping[int, re.Match[str]], form: Form, options: FillOptions) -> int:
    """Return the column that is named, else the one whose title is most like the title or the id of the lab."""
    wanted = options.column.strip()
    if wanted:
        parts = {at: found.groupdict() | {"maximum": ""} for at, found in columns.items()}
        ranks = {at: [wanted == found[0], wanted in parts[at].values()] for at, found in columns.items()}
    elif "maximum" in form.columns:
        ranks = {at: [True] for at in columns}
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
