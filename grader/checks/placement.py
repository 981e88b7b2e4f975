"""Checks of positions, measured by forward kinematics with every joint at 0."""

from collections.abc import Callable, Sequence
from math import acos, degrees

from grader.checks.outcome import (
    SLACK,
    Outcome,
    difference,
    failed,
    in_degrees,
    judged,
    location_of,
    measured,
    measured_point,
    place,
    point,
    within,
)
from grader.checks.toml_types import Direction, NonNegative
from grader.checks.visuals import ShapeName, main_visual, origin_place, shape_name, span, visual_pose
from grader.errors import MissingElement
from grader.robot.kinematics import Configuration
from grader.robot.likeness import turn_between
from grader.robot.model import Mesh, Visual
from grader.robot.shapes import UnknownShape, extent
from grader.robot.transforms import IDENTITY_ROTATION, Vector, dot, minus, rotation_from_rpy, unit
from grader.source import LazyLocation
from grader.text import enumerated

_ALONG = 0.9  # the least cosine of the angle between two vectors that count as one direction
_UP: Vector = (0.0, 0.0, 1.0)
_NOT_TURNED: Vector = (0.0, 0.0, 0.0)
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
        rpy: The orientation: roll, pitch and yaw about fixed axes, in radians. It counts if `angle` is given.
        angle: How far the orientation may be off, in degrees; with 180, it is not checked.
    """
    pose, at = robot.pose(link, relative_to=relative_to), origin_place(robot, link)
    placed = measured_point(f"the frame {link!r}", pose.translation, xyz, tolerance, relative_to, at=at)
    return (
        _turned(placed, turn_between(pose.rotation, rotation_from_rpy(rpy)), angle, at)
        if angle < _ANY_ANGLE
        else placed
    )


def centre_at(
    robot: Configuration,
    *,
    link: str,
    relative_to: str,
    xyz: Vector,
    tolerance: NonNegative,
    rigid: bool = False,
    shape: ShapeName = "any",
    axis: Direction = _UP,
    angle: NonNegative = _ANY_AXIS,
) -> Outcome:
    """The centre of a link's visual is at a point in another link's frame, in metres; if rigid, only fixed joints lie between.

    Args:
        link: The link that is examined.
        relative_to: The link in whose frame the point is given.
        xyz: The point: x, y and z, in metres.
        tolerance: How far each coordinate may be off, in metres.
        rigid: Whether only fixed joints may lie between the two links.
        shape: Which of several visuals counts: the largest of this shape or, without one, the largest of all.
        axis: The direction of the visual's z axis in the other frame, either way. It counts if `angle` is given.
        angle: How far the z axis may be off, in degrees; with 90, it is not checked.
    """
    visual = main_visual(robot, link, shape)
    if isinstance(visual.geometry, Mesh):
        raise UnknownShape(visual.geometry)
    pose = visual_pose(robot, link, visual, relative_to)
    actual = pose.translation
    loose = _loose_joint(robot, link, relative_to) if rigid else None
    if loose is not None:
        return loose
    at = _moved_by(robot, link, visual, relative_to, minus(actual, xyz)) or place(visual.location)
    placed = measured_point(f"the centre of the visual of {link!r}", actual, xyz, tolerance, relative_to, at=at)
    if angle >= _ANY_AXIS:
        return placed
    cosine = abs(dot(pose.rotate(_UP), unit(axis) or axis))
    return _turned(placed, degrees(acos(min(1.0, cosine))), angle, at)


def bottom_at_height(
    robot: Configuration,
    *,
    link: str,
    relative_to: str,
    height: float,
    tolerance: NonNegative,
    shape: ShapeName = "any",
) -> Outcome:
    """The lowest point of a link's visuals is at a height (z) in another link's frame, in metres.

    Args:
        link: The link that is examined.
        relative_to: The link in whose frame the height is given.
        height: The height (z), in metres.
        tolerance: How far the height may be off, in metres.
        shape: If given and the link shows it, only the largest visual of this shape counts.
    """
    visual = main_visual(robot, link, shape)
    if shape == "any" or shape_name(visual.geometry) != f"a {shape}":
        lowest, _ = span(robot, link, relative_to, _UP)
    else:
        lowest, _ = extent(visual.geometry, visual_pose(robot, link, visual, relative_to), _UP)
    what = f"the bottom of {link!r} in the frame {relative_to!r} is at z ="
    at = place(visual.origin.location, "xyz") or visual.location
    return measured(what, lowest, height, tolerance, sides=("too high", "too low"), at=at)


def bottoms_at_height(
    robot: Configuration, *, links: list[str], relative_to: str, height: float, tolerance: NonNegative
) -> Outcome:
    """The lowest points of several links are at the same height (z) in another link's frame, in metres.

    Args:
        links: The links that are examined.
        relative_to: The link in whose frame the height is given.
        height: The height (z), in metres.
        tolerance: How far each height may be off, in metres.
    """
    robot.link(relative_to)
    lowest, missing = _measured(links, lambda link: span(robot, link, relative_to, _UP)[0])
    wrong = {link: value for link, value in lowest.items() if not within(value, height, tolerance)}
    actual = tuple(lowest.values())
    if not wrong and missing is not None:
        raise missing
    names = enumerated([repr(link) for link in lowest])
    message = f"the bottoms of {names} are at z = {point(actual)} m in {relative_to!r}"
    if wrong:
        off = [f"{link!r} {difference(value - height, 'too high', 'too low')}" for link, value in wrong.items()]
        message += f"; they should be at {height:g} m ({', '.join(off)})"
    at = _common_place(robot, wrong, lowest, relative_to, tolerance) if wrong else None
    return judged(not wrong, message, actual, height, tolerance, "m", at=at)


def under_the_base(
    robot: Configuration, *, link: str, base: str, wheels: list[str], tolerance: NonNegative, angle: NonNegative
) -> Outcome:
    """A frame has the x, y and orientation of a base's frame and is level with the lowest points of the wheels.

    Args:
        link: The link whose frame is examined, such as base_footprint.
        base: The link of the base.
        wheels: The links of the wheels.
        tolerance: How far x, y and the height may each be off, in metres.
        angle: How far the orientation may be off, in degrees.
    """
    T_link_base = robot.pose(base, relative_to=link)
    x, y, _ = T_link_base.translation
    turned = turn_between(T_link_base.rotation, IDENTITY_ROTATION)
    lowest, missing = _measured(wheels, lambda wheel: span(robot, wheel, link, _UP)[0])
    off = {wheel: value for wheel, value in lowest.items() if not within(value, 0.0, tolerance)}
    faults = []
    if not (within(x, 0.0, tolerance) and within(y, 0.0, tolerance)):
        faults.append(f"{base!r} is at x, y = {point((x, y))} m in it and should be at 0 0")
    if turned > angle:
        faults.append(f"{base!r} is turned by {in_degrees(turned)} in it and should not be turned")
    heights = {wheel: difference(value, "above", "below") for wheel, value in off.items()}
    faults += [f"the lowest point of {wheel!r} is {height} it" for wheel, height in heights.items()]
    if missing is not None and not faults:
        raise missing
    verb, found = ("should be", f": {'; '.join(faults)}") if faults else ("is", "")
    message = f"the frame {link!r} {verb} under {base!r}, level with the bottoms of the wheels{found}"
    actual = (x, y, *lowest.values())
    at = origin_place(robot, base)
    if len(off) == len(faults) < len(lowest):  # the frame is where it should be, and some wheel is not
        at = origin_place(robot, next(iter(off), base))
    return judged(not faults, message, actual, 0.0, tolerance, "m", at=at)


def _turned(placed: Outcome, turned: float, angle: float, at: LazyLocation | None) -> Outcome:
    """Return the outcome of a position, or its failure where the orientation is more than `angle` degrees off."""
    if turned <= angle + SLACK:
        return placed
    message = f"{placed.message}; its orientation is {in_degrees(turned)} off"
    return placed._replace(status="failed", message=message, location=location_of(at))


def _loose_joint(robot: Configuration, link: str, relative_to: str) -> Outcome | None:
    """Return the failure of a link that moves in another link's frame; None where only fixed joints lie between."""
    path = robot.between(relative_to, link)
    loose = next((joint for joint in path if joint.type != "fixed"), None)
    if loose is None:
        return None
    own, detail = robot.parent_joints.get(link), f" (joint {loose.name!r})"
    if own is not None and own in path and loose is not own:
        reason = f"which moves: a joint above it is {loose.type}; it should be fixed"
        at = place(own.location, "link", "parent")
        return failed(f"{link!r} is a child of {own.parent!r}, {reason}", at, detail=detail)
    message = f"a joint between {relative_to!r} and {link!r} is {loose.type}; it should be fixed"
    return failed(message, place(loose.location, "type"), detail=detail)


def _measured(
    links: Sequence[str], measure: Callable[[str], float]
) -> tuple[dict[str, float], MissingElement | UnknownShape | None]:
    """Return what can be measured of each link; and why one of them cannot, so that it does not hide the others."""
    found: dict[str, float] = {}
    missing: MissingElement | UnknownShape | None = None
    for link in links:
        try:
            found[link] = measure(link)
        except (MissingElement, UnknownShape) as error:
            missing = missing or error.with_traceback(None)  # a traceback keeps this frame and its values alive
    return found, missing


def _moved_by(robot: Configuration, link: str, visual: Visual, relative_to: str, off: Vector) -> LazyLocation | None:
    """Return the origin that puts a visual off: its own if it moves the visual along that line, else the joint's."""
    T_relative_link = robot.pose(link, relative_to=relative_to)
    moved, error = unit(T_relative_link.rotate(visual.origin.xyz)), unit(off)
    if moved is not None and error is not None and abs(dot(moved, error)) > _ALONG:
        return place(visual.origin.location, "xyz")
    return origin_place(robot, link) or place(visual.location)


def _common_place(
    robot: Configuration, wrong: dict[str, float], lowest: dict[str, float], relative_to: str, tolerance: float
) -> LazyLocation | None:
    """Return where to look if heights are off: the origin of the frame if all are off alike, else that of the first link."""
    first, value = next(iter(wrong.items()))
    alike = len(wrong) == len(lowest) > 1 and all(within(other, value, tolerance) for other in wrong.values())
    chain = robot.chain(first, above=relative_to) if alike else None
    return origin_place(robot, chain[0].child if chain else first)
