"""Comments for an LMS: safe HTML that says which points were lost, and that is recognised again."""

import re
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.lms.feedback import MAX_LINES, comment_html, is_own_comment, lost_points
from grader.lab.checks.outcome import Outcome
from grader.lab.grading.report import ManualComment, ManualMark, Result
from grader.lab.rubric.rubric import read_rubric
from tests.samples import ROOT

pytestmark = pytest.mark.slow

SMALL = ROOT / "tests/corpus/class/small/small.toml"
CRITERIA = {one.id: one for one in read_rubric(SMALL.read_bytes(), Path("small.toml")).criteria}
OPENING = "Graded automatically: 58.5 of 100 points."
OWN = (
    "<p>Graded automatically: 58.5 of 100 points.</p><ul><li>The base: 2 of 4. it is 0.1 m too low</li></ul>"
    "<!-- grader 81396dd30bb0 -->"
)


def test_lost_points() -> None:
    """A line for each mistake, skip, open question, mark and comment; none for a criterion with full points."""
    skip, asks = (
        Outcome("skipped", "skipped because loads failed"),
        Outcome("pending", "a person has to mark it", "this", "that"),
    )
    found = [
        Result(CRITERIA["loads"], Outcome("passed", "fine")),
        Result(CRITERIA["loads"], Outcome("failed", "it is off")),
        Result(CRITERIA["loads"], Outcome("passed", "fine"), comment=ManualComment("nice", "Kim")),
        Result(
            CRITERIA["box"], skip, "loads", manual_mark=ManualMark(Decimal(1), "me", "nice try")
        ),
        Result(CRITERIA["tall"], skip, "loads"),
        Result(CRITERIA["tall"], Outcome("failed", "it is too low"), carried="box"),
        Result(CRITERIA["essay"], skip, "loads"),
        Result(CRITERIA["essay"], asks, comment=ManualComment("see me", "Kim")),
    ]
    assert list(lost_points(found)) == [
        "0 of 3, passes when: About loads: it is off",
        "3 of 3: About loads. nice",
        "1 of 2.5, passes when: About box. nice try",
        "0 of 0.5, passes when: About tall: skipped because loads failed",
        "0.5 of 0.5, passes when: About tall: it is too low. No points lost for tall: it fails only because of box.",
        "0 of 4: About essay: skipped because loads failed",
        "– of 4: About essay: a person has to mark it. see me",
    ]
    zeros = [line for line in lost_points(found, has_open_zeros=True) if line.startswith("–")]
    assert zeros == ["– of 4 (counted as 0 for now): About essay: a person has to mark it. see me"]


def test_own_comments_are_recognised() -> None:
    """The same words in other tags and spaces are the grader's, also of earlier versions; other words are a person's."""
    assert comment_html(OPENING, ["The base: 2 of 4. it is 0.1 m too low"]) == OWN
    assert is_own_comment(OWN.replace("<p>", "<p dir='ltr'>\n ").replace("</li>", "</li>\n"))
    for other in (
        OWN.replace("too low", "far too low"),
        OWN.replace("automatically", "badly"),
        OWN[:-30],
        "",
    ):
        assert not is_own_comment(other)


def test_a_comment_is_limited() -> None:
    """A long comment says how many items it omits, and fits into a cell of Excel."""
    text = comment_html(OPENING, [f"Criterion {n}: {'x' * 2000}" for n in range(90)])
    assert text.count("Criterion") == MAX_LINES
    assert f"<li>... and {90 - MAX_LINES} more</li></ul>" in text
    assert len(text) <= 32_767


@given(
    st.text(max_size=50),
    st.lists(
        st.text(max_size=900) | st.text(st.sampled_from(";=-+@ \\<&'\"a"), max_size=9), max_size=8
    ),
)
def test_a_comment_is_always_safe(graders: str, lines: list[str]) -> None:
    """Any text gives one line, with only the grader's tags, no formula, and is recognised again."""
    text = comment_html(f"Graded manually by {graders}", lines)
    assert text.splitlines() == [text]
    assert not re.search(r"[;\t]\s*[=+\-@＝＋－＠]", text)
    assert set(re.findall(r"</?\w+", text)) <= {"<p", "</p", "<ul", "</ul", "<li", "</li"}
    assert "\\" not in text
    assert is_own_comment(text)
    assert is_own_comment(text.encode("cp1252", "xmlcharrefreplace").decode("cp1252"))
    text.encode("utf-8")
