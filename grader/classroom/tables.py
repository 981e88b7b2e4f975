"""CSV files.

A cell can change while every other byte stays, and a spreadsheet finds nothing to run as a formula.

An LMS compares the file with what it exported, so nothing else may change. Python's csv module
gives values, but not how they were written (which cells were quoted, the line ends, blank lines):
so rows are split here, into the same values. An open quote, which csv accepts, is an error.

What starts a formula is after OWASP's page on CSV injection: = + - @, a tab, a line break, the
full-width forms of the four; also after spaces. With the semicolon as separator, a cell begins
after each semicolon, quoted or not.
"""

import codecs
import csv
import io
import re
from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.patterns import on_use
from grader.base.text import format_points
from grader.files.reading import capped

SIZE_LIMIT = 16 * 1024 * 1024  # bytes
_CELL_LIMIT = 1_000_000
_DELIMITERS = ",;\t"
_AS_TEXT = on_use(r'\A="(.*)"\Z', re.DOTALL)  # keeps a spreadsheet from reading a text as a number
# Possessive, so that an open quote fails in one pass. After a closing quote csv continues with
# plain text.
_QUOTED = on_use(r'"(?:[^"]++|"")*+"')
_SPREADSHEETS = (
    b"PK\x03\x04",
    b"\xd0\xcf\x11\xe0",
)  # the first bytes of .xlsx and .ods, and of .xls
_BOMS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
# the last four are the small forms
_TRIGGERS = "=+\\-@\uff1d\uff0b\uff0d\uff20\ufe66\ufe62\ufe63\ufe6b"
_FORMULA = on_use(rf"(\A\s*+|;\s*+|(?<!\s)[^\S\t\r\n]*+[\t\r\n]\s*+)('*+[{_TRIGGERS}])")
_PROTECTED = on_use(rf"(\A\s*+|;\s*+|(?<!\s)[^\S\t\r\n]*+[\t\r\n]\s*+)'('*+[{_TRIGGERS}])")
# Control characters but tab and line ends, C1 controls, bidirectional embeddings and isolates,
# surrogates, and the noncharacters of Unicode, which HTML has no reference for.
_NONCHARACTERS = "".join(
    chr(plane << 16 | last) for plane in range(17) for last in (0xFFFE, 0xFFFF)
)
_ESCAPED = on_use(
    "[\\0-\\x08\\v\\f\\x0e-\\x1f\\x7f-\\x9f\\u202a-\\u202e\\u2066-\\u2069\\ud800-\\udfff\\ufdd0-\\ufdef"
    f"{_NONCHARACTERS}]"
)
CellValue = str | int | Decimal | None


class TableRow(NamedTuple):
    """One row of a file."""

    number: int  # from 1
    line: int  # where it begins
    cells: Sequence[str]  # as in the file; a blank line has none
    end: str  # the line break after it

    @property
    def values(self) -> list[str]:
        """The values of the cells, without quotes."""
        return [_unquoted(cell) for cell in self.cells]

    def value(self, column: int | None) -> str:
        """Return the stripped value in a column.

        It is empty if the row is shorter or the column is None.
        """
        if column is not None and column < len(self.cells):
            return _unquoted(self.cells[column]).strip()
        return ""


class Table(NamedTuple):
    """A CSV file: its rows, and what is needed to write them back unchanged."""

    rows: Sequence[TableRow]
    delimiter: str
    encoding: str
    bom: bytes

    @property
    def titles(self) -> Sequence[str]:
        """The cells of the first row, without surrounding spaces."""
        if self.rows:
            return tuple(value.strip() for value in self.rows[0].values)
        return ()

    @property
    def filled(self) -> list[TableRow]:
        """The rows that are not empty, and do not say what the separator is to Excel."""
        return [
            row for row in self.rows if any(map(str.strip, row.values)) and row.value(0) != "sep="
        ]

    def encoded(self) -> bytes:
        """Return the file's bytes.

        A character that the encoding lacks becomes an HTML character reference.
        """
        text = "".join(self.delimiter.join(row.cells) + row.end for row in self.rows)
        return self.bom + text.encode(self.encoding, "xmlcharrefreplace")

    def changed(self, row: TableRow, column: int, value: str) -> TableRow:
        """Return a row with another value in one cell.

        It is quoted if the old one was, or if necessary.
        """
        new = self.cell(value, is_quoted=row.cells[column].startswith('"'))
        return row._replace(cells=(*row.cells[:column], new, *row.cells[column + 1 :]))

    def cell(self, value: str, *, is_quoted: bool = False) -> str:
        """Return a cell with a value, quoted if necessary."""
        is_quoted = (
            is_quoted or re.search(rf'[{self.delimiter};\t"\r\n]|^\s|\s$', value) is not None
        )
        if is_quoted:
            return '"' + value.replace('"', '""') + '"'
        return value


def read_table(data: bytes, shown: str, *, is_from_person: bool = False) -> Table:
    """Return the rows of a CSV file; `shown` is its name in messages.

    It is UTF-8, UTF-16 with a byte order mark, or else Windows-1252. The delimiter is the first
    comma, semicolon or tab outside quotes in the first line, or the most frequent one in the file
    of a person, who may write a comma in a title. Raises InputError for a file that is too large or
    not CSV.
    """
    capped(data, SIZE_LIMIT, shown, "")
    if data.startswith(_SPREADSHEETS):
        raise InputError(
            f"{shown} is a spreadsheet, not a CSV file: open it and save it as CSV (UTF-8)"
        )
    bom, encoding, text = _decode(data, shown)
    if "\0" in text:
        raise InputError(f"{shown} is not a CSV file: it contains a NUL character")
    header = re.match(r'\s*((?:"(?:[^"]++|"")*+"|[^"\r\n])*+)', text)
    delimiters = re.findall(
        f"[{_DELIMITERS}]", re.sub(r'"[^"]*"', "", header[1] if header else "")
    ) or [","]
    delimiter = (
        max(dict.fromkeys(delimiters), key=delimiters.count) if is_from_person else delimiters[0]
    )
    return Table(_split_rows(text, delimiter, shown), delimiter, encoding, bom)


def rows_with_lines(data: bytes, shown: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the line where each row of a person's file begins, and its cells, spaces normalised."""
    for row in read_table(data, shown, is_from_person=True).filled:
        yield (
            row.line,
            [" ".join(_AS_TEXT.sub(r"\1", value.strip()).split()) for value in row.values],
        )


def _decode(data: bytes, shown: str) -> tuple[bytes, str, str]:
    bom, encoding = next((pair for pair in _BOMS if data.startswith(pair[0])), (b"", ""))
    for candidate in (encoding,) if encoding else ("utf-8", "windows-1252"):
        try:
            return bom, candidate, data[len(bom) :].decode(candidate)
        except UnicodeDecodeError:
            continue
    raise InputError(
        f"{shown} is not text in {encoding or 'UTF-8 or Windows-1252'}: export it again, as "
        "CSV in UTF-8"
    )


def _unquoted(cell: str) -> str:
    match = _QUOTED.match(cell)
    if not match:
        return cell
    return match[0][1:-1].replace('""', '"') + cell[match.end() :]


def _split_rows(text: str, delimiter: str, shown: str) -> Sequence[TableRow]:
    pattern = re.compile(
        rf'((?:{_QUOTED.pattern}|(?!"))[^{delimiter}\r\n]*+)({delimiter}|\r\n|\r|\n|\Z)'
    )
    at = 0
    line = 1
    count = 0
    rows: list[TableRow] = []
    cells: list[str] = []
    while at < len(text) or cells:  # a text that ends after a delimiter has one more empty cell
        match = pattern.match(text, at)
        if not match:
            raise InputError(
                f"{shown} is not a CSV file: a quotation mark in row {len(rows) + 1} is "
                "never closed"
            )
        cells.append(match[1])
        count += 1
        if count > _CELL_LIMIT:
            raise InputError(f"{shown} has more than {_CELL_LIMIT} cells, the limit")
        at = match.end()
        if match[2] != delimiter:
            rows.append(
                TableRow(len(rows) + 1, line, () if cells == [""] else tuple(cells), match[2])
            )
            line += 1 + sum(len(cell.splitlines()) - 1 for cell in cells if cell[:1] == '"')
            cells = []
    return tuple(rows)


def write_table(header: Sequence[str], rows: Iterable[Sequence[CellValue]]) -> str:
    """Return a table as CSV: commas, CRLF, quotes where necessary.

    Numbers stay numbers, None is an empty cell.
    """
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(map(protected, header))
    writer.writerows(map(_cell_text, row) for row in rows)
    return text.getvalue()


def protected(text: str) -> str:
    """Return text that no spreadsheet takes for a formula.

    `unprotected` returns it unchanged.
    """
    if text.isalnum():
        return text
    return _FORMULA.sub(r"\1'\2", spelt_out(text))


def unprotected(text: str) -> str:
    """Return text without what protects it from a spreadsheet.

    That keeps one from running it, or from reading it as a number.
    """
    if "'" not in text and text[:1] != "=":
        return text
    return _PROTECTED.sub(r"\1\2", _AS_TEXT.sub(r"\1", text))


def spelt_out(text: str) -> str:
    """Return text with escapes for controls, lone surrogates and bidirectional marks."""
    if text.isprintable():
        return text
    return _ESCAPED.sub(lambda match: f"\\x{ord(match[0]):02x}", text)


def _cell_text(value: CellValue) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return protected(value)
    if isinstance(value, Decimal):
        return format_points(value)
    return str(value)
