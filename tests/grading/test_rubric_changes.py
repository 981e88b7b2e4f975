"""The differences between two rubrics: each key that can change points, and which criteria it concerns."""

from decimal import Decimal
from pathlib import Path

import pytest

from grader.grading.criterion import Adjustment
from grader.grading.rubric import Rubric, read_rubric
from grader.grading.rubric_changes import RubricChange, concerning, rubric_changes

_TEXT = """
id = "r"
title = "R"
[[part]]
id = "p"
title = "P"
[[criterion]]
id = "loads"
part = "p"
title = "It loads"
points = 2
check = "urdf_loads"
[[criterion]]
id = "box"
part = "p"
title = "A box"
points = 4
check = "shows_box"
with = { link = "base", size = [1, 1, 1], tolerance = 0.001 }
requires = ["loads"]
"""


def rubric(text: str = _TEXT) -> Rubric:
    """Return a rubric from its text."""
    return read_rubric(text.encode(), Path("r.toml"))


def changed(*edits: tuple[str, str], more: str = "") -> Rubric:
    """Return the rubric with other text."""
    text = _TEXT
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return rubric(text + more)


@pytest.mark.parametrize(
    ("edits", "more", "expected"),
    [
        ([("points = 4", "points = 5")], "", RubricChange("box", "points", Decimal(4), Decimal(5))),
        ([("[1, 1, 1]", "[1, 1, 2]")], "", RubricChange("box", "size", (1.0, 1.0, 1.0), (1.0, 1.0, 2.0))),
        ([("tolerance = 0.001", "tolerance = 0.5")], "", RubricChange("box", "tolerance", 0.001, 0.5)),
        ([('requires = ["loads"]', "")], "", RubricChange("box", "requires", ("loads",), ())),
        ([], "bonus = true", RubricChange("box", "bonus", False, True)),
        (
            [],
            '[adjust.box]\naction = "drop"\nreason = "it was wrong"',
            RubricChange("box", "adjust", None, Adjustment("drop", "it was wrong")),
        ),
        ([('id = "r"', 'id = "r"\nurdf = "other.urdf"')], "", RubricChange("", "urdf", "robot.urdf", "other.urdf")),
        (
            [('title = "P"', 'title = "P"\nneeds = "package"')],
            "",
            RubricChange("", "part", (("p", "urdf"),), (("p", "package"),)),
        ),
    ],
)
def test_each_key_is_named_with_its_values(edits: list[tuple[str, str]], more: str, expected: RubricChange) -> None:
    """One change is one row, in both directions; a dropped criterion has not got other points as well."""
    newer = changed(*edits, more=more)
    assert rubric_changes(rubric(), newer) == {expected.criterion: (expected,)}
    back = expected._replace(before=expected.after, after=expected.before)
    assert rubric_changes(newer, rubric()) == {expected.criterion: (back,)}


def test_criteria_that_are_added_or_removed() -> None:
    """They have their points before or after."""
    newer = changed(('id = "box"', 'id = "cube"'))
    assert rubric_changes(rubric(), newer) == {
        "cube": (RubricChange("cube", "criterion", None, Decimal(4)),),
        "box": (RubricChange("box", "criterion", Decimal(4), None),),
    }


def test_words_are_no_change() -> None:
    """Titles, headings and feedback change no points."""
    newer = changed(('title = "A box"', 'title = "A cube"\nfeedback = "Look"\nabout = "base"'), ('"P"', '"Part"'))
    assert rubric_changes(rubric(), newer) == {}


def test_a_change_concerns_what_depends_on_it() -> None:
    """A criterion without a change of its own names that of one that it requires, else that of the rubric."""
    both = changed(("points = 2", "points = 1"), ('id = "r"', 'id = "r"\nurdf = "other.urdf"'))
    changes = rubric_changes(rubric(), both)
    assert [change.criterion for change in concerning(["box"], changes, rubric(), both)] == ["loads"]
    only = changed(('id = "r"', 'id = "r"\nurdf = "other.urdf"'))
    assert [change.key for change in concerning(["box"], rubric_changes(rubric(), only), rubric(), only)] == ["urdf"]
    assert list(concerning([], changes, rubric(), both)) == []
