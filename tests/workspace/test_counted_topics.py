"""Names that are not known are counted, and a family in which nothing is compared is undecided."""

import pytest

from grader.workspace.rules.names import Counted
from tests.workspace.carts import Edit, agreement_of, edited

pytestmark = pytest.mark.slow

_ALARM, _DETECTOR = "cart_nodes/alarm.py", "cart_nodes/detector.py"
_COMPUTED: Edit = (_ALARM, '(Bool, "obstacle",', '(Bool, self.find_name() + "/obstacle",')
_NOT_PUBLISHED: Edit = (_DETECTOR, 'self.create_publisher(Bool, "obstacle", 10)', "print")
_NO_IMAGE: Edit = (_DETECTOR, 'self.create_subscription(Image, "image", self.on_image, 10)', "pass")


def test_topics_that_are_known_need_no_count() -> None:
    """Each of the three has another end: a node's, or the bridge's."""
    found = agreement_of(edited())
    assert found.counts["topics"].compared == 3
    assert found.counts["topics"].words == ""
    assert found.holds("topics")


def test_a_computed_name_is_counted() -> None:
    """One other topic still is compared, that of the bridge."""
    found = agreement_of(edited(_COMPUTED))
    assert found.counts["topics"].words == "1 of 3 names compared: 1 is computed"
    assert "topics" not in found.undecided


def test_where_nothing_is_compared_nothing_agrees() -> None:
    """The only name is computed."""
    found = agreement_of(edited(_COMPUTED, _NOT_PUBLISHED, _NO_IMAGE))
    assert found.undecided["topics"] == "0 of 1 name compared: 1 is computed"
    assert not found.holds("topics")


def test_topics_without_another_end_are_not_compared() -> None:
    """All names are known, so that nobody has to grade them."""
    subscribed = (_ALARM, '(Bool, "obstacle",', '(Bool, "door",')
    found = agreement_of(edited(subscribed, _NOT_PUBLISHED, _NO_IMAGE))
    assert "topics" not in found.undecided
    assert found.counts["topics"].compared == 0


def test_no_name_at_all_is_said_without_a_count() -> None:
    """What is not read may have names."""
    assert Counted("topics", 0, 0, "nothing is read").words == "no name compared: nothing is read"
