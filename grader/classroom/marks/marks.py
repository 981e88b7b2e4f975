"""The marks of people: the rows of the CSV files in a folder.

Here it is also decided which of them counts for a student and criterion.

The latest time counts, of equal times in one file the later row. A row without a time is newer than
all with one. Different rows that have no order are refused; equal rows are one. A comment without
points changes only the comment.

People and spreadsheets write the files, too: a file keeps its delimiter, decimal sign, encoding,
line ends, order of columns and further columns. It is locked only while rows are appended.
"""

import os
import re
import sys
import unicodedata
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from datetime import MAXYEAR, UTC, datetime, timedelta
from decimal import Decimal
from getpass import getuser
from itertools import zip_longest
from pathlib import Path
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.grouping import Strings, StringsByName
from grader.base.names import folded
from grader.base.patterns import on_use
from grader.base.text import (
    enumerated,
    first_lines,
    format_points,
    printable,
    printable_path,
    quoted,
)
from grader.classroom.marks.gradebook_folder import lock
from grader.classroom.roster.lateness import read_time
from grader.classroom.roster.typed_names import NotCountedError, known, number_in, read_points
from grader.classroom.tables import SIZE_LIMIT, Table, TableRow, protected, read_table, unprotected
from grader.files.reading import hash_bytes, read_capped
from grader.lab.rubric.criterion import DEADLINE, GRADE, TOTAL
from grader.lab.rubric.keys import MAX_POINTS
from grader.lab.rubric.rubric import Rubric

EXCUSED = "excused"  # in place of points, for GRADE
COLUMNS = ("time", "by", "student", "criterion", "points", "comment", "submission")
Cells = StringsByName  # of a row, by column
_Rows = list[tuple[str, Cells]]  # the place of each row, file and line, and its cells
_TITLES = {*COLUMNS, "answer", "exported", "id"}  # known in any spelling
SURPLUS = ""  # in place of a title: the cells that have none
WITHDRAWN = "-"  # in place of points: no formula
_FLAGS = (
    os.O_RDWR | os.O_APPEND | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
)
_SAFE = on_use(r"(?!(?:con|prn|aux|nul|com\d|lpt\d)$)[a-z0-9_]{1,40}")  # no device of Windows
_DIGEST = on_use(r"d[0-9a-f]+")
_MAX_MISTAKES = 20


Key = tuple[str, str]  # a student and a criterion
_ReadTable = tuple[Table, Strings, _Rows]  # with the titles of its columns, and its rows


class Mark(NamedTuple):
    """A row: what a grader gave for a criterion or for GRADE, or a student's DEADLINE."""

    time: str  # in UTC, or empty
    by: str
    student: str
    criterion: str
    value: str = ""  # the points, EXCUSED, WITHDRAWN or a time; empty for a comment alone
    comment: str = ""
    submission: str = ""  # the digest of what was marked, or empty
    place: str = ""  # the file and line

    @property
    def points(self) -> Decimal | None:
        """The points; None for another value."""
        if self.criterion != DEADLINE:
            return number_in(self.value)
        return None


_MarkByKey = dict[Key, Mark]


_Reader = Callable[[Cells, str], Iterable[Mark]]  # of the marks in the cells of a row, at a place


class Marks(NamedTuple):
    """The marks of a class."""

    counting: _MarkByKey  # those that count
    comments: _MarkByKey  # the newest row where no mark counts
    newest: _MarkByKey  # the newest rows of any kind
    ignored: list[str]  # which rows do not count, and why

    def add(self, key: Key, rows: Sequence[Mark]) -> None:
        """Add all rows of a student's criterion, in the order of files.

        Raises InputError if they have no order.
        """
        newest = _newest(rows)
        counting = _newest([mark for mark in rows if mark.value] or rows)
        self.newest[key] = newest
        if counting.value not in ("", WITHDRAWN):
            self.counting[key] = counting._replace(comment=newest.comment)
        elif not newest.value:
            self.comments[key] = newest

    def next_time(self, key: Key) -> str:
        """Return the time for a new mark: now, or later, so that it counts.

        Raises InputError if none would.
        """
        before = self.newest.get(key)
        now = datetime.now(UTC)
        if not before:
            return _utc_text(now)
        if not before.time:
            raise InputError(
                f"{before.place} has no time, so it counts before every new mark: change that row"
            )
        return _utc_text(max(now, datetime.fromisoformat(before.time) + timedelta(milliseconds=1)))


def _utc_text(time: datetime) -> str:
    """Return a time that no spreadsheet changes, and that sorts as text."""
    return time.astimezone(UTC).isoformat(timespec="milliseconds")


def append_marks(path: Path, marks: Iterable[Mark]) -> None:
    """Append marks to a grader's file; raises InputError as `_append_rows` does."""
    rows = []
    for mark in marks:
        row = {name: getattr(mark, name) for name in COLUMNS}
        rows.append({**row, "points": mark.value})
    _append_rows(path, rows)


def read_marks(folder: Path, students: Iterable[str], rubric: Rubric) -> Marks:
    """Return the marks in the files of a folder.

    Raises InputError with a line for each row that cannot be read.
    """
    most = maxima(rubric)
    keys = dict.fromkeys(students)

    def read(cells: Cells, place: str) -> list[Mark]:
        student = known("student", cells["student"], keys)
        key = student, known("criterion", marked_name(cells["criterion"]), most)
        return [mark_in(cells, key, most[key[1]], place)]

    mistakes: list[str] = []
    return collect(_rows_in_folder(folder, mistakes), read, mistakes, [])


def collect(
    rows: Iterable[tuple[str, Cells]], read: _Reader, mistakes: list[str], ignored: list[str]
) -> Marks:
    """Return the marks in rows, each with its place; raises InputError if there are mistakes."""
    marks_by_key = defaultdict(list)
    marks = Marks({}, {}, {}, ignored)
    for place, cells in rows:
        try:
            for mark in read(cells, place):
                if mark.value or mark.comment:
                    marks_by_key[mark.student, mark.criterion].append(mark)
        except NotCountedError as error:
            ignored.append(printable(f"{place}: {error}"))
        except InputError as error:
            mistakes.append(f"{place}: {error}")
    for key, those in marks_by_key.items():
        try:
            marks.add(key, those)
        except InputError as error:
            mistakes.append(str(error))
    if mistakes:
        raise InputError("\n".join(map(printable, first_lines(mistakes, _MAX_MISTAKES))))
    return marks


def _rows_in_folder(folder: Path, mistakes: list[str]) -> Iterator[tuple[str, Cells]]:
    """Yield the place and the cells of each row of the files in a folder.

    Files that cannot be read are mistakes.
    """
    for path in sorted(folder.absolute().glob("[!.]*.[cC][sS][vV]")):
        shown = printable_path(Path(folder.name, path.name))
        try:
            data = read_capped(path, SIZE_LIMIT, shown=shown, top=str(path.parent), advice="")
            yield from (row for row in _whole_rows(data, shown)[2] if any(map(row[1].get, COLUMNS)))
        except InputError as error:
            mistakes.append(str(error))


def marked_name(text: str) -> str:
    """Return what a mark is for: a criterion, GRADE or DEADLINE."""
    return GRADE if text.strip().casefold() == TOTAL else text


def maxima(rubric: Rubric) -> dict[str, Decimal]:
    """Return the most points for each criterion and GRADE.

    Marks of an adjusted criterion never count: any is valid.
    """
    most = {
        row.id: row.points if not row.adjustment else Decimal(MAX_POINTS) for row in rubric.criteria
    }
    return {
        **most,
        GRADE: sum((row.points for row in rubric.criteria), Decimal(0)),
        DEADLINE: Decimal(0),
    }


def mark_in(cells: Cells, key: Key, most: Decimal, place: str) -> Mark:
    """Return the mark in a row; raises InputError, or NotCountedError."""
    value = cells["points"]
    submission = cells["submission"]
    if cells[SURPLUS]:
        raise InputError(
            f"{quoted(cells[SURPLUS])} is in no column: a cell that contains a delimiter "
            "needs quotes"
        )
    if submission and not _DIGEST.fullmatch(submission):
        raise InputError(f"{quoted(submission)} is not the digest of a submission")
    if value.casefold() == EXCUSED and key[1] == GRADE:
        value = EXCUSED
    elif value not in ("", WITHDRAWN) and key[1] == DEADLINE:
        read_time(value)
    elif value not in ("", WITHDRAWN):
        value = format_points(read_points(value, key[1], most))
    return Mark(_time(cells["time"]), cells["by"], *key, value, cells["comment"], submission, place)


def _time(text: str) -> str:
    with suppress(ValueError, OverflowError):
        if not text or (
            (time := datetime.fromisoformat(text)).tzinfo is not None and time.year < MAXYEAR
        ):
            return _utc_text(time) if text else ""
    raise InputError(
        f"{quoted(text)} is not a time: write it as 2026-11-23T14:05:09.123+00:00, or leave "
        "it empty"
    )


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


def read_rows(data: bytes, shown: str) -> _ReadTable:
    """Return a CSV file, the titles of its columns, and its rows.

    Raises InputError if two columns have one title.
    """
    table = read_table(data, shown, is_from_person=True)
    header, *lines = table.filled or [TableRow(1, 1, (), "")]
    titles = []
    for title in header.values:
        name = folded(title)
        titles.append(name if name in _TITLES else title.strip())
    for title, count in Counter(titles).items():
        if title and count > 1:
            raise InputError(f"{shown} has two columns {title!r}")
    rows = _Rows()
    for line in lines:
        row = dict.fromkeys((*COLUMNS, SURPLUS), "")
        cells = map(_cell_text, line.values)
        for title, cell in zip_longest(titles[: len(line.cells)], cells, fillvalue=SURPLUS):
            row[title] = cell if title else f"{row[SURPLUS]} {cell}".strip()
        rows.append((f"{shown}:{line.line}", row))
    return table, tuple(titles), rows


def _cell_text(cell: str) -> str:
    return unprotected(_with_newlines(cell))


def _with_newlines(text: str) -> str:
    """Return a text without spaces around it, and with the line ends of Unix."""
    return text.replace("\r\n", "\n").replace("\r", "\n").strip()


def _whole_rows(data: bytes, shown: str) -> _ReadTable:
    """Return the rows of a file of marks; raises InputError if the last mark in it may be cut.

    The last row may be cut where it has no line break: it is refused (12.5 cut to 12 is a wrong
    mark), unless its last cell is the digest, which is not used then, or one of a person's own
    column.
    """
    table, titles, rows = read_rows(data, shown)
    has_needed = {"student", "criterion"} <= {*titles} and {"points", "comment"} & {*titles}
    if titles and not has_needed:
        raise InputError(f"the first line of {shown} must name the columns {enumerated(COLUMNS)}")
    last = table.rows[-1] if table.rows else None
    if not last or last.end or last not in table.filled:
        return table, titles, rows
    is_whole = rows and len(last.cells) == len(titles) and titles[-1] not in COLUMNS[:-1]
    if not is_whole or table.encoding == "windows-1252":
        where = f"{shown}:{last.line}"
        raise InputError(
            f"{where}: the last row may be incomplete: check it, and end it with a line break"
        )
    if titles[-1] == COLUMNS[-1]:
        place, cells = rows[-1]
        rows[-1] = place, {**cells, titles[-1]: ""}
    return table, titles, rows


def _append_rows(path: Path, rows: Sequence[StringsByName]) -> None:
    """Append rows to a file of marks, all or none, and wait until they are on the disk.

    Make the file if necessary.

    Raises InputError if the file cannot be written, lacks a column, or may be cut at its end.
    """
    shown = printable_path(Path(path.parent.name, path.name))
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        with os.fdopen(os.open(path, _FLAGS, 0o600), "ab", buffering=0) as file:
            lock(file.fileno())
            if not os.path.samestat(os.fstat(file.fileno()), path.stat()):
                raise InputError(f"another program replaces {shown}: try again")
            before = os.fstat(file.fileno()).st_size
            data = _encoded(read_capped(path, SIZE_LIMIT, shown=shown, advice=""), rows, shown)
            try:
                while data:  # once, unless the disk is full
                    data = data[file.write(data) :]
                os.fsync(file.fileno())
            except BaseException:
                file.truncate(before)
                raise
        if not before:
            _sync_folder(path.parent)
    except OSError as error:
        raise InputError(f"cannot write {shown}: {error.strerror}") from None


def _sync_folder(folder: Path) -> None:
    """Wait until the name of a new file is on the disk; Windows opens no folder."""
    if sys.platform != "win32":
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _encoded(data: bytes, rows: Sequence[StringsByName], shown: str) -> bytes:
    """Return what appends rows to a file in its own style.

    It has the header or line break that the file lacks.
    """
    table, titles, old = _whole_rows(data, shown)
    missing = [name for name in COLUMNS if titles and name not in titles]
    if missing:
        raise InputError(f"{shown} has no column {enumerated(missing)}: add it to the first line")
    end = (table.rows[0].end if table.rows else "") or "\n"
    lines = []
    if table.rows and not table.rows[-1].end:
        lines.append("")  # ends the last row
    if not titles:
        lines.append(table.delimiter.join(COLUMNS))
    has_comma = _has_decimal_comma(table, old)
    for row in rows:
        cells = []
        for title in titles or COLUMNS:
            cells.append(table.cell(_new_cell(row, title, has_comma=has_comma)))
        lines.append(table.delimiter.join(cells))
    text = "".join(line + end for line in lines)
    return text.encode(table.encoding, "xmlcharrefreplace")


def _new_cell(row: StringsByName, title: str, *, has_comma: bool) -> str:
    """Return what a cell of a new row says, as no spreadsheet misreads it."""
    text = row.get(title, "")
    if text != WITHDRAWN:
        text = protected(_with_newlines(text))
    if title == "points" and has_comma:
        text = text.replace(".", ",")
    return text


def _has_decimal_comma(table: Table, rows: _Rows) -> bool:
    """Return whether points in a file are written with a comma, as in files with semicolons."""
    points = " ".join(row["points"] for _, row in rows)
    if re.search(r"\d,\d", points):
        return True
    return table.delimiter == ";" and not re.search(r"\d\.\d", points)


def mark_file(folder: Path, by: str) -> Path:
    """Return the file of a grader; without a name, that of the login.

    Its name is valid on every system, and of nobody else, though systems may ignore case.

    Raises InputError if the login has no name, as in a container.
    """
    name = unicodedata.normalize("NFC", by.strip().lower())
    if not name:
        try:
            name = getuser().lower()
        except (OSError, KeyError, ImportError):  # by the version of Python and the system
            raise InputError("this login has no name: name yourself with --by NAME") from None
    if not _SAFE.fullmatch(name):
        digest = hash_bytes(name.encode("utf-8", "surrogateescape"))[:16]
        name = f"{re.sub('[^a-z0-9_]+', '-', name).strip('-')[:40] or '_'}-{digest}"
    return folder / f"{name}.csv"


def is_open_in_libreoffice(path: Path) -> bool:
    """Return whether LibreOffice has a file open, and may replace it: there is its lock."""
    return os.path.lexists(path.with_name(f".~lock.{path.name}#"))
