"""grader stats: a class at a glance, for people at any terminal and for programs."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.run_writer import save_student
from grader.classroom.gradebook.stored import Enrolment
from grader.classroom.students import Student
from tests.classroom.gradebooks import graded_as, grader, lab, record_run, refusal


def stats(path: Path, *more: object, **variables: str) -> str:
    """Return the output for a gradebook."""
    done = grader("stats", "--gradebook", path, *more, **variables)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def as_json(path: Path) -> dict[str, Any]:
    """Return the same as JSON, valid under its schema."""
    data = json.loads(stats(path, "--format", "json"))
    jsonschema.validate(data, json.loads(grader("schema", "class").stdout))
    return dict(data)


def test_an_empty_gradebook(tmp_path: Path) -> None:
    """A gradebook without results is reported in a line."""
    book = tmp_path / "book.db"
    Gradebook(book, create=True).close()
    why = f"nothing has been graded into {book} yet: run `grader batch PATH --gradebook {book}`"
    assert refusal(grader("stats", "--gradebook", book)) == why


@pytest.mark.parametrize("signs", [{}, {"anna": "pps?f"}, {"anna": "?!p!?"}])
def test_few_or_none(signs: dict[str, str], tmp_path: Path) -> None:
    """A run without submissions, of one student, and with only unreadable submissions."""
    rubric = lab()
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, rubric, [graded_as(rubric, key, row) for key, row in signs.items()])
    text = stats(tmp_path / "book.db")
    data = as_json(tmp_path / "book.db")
    assert len(data["students"]) == len(signs)
    grades = (
        "Grades out of 11 (scaled up from the points that need no manual grading): mean 8.6, standard deviation 0.0"
    )
    assert (grades in " ".join(text.split())) == ("pps?f" in signs.values())
    assert ("no students" in text) == (not signs)
    assert grader("export", "csv", "--gradebook", tmp_path / "book.db").stdout.count("\n") == 1 + len(signs)


def sections(path: Path) -> None:
    """Write a gradebook with the sections A (two graded, one late) and B (one graded, one missing), and a student without a section."""
    rubric = lab("due = 2026-09-10T12:00:00Z\npercent_per_day = 10")
    enrolled = {
        "ash": ("A", "ppppp", 0),
        "birch": ("A", "pfspp", 2),
        "cedar": ("B", "pppff", 0),
        "fir": ("", "ffff?", 0),
    }
    with Gradebook(path, create=True) as book:
        run = record_run(book, rubric, [graded_as(rubric, key, signs) for key, (_, signs, _) in enrolled.items()])
        assert run == 1
        with book.transaction():
            for key, (section, _, late) in {**enrolled, "elm": ("B", "", 0)}.items():
                enrolment = Enrolment(1, days_late=late, section=section, marker="Kim" if section == "A" else "Lee")
                save_student(book, Student(key), enrolment)


def test_sections_side_by_side(tmp_path: Path) -> None:
    """Students, grades, lateness, and the criteria that differ most between named sections."""
    sections(tmp_path / "book.db")
    lines = stats(tmp_path / "book.db", "--compare", "section").splitlines()
    assert lines[:5] == [
        "Grades out of 11 (scaled up from the points that need no manual grading)",
        "section       students  graded  mean  median  late  late penalty",
        "(no section)         1       1   0.0     0.0     0             0",
        "A                    2       2   9.5     9.5     1           2.2",
        "B                    2       1   6.0     6.0     0             0",
    ]
    assert lines[8:] == [
        "Criteria that differ most: mean share of the points earned",
        "  essay (4): (no section) 0%, A 100%, B 0%",
        "  picture (1): A 100%, B 0%",
        "  box (2.5): (no section) 0%, A 50%, B 100%",
        "  tall (0.5): (no section) 0%, A 50%, B 100%",
    ]


@pytest.mark.parametrize("entry", ["3", "--excused"])
def test_final_marks_and_excuses_are_not_late(tmp_path: Path, entry: str) -> None:
    """They lose nothing, so neither the class nor its sections count them."""
    book = tmp_path / "book.db"
    sections(book)
    assert "1 submission late: 2.2 points lost" in grader("stats", "--gradebook", book).stdout
    assert grader("mark", "birch", "total", entry, "--gradebook", book).returncode == 0
    assert " late: " not in grader("stats", "--gradebook", book).stdout
    (section,) = (line for line in stats(book, "--compare", "section").splitlines() if line.startswith("A "))
    assert section.split()[-2:] == ["0", "0"]


def test_sections_in_json(tmp_path: Path) -> None:
    """The comparison is added to the data of the class, which are otherwise the same."""
    sections(tmp_path / "book.db")
    book = ("--gradebook", tmp_path / "book.db", "--format", "json")
    plain, data = (json.loads(grader("stats", *more, *book).stdout) for more in ((), ("--compare", "marker")))
    jsonschema.validate(data, json.loads(grader("schema", "class").stdout))
    comparison = data.pop("comparison")
    assert data == plain
    assert comparison["by"] == "marker"
    assert [(group["name"], group["students"], group["graded"], group["mean"]) for group in comparison["groups"]] == [
        ("Kim", 2, 2, 9.5),
        ("Lee", 3, 2, 3),
    ]
    assert comparison["groups"][0]["late_points"] == 2.2
    assert comparison["groups"][0]["shares"]["box"] == 0.5
    assert comparison["differing"][0] == "essay"
