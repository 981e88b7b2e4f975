"""The room that Nav2 plans with: a costmap's radius and footprint against the robot's shapes."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from math import cos, pi, sin

from grader.base.errors import MissingElement, NotDecided
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import quoted
from grader.base.transforms import Vector
from grader.ros.config.yaml_nodes import YamlNode, yaml_value
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Mesh
from grader.ros.urdf.numbers import finite_number
from grader.ros.urdf.shapes import PlacedShape
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.under_arguments import may_vary
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    warning,
)
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    Rule,
)

_DIRECTIONS = 36  # horizontal directions in which the robot is measured
_TOLERANCE, _ROUNDING = 0.05, 0.005  # of a length; metres
_MAX_LINKS, _OF_LINK = 300, 20  # of a robot that is compared; parts of each
_BASE = "robot_base_frame"
_RADIUS = "robot_radius"
_FOOTPRINT = "footprint"
_PLACING = ("origin", "axis", "cylinder", "sphere", "box")


class _Reach(Named):
    """How far a link reaches from the base in a horizontal direction, in metres."""

    link: str
    distance: float
    direction: Vector


class _Room(Named):
    """The area that a costmap takes the robot for: the corners of a polygon, or a radius."""

    said: str  # the parameter
    base: str
    corners: Sequence[tuple[float, float]]
    radius: float
    location: Location

    def reach(self, direction: Vector) -> float:
        """Return how far it reaches in a horizontal direction, in metres."""
        x, y, _ = direction
        return self.radius + max(x * corner[0] + y * corner[1] for corner in self.corners)


def footprint_facts(workspace: Workspace) -> Facts:
    """Yield the costmaps for which the robot is smaller than it is.

    Where there are several robots, it may be the footprint of one that it has room for.
    """
    rooms = list(_rooms(workspace))
    robots = workspace.robots.known
    if not rooms or not robots or workspace.robots.may_be_others or may_vary(workspace, *_PLACING):
        return
    links = [len(known.robot.links) for known in robots]
    if max(links) > _MAX_LINKS:
        return
    for room in rooms:
        workspace.charge(_OF_LINK * sum(links))
        yield Compared("values")
        beyond = [_beyond(room, robot) for robot in robots]
        if beyond[0] and None not in beyond:
            yield _too_small(room, robots[0], beyond[0])


_FOOTPRINT_SIZE = Rule(
    "footprint-size",
    "values",
    OTHER_VALUE,
    "The footprint of a costmap holds the robot.",
    why=(
        "Nav2 plans for a robot that is smaller than the real one. It drives through gaps that "
        "are too narrow, and hits obstacles."
    ),
    wrong="robot_radius: 0.1",
    right="robot_radius: 0.4",
    frame="costmap.yaml",
    beside={
        "lidar/rover.urdf": "",
    },
)


def _too_small(room: _Room, robot: KnownRobot, beyond: _Reach) -> Mismatch:
    """Return that a link of a robot reaches beyond an area."""
    message = (
        f"{room.said} ends {room.reach(beyond.direction):.3g} m from {quoted(room.base)}, where "
        f"the link {quoted(beyond.link)} of the robot reaches {beyond.distance:.3g} m"
    )
    location = robot.robot.link(beyond.link).location
    at = location.resolve() if location else None
    return warning(_FOOTPRINT_SIZE, message, room.location, at)


def _rooms(workspace: Workspace) -> Iterator[_Room]:
    """Yield the radii and footprints of the costmaps in parameter files."""
    for keys, section in workspace.installed.sections:
        room = _room_in(keys[-1] if keys else "", section)
        if room:
            yield room


def _room_in(name: str, section: YamlNode) -> _Room | None:
    """Return the area of a costmap; of a radius and a footprint, the latter counts."""
    base = section.get(_BASE)
    footprint = section.get(_FOOTPRINT)
    radius = section.get(_RADIUS)
    if not base or not base.text:
        return None
    corners = _corners(footprint)
    if footprint and corners:
        return _Room(f"{name}.{_FOOTPRINT}", base.text, corners, 0.0, footprint.location)
    value = finite_number(radius.text) if radius else None
    if not radius or value is None or value <= 0.0:
        return None
    return _Room(f"{name}.{_RADIUS}", base.text, [(0.0, 0.0)], value, radius.location)


def _corners(node: YamlNode | None) -> list[tuple[float, float]]:
    """Return the corners of a footprint, which is a text with a list of points."""
    if not node or not node.text:
        return []
    try:
        points = yaml_value(node.text)
        corners = [(float(x), float(y)) for x, y in points]
    except (TypeError, ValueError):
        return []
    return corners if len(corners) > 2 else []


def _beyond(room: _Room, known: KnownRobot) -> _Reach | None:
    """Return the link of a robot that reaches farthest beyond an area, or None."""
    robot = Configuration(known.robot)
    worst = None
    worst_excess = 0.0
    with suppress(MissingElement, NotDecided):
        robot.link(room.base)
        for link, shape in _shapes_of_base(robot, room.base):
            for number in range(_DIRECTIONS):
                angle = 2.0 * pi * number / _DIRECTIONS
                direction = (cos(angle), sin(angle), 0.0)
                distance = shape.extent(direction)[1]
                excess = distance - room.reach(direction)
                if excess > worst_excess and excess > _TOLERANCE * distance + _ROUNDING:
                    worst = _Reach(link, distance, direction)
                    worst_excess = excess
    return worst


def _shapes_of_base(robot: Configuration, base: str) -> Iterator[tuple[str, PlacedShape]]:
    """Yield the shapes of known size that stay with the base.

    These are the shapes of its own body and of wheels, not of arms.
    """
    for link in robot.robot.links:
        with suppress(MissingElement):
            joints = robot.between(base, link.name) if link.name != base else ()
            if any(joint.type not in ("fixed", "continuous") for joint in joints):
                continue
            T_base_link = robot.pose(link.name, relative_to=base)
            elements = link.collisions or link.visuals
            for element in elements:
                if not isinstance(element.geometry, Mesh):
                    pose = element.origin.placed_in(T_base_link)
                    yield link.name, PlacedShape(element.geometry, pose)
