"""Which changes leave a robot the same, and which do not."""

import re

import pytest

from grader.mutation.mutants import mutants
from grader.mutation.sameness import is_same_robot
from grader.submission.urdf import read_as_ros
from tests.hints.behaviour import behaviour, differences
from tests.hints.trials import BASES
from tests.mutation.robots import ARM

REFERENCE = read_as_ros(ARM.encode(), "birch.urdf")
NO_RPY = '<origin xyz="0 0 0.4"/>'
TURNED = 'rpy="0 1.5708 0"/>\n      <geometry><box size="0.4 0.05 0.06"/>'


def is_same(old: str, new: str, *kept: str) -> bool:
    """Return whether the robot stays the same if one text in it becomes another."""
    assert old in ARM
    return is_same_robot(REFERENCE, read_as_ros(ARM.replace(old, new, 1).encode(), "birch.urdf"), kept)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (NO_RPY, '<origin xyz="0 -0 0.40" rpy="0 0 0"/>'),
        (NO_RPY, '<origin xyz="0 0 0.4" rpy="6.283185307179586 0 0"/>'),
        ('rpy="0 0 3.14159"', 'rpy="0 0 -3.14159"'),
        ('<origin xyz="0 0 0.05"/>\n      <geometry><cylinder radius="0.1"', '<origin xyz="0 0 0.05" rpy="0 0 1"/>\n      <geometry><cylinder radius="0.1"'),
        ('<origin xyz="0 0 0.05"/>\n      <geometry><cylinder radius="0.1"', '<origin xyz="0 0 0.05" rpy="3.141592653 0 0"/>\n      <geometry><cylinder radius="0.1"'),
        ("<visual>\n      <geometry><sphere", '<visual>\n      <origin rpy="1 2 3"/><geometry><sphere'),
        (TURNED, 'rpy="0 0 0"/>\n      <geometry><box size="0.06 0.05 0.4"/>'),
        ('<axis xyz="0 1 2"/>', '<axis xyz="0 3 6"/>'),
        ('<child link="plate"/>', '<child link="plate"/><axis xyz="0 1 0"/><limit effort="1" velocity="1"/>'),
        ('damping="0.1"', 'damping="0.10" friction="0"'),
        ('<mesh filename="package://birch/meshes/hand.stl"', '<mesh  filename="package://birch/meshes/hand.stl"'),
        ('robot name="birch"', 'robot name="ash"'),
        ('joint name="tool_joint"', 'joint name="other"'),
        ("<mu1>0.2</mu1>", "<mu1> 0.20 </mu1>"),
        ('<link name="tool">', '<link name="tool"><visual><geometry><box size="0 0 0"/></geometry></visual>'),
        ('<color rgba="0.5 0.5 0.6 1"/>', '<color rgba=".5 .5 6e-1 1.0"/>'),
    ],
)  # fmt: skip
def test_what_cannot_be_seen_leaves_the_robot_the_same(old: str, new: str) -> None:
    """Defaults, full turns, symmetric shapes, lengths of axes, spelling, and names that nothing refers to."""
    assert is_same(old, new)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (NO_RPY, '<origin xyz="0 0 0.401"/>'),
        (NO_RPY, '<origin xyz="0 0 0.4" rpy="0 0.01 0"/>'),
        ('rpy="0 0 0.3"', 'rpy="0 0 0.2"'),
        ('<box size="0.01 0.02 0.03"/>', '<box size="0.02 0.01 0.03"/>'),
        ('<axis xyz="0 1 2"/>', '<axis xyz="0 -1 -2"/>'),
        ('lower="-1.5"', 'lower="-1.4"'),
        ('effort="10"', 'effort="11"'),
        ('damping="0.1"', 'damping="0.2"'),
        ('damping="0.1"', 'friction="0.1"'),
        ('multiplier="-0.5" ', ""),
        ('offset="0.1"', 'offset="0.2"'),
        ('mass value="1.2"', 'mass value="1.3"'),
        ('izz="0.01"', 'izz="0.02"'),
        ('<origin xyz="0 0 0.2" rpy="0.1 0 0"/>', '<origin xyz="0 0 0.202" rpy="0.1 0 0"/>'),
        ('radius="0.11"', 'radius="0.1"'),
        ("hand.stl", "Hand.stl"),
        ('scale="0.001 0.001 0.001"', 'scale="1 1 1"'),
        ('<color rgba="0.5 0.5 0.6 1"/>', '<color rgba="0.5 0.5 0.6 0.9"/>'),
        ("<mu1>0.2</mu1>", "<mu1>0.3</mu1>"),
        ('gazebo reference="base"', 'gazebo reference="tool"'),
        ('joint name="slide" type="prismatic"', 'joint name="sliding" type="prismatic"'),  # ros2_control names it
        ('"tool_joint" type="fixed"', '"tool_joint" type="floating"'),
        ('<child link="tool"/>', '<child link="tool_x"/>'),
        ("<geometry><sphere", "<geometry><sphare"),
        ('<param name="min">-1</param>', '<param name="max">-1</param>'),
    ],
)
def test_what_changes_the_robot_does_not(old: str, new: str) -> None:
    """Poses, shapes, colours, masses, axes, limits, mimics, dynamics, the tree, the verdict, and what simulators read."""
    assert not is_same(old, new)


def test_a_name_that_something_refers_to_counts() -> None:
    """A rubric, or another file of the package."""
    assert not is_same('joint name="tool_joint"', 'joint name="other"', "tool_joint")


def test_no_mutant_of_lab6_that_counts_as_the_same_robot_behaves_otherwise() -> None:
    """Shapes, colours, axes and frames, measured in the frame of the base, are where they were."""
    base = BASES["reference"]
    urdf, expected = base.submission.urdf, behaviour(base.submission)
    same = 0
    drawn_twice = re.compile("element duplicated: link [a-z_]+/visual")
    for mutant in mutants(base.text):
        changed = base.changed(mutant.applied(base.text))
        if is_same_robot(urdf, changed.urdf, ()):
            same += 1
            assert drawn_twice.fullmatch(mutant.id) or not differences(expected, behaviour(changed)), mutant.id
    assert same > 100
