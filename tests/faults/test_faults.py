"""Faults of the system: the harnesses find nothing, and the faults that they do not cover."""

import csv
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

import pytest

from grader.classroom.intake.class_files import open_class_submission
from grader.classroom.run import batch_worker
from grader.workers import pool
from grader.workers.pool import Processes, WorkerError
from tests.classroom.class_runs import newest
from tests.classroom.gradebooks import batch, grader, make_class
from tests.command_line import HANG_TIMEOUT, ROOT
from tests.faults.shim import COMPILER

needs_shim = pytest.mark.skipif(
    sys.platform != "linux" or COMPILER is None, reason="needs Linux and a C compiler"
)
STUDENTS = ("anna", "ben", "cleo", "dora", "emil")
_THREE_MARKS = """
import sys
from grader.app.cli.app import run
from grader.__main__ import main
for number in range(3):
    points, student = str(number % 4), sys.argv[2]  # each of a file: marks of two graders at one time are refused
    assert run(["mark", student, "total", points, "--gradebook", sys.argv[1], "--by", f"grader-{student}"]) == 0
"""


def found(module: str, *arguments: str) -> str:
    """Run a harness; return what it has printed if it has findings, else nothing."""
    done = subprocess.run(
        [sys.executable, "-m", module, *arguments],
        cwd=ROOT,
        check=False,
        capture_output=True,
        text=True,
        timeout=4 * HANG_TIMEOUT,
    )
    return f"{done.stdout}{done.stderr}" if done.returncode else ""


@needs_shim
@pytest.mark.exhaustive
def test_failed_calls_of_every_command() -> None:
    """The same for all commands, also for those that start processes."""
    assert found("tests.faults", "--sample", "1") == ""


@needs_shim
@pytest.mark.exhaustive
def test_power_failures() -> None:
    """Every acknowledged mark is on the disk, and every file is as before or complete."""
    assert found("tests.faults.power") == ""


@pytest.mark.exhaustive
def test_a_hundred_processes_mark_at_once(tmp_path: Path) -> None:
    """Each of their 300 marks is in the gradebook, once, although twenty processes append to a file."""
    make_class(tmp_path)
    assert batch(tmp_path).returncode == 0
    book = tmp_path / "book"
    command = (sys.executable, "-W", "error", "-c", _THREE_MARKS, str(book))
    processes = [
        subprocess.Popen([*command, STUDENTS[number % 5]], cwd=ROOT, stdout=subprocess.DEVNULL)
        for number in range(100)
    ]
    assert [process.wait(HANG_TIMEOUT) for process in processes] == [0] * 100
    rows = [
        row
        for file in (book / "marks").iterdir()
        for row in csv.DictReader(file.read_text().splitlines())
    ]
    assert Counter((row["by"], row["student"], row["points"]) for row in rows) == {
        (f"grader-{student}", student, str(number)): 20
        for student in STUDENTS
        for number in range(3)
    }


@contextmanager
def changed_before_reading(path: Path, data: bytes | None) -> Iterator[None]:
    """Give a file other bytes, or none, after the class has been listed and before it is read."""
    opened = open_class_submission

    def change_and_open(*arguments: object) -> object:
        if data is None:
            path.unlink(missing_ok=True)
        else:
            path.write_bytes(data)
        return opened(*arguments)  # type: ignore[arg-type]

    before = path.read_bytes()
    with patch.object(batch_worker, "open_class_submission", change_and_open):
        yield
    path.write_bytes(before)


@pytest.mark.slow
@pytest.mark.parametrize(
    "data", [None, b"", b'<robot name="r">', b"PK\x03\x04"], ids=["gone", "empty", "cut", "other"]
)
@pytest.mark.parametrize("name", ["ben.urdf", "anna/robot.urdf", "anna/answers.md"])
def test_a_file_that_changes_while_it_is_read(
    tmp_path: Path, name: str, data: bytes | None
) -> None:
    """The run ends as usual, and the next one grades what is there then."""
    make_class(tmp_path)
    assert batch(tmp_path).returncode == 0
    expected = newest(tmp_path / "book")
    shutil.rmtree(tmp_path / "book")
    with changed_before_reading(tmp_path / "class" / name, data):
        done = batch(tmp_path)
    assert (done.returncode, "Traceback" in done.stderr) == (0, False)
    assert batch(tmp_path).returncode == 0
    assert {key: {**one, "run": 1} for key, one in newest(tmp_path / "book").items()} == expected


@pytest.mark.slow
def test_a_lost_task_is_noticed() -> None:
    """A pool never completes a task whose worker ended before it began: it is given up, and can be tried again."""
    with patch.object(pool, "_MAX_IDLE", 0.1), Processes(1, 0.1) as processes:
        assert processes.submit_within(60, int, ("1",), {}).result(HANG_TIMEOUT) == 1
        with patch.object(processes._pool, "schedule", lambda *_: Future()):
            lost = processes.submit(int, "2")
        with pytest.raises(WorkerError) as error:
            lost.result(HANG_TIMEOUT)
    assert not error.value.is_own_fault


def test_reports_that_cannot_be_written(tmp_path: Path) -> None:
    """A folder that is a file, or gone, is refused in one line, and the marks stay."""
    make_class(tmp_path)
    assert batch(tmp_path).returncode == 0
    (tmp_path / "file").touch()
    done = grader(
        "export", "html", "--gradebook", tmp_path / "book", "--output", tmp_path / "file/pages"
    )
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    shutil.rmtree(tmp_path / "class")
    assert grader("export", "csv", "--gradebook", tmp_path / "book").returncode == 0
