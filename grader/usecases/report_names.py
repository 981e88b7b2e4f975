"""The files of a class's reports: names that are safe on every system, their index, and the class's page."""

import re
import unicodedata
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from grader.classroom.grades import Class
from grader.classroom.tables import write_table
from grader.files.reading import sha256_of
from grader.report.formats import Format
from grader.text import without_commands
from grader.usecases.saves import address
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
    names = {key: _plain(key) for key in keys}
    counts = Counter(map(_fold, names.values()))
    for key, name in names.items():
        if name != key or counts[_fold(name)] > 1 or _DIGEST.search(name):
            names[key] = f"{name}-{sha256_of(key.encode('utf-8', 'surrogateescape'))}"
    return names


def write_index(folder: Path, names: Mapping[str, str]) -> None:
    """Write which student each report is of. Raises InputError."""
    save(folder / INDEX, write_table(("report", "id"), sorted((name, key) for key, name in names.items())))


def write_class_page(book: Class, folder: Path, pages: Mapping[str, str]) -> None:
    """Write the class's page into a folder, with links to the pages of students, by their names from there."""
    from grader.classroom.statistics import statistics
    from grader.report.pages.class_page import render_class_page

    grades = list(book)
    links = {key: address(f"{name}.{Format.HTML.ending}") for key, name in pages.items()}
    save(folder / CLASS_PAGE, without_commands(render_class_page(book, grades, statistics(book, grades), links)))


def _fold(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


def _plain(key: str) -> str:
    safe = _UNSAFE.sub("_", unicodedata.normalize("NFC", key))
    visible = "".join(letter if letter.isprintable() else "_" for letter in safe)  # some file systems ignore the others
    name = visible.encode("utf-8", "replace")[:_MAX_BYTES].decode("utf-8", "ignore").strip(" .") or "_"
    return f"_{name}" if _RESERVED.fullmatch(name) or name.startswith("-") else name
