"""Links that are called left or right: whether they are on their sides."""

from collections.abc import Iterator

from grader.base.errors import MissingElement
from grader.base.source import place
from grader.base.text import enumerated, quoted
from grader.ros.urdf.kinematics import Configuration
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Facts,
    Mismatch,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    Rule,
)
from grader.workspace.rules.wheel_values import WHEEL_SIDE, wheel_value_facts

_ROLLING = ("wheel", "module", "caster", "track")  # words in names of links that drive
_LEAST = 0.01  # metres between left and right
_OF_PAIR = 20  # parts


def side_facts(workspace: Workspace) -> Facts:
    """Yield the wheels of robots that are called left and are on the right.

    The x axis of the root points forward (REP 103). Where some pairs are on their sides, names may
    mean something else. Nothing is said where a controller has them on the wrong sides.
    """
    wrong: list[Mismatch] = []
    for robot in workspace.robots.known:
        pairs = list(_pairs(robot))
        workspace.charge(_OF_PAIR * len(pairs))
        wrong += _exchanged(robot, pairs)
    if wrong:
        facts = wheel_value_facts(workspace)
        if not any(isinstance(fact, Mismatch) and fact.rule is WHEEL_SIDE for fact in facts):
            yield from wrong


def _pairs(robot: KnownRobot) -> Iterator[tuple[str, str]]:
    """Yield the links of wheels that are called left, each with the one called right."""
    names = {link.name for link in robot.robot.links}
    for name in sorted(names):
        words = name.lower()
        other = name.replace("left", "right").replace("Left", "Right").replace("LEFT", "RIGHT")
        if other != name and other in names and any(word in words for word in _ROLLING):
            yield name, other


def _common_link(configuration: Configuration, left: str, right: str) -> str | None:
    """Return the lowest link above two links, since a robot may be turned; None for the root."""
    above = {joint.parent for joint in configuration.chain(right)}
    shared = [joint.parent for joint in configuration.chain(left) if joint.parent in above]
    return shared[-1] if shared else None


def _side(configuration: Configuration, left: str, right: str, frame: str | None) -> str:
    """Return whether two links are on their sides in a frame, or exchanged, or neither."""
    y_left = configuration.pose(left, relative_to=frame).translation[1]
    y_right = configuration.pose(right, relative_to=frame).translation[1]
    if y_left < -_LEAST and y_right > _LEAST:
        return "exchanged"
    return "right" if y_left > _LEAST or y_right < -_LEAST else "none"


_LINK_SIDE = Rule(
    "link-side",
    "values",
    OTHER_VALUE,
    "Links that are called left are on the left of those called right.",
    why=(
        "Controllers and code choose links by their names. A robot with such wheels turns the "
        "other way, and data of a left sensor come from the right."
    ),
    wrong="""
<link name="left_wheel"/> <link name="right_wheel"/>
<joint name="left" type="continuous">
  <parent link="base_link"/><child link="left_wheel"/><origin xyz="0 -0.2 0"/><axis xyz="0 1 0"/>
</joint>
<joint name="right" type="continuous">
  <parent link="base_link"/><child link="right_wheel"/><origin xyz="0 0.2 0"/><axis xyz="0 1 0"/>
</joint>
""",
    right="""
<link name="left_wheel"/> <link name="right_wheel"/>
<joint name="left" type="continuous">
  <parent link="base_link"/><child link="left_wheel"/><origin xyz="0 0.2 0"/><axis xyz="0 1 0"/>
</joint>
<joint name="right" type="continuous">
  <parent link="base_link"/><child link="right_wheel"/><origin xyz="0 -0.2 0"/><axis xyz="0 1 0"/>
</joint>
""",
    frame="rover.urdf",
)


def _exchanged(robot: KnownRobot, pairs: list[tuple[str, str]]) -> Mismatches:
    """Yield that all pairs are on the other sides."""
    configuration = Configuration(robot.robot)
    wrong = []
    for left, right in pairs:
        try:
            above = _common_link(configuration, left, right)
            sides = {_side(configuration, left, right, frame) for frame in (None, above)}
        except MissingElement:
            return
        if sides == {"exchanged"}:
            wrong.append(left)
        elif sides != {"none"}:
            return
    at = None
    for joint in robot.robot.joints:
        if wrong and joint.child == wrong[0]:
            at = place(joint.origin.location, "xyz") if joint.origin else None
            at = at or place(joint.location)
    if at:
        names = enumerated([quoted(name) for name in wrong])
        verb = "is" if len(wrong) == 1 else "are"
        message = f"{names} {verb} on the right of the robot, where y is negative (REP 103)"
        yield warning(_LINK_SIDE, message, at.resolve())
