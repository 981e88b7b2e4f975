"""Read the rows of a roster: from the bytes of a CSV file to cells by field."""

import csv
import io
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from grader.errors import InputError

_ALIASES = {
    "id": "id userid key",
    "sis": "sis sisid sisuserid studentid studentnumber studentno idnumber matriculationnumber matrikelnummer",
    "login": "login loginid username user sisloginid netid account",
    "github": "github githubusername githublogin githubuser githubid githubaccount",
    "name": "name fullname student studentname sortablename vollständigername",
    "first": "first firstname firstnames givenname givennames forename vorname",
    "last": "last lastname surname familyname nachname",
    "email": "email emailaddress mail sisemail emailadresse",
    "canvas": "canvas canvasid canvasuserid",
    "moodle": "moodle moodleid participantid participant identifier",
    "group": "group groupname team teamname gruppe",
    "section": "section class tutorial",
    "due": "due duedate dueat deadline dueuntil extendeduntil extensionuntil",
    "extension": "extension extensiondays extradays",
    "submitted": "submitted submittedat submissiontime",
    "late": "late islate dayslate latedays",
}
_FIELD_OF = {alias: field for field, aliases in _ALIASES.items() for alias in aliases.split()}
_WHO = ("id", "sis", "login", "github", "email", "name", "canvas", "moodle")
_ASSIGNMENT = re.compile(r".+ \((\d+)\)", re.DOTALL)  # Canvas' column of an assignment: Lab 6 (98765)
_AS_TEXT = re.compile(r'="(.*)"', re.DOTALL)  # keeps a spreadsheet from reading a text as a number


@dataclass(frozen=True, slots=True)
class RosterRow:
    """A student's row: the line where it begins, and its cells by field."""

    line: int
    cells: Mapping[str, str]

    def __getitem__(self, field: str) -> str:
        return self.cells.get(field, "")


def text_of(data: bytes, shown: str) -> str:
    """Return the text of a CSV file in UTF-8, in UTF-16 with a byte order mark, or in cp1252; raises InputError."""
    encodings = ("utf-16",) if data.startswith((b"\xff\xfe", b"\xfe\xff")) else ("utf-8-sig", "cp1252")
    for encoding in encodings:
        try:
            text = data.decode(encoding)
        except UnicodeError:
            continue
        if "\0" not in text:
            return text
    raise InputError(f"{shown} is not a text file: save it as CSV in UTF-8")


def rows_of(text: str, shown: str) -> Iterator[RosterRow]:
    """Yield the rows of students."""
    fields: list[str] | None = None
    of_canvas = False
    width = 0
    for line, cells in _cells(text, shown):
        if not any(cells):
            continue
        if fields is None:
            fields, width = _header(cells, shown), len(cells)
            of_canvas = _is_canvas_header(cells)
            continue
        if len(cells) < width or any(cells[width:]):
            count = len(cells)
            raise InputError(f"line {line} of {shown} has {count} cells where the first line has {width}")
        row = RosterRow(line, _by_field(fields, cells))
        if of_canvas:
            if not row["id"]:  # Canvas has rows of points and comments above the students
                continue
            row = RosterRow(line, {**row.cells, "canvas": row["canvas"] or row["id"]})
        yield row


def canvas_assignments(text: str, shown: str) -> frozenset[str]:
    """Return the assignments with columns in a gradebook that was exported from Canvas; none for any other roster."""
    header = next((cells for _, cells in _cells(text, shown) if any(cells)), [])
    if not _is_canvas_header(header):
        return frozenset()
    return frozenset(f"Canvas {found[1]}" for cell in header if (found := _ASSIGNMENT.fullmatch(cell)))


def _is_canvas_header(cells: list[str]) -> bool:
    plain = {_plain(cell) for cell in cells}
    return {"student", "id"} <= plain and not {"sis", "login"}.isdisjoint(_FIELD_OF.get(cell, "") for cell in plain)


def _cells(text: str, shown: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the line where each row begins, and its cells with spaces normalised."""
    text = text.removeprefix("sep=;\r\n").removeprefix("sep=;\n").removeprefix("sep=,\r\n").removeprefix("sep=,\n")
    header = next((line for line in text.splitlines() if line.strip(' ,;\t"')), "")
    unquoted = re.sub(r'"[^"]*"', "", header)
    delimiter = max(",;\t", key=unquoted.count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    line = 1
    try:
        for cells in reader:
            yield line, [_clean(cell) for cell in cells]
            line = reader.line_num + 1
    except csv.Error as error:
        raise InputError(f"line {line} of {shown} cannot be read as CSV: {error}") from None


def _clean(cell: str) -> str:
    cell = cell.strip()
    found = _AS_TEXT.fullmatch(cell)
    return " ".join((found[1] if found else cell).split())


def _header(cells: list[str], shown: str) -> list[str]:
    """Return the field of each column, empty for an unknown column."""
    fields = [_FIELD_OF.get(_plain(cell), "") for cell in cells]
    if not any(field in (*_WHO, "last") for field in fields):
        named = ", ".join(cell for cell in cells if cell)[:200]
        raise InputError(f"{shown} has no column for an id, login, name or email in its first line, only: {named}")
    return fields


def _plain(header: str) -> str:
    return "".join(letter for letter in header.casefold() if letter.isalnum())


def _by_field(fields: list[str], cells: list[str]) -> dict[str, str]:
    """Return the first cell that is not empty for each field."""
    found: dict[str, str] = {}
    for field, cell in zip(fields, cells, strict=False):
        if field and cell:
            found.setdefault(field, cell)
    return found
