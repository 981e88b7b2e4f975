"""A CSV file kept as it was written, so that one cell can be changed and every other byte stays.

Values are those that Python's csv module reads; what it does not refuse (an open quote) is refused here.
"""

import codecs
import re
from dataclasses import dataclass, replace
from functools import cache

from grader.errors import InputError
from grader.files.reading import capped

SIZE_LIMIT = 16 * 1024 * 1024  # bytes
ROW_LIMIT = 100_000
CELL_LIMIT = 1_000_000
DELIMITERS = ",;\t"
_BOMS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell: `raw` as it is written, with its quotes, and the value that it has."""

    raw: str
    value: str


@dataclass(frozen=True, slots=True)
class TableRow:
    """One row: `number` is 1 for the first, `end` the line break behind it. A blank line has no cells."""

    number: int
    cells: tuple[Cell, ...]
    end: str

    def value(self, column: int | None) -> str:
        """What stands in a column without the spaces around it; empty where the row is shorter or no column is meant."""
        return self.cells[column].value.strip() if column is not None and column < len(self.cells) else ""


@dataclass(frozen=True, slots=True)
class Table:
    """A CSV file: its rows, and what is needed to write them back byte for byte."""

    rows: tuple[TableRow, ...]
    delimiter: str
    encoding: str
    bom: bytes

    def encoded(self) -> bytes:
        """The file's bytes. What the encoding lacks, in a cell that was changed, becomes an HTML character reference."""
        text = "".join(self.delimiter.join(cell.raw for cell in row.cells) + row.end for row in self.rows)
        return self.bom + text.encode(self.encoding, "xmlcharrefreplace")

    def changed(self, row: TableRow, column: int, value: str) -> TableRow:
        """A row with another value in one cell, in quotes where the old one was, or where it has to be."""
        quoted = row.cells[column].raw.startswith('"') or re.search(rf'[{self.delimiter};\t"\r\n]|^\s|\s$', value)
        raw = '"' + value.replace('"', '""') + '"' if quoted else value
        return replace(row, cells=(*row.cells[:column], Cell(raw, value), *row.cells[column + 1 :]))


def read_table(data: bytes, shown: str) -> Table:
    """The rows of a CSV file; `shown` is what messages call it.

    UTF-8, UTF-16 with its mark, or Windows-1252 where it is no UTF-8. The delimiter is the first comma, semicolon or tab that
    stands outside quotes. Raises InputError, in one sentence, for a file that is too large or no CSV.
    """
    capped(data, SIZE_LIMIT, shown, "")
    bom, encoding, text = _decoded(data, shown)
    if "\0" in text:
        raise InputError(f"{shown} is not a CSV file: it has a NUL character in it")
    delimiter = _delimiter(text)
    return Table(_rows(text, delimiter, shown), delimiter, encoding, bom)


def _decoded(data: bytes, shown: str) -> tuple[bytes, str, str]:
    bom, encoding = next((each for each in _BOMS if data.startswith(each[0])), (b"", ""))
    for candidate in (encoding,) if encoding else ("utf-8", "windows-1252"):
        try:
            return bom, candidate, data[len(bom) :].decode(candidate)
        except UnicodeDecodeError:
            continue
    raise InputError(f"{shown} is no text in {encoding or 'UTF-8 or Windows-1252'}: export it again, as CSV in UTF-8")


def _delimiter(text: str) -> str:
    found = re.match(rf'(?:"(?:[^"]++|"")*+"|[^"{DELIMITERS}])*+([{DELIMITERS}])', text)
    return found[1] if found else ","


@cache
def _cell(delimiter: str) -> re.Pattern[str]:
    # Possessive, so that an open quote is a miss and costs one pass. Behind a closing quote csv reads on as plain text.
    return re.compile(rf'"((?:[^"]++|"")*+)"([^{delimiter}\r\n]*+)|((?!")[^{delimiter}\r\n]*+)')


def _rows(text: str, delimiter: str, shown: str) -> tuple[TableRow, ...]:
    pattern, at, count = _cell(delimiter), 0, 0
    rows: list[TableRow] = []
    cells: list[Cell] = []
    while at < len(text):
        if not cells and len(rows) >= ROW_LIMIT:
            raise InputError(f"{shown} has more than {ROW_LIMIT} rows, the limit")
        found = pattern.match(text, at)
        if found is None:
            raise InputError(f"{shown} is not a CSV file: a quotation mark in row {len(rows) + 1} is never closed")
        cells.append(_cell_of(found))
        count += 1
        if count > CELL_LIMIT:
            raise InputError(f"{shown} has more than {CELL_LIMIT} cells, the limit")
        at = found.end()
        if text[at : at + 1] == delimiter:
            at += 1
            if at < len(text):
                continue
            cells.append(Cell("", ""))  # the text ends behind a delimiter
        end = "\r\n" if text.startswith("\r\n", at) else text[at : at + 1]
        at += len(end)
        is_blank = len(cells) == 1 and not cells[0].raw
        rows.append(TableRow(len(rows) + 1, () if is_blank else tuple(cells), end))
        cells = []
    return tuple(rows)


def _cell_of(found: re.Match[str]) -> Cell:
    raw: str = found[0]
    if found[1] is None:
        return Cell(raw, raw)
    return Cell(raw, found[1].replace('""', '"') + found[2])
