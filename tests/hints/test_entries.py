"""A hint that needs an earlier one names it as the report shows it."""

import pytest

from grader.lab.grading.grade import grade
from grader.lab.hints import search
from grader.lab.hints.hinting import hinted
from grader.lab.submission.opening import read_submission
from grader.report.content import failures
from grader.report.criteria import hint_text
from tests.hints.trials import BASES
from tests.samples import LAB6, SAMPLES

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", ["caster-misnamed"])
def test_an_earlier_edit_is_named_by_the_entry_that_shows_it(name: str) -> None:
    """Not by a criterion that is listed below another one with the same edit."""
    found = failures(hinted(SAMPLES[name].grade(), SAMPLES[name].open(), "edit").report)
    hints = (failure.result.hint for failure in found if not failure.first)
    texts = [hint.message.partition("`")[0] for hint in hints if hint is not None]
    references = [text for text in texts if text.startswith(("After", "Fixed with"))]
    named = {
        failure.result.criterion.id
        for failure in found
        for text in references
        if _names(text, failure.result.criterion.id)
    }
    assert references
    assert named
    assert named <= {failure.result.criterion.id for failure in found if not failure.first}


_SAMPLE = SAMPLES["wheel-axes-along-x"]
_FORWARD = "left-wheel-forward", "right-wheel-forward"


def _edits_named() -> list[str]:
    report = hinted(_SAMPLE.grade(), _SAMPLE.open(), "edit").report
    hints = [result.hint for result in report.results if result.criterion.id in _FORWARD]
    return [hint.message for hint in hints if hint is not None]


def test_a_criterion_names_the_edits_that_it_needs() -> None:
    """A wheel needs the edits of its own joint, not those of the other wheel."""
    assert _edits_named() == [
        "Fixed with left-wheel-placed and left-wheel-spins.",
        "Fixed with right-wheel-placed and right-wheel-spins.",
    ]


def test_all_edits_are_named_where_no_trials_are_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """Which of them are needed is not known then, and all are enough."""
    monkeypatch.setattr(search, "_MAX_WITHOUT", 0)
    every = "left-wheel-placed, right-wheel-placed, left-wheel-spins and right-wheel-spins"
    assert _edits_named() == [f"Fixed with {every}."] * 2


def _names(text: str, criterion: str) -> bool:
    return criterion in text.replace(",", " ").replace(".", " ").split()


@pytest.mark.parametrize(("break_", "place"), [("\n      ", "after line 17"), ("", "in line 17")])
def test_an_addition_says_whether_more_of_the_line_follows(break_: str, place: str) -> None:
    """If more of the line follows, "after line 17" would be outside of the visual, where ROS 2 ignores an origin."""
    before, origin, after = BASES["reference"].text.partition(
        '\n      <origin xyz="0 0 0.1" rpy="0 0 0"/>\n      '
    )
    submission = read_submission(
        (before + break_ + after).encode(), identity="test", path="robot.urdf"
    )
    hints = (
        result.hint for result in hinted(grade(LAB6, submission), submission, "edit").report.results
    )
    messages = [hint.message for hint in hints if hint is not None]
    assert origin
    assert f'Add `<origin xyz="0 0 0.1"/>` {place}.' in messages


def test_what_two_edits_fix_is_listed_below_the_costlier_one() -> None:
    """It is no mistake of its own, and is fixed with both."""
    text = BASES["reference"].text
    for old, new in (
        ("0.15 0 0.225", "0.225 0 0.15"),
        ('radius="0.1" length="0.05"', 'radius="0.4" length="0.05"'),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    submission = read_submission(text.encode(), identity="test", path="robot.urdf")
    mistakes = failures(hinted(grade(LAB6, submission, ["task1"]), submission, "cause").report)
    below = {one.id: one.first for one in mistakes}
    assert below == {"lidar-frame": "", "lidar-on-top": "lidar-frame", "lidar-shape": ""}
    hint = mistakes[0].result.hint
    assert hint is not None
    assert hint_text(mistakes[0], hint).endswith(
        ". lidar-on-top: Fixed with lidar-frame and lidar-shape."
    )
