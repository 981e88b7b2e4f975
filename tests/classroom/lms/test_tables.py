"""CSV edited in place: values as Python's csv reads them, and every byte but those of the changed cell unchanged."""

import csv
import io
from typing import Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.classroom import tables
from grader.classroom.tables import Table, read_table

CELLS = st.text(st.sampled_from("ab ü=é😀א\"\n\r\t,;'\\\u202e\xa0"), max_size=6)
WELL_FORMED = st.lists(st.lists(CELLS, max_size=5), max_size=6)
LOOSE = st.text(st.sampled_from('ab"",;\n\r\t '), max_size=40)


def written(rows: list[list[str]], delimiter: str, end: str, quoting: Literal[0, 1]) -> str:
    text = io.StringIO(newline="")
    csv.writer(text, delimiter=delimiter, lineterminator=end, quoting=quoting).writerows(rows)
    return text.getvalue()


def values(table: Table) -> list[list[str]]:
    return [row.values for row in table.rows]


def by_csv(text: str, delimiter: str) -> list[list[str]]:
    return list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter))


@given(
    WELL_FORMED,
    st.sampled_from(",;\t"),
    st.sampled_from(["\n", "\r\n", "\r"]),
    st.sampled_from([csv.QUOTE_ALL, csv.QUOTE_MINIMAL]),
)
def test_tables_read_as_csv_wrote_them(
    rows: list[list[str]], delimiter: str, end: str, quoting: Literal[0, 1]
) -> None:
    """A header and any cells, in any quoting, have the written values, and encode to the same bytes."""
    text = written([["Student", "ID"], *rows], delimiter, end, quoting)
    table = read_table(text.encode(), "x.csv")
    assert table.delimiter == delimiter
    assert values(table) == by_csv(text, delimiter)
    if quoting == csv.QUOTE_ALL:  # else csv.writer leaves a bare CR without quotes
        assert values(table) == [["Student", "ID"], *rows]
    assert table.encoded() == text.encode()


@given(LOOSE)
def test_any_text_is_read_like_csv_or_refused(text: str) -> None:
    """Odd quotes and mixed line breaks give csv.reader's values and the same bytes; an open quote is refused."""
    try:
        table = read_table(text.encode(), "x.csv")
    except InputError as error:
        assert "never closed" in str(error)
        with pytest.raises(csv.Error):
            list(
                csv.reader(
                    io.StringIO(text, newline=""), delimiter=first_delimiter(text), strict=True
                )
            )
        return
    assert values(table) == by_csv(text, table.delimiter)
    assert table.encoded() == text.encode()


def first_delimiter(text: str) -> str:
    """Return the delimiter of a table of this text with the quote closed."""
    return read_table(text.encode() + b'"', "x.csv").delimiter


@given(WELL_FORMED, st.data(), CELLS)
def test_a_changed_cell_changes_nothing_else(
    rows: list[list[str]], data: st.DataObject, value: str
) -> None:
    """After a change the file has the new value in that one cell; all other cells are the same, byte for byte."""
    table = read_table(
        written([["a", "b"], *rows], ",", "\r\n", csv.QUOTE_MINIMAL).encode(), "x.csv"
    )
    row = data.draw(st.sampled_from([row for row in table.rows if row.cells]))
    column = data.draw(st.integers(0, len(row.cells) - 1))
    changed = table.changed(row, column, value)
    others = [cell for index, cell in enumerate(changed.cells) if index != column]
    assert others == [cell for index, cell in enumerate(row.cells) if index != column]
    after = table._replace(rows=tuple(changed if other is row else other for other in table.rows))
    again = read_table(after.encoded(), "x.csv")
    expected = values(after)
    if changed.cells == ("",):  # one empty cell alone is a blank line
        expected[row.number - 1] = []
    assert values(again) == expected


@pytest.mark.parametrize(
    ("data", "encoding"),
    [
        ("Student,ID\nJörg,1\n".encode(), "utf-8"),
        ("Student,ID\nJörg,1\n".encode("utf-8-sig"), "utf-8"),
        ("Student,ID\nJörg,1\n".encode("utf-16"), "utf-16-le"),
        (b"\xfe\xff" + "Student,ID\nJörg,1\n".encode("utf-16-be"), "utf-16-be"),
        ("Student,ID\nJörg “J” Ødegård,1\n".encode("cp1252"), "windows-1252"),
    ],
)
def test_encodings(data: bytes, encoding: str) -> None:
    """UTF-8 and UTF-16 with a byte-order mark, and Windows-1252, are detected; the mark is not part of the first header."""
    table = read_table(data, "x.csv")
    assert table.encoding == encoding
    assert table.rows[0].value(0) == "Student"
    assert table.rows[1].value(0).startswith("Jörg")
    assert table.encoded() == data


def test_delimiter_outside_quotes() -> None:
    """Commas inside a quoted header, or later in a header without quotes, are no delimiter."""
    assert read_table(b'"a,b";c;d', "x.csv").delimiter == ";"
    assert read_table(b"Student;ID;Lab 6, part 2, again, and again (7)", "x.csv").delimiter == ";"


def test_other_files_are_refused() -> None:
    """A file that is no CSV is refused in one sentence that says what it is."""
    for data, words in [
        (b'a,b\n1,"2', "row 2 is never closed"),
        (b"a,b\n\0,2", "NUL"),
        (
            b"PK\x03\x04 a spreadsheet",
            "is a spreadsheet, not a CSV file: open it and save it as CSV",
        ),
        (b"\xd0\xcf\x11\xe0 an older one", "is a spreadsheet, not a CSV file"),
        ("a,b".encode("utf-32"), "NUL"),
        (b"\xff\xfea", "not text in utf-16-le"),
        (b"a,\x81", "not text in UTF-8 or Windows-1252"),
    ]:
        with pytest.raises(InputError, match=words):
            read_table(data, "x.csv")


def test_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    """A file at a limit is read, and one above it is refused."""
    for name, data in [
        ("SIZE_LIMIT", b"a,b\n"),
        ("_CELL_LIMIT", b"a\n\nc\nd"),
        ("_CELL_LIMIT", b"a,b\nc,d"),
    ]:
        monkeypatch.setattr(tables, name, 4)
        read_table(data, "x.csv")
        monkeypatch.setattr(tables, name, 3)
        with pytest.raises(InputError, match="the limit"):
            read_table(data, "x.csv")
        monkeypatch.undo()


def test_unencodable_characters_become_references() -> None:
    """An emoji in a new cell of a Windows-1252 file is written as an HTML character reference."""
    table = read_table("Name,Text\nJörg,x\n".encode("cp1252"), "x.csv")
    changed = table.changed(table.rows[1], 1, "gut 😀")
    assert table._replace(
        rows=(table.rows[0], changed)
    ).encoded() == "Name,Text\nJörg,gut &#128512;\n".encode("cp1252")


def test_quoting_of_a_changed_cell() -> None:
    """A quoted cell stays quoted; another one is quoted if its new value needs it."""
    table = read_table(b'a,b\n"1",2\n', "x.csv")
    row = table.rows[1]
    assert table.changed(row, 0, "3").cells[0] == '"3"'
    assert table.changed(row, 1, "3").cells[1] == "3"
    assert table.changed(row, 1, "3,5").cells[1] == '"3,5"'
    assert table.changed(row, 1, 'a "b"').cells[1] == '"a ""b"""'
