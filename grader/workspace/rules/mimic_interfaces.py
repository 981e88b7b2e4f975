"""Joints in <ros2_control> that mimic others: hardware_interface refuses commands of them."""

from grader.ros.known.releases import RELEASES
from grader.ros.xml.parsing import Element
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
)
from grader.workspace.rules.rule_table import (
    NO_CONTROLLER,
    Rule,
)

# Since this one, hardware_interface reads <mimic>: src/component_parser.cpp of ros2_control.
_SINCE = RELEASES.index("jazzy")
_FALSE = ("false", "False", "0")


def mimic_facts(workspace: Workspace) -> Facts:
    """Yield the command interfaces of joints with <mimic>, unless they say mimic="false".

    It is certain for the stated releases, all of which refuse them.
    """
    places = [RELEASES.index(release) for release in workspace.releases]
    if places and max(places) < _SINCE:
        return
    is_certain = bool(places) and min(places) >= _SINCE
    for robot in workspace.robots.known:
        mimics = {joint.name for joint in robot.robot.joints if joint.mimic}
        for system in robot.systems:
            yield Compared("controllers")
            for joint in system.iterchildren("joint"):
                if joint.get("name", "") in mimics:
                    yield from _find_commands(robot, joint, is_certain=is_certain)


_MIMIC_COMMAND = Rule(
    "mimic-command",
    "controllers",
    NO_CONTROLLER,
    "A joint that mimics another one has no command interface.",
    why=(
        "From Jazzy on ros2_control raises an error when it parses the robot. No hardware is "
        "loaded, and spawners wait or fail."
    ),
    wrong="""
<link name="a"/> <link name="b"/>
<joint name="first" type="continuous"><parent link="base_link"/><child link="a"/></joint>
<joint name="second" type="continuous">
  <parent link="a"/><child link="b"/><mimic joint="first"/>
</joint>
<ros2_control name="arm" type="system">
  <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
  <joint name="first"><command_interface name="position"/></joint>
  <joint name="second"><command_interface name="position"/></joint>
</ros2_control>
""",
    right="""
<link name="a"/> <link name="b"/>
<joint name="first" type="continuous"><parent link="base_link"/><child link="a"/></joint>
<joint name="second" type="continuous">
  <parent link="a"/><child link="b"/><mimic joint="first"/>
</joint>
<ros2_control name="arm" type="system">
  <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
  <joint name="first"><command_interface name="position"/></joint>
  <joint name="second"><state_interface name="position"/></joint>
</ros2_control>
""",
    frame="rover.urdf",
)


def _find_commands(robot: KnownRobot, joint: Element, *, is_certain: bool) -> Mismatches:
    interface = next(joint.iterchildren("command_interface"), None)
    if interface is not None and joint.get("mimic") not in _FALSE:
        name = joint.get("name", "")
        since = "" if is_certain else "from Jazzy on, "
        message = (
            f"{since}ros2_control loads no robot with a command interface of {name!r}, whose joint "
            'mimics another one: remove it, or write mimic="false"'
        )
        yield Mismatch(_MIMIC_COMMAND, message, robot.place(interface), is_certain=is_certain)
