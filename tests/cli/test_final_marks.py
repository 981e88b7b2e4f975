"""grader mark: final marks, excuses, comments without points, undo, second opinions, and what is refused."""

import subprocess
from decimal import Decimal
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from tests.classroom.gradebooks import batch, grader, refusal


def mark(top: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    """Mark in the class's gradebook."""
    return grader("mark", *arguments, "--gradebook", top / "book.db")


def entries(top: Path) -> list[tuple[str, int | None, str, str]]:
    """Return all entries: kind, points in ten-thousandths, comment, name in reports."""
    with Gradebook(top / "book.db") as book:
        return list(book.rows("SELECT kind, points, comment, grader_name FROM mark ORDER BY id"))


def total(top: Path, key: str) -> tuple[Decimal, bool, str]:
    """Return the total of a student, whether there is an excuse, and why there is no final grade."""
    with Gradebook(top / "book.db") as book:
        grade = Grades(book).find(key)
        return grade.total, grade.is_excused, grade.why_not_final


def test_undo(top: Path) -> None:
    """It adds an entry that repeats the one before the newest, with the name of who gave it; undo of undo is redo."""
    mark(top, "anna", "essay", "--comment", "read again", "--by", "Kim")
    mark(top, "anna", "essay", "3", "--by", "Lee")
    undone = mark(top, "anna", "essay", "--undo", "--by", "Max")
    assert undone.stdout == "anna, Anna Ek: 6 of 11 points; needs manual grading: 5 points\n"
    assert undone.stderr.startswith("grader: this undoes the newest mark of essay: 3 points by Lee at 20")
    assert (
        mark(top, "anna", "essay", "--undo").stdout == "anna, Anna Ek: 9 of 11 points; needs manual grading: 1 point\n"
    )
    comment, points = ("comment", None, "read again", "Kim"), ("points", 30_000, "", "Lee")
    assert entries(top) == [comment, points, comment, points]
    with Gradebook(top / "book.db") as book:
        assert [author for (author,) in book.rows("SELECT author FROM mark ORDER BY id")][:3] == ["Kim", "Lee", "Max"]


def test_undo_of_the_only_mark(top: Path) -> None:
    """It is withdrawn; without a mark there is nothing to undo."""
    assert refusal(mark(top, "dora", "total", "--undo")) == "there is no mark of total to undo for dora"
    mark(top, "dora", "total", "0")
    assert mark(top, "dora", "total", "--undo").stdout == "dora, Dora Fi: no submission\n"
    assert [kind for kind, *_ in entries(top)] == ["points", "withdrawn"]


def test_undo_restores_a_mark_for_an_earlier_submission_as_such(top: Path) -> None:
    """A mark that was given for the submission before stays one that needs a look."""
    mark(top, "anna", "box", "1")
    (top / "class" / "anna" / "more.txt").write_text("changed")
    assert batch(top).returncode == 0
    mark(top, "anna", "box", "2")
    mark(top, "anna", "box", "--undo")
    with Gradebook(top / "book.db") as book:
        assert Grades(book).find("anna").doubtful.older == ("box",)


def test_a_second_opinion_changes_no_grade(top: Path) -> None:
    """It is recorded beside the mark, can be replaced and withdrawn, and its output shows no points of the first."""
    mark(top, "anna", "essay", "3", "--by", "Kim")
    before = total(top, "anna")
    second = mark(top, "anna", "essay", "1", "--second", "--by", "Lee", "--comment", "two roots")
    assert (second.stdout, second.stderr) == ("anna, Anna Ek: second opinion on essay; the grade stays the same\n", "")
    again = mark(top, "anna", "essay", "-", "--second", "--by", "Lee")
    assert again.stderr.startswith("grader: this replaces the newest second opinion of essay: 1 point by Lee at 20")
    assert mark(top, "anna", "essay", "2", "--second", "--by", "Lee").stderr == ""
    assert total(top, "anna") == before
    own = refusal(mark(top, "anna", "essay", "2", "--second", "--by", "Kim"))
    assert own == "the mark of essay is by Kim: a second opinion must be given by another person"
    assert (
        mark(top, "anna", "essay", "--undo").stdout == "anna, Anna Ek: 6 of 11 points; needs manual grading: 5 points\n"
    )


def test_comments_are_numbered(top: Path) -> None:
    """`--list-comments` lists them by first use, also those that no longer count; `#2` repeats one, and says which."""
    assert mark(top, "anna", "essay", "--list-comments").stdout == "no comments yet\n"
    for points, comment in (("1", "one root"), ("2", "two\nroots"), ("3", "one root")):
        mark(top, "anna", "essay", points, "--comment", comment)
    mark(top, "anna", "essay", "3", "--second", "--by", "Lee", "--comment", "blind")
    assert mark(top, "emil", "essay", "--list-comments").stdout == "#1 one root\n#2 two roots\n"
    used = mark(top, "emil", "essay", "2", "--comment", "#2")
    assert used.stderr == "grader: comment #2: two roots\n"
    assert entries(top)[-1][2] == "two\nroots"
    assert refusal(mark(top, "emil", "essay", "2", "--comment", "#3")) == (
        "essay has no comment #3: `grader mark STUDENT essay --list-comments` lists the earlier comments"
    )
    assert mark(top, "emil", "essay", "2", "--comment", "#3 is wrong").returncode == 0


def test_a_repeated_comment_is_printable(top: Path) -> None:
    """Control characters of a stored comment are escaped on the terminal, and kept in the gradebook."""
    mark(top, "anna", "essay", "1", "--comment", "\x1b[31mred\u202e")
    used = mark(top, "emil", "essay", "2", "--comment", "#1")
    assert used.stderr == "grader: comment #1: \\x1b[31mred\\u202e\n"
    assert entries(top)[-1][2] == "\x1b[31mred\u202e"
