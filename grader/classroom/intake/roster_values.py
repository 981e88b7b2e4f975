"""The values in a row of a roster, the Status of Moodle's grading worksheet among them, and which of them are wrong."""

import re
import unicodedata
from collections.abc import Callable

from grader.classroom.intake.names import iso_time
from grader.classroom.intake.roster import RosterEntry
from grader.classroom.students import Student
from grader.text import printable_path

# moodle, mod/assign/gradingtable.php, col_status: parts with ` - ` between them. One is the string submittedlateshort
# with the time after the deadline, which is the student's own where Moodle knows an extension. Others with a number are
# overdue and userextensiondate, which have a colon. lib/moodlelib.php, format_time: the two largest units, rounded
# down. submittedlateshort in English, German, French, Spanish, Italian, Portuguese and Dutch, as their language packs
# have it.
_LATE = re.compile(
    # 2 days 3 hours late
    r"(?P<after>.+?) (?:late|später|verspätet|después|de retraso|in ritardo|atrasado|(?:te )?laat)"
    # en retard de 2 jours 3 heures
    r"|en retard de (?P<before>.+)",
    re.IGNORECASE,
)
# How the units begin in these languages, or their letter (French has s for seconds), and what one of them is in days.
_UNITS = (
    (("year", "jahr", "an", "año", "jaar"), "y", 365.0),
    (("day", "tag", "jour", "día", "dia", "giorn", "dag"), "dj", 1.0),
    (("hour", "stunde", "std", "heure", "hora", "ora", "ore", "uur", "uren"), "hu", 1 / 24),
    (("min",), "m", 1 / 1440),
    (("sec", "sek", "seg"), "s", 1 / 86400),
)
_PAIR = re.compile(r"([0-9]{1,6}) ([^\W\d]+)\.?")
_NUMBER = re.compile(r"[0-9]")


def days_late(status: str) -> float | None:
    """Return by how many days a submission was late, 0 if it was not; None if the status is not understood."""
    for part in status.split(" - "):
        if found := _LATE.fullmatch(part.strip()):
            return _days_of(found["after"] or found["before"])
        if _NUMBER.search(part) and ":" not in part:
            return None
    return 0.0


def _days_of(duration: str) -> float | None:
    """Return the days of `1 day 2 hours`; None if a unit is not known."""
    if not re.fullmatch(rf"{_PAIR.pattern}(?: {_PAIR.pattern})?", duration):
        return None
    days = 0.0
    for number, word in _PAIR.findall(duration):
        plain = word.casefold()
        unit = next((size for words, letters, size in _UNITS if plain.startswith(words) or plain in [*letters]), None)
        if unit is None:
            return None
        days += int(number) * unit
    return days


Complain = Callable[[str], None]
_YES = frozenset({"yes", "y", "true", "late", "x", "ja"})
_NO = frozenset({"no", "n", "false", "on time", "-", "nein"})
_NO_GROUP = frozenset({"none", "n/a", "null", "nil", "no group"})
_PARTICIPANT = re.compile(r"(?:participant|teilnehmer(?:/?in)?)\s*[0-9]+", re.IGNORECASE)
_WORD_AND_NUMBER = re.compile(r"(?:[^\W\d]{4,}\D*)?([0-9]+)")  # Participant 123, in any language
_DATE = re.compile(r"\d{4}-\d\d?-\d\d?(?!\d)")


def _ids(row: dict[str, str]) -> tuple[str, str]:
    """Return the id of the student, and that of Moodle, which also stand in columns with other names."""
    is_participant = bool(_PARTICIPANT.fullmatch(row["id"]))
    own_id, of_moodle = ("", row["moodle"] or row["id"]) if is_participant else (row["id"], row["moodle"])
    if _is_of_moodle(row):
        return own_id, of_moodle or row["identifier"]
    return own_id or row["identifier"], of_moodle


class RowReader:
    """Reads the rows of one roster. `unread` are the lines with a Status that is not understood."""

    def __init__(self, *, is_from_canvas: bool) -> None:
        self._is_from_canvas = is_from_canvas
        self.unread: list[tuple[int, str]] = []

    def entry(self, line: int, row: dict[str, str]) -> tuple[RosterEntry | None, list[str]]:
        """Return the student in a row, given by field, and what is wrong in it; no student if the row names none."""
        mistakes: list[str] = []
        return self._entry(line, row, mistakes.append), mistakes

    def _entry(self, line: int, row: dict[str, str], complain: Complain) -> RosterEntry | None:
        own_id, of_moodle = _ids(row)
        canvas = _canvas(row["canvas"] or (own_id if self._is_from_canvas else ""), complain)
        moodle = _moodle(of_moodle, complain)
        sis = row["sis"] or ("" if own_id == canvas else own_id)
        login = row["login"] or row["github"]
        name = row["name"] or f"{row['first']} {row['last']}".strip()
        email = _email(row["email"], complain)
        key = own_id or row["sis"] or login or email or name or canvas or moodle
        if not key:
            complain("has no id, login, name or email address: add one of them")
            return None
        due, extension = _due(row, complain)
        is_late, days = _late(row["late"], complain)
        if row["status"] and moodle and not (row["late"] or row["submitted"]):
            is_late, days = self._of_status(line, row["status"], due, extension)
        return RosterEntry(
            Student(printable_path(key), name, email, login, sis, canvas, moodle),
            row["section"],
            due,
            extension,
            _submission_time(row["submitted"], complain),
            is_late,
            days,
            (row["github"],) if row["github"] not in ("", login) else (),
            _group(row["group"], complain),
            row["marker"],
        )

    def _of_status(self, line: int, status: str, due: str, extension: float) -> tuple[bool | None, float | None]:
        """Return the lateness that Moodle states. Moodle does not know the extension and the deadline in the roster."""
        days = days_late(status)
        if days is None:
            self.unread.append((line, status))
        if not days:
            return None, None
        if due:
            return True, None
        return days > extension, max(0.0, days - extension)


def _is_of_moodle(row: dict[str, str]) -> bool:
    """Return whether the Identifier is Moodle's, as in a worksheet; GitHub Classroom's is the course's own id."""
    return bool(_WORD_AND_NUMBER.fullmatch(row["identifier"])) and not row["github"]


def _canvas(text: str, complain: Complain) -> str:
    if text and not re.fullmatch("[0-9]+", text):
        complain(f"has {text!r} for the canvas id, which must be a number")
        return ""
    return text


def _moodle(text: str, complain: Complain) -> str:
    found = _WORD_AND_NUMBER.fullmatch(text)
    if text and not found:
        complain(f"has {text!r} for the participant id, which must be a number (put other ids in a column `id`)")
    return found[1] if found else ""


def _email(text: str, complain: Complain) -> str:
    if text and not re.fullmatch(r"[^@\s]+@[^@\s]+", text):
        complain(f"has {text!r} for the email address, which needs an @")
    return text


def _group(text: str, complain: Complain) -> str:
    visible = [letter for letter in text if unicodedata.category(letter)[0] in "LN"]
    if text and (not visible or text.casefold() in _NO_GROUP):
        complain(f"has {text!r} for the group: leave the cell empty for a student without a group")
    return text


def _submission_time(text: str, complain: Complain) -> str:
    time = iso_time(text)
    if text and not time:
        complain(f"has the time {text!r} for submitted{_why_no_date(text)}: write it as 2026-09-01T10:00")
    return time


def _due(row: dict[str, str], complain: Complain) -> tuple[str, float]:
    """Return a student's own deadline and extension in days: the column extension may hold either."""
    days, extended = _days(row["extension"]), iso_time(row["extension"])
    if row["extension"] and days is None and not extended:
        why = _why_no_date(row["extension"])
        complain(f"has {row['extension']!r} for extension{why}: write a number of days from 0, or a date")
        return "", 0.0
    due = iso_time(row["due"]) if row["due"] else "" if days is not None else extended
    if row["due"] and not due:
        complain(f"has the date {row['due']!r}{_why_no_date(row['due'])}: write it as 2026-09-01 or 2026-09-01T23:59")
    if row["due"] and row["extension"] and days is None:
        complain(f"has both {row['due']!r} for due and {row['extension']!r} for extension: write one date")
    return due, days or 0.0


def _why_no_date(text: str) -> str:
    return ", which does not exist" if _DATE.match(text) else ""


def _late(text: str, complain: Complain) -> tuple[bool | None, float | None]:
    said = text.casefold()
    if not said:
        return None, None
    if said in _YES or said in _NO:
        return said in _YES, None
    days = _days(said)
    if days is None:
        complain(f"has {text!r} for late: write yes, no, or a number of days from 0")
        return None, None
    return days > 0, days


def _days(text: str) -> float | None:
    found = re.fullmatch(r"([0-9]{1,4}(?:[.,][0-9]{1,4})?)\s*(?:days?)?", text)
    return float(found[1].replace(",", ".")) if found else None
