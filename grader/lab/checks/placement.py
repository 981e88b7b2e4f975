"""Checks of positions, measured by forward kinematics with every joint at 0."""

from math import acos, degrees

from grader.base.quantities import point
from grader.base.source import LazyLocation, place
from grader.base.toml_types import Direction, NonNegative
from grader.base.transforms import Z_AXIS, Vector, dot, minus, rotation_from_rpy, turn_between, unit
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, measured_point, measured_turn
from grader.lab.checks.visuals import ShapeName, main_visual
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Mesh, Visual
from grader.ros.urdf.shapes import UnknownShape
from grader.ros.urdf.visuals import origin_place, placed

_LOOSE = {"joint": "a joint between the two links moves"}
ABOUT = {
    "frame_at": About(("joint/origin",), picture="frame", causes=_LOOSE),
    "centre_at": About(("visual/origin",), picture="outline", causes=_LOOSE),
}

_ALONG = 0.9  # the least cosine of the angle between two vectors that count as one direction
_NOT_TURNED = (0.0, 0.0, 0.0)
_ANY_ANGLE = 180.0  # degrees: no two orientations are farther apart
_ANY_AXIS = 90.0  # degrees: no two lines are farther apart


def frame_at(
    robot: Configuration,
    *,
    link: str,
    relative_to: str,
    xyz: Vector,
    tolerance: NonNegative,
    rpy: Vector = _NOT_TURNED,
    angle: NonNegative = _ANY_ANGLE,
) -> Outcome:
    """The origin of a link's frame is at a point in another link's frame, in metres.

    Args:
        link: The link that is examined.
        relative_to: The link in whose frame the point is given.
        xyz: The point: x, y and z, in metres.
        tolerance: How far each coordinate may be off, in metres.
        rpy: The orientation: roll, pitch and yaw about fixed axes, in radians. It counts if `angle`
            is given.
        angle: How far the orientation may be off, in degrees; with 180, it is not checked.
    """
    pose = robot.pose(link, relative_to=relative_to)
    at = origin_place(robot, link)
    position = measured_point(
        f"the frame {link!r}", pose.translation, xyz, tolerance, relative_to, at=at
    )
    if angle < _ANY_ANGLE:
        return _with_orientation(
            position,
            turn_between(pose.rotation, rotation_from_rpy(rpy)),
            angle,
            f"rpy = {point(rpy)} (radians)",
            at,
        )
    return position


def centre_at(
    robot: Configuration,
    *,
    link: str,
    relative_to: str,
    xyz: Vector,
    tolerance: NonNegative,
    rigid: bool = False,
    shape: ShapeName = "any",
    axis: Direction = Z_AXIS,
    angle: NonNegative = _ANY_AXIS,
) -> Outcome:
    """The centre of a link's visual is at a point in another link's frame (m); if rigid, only fixed
    joints are between.

    Args:
        link: The link that is examined.
        relative_to: The link in whose frame the point is given.
        xyz: The point: x, y and z, in metres.
        tolerance: How far each coordinate may be off, in metres.
        rigid: Whether only fixed joints may lie between the two links.
        shape: Which of several visuals counts: the largest of this shape or, without one, the
            largest of all.
        axis: The direction of the visual's z axis in the other frame, either way. It counts if
            `angle` is given.
        angle: How far the z axis may be off, in degrees; with 90, it is not checked.
    """
    visual = main_visual(robot, link, shape)
    if isinstance(visual.geometry, Mesh):
        raise UnknownShape(visual.geometry)
    pose = placed(robot, link, visual, relative_to).pose
    actual = pose.translation
    loose = _loose_joint(robot, link, relative_to) if rigid else None
    if loose:
        return loose
    at = _origin_by(robot, link, visual, relative_to, minus(actual, xyz)) or place(visual.location)
    position = measured_point(
        f"the centre of the visual of {link!r}", actual, xyz, tolerance, relative_to, at=at
    )
    if angle >= _ANY_AXIS:
        return position
    cosine = abs(dot(pose.rotate(Z_AXIS), unit(axis) or axis))
    return _with_orientation(
        position, degrees(acos(min(1.0, cosine))), angle, f"the axis {point(axis)}", at
    )


def _with_orientation(
    placed: Outcome, turned: float, angle: float, wanted: str, at: LazyLocation | None
) -> Outcome:
    """Return the outcome of a position, or the failure of its orientation.

    The orientation may be at most `angle` degrees off.
    """
    if placed.status == "passed" and at and at.attribute == "xyz":
        at = at._replace(attribute="rpy")
    return measured_turn(placed, turned, angle, wanted, at)


def _loose_joint(robot: Configuration, link: str, relative_to: str) -> Outcome | None:
    """Return the failure of a link that moves in another link's frame.

    It is None where only fixed joints lie between.
    """
    path = robot.between(relative_to, link)
    loose = next((joint for joint in path if joint.type != "fixed"), None)
    if not loose:
        return None
    parent_joint = robot.parent_joints.get(link)
    detail = f" (joint {loose.name!r})"
    if parent_joint and parent_joint in path and loose is not parent_joint:
        reason = f"which moves: a joint above it is {loose.type}; it should be fixed"
        at = place(parent_joint.location, "link", "parent")
        message = f"{link!r} is a child of {parent_joint.parent!r}, {reason}"
        return failed(message, at, detail=detail, cause="joint")
    message = f"a joint between {relative_to!r} and {link!r} is {loose.type}; it should be fixed"
    return failed(message, place(loose.location, "type"), detail=detail, cause="joint")


def _origin_by(
    robot: Configuration, link: str, visual: Visual, relative_to: str, off: Vector
) -> LazyLocation | None:
    """Return the origin that puts a visual off.

    This is its own if it moves the visual along that line, else the joint's.

    In the frame of its own link, nothing but the visual's own origin moves it.
    """
    if relative_to == link:
        return place(visual.origin.location, "xyz") or place(visual.location)
    T_relative_link = robot.pose(link, relative_to=relative_to)
    moved = unit(T_relative_link.rotate(visual.origin.xyz))
    error = unit(off)
    if moved is not None and error is not None and abs(dot(moved, error)) > _ALONG:
        return place(visual.origin.location, "xyz")
    return origin_place(robot, link) or place(visual.location)
