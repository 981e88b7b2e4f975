"""In which direction one wheel drives a robot while the ground holds its lowest point."""

from math import asin, degrees, hypot
from typing import Literal

from grader.base.quantities import SLACK, in_degrees
from grader.base.transforms import Vector, dot, minus, unit
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint
from grader.ros.urdf.visuals import placed, visuals

_SMALL_ANGLE = 1e-3  # radians
_STANDSTILL = 1e-9  # metres
_MAX_SLOPE = 45.0  # degrees between the axis of a wheel and the level
_NEARLY = 5.0  # degrees within which an axis is said to be vertical


def find_travel(
    robot: Configuration, link: str, joint: Joint, base: str, up: Vector
) -> tuple[Vector, Literal[""]] | tuple[None, str]:
    """Return the direction in which a small positive rotation drives the base.

    If the wheel does not roll, returns None and why.

    The direction is a unit vector in the base's frame, perpendicular to the unit vector `up`.
    Raises MissingElement, NotDecided or UnknownShape if it cannot be determined.
    """
    shown = visuals(robot, link)
    shapes = [placed(robot, link, visual, base) for visual in shown]
    lowest = shapes[0]
    if len(shapes) > 1:
        lowest = min(shapes, key=lambda shape: shape.extent(up)[0])
    low = lowest.farthest(minus((0.0, 0.0, 0.0), up))
    motion = robot.displacement(link, joint, _SMALL_ANGLE, relative_to=base)
    # While the ground holds the lowest point, the base moves the other way.
    x, y, z = _flatten(minus(motion.apply(low), low), up)
    travel = unit((-x, -y, -z)) if hypot(x, y, z) > _STANDSTILL else None
    if travel is None:
        return None, "its lowest point stays in place"
    axis = robot.pose(joint.child, relative_to=base).rotate(robot.axis(joint))
    slope = degrees(asin(min(1.0, abs(dot(axis, up)))))
    if slope <= _MAX_SLOPE + SLACK:
        return travel, ""
    is_vertical = slope >= 90.0 - _NEARLY
    tilt = (
        "it turns about a vertical axis"
        if is_vertical
        else f"its axis is {in_degrees(slope)} off level"
    )
    return None, tilt


def turning_joint(robot: Configuration, link: str, base: str) -> Joint:
    """Return the turning joint next to a link, on the path to the base.

    Raises MissingElement where nothing turns.
    """
    message = f"no joint between {base!r} and {link!r} turns; one should be continuous or revolute"
    return robot.joint_between(base, link, ("continuous", "revolute"), message)


def _flatten(vector: Vector, up: Vector) -> Vector:
    """Return the part of a vector in the plane across a unit direction."""
    lifted = dot(vector, up)
    return (vector[0] - lifted * up[0], vector[1] - lifted * up[1], vector[2] - lifted * up[2])
