"""Forward kinematics agrees with pinocchio's, which agrees with KDL's, on real robots and on random trees."""

import re
from collections.abc import Mapping
from itertools import pairwise
from math import cos, sin
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf
from tests.examples import examples
from tests.oracles.example_robots import each_robot
from tests.oracles.random_trees import KINDS, difference, followed, joints_of, pin, random_tree

pytestmark = pytest.mark.exhaustive

_ANGLE, _CIRCLE = (
    1,
    2,
)  # how many numbers pinocchio keeps for a joint of one axis: its position, or cosine and sine


def assert_same_poses(
    model: Any, configuration: Configuration, positions: Mapping[str, float]
) -> None:
    """Assert that every link has the pose of pinocchio's frame of its name, to 1e-9, at these positions."""
    state = pin.neutral(model)
    for name, joint in joints_of(model).items():
        position = positions.get(name, 0.0)
        if joint.nq == _ANGLE:
            state[joint.idx_q] = position
        elif joint.nq == _CIRCLE:
            state[joint.idx_q : joint.idx_q + 2] = cos(position), sin(position)
    data = model.createData()
    pin.framesForwardKinematics(model, data, state)
    for link in configuration.robot.links:
        expected = data.oMf[model.getFrameId(link.name, pin.FrameType.BODY)].homogeneous
        actual = np.array(configuration.pose(link.name))
        assert np.allclose(actual, expected, rtol=0, atol=1e-9), link.name


def random_positions(model: Any, random: Random) -> dict[str, float]:
    """Return a position for every joint that moves, mimic joints included."""
    return {name: random.uniform(-3.0, 3.0) for name in joints_of(model)}


@each_robot
def test_real_robots(path: Path) -> None:
    """At zero and at five random positions, with mimic joints following."""
    read = read_urdf(path.read_bytes(), path.name)
    try:
        model = pin.buildModelFromUrdf(str(path))
    except ValueError as error:
        assert read.verdict == "rejected", error
        return
    robot = read.robot
    assert robot is not None
    assert_same_poses(
        model, Configuration(robot), followed(robot, dict.fromkeys(joints_of(model), 0.0))
    )
    random = Random(path.name)
    for _ in range(5):
        positions = random_positions(model, random)
        leading = {
            joint.name: positions[joint.name]
            for joint in robot.joints
            if joint.name in positions and not joint.mimic
        }
        assert_same_poses(model, Configuration(robot, leading), followed(robot, positions))


@each_robot
def test_real_robots_whose_mimics_are_moved_directly(path: Path) -> None:
    """If every joint has its own position, none follows another."""
    read = read_urdf(path.read_bytes(), path.name)
    if read.robot is None or read.verdict == "rejected":
        return
    model = pin.buildModelFromUrdf(str(path))
    positions = random_positions(model, Random(path.name))
    assert_same_poses(model, Configuration(read.robot, positions), positions)


# --- Random trees -----------------------------------------------------------------------------------------------------

_length = st.floats(-10, 10) | st.sampled_from((0.0, 1e-9, -1e-300, 1e-3))
_angle = st.floats(-7, 7) | st.sampled_from(
    (0.0, 1.5707963267948966, -1.57, 3.141592653589793, 1e-12)
)
_axis = st.tuples(_length, _length, _length).filter(
    lambda axis: max(map(abs, axis)) > 1e-3
) | st.sampled_from(
    ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -2.5), (0.0, -1e-3, 0.0))
)
_kind = st.sampled_from(("fixed", "continuous", "revolute", "prismatic"))


def _text(values: tuple[float, ...]) -> str:
    return " ".join(map(repr, values))


@st.composite
def urdfs(draw: st.DrawFn) -> str:
    """Draw a URDF of 1 to 15 links."""
    count = draw(st.integers(1, 15))
    elements = [f'<link name="l{index}"/>' for index in range(count)]
    for child in range(1, count):
        kind = draw(_kind)
        xyz, rpy = (
            draw(st.tuples(_length, _length, _length)),
            draw(st.tuples(_angle, _angle, _angle)),
        )
        elements.append(
            f'<joint name="j{child}" type="{kind}"><parent link="l{draw(st.integers(0, child - 1))}"/>'
            f'<child link="l{child}"/><origin xyz="{_text(xyz)}" rpy="{_text(rpy)}"/><axis xyz="{_text(draw(_axis))}"/>'
            f'<limit lower="-9" upper="9" effort="1" velocity="1"/></joint>'
        )
    return f'<robot name="r">{"".join(draw(st.permutations(elements)))}</robot>'


@examples(300)
@given(text=urdfs(), seed=st.integers(0, 999))
def test_random_trees(text: str, seed: int) -> None:
    """At zero and at random positions, read from the same text."""
    read = read_urdf(text.encode())
    assert read.robot is not None
    assert read.verdict == "clean"
    model = pin.buildModelFromXML(text)
    assert_same_poses(model, Configuration(read.robot), {})
    positions = random_positions(model, Random(seed))
    assert_same_poses(model, Configuration(read.robot, positions), positions)


@examples(150)
@given(text=urdfs(), multiplier=_length, offset=_length, position=_angle)
def test_random_mimics(text: str, multiplier: float, offset: float, position: float) -> None:
    """A chain of mimics follows its rules, led by the first joint in the file."""
    moving = re.findall(r'name="(j\d+)" type="(?:continuous|revolute|prismatic)"', text)
    positions = dict.fromkeys(moving[:1], position)
    expected = dict(positions)
    for leading, follower in pairwise(moving):
        rule = f'<mimic joint="{leading}" multiplier="{multiplier!r}" offset="{offset!r}"/>'
        text = re.sub(f'(<joint name="{follower}".*?)</joint>', rf"\1{rule}</joint>", text)
        expected[follower] = multiplier * expected[leading] + offset
        if abs(expected[follower]) > 1e3:
            return  # a large angle is not the same to 1e-9 for every order of multiplication
    read = read_urdf(text.encode())
    assert read.robot is not None
    assert_same_poses(pin.buildModelFromXML(text), Configuration(read.robot, positions), expected)


# --- Joints of all types ----------------------------------------------------------------------------------------------


def test_joints_of_all_types_and_mimics() -> None:
    """100 random trees at 10 random positions each: every pose is pinocchio's, to 1e-9."""
    random = Random(1000)
    texts = [random_tree(random) for _ in range(100)]
    assert [text for text in texts if difference(text, random, 10) is not None] == []
    assert set(re.findall(r'type="(\w+)"', "".join(texts))) == set(KINDS)
    assert "".join(texts).count("<mimic") > 100
