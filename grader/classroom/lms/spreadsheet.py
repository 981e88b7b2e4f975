"""Write CSV for any spreadsheet, with nothing in it that one would run as a formula.

What starts a formula is after OWASP's page on CSV injection: = + - @, a tab, a line break, the full-width forms of the four;
also after spaces. A spreadsheet with the semicolon as separator begins a cell after each semicolon, quoted or not.
"""

import csv
import io
import re
from collections.abc import Iterable, Sequence
from decimal import Decimal

from grader.text import format_points

_TRIGGERS = "=+\\-@\uff1d\uff0b\uff0d\uff20\ufe66\ufe62\ufe63\ufe6b"  # the last four are the small forms
_AT_START = re.compile(rf"\s*[{_TRIGGERS}]|[\t\r\n]")
FORMULA_BEHIND_SEMICOLON = re.compile(rf"(?<=;)\s*+[{_TRIGGERS}\s]*+")
_INSIDE = re.compile(rf"([;\t\r\n]\s*+)(?=[{_TRIGGERS}])")

_ESCAPED = re.compile("[\\0-\\x08\\v\\f\\x0e-\\x1f\\x7f-\\x9f\\u202a-\\u202e\\u2066-\\u2069\\ud800-\\udfff]")

CellValue = str | int | Decimal | None


def write_table(header: Sequence[str], rows: Iterable[Sequence[CellValue]]) -> str:
    """Return a table as CSV: commas, CRLF, quotes where necessary. Numbers stay numbers, None is an empty cell."""
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(map(neutral, header))
    writer.writerows(map(_cell, row) for row in rows)
    return text.getvalue()


def rows_of_table(text: str) -> list[list[str]]:
    """Return the rows below the header of a table from `write_table`."""
    return list(csv.reader(io.StringIO(text, newline="")))[1:]


def neutral(text: str) -> str:
    """Return text that no spreadsheet takes for a formula: an apostrophe precedes what would start one."""
    safe = _INSIDE.sub(r"\1'", spelt_out(text))
    return f"'{safe}" if _AT_START.match(safe) else safe


def spelt_out(text: str) -> str:
    """Return text with escapes for controls, lone surrogates and bidirectional marks."""
    return _ESCAPED.sub(lambda found: f"\\x{ord(found[0]):02x}", text)


def _cell(value: CellValue) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return neutral(value)
    return format_points(value) if isinstance(value, Decimal) else str(value)
