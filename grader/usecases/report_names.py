"""The files of a class's reports: a file name for each student that is safe on every system, and their index."""

import hashlib
import re
import unicodedata
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from grader.classroom.tables import neutral, rows_of_table, write_table
from grader.errors import InputError
from grader.usecases.writing import save

INDEX = "index.csv"  # the student of each report
CLASS_PAGE = "index.html"
_UNSAFE = re.compile(r'[\x00-\x1f\x7f<>:"/\\|?*\s]+')
# Device names of Windows, and the name of the class's page, in upper and lower case.
_RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?|index")
_DIGEST = re.compile(r"-[0-9a-fA-F]{64}$")
_MAX_BYTES = 140  # of a name: with a digest, an ending and a temporary name it stays below the 255 of a file system


def file_names(keys: Sequence[str]) -> dict[str, str]:
    """Return a file name without ending for each key: valid on every system, and unique without regard to case.

    A key that is not a valid name, or that ends like one with a digest, gets its digest appended.
    """
    plain = {key: _plain(key) for key in keys}
    counts = Counter(map(_fold, plain.values()))
    names = {}
    for key, name in plain.items():
        is_valid = name == key and counts[_fold(name)] == 1 and not _DIGEST.search(name)
        digest = "" if is_valid else f"-{hashlib.sha256(key.encode('utf-8', 'surrogateescape')).hexdigest()}"
        names[key] = name + digest
    if len(set(map(_fold, names.values()))) < len(names):
        raise InputError("two students would share a report file; nothing was written")
    return names


def update_index(folder: Path, names: dict[str, str]) -> list[str]:
    """Record the student of each report, and return the names of earlier reports of students who have no report now.

    Raises InputError if the report of another student would be overwritten.
    """
    index = folder / INDEX
    try:
        before = {row[0]: row[1] for row in rows_of_table(index.read_text(encoding="utf-8"))} if index.exists() else {}
    except (OSError, ValueError, IndexError):
        raise InputError(
            f"cannot read {index}, the list of the students of the reports: remove it, or choose another folder"
        ) from None
    rows = {neutral(name): neutral(key) for key, name in names.items()}
    other = next((name for name, key in rows.items() if before.get(name, key) != key), None)
    if other is not None:
        raise InputError(f"{index.parent} has a report of {before[other]} named {other}: choose another folder")
    save(index, write_table(("report", "id"), sorted({**before, **rows}.items())))
    return sorted(before.keys() - rows.keys())


def _fold(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


def _plain(key: str) -> str:
    safe = _UNSAFE.sub("_", unicodedata.normalize("NFC", key))
    visible = "".join(letter if letter.isprintable() else "_" for letter in safe)  # some file systems ignore the others
    name = visible.encode("utf-8", "replace")[:_MAX_BYTES].decode("utf-8", "ignore").strip(" .") or "_"
    return f"_{name}" if _RESERVED.fullmatch(name) or name.startswith("-") else name
