"""Command interfaces of joints that several <ros2_control> of a robot have."""

from grader.ros.xml.parsing import Element
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_CONTROLLER,
    Rule,
)

_INTERFACE_ONCE = Rule(
    "interface-once",
    "controllers",
    NO_CONTROLLER,
    "A robot has each command interface in one <ros2_control> only.",
    why=(
        "Newer releases of ros2_control refuse the whole robot. Older ones use only the first "
        "system, so commands never reach the hardware of the second."
    ),
    wrong="""
<link name="a"/>
<joint name="first" type="continuous"><parent link="base_link"/><child link="a"/></joint>
<ros2_control name="arm" type="system">
  <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
  <joint name="first"><command_interface name="position"/></joint>
</ros2_control>
<ros2_control name="simulated_arm" type="system">
  <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
  <joint name="first"><command_interface name="position"/></joint>
</ros2_control>
""",
    right="""
<link name="a"/>
<joint name="first" type="continuous"><parent link="base_link"/><child link="a"/></joint>
<ros2_control name="arm" type="system">
  <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
  <joint name="first"><command_interface name="position"/></joint>
</ros2_control>
""",
    frame="rover.urdf",
)


def repeated_interface_facts(workspace: Workspace) -> Facts:
    """Yield the joints whose commands two systems of a robot take.

    Newer controller managers load no such robot, older ones use the first of them.
    """
    for robot in workspace.robots.known:
        owners: dict[str, Element] = {}
        for system in robot.systems:
            yield Compared("controllers")
            repeated = []
            for joint in system.iterchildren("joint"):
                for interface in joint.iterchildren("command_interface"):
                    name = f"{joint.get('name', '')}/{interface.get('name', '')}"
                    if owners.setdefault(name, system) is not system:
                        repeated.append(name)
            if repeated:
                first = owners[repeated[0]]
                message = (
                    f"<ros2_control> {system.get('name', '')!r} has the command interface "
                    f"{repeated[0]!r}, which {first.get('name', '')!r} has as well: one robot has "
                    "each once"
                )
                at = robot.place(system)
                other = robot.place(first)
                yield warning(_INTERFACE_ONCE, message, at, other)
