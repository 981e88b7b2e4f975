"""Checks of what moves when a joint is turned."""

from math import atan2, degrees, hypot

from grader.checks.outcome import SLACK, Outcome, judged, place, point, quantity, size
from grader.checks.visuals import body, pose_of, visuals
from grader.errors import MissingElement
from grader.robot.kinematics import Configuration
from grader.robot.model import Cylinder, Joint
from grader.robot.shapes import extent, farthest, volume
from grader.robot.transforms import Vector, cross, dot, minus, unit
from grader.source import LazyLocation

_SMALL_ANGLE = 1e-3  # rad; also metres for a sliding joint
_STANDSTILL = 1e-9  # metres
_ROLLING = (
    0.7  # of the way that the lowest point of a level wheel makes against its highest: up to 45 degrees off level
)
_NONE, _Z_AXIS = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
_TURNING_TYPES = ("continuous", "revolute")


def rolls_forward(
    robot: Configuration,
    *,
    link: str,
    base: str,
    forward: Vector = (1.0, 0.0, 0.0),
    up: Vector = (0.0, 0.0, 1.0),
    tolerance: float,
) -> Outcome:
    """Turning a wheel's joint by a small positive angle drives the base forward, if the wheel rolls without slip.

    The lowest point of the wheel must move opposite to `forward`, a direction in the base's frame, within `tolerance`
    degrees in the ground plane across `up`; and it must move so against the wheel's highest point, as it does where a
    wheel rolls and does not where it swivels.
    """
    joint = _turning_joint(robot, link, base)
    ahead, upward = unit(forward) or forward, unit(up) or up
    low, high = _lowest_and_highest(robot, link, base, upward)
    displaced = robot.displacement(link, joint, _SMALL_ANGLE, relative_to=base)
    moved_low = _flat(minus(displaced.apply(low), low), upward)
    moved_high = _flat(minus(displaced.apply(high), high), upward)
    rolled = hypot(*minus(moved_low, moved_high))
    at = _axis_place(joint)
    travel = unit((-moved_low[0], -moved_low[1], -moved_low[2])) if hypot(*moved_low) > _STANDSTILL else None
    if travel is None or rolled < _ROLLING * _SMALL_ANGLE * dot(minus(high, low), upward):
        how = "its lowest point stays where it is" if travel is None else "it swivels about an upright axis"
        message = f"turning joint {joint.name!r} does not roll {link!r}: {how}"
        return judged(False, message, actual=None, expected=ahead, tolerance=tolerance, unit="deg", at=at)
    off = _angle(travel, ahead)
    message = f"a small positive turn of joint {joint.name!r} {_heading(off, travel, base)}"
    fine = off <= tolerance + SLACK
    return judged(fine, message, actual=travel, expected=ahead, tolerance=tolerance, unit="deg", at=at)


def axis_along(
    robot: Configuration, *, link: str, axis: Vector, relative_to: str, direction: Vector, tolerance: float
) -> Outcome:
    """An axis of a link's frame lies along a direction of another link's frame, within `tolerance` degrees."""
    pose = robot.pose(link, relative_to=relative_to)
    actual, expected = pose.rotate(unit(axis) or axis), unit(direction) or direction
    off = _angle(actual, expected)
    message = f"{_axis_name(axis)} of the frame {link!r} points along {point(actual)} in {relative_to!r}"
    fine = off <= tolerance + SLACK
    if not fine:
        message += f", expected {point(expected)}: {quantity(off, 'deg')} off"
    joint = robot.parent_joints.get(link)
    at = place(joint.origin.location if joint and joint.origin else None, "rpy") or place(robot.link(link).location)
    return judged(fine, message, actual=actual, expected=expected, tolerance=tolerance, unit="deg", at=at)


def turns_about_itself(robot: Configuration, *, link: str, base: str, tolerance: float, angle: float) -> Outcome:
    """A cylinder turns about its own axis: the joint's axis has its direction (`angle`, degrees) and place (metres)."""
    cylinders = [each for each in visuals(robot, link) if isinstance(each.geometry, Cylinder)]
    visual = max(cylinders, key=lambda each: volume(each.geometry)) if cylinders else body(robot, link)
    if not isinstance(visual.geometry, Cylinder):
        message = f"{link!r} shows no cylinder, so it has no axis to turn about"
        raise MissingElement("cylinder", link, message=message, location=place(visual.geometry.location))
    joint = _turning_joint(robot, link, base)
    T_joint_wheel = pose_of(robot, link, visual, joint.child)
    turning, own = robot.axis(joint), T_joint_wheel.rotate((0.0, 0.0, 1.0))
    tilt = min(_angle(turning, own), 180.0 - _angle(turning, own))
    away = hypot(*cross(turning, T_joint_wheel.translation))
    at = place(joint.axis_location, "xyz") or place(joint.location)
    if tilt > angle + SLACK:
        message = (
            f"{link!r} wobbles: the axis of joint {joint.name!r} is {quantity(tilt, 'deg')} off the cylinder's axis"
        )
        return judged(False, message, actual=tilt, expected=0.0, tolerance=angle, unit="deg", at=at)
    fine = away <= tolerance + SLACK
    message = f"{link!r} turns about its own axis"
    if not fine:
        message = (
            f"{link!r} turns off its centre: joint {joint.name!r} turns it about a line {size(away, 'm')} beside it"
        )
    at = place(visual.origin.location, "xyz") or at
    return judged(fine, message, actual=away, expected=0.0, tolerance=tolerance, unit="m", at=at)


def _axis_place(joint: Joint) -> LazyLocation | None:
    """Where an axis got its direction: from the joint's own turn, if it is the z axis of a frame that is turned."""
    origin = joint.origin
    if (
        origin is not None
        and any(origin.rpy)
        and joint.axis_location is not None
        and unit(joint.axis or _NONE) == _Z_AXIS
    ):
        return place(origin.location, "rpy")
    return place(joint.axis_location, "xyz") or place(joint.location)


def _turning_joint(robot: Configuration, link: str, base: str) -> Joint:
    """The turning joint next to a link on the way to the base; raises MissingElement where nothing turns."""
    way = robot.between(base, link)
    moving = [joint for joint in way if joint.type in _TURNING_TYPES]
    if not moving:
        message = f"no joint between {base!r} and {link!r} turns"
        raise MissingElement("moving joint", link, message=message, location=place(way[-1].location if way else None))
    return moving[-1]


def _lowest_and_highest(robot: Configuration, link: str, base: str, up: Vector) -> tuple[Vector, Vector]:
    """The lowest and the highest point of what a link shows, in the base's frame; of a face or edge its middle."""
    poses = [(visual.geometry, pose_of(robot, link, visual, base)) for visual in visuals(robot, link)]
    down = (-up[0], -up[1], -up[2])
    lowest = highest = poses[0]
    if len(poses) > 1:
        lowest = min(poses, key=lambda each: extent(each[0], each[1], up)[0])
        highest = max(poses, key=lambda each: extent(each[0], each[1], up)[1])
    return farthest(*lowest, down), farthest(*highest, up)


def _flat(vector: Vector, up: Vector) -> Vector:
    """What is left of a vector in the plane across a unit direction."""
    lifted = dot(vector, up)
    return (vector[0] - lifted * up[0], vector[1] - lifted * up[1], vector[2] - lifted * up[2])


def _heading(off: float, travel: Vector, base: str) -> str:
    if off <= 45.0:
        slant = f", {quantity(off, 'deg')} off straight ahead" if off > 0.05 else ""
        return f"drives {base!r} forward{slant}"
    if off >= 135.0:
        return f"drives {base!r} backward, expected forward"
    return f"drives {base!r} sideways, along {point(travel)}, expected forward"


def _axis_name(axis: Vector) -> str:
    names = {(1.0, 0.0, 0.0): "the x axis", (0.0, 1.0, 0.0): "the y axis", (0.0, 0.0, 1.0): "the z axis"}
    return names.get(axis, f"the direction {point(axis)}")


def _angle(one: Vector, other: Vector) -> float:
    """The angle between two unit vectors in degrees, as exact near 0 as elsewhere; NaN where one has no direction."""
    sine, cosine = hypot(*cross(one, other)), dot(one, other)
    return degrees(atan2(sine, cosine)) if sine or cosine else float("nan")
