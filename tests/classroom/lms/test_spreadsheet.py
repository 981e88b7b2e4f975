"""Plain CSV: a spreadsheet runs none of it, and it reads back as it was."""

import csv
import io
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.tables import CellValue, protected, spelt_out, unprotected, write_table

pytestmark = pytest.mark.slow

TRIGGERS = tuple("=+-@＝＋－＠")


@pytest.mark.parametrize(
    ("text", "safe"),
    [
        ("=1+1", "'=1+1"),
        ("+49 170", "'+49 170"),
        ("-5", "'-5"),
        ("@SUM(A1)", "'@SUM(A1)"),
        ("\t=1", "\t'=1"),
        ("  =1", "  '=1"),
        ("\xa0=1", "\xa0'=1"),
        ("＝1", "'＝1"),
        ("﹦1", "'﹦1"),
        ("a;=1+1", "a;'=1+1"),
        ("a\n  @x", "a\n  '@x"),
        ("'=1", "''=1"),
    ],
)
def test_formulas_get_an_apostrophe(text: str, safe: str) -> None:
    """Text that Excel, LibreOffice or Sheets would run, also after spaces or a semicolon, in full or half width."""
    assert protected(text) == safe
    for table in (write_table(["a"], [[text]]), write_table([text], [["a"]])):
        assert [safe] in csv.reader(io.StringIO(table, newline=""))


@pytest.mark.parametrize(
    "text", ["", "Ann", "a=b", "5 - 3", "O'Brien", "שלום", "👩‍🔬", "a; b", "x,y", "3 <= 4; 5"]
)
def test_plain_text_stays(text: str) -> None:
    """Text that starts no formula is unchanged."""
    assert protected(text) == text


def test_numbers_stay_numbers() -> None:
    """Points, negative ones too, have no apostrophe and no exponent; None is an empty cell; controls are escaped."""
    rows: list[list[CellValue]] = [
        ["Ann", Decimal("58.5000")],
        ["Bob", Decimal(-5)],
        ["Cem", Decimal("1E+2")],
        ["Dee", None],
        ["\0\ud800\x1b\u202e", 3],
    ]
    table = write_table(["who", "points"], rows)
    assert (
        table
        == "who,points\r\nAnn,58.5\r\nBob,-5\r\nCem,100\r\nDee,\r\n\\x00\\xd800\\x1b\\x202e,3\r\n"
    )


@given(st.lists(st.lists(st.text(max_size=8), min_size=1, max_size=4), max_size=4))
def test_any_text_survives(rows: list[list[str]]) -> None:
    """Any text can be written as UTF-8, is the same without the apostrophes, and starts no formula."""
    text = write_table(["a", "b"], rows)
    text.encode("utf-8")
    found = list(csv.reader(io.StringIO(text, newline="")))[1:]
    assert [[unprotected(cell) for cell in row] for row in found] == [
        [spelt_out(cell) for cell in row] for row in rows
    ]
    assert not any(cell.lstrip().startswith(TRIGGERS) for row in found for cell in row)
