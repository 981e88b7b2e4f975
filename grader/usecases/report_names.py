"""The files of a class's reports: names that are safe on every system, and the class's page."""

import re
import unicodedata
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from grader.classroom.grades import Class
from grader.files.reading import sha256_of
from grader.report.formats import Format
from grader.text import without_commands
from grader.usecases.saves import address
from grader.usecases.writing import save

CLASS_PAGE = "index.html"
# No device of Windows, no class's page, and nothing that ends like a name with a digest.
_SAFE = re.compile(
    r"(?i)(?!(?:con|prn|aux|nul|com\d|lpt\d)(?:\.|$)|index$|.*-[0-9a-f]{64}$)[\w=][\w.@+=,'()-]{0,39}(?<!\.)"
)


def file_names(keys: Sequence[str]) -> dict[str, str]:
    """Return a file name without ending for each key: valid on every system, and unique without regard to case.

    A key that is not a valid name, or that differs from another one only in case, gets its digest appended.
    """
    folds = {key: unicodedata.normalize("NFC", key).casefold() for key in keys}
    counts = Counter(folds.values())
    return {key: key if _SAFE.fullmatch(key) and counts[folds[key]] == 1 else _with_digest(key) for key in keys}


def _with_digest(key: str) -> str:
    readable = re.sub(r"[^\w-]+", "_", unicodedata.normalize("NFC", key))[:30].strip(" .-") or "_"
    return f"{readable}-{sha256_of(key.encode('utf-8', 'surrogateescape'))}"


def write_class_page(book: Class, folder: Path, pages: Mapping[str, str]) -> None:
    """Write the class's page into a folder, with links to the pages of students, by their names from there."""
    from grader.classroom.statistics import statistics
    from grader.report.pages.class_page import render_class_page

    grades = list(book)
    links = {key: address(f"{name}.{Format.HTML.ending}") for key, name in pages.items()}
    save(folder / CLASS_PAGE, without_commands(render_class_page(book, grades, statistics(book, grades), links)))
