"""grader mark: a manual mark is kept, whatever is graded meanwhile, and names nobody who gave no name."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from grader.report.formats import Format
from tests.classroom.gradebooks import (
    ENVIRONMENT,
    HOSTILE,
    batch,
    grader,
    lab_text,
    urdf,
    write_submission,
)
from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT


def scores(book: Path) -> dict[str, Any]:
    """Return the status, score and finality of each student."""
    students = json.loads(grader("export", "json", "--gradebook", book).stdout)["students"]
    return {
        one["id"]: (one["status"], one["score"], not one.get("not_final_because"))
        for one in students
    }


@pytest.mark.usefixtures("hostile_checks")
def test_a_mark_on_an_errored_criterion(tmp_path: Path) -> None:
    """A mark replaces the result of a check that failed with an error; the grade is final then."""
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "anna.urdf").write_text(urdf().replace('name="r"', 'name="raises"'))
    (tmp_path / "roster.csv").write_text("id\nanna\n")
    book = ("--gradebook", tmp_path / "book")
    assert (
        grader("batch", tmp_path / "class", "--rubric", HOSTILE / "hostile.toml", *book).returncode
        == 0
    )
    assert scores(tmp_path / "book") == {"anna": ("errored", 1, False)}
    done = grader("mark", "anna", "behaves", "1.5", *book)
    assert (done.returncode, done.stdout) == (0, "anna: 2.5 of 3 points\n")
    assert scores(tmp_path / "book") == {"anna": ("errored", 2.5, True)}


def test_undecodable_bytes(top: Path) -> None:
    """A comment in another encoding is kept as far as it can be read."""
    book = ("--gradebook", top / "book")
    assert (
        grader(
            "mark", "anna", "essay", "1", "--comment", b"gr\xfcn", "--by", b"\xff", *book
        ).returncode
        == 0
    )
    (file,) = (top / "book/marks").iterdir()
    assert "anna,essay,1,gr\\xdcfcn" in file.read_text() and "\\xdcff" in file.read_text()


@pytest.mark.exhaustive
def test_concurrent_marks(top: Path) -> None:
    """Several graders, and a batch that grades everything meanwhile: nothing is lost."""
    expected = [
        (key, name) for key in ("anna", "emil") for name in ("essay", "picture", "box", "loads")
    ]
    command = [sys.executable, "-m", "grader", "mark"]
    started = [
        subprocess.Popen(
            [*command, *words, "0.5", "--by", "Kim", "--gradebook", str(top / "book")],
            cwd=ROOT,
            env=ENVIRONMENT,
            stdout=subprocess.DEVNULL,
        )
        for words in expected
    ]
    done = batch(top, "--force")
    assert done.returncode == 0, done.stderr
    assert [process.wait(HANG_TIMEOUT) for process in started] == [0] * len(expected)
    assert (top / "book/marks/kim.csv").read_text().count("\n") == 1 + len(expected)
    found = scores(top / "book")
    assert (found["anna"][1], found["emil"][1]) == (2.5, 2)


@pytest.mark.slow
def test_no_report_names_an_account(top: Path) -> None:
    """Without `--by` no report, table or feedback names an author; with it, that name."""
    book, account = ("--gradebook", top / "book"), {"LOGNAME": "jdoe47"}
    assert (
        grader("mark", "anna", "essay", "3", "--comment", "fine", *book, **account).returncode == 0
    )
    assert grader("mark", "emil", "essay", "3", "--by", "Kim", *book, **account).returncode == 0
    formats = [
        part for kind in Format if kind.needs != "identity" for part in ("--report-format", kind)
    ]
    done = batch(top, "--reports", top / "out", *formats)
    assert done.returncode == 0, done.stderr
    (top / "moodle.csv").write_text(
        "Identifier,Email address,Grade,Maximum Grade,Feedback comments\nParticipant 1,anna@example.org,-,11.00,\n"
    )
    output = [done.stdout, done.stderr]
    for arguments in (
        ("csv",),
        ("json",),
        ("moodle", "--into", top / "moodle.csv", "--pending-as-zero"),
    ):
        shown = grader("export", *arguments, *book)
        assert shown.returncode == 0, shown.stderr
        output.append(shown.stdout + shown.stderr)
    assert "fine" in output[-1]
    files = [
        path.read_text(encoding="utf-8")
        for path in (*(top / "out").iterdir(), top / "book/grades.csv")
    ]
    assert len(files) > len(Format)
    assert all("jdoe47" not in text for text in (*files, *output))
    assert "Marked manually: fine." in (top / "out/anna.md").read_text(encoding="utf-8")
    assert "Marked by Kim." in (top / "out/emil.md").read_text(encoding="utf-8")
    assert sorted(path.name for path in (top / "book/marks").iterdir()) == ["jdoe47.csv", "kim.csv"]


@pytest.mark.slow
def test_the_id_of_a_university_is_no_changed_id_of_another_student(tmp_path: Path) -> None:
    """0003 is Gina's, though Carol's id in Canvas is 3; 09 may be 9, and is refused."""
    for key in ("carol", "gina"):
        write_submission(tmp_path / "class" / key)
    head = "Student,ID,SIS User ID,SIS Login ID,Section\n"
    rows = '"Ek, Carol",3,0007,carol,A\n"Ray, Gina",9,0003,gina,A\n'
    (tmp_path / "roster.csv").write_text(head + rows)
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path).returncode == 0
    book = ("--gradebook", tmp_path / "book")
    assert grader("mark", "0003", "grade", "1", *book).stdout.startswith("Ray, Gina (9): ")
    assert "'09' may be '9'" in grader("mark", "09", "grade", "1", *book).stderr
