"""The files of a class's reports: a file name for each student that is safe on every system, and their index."""

import hashlib
import re
import unicodedata
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from grader.classroom.tables import write_table
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
    return names


def write_index(folder: Path, names: dict[str, str]) -> None:
    """Write which student each report is of. Raises InputError."""
    save(folder / INDEX, write_table(("report", "id"), sorted((name, key) for key, name in names.items())))


def _fold(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


def _plain(key: str) -> str:
    safe = _UNSAFE.sub("_", unicodedata.normalize("NFC", key))
    visible = "".join(letter if letter.isprintable() else "_" for letter in safe)  # some file systems ignore the others
    name = visible.encode("utf-8", "replace")[:_MAX_BYTES].decode("utf-8", "ignore").strip(" .") or "_"
    return f"_{name}" if _RESERVED.fullmatch(name) or name.startswith("-") else name
