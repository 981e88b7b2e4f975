"""Descriptions of robots for MoveIt (SRDF): the links, joints and groups that they name, states and
collisions.
"""

from collections.abc import Iterator
from contextlib import suppress

from grader.base.text import quoted
from grader.ros.urdf.model import Robot
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Definition, Fact, Mismatch, Open, Use, warning
from grader.ros.workspace.rules.rule_table import (
    DISABLED_PAIRS,
    SRDF_GROUP,
    SRDF_ROBOT,
    STATE_LIMITS,
)
from grader.ros.xml.parsing import XmlFile

_LINKS = ("link1", "link2", "parent_link", "child_link", "base_link", "tip_link")
_ROUNDING = 1e-6
_COMPUTED = (".srdf.xacro", ".srdf.xml.xacro")


def srdf_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield what SRDF files define and name, if a robot is known."""
    robots, files = [found.robot for found in workspace.robots.known], workspace.texts.srdf_files
    if not robots:
        return
    names = {file.root.get("name") for file in files}
    is_only = (
        len(robots) == 1 and not workspace.robots.may_be_others and robots[0].name not in names
    )
    computed = [path for path in workspace.tree.files if path.endswith(_COMPUTED)]
    if computed or any("<xacro:" in file.source.text for file in files):
        yield Open("group")
    for file in files:
        for group in file.root.iterchildren("group"):
            yield Definition("group", group.get("name", ""), file.location(group))
        described = [robot for robot in robots if robot.name == file.root.get("name")]
        robot = next(iter(described or robots))
        if not described and not is_only:
            continue  # it describes another robot
        yield from _names(file)
        yield from _other_robot(robot, file)
        yield from _empty_groups(file)
        yield from _states(robot, file)
        yield from _neighbours(robot, file)


def _names(file: XmlFile) -> Iterator[Fact]:
    root = file.root
    virtual = {it.get("name") for it in root.iterchildren("virtual_joint")}
    for element in root.iter("*"):
        if not isinstance(element.tag, str):
            continue
        at, name = file.location(element), element.get("name", "")
        said = f"<{element.tag}>"
        # The parent of a virtual joint is a frame of the world.
        for key in [key for key in _LINKS if element.get(key)]:
            yield Use("link", element.get(key, ""), at, f"{said} {key}")
        if element.tag in ("joint", "passive_joint") and name and name not in virtual:
            yield Use("joint", name, at, said)
        if element.tag == "link" and name:
            yield Use("link", name, at, said)
        for key in ("group", "parent_group"):
            if element.get(key):
                yield Use("group", element.get(key, ""), at, f"{said} {key}")
        if element.tag == "group" and element.getparent() is not root and name:
            yield Use("group", name, at, said)


def _other_robot(robot: Robot, file: XmlFile) -> Iterator[Mismatch]:
    """Yield that the description has another name than the only robot, of which MoveIt writes an
    error and goes on.
    """
    name = file.root.get("name", "")
    if name == robot.name:
        return
    message = (
        f"the SRDF is of the robot {quoted(name)}, but the robot is named {quoted(robot.name)}"
    )
    yield warning(SRDF_ROBOT, message, file.location(file.root, "name"))


def _empty_groups(file: XmlFile) -> Iterator[Mismatch]:
    """Yield groups in which nothing is, which MoveIt leaves out."""
    for group in file.root.iterchildren("group"):
        if next(group.iterchildren("*"), None) is None:
            message = (
                f"the group {quoted(group.get('name', ''))} has no joint, link, chain or group: "
                "MoveIt leaves it out"
            )
            yield warning(SRDF_GROUP, message, file.location(group))


def _states(robot: Robot, file: XmlFile) -> Iterator[Mismatch]:
    """Yield positions in states of groups that are beyond the limits of their joints."""
    limits = {it.name: it.limit for it in robot.joints if it.type in ("revolute", "prismatic")}
    for element in file.root.iterfind("group_state/joint"):
        name, limit = element.get("name", ""), limits.get(element.get("name", ""))
        with suppress(ValueError):
            value = float(element.get("value", ""))
            if limit is not None and (
                value < limit.lower - _ROUNDING or value > limit.upper + _ROUNDING
            ):
                message = (
                    f"<group_state>: {quoted(name)} is at {value:g}; its limits are "
                    f"{limit.lower:g} and {limit.upper:g}"
                )
                yield Mismatch(STATE_LIMITS, message, file.location(element, "value"))


def _neighbours(robot: Robot, file: XmlFile) -> Iterator[Mismatch]:
    """Yield links that a joint connects and whose collisions are compared, where most such pairs
    are disabled.
    """
    disabled = set()
    for element in file.root.iterchildren("disable_collisions"):
        disabled.add(frozenset((element.get("link1"), element.get("link2"))))
    solid = {link.name for link in robot.links if link.collisions}
    pairs = [(joint.parent, joint.child) for joint in robot.joints]
    pairs = [pair for pair in pairs if solid.issuperset(pair)]
    compared = [pair for pair in pairs if frozenset(pair) not in disabled]
    if 2 * len(compared) >= len(pairs):
        return
    for parent, child in compared:
        message = (
            f"a joint connects {quoted(parent)} and {quoted(child)}, but <disable_collisions> "
            "does not name them"
        )
        # Wrong only if their shapes touch in some position, which is not computed.
        yield warning(DISABLED_PAIRS, message, file.location(file.root))
