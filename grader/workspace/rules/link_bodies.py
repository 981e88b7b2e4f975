"""Bodies of links: collisions beside their visuals, and masses without which Gazebo drops links."""

from math import dist

from grader.base.quantities import in_millimetres
from grader.base.source import place
from grader.base.text import quoted
from grader.ros.urdf.model import Joint, Link, Mesh, Robot
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    Rule,
)

_LEAST = 0.001  # metres
_OF_LINK = 5  # parts


def body_facts(workspace: Workspace) -> Facts:
    """Yield collisions that are beside their visuals, and moving links that Gazebo drops."""
    said = set()  # of a macro, the first link
    for robot in workspace.robots.known:
        workspace.charge(_OF_LINK * len(robot.robot.links))
        for link in robot.robot.links:
            for wrong in _other_places(link):
                key = (wrong.location.path, wrong.location.line)
                if key not in said:
                    said.add(key)
                    yield wrong
        if _is_simulated(robot):
            yield from _without_mass(robot.robot)


_COLLISION_PLACE = Rule(
    "collision-place",
    "values",
    OTHER_VALUE,
    "A collision with the shape of a visual is where that is.",
    why=(
        "Gazebo and MoveIt compute contacts with the collision only. The robot collides with "
        "nothing visible, or parts pass through each other."
    ),
    wrong="""
<link name="box">
  <visual><origin xyz="0 0 0.05"/><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link>
<joint name="box_joint" type="fixed"><parent link="base_link"/><child link="box"/></joint>
""",
    right="""
<link name="box">
  <visual><origin xyz="0 0 0.05"/><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
  <collision><origin xyz="0 0 0.05"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link>
<joint name="box_joint" type="fixed"><parent link="base_link"/><child link="box"/></joint>
""",
    frame="rover.urdf",
)


def _other_places(link: Link) -> Mismatches:
    """Yield that the only collision of a link has the shape of its only visual in another place."""
    if len(link.visuals) != 1 or len(link.collisions) != 1:
        return
    visual = link.visuals[0]
    collision = link.collisions[0]
    if isinstance(visual.geometry, Mesh) or visual.geometry != collision.geometry:
        return
    away = dist(visual.origin.xyz, collision.origin.xyz)
    at = place(collision.origin.location, "xyz") or place(collision.location)
    if away > _LEAST and at:
        message = (
            f"the collision of {quoted(link.name)} has the shape of its visual, "
            f"{in_millimetres(away)} beside it"
        )
        yield warning(_COLLISION_PLACE, message, at.resolve())


def _is_simulated(robot: KnownRobot) -> bool:
    """Return whether a robot has a plugin or a sensor of Gazebo."""
    parts = (*robot.root.iterfind("gazebo/plugin"), *robot.root.iterfind("gazebo/sensor"))
    return bool(parts)


_GAZEBO_INERTIA = Rule(
    "gazebo-inertia",
    "values",
    OTHER_VALUE,
    "A link that a joint moves in Gazebo has a mass.",
    why=(
        "Gazebo drops the link and its joint when it converts the URDF. The wheel or sensor is "
        "missing, and plugins do not find the joint."
    ),
    wrong="""
<link name="wheel"/>
<joint name="wheel_joint" type="continuous">
  <parent link="body"/><child link="wheel"/><axis xyz="0 1 0"/>
</joint>
<link name="body">
  <inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
</link>
<joint name="body_joint" type="fixed"><parent link="base_link"/><child link="body"/></joint>
<gazebo reference="base_link"><sensor name="imu" type="imu"/></gazebo>
""",
    right="""
<link name="wheel">
  <inertial>
    <mass value="0.2"/>
    <inertia ixx="0.0001" iyy="0.0002" izz="0.0001" ixy="0" ixz="0" iyz="0"/>
  </inertial>
</link>
<joint name="wheel_joint" type="continuous">
  <parent link="body"/><child link="wheel"/><axis xyz="0 1 0"/>
</joint>
<link name="body">
  <inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
</link>
<joint name="body_joint" type="fixed"><parent link="base_link"/><child link="body"/></joint>
<gazebo reference="base_link"><sensor name="imu" type="imu"/></gazebo>
""",
    frame="rover.urdf",
)


def _without_mass(robot: Robot) -> Mismatches:
    """Yield the first joint that moves links which have no mass, with what is fixed to them.

    A robot without any mass is a sketch.
    """
    fixed: dict[str, list[Joint]] = {}
    for joint in robot.joints:
        if joint.type == "fixed":
            fixed.setdefault(joint.parent, []).append(joint)
    with_mass = {link.name for link in robot.links if link.inertial and link.inertial.mass > 0.0}
    for joint in robot.joints if with_mass else ():
        if not joint.has_position:
            continue
        carried = [joint.child]
        for name in carried:  # grows
            carried += [each.child for each in fixed.get(name, ()) if each.child not in carried]
        if with_mass.isdisjoint(carried) and joint.location:
            message = (
                f"{quoted(joint.child)} has no mass, so Gazebo drops the link and the joint "
                f"{quoted(joint.name)}: give it an <inertial>"
            )
            yield warning(_GAZEBO_INERTIA, message, joint.location.resolve())
            return
