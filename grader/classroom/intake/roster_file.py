"""Read a roster from a CSV file: an instructor's own, a gradebook from Canvas, or a grading worksheet from Moodle."""

import csv
import io
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from grader.classroom.intake.names import iso_time
from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.students import Student
from grader.errors import InputError
from grader.files.reading import read_capped
from grader.text import printable_path

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
    "marker": "marker gradedby assignedgrader teachingassistant ta",
    "due": "due duedate dueat deadline dueuntil extendeduntil extensionuntil",
    "extension": "extension extensiondays extradays",
    "submitted": "submitted submittedat submissiontime",
    "late": "late islate dayslate latedays",
}
_FIELD_OF = {alias: field for field, aliases in _ALIASES.items() for alias in aliases.split()}
_WHO = frozenset({"id", "sis", "login", "github", "email", "name", "last", "canvas", "moodle"})
_ASSIGNMENT = re.compile(r".+ \((\d+)\)", re.DOTALL)  # Canvas' column of an assignment: Lab 6 (98765)
_AS_TEXT = re.compile(r'\A="(.*)"\Z', re.DOTALL)  # keeps a spreadsheet from reading a text as a number
_LIMIT = 16 * 1024 * 1024  # bytes
_YES = frozenset({"yes", "y", "true", "late", "x", "ja"})
_NO = frozenset({"no", "n", "false", "on time", "-", "nein"})
_PARTICIPANT = re.compile(r"(?:participant|teilnehmer(?:/?in)?)\s*([0-9]+)", re.IGNORECASE)


def read_roster(path: Path) -> Roster:
    """Return the roster in a CSV file in UTF-8, UTF-16 with a byte order mark, or cp1252; raises InputError.

    Columns can be in any order, separated by commas, semicolons or tabs; unknown columns are ignored. A student's key is the id, else
    the university's id, login, address, name, or LMS id.
    """
    shown = printable_path(path)
    rows = _rows(_text_of(read_capped(path, _LIMIT, advice=""), shown), shown)
    _, header = next(rows, (1, []))
    fields = _fields(header, shown) if header else []
    plain = set(map(_plain, header))
    is_from_canvas = {"student", "id"} <= plain and not {"sis", "login"}.isdisjoint(fields)
    entries: list[RosterEntry] = []
    notes: list[str] = []
    lines: dict[tuple[str, str], int] = {}
    for line, cells in rows:
        if len(cells) < len(fields) or any(cells[len(fields) :]):
            raise InputError(f"line {line} of {shown} has {len(cells)} cells where the first line has {len(fields)}")
        row = dict.fromkeys(_ALIASES, "")  # the first cell of each field that is not empty
        row |= {field: cell for field, cell in reversed(list(zip(fields, cells, strict=False))) if cell}
        if is_from_canvas:
            if not row["id"]:  # Canvas has rows of points and comments above the students
                continue
            row["canvas"] = row["canvas"] or row["id"]
        entry = _entry(row, f"line {line} of {shown}")
        for field in ("key", "canvas", "moodle"):
            value = getattr(entry.student, field)
            first = lines.setdefault((field, value), line) if value else line
            if first != line:
                what = "id" if field == "key" else f"{field} id"
                raise InputError(f"{shown} has the {what} {value} twice, in lines {first} and {line}")
        if row["submitted"] and not entry.submitted:
            notes.append(f"line {line}: {row['submitted']!r} is not a time such as 2026-09-01T10:00, and was ignored")
        entries.append(entry)
    if not entries:
        raise InputError(f"{shown} has no students")
    ids = (found[1] for cell in header if is_from_canvas and (found := _ASSIGNMENT.fullmatch(cell)))
    return Roster(entries, tuple(notes), map("Canvas {}".format, ids))


def _entry(row: dict[str, str], where: str) -> RosterEntry:
    participant = _PARTICIPANT.fullmatch(row["id"])
    own_id = "" if participant else row["id"]
    moodle = row["moodle"] or (participant[1] if participant else "")
    moodle = found[1] if (found := re.search(r"([0-9]+)$", moodle)) else ""
    sis = row["sis"] or ("" if own_id == row["canvas"] else own_id)
    login = row["login"] or row["github"]
    name = row["name"] or " ".join(part for part in (row["first"], row["last"]) if part)
    key = own_id or row["sis"] or login or row["email"] or name or row["canvas"] or moodle
    if not key:
        raise InputError(f"{where} has no id, login, name or email address: add one of them")
    return RosterEntry(
        Student(printable_path(key), name, row["email"], login, sis, row["canvas"], moodle),
        row["section"],
        *_due(row, where),
        iso_time(row["submitted"]),
        *_late(row["late"], where),
        (row["github"],) if row["github"] not in ("", login) else (),
        row["group"],
        row["marker"],
    )


def _due(row: dict[str, str], where: str) -> tuple[str, float]:
    """Return a student's own deadline and extension in days: the column extension may hold either."""
    days = _days(row["extension"])
    written = row["due"] or ("" if days is not None else row["extension"])
    due = iso_time(written)
    if written and not due:
        raise InputError(f"{where} has the date {written!r}: write it as 2026-09-01 or 2026-09-01T23:59")
    return due, days or 0.0


def _late(text: str, where: str) -> tuple[bool | None, float | None]:
    said = text.casefold()
    if not said:
        return None, None
    if said in _YES or said in _NO:
        return said in _YES, None
    days = _days(said)
    if days is None:
        raise InputError(f"{where} has {text!r} for late: write yes, no, or a number of days")
    return days > 0, days


def _days(text: str) -> float | None:
    found = re.fullmatch(r"([0-9]{1,4}(?:[.,][0-9]{1,4})?)\s*(?:days?)?", text)
    return float(found[1].replace(",", ".")) if found else None


def _text_of(data: bytes, shown: str) -> str:
    encodings = ("utf-16",) if data.startswith((b"\xff\xfe", b"\xfe\xff")) else ("utf-8-sig", "cp1252")
    for encoding in encodings:
        with suppress(UnicodeError):
            if "\0" not in (text := data.decode(encoding)):
                return text
    raise InputError(f"{shown} is not a text file: save it as CSV in UTF-8")


def _rows(text: str, shown: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the line where each row begins that is not empty, and its cells with spaces normalised."""
    text = re.sub(r"\Asep=[;,]\r?\n", "", text)
    header = next((line for line in text.splitlines() if line.strip(' ,;\t"')), "")
    unquoted = re.sub(r'"[^"]*"', "", header)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=max(",;\t", key=unquoted.count), strict=True)
    line = 1
    try:
        for row in reader:
            cells = [" ".join(_AS_TEXT.sub(r"\1", cell.strip()).split()) for cell in row]
            if any(cells):
                yield line, cells
            line = reader.line_num + 1
    except csv.Error as error:
        raise InputError(f"line {line} of {shown} cannot be read as CSV: {error}") from None


def _fields(header: list[str], shown: str) -> list[str]:
    """Return the field of each column, empty for an unknown column."""
    fields = [_FIELD_OF.get(_plain(cell), "") for cell in header]
    if _WHO.isdisjoint(fields):
        named = ", ".join(cell for cell in header if cell)[:200]
        raise InputError(f"{shown} has no column for an id, login, name or email in its first line, only: {named}")
    return fields


def _plain(header: str) -> str:
    return "".join(letter for letter in header.casefold() if letter.isalnum())
