"""grader mark --import and --missing: the marks of many students by one command."""

import subprocess
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from tests.classroom.gradebooks import grader, refusal


def mark(top: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    """Mark in the class's gradebook."""
    return grader("mark", *arguments, "--gradebook", top / "book.db")


def marks(top: Path) -> list[tuple[Any, ...]]:
    """Return all marks ever given."""
    query = "SELECT key, criterion, kind, points, comment, grader_name FROM mark JOIN student ON student.id = student"
    with Gradebook(top / "book.db") as book:
        return list(book.rows(f"{query} ORDER BY mark.id"))


def imported(top: Path, text: str, *more: object) -> subprocess.CompletedProcess[str]:
    """Import marks in a CSV file."""
    (top / "marks.csv").write_text(text)
    return mark(top, "--import", top / "marks.csv", *more)


# --- --import ---------------------------------------------------------------------------------------------------------


def test_a_file_of_marks(top: Path) -> None:
    """Columns in any order; students by key or name; points, a comment, or both; rows without either are no marks."""
    text = (
        "Comment;Student;Criterion;Points;Group\n"
        "the roots;Anna Ek;essay;3,5;a\n;emil;essay;2;b\nwell shown;emil;picture;;b\n;ben;essay;;b\n;dora;total;0;b\n"
    )
    done = imported(top, text, "--by", "Kim")
    assert (done.returncode, done.stdout, done.stderr) == (
        0,
        f"{top / 'marks.csv'}: 4 recorded, 0 the same as before\n",
        "",
    )
    assert marks(top) == [
        ("anna", "essay", "points", 35_000, "the roots", "Kim"),
        ("emil", "essay", "points", 20_000, "", "Kim"),
        ("emil", "picture", "comment", None, "well shown", "Kim"),
        ("dora", "total", "points", 0, "", "Kim"),
    ]


def test_the_same_file_again_adds_nothing(top: Path) -> None:
    """Only rows that differ from the newest marks are recorded; a comment keeps the points."""
    head = "student,criterion,points,comment\n"
    imported(top, f"{head}anna,essay,3,good\nemil,essay,2,\n")
    before = marks(top)
    again = imported(top, f"{head}anna,essay,3.0,good\nemil,essay,2,\nben,essay,-,\n")
    assert again.stdout.endswith("marks.csv: 0 recorded, 3 the same as before\n")
    assert marks(top) == before
    assert imported(top, f"{head}anna,essay,,better\nemil,essay,-,\n").stdout.endswith(
        ": 2 recorded, 0 the same as before\n"
    )
    assert marks(top)[2:] == [
        ("anna", "essay", "points", 30_000, "better", ""),
        ("emil", "essay", "withdrawn", None, "", ""),
    ]


def test_all_rows_are_checked_before_any_is_recorded(top: Path) -> None:
    """One line for each kind of mistake, with the lines of the file, also after a comment of two lines."""
    text = (
        "student,criterion,points,comment\n"
        'anna,essay,3,"two\nlines"\n'
        "zed,essay,1,\nBen Oh,essay,1,\nanna,esay,1,\ndora,essay,1,\nanna,picture,7,\nemil,essay,x,\nanna,essay,2,\n"
    )
    done = imported(top, text)
    assert (done.returncode, done.stdout) == (2, "")
    start = f"grader: {top / 'marks.csv'}: wrong "
    lines = done.stderr.splitlines()
    assert [line.removeprefix(start).partition(":")[0] for line in lines] == [
        "student in line 4 and 5",
        "criterion in line 6 and 7",
        "points in line 8 and 9",
        "mark in line 10",
    ]
    assert "there is no student 'zed' in the gradebook" in lines[0]
    assert "the rubric small has no criterion 'esay'; did you mean 'essay'?" in lines[1]
    assert lines[2].endswith("picture is worth 0 to 1 points, not 7")
    assert lines[3].endswith("anna, Anna Ek has essay twice")
    assert marks(top) == []


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "must name the columns student, criterion, points and comment"),
        ("id,essay\nanna,3\n", "must name the columns student, criterion, points and comment"),
        ("PK\x03\x04", "is a spreadsheet, not a CSV file: open it and save it as CSV (UTF-8)"),
    ],
)
def test_another_file_is_refused(text: str, why: str, graded_class: Path, tmp_path: Path) -> None:
    """The line says what was expected."""
    (tmp_path / "marks.csv").write_text(text)
    assert why in refusal(mark(graded_class, "--import", tmp_path / "marks.csv"))


# --- --missing --------------------------------------------------------------------------------------------------------


def test_all_without_a_submission(top: Path) -> None:
    """Each is named; a comment that was there stays; a second time nobody is left."""
    mark(top, "dora", "total", "--comment", "ill?")
    done = mark(top, "--missing", "total", "0", "--by", "Kim")
    assert done.stdout == "final mark 0 for 1 student on the roster without a submission\n  dora, Dora Fi\n"
    assert marks(top)[1:] == [("dora", "total", "points", 0, "ill?", "Kim")]
    assert mark(top, "--missing", "total", "0").stdout.startswith("final mark 0 for 0 students")


@pytest.mark.parametrize("given", [("5",), ("--excused",)])
def test_a_final_mark_and_an_excuse_stay(given: tuple[str], top: Path) -> None:
    """They were given by a person."""
    mark(top, "dora", "total", *given)
    before = marks(top)
    assert mark(top, "--missing", "total", "0").stdout.startswith("final mark 0 for 0 students")
    assert marks(top) == before


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("--missing", "essay", "0"), "write it as --missing total POINTS"),
        (("--missing", "total"), "write it as --missing total POINTS"),
        (("--missing", "total", "-"), "write it as --missing total POINTS"),
        (("--missing", "total", "99"), "total is worth 0 to 11 points, not 99"),
        (("--missing", "dora", "total", "0"), "write it as --missing total POINTS"),
        (("--missing", "total", "0", "--excused"), "--excused has no POINTS"),
        (("--missing", "total", "0", "--undo"), "--undo takes no POINTS and no other option but --by"),
        (("--missing", "total", "0", "--second"), "--second is for one criterion, not for the whole submission"),
        (("--missing", "total", "0", "--list-comments"), "--list-comments records nothing: use it alone"),
        (("dora",), "name a STUDENT and a CRITERION"),
        ((), "name a STUDENT and a CRITERION"),
        (("--import", "marks.csv", "dora"), "--import takes no argument and no other option but --by"),
        (("--import", "marks.csv", "--excused"), "--import takes no argument and no other option but --by"),
    ],
)
def test_what_is_refused(arguments: tuple[str, ...], why: str, graded_class: Path) -> None:
    """One plain line, and nothing is recorded."""
    assert refusal(mark(graded_class, *arguments)) == why
    assert marks(graded_class) == []
