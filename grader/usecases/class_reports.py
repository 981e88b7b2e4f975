"""A report for each student of a class, from the gradebook, in files of their own."""

import hashlib
import re
import unicodedata
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from grader.classroom.lms.spreadsheet import neutral, rows_of_table, write_table
from grader.errors import InputError
from grader.report.formats import Format, render
from grader.usecases.writing import save

if TYPE_CHECKING:
    from datetime import datetime

    from grader.classroom.gradebook.grades import Grades
    from grader.classroom.gradebook.student_grade import StudentGrade
    from grader.grading.report import Report

_TOGETHER = 50
_UNSAFE = re.compile(r'[\x00-\x1f\x7f<>:"/\\|?*\s]+')
_RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?")  # names that Windows keeps for devices
_DIGEST = re.compile(r"-[0-9a-fA-F]{64}$")
INDEX = "index.csv"  # whose each report is
_LONGEST = 140  # bytes: with a digest, an ending and what `save` puts around it a file system takes 255


def write_reports(
    executor: Executor, book: Path, folder: Path, formats: Sequence[Format], due: "datetime | None" = None
) -> int:
    """Write a report of every student who has a result; how many. Raises InputError where one cannot be written."""
    from grader.classroom.gradebook.gradebook import Gradebook

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the folder {folder}: {error.strerror}") from None
    with Gradebook(book) as opened:
        keys = [str(row[0]) for row in opened.rows("SELECT key FROM grade WHERE result IS NOT NULL ORDER BY key")]
    names = file_names(keys)
    _record_names(folder / INDEX, names)
    some = [keys[start : start + _TOGETHER] for start in range(0, len(keys), _TOGETHER)]
    waiting = [
        executor.submit(_write_some, str(book), str(folder), tuple(formats), {key: names[key] for key in each}, due)
        for each in some
    ]
    for each in waiting:
        each.result()
    return len(keys)


def _write_some(
    book: str, folder: str, formats: tuple[Format, ...], names: dict[str, str], due: "datetime | None"
) -> None:
    from grader.classroom.gradebook.gradebook import Gradebook
    from grader.classroom.gradebook.grades import Grades

    with Gradebook(Path(book)) as opened:
        standings = Grades(opened, due)
        for standing in list(standings.between(min(names), max(names))):
            name = names.get(standing.student.key)
            if name is None:
                continue
            report = report_of(standings, standing)
            for kind in formats:
                save(Path(folder, f"{name}.{kind.ending}"), render(report, kind))


def report_of(standings: "Grades", standing: "StudentGrade") -> "Report":
    """The report on a student's newest hand-in; what being late costs is a note of its own."""
    report = standings.report(standing)
    if not standing.late.reason:
        return report
    from grader.report.points import points_words

    note = standing.late.reason
    if standing.late.points:
        note += (
            f": {points_words(-standing.late.points)} points are taken off, which leaves {points_words(standing.total)}"
        )
    return replace(report, notes=(*report.notes, note))


def file_names(keys: Sequence[str]) -> dict[str, str]:
    """A file name, without its ending, for each key: safe on every system, and no two alike, in upper or lower case.

    A key that is no such name, or looks like one with a digest, has its digest behind it.
    """
    plain = {key: _plain(key) for key in keys}
    counts = Counter(map(_folded, plain.values()))
    names = {
        key: name
        if name == key and counts[_folded(name)] == 1 and not _DIGEST.search(name)
        else _with_digest(name, key)
        for key, name in plain.items()
    }
    if len(set(map(_folded, names.values()))) < len(names):
        raise InputError("two students would share a report file; nothing was written")
    return names


def _record_names(index: Path, names: dict[str, str]) -> None:
    """Write down whose each report is; raises InputError where a report of another student would be written over."""
    try:
        before = {row[0]: row[1] for row in rows_of_table(index.read_text(encoding="utf-8"))} if index.exists() else {}
    except (OSError, ValueError, IndexError):
        raise InputError(
            f"cannot read {index}, which says whose each report is: remove it, or name another folder"
        ) from None
    rows = {neutral(name): neutral(key) for key, name in names.items()}
    other = next((name for name, key in rows.items() if before.get(name, key) != key), None)
    if other is not None:
        raise InputError(f"{index.parent} has a report of {before[other]} named {other}: name another folder")
    save(index, write_table(("report", "id"), sorted({**before, **rows}.items())))


def _folded(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


def _plain(key: str) -> str:
    data = _UNSAFE.sub("_", unicodedata.normalize("NFC", key)).encode("utf-8", "replace")
    name = data[:_LONGEST].decode("utf-8", "ignore").strip(" .") or "_"
    return f"_{name}" if _RESERVED.fullmatch(name) or name.startswith("-") else name


def _with_digest(name: str, key: str) -> str:
    return f"{name}-{hashlib.sha256(key.encode('utf-8', 'surrogateescape')).hexdigest()}"
