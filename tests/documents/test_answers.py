"""Answers under the headings that students use, in every kind of document, and how a heading is matched to a question."""

import io
from collections.abc import Mapping, Sequence

import pytest

from grader.checks.manual import answered
from grader.checks.outcome import Outcome
from grader.submission.submission import Submission
from tests.checks.submissions import REFERENCE, URDF, Submitted
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

HEADINGS = [
    ("REQUIRED Question:", "REQUIRED Question:"),
    ("Required question 1", "Required question 2"),
    ("REQUIRED QUESTION 1", "REQUIRED QUESTION 2"),
    ("REQUIRED Question #1:", "REQUIRED Question #2:"),
    ("**REQUIRED Question:**", "**REQUIRED Question:**"),
    ("## Required Question", "## Required Question"),
    ("Question 1:", "Question 2:"),
    ("Question 1 (required)", "Question 2 (required)"),
    ("Answer 1:", "Answer 2:"),
    ("<b>REQUIRED Question:</b>", "<b>REQUIRED Question:</b>"),
    ("Reqired Question 1:", "Required questoin 2:"),
    ("(REQUIRED) Question:", "(REQUIRED) Question:"),
    ("Step 15 - Required question", "Step 2 - Required question"),
    ("Task 1 REQUIRED Question:", "Task 2 REQUIRED Question:"),
    ("## Task 1 - Required question", "## Task 2 - Required question"),
    ("1. REQUIRED Question:", "2. REQUIRED Question:"),
    ("| Task 1 Step 15 |", "| Task 2 Step 2 |"),
    ("Q1", "Q2"),
    ("- Q1:", "- Q2:"),
    ("Answer to required question 1:", "Answer to required question 2:"),
    ("Task 1: Step 15", "Task 2: Step 2"),
    ("Task 1 - Step 15", "Task 2 - Step 2"),
    ("**Task 1: Step 15**", "**Task 2: Step 2**"),
    ("Step 15 of Task 1", "Step 2 of Task 2"),
    ("Task 1\nStep 15.", "Task 2\nStep 2."),
    ("Task 1\nStep 15 answer", "Task 2\nStep 2 answer"),
    ("Task 1\nAnswer 15:", "Task 2\nAnswer 2:"),
    ("Task 1\n15.", "Task 2\n2."),
    ("# Task 1\n## 15.", "# Task 2\n## Step 2"),
    ("__Task 1__\n15)", "__Task 2__\n2)"),
    ("Task 1\nREQUIRED Question:", "Task 2\nREQUIRED Question:"),
    ("Task 1: Step 15\nREQUIRED Question:", "Task 2: Step 2\nREQUIRED Question:"),
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
    ("kind", "first", "second"),
    [
        (kind, *pair)
        for kind, step in {"md": 1, "txt": 2, "docx": 4, "pdf": 3, "google.pdf": 2}.items()
        for pair in HEADINGS[::step]
    ],
)
def test_headings_that_students_use(kind: str, first: str, second: str) -> None:
    """Each heading is found in Markdown, text, Word and PDF, also of Google Docs, and its answer ends at the next heading."""
    if kind.endswith(("docx", "pdf")):  # whose headings are no Markdown
        first, second = (text.replace("#", "").replace("*", "").replace("__", "") for text in (first, second))
    lines = ["Lab 6", *first.splitlines(), VANISHES, *second.splitlines(), NODES]
    made = {"pdf": lambda: pdf(lines), "google.pdf": lambda: pdf(lines, by_word=True), "docx": lambda: docx(*lines)}
    one, two = both({f"report.{kind}": made.get(kind, lambda: "\n".join(lines).encode())()})
    assert is_certain(one), one
    assert is_certain(two), two
    assert VANISHES in str(one.measured)
    assert NODES not in str(one.measured)
    assert NODES in str(two.measured)
    assert VANISHES not in str(two.measured)


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


def test_questions_in_order() -> None:
    """Two headings of the same words are taken in the order of the questions, and the message says so."""
    one, two = both({"a.md": f"REQUIRED Question: why?\n{VANISHES}\nREQUIRED Question: name some\n{NODES}\n"})
    how = '(in order: heading {} of 2 like "REQUIRED Question")'
    assert one.message == f"The answer in a.md, from line 1 {how.format(1)}, needs manual grading"
    assert two.message == f"The answer in a.md, from line 3 {how.format(2)}, needs manual grading"


def test_questions_by_their_number() -> None:
    """A number in the heading wins over the order."""
    one, two = both({"a.md": f"Required question 2:\n{NODES}\nRequired question 1:\n{VANISHES}\n"})
    assert one.measured == f"Required question 1:\n{VANISHES}"
    assert two.measured == f"Required question 2:\n{NODES}"
    assert '(by the number in "Required question 2")' in two.message
    only = {"a.md": f"Required question 2:\n{NODES}\n"}
    assert is_certain(ask(only, SECOND))
    assert ask(only, FIRST).message.startswith("No answer was found under ")


def test_questions_by_their_task() -> None:
    """The only such heading below the heading of a task belongs to the question of that task."""
    only = {"a.md": f"# Task 1\nAll done.\n# Task 2\nREQUIRED Question:\n{NODES}\n"}
    two = ask(only, SECOND)
    assert is_certain(two)
    assert '(the only "REQUIRED Question" below the heading of task 2)' in two.message
    assert NODES not in str(ask(only, FIRST).measured) or not is_certain(ask(only, FIRST))
    restarted = {"a.md": f"# Task 1\n## Question 1\n{VANISHES}\n# Task 2\n## Question 1\n{NODES}\n"}
    one, two = both(restarted)
    assert (is_certain(one), is_certain(two)) == (True, True)
    assert (VANISHES in str(one.measured), NODES in str(two.measured)) == (True, True)


@pytest.mark.parametrize(
    "text",
    [
        f"REQUIRED Question:\n{VANISHES}\n",
        f"Task 1: Step 8\nREQUIRED Question:\n{VANISHES}\nTask 2: Step 6\n",
        f"REQUIRED Question:\nno\nREQUIRED Question:\n{VANISHES}\nREQUIRED Question:\n{NODES}\n",
        f"Question 1:\nno\nQuestion 2:\n{VANISHES}\nQuestion 3:\n{NODES}\n",
        f"Required question 1:\n{VANISHES}\nRequired question 1:\n{NODES}\n",
        f"# Task 2\nQuestion 1:\n{VANISHES}\nQuestion 2:\n{NODES}\n",
        f"Question 1: units?\nm\nQuestion 2: what?\n{VANISHES}\nQuestion 3: -0.15?\nhalf\nQuestion 4: nodes\n{NODES}\n",
    ],
    ids=[
        "one-of-two",
        "one-after-a-picture",
        "three-for-two",
        "numbers-of-others",
        "number-twice",
        "other-task",
        "four",
    ],
)
def test_an_ambiguous_heading_is_no_certain_answer(text: str) -> None:
    """If it cannot be told which question a heading belongs to, the message says so, and all that may be meant is shown."""
    one = ask({"a.txt": text}, FIRST)
    assert not is_certain(one)
    assert one.message.startswith("Perhaps the answer in a.txt, from line ")
    assert VANISHES in str(one.measured)


def test_a_list_below_a_task_may_be_steps_or_points() -> None:
    """Items from 1 on may be the points of one answer: the whole list is shown, as perhaps the answer."""
    two = ask({"a.md": "# Task 2\n1. rviz2 shows it.\n2. robot_state_publisher publishes.\n"}, SECOND)
    assert two.message.startswith(
        "Perhaps the answer in a.md, from line 2 (a numbered list below the heading of task 2"
    )
    assert two.measured == "1. rviz2 shows it.\n2. robot_state_publisher publishes."
    whole = ask({"a.md": "# Task 2\n1. rviz2\n2. no\n"}, ("What did you do?", ["task 2"]))
    assert whole.measured == "# Task 2\n1. rviz2\n2. no"
    below = ask({"a.md": f"# Task 2\n## Step 2\n1. rviz2\n2. {NODES}\n"}, SECOND)
    assert below.measured == f"## Step 2\n1. rviz2\n2. {NODES}"
    assert is_certain(below)


@pytest.mark.parametrize(
    "text",
    [
        "Task 1: Step 15\nTask 2: Step 2\n",
        "REQUIRED Question: What happens if you start it now, and why?\nREQUIRED Question: Name some nodes, and what they do.\n",
        "REQUIRED Question: Run it now, what happens and why?\n\nREQUIRED Question: name some nodes and what they do\n",
        "Task 1 Step 15\nWhat happens?\nTask 2 Step 2\nName some nodes.\n",
    ],
    ids=["headings", "questions", "reworded", "below"],
)
def test_a_copied_question_is_no_answer(text: str) -> None:
    """A heading with nothing but the question is not taken as an answer."""
    for outcome in both({"a.md": text}):
        assert outcome.message.startswith("No answer was found in a.md, from line "), outcome
        assert ": only the question is there" in outcome.message


@pytest.mark.parametrize("answer", ["It vanishes, I do not know why?", "No.", "Why? Two roots.", "nothing is shown"])
def test_a_short_answer_is_an_answer(answer: str) -> None:
    """A short answer, or one that asks back, is taken as an answer."""
    assert is_certain(ask({"a.md": f"Task 1 Step 15\n{answer}\n"}, FIRST))


@pytest.mark.parametrize(
    "heading", ["Desired speed:", "Requested question of mine:", "Questions:", "The question is hard."]
)
def test_other_words_are_no_question(heading: str) -> None:
    """Words that only resemble those of a question begin no passage."""
    assert ask({"a.md": f"{heading}\n{VANISHES}\n{heading}\n{NODES}\n"}, FIRST).measured is None


def test_an_answer_wins_over_a_copied_question() -> None:
    """A list of questions at the beginning does not hide the answers below."""
    copied = "REQUIRED Question: What happens, and why?\nREQUIRED Question: Name some nodes.\n"
    one, two = both({"a.md": f"{copied}\nREQUIRED Question:\n{VANISHES}\nREQUIRED Question:\n{NODES}\n"})
    assert (is_certain(one), VANISHES in str(one.measured)) == (True, True)
    assert (is_certain(two), NODES in str(two.measured)) == (True, True)
    files: Files = {"a.md": "Task 1: Step 15 ..... 2\n", "b.md": f"REQUIRED Question 1\n{VANISHES}\n"}
    assert VANISHES in str(ask(files, FIRST).measured)


def test_the_same_report_twice() -> None:
    """A report that was submitted in two formats is matched in each of them."""
    lines = ["REQUIRED Question:", VANISHES, "REQUIRED Question:", NODES]
    one, two = both({"report.docx": docx(*lines), "report.pdf": pdf(lines)})
    assert (is_certain(one), is_certain(two)) == (True, True)


def test_a_heading_without_a_step_ends_an_answer() -> None:
    """A marked heading ends the passage, unless there is nothing above it."""
    text = f"## Task 1 Step 15\n### Answer\n{VANISHES}\n```sh\n# no heading\n```\n## Conclusion\nAll went well.\n"
    assert ask({"a.md": text}, FIRST).measured == "\n".join(text.splitlines()[:6])


def test_a_mentioned_task_changes_no_task() -> None:
    """A sentence about another task is no heading of it."""
    text = f"Task 1\nThis is as in task 2 of the lab before.\nStep 15\n{VANISHES}\n"
    assert ask({"a.txt": text}, FIRST).measured == f"Step 15\n{VANISHES}"


@pytest.mark.parametrize(
    ("one", "two"),
    [
        ("Task1/Question.txt", "Task2/Question.txt"),
        ("required_question_1.txt", "required_question_2.txt"),
        ("Q1.md", "Q2.md"),
        ("Task1_Step15.md", "Task2_Step2.md"),
    ],
)
def test_files_named_for_a_question(one: str, two: str) -> None:
    """A file with the name of a question is the answer, matched as a heading is."""
    first, second = both({one: VANISHES, two: NODES})
    assert (is_certain(first), first.measured) == (True, VANISHES)
    assert (is_certain(second), second.measured) == (True, NODES)


def test_numbers_of_a_text_are_no_steps() -> None:
    """A value after the number of a step is not another step."""
    text = f"# Task 1\nStep 26: 0.15 as half\nno\nStep 15: {VANISHES}\nStep 29: see task 2\nStep 18: no\n"
    one = ask({"a.md": text}, FIRST)
    assert one.measured == f"Step 15: {VANISHES}"
    assert ask({"a.md": text}, SECOND).measured is None


@pytest.mark.parametrize(
    ("place", "heading"),
    [
        ("floating link", "The floating link:"),
        ("floating link", "## On the floating link"),
        ("exercise 1 of 2", "Exercise 1"),
        ("exercise 1 of 1", "Exercise:"),
    ],
)
def test_a_rubric_adds_headings(place: str, heading: str) -> None:
    """The words of a place are a heading of their own, with or without its number among all."""
    question = ("What happens?", [place])
    text = f"{heading.replace('The ', '')}\n{VANISHES}\n# Task 7\nno\n"
    outcome = ask({"a.md": text}, question)
    assert is_certain(outcome), outcome
    assert VANISHES in str(outcome.measured)
    assert "no" not in str(outcome.measured).split()


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
