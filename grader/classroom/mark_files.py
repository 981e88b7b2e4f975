"""Files of marks as people and spreadsheets write them: their rows as text, and new rows in a file's own style.

A file keeps its delimiter, decimal sign, encoding, line ends, order of columns and further columns. The lock is one of
the operating system on the file itself, and held only while rows are appended.
"""

import os
import re
import sys
import unicodedata
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import zip_longest
from pathlib import Path

from grader.classroom.tables import SIZE_LIMIT, Table, TableRow, protected, read_table, unprotected
from grader.errors import InputError
from grader.files.reading import read_capped, sha256_of
from grader.names import folded
from grader.text import enumerated, printable_path

COLUMNS = ("time", "by", "student", "criterion", "points", "comment", "submission")
Cells = Mapping[str, str]  # of a row, by column
Rows = list[tuple[str, Cells]]  # the place of each row, file and line, and its cells
_TITLES = {*COLUMNS, "answer", "exported", "id"}  # known in any spelling
SURPLUS = ""  # in place of a title: the cells that have none
WITHDRAWN = "-"  # in place of points: no formula
_FLAGS = os.O_RDWR | os.O_APPEND | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
_WINDOWS_LOCK_AT = 1 << 30  # beyond the end of the file: others cannot read what is locked
_SAFE = re.compile(r"(?!(?:con|prn|aux|nul|com\d|lpt\d)$)[a-z0-9_]{1,40}")  # no device of Windows


def read_rows(data: bytes, shown: str) -> tuple[Table, tuple[str, ...], Rows]:
    """Return a CSV file, the titles of its columns, and its rows; raises InputError if two columns have one title."""
    table = read_table(data, shown, is_from_person=True)
    header, *lines = table.filled or [TableRow(1, 1, (), "")]
    titles = tuple(name if (name := folded(title)) in _TITLES else title.strip() for title in header.values)
    if twice := [title for title, count in Counter(filter(None, titles)).items() if count > 1]:
        raise InputError(f"{shown} has two columns {twice[0]!r}")
    rows = Rows()
    for line in lines:
        row = dict.fromkeys((*COLUMNS, SURPLUS), "")
        for title, cell in zip_longest(titles[: len(line.cells)], map(_read, line.values), fillvalue=SURPLUS):
            row[title] = cell if title else f"{row[SURPLUS]} {cell}".strip()
        rows.append((f"{shown}:{line.line}", row))
    return table, titles, rows


def _read(cell: str) -> str:
    return unprotected(_unix(cell))


def _unix(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n").strip()


def whole_rows(data: bytes, shown: str) -> tuple[Table, tuple[str, ...], Rows]:
    """Return the rows of a file of marks; raises InputError if the last mark in it may be cut.

    The last row may be cut where it has no line break: it is refused (12.5 cut to 12 is a wrong mark), unless its last
    cell is the digest, which is not used then, or one of a person's own column.
    """
    table, titles, rows = read_rows(data, shown)
    if titles and not ({"student", "criterion"} <= {*titles} and {"points", "comment"} & {*titles}):
        raise InputError(f"the first line of {shown} must name the columns {enumerated(COLUMNS)}")
    last = table.rows[-1] if table.rows else None
    if last is not None and not last.end and last in table.filled:
        is_whole = rows and len(last.cells) == len(titles) and titles[-1] not in COLUMNS[:-1]
        if not is_whole or table.encoding == "windows-1252":
            where = f"{shown}:{last.line}"
            raise InputError(f"{where}: the last row may be incomplete: check it, and end it with a line break")
        if titles[-1] == COLUMNS[-1]:
            rows[-1] = rows[-1][0], {**rows[-1][1], titles[-1]: ""}
    return table, titles, rows


def append_rows(path: Path, rows: Sequence[Mapping[str, str]]) -> None:
    """Append rows to a file of marks, all or none, and wait until they are on the disk; make the file if necessary.

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


def lock(handle: int, *, wait: bool = True) -> None:
    """Lock an open file until it is closed; raises OSError if another process has locked it, without `wait`."""
    if sys.platform == "win32":
        import msvcrt

        os.lseek(handle, _WINDOWS_LOCK_AT, os.SEEK_SET)
        msvcrt.locking(handle, msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))


def _encoded(data: bytes, rows: Sequence[Mapping[str, str]], shown: str) -> bytes:
    """Return what appends rows to a file in its own style, with the header or line break that it lacks."""
    table, titles, old = whole_rows(data, shown)
    if missing := [name for name in COLUMNS if titles and name not in titles]:
        raise InputError(f"{shown} has no column {enumerated(missing)}: add it to the first line")
    end = (table.rows[0].end if table.rows else "") or "\n"
    text = end if table.rows and not table.rows[-1].end else ""
    text += "" if titles else table.delimiter.join(COLUMNS) + end
    points = " ".join(row["points"] for _, row in old)
    has_comma = bool(re.search(r"\d,\d", points) or (table.delimiter == ";" and not re.search(r"\d\.\d", points)))
    for row in rows:
        texts = {name: value if value == WITHDRAWN else protected(_unix(value)) for name, value in row.items()}
        texts["points"] = texts["points"].replace(".", ",") if has_comma else texts["points"]
        text += table.delimiter.join(table.cell(texts.get(title, "")) for title in titles or COLUMNS) + end
    return text.encode(table.encoding, "xmlcharrefreplace")


def mark_file(folder: Path, by: str) -> Path:
    """Return the file of a grader: valid on every system, and of nobody else, though systems may ignore case."""
    name = unicodedata.normalize("NFC", by.strip().lower())
    if not _SAFE.fullmatch(name):
        digest = sha256_of(name.encode("utf-8", "surrogateescape"))[:16]
        name = f"{re.sub('[^a-z0-9_]+', '-', name).strip('-')[:40] or '_'}-{digest}"
    return folder / f"{name}.csv"


def is_open_in_libreoffice(path: Path) -> bool:
    """Return whether LibreOffice has a file open, and may replace it: there is its lock."""
    return os.path.lexists(path.with_name(f".~lock.{path.name}#"))
