"""Rosters: a table of CSV files with the students or mistakes in them, and laws that hold for any file."""

import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.classroom.roster.roster import Student, iso_time, plain, read_roster

ROWS: list[dict[str, Any]] = tomllib.loads(
    Path(__file__).with_name("rosters.toml").read_text("utf-8")
)["roster"]


def lines_of(data: bytes) -> list[str]:
    """Return a line for each student with all that is not a default, or the lines of the error."""
    try:
        roster = read_roster(data, "roster.csv")
    except InputError as error:
        return [f"error: {line}" for line in str(error).split("\n")]
    defaults = Student("")._asdict()
    students = [
        {k: v for k, v in one._asdict().items() if v != defaults[k]} for one in roster.students
    ]
    lines = [" ".join(f"{field}={value!r}" for field, value in one.items()) for one in students]
    return [*lines, *(f"note: {note}" for note in roster.notes)]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row["about"])
def test_a_roster_is_read(row: dict[str, Any]) -> None:
    """Every student or mistake of the table is found."""
    assert (
        lines_of(bytes.fromhex(row["hex"]) if "hex" in row else row["text"].encode())
        == row["found"]
    )


def test_of_many_mistakes_the_first_are_listed() -> None:
    """Twenty lines are shown, the others are counted."""
    lines = lines_of(b"id,late\n" + b"".join(b"%d,maybe\n" % number for number in range(50)))
    assert len(lines) == 21 and lines[-1] == "error: ... and 30 more"


@given(st.binary(max_size=300))
def test_any_bytes_give_a_roster_or_lines(data: bytes) -> None:
    """Any bytes are read, or refused with a line for each mistake."""
    for head in (b"id,name\n", b"id,submission,late,status,moodle id,due,extension\n"):
        try:
            students = read_roster(head + data, "roster.csv").students
        except InputError as error:
            assert all(line.isprintable() for line in str(error).split("\n"))
        else:
            assert all(student.key.isprintable() for student in students)
            assert len({student.key for student in students}) == len(students)


@given(st.datetimes())
def test_times(time: object) -> None:
    """A time as Python writes it is read to the second."""
    text = str(time)
    assert iso_time(text) == text[:19].replace(" ", "T")
    assert iso_time(f"{text} UTC") == f"{text[:19].replace(' ', 'T')}Z"
    assert iso_time(text[:10]) == text[:10]
    assert iso_time(f"on {text}") == ""


@given(st.text() | st.text("aB,-_ "), st.text())
def test_normalising_again_changes_nothing(one: str, other: str) -> None:
    """A normalised word is its own; case, separators and the order of `last, first` make no difference."""
    word = plain(one)
    assert not word.isascii() or plain(word.upper()) == word
    assert plain(f"{word}_{plain(other)}") == plain(f"{word} - {plain(other)}")
    assert plain(word) == word
