"""Plain CSV for people: read by any spreadsheet, and nothing in it that one would run.

What starts a formula is after OWASP's page on CSV injection: = + - @, a tab, a line break, the full-width forms of the four;
also behind spaces. A spreadsheet whose separator is a semicolon begins a cell behind each one, quotes or none.
"""

import csv
import io
import re
import unicodedata
from collections.abc import Iterable, Sequence
from decimal import Decimal

_TRIGGERS = "=+\\-@\uff1d\uff0b\uff0d\uff20\ufe66\ufe62\ufe63\ufe6b"  # the last four are the small forms
_AT_START = re.compile(rf"\s*[{_TRIGGERS}]|[\t\r\n]")
FORMULA_BEHIND_SEMICOLON = re.compile(rf"(?<=;)\s*+[{_TRIGGERS}\s]*+")
_INSIDE = re.compile(rf"([;\t\r\n]\s*+)(?=[{_TRIGGERS}])")

CellValue = str | int | Decimal | None


def write_table(header: Sequence[str], rows: Iterable[Sequence[CellValue]]) -> str:
    """A table as CSV: commas, CRLF, quotes where they are needed. Numbers stay numbers, None is an empty cell."""
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow([neutral(each) for each in header])
    writer.writerows([_cell(each) for each in row] for row in rows)
    return text.getvalue()


def rows_of_table(text: str) -> list[list[str]]:
    """The rows below the header of a table that `write_table` has made."""
    return list(csv.reader(io.StringIO(text, newline="")))[1:]


def neutral(text: str) -> str:
    """Text that no spreadsheet takes for a formula: an apostrophe goes before what would start one."""
    safe = _INSIDE.sub(r"\1'", spelt_out(text))
    return f"'{safe}" if _AT_START.match(safe) else safe


def spelt_out(text: str) -> str:
    """Text with everything spelt out that CSV or UTF-8 cannot hold, or that turns the line around: controls, lone surrogates."""
    return "".join(f"\\x{ord(each):02x}" if _is_unspeakable(each) else each for each in text)


def _is_unspeakable(character: str) -> bool:
    kind = unicodedata.category(character)
    return (
        kind == "Cs" or (kind == "Cc" and character not in "\t\r\n") or unicodedata.bidirectional(character) in _TURNS
    )


_TURNS = frozenset({"LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI"})


def _cell(value: CellValue) -> str:
    match value:
        case None:
            return ""
        case Decimal():
            return format(value.normalize(), "f") if value else "0"
        case int():
            return str(value)
        case str():
            return neutral(value)
