"""The lateness in the column Status of Moodle's grading worksheet: `Submitted for grading - 1 day 2 hours late`.

moodle, mod/assign/gradingtable.php, col_status: parts with ` - ` between them. One is the string submittedlateshort with the time
after the deadline, which is the student's own where Moodle knows an extension. Others with a number are overdue and
userextensiondate, which have a colon. lib/moodlelib.php, format_time: the two largest units, rounded down.
"""

import re

# submittedlateshort in English, German, French, Spanish, Italian, Portuguese and Dutch, as their language packs have it.
_LATE = re.compile(
    r"(?P<after>.+) (?:late|später|verspätet|después|de retraso|in ritardo|atrasado|(?:te )?laat)|en retard de (?P<before>.+)",
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
            return _days(found["after"] or found["before"])
        if _NUMBER.search(part) and ":" not in part:
            return None
    return 0.0


def _days(duration: str) -> float | None:
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
