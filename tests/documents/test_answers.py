"""Answers under the headings that students use, in every kind of document, and how a heading is matched to a question."""

import io
import re
from collections.abc import Mapping, Sequence

import pytest

from grader.checks.manual import answered
from grader.checks.outcome import Outcome
from grader.submission.submission import Submission
from tests.checks.submissions import REFERENCE, URDF, Submitted
from tests.corpus.cases import read_corpus
from tests.documents.files import PICTURE, docx, pdf
from tests.examples import spread
from tests.work import limited_work

VANISHES, NODES = "It vanishes, as it has two roots.", "robot_state_publisher publishes the transforms."
FIRST = (
    "What happens if you start it now, and why?",
    ["task 1 step 15", "step 15", "required question 1 of 2", "question 1 of 2"],
)
SECOND = ("Name some nodes, and what they do.", ["task 2 step 2", "required question 2 of 2", "question 2 of 2"])
Files = Mapping[str, str | bytes]
Question = tuple[str, list[str]]
ROBOT = Submitted({URDF: REFERENCE.files[URDF]})

# Pages in Markdown with two headings and their answers, which are cases of the corpus.
PAGES = [case.files["work/report.md"] for case in read_corpus() if "documents/answers: the heading" in case.name]


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
    [(kind, page) for kind, step in {"txt": 2, "docx": 4, "pdf": 3, "google.pdf": 2}.items() for page in PAGES[::step]],
)
def test_headings_in_every_kind_of_document(kind: str, page: str) -> None:
    """What is a heading in Markdown is one in text, Word and PDF, also of Google Docs; its answer ends at the next heading."""
    lines = (page if kind == "txt" else re.sub(r"[#*]|__", "", page)).splitlines()
    made = {"pdf": lambda: pdf(lines), "google.pdf": lambda: pdf(lines, by_word=True), "docx": lambda: docx(*lines)}
    one, two = both({f"report.{kind}": made.get(kind, page.encode)()})
    assert (is_certain(one), VANISHES in str(one.measured), NODES in str(one.measured)) == (True, True, False), one
    assert (is_certain(two), VANISHES in str(two.measured), NODES in str(two.measured)) == (True, False, True), two


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
        *(" ".join(line.split()) for line in lines), "and", "more",
    ]  # fmt: skip


@pytest.mark.parametrize(
    "content",
    [
        " ".join(f"BT /F1 12 Tf 1 0 0 -1 0 0 Tm {x} {-x} Td (w) Tj ET" for x in (1, 10**9, 10**30)),
        " ".join(f"BT /F1 12 Tf 1 0 0 -1 0 0 Tm {x} 9 Td (w) Tj ET" for x in range(0, 10**12, 10**8)),
        "q " * 5000 + "BT /F1 12 Tf 1 0 0 -1 0 0 Tm 1 1 Td (w) Tj 1 0 0 -1 0 0 Tm 9 20 Td (w) Tj ET",
        "BT /F1 12 Tf " + " ".join(f"1 0 0 -1 0 0 Tm 1 {y} Td (w) Tj" for y in range(12_000)) + " ET",
    ],
)
def test_a_crafted_page_is_read_within_limits(content: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Words that are very far apart or very many take bounded time and memory, and the text is there."""
    monkeypatch.setattr(
        "tests.documents.files._placed", lambda _: f"BT /F1 12 Tf 50 800 Td (Task 1: Step 15) Tj ET {content}"
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
    one = ask({"report.pdf": pdf(["Task 1: Step 15", VANISHES], ["So it does.", "Task 2: Step 2"])}, FIRST)
    assert [line for line in str(one.measured).splitlines() if line] == ["Task 1: Step 15", VANISHES, "So it does."]
    assert "on page 1 of report.pdf" in one.message


def test_the_heading_or_page_in_a_word_file_is_named() -> None:
    """A Word file that Word has saved knows its pages; else the heading is named."""
    plain = docx("Task 1: Step 15", VANISHES)
    assert (
        ask({"a.docx": plain}, FIRST).message == 'The answer in a.docx, below "Task 1: Step 15", needs manual grading'
    )
    paged = docx("Lab 6", "\fTask 1: Step 15", VANISHES, "\fTask 2: Step 2", NODES)
    one, two = both({"a.docx": paged})
    assert one.message == "The answer on page 2 of a.docx, needs manual grading"
    assert two.message == "The answer on page 3 of a.docx, needs manual grading"


def test_styles_of_word() -> None:
    """Heading styles, bold paragraphs and numbered lists of Word are headings, although their text has neither sign nor number."""
    data = docx("Task 1", "Step 15", VANISHES, "Task 2", "Step 1", "no", "Step 2", NODES, "Conclusion", "All went well.",
                styles=["Heading 1", "Heading 2", "", "Heading 1", "bold", "", "bold", "", "Heading 1"])  # fmt: skip
    one, two = both({"a.docx": data})
    assert one.measured == f"## Step 15\n{VANISHES}"
    assert two.measured == f"**Step 2**\n{NODES}"
    listed = docx("Task 2", "It builds.", NODES, "It runs.", styles=["", *["List Number"] * 3])
    assert str(ask({"a.docx": listed}, SECOND).measured) == f"1. It builds.\n2. {NODES}\n3. It runs."


def numbered(text: str, *items: tuple[int, str], level: str = "", override: str = "") -> bytes:
    """Return a Word file with these paragraphs in list 77, each with its level; `text` is that of the numbers of level 0."""
    from docx.oxml import parse_xml
    from docx.oxml.ns import nsdecls

    document = pytest.importorskip("docx").Document()
    root = document.part.numbering_part.element
    levels = (
        f'<w:lvl w:ilvl="0"><w:start w:val="15"/><w:numFmt w:val="decimal"/><w:lvlText w:val="{text}"/></w:lvl>{level}'
    )
    root.insert(0, parse_xml(f'<w:abstractNum {nsdecls("w")} w:abstractNumId="88">{levels}</w:abstractNum>'))
    root.append(parse_xml(f'<w:num {nsdecls("w")} w:numId="77"><w:abstractNumId w:val="88"/>{override}</w:num>'))
    for depth, line in items:
        paragraph = document.add_paragraph(line)
        if depth >= 0:
            number = f'<w:ilvl w:val="{depth}"/><w:numId w:val="77"/>'
            paragraph._p.get_or_add_pPr().append(parse_xml(f"<w:numPr {nsdecls('w')}>{number}</w:numPr>"))
    data = io.BytesIO()
    document.save(data)
    return data.getvalue()


def test_numbers_that_word_writes() -> None:
    """A number and the text around it are those that Word shows: start, levels, bullets, lists that begin anew."""
    ending = (-1, "Task 2: Step 2")
    first = numbered("Step %1.", (0, VANISHES), (0, "no"), ending)
    assert ask({"a.docx": first}, FIRST).measured == f"Step 15. {VANISHES}"
    deep = '<w:lvl w:ilvl="1"><w:numFmt w:val="decimal"/><w:lvlText w:val="%1.%2)"/></w:lvl>'
    below = numbered("Step %1.", (0, "See below"), (1, VANISHES), (1, "So."), (0, "no"), (1, "no"), ending, level=deep)
    assert ask({"a.docx": below}, FIRST).measured == f"Step 15. See below\n15.1) {VANISHES}\n15.2) So."
    assert ask({"a.docx": below}, ("Why?", ["step 16"])).measured == "Step 16. no\n16.1) no"
    anew = '<w:lvlOverride w:ilvl="0"><w:startOverride w:val="2"/></w:lvlOverride>'
    again = numbered("%1.", (-1, "Task 2"), (0, NODES), override=anew)
    assert ask({"a.docx": again}, SECOND).measured == f"2. {NODES}"
    bullets = numbered("%1.", (-1, "Task 1: Step 15"), (1, VANISHES), level=deep.replace("decimal", "bullet"))
    assert ask({"a.docx": bullets}, FIRST).measured == f"Task 1: Step 15\n{VANISHES}"
    damaged = numbered("%1.", (-1, "Task 1: Step 15"), (5, VANISHES))
    assert ask({"a.docx": damaged}, FIRST).measured == f"Task 1: Step 15\n{VANISHES}"


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


@pytest.mark.parametrize(
    "line",
    spread(
        ["Step 15", "# Step 15", "we did then the step 15 of it and more", "REQUIRED Question:", "2. x", "a1 " * 160], 2
    ),
)
def test_documents_of_headings_are_bounded(line: str) -> None:
    """Documents that consist of headings take no longer than their lines."""
    files: Files = {f"{number}.md": "# Task 1\n" + f"{line}\n" * 1999 for number in range(5)}
    with limited_work(10_000_000):
        both(files)


def test_text_that_looks_like_a_picture_or_page_changes_no_page() -> None:
    """The signs that mark pages and pictures cannot be part of a student's text."""
    texts: Sequence[str] = ("Task 1: Step 15", "It \ufffc vanishes.")
    assert ask({"a.docx": docx(*texts)}, FIRST).measured == "Task 1: Step 15\nIt   vanishes."
