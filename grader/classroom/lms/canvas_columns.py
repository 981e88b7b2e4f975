"""Detect the columns of a Canvas gradebook, as Canvas itself does (lib/gradebook_importer.rb, lib/gradebook_exporter.rb).

Canvas does not translate these headers. A new export may have LastName and FirstName instead of Student.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from grader.classroom.lms.tables import Table, TableRow
from grader.errors import InputError
from grader.text import enumerated

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


@dataclass(frozen=True, slots=True)
class CanvasColumns:
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


def is_student(row: TableRow) -> bool:
    """Return whether a row is a student's: not blank, not points possible, not "Manual Posting" of assignments with hidden grades."""
    if row.number == 1 or "Points Possible" in row.value(0):
        return False
    return not all(_NOT_A_STUDENT.fullmatch(cell.value) for cell in row.cells)


def find_columns(table: Table, column: str, rubric_names: tuple[str, ...], shown: str) -> CanvasColumns:
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
    return CanvasColumns(
        titles,
        name,
        first_name,
        first["ID"],
        first.get("SIS User ID"),
        first.get("SIS Login ID"),
        grade,
        others,
        points,
    )


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
    similar = [index for index in assignments if names_rubric(titles[index], rubric_names)]
    candidates = same or similar or assignments
    if len(candidates) == 1:
        return candidates[0]
    if not candidates:
        raise InputError(
            f"{shown} has no column of an assignment, such as 'Lab 6 (98765)', but: {_list(titles, writable)};"
            " create the assignment in Canvas, and export again"
        )
    raise InputError(f"{shown} has several possible columns, choose one with --column: {_list(titles, candidates)}")


def names_rubric(title: str, rubric_names: tuple[str, ...]) -> bool:
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
