"""Rosters in CSV files, and matching names to their students."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.names import iso_time
from grader.classroom.intake.roster import Roster
from grader.classroom.intake.roster_file import read_roster
from grader.errors import InputError


def read(tmp_path: Path, text: str | bytes) -> Roster:
    path = tmp_path / "roster.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_roster(path)


PLAIN = "id,name,email\n100,Ann Ash,ann@example.org\n\n200,Jörg Müller,jm@example.org\n"


def test_a_file_that_cannot_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A missing file and a huge one are errors of one line."""
    with pytest.raises(InputError, match="cannot read"):
        read_roster(tmp_path / "none.csv")
    monkeypatch.setattr("grader.classroom.intake.roster_file.SIZE_LIMIT", 10)
    with pytest.raises(InputError, match=r"larger than 10 bytes, the limit$"):
        read(tmp_path, PLAIN)


@given(st.datetimes())
def test_times(time: object) -> None:
    """A time as Python writes it is read to the second."""
    text = str(time)
    assert iso_time(text) == text[:19].replace(" ", "T")
    assert iso_time(f"{text} UTC") == f"{text[:19].replace(' ', 'T')}Z"
    assert iso_time(text[:10]) == text[:10]
    assert iso_time(f"on {text}") == ""


@given(st.binary(max_size=300))
def test_any_bytes_give_a_roster_or_lines(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    """Any bytes are read, or refused with a line for each mistake."""
    try:
        roster = read(tmp_path_factory.getbasetemp(), b"id,name\n" + data)
    except InputError as error:
        assert all(line.isprintable() for line in str(error).split("\n"))
    else:
        assert all(student.key.isprintable() for student in roster.students)
