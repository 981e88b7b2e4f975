"""Comments for an LMS: safe HTML that says which points were lost, and that is recognised again."""

import re
from decimal import Decimal
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from grader.checks.outcome import Outcome
from grader.classroom.lms.comments import LIMIT, CommentItem, comment_html, comment_items, is_own_comment
from grader.classroom.tables import neutral
from grader.grading.report import ManualMark, Result
from grader.grading.rubric import read_rubric
from tests.samples import ROOT

SMALL = ROOT / "tests/corpus/class/small/small.toml"
CRITERIA = {one.id: one for one in read_rubric(SMALL.read_bytes(), Path("small.toml")).criteria}
OWN = (
    "<p>Graded automatically: 58.5 of 100 points.</p><ul><li>The base: 2 of 4. it is 0.1 m too low</li></ul>"
    "<!-- grader 81396dd30bb0 -->"
)
ITEM = CommentItem("The base", Decimal(2), Decimal(4), "it is 0.1 m too low")


def result(name: str, outcome: Outcome, because: str | None = None, mark: ManualMark | None = None) -> Result:
    return Result(CRITERIA[name], outcome, because, "", mark)


def skipped(name: str, because: str = "loads", mark: ManualMark | None = None) -> Result:
    return result(name, Outcome("skipped", f"not decided, because {because} failed"), because, mark)


def test_criteria_are_grouped_by_cause() -> None:
    """Criteria that are skipped or open for one reason are one item; messages begin with a capital."""
    loads = result("loads", Outcome("failed", "the file has no root"))
    text = comment_html(Decimal(0), Decimal(11), [*comment_items([loads, *map(skipped, ("box", "tall", "essay"))])])
    assert re.findall("<li>(.*?)</li>", text) == [
        "About loads: 0 of 3. The file has no root",
        "3 criteria were skipped because loads failed: 0 of 7.",
    ]
    pending = Outcome("pending", "nobody can tell; needs manual grading")
    (item,) = comment_items([result(name, pending) for name in ("box", "tall")])
    why = "Nobody can tell; needs manual grading"
    assert item == CommentItem("2 criteria need manual grading", Decimal(0), Decimal(3), why, is_open=True)


def test_criteria_with_their_own_cause_stay_separate() -> None:
    """A single skip, a question with its model answer, and a manual comment; not a criterion with full points."""
    asks = Outcome("pending", "a person has to mark it", "this", "that")
    found = [
        result("loads", Outcome("passed", "fine")),
        skipped("box", mark=ManualMark(Decimal(1), "me", "nice try")),
        skipped("tall", "box"),
        result("essay", asks),
        result("picture", asks._replace(measured='xyz="0" is off', message='xyz="0" is off')),
    ]
    assert [(item.title, item.message) for item in comment_items(found)] == [
        ("About box", "nice try"),
        ("About tall", "Not decided, because box failed"),
        ("About essay", "A person has to mark it"),
        ("About picture", 'xyz="0" is off'),
    ]


def test_own_comments_are_recognised() -> None:
    """The same words in other tags and spaces are the grader's, also of earlier versions; other words are a person's."""
    assert comment_html(Decimal("58.5"), Decimal(100), [ITEM]) == OWN
    assert is_own_comment(OWN.replace("<p>", "<p dir='ltr'>\n ").replace("</li>", "</li>\n"))
    for other in (OWN.replace("too low", "far too low"), OWN.replace("automatically", "badly"), OWN[:-30], ""):
        assert not is_own_comment(other)


def test_a_comment_is_limited() -> None:
    """A long comment says how many items it omits."""
    items = [CommentItem(f"Criterion {n}", Decimal(0), Decimal(1), "x" * 200) for n in range(90)]
    text = comment_html(Decimal(0), Decimal(90), items)
    assert 10 < text.count("Criterion") < 90
    assert f"<li>... and {90 - text.count('Criterion')} more</li></ul>" in text
    assert len(text) <= LIMIT


ITEMS = st.builds(
    CommentItem, st.text(max_size=900), st.decimals(-5, 5, places=2), st.just(Decimal(5)), st.text(max_size=900)
)


@given(st.lists(ITEMS, max_size=8), st.text(max_size=50))
def test_a_comment_is_always_safe(items: list[CommentItem], graded: str) -> None:
    """Any text gives one line within the limit, with only the grader's tags, no formula, and is recognised again."""
    text = comment_html(Decimal(1), Decimal(2), items, graded)
    assert len(text) <= LIMIT
    assert text.splitlines() == [text]
    assert neutral(text) == text
    assert set(re.findall(r"</?\w+", text)) <= {"<p", "</p", "<ul", "</ul", "<li", "</li"}
    assert "\\" not in text
    assert is_own_comment(text)
    assert is_own_comment(text.encode("cp1252", "xmlcharrefreplace").decode("cp1252"))
    text.encode("utf-8")
