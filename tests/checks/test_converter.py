"""Answers in Word and PDF files: what converts them, and its limits."""

import sys
from collections.abc import Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path
from types import SimpleNamespace

import pytest

from grader.base.source import Location
from grader.lab.checks.manual import answered
from grader.lab.checks.outcome import Outcome
from grader.lab.submission.submission import Opening
from tests.checks.outcomes import ask
from tests.checks.submissions import REFERENCE, URDF, Submitted
from tests.documents.files import docx
from tests.samples import ROOT

pytestmark = pytest.mark.slow

PLACES = ["task 1 step 15", "step 15"]
ANSWER = "There are two roots."
QUESTION = "What happens?"
ALONE = Submitted({URDF: REFERENCE.files[URDF]})
NOT_FOUND = "What happens? No answer was found under 'task 1 step 15' or 'step 15'"


def answer_in(submitted: Submitted, locations: Sequence[str] = PLACES) -> Outcome:
    """Return the message about the answer to step 15; it is always pending and never contains the model answer."""
    outcome = ask(answered, submitted, question=QUESTION, answer=ANSWER, places=list(locations))
    assert (outcome.status, outcome.expected) == ("pending", None)
    assert ANSWER not in repr(outcome)
    return outcome


def test_a_word_file_is_read() -> None:
    """Paragraphs and tables of a Word file are read as lines."""
    data = docx(
        "Task 1 step 15",
        "It vanishes.",
        "Task 1 step 18",
        "no",
        row=("Task 2 step 2", "rviz2 shows it"),
    )
    found = answer_in(ALONE.with_files({"answers.docx": data}))
    assert (
        found.message
        == 'What happens? The answer in answers.docx, below "Task 1 step 15", needs manual grading'
    )
    assert (found.measured, found.location) == (
        "Task 1 step 15\nIt vanishes.",
        Location("answers.docx", 1, 1),
    )
    row = answer_in(ALONE.with_files({"answers.docx": data}), ["task 2 step 2"])
    assert row.measured == "Task 2 step 2\trviz2 shows it"


@pytest.mark.parametrize("name", ["answers.docx", "answers.pdf"])
def test_a_damaged_document_is_named(name: str) -> None:
    """A document that cannot be read is named for the person who grades; other documents are read all the same."""
    message = answer_in(ALONE.with_files({name: b"no document"})).message
    assert message.startswith(f"{NOT_FOUND}; needs manual grading (not read: {name} ")
    assert message.endswith(": open it yourself)")
    beside = answer_in(
        ALONE.with_files({name: b"no document", "b.txt": "Task 1 step 15: It vanishes."})
    )
    assert beside.measured == "Task 1 step 15: It vanishes."
    assert f" (not read: {name} " in beside.message


@pytest.mark.parametrize("name", ["answers.docx", "answers.pdf"])
def test_without_the_readers_the_document_is_named(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the packages for Word and PDF are not installed, the message says how to install them."""
    monkeypatch.setattr(sys, "executable", "python-that-is-not-there")
    message = f"{name} could not be read on this machine: open it yourself"
    assert message in answer_in(ALONE.with_files({name: b""})).message
    monkeypatch.undo()
    monkeypatch.setattr("grader.lab.documents.converter.MISSING", 1)  # as a damaged document ends
    message = f"{name} is read only with the grader's extra `documents`: open it yourself"
    assert message in answer_in(ALONE.with_files({name: b"no document"})).message


SLOW = b"import time; time.sleep(60)"  # a converter that never ends
TOO_LATE = (
    "was not read: the Word and PDF files take longer than 0.5 s in all; needs manual grading"
)


def converter(code: bytes, path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Return a function that replaces the converter by other code."""
    path.write_bytes(code)
    monkeypatch.setattr("grader.lab.documents.converter.__file__", str(path))


def test_all_documents_share_one_budget(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A document that takes too long uses up the time of later documents; texts are read all the same."""
    log = tmp_path / "log"
    converter(
        f"open({str(log)!r}, 'a').write('x')\n".encode() + SLOW, tmp_path / "slow.py", monkeypatch
    )
    monkeypatch.setattr("grader.lab.documents.collection.MAX_SECONDS", 0.5)
    submitted = ALONE.with_files(
        {f"{name}.pdf": b"" for name in "abcd"} | {"e.txt": "Task 1 step 15: It vanishes."}
    )
    outcome = answer_in(submitted)
    assert outcome.measured == "Task 1 step 15: It vanishes."
    assert outcome.message.endswith(
        f"(not read: {'; '.join(f'{name}.pdf {TOO_LATE}' for name in 'abcd')})"
    )
    assert (
        not log.exists() or log.read_text() == "x"
    )  # the first one may end before it writes; no other one starts


def test_the_time_of_a_converter_is_taken_from_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each one gets what those before it have left of the processor time, the first one all of it."""
    used = count(0, 0.25)  # by the processes that have ended, from none of them on
    monkeypatch.setattr(
        "os.times",
        lambda: SimpleNamespace(children_user=next(used), children_system=0.0, elapsed=1e6),
    )
    log = tmp_path / "log"
    code = f"import sys; open({str(log)!r}, 'a').write(sys.argv[2] + ' ')"
    converter(code.encode(), tmp_path / "log.py", monkeypatch)
    answer = b"Task 1 step 15: It vanishes."
    answer_in(ALONE.with_files({f"{name}.pdf": b"" for name in "abc"} | {"d.txt": answer}))
    assert log.read_text().split() == ["3.0", "2.75", "2.5"]


def test_the_converter_bounds_its_own_processor_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The system stops a converter that the grader cannot stop."""
    code = f"import sys; sys.argv[2] = '1'; sys.path.insert(0, {str(ROOT)!r})\n"
    code += "from grader.lab.documents import converter\n"
    code += "converter._pdf = lambda data: str(sum(0 for _ in iter(int, 1)))\nsys.exit(converter.main())"
    converter(code.encode(), tmp_path / "busy.py", monkeypatch)
    monkeypatch.setattr("grader.lab.documents.collection.MAX_SECONDS", 60.0)
    message = answer_in(ALONE.with_files({"a.pdf": b""})).message
    assert "a.pdf was not read: the Word and PDF files take longer than 60 s in all" in message


def test_a_document_is_converted_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two questions about the same document start one converter."""
    log = tmp_path / "log"
    text = "Step 15: It vanishes.\nStep 18: yes"
    converter(
        f"open({str(log)!r}, 'a').write('x'); print({text!r})".encode(),
        tmp_path / "count.py",
        monkeypatch,
    )
    submission = ALONE.with_files({"a.pdf": b""}).submission
    for at_location, text in (("step 15", "Step 15: It vanishes."), ("step 18", "Step 18: yes")):
        assert (
            answered(submission, question=QUESTION, answer=ANSWER, places=[at_location]).measured
            == text
        )
    assert log.read_text() == "x"


def test_the_number_of_converted_documents_is_limited(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The message names the limit and the first document beyond it."""
    converter(b"print('none')", tmp_path / "none.py", monkeypatch)
    message = answer_in(ALONE.with_files({f"{number}.pdf": b"" for number in range(10)})).message
    assert (
        "8.pdf was not read: at most 8 Word and PDF files are; needs manual grading; 9.pdf"
        in message
    )
    assert "7.pdf was not read" not in message


def test_documents_that_broke_the_grading_need_manual_grading() -> None:
    """The model answer stays beside the question, and no document is converted."""
    submission = replace(REFERENCE.submission, opening=Opening(no_documents="it took long"))
    outcome = answered(submission, question=QUESTION, answer=ANSWER, places=PLACES)
    message = "What happens? The documents cannot be read: it took long; needs manual grading"
    assert (outcome.status, outcome.message, outcome.expected) == ("pending", message, None)
