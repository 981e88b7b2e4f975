"""Plain CSV: a spreadsheet runs none of it, and it reads back as it was."""

import csv
import io
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.tables import neutral, write_table


def read(text: str) -> list[list[str]]:
    return list(csv.reader(io.StringIO(text, newline="")))


@pytest.mark.parametrize(
    "text",
    ["=1+1", "+49 170", "-5", "@SUM(A1)", "\t=1", "\r=1", "\nx", "  =1", "\xa0=1", "＝1", "＋1", "－1", "＠x", "﹦1"],
)
def test_formulas_get_an_apostrophe(text: str) -> None:
    """Text that Excel, LibreOffice or Sheets would run is quoted, in full or half width, also after spaces."""
    assert neutral(text).startswith("'")
    assert write_table(["a"], [[text]]).split("\r\n", 1)[1].lstrip('"').startswith("'")


@pytest.mark.parametrize("text", ["", "Ann", "a=b", "5 - 3", "O'Brien", "שלום", "👩‍🔬", "a; b", "x,y", "3 <= 4; 5"])
def test_plain_text_stays(text: str) -> None:
    """Text that starts no formula is unchanged."""
    assert neutral(text) == text


def test_formulas_after_a_separator() -> None:
    """A cell that a semicolon-separated spreadsheet would start within a text starts no formula either."""
    assert neutral("a;=1+1") == "a;'=1+1"
    assert neutral("a\n  @x") == "a\n  '@x"


def test_numbers_stay_numbers() -> None:
    """Points, negative ones too, have no apostrophe and no exponent; None is an empty cell."""
    table = write_table(
        ["who", "points"],
        [["Ann", Decimal("58.5000")], ["Bob", Decimal(-5)], ["Cem", Decimal("1E+2")], ["Dee", None], ["Eve", 3]],
    )
    assert table == "who,points\r\nAnn,58.5\r\nBob,-5\r\nCem,100\r\nDee,\r\nEve,3\r\n"


def test_headers_are_neutralised() -> None:
    """A header that would be a formula is quoted."""
    assert write_table(["=1"], []) == "'=1\r\n"


def test_characters_that_csv_cannot_hold_are_escaped() -> None:
    """NUL, lone surrogates, controls and bidirectional marks are escaped."""
    assert write_table(["a"], [["x\0y\ud800z\x1b\u202e"]]) == "a\r\nx\\x00y\\xd800z\\x1b\\x202e\r\n"


@given(st.lists(st.lists(st.text(max_size=8), min_size=1, max_size=4), max_size=4))
def test_any_text_survives(rows: list[list[str]]) -> None:
    """Any text can be written as UTF-8, reads back as `neutral` returns it, and starts no formula."""
    text = write_table(["a", "b"], rows)
    text.encode("utf-8")
    found = read(text)[1:]
    assert found == [[neutral(cell) for cell in row] for row in rows]
    assert not any(cell.lstrip().startswith(tuple("=+-@＝＋－＠")) for row in found for cell in row)


@given(st.text(max_size=20))
def test_neutral_is_idempotent(text: str) -> None:
    """A neutralised text is not changed again."""
    assert neutral(neutral(text)) == neutral(text)
