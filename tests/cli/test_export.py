"""grader export replaces neither the gradebook nor the file of the LMS, and a fault costs one report at most."""

import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

import pytest

from grader.app.cli.streams import TERMINAL
from grader.base.errors import InputError
from grader.classroom.reports import class_reports
from grader.classroom.reports.class_reports import ReportRun, write_reports
from grader.report.formats import Format
from grader.workers.pool import WorkerError
from tests.classroom.gradebooks import grader, refusal
from tests.report.class_pages import ClassPageReader
from tests.samples import ROOT


@pytest.mark.parametrize(
    "name", ["book/grades.csv", "../small/book/marks/kim.csv", "link.csv", "book/new.csv"]
)
def test_the_gradebook_is_never_replaced(name: str, top: Path) -> None:
    """Nor gets it other files, under any name; it contains all manual marks."""
    assert (
        grader(
            "mark", "anna", "essay", "3.5", "--by", "Kim", "--gradebook", top / "book"
        ).returncode
        == 0
    )
    (top / "link.csv").symlink_to("book/marks/kim.csv")
    before = {path: path.read_bytes() for path in top.rglob("*") if path.is_file()}
    done = grader("export", "csv", "--gradebook", top / "book", "--output", top / name)
    assert (
        refusal(done) == f"cannot write {top / name}: the gradebook is written by its own commands"
    )
    assert {path: path.read_bytes() for path in top.rglob("*") if path.is_file()} == before


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ["lms.csv", "link.csv", "hard.csv"])
def test_standard_output_is_no_way_to_replace_the_file_of_the_lms(name: str, top: Path) -> None:
    """Nor is it appended to."""
    lms = top / "lms.csv"
    lms.write_text(
        "Student,ID,Section,A small lab (77)\n    Points Possible,,,11\nBen,102,S1,\nNobody,9,S1,\n"
    )
    (top / "link.csv").symlink_to("lms.csv")
    (top / "hard.csv").hardlink_to(lms)
    before = lms.read_bytes()
    with lms.open("ab") as stdout:
        command = [
            sys.executable,
            "-m",
            "grader",
            "export",
            "canvas",
            "--gradebook",
            str(top / "book"),
        ]
        done = subprocess.run(
            [*command, "--into", str(top / name)], cwd=ROOT, stdout=stdout, check=False
        )
    assert done.returncode == 2
    assert lms.read_bytes() == before


class FailingWorkers(Executor):
    """An executor that fails whenever it works on the report of one student."""

    def __init__(self, error: Exception) -> None:
        self.error = error

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **_: Any) -> "Future[Any]":
        """Run a function here and now."""
        future: Future[Any] = Future()
        if any(key == "ben" for key, *_ in arguments[-1]):
            future.set_exception(self.error)
        else:
            future.set_result(function(*arguments))
        return future


def pages(error: Exception, top: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Write the pages of the class with workers that fail, and return what is said."""
    lines: list[str] = []
    monkeypatch.setattr(class_reports, "Processes", lambda *_, **__: FailingWorkers(error))
    terminal = TERMINAL._replace(warn=lines.append)
    write_reports(ReportRun(top / "book", top / "pages", (Format.HTML,)), terminal)
    return lines


@pytest.mark.parametrize(
    ("error", "why"),
    [
        (
            WorkerError("the process that graded it was killed"),
            "the process that graded it was killed",
        ),
        (OverflowError("inf"), "the grader itself failed: OverflowError: inf"),
    ],
)
def test_a_crash_costs_one_page(
    error: Exception, why: str, top: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The others have theirs, the class's page has no link to it, and standard error says why."""
    assert pages(error, top, monkeypatch) == [
        f"3 reports written to {top / 'pages'}",
        f"no report for Ben Oh (ben): {why}",
    ]
    assert sorted(ClassPageReader(top / "pages/index.html").links()) == [
        "anna.html",
        "cleo.html",
        "emil.html",
    ]


def test_a_full_disk_ends_the_command(top: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It concerns all pages: none is blamed on a student."""
    with pytest.raises(InputError, match="No space left"):
        pages(InputError("No space left"), top, monkeypatch)


def test_grades_of_some_students(top: Path) -> None:
    """Only theirs are written; nobody else's row in the file of the LMS changes."""
    book = ("--gradebook", top / "book")
    exported = grader("export", "csv", *book, "--for", "anna", "--for", "ben")
    rows = [line.split(",")[0] for line in exported.stdout.splitlines()]
    assert rows == ["id", "anna", "ben"]
    lms = "Student,ID,SIS Login ID,Section,A small lab (77)\n    Points Possible,,,,11\n"
    (top / "lms.csv").write_text(f"{lms}Anna,101,anna,S1,\nBen,102,ben,S1,\n")
    options = ("--into", top / "lms.csv", "--for", "anna", "--pending-as-zero")
    filled = grader("export", "canvas", *book, *options)
    assert [line.partition(",")[0] for line in filled.stdout.splitlines()[2:]] == ["Anna"]
    assert "is not released" in filled.stderr
    refused = grader("export", "html", *book, "--for", "anna")
    assert refusal(refused).startswith("export html takes no --for: ")
    assert "there is no student 'zoe'" in refusal(grader("export", "csv", *book, "--for", "zoe"))
