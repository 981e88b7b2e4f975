"""Read a roster from a CSV file: an instructor's own, a gradebook from Canvas, or a grading worksheet from Moodle."""

import re
from collections.abc import Iterable, Iterator
from operator import attrgetter, itemgetter
from pathlib import Path

from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.intake.roster_values import RowReader
from grader.classroom.matching import plain_word
from grader.classroom.students import CANVAS_TEST_STUDENT
from grader.classroom.tables import SIZE_LIMIT, rows_with_lines
from grader.errors import InputError
from grader.files.reading import read_capped
from grader.names import folded
from grader.text import counted, first_lines, printable_path

_ALIASES = {
    "id": "id userid key",
    "sis": (
        "sis sisid sisuserid studentid studentnumber studentno idnumber idnummer númerodeid"
        " matriculationnumber matrikelnummer"
    ),
    "login": "login loginid username user sisloginid netid account",
    "github": "github githubusername githublogin githubuser githubid githubaccount",
    "name": (
        "name fullname student studentname sortablename"
        " vollständigername nomcomplet nombrecompleto nomecompleto volledigenaam"
    ),
    "first": "first firstname firstnames givenname givennames forename vorname nombre",
    "last": "last lastname surname familyname nachname apellidos",
    "email": "email emailaddress mail sisemail emailadresse direccióndecorreo correoelectrónico",
    "canvas": "canvas canvasid canvasuserid",
    "moodle": "moodle moodleid participantid participant",
    "identifier": "identifier identifiant identificador identificativo identificatie",
    "group": "group groupname team teamname gruppe",
    "section": "section class tutorial",
    "marker": "marker gradedby assignedgrader teachingassistant ta",
    "due": "due duedate dueat deadline dueuntil extendeduntil extensionuntil",
    "extension": "extension extensiondays extradays",
    "submitted": "submitted submittedat submissiontime",
    "late": "late islate dayslate latedays",
    "status": "status statut stato estado",
}
_FIELD_OF = {alias: field for field, aliases in _ALIASES.items() for alias in aliases.split()}
_WHO = frozenset({"id", "sis", "login", "github", "email", "name", "last", "canvas", "moodle", "identifier"})
_ASSIGNMENT = re.compile(r".+ \((\d+)\)", re.DOTALL)  # Canvas' column of an assignment: Lab 6 (98765)
_MAX_MISTAKES = 20
_UNIQUE = {
    "key": "id",
    "canvas": "canvas id",
    "moodle": "moodle id",
    "sis": "sis id",
    "login": "login",
    "email": "email address",
}


def read_roster(path: Path) -> Roster:
    """Return the roster in a CSV file in UTF-8, UTF-16 with a byte order mark, or cp1252.

    Columns can be in any order, separated by commas, semicolons or tabs; unknown columns are ignored. A student's key
    is the id, else the university's id, login, address, name, or LMS id. Raises InputError with a line for each mistake
    in the file.
    """
    shown = printable_path(path)
    rows = rows_with_lines(read_capped(path, SIZE_LIMIT, advice=""), shown)
    _, header = next(rows, (1, []))
    fields = _fields(header, shown) if header else []
    mistakes: list[tuple[int, str]] = []
    read = list(_by_field(rows, fields, mistakes))
    has_columns = {"student", "id"} <= set(map(folded, header)) and not {"sis", "login"}.isdisjoint(fields)
    is_from_canvas = has_columns and any(row["id"].isdecimal() for _, row in read)
    if is_from_canvas:  # Canvas has rows of points and comments above the students, and a row of its test student
        read = [(line, row) for line, row in read if row["id"] and row["name"].casefold() not in CANVAS_TEST_STUDENT]
    reader = RowReader(is_from_canvas=is_from_canvas)
    entries: list[RosterEntry] = []
    lines: list[int] = []
    for line, row in read:
        entry, wrong = reader.entry(line, row)
        mistakes += ((line, text) for text in wrong)
        if entry is not None:
            entries.append(entry)
            lines.append(line)
    complaints = [f"line {line} of {shown} {text}" for line, text in sorted(mistakes, key=itemgetter(0))]
    complaints += _duplicates(zip(lines, entries, strict=True), shown)
    if complaints:
        raise InputError("\n".join(first_lines(complaints, _MAX_MISTAKES)))
    if not entries:
        raise InputError(f"{shown} has no students")
    ids = (found[1] for cell in header if is_from_canvas and (found := _ASSIGNMENT.fullmatch(cell)))
    return Roster(entries, tuple(_notes(reader, shown)), map("Canvas {}".format, ids))


def _by_field(
    rows: Iterator[tuple[int, list[str]]], fields: list[str], mistakes: list[tuple[int, str]]
) -> Iterator[tuple[int, dict[str, str]]]:
    """Yield the line of each row, and its first cell of each field that is not empty."""
    for line, cells in rows:
        if len(cells) < len(fields) or any(cells[len(fields) :]):
            mistakes.append((line, f"has {counted(len(cells), 'cell')}, but the first line has {len(fields)}"))
            continue
        filled = {field: cell for field, cell in reversed(list(zip(fields, cells, strict=False))) if cell}
        yield line, dict.fromkeys(_ALIASES, "") | filled


def _duplicates(entries: Iterable[tuple[int, RosterEntry]], shown: str) -> list[str]:
    """Return a message for each student with an id or address that another student has."""
    entries, found = tuple(entries), dict[int, str]()
    for field, title in _UNIQUE.items():
        value_of, first = attrgetter(field), dict[str, int]()
        for line, entry in entries:
            if value := value_of(entry.student):
                same = value if field == "key" else plain_word(value)
                if first.setdefault(same, line) != line:
                    message = f"{shown} has the {title} {value} twice, in lines {first[same]} and {line}"
                    found.setdefault(line, message)
    return [found[line] for line in sorted(found)]


def _notes(reader: RowReader, shown: str) -> Iterator[str]:
    if reader.unread:
        line, status = reader.unread[0]
        count = f" ({len(reader.unread)} lines)" if len(reader.unread) > 1 else ""
        yield (
            f"line {line} of {shown}: the status {status!r} does not say clearly how late the submission is{count}: "
            "add a column `late` with `no` or a number of days"
        )


def _fields(header: list[str], shown: str) -> list[str]:
    """Return the field of each column, empty for an unknown column."""
    fields = [_FIELD_OF.get(folded(cell), "") for cell in header]
    if _WHO.isdisjoint(fields):
        named = ", ".join(cell for cell in header if cell)[:200]
        raise InputError(f"{shown} has no column for an id, login, name or email in its first line, only: {named}")
    return fields
