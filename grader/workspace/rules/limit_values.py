"""Limits of joints that are said twice: by the robot, and by MoveIt or <ros2_control>.

MoveIt's joint_limits.yaml and <ros2_control> may allow less than the robot, not more.
"""

from collections.abc import Iterator, Sequence
from math import isfinite

from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.urdf.model import Joint, Limit
from grader.ros.urdf.numbers import finite_number
from grader.ros.xml.parsing import Element
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.under_arguments import may_vary
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    warning,
)
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    Rule,
)

_TOLERANCE = 1e-3  # of a limit: files round differently
_TABLE = "joint_limits"
# The limits of joint_limits.yaml, each with the key that switches it on: moveit_core of
# moveit/moveit2, robot_model.
_OF_MOVEIT = {
    "max_velocity": "has_velocity_limits",
    "min_position": "has_position_limits",
    "max_position": "has_position_limits",
}
# The parameters of a command interface, by its name.
_OF_INTERFACES = {
    ("position", "min"): "min_position",
    ("position", "max"): "max_position",
    ("velocity", "max"): "max_velocity",
}


class _Said(Named):
    """A limit of a joint that a file says."""

    name: str  # as in joint_limits.yaml
    joint: str
    value: float
    words: str  # what the file calls it
    location: Location


def limit_facts(workspace: Workspace) -> Facts:
    """Yield the limits of joints that are wider than those of the robot."""
    if may_vary(workspace, "limit"):
        return
    for tree in workspace.installed.trees:
        table = tree.get(_TABLE) or tree.get("robot_description_planning", _TABLE)
        if table:
            for said in _said_by_moveit(table):
                yield from _wider(said, workspace.robots.known)
    for robot in workspace.robots.known:
        for system in robot.systems:
            limits = list(_said_by_control(robot, system))
            for said in limits:
                yield from _wider(said, [robot])
            yield from _exchanged(limits)


def _said_by_moveit(table: YamlNode) -> Iterator[_Said]:
    for joint, limits in table.table.items():
        for name, switch in _OF_MOVEIT.items():
            given = limits.get(name)
            is_on = limits.get(switch)
            if given is None or is_on is None or (is_on.text or "").lower() != "true":
                continue
            value = finite_number(given.text)
            if value is not None:
                yield _Said(name, joint, value, f"{joint}.{name}", given.location)


def _said_by_control(robot: KnownRobot, system: Element) -> Iterator[_Said]:
    for joint in system.iterchildren("joint"):
        name = joint.get("name", "")
        for interface in joint.iterchildren("command_interface"):
            kind = interface.get("name", "")
            for param in interface.iterchildren("param"):
                limit = _OF_INTERFACES.get((kind, param.get("name", "")))
                value = finite_number(param.text)
                if limit is not None and value is not None:
                    words = f"{param.get('name')} of the command interface {name}/{kind}"
                    yield _Said(limit, name, value, words, robot.place(param))


_JOINT_LIMIT = Rule(
    "joint-limit",
    "values",
    OTHER_VALUE,
    "The limits in a file are within those of the robot's joints.",
    why=(
        "MoveIt or ros2_control then allows motions that the joint is not made for. A "
        "controller may abort them, and a real motor may be damaged."
    ),
    wrong="""
joint_limits:
  arm_joint: {has_velocity_limits: true, max_velocity: 9.0}
""",
    right="""
joint_limits:
  arm_joint: {has_velocity_limits: true, max_velocity: 0.9}
""",
    frame="joint_limits.yaml",
    beside={
        "arm/rover.urdf": "",
    },
)


def _exchanged(limits: Sequence[_Said]) -> Facts:
    """Yield that the least position of a command interface is above the greatest one."""
    lowest = {said.joint: said for said in limits if said.name == "min_position"}
    for said in limits:
        lower = lowest.get(said.joint)
        if said.name == "max_position" and lower and lower.value > said.value:
            message = (
                f"{lower.words} is {lower.value:g}, above max, which is {said.value:g}: they are "
                "exchanged"
            )
            yield warning(_JOINT_LIMIT, message, lower.location, said.location)


def _wider(said: _Said, robots: Sequence[KnownRobot]) -> Facts:
    """Yield that every robot with the joint allows less than a file says."""
    joints = [
        wider_robot.robot.joint(said.joint)
        for wider_robot in robots
        if wider_robot.robot.has_joint(said.joint)
    ]
    limits = [(joint, joint.limit) for joint in joints if joint.limit]
    if not limits:
        return
    yield Compared("values")
    if not all(_is_wider(said, joint, limit) for joint, limit in limits):
        return
    joint, limit = limits[0]
    place = limit.location or joint.location
    message = (
        f"{said.words} is {said.value:g}; the joint {quoted(said.joint)} of the robot allows "
        f"{_allowed(said, limit):g}"
    )
    at = place.resolve() if place is not None else None
    yield warning(_JOINT_LIMIT, message, said.location, at)


def _allowed(said: _Said, limit: Limit) -> float:
    if said.name == "max_velocity":
        return limit.velocity
    return limit.lower if said.name == "min_position" else limit.upper


def _is_wider(said: _Said, joint: Joint, limit: Limit) -> bool:
    allowed = _allowed(said, limit)
    if not isfinite(allowed):
        return False
    slack = _TOLERANCE * max(1.0, abs(allowed))
    if said.name == "max_velocity":
        return allowed > 0.0 and said.value > allowed + slack
    if joint.type == "continuous" or limit.lower >= limit.upper:
        return False  # no range, or one that is a mistake of the robot alone
    if said.name == "min_position":
        return said.value < allowed - slack
    return said.value > allowed + slack
