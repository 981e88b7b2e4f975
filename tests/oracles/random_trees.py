"""Random trees of links, and how the poses of the grader differ from those of pinocchio, which agree with KDL's."""

from collections.abc import Mapping
from math import cos, sin
from random import Random
from typing import Any

import numpy as np
import pytest

from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Robot
from grader.ros.urdf.reader import read_urdf
from tests.oracles.example_robots import MISSING

SINGLE = ("revolute", "continuous", "prismatic")  # the types of joints that a position moves

pin: Any = pytest.importorskip("pinocchio", reason=MISSING)

KINDS = ("fixed", "continuous", "revolute", "prismatic", "planar", "floating")
# how many numbers pinocchio keeps for a joint that turns without limits: cosine and sine
_CIRCLE = 2


def _numbers(random: Random, size: float) -> str:
    return " ".join(repr(random.uniform(-size, size)) for _ in range(3))


def random_tree(random: Random) -> str:
    """Return a URDF of 2 to 20 links with joints of all types, some of which mimic a joint of one position."""
    count = random.randint(2, 20)
    elements, leading = ['<link name="l0"/>'], list[str]()
    for child in range(1, count):
        kind = random.choice(KINDS)
        is_single = kind in SINGLE
        rule = ""
        if is_single and leading and random.random() < 0.4:
            rule = f'<mimic joint="{random.choice(leading)}" multiplier="{random.uniform(-2, 2)!r}" offset="{random.uniform(-1, 1)!r}"/>'
        elif is_single:
            leading.append(f"j{child}")
        axis = (
            _numbers(random, 1.0) if kind != "planar" else "0 0 1"
        )  # pinocchio knows planes across z only
        elements.append(
            f'<link name="l{child}"/><joint name="j{child}" type="{kind}"><parent link="l{random.randrange(child)}"/>'
            f'<child link="l{child}"/><origin xyz="{_numbers(random, 1.0)}" rpy="{_numbers(random, 4.0)}"/>'
            f'<axis xyz="{axis}"/><limit lower="-9" upper="9" effort="1" velocity="1"/>{rule}</joint>'
        )
    return f'<robot name="r">{"".join(elements)}</robot>'


def joints_of(model: Any) -> dict[str, Any]:
    """Return the joints that move, by name: pinocchio's first one is the universe, and it merges fixed ones."""
    return dict(list(zip(model.names, model.joints, strict=True))[1:])


def followed(robot: Robot, positions: Mapping[str, Any]) -> dict[str, Any]:
    """Return the positions of all joints with mimics applied; a missing joint is at 0, and no robot here mimics a mimic."""
    rules = {joint.name: joint.mimic for joint in robot.joints if joint.mimic is not None}
    leading = {name: position for name, position in positions.items() if name not in rules}
    following = {
        name: rule.multiplier * leading.get(rule.joint, 0.0) + rule.offset
        for name, rule in rules.items()
    }
    return leading | following


def difference(text: str, random: Random, count: int) -> str | None:
    """Return the first link whose pose is another one at some random position; None if all poses agree."""
    robot = read_urdf(text.encode()).robot
    assert robot is not None
    model = pin.buildModelFromXML(text)
    types = {joint.name: joint.type for joint in robot.joints}
    for _ in range(count):
        given: dict[str, float] = {}
        for joint in robot.joints:
            if joint.type in SINGLE and joint.mimic is None:
                given[joint.name] = random.uniform(-3.0, 3.0)
        positions, state = followed(robot, given), pin.neutral(model)
        for name, moving in joints_of(model).items():
            if types[name] in SINGLE:
                _set(state, moving, positions[name])
        data, configuration = model.createData(), Configuration(robot, given)
        pin.framesForwardKinematics(model, data, state)
        for link in robot.links:
            expected = data.oMf[model.getFrameId(link.name, pin.FrameType.BODY)].homogeneous
            if not np.allclose(
                np.array(configuration.pose(link.name)), expected, rtol=0, atol=1e-9
            ):
                return f"the pose of {link.name} differs at {given}"
    return None


def _set(state: Any, joint: Any, position: float) -> None:
    """Write the position of a joint as pinocchio keeps it: cosine and sine of an angle without limits."""
    values = (cos(position), sin(position)) if joint.nq == _CIRCLE else position
    state[joint.idx_q : joint.idx_q + joint.nq] = values
