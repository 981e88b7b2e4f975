"""The students of a class, and the normalised form in which names and ids are compared."""

import unicodedata
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Student:
    """A student: `key` is unique in the class, other fields are empty where they are not known.

    `sis` is the university's id, `canvas` Canvas' user id, `moodle` Moodle's participant id. `is_on_roster` is False
    for a student who is known by the name of the submission alone.
    """

    key: str
    name: str = ""
    email: str = ""
    login: str = ""
    sis: str = ""
    canvas: str = ""
    moodle: str = ""
    aliases: tuple[str, ...] = ()
    group: str = ""
    section: str = ""
    due: str = ""
    submitted: str = ""
    extension_days: float = 0.0
    is_late: bool | None = None
    days_late: float | None = None
    submission: str = ""
    is_on_roster: bool = True


def plain(word: str) -> str:
    """Return an id, name or group without case, `_`, `-` and ways to encode a letter; "Doe, Jane" is Jane Doe."""
    text = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", word).casefold())
    last, comma, first = text.replace("_", " ").replace("-", " ").partition(",")
    return " ".join(f"{first} {last}".split() if comma else last.split())
