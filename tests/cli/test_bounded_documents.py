"""A Word file that takes very long: its cost, its effect on a mark, and the end of the process that reads it."""

import io
import os
import re
import shutil
import signal
import subprocess
import sys
import zipfile
import zlib
from contextlib import suppress
from pathlib import Path

import pytest

from grader.app.cli.app import run
from grader.base.errors import OutOfTime
from grader.lab.documents.converter import __file__ as converter
from grader.workers.pool import NO_MEMORY
from tests.classroom.class_runs import eventually, grader, newest, session_of, started
from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT

REFERENCE = ROOT / "rubrics" / "lab6" / "my_robot"


PARAGRAPH = f"<p>{'<t/>' * 1000}</p>"


def docx_of(paragraphs: int) -> bytes:
    """Return a Word file of some kilobytes that unpacks to paragraphs of a thousand empty texts each."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("word/document.xml", f"<body>{PARAGRAPH * paragraphs}</body>")
    assert len(data.getvalue()) < 100_000
    return data.getvalue()


def pdf_of(page: bytes) -> bytes:
    """Return a PDF file of some kilobytes with one page."""
    packed = zlib.compress(page, 9)
    objects = [
        b"<</Type/Catalog/Pages 2 0 R>>",
        b"<</Type/Pages/Kids[3 0 R]/Count 1>>",
        b"<</Type/Page/Parent 2 0 R/Contents 4 0 R/Resources<</Font<</F1 5 0 R>>>>>>",
        b"<</Length %d/Filter/FlateDecode>>stream\n%s\nendstream" % (len(packed), packed),
        b"<</Type/Font/Subtype/Type1/BaseFont/Helvetica>>",
    ]
    body = b"".join(b"%d 0 obj\n%s\nendobj\n" % item for item in enumerate(objects, 1))
    return b"%%PDF-1.4\n%strailer<</Root 1 0 R/Size 6>>\nstartxref\n0\n%%%%EOF\n" % body


def write_submission(folder: Path) -> Path:
    """Write the reference solution with a slow document beside it."""
    shutil.copytree(REFERENCE, folder / "my_robot")
    (folder / "answers.docx").write_bytes(docx_of(450))
    (folder / "notes.md").write_text("Task 1 step 15: It vanishes.\n")
    return folder


@pytest.mark.slow
def test_a_slow_document_needs_manual_grading(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is not read, everything else has its result, and another document is read all the same."""
    monkeypatch.setattr("grader.lab.documents.collection.MAX_SECONDS", 0.2)
    assert run(["grade", "--verbose", str(write_submission(tmp_path / "alice"))]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    reason = "the Word and PDF files take longer than 0.2 s in all; needs manual grading"
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


@pytest.mark.slow
@pytest.mark.parametrize("name", ["answers.docx", "answers.pdf"])
@pytest.mark.parametrize("factor", [1, 1000])
def test_what_is_no_answer_is_not_read(name: str, factor: int, tmp_path: Path) -> None:
    """The work is counted, whatever time it takes: some kilobytes of far too many texts, and the same with few of them."""
    shutil.copytree(REFERENCE, tmp_path / "my_robot")
    data = docx_of(factor)
    if name == "answers.pdf":
        text = b"(Task 1 step 15: It vanishes.) Tj T* "
        data = pdf_of(b"BT /F1 12 Tf " + text + b"(a) Tj " * 1000 * (factor - 1) + b"ET")
    (tmp_path / name).write_bytes(data)
    done = grader("grade", "--verbose", tmp_path)
    assert done.returncode == 0
    shown = " ".join(done.stdout.split())
    reason = f"{name} was not read: it has far more content than an answer; needs manual grading"
    assert (reason in shown) == (factor == 1000)
    assert "may be damaged" not in shown


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        (MemoryError, NO_MEMORY),
        (
            OutOfTime,
            "grading it took longer than 20 s of processor time (--timeout raises the limit)",
        ),
    ],
)
def test_a_mark_never_depends_on_a_document(
    fault: type[BaseException], reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If grading fails because of a document, the submission is graded again without it, with the same points."""

    def fail(*_: object, **__: object) -> None:
        raise fault

    monkeypatch.setattr("grader.lab.documents.collection.find_headings", fail)
    write_submission(tmp_path / "class" / "alice")
    shutil.copytree(REFERENCE, tmp_path / "class" / "bob" / "my_robot")
    book = tmp_path / "lab"
    command = ("batch", tmp_path / "class", "--gradebook", book, "--jobs", "2")
    assert "2 graded, 0 unchanged" in grader(*command).stderr
    for line in newest(book).values():
        points = [entry[0] for entry in line["results"].values()]
        assert (line["verdict"], sum(filter(None, points)), points.count(None)) == ("graded", 90, 3)
    again = grader(*command, "--reports", tmp_path / "reports")
    assert "0 graded, 2 unchanged" in again.stderr
    report = " ".join((tmp_path / "reports" / "alice.txt").read_text().split())
    assert (
        f"answer-floating-link and answer-launch-nodes (8): the documents cannot be read: {reason}"
        in report
    )
