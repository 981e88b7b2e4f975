"""The checks on robots that pass, robots that fail, and robots that lack what a check needs."""

import pytest
from arm_checks import distance_between

from grader import Configuration, MissingElement, read_urdf

ARM = """<robot name="arm">
  <link name="base"/>
  <link name="tip"/>
  <joint name="shoulder" type="fixed">
    <parent link="base"/><child link="tip"/><origin xyz="{}"/></joint>
</robot>
"""


def arm(xyz: str) -> Configuration:
    """Return an arm whose tip is at a point of the base's frame, in metres."""
    robot = read_urdf(ARM.format(xyz).encode()).robot
    assert robot is not None
    return Configuration(robot)


@pytest.mark.parametrize(
    ("xyz", "status"),
    [
        ("0 0 0.5", "passed"),
        ("0.3 0 -0.4", "passed"),  # equal distances are equally correct
        ("0 0 0.5019", "passed"),
        ("0 0 0.5021", "failed"),
        ("0 0 0", "failed"),
    ],
)
def test_the_distance_is_measured(xyz: str, status: str) -> None:
    """The check passes within its tolerance, and fails just outside."""
    outcome = distance_between(
        arm(xyz), link="tip", relative_to="base", distance=0.5, tolerance=0.002
    )
    assert outcome.status == status


def test_the_message_says_what_was_measured() -> None:
    """A student reads what was measured, and what was expected."""
    outcome = distance_between(
        arm("0 0 0.4"), link="tip", relative_to="base", distance=0.5, tolerance=0.002
    )
    assert (
        outcome.message
        == "the distance of 'tip' from 'base' is 0.4 m; it should be 0.5 m (100 mm too small)"
    )


def test_a_missing_link_is_not_the_checks_concern() -> None:
    """The grader fails the criterion, and says which links there are."""
    with pytest.raises(MissingElement, match="there is no link 'hand'"):
        distance_between(
            arm("0 0 0.5"), link="hand", relative_to="base", distance=0.5, tolerance=0.002
        )
