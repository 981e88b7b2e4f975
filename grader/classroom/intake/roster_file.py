"""Read a roster from a CSV file: an instructor's own, a gradebook from Canvas, or a grading worksheet from Moodle."""

import re
from pathlib import Path

from grader.classroom.intake.names import iso_time
from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.intake.roster_rows import RosterRow, canvas_assignments, rows_of, text_of
from grader.classroom.students import Student
from grader.errors import InputError
from grader.files.reading import read_capped
from grader.text import printable_path

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
    text = text_of(read_capped(path, _LIMIT, advice=""), shown)
    entries: list[RosterEntry] = []
    notes: list[str] = []
    lines: dict[tuple[str, str], int] = {}
    for row in rows_of(text, shown):
        entry = _entry(row, shown, notes)
        for field in ("key", "canvas", "moodle"):
            value = getattr(entry.student, field)
            first = lines.setdefault((field, value), row.line) if value else row.line
            if first != row.line:
                what = "id" if field == "key" else f"{field} id"
                raise InputError(f"{shown} has the {what} {value} twice, in lines {first} and {row.line}")
        entries.append(entry)
    if not entries:
        raise InputError(f"{shown} has no students")
    return Roster(entries, tuple(notes), canvas_assignments(text, shown))


def _entry(row: RosterRow, shown: str, notes: list[str]) -> RosterEntry:
    participant = _PARTICIPANT.fullmatch(row["id"])
    own_id = "" if participant else row["id"]
    moodle = row["moodle"] or (participant[1] if participant else "")
    moodle = found[1] if (found := re.search(r"([0-9]+)$", moodle)) else ""
    sis = row["sis"] or ("" if own_id == row["canvas"] else own_id)
    login = row["login"] or row["github"]
    name = row["name"] or " ".join(part for part in (row["first"], row["last"]) if part)
    key = own_id or row["sis"] or login or row["email"] or name or row["canvas"] or moodle
    if not key:
        raise InputError(f"line {row.line} of {shown} has no id, login, name or email address: add one of them")
    is_late, days_late = _late(row, shown)
    submitted = iso_time(row["submitted"])
    if row["submitted"] and not submitted:
        notes.append(f"line {row.line}: {row['submitted']!r} is not a time such as 2026-09-01T10:00, and was ignored")
    return RosterEntry(
        Student(printable_path(key), name, row["email"], login, sis, row["canvas"], moodle),
        row["group"] or row["section"],
        *_due(row, shown),
        submitted,
        is_late,
        days_late,
        (row["github"],) if row["github"] not in ("", login) else (),
    )


def _due(row: RosterRow, shown: str) -> tuple[str, float]:
    """Return a student's own deadline and extension in days: the column extension may contain either."""
    days = _number(row["extension"].removesuffix("days").removesuffix("day").strip())
    written = row["due"] or ("" if days is not None else row["extension"])
    due = iso_time(written)
    if written and not due:
        raise InputError(
            f"line {row.line} of {shown} has the date {written!r}: write it as 2026-09-01 or 2026-09-01T23:59"
        )
    return due, days or 0.0


def _late(row: RosterRow, shown: str) -> tuple[bool | None, float | None]:
    said = row["late"].casefold()
    if not said:
        return None, None
    if said in _YES or said in _NO:
        return said in _YES, None
    days = _number(said.removesuffix("days").removesuffix("day").strip())
    if days is None:
        raise InputError(f"line {row.line} of {shown} has {row['late']!r} for late: write yes, no, or a number of days")
    return days > 0, days


def _number(text: str) -> float | None:
    return float(text.replace(",", ".")) if re.fullmatch(r"[0-9]{1,4}(?:[.,][0-9]{1,4})?", text) else None
