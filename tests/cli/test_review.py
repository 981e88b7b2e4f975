"""grader review: the questions shown, the accepted answers, and that a later review continues."""

import json
import os
import pty
import shutil
import subprocess
import sys
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import ReviewScope, queued_results
from grader.classroom.gradebook.marks import NewerMarkError
from grader.cli.terminal import show_class
from grader.report.screen import Screen
from grader.usecases.review import review as review_class
from grader.usecases.terminal import Terminal
from tests.classroom.gradebooks import ENVIRONMENT, batch, grade_without, grader, lab_text, make_class, mark
from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT


@pytest.fixture
def top(top: Path) -> Path:
    """Return the class of two students with open questions: those of the single URDF are marked."""
    assert review(top, "s\ns\ns\ns\n0\n0\n").stdout.endswith("2 marked, 4 left\n")
    return top


def review(top: Path, typed: str | bytes, *more: object, **variables: str) -> subprocess.CompletedProcess[str]:
    """Review with these input lines."""
    return grader("review", "--gradebook", top / "book.db", "--by", "Kim", *more, stdin=typed, **variables)


def marks(top: Path) -> list[tuple[Any, ...]]:
    """Return all marks: key, criterion, points, comment."""
    query = "SELECT key, criterion, points / 10000.0, comment FROM mark JOIN student ON student = student.id"
    with Gradebook(top / "book.db") as book:
        return list(book.rows(f"{query} WHERE key <> 'ben' ORDER BY mark.id"))


def test_order_of_questions(top: Path) -> None:
    """All essays, then all pictures; unreadable submissions are omitted."""
    done = review(top, "3.5 the roots are missing\n4\n0,5   too small to read  \n1\n")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith("4 marked, 0 left\n")
    assert marks(top) == [
        ("anna", "essay", 3.5, "the roots are missing"),
        ("emil", "essay", 4.0, ""),
        ("anna", "picture", 0.5, "too small to read"),
        ("emil", "picture", 1.0, ""),
    ]
    again = review(top, "")
    assert (again.returncode, again.stdout) == (0, "nothing needs manual grading\n")


def test_a_question(top: Path, graded_class: Path) -> None:
    """Student, criterion, answer, model answer, location and picture; without control characters."""
    done = review(top, "s\ns\nq\n", COLUMNS="200")
    first, second, third, last = done.stdout.split("points, 0 to ")
    assert first == (
        "\n1 of 4  Anna Ek (anna): About essay (4 points)\n"
        "Why? The answer in answers.md, from line 1, needs manual grading\n"
        "Found:\n  Step 1\n  The roots of anna.\n"
        "Model answer:\n  Because of the roots.\n"
        f"in {graded_class}/class/anna/answers.md, line 1\n"
    )
    assert "2 of 4  Ben Oh (emil): About essay (4 points)\n" in second
    assert r"[bold]\x1b[31mRed\x1b[0m roots[/bold] \u202eturned" in second
    assert f"Look at:\n  {graded_class}/class/anna/screen.png\n" in third
    assert last.endswith("0 marked, 4 left\n")
    assert not set(done.stdout) & set("\x1b\u202e")


def test_stopping_and_resuming(top: Path) -> None:
    """Marks are kept; the next review continues with the rest, including skipped questions."""
    assert review(top, "s\n2\nquit\n").stdout.endswith("1 marked, 3 left\n")
    done = review(top, "1 now\n")
    assert "1 of 3  Anna Ek (anna): About essay" in done.stdout
    assert done.stdout.endswith("1 marked, 2 left\n")
    assert marks(top) == [("emil", "essay", 2.0, ""), ("anna", "essay", 1.0, "now")]


@pytest.mark.parametrize(
    ("typed", "why"),
    [
        ("-", "points are a number from 0 to 4, with at most 4 decimals, not '-'"),
        ("good", "points are a number from 0 to 4, with at most 4 decimals, not 'good'"),
        ("4.5 very good", "essay is worth 0 to 4 points, not 4.5"),
        ("-1", "essay is worth 0 to 4 points, not -1"),
        ("nan", "points are a number from 0 to 4, with at most 4 decimals, not 'nan'"),
        ("\x1b[A", r"points are a number from 0 to 4, with at most 4 decimals, not '\x1b[A'"),
    ],
)
def test_invalid_input_is_asked_again(typed: str, why: str, top: Path) -> None:
    """Nothing is marked."""
    done = review(top, f"{typed}\n2 fine\n")
    assert done.stderr == f"grader: {why}\n"
    assert done.stdout.endswith("1 marked, 3 left\n")
    assert marks(top) == [("anna", "essay", 2.0, "fine")]


def test_help(top: Path) -> None:
    """`?` lists what can be typed, each in a line, and asks again."""
    done = review(top, "?\nq\n")
    lines = done.stdout.split("(? for help): ")[1].splitlines()
    typed = ["3.5 a comment", "3.5 #2", "d1 d3 a comment", "s or Enter", "b", "u", "o", "/NAME", "q"]
    assert [line[:16].strip() for line in lines[1:10]] == typed


@pytest.mark.parametrize("typed", ["", "\n\n", "S\n", "Q\n", "skip\nQUIT\n", "???"])
def test_nothing_is_marked_by_accident(typed: str, graded_class: Path) -> None:
    """End of input, empty lines, and words for skipping and stopping in any case mark nothing."""
    done = review(graded_class, typed)
    assert done.returncode == 0
    assert done.stdout.endswith("0 marked, 6 left\n")
    assert marks(graded_class) == []


def test_undecodable_bytes(top: Path) -> None:
    """A comment in another encoding is kept as far as it can be read."""
    assert review(top, b"2 gr\xfcn \x00 [red]\n").stdout.endswith("1 marked, 3 left\n")
    assert marks(top) == [("anna", "essay", 2.0, r"gr\xfcn " + "\0 [red]")]


def test_one_criterion_only(top: Path) -> None:
    """The others are omitted; an unknown one is refused."""
    done = review(top, "1\n1\n", "--criterion", "picture")
    assert done.stdout.endswith("2 marked, 0 left\n")
    assert [row[:2] for row in marks(top)] == [("anna", "picture"), ("emil", "picture")]
    assert "did you mean 'picture'" in review(top, "", "--criterion", "pictur").stderr


@pytest.mark.exhaustive
def test_without_standard_input(graded_class: Path) -> None:
    """It stops at the first question."""
    command = [sys.executable, "-m", "grader", "review", "--gradebook", str(graded_class / "book.db")]
    closed = ["sh", "-c", 'exec "$@" <&-', "sh", *command]
    done = subprocess.run(closed, cwd=ROOT, env=ENVIRONMENT, capture_output=True, check=False, timeout=HANG_TIMEOUT)
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.endswith(b"0 marked, 6 left\n")


@pytest.fixture
def meanwhile(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Return a function that has somebody do something while the first question waits, and then types lines."""

    def types(others: Callable[[], object], lines: list[str]) -> None:
        waiting = iter(lines)
        first = iter([others])

        def typed() -> str:
            for act in first:
                act()
            for line in waiting:
                return line
            raise EOFError

        monkeypatch.setattr("builtins.input", typed)

    return types


def put(top: Path, key: str, criterion: str, points: int, comment: str = "") -> None:
    """Mark as Kim."""
    with Gradebook(top / "book.db") as book:
        (found,) = queued_results(Grades(book), Grades(book).find(key), [criterion])
        mark(book, found.grade, found.result.criterion, Decimal(points), "Kim", comment)


def test_two_reviews_at_once(top: Path, meanwhile: Callable[..., None]) -> None:
    """A question that one reviewer has answered is not asked of the other."""

    def answer() -> None:
        put(top, "emil", "essay", 4)
        put(top, "anna", "picture", 1)

    meanwhile(answer, ["2", "s"])
    done = review(top, "")
    assert "Anna Ek (anna): About picture" not in done.stdout
    assert "Ben Oh (emil): About picture" in done.stdout
    assert done.stdout.endswith("1 marked, 1 left\n")
    assert marks(top) == [("emil", "essay", 4.0, ""), ("anna", "picture", 1.0, ""), ("anna", "essay", 2.0, "")]


@pytest.mark.parametrize(
    ("typed", "end", "kept"),
    [
        (["k"], "0 marked, 1 left\n", [1.5, None, 3.0]),
        (["what", "", "KEEP"], "0 marked, 1 left\n", [1.5, None, 3.0]),
        (["r"], "1 marked, 1 left\n", [1.5, None, 3.0, 2.0]),
        ([], "0 marked, 1 left\n", [1.5, None, 3.0]),
    ],
)
def test_a_newer_mark_is_confirmed(
    typed: list[str], end: str, kept: list[float], top: Path, meanwhile: Callable[..., None]
) -> None:
    """A reviewer keeps or replaces a mark that somebody added after the question; all marks are kept."""
    for points in ("1.5", "-"):
        assert grader("mark", "anna", "essay", points, "--gradebook", top / "book.db").returncode == 0
    meanwhile(lambda: put(top, "anna", "essay", 3, "two roots"), ["2 mine", *typed])
    done = review(top, "", "--criterion", "essay")
    assert done.stderr.startswith("grader: somebody has marked this since it was shown: 3 points by Kim at 20")
    assert done.stderr.endswith("): two roots\n")
    assert done.stderr.count("\n") == 1
    assert "k to keep that mark, r to replace it with yours: " in done.stdout
    assert done.stdout.endswith(end)
    assert [row[2] for row in marks(top)] == kept


def test_a_third_mark_is_shown_as_well(graded_class: Path, top: Path) -> None:
    """Each read and write are one transaction: also a mark added during the confirmation of another."""
    del graded_class
    with Gradebook(top / "book.db") as one, Gradebook(top / "book.db") as other:
        standings = Grades(one)
        (found,) = queued_results(standings, standings.find("anna"), ["essay"])
        shown, seen = found.newest, []
        for points in (1, 2):
            theirs = mark(other, found.grade, found.result.criterion, Decimal(points), "", "").before
            assert (theirs.points if theirs is not None else 0) == points - 1
            with pytest.raises(NewerMarkError) as caught:
                mark(one, found.grade, found.result.criterion, Decimal(4), "Kim", "", shown=shown)
            shown = caught.value.mark.id
            seen.append(caught.value.mark.points)
        mark(one, found.grade, found.result.criterion, Decimal(4), "Kim", "", shown=shown)
    assert seen == [1, 2]
    assert [row[2] for row in marks(top)] == [1, 2, 4]


@pytest.mark.exhaustive
def test_ctrl_c_keeps_earlier_marks(top: Path) -> None:
    """At a terminal, in the middle of a question."""
    own, theirs = pty.openpty()
    command = [sys.executable, "-m", "grader", "review", "--gradebook", str(top / "book.db")]
    with subprocess.Popen(
        command, cwd=ROOT, env=ENVIRONMENT, stdin=theirs, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        start_new_session=True,
    ) as process:  # fmt: skip
        os.write(own, b"3 good\n")
        assert process.stdout is not None
        text = b""
        while text.count(b"points, 0 to 4") < 2:
            text += os.read(process.stdout.fileno(), 4096)
        process.send_signal(2)
        assert process.wait(HANG_TIMEOUT) == 130
    os.close(own)
    os.close(theirs)
    assert marks(top) == [("anna", "essay", 3.0, "good")]


def test_back_and_undo(top: Path) -> None:
    """An item that this review has marked is shown with its mark; undo opens it again, with a new entry."""
    done = review(top, "b\n3 good\nb\nu\nu\n2\nq\n")
    assert done.stderr == (
        "grader: this is the first item\ngrader: undone\ngrader: nothing to undo: this review has marked nothing\n"
    )
    positions = [line.split(":")[0] for line in done.stdout.splitlines() if " of 4  " in line]
    assert positions == [
        "1 of 4  Anna Ek (anna)", "2 of 4  Ben Oh (emil)", "1 of 4  Anna Ek (anna)", "1 of 4  Anna Ek (anna)",
        "2 of 4  Ben Oh (emil)",
    ]  # fmt: skip
    _, marked, unmarked = done.stdout.split("1 of 4  ")[1:][0], *done.stdout.split("1 of 4  ")[2:]
    assert "\nMarked: 3 points by Kim at 20" in marked
    assert "Marked:" not in unmarked
    assert done.stdout.endswith("1 marked, 3 left\n")
    assert [row[1:] for row in marks(top)] == [("essay", 3.0, "good"), ("essay", None, ""), ("essay", 2.0, "")]


def test_undo_of_a_criterion_that_is_no_longer_graded(top: Path) -> None:
    """After another process has used another rubric, standard error has the reason, and the review goes on."""
    lines: list[str] = []
    typed = iter(["3", "u", "2", "q"])

    def ask(_prompt: str) -> str:
        line = next(typed)
        if line == "u":
            grade_without(top / "book.db", "anna", "essay")
        return line

    terminal = Terminal(lambda _text: None, lines.append, lambda: Screen(80), ask, lambda _file: None, show_class)
    assert review_class(top / "book.db", ReviewScope("essay", "Kim"), None, terminal).startswith("1 marked, ")
    assert lines == ["not undone: this criterion is no longer graded for this student"]
    assert [row[:3] for row in marks(top)] == [("anna", "essay", 3.0), ("emil", "essay", 2.0)]


def test_undo_of_a_replacement(top: Path) -> None:
    """The mark before it counts again."""
    done = review(top, "3 good\nback\n1 bad\nundo\ns\nq\n")
    assert done.stderr.startswith("grader: undone; the mark before it counts again: 3 points by Kim at 20")
    assert [row[2] for row in marks(top)] == [3, 1, 3]


def test_an_interrupt_ends_with_the_summary(top: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C at the prompt keeps the marks, and says how many there are."""

    def typed() -> str:
        if marks(top):
            raise KeyboardInterrupt
        return "2"

    monkeypatch.setattr("builtins.input", typed)
    done = review(top, "")
    assert done.stdout.endswith("(? for help): \n1 marked, 3 left\n")
    assert (done.returncode, done.stderr) == (130, "grader: interrupted\n")


def test_the_last_item_can_be_undone(top: Path) -> None:
    """At the end of the queue a review that has marked something asks; one that has marked nothing does not."""
    end = "end of the queue: u to undo, b to go back, Enter to end: "
    done = review(top, "s\ns\ns\n1\nx\nu\n0.5 better\nb\n0.25\n\n")
    assert done.stdout.count("4 of 4") == 3
    assert done.stdout.count(end) == 4
    assert done.stdout.endswith(f"{end}1 marked, 3 left\n")
    assert done.stderr == "grader: u to undo, b to go back, Enter to end\ngrader: undone\n"
    assert [points for *_, points, _ in marks(top)] == [1, None, 0.5, 0.25]
    assert end not in review(top, "s\ns\ns\n").stdout


def test_several_students_at_once(top: Path) -> None:
    """One item for all without an answer: their names, the points for all, one by one, and a jump to one of them."""
    for key in ("ben", "anna", "emil"):
        for criterion in ("essay", "picture"):
            grader("mark", key, criterion, "-", "--gradebook", top / "book.db")
    shutil.copytree(top / "class" / "anna", top / "class" / "dora")
    (top / "class" / "cleo.zip").unlink()
    shutil.copy(top / "class" / "ben.urdf", top / "class" / "cleo.urdf")
    assert batch(top).returncode == 0
    done = review(top, "/cleo\no\no\ns\n1\n/ben\nq\n", COLUMNS="200")
    assert "6 of 7  2 students: About essay (4 points)\nNo answer:\n  Ben Oh (ben); Cleo Ray (cleo)\n" in done.stdout
    assert "points for all 2 students, 0 to 4 (? for help): " in done.stdout
    assert done.stderr == "grader: this item has one student only\n"
    assert marks(top)[-1][:3] == ("cleo", "essay", 1)
    together = review(top, "0\n0\n0\n0\n", "--criterion", "essay")
    assert together.stdout.endswith("4 marked, 0 left\n"), together.stdout[-300:]
    assert (
        "1 of 3  2 students" in together.stdout
        and "The same answer:\n  Anna Ek (anna); Dora Fi (dora)" in together.stdout
    )


def test_usual_deductions(tmp_path: Path) -> None:
    """`d1 d2` takes their points from the maximum and gives their comments; `stats` counts each."""
    make_class(tmp_path)
    head, tail = lab_text().split('check = "answered"', 1)
    choices = 'choices = { "no reason" = -2, "too short" = -3 }\n'
    (tmp_path / "small.toml").write_text(f'{head}{choices}check = "answered"{tail}')
    assert batch(tmp_path).returncode == 0
    done = review(tmp_path, "d3\nd1 see me\nD1 d2\nd4\nq\n", "--criterion", "essay")
    assert "Usual deductions:\n  d1 no reason (-2)\n  d2 too short (-3)\n" in done.stdout
    assert done.stderr == "grader: there is no deduction d3\ngrader: there is no deduction d4\n"
    assert [row[2:] for row in marks(tmp_path)] == [(2, "no reason; see me"), (0, "no reason; too short")]
    stats = grader("stats", "--gradebook", tmp_path / "book.db").stdout
    assert "Usual deductions\n     2  essay: no reason (-2)\n     1  essay: too short (-3)\n" in stats
    data = json.loads(grader("stats", "--gradebook", tmp_path / "book.db", "--format", "json").stdout)
    assert data["choices"][0] == {"criterion": "essay", "text": "no reason", "points": -2, "students": 2}
