"""Write a report for each student of a class, from the gradebook, each in a separate file."""

import hashlib
import re
import unicodedata
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace
from datetime import datetime
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.lms.spreadsheet import neutral, rows_of_table, write_table
from grader.errors import InputError
from grader.grading.report import Report
from grader.report.formats import Format, render
from grader.text import format_points
from grader.usecases.writing import save

_TASK_SIZE = 50  # reports
_UNSAFE = re.compile(r'[\x00-\x1f\x7f<>:"/\\|?*\s]+')
_RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?")  # device names of Windows
_DIGEST = re.compile(r"-[0-9a-fA-F]{64}$")
INDEX = "index.csv"  # the student of each report
_MAX_BYTES = 140  # of a name: with a digest, an ending and a temporary name it stays below the 255 of a file system


def write_reports(
    executor: Executor, book: Path, folder: Path, formats: Sequence[Format], due: datetime | None = None
) -> int:
    """Write a report for every student who has a result and return their number. Raises InputError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the folder {folder}: {error.strerror}") from None
    with Gradebook(book) as opened:
        names = report_names(opened)
    keys = list(names)
    update_index(folder / INDEX, names)
    tasks = [
        executor.submit(_write_some, str(book), str(folder), tuple(formats), {key: names[key] for key in some}, due)
        for some in (keys[start : start + _TASK_SIZE] for start in range(0, len(keys), _TASK_SIZE))
    ]
    for task in tasks:
        task.result()
    return len(keys)


def _write_some(
    book: str, folder: str, formats: tuple[Format, ...], names: dict[str, str], due: datetime | None
) -> None:
    with Gradebook(Path(book)) as opened:
        grades = Grades(opened, due)
        for grade in list(grades.between(min(names), max(names))):
            name = names.get(grade.student.key)
            if name is not None:
                report = report_of(grades, grade)
                for kind in formats:
                    save(Path(folder, f"{name}.{kind.ending}"), render(report, kind))


def report_of(grades: Grades, grade: StudentGrade) -> Report:
    """Return the report on a student's newest submission; the late penalty is a note of its own."""
    report = grades.report(grade)
    if not grade.late.reason:
        return report
    note = grade.late.reason
    if grade.late.points:
        note += f": the late penalty is {format_points(-grade.late.points)} points, the total is {format_points(grade.total)}"
    return replace(report, notes=(*report.notes, note))


def report_names(book: Gradebook) -> dict[str, str]:
    """Return the file name without ending of each student who has a result, by key."""
    return file_names([str(row[0]) for row in book.rows("SELECT key FROM grade WHERE result IS NOT NULL ORDER BY key")])


def file_names(keys: Sequence[str]) -> dict[str, str]:
    """Return a file name without ending for each key: valid on every system, and unique without regard to case.

    A key that is not a valid name, or that ends like one with a digest, gets its digest appended.
    """
    plain = {key: _plain(key) for key in keys}
    counts = Counter(map(_folded, plain.values()))
    names = {}
    for key, name in plain.items():
        is_valid = name == key and counts[_folded(name)] == 1 and not _DIGEST.search(name)
        digest = "" if is_valid else f"-{hashlib.sha256(key.encode('utf-8', 'surrogateescape')).hexdigest()}"
        names[key] = name + digest
    if len(set(map(_folded, names.values()))) < len(names):
        raise InputError("two students would share a report file; nothing was written")
    return names


def update_index(index: Path, names: dict[str, str]) -> None:
    """Record the student of each report. Raises InputError if the report of another student would be overwritten."""
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


def _folded(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


def _plain(key: str) -> str:
    data = _UNSAFE.sub("_", unicodedata.normalize("NFC", key)).encode("utf-8", "replace")
    name = data[:_MAX_BYTES].decode("utf-8", "ignore").strip(" .") or "_"
    return f"_{name}" if _RESERVED.fullmatch(name) or name.startswith("-") else name
