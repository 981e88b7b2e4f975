"""A Word file that takes very long: its cost, its effect on a mark, and the end of the process that reads it."""

import io
import os
import re
import shutil
import signal
import subprocess
import sys
import zipfile
from contextlib import suppress
from pathlib import Path

import pytest

from grader.app.cli.app import run
from grader.lab.documents.converter import __file__ as converter
from tests.classroom.class_runs import eventually, grader, newest, session_of, started
from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT

REFERENCE = ROOT / "rubrics" / "lab6" / "my_robot"


PARAGRAPH = f"<p>{'<t/>' * 1000}</p>"


def slow_docx() -> bytes:
    """Return a Word file of some kilobytes that takes long to read: it unpacks to 60 MB of empty texts."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("word/document.xml", f"<body>{PARAGRAPH * 15_000}</body>")
    assert len(data.getvalue()) < 100_000
    return data.getvalue()


def write_submission(folder: Path) -> Path:
    """Write the reference solution with a slow document beside it."""
    shutil.copytree(REFERENCE, folder / "my_robot")
    (folder / "answers.docx").write_bytes(slow_docx())
    (folder / "notes.md").write_text("Task 1 step 15: It vanishes.\n")
    return folder


@pytest.mark.slow
def test_a_slow_document_needs_manual_grading(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is not read, everything else has its result, and another document is read all the same."""
    monkeypatch.setattr("grader.lab.documents.collection.MAX_SECONDS", 1.0)
    assert run(["grade", "--verbose", str(write_submission(tmp_path / "alice"))]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    reason = "the Word and PDF files take longer than 1 s in all; needs manual grading"
    assert shown.count(reason) == 3
    assert f"Note: not searched for evidence: answers.docx was not read: {reason}" in shown
    assert "The answer in notes.md, from line 1, needs manual grading" in shown
    assert "90/100" in shown


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, -15), (signal.SIGKILL, -9)]
)
def test_no_converter_outlives_the_grader(
    number: signal.Signals, code: int, tmp_path: Path
) -> None:
    """However the grader ends, its converter process ends, too."""
    with started("grade", write_submission(tmp_path / "alice")) as process:
        _stop_converter(process)
        process.send_signal(number)  # to the grader alone
        assert process.wait(HANG_TIMEOUT) == code
        assert eventually(lambda: not session_of(process))


@pytest.mark.exhaustive
def test_no_converter_outlives_a_killed_batch(tmp_path: Path) -> None:
    """A worker that is killed takes its converter with it."""
    write_submission(tmp_path / "class" / "alice")
    with started(
        "batch", tmp_path / "class", "--gradebook", tmp_path / "lab", "--jobs", "1"
    ) as process:
        _stop_converter(process)
        process.kill()
        assert eventually(lambda: not session_of(process))


def _stop_converter(process: "subprocess.Popen[str]") -> None:
    """Wait for the converter, and stop it, so that it can only be killed and does not reach its own limits."""
    assert eventually(lambda: _converters(process))
    os.kill(_converters(process)[0], signal.SIGSTOP)


def _converters(process: "subprocess.Popen[str]") -> list[int]:
    """Return the processes with a hard limit of processor time, which is the last step of a converter's start."""
    found = []
    for pid in session_of(process):
        with suppress(OSError):
            if not re.search(
                r"Max cpu time +\S+ +unlimited", Path(f"/proc/{pid}/limits").read_text()
            ):
                found.append(pid)
    return found


@pytest.mark.exhaustive
def test_a_converter_without_a_parent_ends_at_once() -> None:
    """A parent that ends before the kernel is told about it leaves no converter."""
    other = os.getppid()  # not the parent of what is started here
    done = subprocess.run(
        [sys.executable, "-P", converter, "docx", "600", str(other)],
        timeout=HANG_TIMEOUT,
        check=False,
    )
    assert done.returncode == 1


@pytest.mark.exhaustive
def test_a_mark_never_depends_on_a_document(tmp_path: Path) -> None:
    """If grading fails because of a document, the submission is graded again without it, with the same points."""
    write_submission(tmp_path / "class" / "alice")
    shutil.copytree(REFERENCE, tmp_path / "class" / "bob" / "my_robot")
    book = tmp_path / "lab"
    done = grader(
        "batch",
        tmp_path / "class",
        "--gradebook",
        book,
        "--timeout",
        "4",
        "--jobs",
        "2",
        cwd=str(ROOT),
    )
    assert "2 graded, 0 unchanged" in done.stderr
    for line in newest(book).values():
        points = [entry[0] for entry in line["results"].values()]
        assert (line["verdict"], sum(filter(None, points)), points.count(None)) == ("graded", 90, 3)
    again = grader(
        "batch", tmp_path / "class", "--gradebook", book, "--reports", tmp_path / "reports"
    )
    assert "0 graded, 2 unchanged" in again.stderr
    report = " ".join((tmp_path / "reports" / "alice.txt").read_text().split())
    reason = "grading it took longer than 4 s (--timeout raises the limit)"
    assert (
        f"answer-floating-link and answer-launch-nodes (8): the documents cannot be read: {reason}"
        in report
    )
