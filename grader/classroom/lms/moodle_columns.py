"""Detect the columns of a Moodle grading worksheet, in any language.

The order of the columns is fixed (mod/assign/gradingtable.php): Identifier, then, unless the marking is blind, Full name and
other data of a user; Status, group, marker; Grade, and directly after it Maximum grade, or Scale. So the Identifier is detected by
its shape, a word and a number, and the Grade by the column after it.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from grader.classroom.lms.grades import read_points
from grader.classroom.lms.moodle_headers import CHANGEABLE, FEEDBACK, IDENTIFIER, MAXIMUM, MODIFIED, NUMBERS, STATUS
from grader.classroom.lms.tables import Table, TableRow
from grader.errors import InputError

_IDENTIFIER = re.compile(r"[^\d\s][^\d]*\d+")
_ADDRESS = re.compile(r"[^@\s]+@[^@\s]+")


@dataclass(frozen=True, slots=True)
class MoodleColumns:
    """The columns by index, None where there are none. `numbers` contain ID numbers and user names."""

    identifier: int
    name: int | None
    email: int | None
    numbers: tuple[int, ...]
    grade: int
    maximum: int
    changeable: int | None
    feedback: int | None
    has_modified: bool


def student_rows(table: Table) -> list[TableRow]:
    """Return the rows below the header that are not empty."""
    return [row for row in table.rows[1:] if any(cell.value.strip() for cell in row.cells)]


def find_columns(table: Table, column: str, feedback_column: str, shown: str) -> MoodleColumns:
    """Return the columns of a grading worksheet; `column` and `feedback_column` are headers that the user names.

    Raises InputError if it is not a worksheet, if a column cannot be detected, and if the assignment is graded by a scale.
    """
    titles = table.titles
    headers = [title.casefold() for title in titles]
    rows = student_rows(table)
    first = [index for index, header in enumerate(headers) if index == 0 or header in IDENTIFIER]
    identifier = next((index for index in first if _all(rows, index, _IDENTIFIER)), None)
    if identifier is None:
        raise InputError(
            f"{shown} is not a grading worksheet of Moodle: its first column does not have 'Participant 123' in every row; {_list(titles)}"
        )
    grade = _named(titles, column, shown) if column else _grade(headers, rows, identifier)
    if grade is None:
        raise InputError(f"cannot detect the column of {shown} with the grades, name it with --column; {_list(titles)}")
    maximum = grade + 1
    if not rows or any(not _is_maximum(row.value(maximum)) for row in rows if len(row.cells) == len(titles)):
        raise InputError(
            f"{shown} has no number as the maximum grade after {titles[grade]!r}: an assignment that is graded by a scale takes no points"
        )
    between = range(identifier + 1, grade)
    email = next((index for index in between if _all(rows, index, _ADDRESS)), None)
    name = next((index for index in between[:1] if index != email and headers[index] not in STATUS), None)
    return MoodleColumns(
        identifier=identifier,
        name=name,
        email=email,
        numbers=tuple(index for index in between if headers[index] in NUMBERS),
        grade=grade,
        maximum=maximum,
        changeable=_first(headers, CHANGEABLE, grade),
        feedback=_named(titles, feedback_column, shown) if feedback_column else _first(headers, FEEDBACK, maximum),
        has_modified=_first(headers, MODIFIED, maximum) is not None,
    )


def _grade(headers: Sequence[str], rows: Sequence[TableRow], identifier: int) -> int | None:
    """Return the column before the maximum grade: by the maximum's header, by English headers, else by the values."""
    for index in range(identifier + 2, len(headers)):
        if headers[index] in MAXIMUM or (headers[index - 1], headers[index]) == ("grade", "scale"):
            return index - 1
    if headers.count("grade") == 1:
        return headers.index("grade")
    shaped = [index - 1 for index in range(identifier + 2, len(headers)) if _is_grade_and_maximum(rows, index)]
    return shaped[0] if len(shaped) == 1 else None


def _is_grade_and_maximum(rows: Sequence[TableRow], index: int) -> bool:
    """Return whether a column has the same number everywhere, and the column before it nothing, or numbers up to it."""
    limits = {read_points(row.value(index)) for row in rows}
    limit = limits.pop() if len(limits) == 1 else None
    if not limit or limit < 0:
        return False
    grades = [row.value(index - 1) for row in rows]
    return all(not grade or ((points := read_points(grade)) is not None and points <= limit) for grade in grades)


def _is_maximum(text: str) -> bool:
    points = read_points(text)
    return points is not None and points > 0


def _all(rows: Sequence[TableRow], index: int, pattern: re.Pattern[str]) -> bool:
    """Return whether all values in a column match a pattern, and there is at least one."""
    values = [value for row in rows if (value := row.value(index))]
    return bool(values) and all(pattern.fullmatch(value) for value in values)


def _first(headers: Sequence[str], known: frozenset[str], behind: int) -> int | None:
    return next((index for index in range(behind + 1, len(headers)) if headers[index] in known), None)


def _named(titles: tuple[str, ...], column: str, shown: str) -> int:
    found = [index for index, title in enumerate(titles) if title == column.strip()]
    if len(found) != 1:
        raise InputError(f"{shown} has {'more than one' if found else 'no'} column {column.strip()!r}; {_list(titles)}")
    return found[0]


def _list(titles: Sequence[str]) -> str:
    return "its first row has: " + (", ".join(map(repr, titles[:30])) or "nothing")
