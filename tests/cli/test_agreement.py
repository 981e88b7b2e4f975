"""grader stats: the agreement of two graders, in the terminal and as JSON."""

import json
from pathlib import Path
from typing import Any

import jsonschema

from grader.classroom.gradebook.gradebook import Gradebook
from tests.classroom.gradebooks import batch, grader


def mark(top: Path, key: str, points: str, by: str, *more: object, criterion: str = "essay") -> None:
    """Mark a criterion."""
    done = grader("mark", key, criterion, points, "--by", by, "--gradebook", top / "book.db", *more)
    assert done.returncode == 0, done.stderr


def agreement(top: Path) -> dict[str, Any]:
    """Return the agreement as JSON, valid under the schema of a class."""
    data = json.loads(grader("stats", "--gradebook", top / "book.db", "--format", "json").stdout)
    jsonschema.validate(data, json.loads(grader("schema", "class").stdout))
    return dict(data["agreement"])


def test_agreement(top: Path) -> None:
    """Items marked twice, the same points, the mean difference, the largest differences with student and criterion."""
    assert agreement(top) == {"items": 0, "same": 0, "mean_difference_percent": 0, "largest": []}
    assert "Agreement" not in grader("stats", "--gradebook", top / "book.db").stdout
    mark(top, "ben", "2", "Lee", "--second")  # without a first mark there is nothing to compare
    for key, first, second in (("anna", "3", "2"), ("emil", "1.5", "1.5")):
        mark(top, key, first, "Kim")
        mark(top, key, "0", "Lee", "--second")
        mark(top, key, second, "Lee", "--second")  # the newest opinion of each grader counts
    mark(top, "anna", "0", "Max", "--second")
    mark(top, "anna", "1", "Nia", "--second")
    mark(top, "anna", "-", "Nia", "--second")
    assert agreement(top) == {
        "items": 3,
        "same": 1,
        "mean_difference_percent": 33.333333,  # 25, 0 and 75
        "largest": [
            {"id": "anna", "criterion": "essay", "first": 3, "second": 0, "max_points": 4},
            {"id": "anna", "criterion": "essay", "first": 3, "second": 2, "max_points": 4},
        ],
    }
    text = grader("stats", "--gradebook", top / "book.db").stdout
    assert (
        "Agreement of two graders\n"
        "  3 items marked twice, 1 with the same points, mean difference 33.3 % of the\n    maximum\n"
        "  Anna Ek (anna), essay: 3 and 0 of 4 points\n"
        "  Anna Ek (anna), essay: 3 and 2 of 4 points\n"
    ) in text


def test_a_comment_of_the_second_grader_keeps_the_agreement(top: Path) -> None:
    """The points stay those of the first grader; the audit names the one who commented."""
    mark(top, "anna", "3", "Kim")
    mark(top, "anna", "2", "Lee", "--second")
    before = agreement(top)
    commented = ("mark", "anna", "essay", "--comment", "see step 2", "--by", "Lee", "--gradebook", top / "book.db")
    assert grader(*commented).returncode == 0
    assert agreement(top) == before
    assert before["items"] == 1
    with Gradebook(top / "book.db") as book:
        newest = "SELECT points, comment, grader_name, author FROM mark ORDER BY id DESC LIMIT 1"
        assert list(book.rows(newest)) == [(30_000, "see step 2", "Kim", "Lee")]


def test_only_marks_of_the_same_submission_and_of_two_people_are_compared(top: Path) -> None:
    """An opinion on an earlier submission is not compared, nor one of the person whose mark counts later."""
    mark(top, "anna", "3", "Kim")
    mark(top, "anna", "2", "Lee", "--second")
    mark(top, "emil", "1", "Kim")
    mark(top, "emil", "2", "Lee", "--second")
    mark(top, "emil", "2", "Lee")
    (top / "class" / "anna" / "more.txt").write_text("changed")
    assert batch(top).returncode == 0
    assert agreement(top)["items"] == 1
    mark(top, "anna", "4", "Kim")
    assert agreement(top)["items"] == 0
    mark(top, "anna", "1", "Lee", "--second")
    assert agreement(top)["largest"] == [{"id": "anna", "criterion": "essay", "first": 4, "second": 1, "max_points": 4}]
