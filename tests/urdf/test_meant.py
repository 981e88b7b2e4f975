"""Words for which ROS 2 rejects a file, and that surely stand for others: what is left as it is."""

import pytest

from grader.ros.package.robot_file import Surroundings, read_as_ros
from grader.ros.package.robot_readings import read_as_meant
from grader.ros.python.budget import Budget
from grader.ros.urdf.reader import Reading

pytestmark = pytest.mark.slow

JOINT = '<joint name="j{0}" type="fixed"><parent link="{1}"/><child link="{2}"/></joint>'


def _read_as_meant(text: str) -> Reading:
    return read_as_meant(read_as_ros(text.encode(), "r.urdf"), Surroundings(Budget())).reading


def many_misspelt(count: int) -> str:
    """Return a robot in which joints name their parent wrongly."""
    links = "".join(f'<link name="arm_{number}"/>' for number in range(count))
    wrong = ("torsoo", "trso")
    joints = "".join(
        JOINT.format(number, wrong[number % 2], f"arm_{number}") for number in range(count)
    )
    links += '<link name="head"/>'
    joints += JOINT.format("head", "torso", "head")
    return f'<robot name="r"><link name="torso"/>{links}{joints}</robot>'


@pytest.mark.parametrize(("count", "is_meant"), [(3, True), (250, False)])
def test_a_name_is_undone_in_few_places(count: int, *, is_meant: bool) -> None:
    """A name that is wrong in more places than a person corrects is left as it is."""
    assert _read_as_meant(many_misspelt(count)).is_meant == is_meant


def test_ends_without_a_link_are_not_exchanged() -> None:
    """A second joint of a link, whose parent names no link, stays as it is."""
    joints = (
        JOINT.format(1, "base", "arm")
        + '<joint name="j2" type="fixed"><parent/><child link="arm"/></joint>'
    )
    links = '<link name="base"/><link name="arm"/>'
    reading = _read_as_meant(f'<robot name="r">{links}{joints}</robot>')
    assert (reading.verdict, reading.is_meant) == ("rejected", False)
