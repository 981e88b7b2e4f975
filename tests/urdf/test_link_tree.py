"""The parent joint of a link with several candidates: as in ROS 2, and the most plausible one in a rejected file."""

from itertools import permutations

import pytest

from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.link_tree import parent_joints
from grader.ros.urdf.model import Joint, Link, Robot
from grader.ros.urdf.reader import read_urdf

pytestmark = pytest.mark.slow


def joint(name: str, parent: str, child: str) -> Joint:
    """Return a fixed joint."""
    return Joint(name, "fixed", parent, child)


def robot(*joints: Joint, rejected: bool = True) -> Robot:
    """Return a robot of these joints and the links that they name; default: ROS 2 rejects it."""
    names = dict.fromkeys(end for joint in joints for end in (joint.parent, joint.child))
    return Robot("r", tuple(map(Link, names)), joints, rejected=rejected)


def parents(*joints: Joint, rejected: bool = True) -> dict[str, str]:
    """Return the name of each link's parent joint."""
    return {
        link: joint.name for link, joint in parent_joints(robot(*joints, rejected=rejected)).items()
    }


FOOT, WHEEL = joint("base_joint", "foot", "base"), joint("base_wheel_joint", "base", "wheel")
LIDAR = joint("base_lidar_joint", "base", "lidar")


@pytest.mark.parametrize("rejected", [False, True])
def test_a_tree_is_unambiguous(rejected: bool) -> None:
    """If each link has at most one joint, there is nothing to choose, whatever the order of the joints."""
    for order in permutations((FOOT, WHEEL, LIDAR)):
        expected = {"base": "base_joint", "wheel": "base_wheel_joint", "lidar": "base_lidar_joint"}
        assert parents(*order, rejected=rejected) == expected


def test_a_swapped_joint_is_no_parent_joint_of_the_base() -> None:
    """A joint named after its parent is the swapped one: its link has no parent joint, the others keep theirs."""
    swapped = joint("wheel_joint", "wheel", "base")
    for order in permutations((FOOT, swapped, LIDAR)):
        assert parents(*order) == {"base": "base_joint", "lidar": "base_lidar_joint"}
    assert parents(FOOT, swapped, rejected=False) == {
        "base": "wheel_joint"
    }  # ROS 2: the last in name order


def test_a_name_with_both_links_decides_nothing() -> None:
    """With both links in its name a joint may be correct, so the first in the file counts."""
    one, other = joint("foot_base_joint", "foot", "base"), joint("a_base_joint", "world", "base")
    assert parents(one, other) == {"base": "foot_base_joint"}
    assert parents(other, one) == {"base": "a_base_joint"}


def test_the_original_of_a_copied_joint_counts() -> None:
    """Of a joint that was copied with its child the first is the parent joint."""
    left, copied = (
        joint("left_wheel_joint", "base", "left_wheel"),
        joint("right_wheel_joint", "base", "left_wheel"),
    )
    assert parents(FOOT, left, copied) == {"base": "base_joint", "left_wheel": "left_wheel_joint"}
    assert parents(FOOT, left, copied, rejected=False)["left_wheel"] == "right_wheel_joint"


def test_a_copy_before_the_original_is_recognised_by_its_name() -> None:
    """A joint whose name has only the parent and another child comes last, whatever its position."""
    right = joint("base_right_wheel_joint", "base", "right_wheel")
    copied = joint("base_left_wheel_joint", "base", "right_wheel")
    for order in ((copied, right), (right, copied)):
        assert parents(*order) == {"right_wheel": "base_right_wheel_joint"}


def test_the_joint_that_closes_a_loop_is_ignored() -> None:
    """A loop is opened at the last of its joints in the file; links below it are kept."""
    ring = [joint("p", "a", "b"), joint("q", "b", "c"), joint("r", "c", "a")]
    branch = joint("s", "c", "d")
    for order in permutations(ring):
        expected = {joint.child: joint.name for joint in order[:2]}
        assert parents(*order, branch) == {**expected, "d": "s"}
        assert len(Configuration(robot(*order, branch)).roots) == 1


def test_the_joint_named_after_its_parent_closes_the_loop() -> None:
    """In a loop too, the joint that may be swapped is ignored, whatever its position."""
    back = joint("wheel_mount", "wheel", "foot")
    for order in permutations((FOOT, WHEEL, back)):
        assert parents(*order) == {"base": "base_joint", "wheel": "base_wheel_joint"}


def test_a_joint_from_a_link_to_itself_is_no_parent_joint() -> None:
    """A loop of one joint is ignored like any other."""
    assert parents(joint("self", "base", "base"), FOOT) == {"base": "base_joint"}


def test_joints_without_existing_links_connect_nothing() -> None:
    """A parent or child that is missing or not given connects nothing."""
    links = (Link("base"), Link("wheel"))
    for broken in (
        joint("j", "nowhere", "wheel"),
        joint("j", "base", "nowhere"),
        joint("j", "", "wheel"),
    ):
        assert parent_joints(Robot("r", links, (broken,), rejected=True)) == {}


def test_a_long_chain_in_any_order_is_read_at_once() -> None:
    """Paths to the root are shortened when they are walked: ten thousand links take no time, top down or bottom up."""
    chain = [joint(f"j{index}", f"l{index}", f"l{index + 1}") for index in range(10_000)]
    back = joint("back", "l10000", "l0")
    for order in (chain, chain[::-1]):
        assert len(parents(*order, back)) == 10_000
        assert "l0" not in parents(*order, back)


def test_plausibility_counts_only_in_a_rejected_file() -> None:
    """The reader says which rule applies: ROS 2 loads two parents alone but no loop."""
    parts = '<link name="{}"/>'.format
    written = '<joint name="{}" type="fixed"><parent link="{}"/><child link="{}"/></joint>'.format

    def read(*joints: str) -> dict[str, str]:
        text = f'<robot name="r">{"".join(map(parts, ("a", "b", "c")))}{"".join(joints)}</robot>'
        found = read_urdf(text.encode(), "r.urdf").robot
        assert found is not None
        return {link: joint.name for link, joint in parent_joints(found).items()}

    two = (written("p", "a", "b"), written("q", "a", "b"))
    assert read(*two, written("r", "b", "c")) == {"b": "q", "c": "r"}
    assert read(*two, written("r", "b", "c"), written("s", "c", "a")) == {"b": "p", "c": "r"}
