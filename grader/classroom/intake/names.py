"""How people and their files are named: in rosters, in an LMS, and by browsers that save a file for the second time."""

import re
import unicodedata
from collections.abc import Iterator
from datetime import UTC, datetime
from functools import lru_cache

# What one student's work comes as. Where two names differ in their ending only, the earlier ending here counts.
ENDINGS = (
    ".zip", ".tar.gz", ".tgz", ".tar.bz2", ".tar.xz", ".tar", ".gz", ".bz2", ".xz", ".7z", ".rar",
    ".urdf.xacro", ".urdf", ".xacro",
)  # fmt: skip
_LAST = frozenset(ENDINGS)
_BEFORE = {".gz": ".tar", ".bz2": ".tar", ".xz": ".tar", ".xacro": ".urdf"}
_COPY = re.compile(r"(.+?) ?\((\d{1,4})\)", re.DOTALL)
_WORD = frozenset({"Lu", "Ll", "Lt", "Lm", "Lo", "Mn", "Mc", "Me", "Nd", "Pc"})
_SUFFIX = re.compile(r"(sn?r|senior|jn?r|junior|i{2,3}|iv|vi?|esq|esquire)\.?", re.IGNORECASE)
_ZONE = re.compile(r"\s*(?:UTC|UCT|GMT|Z)$")
_OFFSET = re.compile(r"\s+(?=[+-][0-9:]+$)")
_UNWRITTEN = str.maketrans("", "", "&<>\"`|':\\/")
_MOST_WORDS = 8


@lru_cache(maxsize=64)  # each name is asked for several times in a row
def ending_of(name: str) -> str:
    """The ending for which a file is taken for a submission, as it is written; empty where it has none of these."""
    dot = name.rfind(".")
    last = name[dot:].lower()
    if dot < 0 or last not in _LAST:
        return ""
    before = _BEFORE.get(last)
    return name[dot - len(before) :] if before and name[:dot].lower().endswith(before) else name[dot:]


def without_copy(stem: str, ending: str = "") -> tuple[str, int]:
    """A name as it was before a browser added the number of a copy, and that number: `alice (2)` is `alice`, 2.

    A browser may put the number in front of the last ending only: `alice.tar (1).gz`.
    """
    found = _COPY.fullmatch(stem) if stem.endswith(")") else None
    if found is None:
        return stem, 0
    plain = found[1]
    if ending.lower() in (".gz", ".bz2", ".xz") and plain.lower().endswith(".tar") and len(plain) > len(".tar"):
        plain = plain[: -len(".tar")]
    return plain, int(found[2])


def plain_word(word: str) -> str:
    """A login, number or address for comparison: case does not count, nor how an accent is put together."""
    return word.casefold() if word.isascii() else unicodedata.normalize("NFC", word).casefold()


def plain_name(name: str) -> str:
    """A full name for comparison: compatible characters, case and spaces made alike, `Doe, Jane` the same as `Jane Doe`.

    Apostrophes and the like do not count: Moodle leaves them out of the names of files (moodlelib.php, PARAM_FILE).
    """
    words = name.casefold().replace("_", " ")
    if not words.isascii():
        words = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", name).casefold()).replace("_", " ")
        words = "".join(letter for letter in words if unicodedata.category(letter) != "Cf")  # marks of direction
    last, comma, first = words.translate(_UNWRITTEN).partition(",")
    return " ".join(f"{first} {last}".split()) if comma else " ".join(last.split())


def plain_group(name: str) -> str:
    """The name of a group or of its hand-in for comparison: case does not count, nor which of space, `_` and `-` stands between words."""
    return " ".join(plain_word(name).replace("_", " ").replace("-", " ").split())


def is_word(letter: str) -> bool:
    """Whether a character is one of words to Ruby, in which Canvas is written: a letter, mark, digit or connector."""
    return (letter.isascii() and letter.isalnum()) or unicodedata.category(letter) in _WORD


def canvas_name(sortable: str) -> str:
    """What Canvas makes of a sortable name in the names of files (canvas-lms, content_zipper.rb), for comparison."""
    plain = unicodedata.normalize("NFC", re.sub(r"_(\d+)_", r"\1", sortable))
    return "".join(letter for letter in plain if is_word(letter)).casefold()


def canvas_names(name: str) -> Iterator[str]:
    """What Canvas may call someone in a file's name: it sorts by the last word of a name, or by what its user has set."""
    if "," in name:
        yield canvas_name(name)
        return
    words = name.split()[:_MOST_WORDS]
    for index in range(len(words)):
        yield canvas_name("".join(words[index:] + words[:index]))
    if len(words) > 2 and _SUFFIX.fullmatch(words[-1]):
        *given, last, suffix = words
        yield canvas_name("".join([last, *given, suffix]))


def surname(name: str) -> str:
    """The part of a full name that people are sorted by: what stands before a comma, or the last word."""
    last, comma, _ = name.partition(",")
    words = last.split()
    return plain_name(last) if comma else plain_name(words[-1] if words else "")


def iso_time(text: str) -> str:
    """A date or time as ISO 8601, to the second; empty where it is none. A time without a zone is left without one."""
    text = text.strip()
    if ":" in text:
        text = _OFFSET.sub("", _ZONE.sub("+00:00", text))
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        return ""
    if ":" not in text:
        return time.date().isoformat() if len(text) == len("2026-09-01") else ""
    return time.isoformat(timespec="seconds").replace("+00:00", "Z")


def utc_time(text: str) -> str:
    """A date or time as ISO 8601 in UTC, where one that names no zone is meant in UTC; empty where it is none."""
    written = iso_time(text)
    if not written:
        return ""
    time = datetime.fromisoformat(written)
    try:
        time = time.replace(tzinfo=UTC) if time.tzinfo is None else time.astimezone(UTC)
    except OverflowError:  # a time in the year 1
        return ""
    return time.isoformat(timespec="seconds").replace("+00:00", "Z")
