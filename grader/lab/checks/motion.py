"""Checks of the motion of a link when its joint turns."""

from dataclasses import replace
from math import hypot

from grader.base.errors import MissingElement
from grader.base.quantities import SLACK, in_degrees, in_millimetres, point
from grader.base.source import place
from grader.base.toml_types import Direction, NonNegative
from grader.base.transforms import Z_AXIS, Vector, cross, degrees_between, unit
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, judged
from grader.lab.checks.visuals import main_visual
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Cylinder
from grader.ros.urdf.visuals import axis_place, placed
from grader.ros.urdf.wheel_travel import find_travel, turning_joint

ABOUT = {
    "rolls_forward": About(picture="wheel"),
    "axis_along": About(("axis",), picture="frame"),
    "turns_about_itself": About(picture="outline"),
}

_MAX_SLANT = 45.0  # degrees off straight ahead within which a base is said to drive forward


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
    ahead = unit(forward) or forward
    upward = unit(up) or up
    travel, why_not = find_travel(robot, link, joint, base, upward)
    at = axis_place(joint)
    detail = f" (joint {joint.name!r})"
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
    actual = pose.rotate(unit(axis) or axis)
    expected = unit(direction) or direction
    off = degrees_between(actual, expected)
    names = {(1.0, 0.0, 0.0): "the x axis", (0.0, 1.0, 0.0): "the y axis", Z_AXIS: "the z axis"}
    name = names.get(axis, f"the direction {point(axis)}")
    message = f"{name} of the frame {link!r} points along {point(actual)} in {relative_to!r}"
    fine = off <= tolerance + SLACK
    if not fine:
        message += f"; it should point along {point(expected)} ({in_degrees(off)} off)"
    joint = robot.parent_joints.get(link)
    origin = joint.origin if joint else None
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
    turning = robot.axis(joint)
    wheel_axis = T_joint_wheel.rotate((0.0, 0.0, 1.0))
    tilt = min(degrees_between(turning, wheel_axis), 180.0 - degrees_between(turning, wheel_axis))
    away = hypot(*cross(turning, T_joint_wheel.translation))
    at = place(joint.axis_location, "xyz") or joint.location
    detail = f" (joint {joint.name!r})"
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


def _as_turning(robot: Configuration, link: str) -> Configuration:
    """Return the robot with the parent joint of a link continuous."""
    joint = robot.parent_joints.get(link)
    if not joint:
        return robot
    known = {key: part for key, part in joint.unresolved.items() if key != "@type"}
    turning = joint.known._replace(type="continuous", unresolved=known)
    joints = (turning if other is joint.known else other for other in robot.known.joints)
    return Configuration(
        replace(robot.known, joints=tuple(joints)), robot.positions, is_guarded=robot.is_guarded
    )


def _describe_heading(off: float, travel: Vector, base: str) -> str:
    if off <= _MAX_SLANT:
        slant = f", {in_degrees(off)} off straight ahead" if off > 0.05 else ""
        return f"drives {base!r} forward{slant}"
    if off >= 135.0:
        return f"drives {base!r} backward"
    return f"drives {base!r} sideways, along {point(travel)}"
