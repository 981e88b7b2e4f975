"""Totals and comments in a Moodle grading worksheet, in the languages that Moodle writes."""

import re
from decimal import Decimal

from hypothesis import example, given
from hypothesis import strategies as st

from grader.checks.outcome import Outcome
from grader.classroom.lms.feedback import LIMIT, FeedbackItem, feedback_html, feedback_items, is_own_feedback
from grader.classroom.tables import neutral
from grader.grading.report import ManualMark, Result
from tests.classroom.gradebooks import lab

COMMENT = feedback_html(
    Decimal("58.5"), Decimal(100), [FeedbackItem("The base", Decimal(2), Decimal(4), "it is 0.1 m too low")]
)


RUBRIC = lab()


def result(name: str, outcome: Outcome, because: str | None = None, ruling: ManualMark | None = None) -> Result:
    (criterion,) = [criterion for criterion in RUBRIC.criteria if criterion.id == name]
    return Result(criterion, outcome, because, "", ruling)


def skipped(name: str, because: str = "loads", ruling: ManualMark | None = None) -> Result:
    return result(name, Outcome("skipped", f"not decided, because {because} failed"), because, ruling)


def test_feedback_is_grouped_by_cause() -> None:
    """Criteria that are skipped or pending for one reason are one item; messages begin with a capital."""
    loads = result("loads", Outcome("failed", "the file has no root"))
    text = feedback_html(
        Decimal(0), Decimal(11), list(feedback_items([loads, *map(skipped, ("box", "tall", "essay"))]))
    )
    assert re.findall("<li>(.*?)</li>", text) == [
        "About loads: 0 of 3. The file has no root",
        "3 criteria were skipped because loads failed: 0 of 7.",
    ]
    pending = Outcome("pending", "nobody can tell; needs manual grading")
    assert list(feedback_items([result(name, pending) for name in ("box", "tall")])) == [
        FeedbackItem(
            "2 criteria need manual grading",
            Decimal(0),
            Decimal(3),
            "Nobody can tell; needs manual grading",
            is_open=True,
        )
    ]


def test_items_with_their_own_cause_stay_separate() -> None:
    """A single skip, a question with its model answer, a manual comment, and criteria with full points."""
    asks = Outcome("pending", "a person has to mark it", "this", "that")
    found = [
        result("loads", Outcome("passed", "fine")),
        skipped("box", ruling=ManualMark(Decimal(1), "me", "nice try")),
        skipped("tall", "box"),
        result("essay", asks),
        result("picture", asks._replace(measured='xyz="0" is off', message='xyz="0" is off')),
    ]
    assert [(item.title, item.message) for item in feedback_items(found)] == [
        ("About box", "nice try"),
        ("About tall", "Not decided, because box failed"),
        ("About essay", "A person has to mark it"),
        ("About picture", 'xyz="0" is off'),
    ]


def test_feedback_that_an_editor_reformatted() -> None:
    """The same words in other tags and spaces are still recognised; other words are not."""
    assert is_own_feedback(COMMENT.replace("<p>", "<p dir='ltr'>\n ").replace("</li>", "</li>\n"))
    assert not is_own_feedback(COMMENT.replace("too low", "far too low"))
    assert not is_own_feedback("Graded automatically: 3 of 4 points.")
    assert not is_own_feedback("")


def test_feedback_is_limited() -> None:
    """A long comment says how many items it omits."""
    remarks = [FeedbackItem(f"Criterion {n}", Decimal(0), Decimal(1), "x" * 200) for n in range(90)]
    text = feedback_html(Decimal(0), Decimal(90), remarks)
    shown = text.count("Criterion")
    assert 10 < shown < 90
    assert f"<li>... and {90 - shown} more</li></ul>" in text
    assert len(text) <= LIMIT


REMARKS = st.builds(
    FeedbackItem, st.text(max_size=900), st.decimals(-5, 5, places=2), st.just(Decimal(5)), st.text(max_size=900)
)


@given(st.lists(REMARKS, max_size=8))
@example([FeedbackItem("a", Decimal(0), Decimal(5), "\ufdd0 \uffff \U0001fffe \U0010ffff")])
def test_feedback_is_always_safe(remarks: list[FeedbackItem]) -> None:
    """Any text gives one line within the limit, with only the grader's tags, no formula, and is recognised again."""
    text = feedback_html(Decimal(1), Decimal(2), remarks)
    assert len(text) <= LIMIT
    assert text.splitlines() == [text]
    assert neutral(text) == text
    assert set(re.findall(r"</?\w+", text)) <= {"<p", "</p", "<ul", "</ul", "<li", "</li"}
    assert "\\" not in text
    assert is_own_feedback(text)
    assert is_own_feedback(text.encode("cp1252", "xmlcharrefreplace").decode("cp1252"))
    text.encode("utf-8")
