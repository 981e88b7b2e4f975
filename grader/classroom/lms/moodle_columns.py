"""Detect the columns of a Moodle grading worksheet, in any language.

The order of the columns is fixed (mod/assign/gradingtable.php): Identifier, then, unless the marking is blind, Full
name and other data of a user; Status, group, marker; Grade, and directly after it Maximum grade, or Scale. So the
Identifier is detected by its shape, a word and a number, and the Grade by the column after it.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from grader.classroom.lms.grades import read_lms_points
from grader.classroom.tables import Table, TableRow
from grader.errors import InputError

# Headers in lower case, as the language packs have them (assign.php, assignfeedback_comments.php): English, German,
# French, Spanish, Italian, Portuguese, Brazilian and Dutch, as far as they were looked up. The other columns are
# detected by place and values, so that a language that is not here mostly works as well.
_HEADERS = {
    "identifier": "identifier | id | identifiant | identificador | identificativo | identificatie",
    "maximum": (
        "maximum grade | bestwertung | note maximale | calificación máxima | valutazione massima | nota máxima"
        " | maximaal cijfer"
    ),
    "changeable": (
        "grade can be changed | bewertung kann geändert werden | la note peut être modifiée"
        " | la calificación puede ser cambiada | la calificación puede cambiarse"
        " | la valutazione può essere cambiata | a nota pode ser alterada. | nota pode ser alterada"
    ),
    "feedback": (
        "feedback comments | feedback als kommentar | feedback par commentaires"
        " | comentarios de retroalimentación | commenti | comentários de feedback | feedback"
    ),
    "modified": (
        "last modified (grade) | zuletzt geändert (bewertung) | dernière modification (note)"
        " | última modificación (calificación) | ultima modifica (valutazione) | última atualização (avaliação)"
        " | última modificação (nota) | laatst gewijzigd (beoordeling)"
    ),
    "grade": "grade",
    "scale": "scale",
    "status": "status | statut | stato | estado",
    "numbers": "id number | id-nummer | username",
}
_KIND_OF = {header: kind for kind, headers in _HEADERS.items() for header in headers.split(" | ")}
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

    Raises InputError if it is not a worksheet, if a column cannot be detected, and if the assignment is graded by a
    scale.
    """
    titles = table.titles
    kinds = [_KIND_OF.get(title.casefold(), "") for title in titles]
    rows = student_rows(table)
    identifier = _identifier(kinds, rows)
    if identifier is None:
        reason = "its first column does not have 'Participant 123' in every row"
        raise InputError(f"{shown} is not a grading worksheet of Moodle: {reason}; {_list(titles)}")
    grade = _column_by_name(titles, column, shown) if column else _grade(kinds, rows, identifier)
    if grade is None:
        raise InputError(f"cannot detect the column of {shown} with the grades, name it with --column; {_list(titles)}")
    maximum = grade + 1
    maxima = [read_lms_points(row.value(maximum)) or 0 for row in rows if len(row.cells) == len(titles)]
    if not rows or maximum == len(titles) or any(value <= 0 for value in maxima):
        reason = "an assignment that is graded by a scale takes no points"
        raise InputError(f"{shown} has no number as the maximum grade after {titles[grade]!r}: {reason}")
    between = range(identifier + 1, grade)
    email = next((index for index in between if _all(rows, index, _ADDRESS)), None)
    name = next((index for index in between[:1] if index != email and kinds[index] != "status"), None)
    return MoodleColumns(
        identifier=identifier,
        name=name,
        email=email,
        numbers=tuple(index for index in between if kinds[index] == "numbers"),
        grade=grade,
        maximum=maximum,
        changeable=_first(kinds, "changeable", grade),
        feedback=_column_by_name(titles, feedback_column, shown)
        if feedback_column
        else _first(kinds, "feedback", maximum),
        has_modified="modified" in kinds[maximum + 1 :],
    )


def _identifier(kinds: list[str], rows: Sequence[TableRow]) -> int | None:
    """Return the first column, or one with that header, if every row has 'Participant 123' in it."""
    first = (index for index, kind in enumerate(kinds) if index == 0 or kind == "identifier")
    return next((index for index in first if _all(rows, index, _IDENTIFIER)), None)


def _grade(kinds: list[str], rows: Sequence[TableRow], identifier: int) -> int | None:
    """Return the column before the maximum grade: by the maximum's header, by English headers, else by the values."""
    behind = range(identifier + 2, len(kinds))
    for index in behind:
        if kinds[index] == "maximum" or kinds[index - 1 : index + 1] == ["grade", "scale"]:
            return index - 1
    if kinds.count("grade") == 1:
        return kinds.index("grade")
    shaped = [index - 1 for index in behind if _is_grade_and_maximum(rows, index)]
    return shaped[0] if len(shaped) == 1 else None


def _is_grade_and_maximum(rows: Sequence[TableRow], index: int) -> bool:
    """Return whether a column has the same number everywhere, and the column before it nothing, or numbers up to it."""
    limits = {read_lms_points(row.value(index)) for row in rows}
    limit = limits.pop() if len(limits) == 1 else None
    if not limit or limit < 0:
        return False
    grades = [row.value(index - 1) for row in rows]
    return all(not grade or ((points := read_lms_points(grade)) is not None and points <= limit) for grade in grades)


def _all(rows: Sequence[TableRow], index: int, pattern: re.Pattern[str]) -> bool:
    """Return whether all values in a column match a pattern, and there is at least one."""
    values = [value for row in rows if (value := row.value(index))]
    return bool(values) and all(pattern.fullmatch(value) for value in values)


def _first(kinds: list[str], kind: str, behind: int) -> int | None:
    return kinds.index(kind, behind + 1) if kind in kinds[behind + 1 :] else None


def _column_by_name(titles: tuple[str, ...], column: str, shown: str) -> int:
    found = [index for index, title in enumerate(titles) if title == column.strip()]
    if len(found) != 1:
        raise InputError(f"{shown} has {'more than one' if found else 'no'} column {column.strip()!r}; {_list(titles)}")
    return found[0]


def _list(titles: Sequence[str]) -> str:
    return "its first row has: " + (", ".join(map(repr, titles[:30])) or "nothing")
