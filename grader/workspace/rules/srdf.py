"""Descriptions of robots for MoveIt (SRDF): links, joints and groups, states and collisions."""

from collections.abc import Iterator, Mapping
from contextlib import suppress

from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.urdf.model import Limit, Robot
from grader.ros.xml.parsing import Element, XmlFile
from grader.workspace.graph.compared_robots import ComparedRobots
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Definition,
    Facts,
    Mismatch,
    Mismatches,
    Open,
    Use,
    among,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_FRAME,
    OTHER_MOVEIT,
    SIMILAR,
    DefinedKind,
    Rule,
    Symptom,
)

_LINKS = ("link1", "link2", "parent_link", "child_link", "base_link", "tip_link")
_KINDS: Mapping[str, DefinedKind] = {
    "joint": "joint",
    "passive_joint": "joint",
    "link": "link",
}
_ROUNDING = 1e-6
_COMPUTED = (".srdf.xacro", ".srdf.xml.xacro")


def srdf_facts(workspace: Workspace) -> Facts:
    """Yield what SRDF files define and name, if a robot is known."""
    files = workspace.texts.srdf_files
    if not workspace.robots.known:
        return
    if _are_groups_computed(workspace):
        yield Open("group")
    for file in files:
        for group in file.root.iterchildren("group"):
            yield Definition("group", group.get("name", ""), file.location(group))
        known_robot = _described_robot(workspace, file)
        if known_robot:
            robot = known_robot.robot
            for use in _names(file):
                yield among(use, ComparedRobots((known_robot,)))
            yield from _other_robot(robot, file)
            yield from _empty_groups(file)
            yield from _states(robot, file)
            yield from _neighbours(robot, file)


def _are_groups_computed(workspace: Workspace) -> bool:
    """Return whether xacro makes an SRDF file."""
    if any(path.endswith(_COMPUTED) for path in workspace.tree.files):
        return True
    return any("<xacro:" in file.source.text for file in workspace.texts.srdf_files)


def _described_robot(workspace: Workspace, file: XmlFile) -> KnownRobot | None:
    """Return the robot that a file describes.

    It is the one of its name, or the only one if no file has its name. The result is None where
    the file is of another robot.
    """
    robots = workspace.robots.known
    for known_robot in robots:
        if known_robot.robot.name == file.root.get("name"):
            return known_robot
    if len(robots) > 1 or workspace.robots.may_be_others:
        return None
    names = {each.root.get("name") for each in workspace.texts.srdf_files}
    return robots[0] if robots[0].robot.name not in names else None


def _names(file: XmlFile) -> Iterator[Use]:
    """Yield the links, joints and groups that a file names."""
    root = file.root
    virtual = {each.get("name") for each in root.iterchildren("virtual_joint")}
    for element in root.iter("*"):
        if not isinstance(element.tag, str):
            continue
        at = file.location(element)
        yield from _links_and_groups(element, at)
        name = element.get("name", "")
        kind = _kind_of_name(element, root)
        is_virtual = kind == "joint" and name in virtual
        if kind is not None and name and not is_virtual:
            yield Use(kind, name, at, f"<{element.tag}>")


def _links_and_groups(element: Element, at: Location) -> Iterator[Use]:
    """Yield the links and groups that the attributes of an element name.

    The parent of a virtual joint is a frame of the world, and no link.
    """
    said = f"<{element.tag}>"
    for key in _LINKS:
        if element.get(key):
            yield Use("link", element.get(key, ""), at, f"{said} {key}")
    for key in ("group", "parent_group"):
        if element.get(key):
            yield Use("group", element.get(key, ""), at, f"{said} {key}")


def _kind_of_name(element: Element, root: Element) -> DefinedKind | None:
    """Return what the attribute `name` of an element names; a group where it is used."""
    if element.tag == "group" and element.getparent() is not root:
        return "group"
    return _KINDS.get(element.tag)


_SRDF_ROBOT = Rule(
    "srdf-robot",
    "moveit",
    OTHER_MOVEIT,
    "An SRDF names its robot.",
    why=(
        "MoveIt prints 'Semantic description is not specified for the same robot as the URDF' "
        "at each start, and the SRDF may be for another robot."
    ),
    symptoms=(
        Symptom(
            "semantic-robot",
            pattern=r"Semantic description is not specified for the same robot as the URDF",
            source="moveit/srdfdom e23af6e, src/model.cpp:660",
            sentence="The SRDF names another robot than the URDF.",
            example="Semantic description is not specified for the same robot as the URDF",
        ),
    ),
    wrong='<robot name="robot"><group name="base"><link name="base_link"/></group></robot>',
    right='<robot name="rover"><group name="base"><link name="base_link"/></group></robot>',
    frame="whole/rover.srdf",
)


def _other_robot(robot: Robot, file: XmlFile) -> Mismatches:
    """Yield that the description has another name than the only robot.

    MoveIt writes an error and goes on.
    """
    name = file.root.get("name", "")
    if name == robot.name:
        return
    message = (
        f"the SRDF is of the robot {quoted(name)}, but the robot is named {quoted(robot.name)}"
    )
    yield warning(_SRDF_ROBOT, message, file.location(file.root, "name"))


_SRDF_GROUP = Rule(
    "srdf-group",
    "moveit",
    OTHER_MOVEIT,
    "A group of an SRDF is not empty.",
    why=(
        "MoveIt leaves out the group. A program that plans for it ends because the group was "
        "not found, and RViz does not list it."
    ),
    wrong='<robot name="rover"><group name="base"/></robot>',
    right='<robot name="rover"><group name="base"><link name="base_link"/></group></robot>',
    frame="whole/rover.srdf",
)


def _empty_groups(file: XmlFile) -> Mismatches:
    """Yield groups in which nothing is, which MoveIt leaves out."""
    for group in file.root.iterchildren("group"):
        if next(group.iterchildren("*"), None) is None:
            message = (
                f"the group {quoted(group.get('name', ''))} has no joint, link, chain or group: "
                "MoveIt leaves it out"
            )
            yield warning(_SRDF_GROUP, message, file.location(group))


_STATE_LIMITS = Rule(
    "state-limits",
    "frames",
    NO_FRAME,
    "The states of an SRDF are within the limits of the joints.",
    why=(
        "MoveIt does not move a joint beyond its limits. A motion to the named state fails or "
        "ends elsewhere, as when 90 degrees are written in place of radians."
    ),
    wrong="""
<group_state name="up" group="arm"><joint name="arm_joint" value="90"/></group_state>
""",
    right="""
<group_state name="up" group="arm"><joint name="arm_joint" value="0.9"/></group_state>
""",
    frame="rover.srdf",
    beside={
        "arm/rover.urdf": "",
    },
)


def _states(robot: Robot, file: XmlFile) -> Mismatches:
    """Yield positions in states of groups that are beyond the limits of their joints."""
    limits = {
        joint.name: joint.limit for joint in robot.joints if joint.type in ("revolute", "prismatic")
    }
    for element in file.root.iterfind("group_state/joint"):
        name = element.get("name", "")
        limit = limits.get(name)
        with suppress(ValueError):
            value = float(element.get("value", ""))
            if limit and _is_beyond(value, limit):
                message = (
                    f"<group_state>: {quoted(name)} is at {value:g}; its limits are "
                    f"{limit.lower:g} and {limit.upper:g}"
                )
                yield Mismatch(_STATE_LIMITS, message, file.location(element, "value"))


def _is_beyond(value: float, limit: Limit) -> bool:
    return value < limit.lower - _ROUNDING or value > limit.upper + _ROUNDING


_DISABLED_PAIRS = Rule(
    "disabled-pairs",
    "frames",
    SIMILAR,
    "An SRDF disables the collisions between links that a joint connects.",
    why=(
        "MoveIt checks the two links for collisions. If the shapes touch at the joint, each "
        "start state counts as a collision, and planning fails."
    ),
    wrong="""
<disable_collisions link1="base_link" link2="a" reason="Adjacent"/>
<disable_collisions link1="a" link2="b" reason="Adjacent"/>
""",
    right="""
<disable_collisions link1="base_link" link2="a" reason="Adjacent"/>
<disable_collisions link1="a" link2="b" reason="Adjacent"/>
<disable_collisions link1="b" link2="arm" reason="Adjacent"/>
""",
    frame="rover.srdf",
    beside={
        "chain/rover.urdf": """
<robot name="rover">
  <link name="base_link"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="a"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="b"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="arm"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="a_joint" type="fixed"><parent link="base_link"/><child link="a"/></joint>
  <joint name="b_joint" type="fixed"><parent link="a"/><child link="b"/></joint>
  <joint name="arm_joint" type="continuous"><parent link="b"/><child link="arm"/></joint>
</robot>
""",
    },
    at="config/rover.srdf",
)


def _neighbours(robot: Robot, file: XmlFile) -> Mismatches:
    """Yield links that a joint connects and whose collisions are compared.

    They are yielded where most such pairs are disabled. It is wrong only if their shapes touch in
    some position, which is not computed.
    """
    disabled = set()
    for element in file.root.iterchildren("disable_collisions"):
        disabled.add(frozenset((element.get("link1"), element.get("link2"))))
    solid = {link.name for link in robot.links if link.collisions}
    compared = []
    count = 0
    for joint in robot.joints:
        pair = frozenset((joint.parent, joint.child))
        if solid.issuperset(pair):
            count += 1
            compared += [joint] if pair not in disabled else []
    for joint in compared if 2 * len(compared) < count else ():
        message = (
            f"a joint connects {quoted(joint.parent)} and {quoted(joint.child)}, but "
            "<disable_collisions> does not name them"
        )
        yield warning(_DISABLED_PAIRS, message, file.location(file.root))
