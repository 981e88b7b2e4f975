"""Checks of where things are, measured by forward kinematics with every joint at 0."""

from collections.abc import Callable, Sequence
from itertools import product
from math import acos, degrees

from grader.checks.outcome import (
    SLACK,
    Outcome,
    difference,
    failed,
    judged,
    measured,
    measured_point,
    place,
    point,
    quantity,
    size,
    within,
)
from grader.checks.visuals import ShapeName, body, pose_of, shape_name, span, visuals
from grader.errors import MissingElement
from grader.robot.kinematics import Configuration
from grader.robot.model import Box, Geometry, Mesh, Visual
from grader.robot.separation import penetration
from grader.robot.shapes import UnknownShape, extent
from grader.robot.transforms import Transform, Vector, dot, minus, unit
from grader.source import LazyLocation

_AHEAD: Vector = (1.0, 0.0, 0.0)
_LEFT: Vector = (0.0, 1.0, 0.0)
_ALONG = 0.9  # the cosine of an angle that still counts as one direction
_MOST_PAIRS = 2_000
_UP: Vector = (0.0, 0.0, 1.0)


def frame_at(robot: Configuration, *, link: str, relative_to: str, xyz: Vector, tolerance: float) -> Outcome:
    """The origin of a link's frame is at a point in another link's frame, in metres."""
    pose = robot.pose(link, relative_to=relative_to)
    return measured_point(
        f"the frame {link!r}",
        actual=pose.translation,
        expected=xyz,
        tolerance=tolerance,
        frame=relative_to,
        at=_origin_place(robot, link),
    )


def centre_at(
    robot: Configuration,
    *,
    link: str,
    relative_to: str,
    xyz: Vector,
    tolerance: float,
    rigid: bool = False,
    shape: ShapeName = "any",
) -> Outcome:
    """The centre of what a link shows is at a point in another link's frame; if rigid, no moving joint lies between.

    Of several visuals the largest counts, among those of the named shape if there are any.
    """
    visual = body(robot, link, shape)
    if isinstance(visual.geometry, Mesh):
        raise UnknownShape(visual.geometry)
    pose = pose_of(robot, link, visual, relative_to)
    if rigid:
        way = robot.between(relative_to, link)
        loose = next((joint for joint in way if joint.type != "fixed"), None)
        held = robot.parent_joints.get(link)
        if loose is not None and held is not None and held in way and loose is not held:
            message = f"joint {held.name!r} holds {link!r} to {held.parent!r}, which moves: joint {loose.name!r} is {loose.type}"
            return failed(message, place(held.location, "link", "parent"))
        if loose is not None:
            message = f"joint {loose.name!r} between {relative_to!r} and {link!r} is {loose.type}, expected fixed"
            return failed(message, place(loose.location, "type"))
    at = _culprit(robot, link, visual, relative_to, minus(pose.translation, xyz))
    return measured_point(
        f"the centre of what {link!r} shows",
        actual=pose.translation,
        expected=xyz,
        tolerance=tolerance,
        frame=relative_to,
        at=at or place(visual.location),
    )


def bottom_at_height(
    robot: Configuration, *, link: str, relative_to: str, height: float, tolerance: float, shape: ShapeName = "any"
) -> Outcome:
    """The lowest point of what a link shows is at a height (z) in another link's frame, in metres.

    Where a shape is named and the link shows it, only the largest of these counts.
    """
    visual = body(robot, link, shape)
    if shape == "any" or shape_name(visual.geometry) != f"a {shape}":
        lowest, _ = span(robot, link, relative_to, _UP)
    else:
        lowest, _ = extent(visual.geometry, pose_of(robot, link, visual, relative_to), _UP)
    return measured(
        f"the bottom of {link!r} in the frame {relative_to!r}",
        actual=lowest,
        expected=height,
        tolerance=tolerance,
        unit="m",
        sides=("too high", "too low"),
        at=place(visual.origin.location, "xyz") or place(visual.location),
    )


def bottoms_at_height(
    robot: Configuration, *, links: list[str], relative_to: str, height: float, tolerance: float
) -> Outcome:
    """Several links all reach down to the same height (z) in another link's frame, in metres."""
    robot.link(relative_to)
    lowest, missing = _each(links, lambda link: span(robot, link, relative_to, _UP)[0])
    wrong = {link: value for link, value in lowest.items() if not within(value, height, tolerance)}
    actual = tuple(lowest.values())
    if not wrong and missing is not None:
        raise missing
    message = f"the bottoms of {', '.join(map(repr, lowest))} are at z = {point(actual)} m in {relative_to!r}"
    if wrong:
        off = [f"{link!r} is {difference(value - height, 'm', 'too high', 'too low')}" for link, value in wrong.items()]
        message += f", expected {height:g} m: {', '.join(off)}"
    at = _common_place(robot, wrong, lowest, relative_to, tolerance) if wrong else None
    return judged(not wrong, message, actual=actual, expected=height, tolerance=tolerance, unit="m", at=at)


def stands_on(robot: Configuration, *, link: str, on: str, tolerance: float, shape: ShapeName = "any") -> Outcome:
    """What a link shows stands on the top of what another shows: no gap, no overlap, within its outline.

    Of several visuals of the one below the largest counts, among those of the named shape if there are any.
    """
    support = body(robot, on, shape)
    T_on_support = pose_of(robot, on, support, on)
    placed = [(visual.geometry, pose_of(robot, link, visual, on)) for visual in visuals(robot, link)]
    bottom = min(extent(geometry, pose, _UP)[0] for geometry, pose in placed)
    _, top = extent(support.geometry, T_on_support, _UP)
    beyond = _overhang(placed, support.geometry, T_on_support)
    message = f"{link!r} stands on the top of {on!r}, at z = {point((top,))} m in {on!r}"
    fine = within(bottom, top, tolerance)
    if not fine:
        fault = "floats above it" if bottom > top else "is sunk into it"
        message = (
            f"the bottom of {link!r} is at z = {point((bottom,))} m in {on!r} and the top of {on!r} at {point((top,))} m:"
            f" {link!r} {fault} by {size(bottom - top, 'm')}"
        )
    elif beyond > tolerance + SLACK:
        fine = False
        message = f"{link!r} reaches {size(beyond, 'm')} beyond the edge of the top of {on!r}"
    at = _origin_place(robot, link) if within(bottom, top, tolerance) else None  # either of the two may be wrong
    return judged(fine, message, actual=bottom, expected=top, tolerance=tolerance, unit="m", at=at)


def clear_of(robot: Configuration, *, link: str, of: str, tolerance: float) -> Outcome:
    """Nothing that a link shows cuts into what another shows, deeper than the tolerance in metres; touching is fine."""
    ours = [(visual, pose_of(robot, link, visual, of)) for visual in visuals(robot, link)]
    theirs = [(visual.geometry, pose_of(robot, of, visual, of)) for visual in visuals(robot, of)]
    if len(ours) * len(theirs) > _MOST_PAIRS:
        message = f"{link!r} and {of!r} show too many shapes to compare each with each; a person has to look"
        return Outcome("pending", message)
    deepest, culprit = 0.0, ours[0][0]
    unknown: Geometry | None = None
    for (visual, pose), (geometry, other) in product(ours, theirs):
        if isinstance(visual.geometry, Mesh) or isinstance(geometry, Mesh):
            unknown = visual.geometry if isinstance(visual.geometry, Mesh) else geometry
            continue
        depth = penetration(visual.geometry, pose, geometry, other, allowed=tolerance)
        if depth > deepest:
            deepest, culprit = depth, visual
    fine = deepest <= tolerance
    if fine and isinstance(unknown, Mesh):
        raise UnknownShape(unknown)
    message = f"{link!r} does not cut into {of!r}" if fine else f"{link!r} cuts {size(deepest, 'm')} deep into {of!r}"
    at = place(culprit.origin.location, "xyz") or place(culprit.location)
    return judged(fine, message, actual=round(deepest, 4), expected=0.0, tolerance=tolerance, unit="m", at=at)


def under_the_base(
    robot: Configuration, *, link: str, base: str, wheels: list[str], tolerance: float, angle: float
) -> Outcome:
    """A frame has the x, y and orientation of a base's frame and is level with the lowest points of the wheels.

    `tolerance` in metres, `angle` in degrees.
    """
    T_link_base = robot.pose(base, relative_to=link)
    x, y, _ = T_link_base.translation
    turned = _turned(T_link_base)
    lowest, missing = _each(wheels, lambda wheel: span(robot, wheel, link, _UP)[0])
    faults = []
    if not (within(x, 0.0, tolerance) and within(y, 0.0, tolerance)):
        faults.append(f"{base!r} is at x, y = {point((x, y))} m in it, expected 0 0")
    if turned > angle:
        faults.append(f"{base!r} is turned by {quantity(turned, 'deg')} in it, expected 0")
    for wheel, value in lowest.items():
        if not within(value, 0.0, tolerance):
            side = "above" if value > 0 else "below"
            faults.append(f"the lowest point of {wheel!r} is {size(value, 'm')} {side} it")
    if missing is not None and not faults:
        raise missing
    message = f"the frame {link!r} is under {base!r}, level with the bottoms of the wheels"
    if faults:
        message = f"the frame {link!r} is not level with the bottoms of the wheels under {base!r}: {'; '.join(faults)}"
    actual = (x, y, *lowest.values())
    off = {wheel: value for wheel, value in lowest.items() if not within(value, 0.0, tolerance)}
    at = _origin_place(robot, base)
    if len(off) == len(faults) < len(lowest):  # the frame is where it should be, and some wheel is not
        at = _origin_place(robot, next(iter(off), base))
    return judged(not faults, message, actual=actual, expected=0.0, tolerance=tolerance, unit="m", at=at)


def _each(
    links: Sequence[str], measure: Callable[[str], float]
) -> tuple[dict[str, float], MissingElement | UnknownShape | None]:
    """What can be measured of each link; and the reason why one cannot, so that it does not hide the others."""
    found: dict[str, float] = {}
    missing: MissingElement | UnknownShape | None = None
    for link in links:
        try:
            found[link] = measure(link)
        except (MissingElement, UnknownShape) as error:
            missing = missing or error.with_traceback(None)  # which would hold this very frame, and all that is in it
    return found, missing


def _overhang(placed: list[tuple[Geometry, Transform]], support: Geometry, T_on_support: Transform) -> float:
    """How far shapes reach beyond the outline of the one below, seen from above, in metres."""
    directions = [_AHEAD, _LEFT]
    if isinstance(support, Box):  # its own edges: it may be turned about the vertical
        axes = [T_on_support.rotate(axis) for axis in (_AHEAD, _LEFT, _UP)]
        directions = sorted(axes, key=lambda axis: abs(axis[2]))[:2]
    beyond = 0.0
    for direction in directions:
        low, high = extent(support, T_on_support, direction)
        for geometry, pose in placed:
            our_low, our_high = extent(geometry, pose, direction)
            beyond = max(beyond, low - our_low, our_high - high)
    return beyond


def _turned(pose: Transform) -> float:
    """The angle of a rotation in degrees."""
    a, e, i = pose.rotation[0], pose.rotation[4], pose.rotation[8]
    return degrees(acos(max(-1.0, min(1.0, (a + e + i - 1.0) / 2.0))))


def _culprit(robot: Configuration, link: str, visual: Visual, relative_to: str, off: Vector) -> LazyLocation | None:
    """Which origin to look at where a visual is off: its own if it is moved along that line, else the joint's."""
    T_relative_link = robot.pose(link, relative_to=relative_to)
    moved, error = unit(T_relative_link.rotate(visual.origin.xyz)), unit(off)
    if moved is not None and error is not None and abs(dot(moved, error)) > _ALONG:
        return place(visual.origin.location, "xyz")
    return _origin_place(robot, link) or place(visual.location)


def _common_place(
    robot: Configuration, wrong: dict[str, float], lowest: dict[str, float], relative_to: str, tolerance: float
) -> LazyLocation | None:
    """Where to look if some heights are off: where the frame is put if all are off alike, else where the first is put."""
    first, value = next(iter(wrong.items()))
    alike = len(wrong) == len(lowest) > 1 and all(within(each, value, tolerance) for each in wrong.values())
    way = robot.chain(first, above=relative_to) if alike else None
    return _origin_place(robot, way[0].child if way else first)


def _origin_place(robot: Configuration, link: str) -> LazyLocation | None:
    """Where the origin is written that puts a link into its parent."""
    joint = robot.parent_joints.get(link)
    if joint is None:
        return place(robot.link(link).location)
    return place(joint.origin.location if joint.origin else None, "xyz") or place(joint.location)
