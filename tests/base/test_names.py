"""Where ROS 2 or xacro rejects a file for one unambiguous word, the rest is graded as the file is meant."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.names import closest, near
from tests.examples import examples

SAME = [
    ("wheel_lenght", "wheel_length", ""),
    ("Left_wheel", "left_wheel", ""),
    ("leftWheel", "left_wheel", ""),
    ("baselink", "base_link", ""),
    ("base", "base_link", "link"),
    ("lidr", "lidar_link", "link"),
    ("lidar_jiont", "lidar_joint", "joint"),
    ("rigth_wheel", "right_wheel", ""),
    ("fotoprnit", "footprint", ""),
]
OTHER = [
    ("y_offset", "x_offset", ""),
    ("link_4", "link_0", ""),
    ("link_11", "link_1_1", ""),
    ("right_wheel", "front_wheel", ""),
    ("lower_arm", "upper_arm", ""),
    ("wheel_width", "wheel_height", ""),
    ("arm_l", "arm_r", ""),
    ("art", "arm", ""),
    ("whl", "wheel", ""),
    ("base", "base_link", ""),
    ("base_wheel", "base", "link"),
    ("max_speed", "min_speed", ""),
]


@pytest.mark.parametrize("row", SAME)
def test_near_names(row: tuple[str, str, str]) -> None:
    """Letter case, one or two letters of a long word, and the suffix of the kind may differ."""
    assert near(row[0], [row[1], "another_name"], row[2]) == row[1]


@pytest.mark.parametrize("row", OTHER)
def test_other_names(row: tuple[str, str, str]) -> None:
    """Numbers, single letters and words of side, place, axis or measure never stand for one another."""
    assert near(row[0], [row[1]], row[2]) is None


@examples(60)
@given(st.text("ab1_", max_size=6), st.sets(st.text("ab1_", max_size=6), max_size=4))
def test_the_nearest_is_another_known_name(name: str, known: set[str]) -> None:
    """What a name stands for is one of the known ones, does not depend on their order, and has the same numbers."""
    found = near(name, sorted(known))
    assert found == near(name, sorted(known, reverse=True))
    assert found is None or (
        found in known - {name} and [*filter(str.isdigit, found)] == [*filter(str.isdigit, name)]
    )


@pytest.mark.parametrize(
    ("name", "known", "suggestion"),
    [
        ("wheel_left_joint", ["right_wheel_joint", "left_wheel_joint"], "left_wheel_joint"),
        ("wheel_left_joint", ["right_wheel_joint"], None),
        ("front_wheel", ["rear_wheel"], None),
        ("link_4", ["link_0"], None),
        ("lft_wheel", ["left_wheel"], "left_wheel"),
        ("xzy", ["xyz"], "xyz"),
        ("joint_base_lidar", ["base_lidar_join", "base_lidar_joint"], "base_lidar_joint"),
    ],
)
def test_a_suggestion_is_no_sibling(name: str, known: list[str], suggestion: str | None) -> None:
    """The same words in another order win over other letters, and a name of another side or number is never offered."""
    assert closest(name, known) == suggestion
