"""Bodies of links: collisions beside their visuals, and masses without which Gazebo drops links."""

from collections.abc import Iterator
from math import dist

from grader.base.quantities import in_millimetres
from grader.base.source import place
from grader.base.text import quoted
from grader.ros.urdf.model import Joint, Link, Mesh, Robot
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Fact, Mismatch, warning
from grader.workspace.rules.rule_table import COLLISION_PLACE, GAZEBO_INERTIA

_LEAST = 0.001  # metres
_OF_LINK = 5  # parts


def body_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield collisions that are beside their visuals, and moving links that Gazebo drops."""
    said = set[tuple[str, int]]()  # of a macro, the first link
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


def _other_places(link: Link) -> Iterator[Mismatch]:
    """Yield that the only collision of a link has the shape of its only visual in another place."""
    if len(link.visuals) != 1 or len(link.collisions) != 1:
        return
    visual, collision = link.visuals[0], link.collisions[0]
    if isinstance(visual.geometry, Mesh) or visual.geometry != collision.geometry:
        return
    away = dist(visual.origin.xyz, collision.origin.xyz)
    at = place(collision.origin.location, "xyz") or place(collision.location)
    if away > _LEAST and at is not None:
        message = (
            f"the collision of {quoted(link.name)} has the shape of its visual, "
            f"{in_millimetres(away)} beside it"
        )
        yield warning(COLLISION_PLACE, message, at.resolve())


def _is_simulated(robot: KnownRobot) -> bool:
    """Return whether a robot has a plugin or a sensor of Gazebo."""
    parts = (*robot.root.iterfind("gazebo/plugin"), *robot.root.iterfind("gazebo/sensor"))
    return bool(parts)


def _without_mass(robot: Robot) -> Iterator[Mismatch]:
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
        if with_mass.isdisjoint(carried) and joint.location is not None:
            message = (
                f"{quoted(joint.child)} has no mass, so Gazebo drops the link and the joint "
                f"{quoted(joint.name)}: give it an <inertial>"
            )
            yield warning(GAZEBO_INERTIA, message, joint.location.resolve())
            return
