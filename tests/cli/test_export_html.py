"""grader export html, and batch --report-format html: the pages of the students and of the class, as files."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.run.pool import WorkerError
from grader.classroom.run.progress import Progress
from grader.errors import InputError
from grader.report.formats import Format
from grader.usecases.class_reports import ReportRun, write_reports
from tests.classroom.gradebooks import grader, refusal
from tests.report.class_pages import ClassPageReader


def export(top: Path, *more: object) -> str:
    """Write the pages of the class and return what is said on standard error."""
    done = grader("export", "html", "--gradebook", top / "book.db", "--output", top / "pages", *more)
    assert (done.returncode, done.stdout) == (0, "")
    return done.stderr


def test_a_gradebook_without_a_run(tmp_path: Path) -> None:
    """It is reported in a line, and no folder is made."""
    Gradebook(tmp_path / "book.db", create=True).close()
    done = grader("export", "html", "--gradebook", tmp_path / "book.db", "--output", tmp_path / "pages")
    assert refusal(done).startswith("nothing has been graded into ")
    assert not (tmp_path / "pages").exists()


class FailingWorkers(Executor):
    """An executor that fails whenever it works on the report of one student."""

    def __init__(self, error: Exception) -> None:
        self.error = error

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> "Future[Any]":
        """Run a function here and now."""
        future: Future[Any] = Future()
        if any(isinstance(given, list) and "ben" in dict(given) for given in arguments):
            future.set_exception(self.error)
        else:
            future.set_result(function(*arguments, **named))
        return future


@pytest.mark.parametrize(
    ("error", "why"),
    [
        (WorkerError("the process that graded it was killed"), "the process that graded it was killed"),
        (OverflowError("inf"), "the grader itself failed: OverflowError: inf"),
    ],
)
def test_a_crash_costs_one_page(error: Exception, why: str, top: Path) -> None:
    """The others have theirs, the class's page has no link to it, and standard error says why."""
    lines: list[str] = []
    progress: list[Progress] = []
    run = ReportRun(top / "book.db", top / "pages", (Format.HTML,))
    write_reports(FailingWorkers(error), run, lines.append, progress.append)
    assert [state.done for state in progress] == [0, 1, 2, 3, 4]
    assert lines == [
        f"3 reports written to {top / 'pages'}",
        f"no report for ben: {why}",
    ]
    assert sorted(ClassPageReader(top / "pages/index.html").links()) == ["anna.html", "cleo.html", "emil.html"]


def test_a_full_disk_ends_the_command(top: Path) -> None:
    """It concerns all pages: none is blamed on a student."""
    with pytest.raises(InputError, match="No space left"):
        run = ReportRun(top / "book.db", top / "pages", (Format.HTML,))
        write_reports(FailingWorkers(InputError("No space left")), run, print, print)
