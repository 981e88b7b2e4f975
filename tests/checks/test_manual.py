"""Manual grading: the answer and the pictures that are shown. Both checks are always pending."""

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from grader.checks.manual import answered, evidence_shown
from grader.checks.outcome import Outcome
from grader.documents.document import MAX_LINES
from grader.source import Location
from grader.submission.submission import Opening
from tests.checks.outcomes import ask
from tests.checks.submissions import ANSWERS, REFERENCE, URDF, Submitted, gif, jpeg, png
from tests.documents.files import docx
from tests.samples import ROOT

PLACES = ["task 1 step 15", "step 15"]
ANSWER = "There are two roots."
QUESTION = "What happens?"
STEP_8 = ["task 1 step 8"]
WEBCAM = ["task 3 step 3", "task 3", "webcam", "camera"]
ALONE = Submitted({URDF: REFERENCE.files[URDF]})
NOT_FOUND = "What happens? No answer was found under 'task 1 step 15' or 'step 15'"


def answer_in(submitted: Submitted, locations: Sequence[str] = PLACES) -> Outcome:
    """Return the message about the answer to step 15; it is always pending and never contains the model answer."""
    outcome = ask(answered, submitted, question=QUESTION, answer=ANSWER, places=list(locations))
    assert (outcome.status, outcome.expected) == ("pending", None)
    assert ANSWER not in repr(outcome)
    return outcome


def passage(files: dict[str, str | bytes], locations: Sequence[str] = PLACES) -> tuple[object, Location | None]:
    """Return the passage shown from some documents and its location."""
    outcome = answer_in(ALONE.with_files(files), locations)
    if outcome.location is not None:
        at = outcome.location
        assert outcome.message == f"What happens? The answer in {at.path}, from line {at.line}, needs manual grading"
    return outcome.measured, outcome.location


def pictures(submitted: Submitted, names: Sequence[str] = STEP_8) -> tuple[str, object]:
    """Return the outcome for a piece of evidence; always pending."""
    outcome = ask(evidence_shown, submitted, names=list(names))
    assert (outcome.status, outcome.expected, outcome.location) == ("pending", None, None)
    return outcome.message, outcome.measured


# --- Answers ----------------------------------------------------------------------------------------------------------


def test_the_passage_is_shown() -> None:
    """The heading and the text below it are shown up to the next heading, with the location of the first line."""
    outcome = answer_in(REFERENCE)
    assert outcome.message == "What happens? The answer in answers.md, from line 3, needs manual grading"
    assert outcome.measured == (
        "## Task 1, step 15\n\nThe robot vanishes: two links have no parent, and a robot has one root."
    )
    assert outcome.location == REFERENCE.location_of(ANSWERS, "## Task 1")


@pytest.mark.parametrize(
    "text",
    [
        "# Task 1 Step 15\nIt vanishes.",
        "Task 1, step 15: It vanishes.",
        "**Task 1, Step 15:** It vanishes.",
        "T1S15 It vanishes.",
        "- task1_step15 - It vanishes.",
        "| Task 1 Step 15 | It vanishes. |",
        "Lab 6 - Task 1 - Step 15\nIt vanishes.",
        "TASK 1 STEP 15\n\nIt vanishes.\nAll of it.",
    ],
)
def test_headings_are_found_in_every_spelling(text: str) -> None:
    """A question is found by its task and step, in every spelling and kind of list."""
    more = f"Something else\n\n{text}\n\nTask 2, step 2: rviz2."
    assert passage({"answers.txt": more}) == (text, Location("answers.txt", 3, 1))


def test_a_heading_of_a_task_applies_to_its_steps() -> None:
    """A step below the heading of a task belongs to that task."""
    text = "# Task 1\n## Step 15\nIt vanishes.\n## Step 18\nno\n# Task 2\n## Step 2\nrviz2\n## Step 15\nno\n"
    assert passage({"answers.md": text}) == ("## Step 15\nIt vanishes.", Location("answers.md", 2, 1))
    assert passage({"answers.md": text}, ["task 2 step 2"])[0] == "## Step 2\nrviz2"


def test_the_best_match_is_shown() -> None:
    """The same step of another task is shown only if there is no better match."""
    other, right = "Task 2\nStep 15: no", "Task 1\nStep 15: It vanishes."
    assert passage({"answers.txt": f"{other}\n{right}"})[0] == "Step 15: It vanishes."
    assert passage({"a.txt": other, "b.txt": right})[0] == "Step 15: It vanishes."
    found = answer_in(ALONE.with_files({"a.txt": other}))
    how = "below a heading of task 2: it may answer another question"
    assert found.message == f"What happens? Perhaps the answer in a.txt, from line 2 ({how}); needs manual grading"
    assert found.measured == "Step 15: no"


def test_a_table_of_contents_is_no_answer() -> None:
    """A heading with an answer below it is preferred to one without text."""
    text = "Contents\nTask 1 Step 15 ..... 2\nTask 2 Step 2 ..... 3\n\nTask 1 Step 15\nIt vanishes, for it has two roots.\n"
    assert passage({"answers.txt": text})[0] == "Task 1 Step 15\nIt vanishes, for it has two roots."
    assert passage({"answers.txt": "Task 1 Step 15: yes"})[0] == "Task 1 Step 15: yes"


def test_a_mentioned_step_does_not_end_an_answer() -> None:
    """A sentence about another step belongs to the answer; only a heading ends it."""
    marked = "## Task 1 step 15\nIt vanishes.\nStep 18 mends it.\n## Task 1 step 18\nno\n"
    assert passage({"answers.md": marked})[0] == "## Task 1 step 15\nIt vanishes.\nStep 18 mends it."
    plain = "Task 1 step 15\nIt vanishes.\nOnly with step 18 of the lab is there one root again.\nTask 1 step 18\nno\n"
    assert passage({"answers.txt": plain})[0] == "\n".join(plain.splitlines()[:3])


def test_a_line_that_mentions_the_step_late_is_no_heading() -> None:
    """A line that mentions the step only near its end is not its heading."""
    text = "As I have said before, in all of task 1 step 15 is the hardest.\n"
    assert passage({"answers.txt": text}) == (None, None)


@pytest.mark.parametrize("name", ["step15.txt", "Step 15.md", "Task1_Step15.txt", "lab6_task1_q15.md", "T1S15.txt"])
def test_a_file_named_after_the_step_is_the_answer(name: str) -> None:
    """A file for one step is shown whole, from its first line with text."""
    assert passage({name: "\n\nIt vanishes.\n\nStep 18 is another.\n"}) == (
        "It vanishes.\n\nStep 18 is another.",
        Location(name, 3, 1),
    )


def test_questions_by_number() -> None:
    """A lab may number its questions."""
    assert passage({"a.txt": "Q14: no\nQ15: It vanishes.\nQ16: no"}, ["question 15"])[0] == "Q15: It vanishes."


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_windows_texts_are_read(encoding: str) -> None:
    """Texts in the encodings of Windows editors are shown as they were written."""
    text = "Task 1 step 15: It doesn’t show, says the café.\r\n\r\nTask 2 step 2: no\r\n"
    expected = "Task 1 step 15: It doesn’t show, says the café."
    assert passage({"answers.txt": text.encode(encoding)}) == (expected, Location("answers.txt", 1, 1))


def test_a_long_answer_is_whole() -> None:
    """An answer of many lines is shown whole; only a text that no student writes is cut, and the cut is marked."""
    lines, _ = passage({"answers.md": "# Task 1 step 15\n" + "x\n" * 1000 + "because of the roots\n"})
    assert isinstance(lines, str)
    assert lines.endswith("x\nbecause of the roots")
    text, _ = passage({"answers.md": "# Task 1 step 15\n" + "x" * 90_000})
    assert isinstance(text, str)
    assert text.endswith("x [...]")
    assert len(text) < 33_000


def test_no_answer_at_all() -> None:
    """Without an answer manual grading is needed; the message says where the grader looked."""
    assert answer_in(ALONE).message == f"{NOT_FOUND}; needs manual grading"
    other = answer_in(ALONE.with_files({"notes.txt": "It vanishes.\n", "answers.md": "\n"}))
    assert other.message == f"{NOT_FOUND} in answers.md and notes.txt; needs manual grading"
    assert (other.measured, other.location) == (None, None)


@pytest.mark.parametrize(
    "line",
    ["15. It vanishes.", "15) It vanishes.", "(15) It vanishes.", "1.15) It vanishes.", "Schritt 15: It vanishes."],
)
def test_plain_numbers_for_steps(line: str) -> None:
    """A step may be a plain number, if it is not part of a short list."""
    found = answer_in(ALONE.with_files({"a.txt": f"Lab 6\n{line}\n16. 0.15\n"}))
    assert str(found.measured).startswith(line)
    short = answer_in(ALONE.with_files({"a.txt": "Lab 6\n1. It vanishes.\n5. No.\n"}))
    assert short.measured is None


def test_an_xml_snippet_in_an_answer_is_no_robot() -> None:
    """An answer may quote the file that it is about."""
    text = "## Step 15\n\nIt vanishes:\n\n```xml\n<robot name='r'>\n```\n"
    assert "It vanishes" in str(answer_in(ALONE.with_files({"a.md": text})).measured)


def test_other_texts_are_not_searched() -> None:
    """Robots, build files and licences are not searched for answers."""
    texts = {
        "robot.txt": "<robot name='r'/> Task 1 step 15: no",
        "my_robot/CMakeLists.txt": "Task 1 step 15: no",
        "requirements.txt": "Task 1 step 15: no",
    }
    assert answer_in(ALONE.with_files({**texts})).message == f"{NOT_FOUND}; needs manual grading"


def test_documents_by_other_names() -> None:
    """A rubric may name the documents with the answers."""
    submitted = ALONE.with_files({"answers.txt": "Step 15: no", "report.tex": "Step 15: yes"})
    outcome = ask(answered, submitted, question=QUESTION, answer=ANSWER, places=PLACES, files=("*.tex",))
    assert outcome.measured == "Step 15: yes"


def test_a_word_file_is_read() -> None:
    """Paragraphs and tables of a Word file are read as lines."""
    data = docx("Task 1 step 15", "It vanishes.", "Task 1 step 18", "no", row=("Task 2 step 2", "rviz2 shows it"))
    found = answer_in(ALONE.with_files({"answers.docx": data}))
    assert found.message == 'What happens? The answer in answers.docx, below "Task 1 step 15", needs manual grading'
    assert (found.measured, found.location) == ("Task 1 step 15\nIt vanishes.", Location("answers.docx", 1, 1))
    row = answer_in(ALONE.with_files({"answers.docx": data}), ["task 2 step 2"])
    assert row.measured == "Task 2 step 2\trviz2 shows it"


@pytest.mark.parametrize("name", ["answers.docx", "answers.pdf"])
def test_a_damaged_document_is_named(name: str) -> None:
    """A document that cannot be read is named for the person who grades; other documents are read all the same."""
    message = answer_in(ALONE.with_files({name: b"no document"})).message
    assert message.startswith(f"{NOT_FOUND}; needs manual grading (not read: {name} ")
    assert message.endswith(": open it yourself)")
    beside = answer_in(ALONE.with_files({name: b"no document", "b.txt": "Task 1 step 15: It vanishes."}))
    assert beside.measured == "Task 1 step 15: It vanishes."
    assert f" (not read: {name} " in beside.message


@pytest.mark.parametrize("name", ["answers.docx", "answers.pdf"])
def test_without_the_readers_the_document_is_named(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """If the packages for Word and PDF are not installed, the message says how to install them."""
    monkeypatch.setattr(sys, "executable", "python-that-is-not-there")
    message = f"{name} could not be read on this machine: open it yourself"
    assert message in answer_in(ALONE.with_files({name: b""})).message
    monkeypatch.undo()
    monkeypatch.setattr("grader.documents.converter.MISSING", 1)  # as a damaged document ends
    message = f"{name} is read only with the grader's extra `documents`: open it yourself"
    assert message in answer_in(ALONE.with_files({name: b"no document"})).message


SLOW = b"import time; time.sleep(60)"  # a converter that never ends
TOO_LATE = "was not read: the Word and PDF files take longer than 0.5 s in all; needs manual grading"


def converter(code: bytes, path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Return a function that replaces the converter by other code."""
    path.write_bytes(code)
    monkeypatch.setattr("grader.documents.converter.__file__", str(path))


def test_all_documents_share_one_budget(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A document that takes too long uses up the time of later documents; texts are read all the same."""
    log = tmp_path / "log"
    converter(f"open({str(log)!r}, 'a').write('x')\n".encode() + SLOW, tmp_path / "slow.py", monkeypatch)
    monkeypatch.setattr("grader.documents.collection.MAX_SECONDS", 0.5)
    submitted = ALONE.with_files({f"{name}.pdf": b"" for name in "abcd"} | {"e.txt": "Task 1 step 15: It vanishes."})
    outcome = answer_in(submitted)
    assert outcome.measured == "Task 1 step 15: It vanishes."
    assert outcome.message.endswith(f"(not read: {'; '.join(f'{name}.pdf {TOO_LATE}' for name in 'abcd')})")
    assert not log.exists() or log.read_text() == "x"  # the first one may end before it writes; no other one starts


def test_the_converter_bounds_its_own_processor_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The system stops a converter that the grader cannot stop."""
    code = f"import sys; sys.argv[2] = '1'; sys.path.insert(0, {str(ROOT)!r})\n"
    code += "from grader.documents import converter\n"
    code += "converter._pdf = lambda data: str(sum(0 for _ in iter(int, 1)))\nsys.exit(converter.main())"
    converter(code.encode(), tmp_path / "busy.py", monkeypatch)
    monkeypatch.setattr("grader.documents.collection.MAX_SECONDS", 60.0)
    message = answer_in(ALONE.with_files({"a.pdf": b""})).message
    assert "a.pdf was not read: the Word and PDF files take longer than 60 s in all" in message


def test_a_document_is_converted_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two questions about the same document start one converter."""
    log = tmp_path / "log"
    text = "Step 15: It vanishes.\nStep 18: yes"
    converter(f"open({str(log)!r}, 'a').write('x'); print({text!r})".encode(), tmp_path / "count.py", monkeypatch)
    submission = ALONE.with_files({"a.pdf": b""}).submission
    for at_location, text in (("step 15", "Step 15: It vanishes."), ("step 18", "Step 18: yes")):
        assert answered(submission, question=QUESTION, answer=ANSWER, places=[at_location]).measured == text
    assert log.read_text() == "x"


def test_the_number_of_converted_documents_is_limited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The message names the limit and the first document beyond it."""
    converter(b"print('none')", tmp_path / "none.py", monkeypatch)
    message = answer_in(ALONE.with_files({f"{number}.pdf": b"" for number in range(10)})).message
    assert "8.pdf was not read: at most 8 Word and PDF files are; needs manual grading; 9.pdf" in message
    assert "7.pdf was not read" not in message


@pytest.mark.parametrize("name", ["answers.doc", "answers.odt", "answers.rtf", "answers.pages"])
def test_a_document_of_another_kind_is_named(name: str) -> None:
    """A document of an unsupported kind is named, so that the person who grades opens it."""
    message = (
        f"{NOT_FOUND}; needs manual grading (not read: {name} has a format that is not supported: open it yourself)"
    )
    assert answer_in(ALONE.with_files({name: b"text"})).message == message


def test_a_text_that_is_too_large_is_named() -> None:
    """A text above the size limit is not read."""
    message = answer_in(ALONE.with_files({"answers.txt": "Step 15: x\n" * 200_000})).message
    assert message == f"{NOT_FOUND}; needs manual grading (not read: answers.txt is larger than 1048576 bytes)"


def test_the_lines_of_a_document_are_capped_with_a_note() -> None:
    """Text after the last line that is read is not found, and the report says so."""
    end = "\n" * MAX_LINES + "Step 15: late\n"
    cut = f"answers.md after line {MAX_LINES}, the limit for a document"
    message = f"{NOT_FOUND} in answers.md; needs manual grading (not read: {cut})"
    assert answer_in(ALONE.with_files({"answers.md": end})).message == message
    last = "\n" * (MAX_LINES - 1) + "Step 15: in time\n"
    found = answer_in(ALONE.with_files({"answers.md": last}))
    assert (found.measured, "not read" in found.message) == ("Step 15: in time", False)


def test_the_number_of_documents_is_capped_with_a_note() -> None:
    """Beyond forty documents the rest is counted."""
    message = answer_in(ALONE.with_files({f"{number:02}.md": "" for number in range(45)})).message
    assert message.endswith("(not read: 5 documents after the first 40, the limit)")


def test_documents_that_broke_the_grading_need_manual_grading() -> None:
    """The model answer stays beside the question, and no document is converted."""
    submission = replace(REFERENCE.submission, opening=Opening(no_documents="it took long"))
    outcome = answered(submission, question=QUESTION, answer=ANSWER, places=PLACES)
    message = "What happens? The documents cannot be read: it took long; needs manual grading"
    assert (outcome.status, outcome.message, outcome.expected) == ("pending", message, None)


# --- Evidence ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "path",
    [
        "Task1_Step8.png",
        "task 1 step 8.png",
        "TASK1-STEP8.PNG",
        "task1step8.png",
        "t1s8.png",
        "lab6_task1_q8.png",
        "Lab6_Task1_Step08.png",
        "Task1_Step8_second try.png",
        "Task1_Steps8-9.png",
        "Task 1/Step 8.png",
        "Task 1/Task 1 Step 8/picture.png",
        "pictures/task1.8.png",
    ],
)
def test_pictures_are_found_in_every_spelling(path: str) -> None:
    """Task and step are found in the name or in the folders; the message has size and dimensions."""
    size = len(png())
    expected = (f"needs manual grading: {path} (640 x 480 pixels, {size} bytes)", (path,))
    assert pictures(ALONE.with_files({path: png()})) == expected


@pytest.mark.parametrize(
    "path", ["Task1_Step18.png", "Task2_Step8.png", "Task 2/Step 8.png", "Task1/Task2_Step8.png", "8.png"]
)
def test_pictures_of_other_steps_are_not_shown(path: str) -> None:
    """Step 18 is not step 8, and a step of another task is not shown; existing pictures are listed."""
    message = f"no picture or PDF is named 'task 1 step 8'; the submission has {path}; needs manual grading"
    assert pictures(ALONE.with_files({path: png()})) == (message, None)


@pytest.mark.parametrize(
    "path", ["Task 3/Step 3.png", "Task3_Step3.png", "Task 3/anything.png", "webcam.png", "my_WebCam_image.png", "Cameras.png"]
)  # fmt: skip
def test_pictures_by_words(path: str) -> None:
    """Evidence may also be named by words, whole or as a prefix."""
    assert pictures(ALONE.with_files({path: png()}), WEBCAM)[1] == (path,)


def test_long_lists_are_cut() -> None:
    """At most three names, and at most six files are in the message, but all of them in the report's data."""
    message, _ = pictures(ALONE, WEBCAM)
    assert "is named 'task 3 step 3', 'task 3' or 'webcam'" in message
    paths = [f"Task1_Step8_{number}.png" for number in range(9)]
    message, found = pictures(ALONE.with_files({path: png() for path in paths}))
    assert message.count(" pixels") == 6
    assert found == tuple(paths)


@pytest.mark.parametrize(
    ("path", "data", "words"),
    [
        ("Task1_Step8.jpg", jpeg(800, 600), "800 x 600 pixels, 23 bytes"),
        ("Task1_Step8.gif", gif(320, 240), "320 x 240 pixels, 14 bytes"),
        ("Task1_Step8.png", png() + bytes(5000), "640 x 480 pixels, 5 kB"),
        ("Task1_Step8.png", png() + bytes(2_500_000), "640 x 480 pixels, 2.5 MB"),
        ("Task1_Step8.pdf", b"%PDF-1.7\n", "9 bytes"),
        ("Task1_Step8.mp4", b"film", "4 bytes"),
        ("Task1_Step8.heic", b"no such thing", "13 bytes"),
        ("Task1_Step8.png", b"\x89PNG\r\n\x1a\n", "8 bytes"),
        ("Task1_Step8.png", png()[:20], "20 bytes"),
        ("Task1_Step8.png", b"no picture", "10 bytes"),
        ("Task1_Step8.png", b"", "0 bytes"),
    ],
    ids=["jpeg", "gif", "kB", "MB", "pdf", "film", "heic", "damaged", "cut", "no-picture", "empty"],
)
def test_the_description_of_a_file(path: str, data: bytes, words: str) -> None:
    """A picture has its dimensions, if they can be read; damaged pictures and other files have their size."""
    assert pictures(ALONE.with_files({path: data})) == (f"needs manual grading: {path} ({words})", (path,))


def test_the_pictures_of_the_reference_are_found() -> None:
    """The pictures of the reference are found."""
    for names, path in (
        (STEP_8, "Task1_Step8.png"),
        (["task 1 step 18"], "Task1_Step18.png"),
        (WEBCAM, "Task3_Step3.png"),
    ):
        assert pictures(REFERENCE, names)[1] == (path,)


def test_what_is_in_doubt_is_a_field() -> None:
    """A heading with the question alone, a picture with a misspelt name, and what was not found."""
    empty = answer_in(ALONE.with_files({"a.md": "# Task 1 step 15\n\nWhat happens?\n\n# Task 1 step 16\n\nNo.\n"}))
    assert "only the question is there" in empty.message
    webcm = ask(evidence_shown, ALONE.with_files({"webcm.png": png()}), names=["webcam"])
    many = ask(evidence_shown, ALONE.with_files({f"{name}.png": png() for name in "abcdefghijklm"}), names=["webcam"])
    found = (empty.problem, webcm.problem, many.problem, answer_in(ALONE).problem)
    assert found == ("only the question is there", "perhaps", "not found", "not found")
    assert many.message.endswith(" more; needs manual grading")
    assert webcm.message.endswith("perhaps: webcm.png (640 x 480 pixels, 118 bytes)")
