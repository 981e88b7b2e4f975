"""Facts about places: of frames, of shapes, and of shapes relative to each other."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tests.second_opinion.elements import Shape, rotation
from tests.second_opinion.geometry import overlap, span
from tests.second_opinion.posed import (
    SLACK,
    UP,
    Fact,
    Missing,
    Posed,
    Undecided,
    angle_between,
    angle_of,
    near,
)


def frame_at(
    posed: Posed,
    link: str,
    relative_to: str,
    xyz: Sequence[float],
    tolerance: float,
    rpy: Sequence[float] = (0, 0, 0),
    angle: float = 180,
) -> Fact:
    pose = posed.pose(link, relative_to)
    is_turned = angle < 180 and angle_of(rotation(*rpy).T @ pose[:3, :3]) > angle + SLACK
    return near(pose[:3, 3], xyz, tolerance) and not is_turned, pose[:3, 3]


def centre_at(
    posed: Posed,
    link: str,
    relative_to: str,
    xyz: Sequence[float],
    tolerance: float,
    rigid: bool = False,
    shape: str = "any",
    axis: Sequence[float] = (0, 0, 1),
    angle: float = 90,
) -> Fact:
    main = posed.main(link, shape)
    if main.kind == "mesh":
        raise Undecided(link)
    pose = posed.pose(link, relative_to) @ main.pose
    is_loose = rigid and any(joint.type != "fixed" for joint in posed.path(link, relative_to))
    tilt = angle_between(pose[:3, 2], axis)
    is_turned = angle < 90 and min(tilt, 180 - tilt) > angle + SLACK
    return near(
        pose[:3, 3], xyz, tolerance
    ) and not is_loose and not is_turned, None if is_loose else pose[:3, 3]


def axis_along(
    posed: Posed,
    link: str,
    axis: Sequence[float],
    relative_to: str,
    direction: Sequence[float],
    tolerance: float,
) -> Fact:
    found = posed.pose(link, relative_to)[:3, :3] @ (np.asarray(axis) / np.linalg.norm(axis))
    return angle_between(found, direction) <= tolerance + SLACK, found


def _spans(
    posed: Posed, shapes: Sequence[Shape], link: str, relative_to: str, direction: Any
) -> tuple[float, float]:
    if any(shape.kind == "mesh" for shape in shapes):
        raise Undecided(link)
    pose = posed.pose(link, relative_to)
    spans = [span(shape, pose @ shape.pose, np.asarray(direction, float)) for shape in shapes]
    return min(low for low, _ in spans), max(high for _, high in spans)


def bottom_at_height(
    posed: Posed, link: str, relative_to: str, height: float, tolerance: float, shape: str = "any"
) -> Fact:
    shapes = posed.visuals(link)
    if shape in {one.kind for one in shapes}:
        shapes = [posed.main(link, shape)]
    low = _spans(posed, shapes, link, relative_to, UP)[0]
    return near(low, height, tolerance), low


def bottoms_at_height(
    posed: Posed, links: Sequence[str], relative_to: str, height: float, tolerance: float
) -> Fact:
    posed.link(relative_to)
    lows, missing = _lows(posed, links, relative_to)
    fine = near(lows, height, tolerance)
    if fine and missing is not None:
        raise missing
    return fine, lows


def _lows(
    posed: Posed, links: Sequence[str], relative_to: str
) -> tuple[list[float], Exception | None]:
    """Return the lowest points that can be measured, and why one of the others cannot: it does not hide them."""
    lows, missing = [], None
    for link in links:
        try:
            posed.pose(link, relative_to)
            lows.append(_spans(posed, posed.visuals(link), link, relative_to, UP)[0])
        except (Missing, Undecided) as error:
            missing = missing or error
    return lows, missing


def stands_on(posed: Posed, link: str, on: str, tolerance: float, shape: str = "any") -> Fact:
    shapes, lower = posed.visuals(link), posed.main(on, shape)
    bottom = _spans(posed, shapes, link, on, UP)[0]
    top = _spans(posed, [lower], on, on, UP)[1]
    fine = near(bottom, top, tolerance)
    directions = list(np.eye(3)[:2])
    if lower.kind == "box":  # its own edges
        directions = sorted(lower.pose[:3, :3].T, key=lambda axis: abs(axis[2]))[:2]
    for direction in directions:
        low, high = _spans(posed, shapes, link, on, direction)
        least, most = _spans(posed, [lower], on, on, direction)
        fine = fine and low >= least - tolerance - SLACK and high <= most + tolerance + SLACK
    return fine, bottom


def clear_of(posed: Posed, link: str, of: str, tolerance: float) -> Fact:
    shapes, others = posed.visuals(link), posed.visuals(of)
    if any(shape.kind == "mesh" for shape in (*shapes, *others)):
        raise Undecided(link)
    pose = posed.pose(link, of)
    depth = max(
        overlap(one, pose @ one.pose, other, other.pose, tolerance)
        for one in shapes
        for other in others
    )
    return depth <= tolerance + SLACK, depth


def under_the_base(
    posed: Posed, link: str, base: str, wheels: Sequence[str], tolerance: float, angle: float
) -> Fact:
    pose = posed.pose(base, link)
    lows, missing = _lows(posed, wheels, link)
    value = [*pose[:2, 3], *lows]
    fine = near(value, 0, tolerance) and angle_of(pose[:3, :3]) <= angle + SLACK
    if fine and missing is not None:
        raise missing
    return fine, value
