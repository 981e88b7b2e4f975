"""Which changes leave a robot the same, and which do not."""

import pytest

from grader.lab.authoring.equivalents import is_same_robot
from grader.lab.authoring.mutants import mutants
from grader.ros.package.robot_file import read_as_ros
from tests.authoring.robots import ARM, CHANGES
from tests.hints.behaviour import behaviour, differences
from tests.hints.trials import BASES

pytestmark = pytest.mark.slow

REFERENCE = read_as_ros(ARM.encode(), "birch.urdf")


def is_same(old: str, new: str, *kept: str) -> bool:
    """Return whether the robot stays the same if one text in it becomes another."""
    assert old in ARM
    return is_same_robot(
        REFERENCE, read_as_ros(ARM.replace(old, new, 1).encode(), "birch.urdf"), kept
    )


@pytest.mark.parametrize("change", CHANGES["same"], ids=lambda change: change["new"])
def test_what_cannot_be_seen_leaves_the_robot_the_same(change: dict[str, str]) -> None:
    """Defaults, full turns, symmetric shapes, lengths of axes, spelling, and names that nothing refers to."""
    assert is_same(change["old"], change["new"])


@pytest.mark.parametrize("change", CHANGES["different"], ids=lambda change: change["new"])
def test_what_changes_the_robot_does_not(change: dict[str, str]) -> None:
    """Poses, shapes, colours, masses, axes, limits, mimics, dynamics, the tree, the verdict, and what simulators read."""
    assert not is_same(change["old"], change["new"])


def test_a_name_that_something_refers_to_counts() -> None:
    """A rubric, or another file of the package."""
    assert not is_same('joint name="tool_joint"', 'joint name="other"', "tool_joint")


def test_no_mutant_of_lab6_that_counts_as_the_same_robot_behaves_otherwise() -> None:
    """Shapes, colours, axes and frames, measured in the frame of the base, are where they were."""
    base = BASES["reference"]
    urdf, expected = base.submission.urdf, behaviour(base.submission)
    same = 0
    for mutant in mutants(base.text):
        changed = base.changed(mutant.applied(base.text))
        if is_same_robot(urdf, changed.urdf, ()):
            same += 1
            assert not differences(expected, behaviour(changed)), mutant.id
    assert same > 20
