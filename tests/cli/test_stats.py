"""grader stats and diff: data that their schemas describe, one definition of grade, and what is refused."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from tests.classroom.gradebooks import batch, grader, make_class, refusal, write_submission


def as_json(schema: str, *command: object) -> dict[str, Any]:
    """Return what a command prints as JSON, valid under its schema."""
    done = grader(*command, "--format", "json")
    assert (done.returncode, done.stderr) == (0, "")
    data: dict[str, Any] = json.loads(done.stdout)
    jsonschema.validate(data, json.loads(grader("schema", schema).stdout))
    return data


@pytest.fixture
def book(tmp_path: Path) -> Path:
    """Return the gradebook of a class of five, of whom two are late and one has submitted nothing."""
    make_class(tmp_path, late="percent_per_day = 10")
    roster = (
        "id,name,section,late\nanna,Anna Ek,A,2\nben,Ben Oh,A,\ncleo,,B,\ndora,,B,\nemil,,B,1\n"
    )
    (tmp_path / "roster.csv").write_text(roster)
    assert batch(tmp_path).returncode == 0
    return tmp_path / "book"


def test_a_grade_is_what_is_published(book: Path) -> None:
    """In mean, bars, sections and late ones: with marks and penalties; without excuses, the missing and visitors."""
    write_submission(book.parent / "class" / "visitor")
    for words in (
        ("anna", "essay", "4"),
        ("ben", "total", "11"),
        ("emil", "total", "excused"),
        ("dora", "total", "1"),
    ):
        assert grader("mark", *words, "--gradebook", book).returncode == 0
    assert batch(book.parent).returncode == 0
    data = as_json("class", "stats", "--gradebook", book)
    found = data["statistics"]
    totals = {one["id"]: one["grade"] for one in data["students"]}
    pending = {row["id"]: row["pending"] for row in found["criteria"]}
    assert (pending["essay"], pending["picture"]) == (0, 1)  # ben's total is final
    assert totals == {"anna": 7.8, "ben": 11, "cleo": None, "dora": 1, "emil": None, "visitor": 6}
    assert found["grades"] == {"students": 3, "mean": 6.6, "median": 7.8}
    assert (found["late"], found["open"], found["tenths"]) == (1, 1, [1, 0, 0, 0, 0, 0, 0, 1, 0, 1])
    assert found["counts"] == {"excused": 1, "graded": 2, "missing": 1, "unreadable": 1}
    assert {name: one["mean"] for name, one in found["sections"].items()} == {"A": 9.4, "B": 1}
    assert [one["id"] for group in data["attention"] for one in group["students"]] == [
        "cleo",
        "visitor",
    ]


def test_a_class_without_a_grade(tmp_path: Path) -> None:
    """One unreadable submission: no mean, and no bars."""
    make_class(tmp_path)
    (tmp_path / "class").rename(tmp_path / "all")
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "cleo.zip").write_bytes(b"PK\x03\x04 broken")
    assert batch(tmp_path).returncode == 0
    assert (
        as_json("class", "stats", "--gradebook", tmp_path / "book")["statistics"]["grades"]["mean"]
        is None
    )
    assert "mean" not in grader("stats", "--gradebook", tmp_path / "book").stdout


def test_differences(book: Path) -> None:
    """Of two gradebooks; a gradebook of one run has none, and one without a run has no statistics."""
    assert "has one run" in refusal(grader("diff", book))
    older = book.rename(book.parent / "older")
    (book.parent / "class" / "anna" / "robot.urdf").unlink()
    assert batch(book.parent).returncode == 0
    [change] = as_json("diff", "diff", older, book)["students"]
    assert (change["id"], change["reasons"][0]) == ("anna", "the submission changed")
    (book / "results.jsonl").unlink()
    assert refusal(grader("stats", "--gradebook", book)).startswith("nothing is graded yet in ")
