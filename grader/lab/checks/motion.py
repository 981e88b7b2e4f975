"""Checks of the motion of a link when its joint turns."""

from dataclasses import replace
from math import asin, degrees, hypot
from typing import Literal

from grader.base.errors import MissingElement
from grader.base.toml_types import Direction, NonNegative
from grader.base.transforms import Z_AXIS, Vector, cross, degrees_between, dot, minus, unit
from grader.lab.checks.check import About
from grader.lab.checks.outcome import (
    SLACK,
    Outcome,
    in_degrees,
    in_millimetres,
    judged,
    place,
    point,
)
from grader.lab.checks.visuals import axis_place, main_visual, placed, visuals
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Cylinder, Joint

ABOUT = {
    "rolls_forward": About(picture="wheel"),
    "axis_along": About(("axis",), picture="frame"),
    "turns_about_itself": About(picture="outline"),
}

_SMALL_ANGLE = 1e-3  # radians
_STANDSTILL = 1e-9  # metres
_MAX_SLOPE = 45.0  # degrees between the axis of a wheel and the level
_MAX_SLANT = 45.0  # degrees off straight ahead within which a base is said to drive forward
_NEARLY = 5.0  # degrees within which an axis is said to be vertical


def rolls_forward(
    robot: Configuration,
    *,
    link: str,
    base: str,
    forward: Direction = (1.0, 0.0, 0.0),
    up: Direction = (0.0, 0.0, 1.0),
    tolerance: NonNegative,
    any_type: bool = False,
) -> Outcome:
    """Turning a wheel's joint by a small positive angle drives the base forward, if the wheel rolls
    without slip.

    The lowest point of the wheel must move opposite to `forward`, and the joint's axis must be
    within 45 degrees of
    level: about an upright axis, a wheel swivels.

    Args:
        link: The link of the wheel.
        base: The link of the base.
        forward: The direction in which the base should drive, in its own frame.
        up: The direction away from the ground, in the base's frame.
        tolerance: How far the direction may be off, in degrees in the ground plane.
        any_type: Whether the parent joint is treated as one that turns, whatever its type.
    """
    robot = _as_turning(robot, link) if any_type else robot
    joint = turning_joint(robot, link, base)
    ahead, upward = unit(forward) or forward, unit(up) or up
    travel, why_not = travel_of(robot, link, joint, base, upward)
    at, detail = axis_place(joint), f" (joint {joint.name!r})"
    if travel is None:
        message = f"{link!r} does not roll when its joint turns: {why_not}"
        return judged(False, message, None, ahead, tolerance, "deg", at=at, detail=detail)
    off = degrees_between(travel, ahead)
    fine = off <= tolerance + SLACK
    message = f"a small positive rotation of {link!r} {_describe_heading(off, travel, base)}"
    if not fine:
        way = "straight ahead" if off <= _MAX_SLANT else "forward"
        message += f"; it should drive it {way}"
    return judged(fine, message, travel, ahead, tolerance, "deg", at=at, detail=detail)


def travel_of(
    robot: Configuration, link: str, joint: Joint, base: str, up: Vector
) -> tuple[Vector, Literal[""]] | tuple[None, str]:
    """Return the direction in which a small positive rotation drives the base, or None and why the
    wheel does not roll.

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


def axis_along(
    robot: Configuration,
    *,
    link: str,
    axis: Direction,
    relative_to: str,
    direction: Direction,
    tolerance: NonNegative,
) -> Outcome:
    """An axis of a link's frame lies along a direction of another link's frame, within `tolerance`
    degrees.

    Args:
        link: The link that is examined.
        axis: A direction in the frame of this link, such as [0, 0, 1] for its z axis.
        relative_to: The link in whose frame the direction is given.
        direction: The direction along which the axis should point.
        tolerance: How far the direction may be off, in degrees.
    """
    pose = robot.pose(link, relative_to=relative_to)
    actual, expected = pose.rotate(unit(axis) or axis), unit(direction) or direction
    off = degrees_between(actual, expected)
    names = {(1.0, 0.0, 0.0): "the x axis", (0.0, 1.0, 0.0): "the y axis", Z_AXIS: "the z axis"}
    name = names.get(axis, f"the direction {point(axis)}")
    message = f"{name} of the frame {link!r} points along {point(actual)} in {relative_to!r}"
    fine = off <= tolerance + SLACK
    if not fine:
        message += f"; it should point along {point(expected)} ({in_degrees(off)} off)"
    joint = robot.parent_joints.get(link)
    origin = joint.origin if joint is not None else None
    at = place(origin.location, "rpy") if origin is not None else None
    at = at or place(robot.link(link).location)
    return judged(fine, message, actual, expected, tolerance, "deg", at=at)


def turns_about_itself(
    robot: Configuration,
    *,
    link: str,
    base: str,
    tolerance: NonNegative,
    angle: NonNegative,
    any_type: bool = False,
) -> Outcome:
    """A cylinder turns about its own axis: the joint's axis has its direction (`angle`, degrees)
    and position (metres).

    Args:
        link: The link that shows the cylinder.
        base: The link relative to which it turns.
        tolerance: How far the joint's axis may be from the cylinder's axis, in metres.
        angle: How far the direction of the joint's axis may be off, in degrees.
        any_type: Whether the parent joint is treated as one that turns, whatever its type.
    """
    robot = _as_turning(robot, link) if any_type else robot
    visual = main_visual(robot, link, "cylinder")
    if not isinstance(visual.geometry, Cylinder):
        message = f"{link!r} shows no cylinder, so it has no axis to turn about"
        raise MissingElement(
            "cylinder", link, message=message, location=place(visual.geometry.location)
        )
    joint = turning_joint(robot, link, base)
    T_joint_wheel = placed(robot, link, visual, joint.child).pose
    turning, own = robot.axis(joint), T_joint_wheel.rotate((0.0, 0.0, 1.0))
    tilt = min(degrees_between(turning, own), 180.0 - degrees_between(turning, own))
    away = hypot(*cross(turning, T_joint_wheel.translation))
    at, detail = place(joint.axis_location, "xyz") or joint.location, f" (joint {joint.name!r})"
    if tilt > angle + SLACK:
        message = (
            f"the joint axis of {link!r} is {in_degrees(tilt)} off the cylinder's axis; they "
            "should coincide"
        )
        return judged(False, message, tilt, 0.0, angle, "deg", at=at, detail=detail)
    fine = away <= tolerance + SLACK
    message = f"{link!r} turns about its own axis"
    if not fine:
        message = (
            f"the joint axis of {link!r} is {in_millimetres(away)} from the cylinder's axis; it "
            "should be on it"
        )
    at = place(visual.origin.location, "xyz") or at
    return judged(fine, message, away, 0.0, tolerance, "m", at=at, detail="" if fine else detail)


def turning_joint(robot: Configuration, link: str, base: str) -> Joint:
    """Return the turning joint next to a link, on the path to the base; raise MissingElement where
    nothing turns.
    """
    message = f"no joint between {base!r} and {link!r} turns; one should be continuous or revolute"
    return robot.joint_between(base, link, ("continuous", "revolute"), message)


def _as_turning(robot: Configuration, link: str) -> Configuration:
    """Return the robot with the parent joint of a link continuous."""
    joint = robot.parent_joints.get(link)
    if joint is None:
        return robot
    known = {key: part for key, part in joint.unresolved.items() if key != "@type"}
    turning = replace(joint.known, type="continuous", unresolved=known)
    joints = (turning if other is joint.known else other for other in robot.known.joints)
    return Configuration(
        replace(robot.known, joints=tuple(joints)), robot.positions, is_guarded=robot.is_guarded
    )


def _flatten(vector: Vector, up: Vector) -> Vector:
    """Return the part of a vector in the plane across a unit direction."""
    lifted = dot(vector, up)
    return (vector[0] - lifted * up[0], vector[1] - lifted * up[1], vector[2] - lifted * up[2])


def _describe_heading(off: float, travel: Vector, base: str) -> str:
    if off <= _MAX_SLANT:
        slant = f", {in_degrees(off)} off straight ahead" if off > 0.05 else ""
        return f"drives {base!r} forward{slant}"
    if off >= 135.0:
        return f"drives {base!r} backward"
    return f"drives {base!r} sideways, along {point(travel)}"
