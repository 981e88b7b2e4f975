"""grader mark: a manual mark on one criterion is kept, whatever is graded again."""

import json
import subprocess
import sys
import threading
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.report.formats import Format, OutputFormat
from grader.usecases.class_summary import SummaryRequest, class_summary
from tests.classroom.gradebooks import (
    ENVIRONMENT,
    HOSTILE,
    batch,
    grader,
    urdf,
)
from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT

GRADE = ("score", "max_score", "pending")


def mark(top: Path, *arguments: object, **more: Any) -> subprocess.CompletedProcess[str]:
    """Mark in the class's gradebook."""
    return grader("mark", *arguments, "--gradebook", top / "book.db", **more)


def student(top: Path, key: str) -> dict[str, Any]:
    """Return a student's grade from `grader export json`, which equals the view."""
    with Gradebook(top / "book.db") as book:
        data = json.loads(class_summary(Grades(book), SummaryRequest(OutputFormat.JSON)))
        (found,) = [student for student in data["students"] if student["id"] == key]
        ((score, out_of, pending, marks),) = book.rows(
            "SELECT score, out_of, pending, marks FROM grade WHERE key = ?", key
        )
    numbers = [None if found[name] is None else Decimal(str(found[name])) * 10_000 for name in GRADE]
    assert [score, out_of, pending, marks] == [*numbers, found["manual_marks"]]
    return dict(found)


def marks(top: Path) -> list[tuple[Any, ...]]:
    """Return all marks ever given."""
    with Gradebook(top / "book.db") as book:
        return list(book.rows("SELECT criterion, points, comment, author, at, result FROM mark ORDER BY id"))


@pytest.mark.usefixtures("hostile_checks")
def test_a_mark_on_an_errored_criterion(tmp_path: Path) -> None:
    """A mark replaces the result of a check that failed with an error; the grade is final then."""
    (tmp_path / "class").mkdir()
    text = urdf().replace('name="r"', 'name="raises"')
    (tmp_path / "class" / "anna.urdf").write_text(text)
    (tmp_path / "roster.csv").write_text("id\nanna\n")
    arguments = ("--rubric", HOSTILE / "hostile.toml", "--gradebook", tmp_path / "book.db")
    assert grader("batch", tmp_path / "class", *arguments).returncode == 0
    book = ("--gradebook", tmp_path / "book.db")

    def status() -> tuple[Any, ...]:
        (found,) = json.loads(grader("export", "json", *book).stdout)["students"]
        return found["status"], found["score"], found["is_final"]

    assert status() == ("errored", 1, False)
    assert "nothing needs manual grading" in grader("review", *book).stdout
    done = grader("mark", "anna", "behaves", "1.5", *book)
    assert (done.returncode, done.stdout) == (0, "anna: 2.5 of 3 points\n")
    assert status() == ("errored", 2.5, True)
    assert "could not be graded, and was marked manually (1): anna" in grader("stats", *book).stdout


def test_undecodable_bytes(top: Path) -> None:
    """A comment in another encoding is kept as far as it can be read."""
    assert mark(top, "anna", "essay", "1", "--comment", b"gr\xfcn", "--by", b"\xff").returncode == 0
    assert marks(top)[0][2:4] == ("gr\\udcfcn", "\\udcff")


@pytest.mark.exhaustive
def test_concurrent_marks(top: Path) -> None:
    """Several graders, and a batch that grades everything meanwhile: nothing is lost."""
    expected = [(key, name) for key in ("anna", "emil") for name in ("essay", "picture", "box", "loads")]
    command = [sys.executable, "-m", "grader"]
    book = str(top / "book.db")
    started = [
        subprocess.Popen(
            [*command, "mark", *words, "0.5", "--gradebook", book],
            cwd=ROOT,
            env=ENVIRONMENT,
            stdout=subprocess.DEVNULL,
        )
        for words in expected
    ]
    done = batch(top, "--force")
    assert done.returncode == 0, done.stderr
    assert [process.wait(HANG_TIMEOUT) for process in started] == [0] * len(expected)
    assert len(marks(top)) == len(expected)
    assert student(top, "anna")["score"] == 2.5
    assert student(top, "emil")["score"] == 2


@pytest.mark.exhaustive
def test_marks_of_several_threads_wait_for_each_other(top: Path) -> None:
    """A slow write does not break another one."""
    with Gradebook(top / "book.db") as book:
        with book.transaction():
            other: list[int] = []
            thread = threading.Thread(target=lambda: other.append(mark(top, "anna", "essay", "1").returncode))
            thread.start()
            thread.join(0.5)
            assert other == []
        thread.join()
    assert other == [0]


def test_no_report_names_an_account(top: Path) -> None:
    """Without `--by` no report, table or feedback names an author; with it, that name.

    The gradebook keeps the account.
    """
    account = {"LOGNAME": "jdoe47"}
    assert mark(top, "anna", "essay", "3", "--comment", "fine", **account).returncode == 0
    assert mark(top, "emil", "essay", "3", "--by", "Kim", **account).returncode == 0
    assert grader("review", "--gradebook", top / "book.db", stdin="1\nq\n", **account).returncode == 0
    formats = [part for kind in Format if kind.needs != "identity" for part in ("--report-format", kind)]
    out = top / "out"
    done = batch(top, "--reports", out, *formats, "--csv", out.with_suffix(".csv"))
    assert done.returncode == 0, done.stderr
    worksheet = top / "moodle.csv"
    worksheet.write_text(
        "Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed,Last modified (grade),Feedback comments\n"
        "Participant 1,Anna Ek,anna@example.org,Submitted,-,11.00,Yes,-,\n",
        encoding="utf-8",
    )
    book = ("--gradebook", top / "book.db")
    output = [done.stdout, done.stderr]
    for arguments in (("csv",), ("json",), ("moodle", "--into", worksheet, "--pending-as-zero")):
        shown = grader("export", *arguments, *book)
        assert shown.returncode == 0, shown.stderr
        output.append(shown.stdout + shown.stderr)
    assert "fine" in output[-1]
    files = [path.read_text(encoding="utf-8") for path in (*out.iterdir(), out.with_suffix(".csv"))]
    assert len(files) > len(Format)
    assert all("jdoe47" not in text for text in (*files, *output))
    assert "Marked manually: fine." in (out / "anna.md").read_text(encoding="utf-8")
    assert "Marked by Kim." in (out / "emil.md").read_text(encoding="utf-8")
    assert [row[3] for row in marks(top)] == ["jdoe47", "Kim", "jdoe47"]
