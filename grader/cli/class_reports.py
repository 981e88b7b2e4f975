"""A report for each student of a class, from the gradebook, in files of their own."""

import hashlib
import re
import unicodedata
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from grader.cli.formats import Format, render
from grader.cli.saving import save
from grader.errors import InputError

if TYPE_CHECKING:
    from datetime import datetime

    from grader.classroom.standings import Standing, Standings
    from grader.grading.report import Report

_TOGETHER = 50
_UNSAFE = re.compile(r'[\x00-\x1f\x7f<>:"/\\|?*\s]+')
_RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?")  # names that Windows keeps for devices
_LONGEST = 180  # bytes: with a digest, an ending and what `save` puts around it a file system takes 255


def write_reports(
    executor: Executor, book: Path, folder: Path, formats: Sequence[Format], due: "datetime | None" = None
) -> int:
    """Write a report of every student who has a result; how many. Raises InputError where one cannot be written."""
    from grader.classroom.gradebook import Gradebook

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the folder {folder}: {error.strerror}") from None
    with Gradebook(book) as opened:
        keys = [str(row[0]) for row in opened.rows("SELECT key FROM grade WHERE result IS NOT NULL ORDER BY key")]
    names = file_names(keys)
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
    from grader.classroom.gradebook import Gradebook
    from grader.classroom.standings import Standings

    with Gradebook(Path(book)) as opened:
        standings = Standings(opened, due)
        for standing in list(standings.between(min(names), max(names))):
            name = names.get(standing.student.key)
            if name is None:
                continue
            report = report_of(standings, standing)
            for kind in formats:
                save(Path(folder, f"{name}.{kind.ending}"), render(report, kind, to_file=True))


def report_of(standings: "Standings", standing: "Standing") -> "Report":
    """The report on a student's newest hand-in; what being late costs is a note of its own."""
    report = standings.report(standing)
    if not standing.late.words:
        return report
    from grader.report.points import points_words

    note = standing.late.words
    if standing.late.points:
        note += (
            f": {points_words(-standing.late.points)} points are taken off, which leaves {points_words(standing.total)}"
        )
    return replace(report, notes=(*report.notes, note))


def file_names(keys: Sequence[str]) -> dict[str, str]:
    """A file name, without its ending, for each key: safe on every system, and no two alike, in upper or lower case."""
    plain = {key: _plain(key) for key in keys}
    taken: dict[str, int] = {}
    for name in plain.values():
        taken[name.casefold()] = taken.get(name.casefold(), 0) + 1
    return {
        key: name if name == key and taken[name.casefold()] == 1 else f"{name}-{_digest(key)}"
        for key, name in plain.items()
    }


def _plain(key: str) -> str:
    data = _UNSAFE.sub("_", unicodedata.normalize("NFC", key)).encode("utf-8", "replace")
    name = data[:_LONGEST].decode("utf-8", "ignore").strip(" .") or "_"
    return f"_{name}" if _RESERVED.fullmatch(name) or name.startswith("-") else name


def _digest(key: str) -> str:
    return hashlib.sha256(key.encode("utf-8", "surrogateescape")).hexdigest()[:6]
