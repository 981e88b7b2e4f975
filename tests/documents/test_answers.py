"""Answers under the headings that students use, in every kind of document, and how a heading is matched to a question."""

import re
from collections.abc import Mapping, Sequence

import pytest

from grader.lab.checks.manual import answered
from grader.lab.checks.outcome import Outcome
from grader.lab.submission.submission import Submission
from tests.checks.submissions import REFERENCE, URDF, Submitted
from tests.corpus.cases import read_corpus
from tests.documents.files import PICTURE, docx, pdf
from tests.examples import spread
from tests.work import limited_work

VANISHES, NODES = (
    "It vanishes, as it has two roots.",
    "robot_state_publisher publishes the transforms.",
)
FIRST = (
    "What happens if you start it now, and why?",
    ["task 1 step 15", "step 15", "required question 1 of 2", "question 1 of 2"],
)
SECOND = (
    "Name some nodes, and what they do.",
    ["task 2 step 2", "required question 2 of 2", "question 2 of 2"],
)
Files = Mapping[str, str | bytes]
Question = tuple[str, list[str]]
ROBOT = Submitted({URDF: REFERENCE.files[URDF]})

# Pages in Markdown with two headings and their answers, which are cases of the corpus.
PAGES = [
    case.files["work/report.md"]
    for case in read_corpus()
    if "documents/answers: the heading" in case.name
]


def ask(files: Files, question: Question) -> Outcome:
    """Return the outcome of one question; it is always pending and begins with the question."""
    return _outcome(ROBOT.with_files(files).submission, question)


def both(files: Files) -> tuple[Outcome, Outcome]:
    """Return the outcomes of both questions."""
    submission = ROBOT.with_files(files).submission
    return _outcome(submission, FIRST), _outcome(submission, SECOND)


def _outcome(submission: Submission, question: Question) -> Outcome:
    text, places = question
    outcome = answered(submission, question=text, places=places)
    assert outcome.status == "pending"
    return outcome._replace(message=outcome.message.removeprefix(f"{text} "))


def is_certain(outcome: Outcome) -> bool:
    """Return whether the passage is taken as the answer."""
    return outcome.message.startswith("The answer ")


@pytest.mark.parametrize(
    ("kind", "page"),
    [
        (kind, page)
        for kind, step in {"txt": 2, "docx": 4, "pdf": 3, "google.pdf": 2}.items()
        for page in PAGES[::step]
    ],
)
def test_headings_in_every_kind_of_document(kind: str, page: str) -> None:
    """What is a heading in Markdown is one in text, Word and PDF, also of Google Docs; its answer ends at the next heading."""
    lines = (page if kind == "txt" else re.sub(r"[#*]|__", "", page)).splitlines()
    made = {
        "pdf": lambda: pdf(lines),
        "google.pdf": lambda: pdf(lines, by_word=True),
        "docx": lambda: docx(*lines),
    }
    one, two = both({f"report.{kind}": made.get(kind, page.encode)()})
    assert (is_certain(one), VANISHES in str(one.measured), NODES in str(one.measured)) == (
        True,
        True,
        False,
    ), one
    assert (is_certain(two), VANISHES in str(two.measured), NODES in str(two.measured)) == (
        True,
        False,
        True,
    ), two


@pytest.mark.parametrize("by_word", [False, True])
def test_a_pdf_has_the_lines_that_it_shows(by_word: bool) -> None:
    """Words that are placed separately are joined to lines of any length; short lines and numbers stay lines."""
    lines = [
        "Task 1: Step 15",
        "It vanishes, as it has two roots.",
        "a  b c",
        "1.",
        "WWWWWWWWWWWWWWWWWWWW i i i i",
        "So it does.",
    ]
    shown = str(ask({"report.pdf": pdf(lines, ["and", "more"], by_word=by_word)}, FIRST).measured)
    assert [" ".join(line.split()) for line in shown.splitlines() if line] == [
        *(" ".join(line.split()) for line in lines),
        "and",
        "more",
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    "content",
    [
        " ".join(f"BT /F1 12 Tf 1 0 0 -1 0 0 Tm {x} {-x} Td (w) Tj ET" for x in (1, 10**9, 10**30)),
        " ".join(
            f"BT /F1 12 Tf 1 0 0 -1 0 0 Tm {x} 9 Td (w) Tj ET" for x in range(0, 10**12, 10**8)
        ),
        "q " * 5000
        + "BT /F1 12 Tf 1 0 0 -1 0 0 Tm 1 1 Td (w) Tj 1 0 0 -1 0 0 Tm 9 20 Td (w) Tj ET",
        "BT /F1 12 Tf "
        + " ".join(f"1 0 0 -1 0 0 Tm 1 {y} Td (w) Tj" for y in range(12_000))
        + " ET",
    ],
)
def test_a_crafted_page_is_read_within_limits(
    content: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Words that are very far apart or very many take bounded time and memory, and the text is there."""
    monkeypatch.setattr(
        "tests.documents.files._placed",
        lambda _: f"BT /F1 12 Tf 50 800 Td (Task 1: Step 15) Tj ET {content}",
    )
    outcome = ask({"report.pdf": pdf([""], by_word=True)}, FIRST)
    assert "w" in str(outcome.measured)
    assert len(str(outcome.measured)) < 40_000


def test_the_page_of_an_answer_is_named() -> None:
    """The message names the page of a PDF, also of an empty page before."""
    data = pdf(["Lab 6"], [PICTURE], ["Task 1: Step 15", VANISHES], ["Task 2: Step 2", NODES])
    one, two = both({"report.pdf": data})
    assert one.message == "The answer on page 3 of report.pdf, needs manual grading"
    assert two.message == "The answer on page 4 of report.pdf, needs manual grading"
    assert one.measured == f"Task 1: Step 15\n{VANISHES}"


def test_an_answer_across_pages_is_whole() -> None:
    """An answer that begins on one page continues on the next one; its page is that of its heading."""
    one = ask(
        {"report.pdf": pdf(["Task 1: Step 15", VANISHES], ["So it does.", "Task 2: Step 2"])}, FIRST
    )
    assert [line for line in str(one.measured).splitlines() if line] == [
        "Task 1: Step 15",
        VANISHES,
        "So it does.",
    ]
    assert "on page 1 of report.pdf" in one.message


def test_the_heading_or_page_in_a_word_file_is_named() -> None:
    """A Word file that Word has saved knows its pages; else the heading is named."""
    plain = docx("Task 1: Step 15", VANISHES)
    assert (
        ask({"a.docx": plain}, FIRST).message
        == 'The answer in a.docx, below "Task 1: Step 15", needs manual grading'
    )
    paged = docx("Lab 6", "\fTask 1: Step 15", VANISHES, "\fTask 2: Step 2", NODES)
    one, two = both({"a.docx": paged})
    assert one.message == "The answer on page 2 of a.docx, needs manual grading"
    assert two.message == "The answer on page 3 of a.docx, needs manual grading"


def test_the_same_report_twice() -> None:
    """A report that was submitted in two formats is matched in each of them."""
    lines = ["REQUIRED Question:", VANISHES, "REQUIRED Question:", NODES]
    one, two = both({"report.docx": docx(*lines), "report.pdf": pdf(lines)})
    assert (is_certain(one), is_certain(two)) == (True, True)


def test_long_documents_are_cut_with_a_note() -> None:
    """Pages after the limit are not read, and the message says so."""
    one = ask({"report.pdf": pdf(*[[f"page {number}"] for number in range(101)])}, FIRST)
    assert one.message.endswith("(not read: report.pdf after page 100, the limit for a document)")
    exact = ask({"report.pdf": pdf(*[["Lab 6"]] * 99, ["Task 1 Step 15", VANISHES])}, FIRST)
    assert exact.message == "The answer on page 100 of report.pdf, needs manual grading"


@pytest.mark.slow
@pytest.mark.parametrize(
    "line",
    spread(
        [
            "Step 15",
            "# Step 15",
            "we did then the step 15 of it and more",
            "REQUIRED Question:",
            "2. x",
            "a1 " * 160,
        ],
        2,
    ),
)
def test_documents_of_headings_are_bounded(line: str) -> None:
    """Documents that consist of headings take no longer than their lines."""
    files: Files = {f"{number}.md": "# Task 1\n" + f"{line}\n" * 1999 for number in range(5)}
    with limited_work(30_000_000):
        both(files)


def test_text_that_looks_like_a_picture_or_page_changes_no_page() -> None:
    """The signs that mark pages and pictures cannot be part of a student's text."""
    texts: Sequence[str] = ("Task 1: Step 15", "It \ufffc vanishes.")
    assert ask({"a.docx": docx(*texts)}, FIRST).measured == "Task 1: Step 15\nIt   vanishes."
