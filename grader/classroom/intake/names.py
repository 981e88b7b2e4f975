"""Parse file names and times in a class folder: endings, numbered copies of a browser, dates."""

import re
from datetime import UTC, datetime
from functools import lru_cache

# The files that are submissions. If two names differ in their ending only, the earlier ending here counts.
ENDINGS = (
    ".zip", ".tar.gz", ".tgz", ".tar.bz2", ".tar.xz", ".tar", ".gz", ".bz2", ".xz", ".7z", ".rar",
    ".urdf.xacro", ".urdf", ".xacro",
)  # fmt: skip
_LAST = frozenset(ENDINGS)
_BEFORE = {".gz": ".tar", ".bz2": ".tar", ".xz": ".tar", ".xacro": ".urdf"}
_COPY = re.compile(r"(.+?) ?\((\d{1,4})\)", re.DOTALL)
_ZONE = re.compile(r"\s*(?:UTC|UCT|GMT|Z)$")
_OFFSET = re.compile(r"\s+(?=[+-][0-9:]+$)")
# The words of the names of folders that hold what a course hands out: Lab6 resources, Starter code, Handout (old).
_COURSE_WORDS = frozenset(
    {
        "resource", "resources", "handout", "handouts", "solution", "solutions", "template", "templates", "starter",
        "skeleton", "material", "materials", "example", "examples", "instructions", "reference", "references",
        "rubric", "rubrics", "grading", "demo", "slides",
    }
)  # fmt: skip
_OTHER_WORDS = frozenset(
    {
        "lab", "labs", "course", "class", "code", "file", "files", "folder", "for", "of", "the", "and", "to", "from",
        "old", "new", "sample", "model", "student", "students", "project", "assignment", "exercise", "task", "week",
        "ws", "workspace",
    }
)  # fmt: skip
_WORDS = re.compile(r"[^\W\d_]+")


@lru_cache(maxsize=64)  # each name is asked for several times in a row
def ending_of(name: str) -> str:
    """Return the ending that makes a file a submission, as written; empty if it has none of ENDINGS."""
    dot = name.rfind(".")
    last = name[dot:].lower()
    if dot < 0 or last not in _LAST:
        return ""
    before = _BEFORE.get(last)
    return name[dot - len(before) :] if before and name[:dot].lower().endswith(before) else name[dot:]


def stems_of(folders: list[str], files: list[str]) -> list[str]:
    """Return the names that may be submissions, files without their endings."""
    return folders + [name.removesuffix(ending) for name in files if (ending := ending_of(name))]


def is_course_folder(path: str) -> bool:
    """Return whether a submission's name is that of a course folder: no word in it could be a student's."""
    name = path.rpartition("/")[2]
    words = set(_WORDS.findall(name.removesuffix(ending_of(name)).casefold()))
    return bool(words & _COURSE_WORDS) and words <= _COURSE_WORDS | _OTHER_WORDS


def without_copy(stem: str, ending: str = "") -> tuple[str, int]:
    """Return a name without the number that a browser gives a copy, and that number: `alice`, 2 for `alice (2)`.

    A browser may put the number in front of the last ending only: `alice.tar (1).gz`.
    """
    found = _COPY.fullmatch(stem) if stem.endswith(")") else None
    if found is None:
        return stem, 0
    plain = found[1]
    if ending.lower() in (".gz", ".bz2", ".xz") and plain.lower().endswith(".tar") and len(plain) > len(".tar"):
        plain = plain[: -len(".tar")]
    return plain, int(found[2])


def iso_time(text: str) -> str:
    """Return a date or time as ISO 8601, to the second; empty if it is neither. A time without a zone gets none."""
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
    """Return a date or time as ISO 8601 in UTC; one without a zone is taken as UTC. Empty if it is neither."""
    try:
        time = datetime.fromisoformat(iso_time(text))
        time = time.replace(tzinfo=UTC) if time.tzinfo is None else time.astimezone(UTC)
    except (ValueError, OverflowError):  # OverflowError for a time in the year 1
        return ""
    return time.isoformat(timespec="seconds").replace("+00:00", "Z")
