"""The marks of people: the rows of the CSV files in a folder, and which of them counts for a student and criterion.

The latest time counts, of equal times in one file the later row. A row without a time is newer than all with one.
Different rows that have no order are refused; equal rows are one. A comment without points changes only the comment.
"""

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from datetime import MAXYEAR, UTC, datetime, timedelta
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from grader.classroom.lateness import read_time
from grader.classroom.mark_files import COLUMNS, SURPLUS, WITHDRAWN, Cells, append_rows, whole_rows
from grader.classroom.tables import SIZE_LIMIT
from grader.classroom.typed_names import NotCountedError, known, number_in, read_points
from grader.errors import InputError
from grader.files.reading import read_capped
from grader.grading.criterion import DEADLINE, TOTAL
from grader.grading.keys import MAX_POINTS
from grader.grading.rubric import Rubric
from grader.text import first_lines, format_points, printable, printable_path, quoted

EXCUSED = "excused"  # in place of points, for TOTAL
_DIGEST = re.compile(r"d[0-9a-f]+")
_MAX_MISTAKES = 20

Key = tuple[str, str]  # a student and a criterion


class Mark(NamedTuple):
    """A row: what a grader gave for a criterion or for TOTAL, or a student's DEADLINE.

    `value` is the text in the column of points: points, EXCUSED, WITHDRAWN, a time, or empty for a comment alone.
    `time` is in UTC, or empty; `submission` is the digest of what was marked, or empty; `place` is the file and line.
    """

    time: str
    by: str
    student: str
    criterion: str
    value: str = ""
    comment: str = ""
    submission: str = ""
    place: str = ""

    @property
    def points(self) -> Decimal | None:
        """The points; None for another value."""
        return number_in(self.value) if self.criterion != DEADLINE else None


Reader = Callable[[Cells, str], Iterable[Mark]]  # of the marks in the cells of a row, at a place


class Marks(NamedTuple):
    """The marks of a class: those that count, the newest row where none counts, the newest rows of any kind.

    `ignored` says which rows do not count, and why.
    """

    counting: dict[Key, Mark]
    comments: dict[Key, Mark]
    newest: dict[Key, Mark]
    ignored: list[str]

    def add(self, key: Key, rows: Sequence[Mark]) -> None:
        """Add all rows of a student's criterion, in the order of files; raises InputError if they have no order."""
        newest, counting = _newest(rows), _newest([mark for mark in rows if mark.value] or rows)
        self.newest[key] = newest
        if counting.value not in ("", WITHDRAWN):
            self.counting[key] = counting._replace(comment=newest.comment)
        elif not newest.value:
            self.comments[key] = newest

    def next_time(self, key: Key) -> str:
        """Return the time for a new mark: now, or later, so that it counts. Raises InputError if none would."""
        before, now = self.newest.get(key), datetime.now(UTC)
        if before is None:
            return utc_text(now)
        if not before.time:
            raise InputError(f"{before.place} has no time, so it counts before every new mark: change that row")
        return utc_text(max(now, datetime.fromisoformat(before.time) + timedelta(milliseconds=1)))


def utc_text(time: datetime) -> str:
    """Return a time that no spreadsheet changes, and that sorts as text."""
    return time.astimezone(UTC).isoformat(timespec="milliseconds")


def append_marks(path: Path, marks: Iterable[Mark]) -> None:
    """Append marks to a grader's file; raises InputError as `append_rows` does."""
    append_rows(path, [{**{name: getattr(mark, name) for name in COLUMNS}, "points": mark.value} for mark in marks])


def read_marks(folder: Path, students: Iterable[str], rubric: Rubric) -> Marks:
    """Return the marks in the files of a folder; raises InputError with a line for each row that cannot be read."""
    most, keys = maxima(rubric), dict.fromkeys(students)

    def read(cells: Cells, place: str) -> list[Mark]:
        key = known("student", cells["student"], keys), known("criterion", cells["criterion"], most)
        return [mark_in(cells, key, most[key[1]], place)]

    mistakes: list[str] = []
    return collect(_rows(folder, mistakes), read, mistakes, [])


def collect(rows: Iterable[tuple[str, Cells]], read: Reader, mistakes: list[str], ignored: list[str]) -> Marks:
    """Return the marks in rows, each with its place; raises InputError if there are mistakes."""
    found: dict[Key, list[Mark]] = defaultdict(list)
    marks = Marks({}, {}, {}, ignored)
    for place, cells in rows:
        try:
            for mark in read(cells, place):
                if mark.value or mark.comment:
                    found[mark.student, mark.criterion].append(mark)
        except NotCountedError as error:
            ignored.append(printable(f"{place}: {error}"))
        except InputError as error:
            mistakes.append(f"{place}: {error}")
    for key, those in found.items():
        try:
            marks.add(key, those)
        except InputError as error:
            mistakes.append(str(error))
    if mistakes:
        raise InputError("\n".join(map(printable, first_lines(mistakes, _MAX_MISTAKES))))
    return marks


def _rows(folder: Path, mistakes: list[str]) -> Iterator[tuple[str, Cells]]:
    """Yield the place and the cells of each row of the files in a folder; files that cannot be read are mistakes."""
    for path in sorted(folder.absolute().glob("[!.]*.[cC][sS][vV]")):
        shown = printable_path(Path(folder.name, path.name))
        try:
            data = read_capped(path, SIZE_LIMIT, shown=shown, top=str(path.parent), advice="")
            yield from (row for row in whole_rows(data, shown)[2] if any(map(row[1].get, COLUMNS)))
        except InputError as error:
            mistakes.append(str(error))


def maxima(rubric: Rubric) -> dict[str, Decimal]:
    """Return the most points for each criterion and TOTAL; marks of an adjusted criterion never count: any is valid."""
    most = {row.id: row.points if row.adjustment is None else Decimal(MAX_POINTS) for row in rubric.criteria}
    return {**most, TOTAL: sum((row.points for row in rubric.criteria), Decimal(0)), DEADLINE: Decimal(0)}


def mark_in(cells: Cells, key: Key, most: Decimal, place: str) -> Mark:
    """Return the mark in a row; raises InputError, or NotCountedError."""
    value, submission = cells["points"], cells["submission"]
    if cells[SURPLUS]:
        raise InputError(f"{quoted(cells[SURPLUS])} is in no column: a cell that contains a delimiter needs quotes")
    if submission and not _DIGEST.fullmatch(submission):
        raise InputError(f"{quoted(submission)} is not the digest of a submission")
    if value.casefold() == EXCUSED and key[1] == TOTAL:
        value = EXCUSED
    elif value not in ("", WITHDRAWN) and key[1] == DEADLINE:
        read_time(value)
    elif value not in ("", WITHDRAWN):
        value = format_points(read_points(value, key[1], most))
    return Mark(_time(cells["time"]), cells["by"], *key, value, cells["comment"], submission, place)


def _time(text: str) -> str:
    with suppress(ValueError, OverflowError):
        if not text or ((time := datetime.fromisoformat(text)).tzinfo is not None and time.year < MAXYEAR):
            return utc_text(time) if text else ""
    raise InputError(f"{quoted(text)} is not a time: write it as 2026-11-23T14:05:09.123+00:00, or leave it empty")


def _newest(rows: Sequence[Mark]) -> Mark:
    """Return the newest of some rows; raises InputError if two that differ are."""
    time = max((not mark.time, mark.time) for mark in rows)[1]
    tied = [mark for mark in rows if mark.time == time]
    by_file = {mark.place.rpartition(":")[0] if time else mark.place: mark for mark in tied}
    first, *others = {mark._replace(place=""): mark for mark in by_file.values()}.values()
    if others:
        what = f"two marks of {first.criterion} for {first.student}"
        when = f"at the same time, {time}" if time else "without a time"
        raise InputError(f"{first.place} and {others[0].place}: {what} {when}: remove one of them")
    return first
