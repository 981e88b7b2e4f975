"""Which column of a Canvas gradebook is which, after Canvas' own reader (lib/gradebook_importer.rb, lib/gradebook_exporter.rb).

Canvas does not translate these headers. A new export may have LastName and FirstName instead of Student.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from grader.classroom.lms.tables import Table, TableRow
from grader.errors import InputError

_IDENTITY = frozenset(
    {
        "Student",
        "LastName",
        "FirstName",
        "ID",
        "SIS User ID",
        "SIS Login ID",
        "Section",
        "Integration ID",
        "Root Account",
    }
)
_COMPUTED = re.compile(r"(Current|Final) (Score|Points|Grade)|Override (Score|Grade|Status)")
_READ_ONLY = re.compile(r"\(.+\)")  # "(read only)", in the language of whoever exported it
_TITLE_AND_ID = re.compile(r"(.*)\s\(([0-9]+)\)", re.DOTALL)
_NO_STUDENT = re.compile(r"\s*(muted|manual posting.*)?\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class CanvasColumns:
    """The columns by index, None where the export lacks them, and the row of the points possible, if there is one."""

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
    """Whether a row is a student's: no blank line, no points possible, no "Manual Posting" of assignments with hidden grades."""
    if row.number == 1 or "Points Possible" in row.value(0):
        return False
    return not all(_NO_STUDENT.fullmatch(cell.value) for cell in row.cells)


def find_columns(table: Table, column: str, wanted: tuple[str, ...], shown: str) -> CanvasColumns:
    """The columns of an exported gradebook; `column` is a title or the number in its parentheses, `wanted` are looser names.

    Raises InputError where it is no gradebook, or where it is not plain which column is meant.
    """
    titles = tuple(cell.value.strip() for cell in table.rows[0].cells) if table.rows else ()
    place = {title: index for index, title in reversed(list(enumerate(titles)))}
    name = place.get("Student", place.get("LastName"))
    if name is None or "ID" not in place or "Section" not in place:
        found = ", ".join(map(repr, titles[:10])) or "nothing"
        raise InputError(
            f"{shown} is not a gradebook exported from Canvas: no Student, ID and Section in its first row, but {found}"
        )
    points = next((row for row in table.rows[1:] if "Points Possible" in row.value(0)), None)
    open_ones = [
        index
        for index, title in enumerate(titles)
        if title not in _IDENTITY
        and not _COMPUTED.search(title)
        and not (points and _READ_ONLY.fullmatch(points.value(index)))
    ]
    grade = _named(titles, open_ones, column, shown) if column else _only(titles, open_ones, wanted, shown)
    others = sum(index != grade and _TITLE_AND_ID.fullmatch(titles[index]) is not None for index in open_ones)
    first = place.get("FirstName") if "Student" not in place else None
    return CanvasColumns(
        titles, name, first, place["ID"], place.get("SIS User ID"), place.get("SIS Login ID"), grade, others, points
    )


def _named(titles: Sequence[str], open_ones: Sequence[int], column: str, shown: str) -> int:
    """The column that somebody asks for, by its whole title, its number, or its title without the number."""
    wanted = column.strip()
    exact = [index for index in open_ones if titles[index] == wanted]
    by_part = [index for index in open_ones if wanted in _split(titles[index])]
    found = exact or by_part
    if len(found) != 1:
        which = "more than one column" if found else "no column that can be filled"
        raise InputError(f"{shown} has {which} {wanted!r}; there is: {_list(titles, found or open_ones)}")
    return found[0]


def _only(titles: Sequence[str], open_ones: Sequence[int], wanted: tuple[str, ...], shown: str) -> int:
    """The one assignment whose title is, or else has in it, or is in, a name of the rubric; else the only assignment."""
    assignments = [index for index in open_ones if _TITLE_AND_ID.fullmatch(titles[index])]
    names = [words for words in map(_words, wanted) if words]
    same = [index for index in assignments if any(_joined(titles[index]) == "".join(words) for words in names)]
    alike = [index for index in assignments if any(_alike(_words(_split(titles[index])[0]), words) for words in names)]
    for found in (same, alike, assignments):
        if len(found) == 1:
            return found[0]
        if found:
            break
    candidates = same or alike or assignments
    if not candidates:
        raise InputError(
            f"{shown} has no assignment's column, such as 'Lab 6 (98765)', but: {_list(titles, open_ones)};"
            " make the assignment in Canvas, and export again"
        )
    raise InputError(
        f"{shown} has several columns that may be meant, name one with --column: {_list(titles, candidates)}"
    )


def names_rubric(title: str, wanted: tuple[str, ...]) -> bool:
    """Whether an assignment's title speaks of the rubric."""
    return any(_alike(_words(_split(title)[0]), words) for words in map(_words, wanted) if words)


def _split(title: str) -> tuple[str, str]:
    found = _TITLE_AND_ID.fullmatch(title)
    return (found[1].strip(), found[2]) if found else (title, title)


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W\d_]+|\d+", text.casefold())


def _joined(title: str) -> str:
    return "".join(_words(_split(title)[0]))


def _alike(left: list[str], right: list[str]) -> bool:
    """Whether one has all words of the other, side by side: Lab 6 and lab6, Lab 6: wheeled base, not Lab 61."""
    short, long = sorted((left, right), key=len)
    return bool(short) and any(long[at : at + len(short)] == short for at in range(len(long) - len(short) + 1))


def _list(titles: Sequence[str], indices: Sequence[int]) -> str:
    more = f", and {len(indices) - 20} more" if len(indices) > 20 else ""
    return (", ".join(repr(titles[index]) for index in indices[:20]) or "none") + more
