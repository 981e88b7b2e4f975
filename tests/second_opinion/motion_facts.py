"""Facts about joints and what they move."""

from collections.abc import Sequence
from copy import copy
from dataclasses import replace

import numpy as np

from tests.second_opinion.elements import Joint, Matrix, Shape, turn
from tests.second_opinion.geometry import reach
from tests.second_opinion.posed import (
    SLACK,
    Fact,
    Missing,
    Posed,
    Undecided,
    Unsure,
    angle_between,
    near,
)
from tests.second_opinion.robot import Robot

_SMALL_TURN = 1e-3  # radians
_RANDOM = np.random.default_rng(11).random((40, 6))


def _turning(posed: Posed, link: str, base: str) -> tuple[Joint, Matrix, Matrix]:
    """Return the turning joint next to a link on the path to the base, its axis, and a point on it, in the base's frame."""
    joint = next(
        (joint for joint in posed.path(link, base) if joint.type in ("continuous", "revolute")),
        None,
    )
    if joint is None:
        raise Missing("moving joint", link)
    return joint, *_line(posed, joint, base)


def _line(posed: Posed, joint: Joint, relative_to: str) -> tuple[Matrix, Matrix]:
    length = np.linalg.norm(joint.axis)
    if length == 0:
        raise Missing("pose", joint.name)
    pose = posed.pose(joint.child, relative_to)
    return pose[:3, :3] @ joint.axis / length, pose[:3, 3]


def _as_turning(posed: Posed, link: str) -> Posed:
    """Return the robot with the parent joint of a link continuous."""
    robot = copy(posed.robot)
    robot.parents = dict(robot.parents)
    if link in robot.parents:
        robot.parents[link] = replace(robot.parents[link], type="continuous")
    return Posed(robot)


def rolls_forward(
    posed: Posed,
    link: str,
    base: str,
    tolerance: float,
    forward: Sequence[float] = (1, 0, 0),
    up: Sequence[float] = (0, 0, 1),
    any_type: bool = False,
) -> Fact:
    posed = _as_turning(posed, link) if any_type else posed
    _, axis, point = _turning(posed, link, base)
    shapes, pose, above = posed.visuals(link), posed.pose(link, base), np.asarray(up, float)
    move = (turn(axis, _SMALL_TURN) - np.eye(3)) @ (_extreme(shapes, pose, -above) - point)
    low = move - above * (move @ above)
    if np.linalg.norm(low) < 1e-9 or not 45 <= angle_between(axis, above) <= 135:
        return False, None
    drive = -low / np.linalg.norm(low)
    return angle_between(drive, forward) <= tolerance + SLACK, drive


def _extreme(shapes: Sequence[Shape], pose: Matrix, direction: Matrix) -> Matrix:
    """Return the point of the shapes that is farthest along a direction; the middle of those that are equally far."""
    best, far = np.zeros(3), -np.inf
    for shape in shapes:
        if shape.kind == "mesh":
            raise Undecided
        placed = pose @ shape.pose
        local, size = placed[:3, :3].T @ direction, np.abs(shape.size)
        local = np.where(np.abs(local) < 1e-9, 0, local)
        match shape.kind:
            case "box":
                point = np.sign(local) * size / 2
            case "cylinder":
                across = np.hypot(local[0], local[1])
                point = np.array(
                    [
                        *(local[:2] / across * size[0] if across else (0, 0)),
                        np.sign(local[2]) * size[1] / 2,
                    ]
                )
            case _:
                point = local * size[0]
        reached = placed[:3, 3] @ direction + reach(shape, placed[:3, :3], direction[None])[0]
        if reached > far + 1e-12:
            best, far = placed[:3, :3] @ point + placed[:3, 3], reached
    return best


def turns_about_itself(
    posed: Posed, link: str, base: str, tolerance: float, angle: float, any_type: bool = False
) -> Fact:
    cylinders = [shape for shape in posed.visuals(link) if shape.kind == "cylinder"]
    if not cylinders:
        raise Missing("cylinder", link)
    posed = _as_turning(posed, link) if any_type else posed
    _, axis, point = _turning(posed, link, base)
    pose = posed.pose(link, base) @ max(cylinders, key=lambda shape: shape.volume).pose
    tilt = angle_between(pose[:3, 2], axis)
    distance = np.linalg.norm(np.cross(pose[:3, 3] - point, axis))
    off = min(tilt, 180 - tilt)
    is_along = off <= angle + SLACK
    return bool(is_along and distance <= tolerance + SLACK), distance if is_along else off


def joint_limits(
    posed: Posed,
    link: str,
    lower: float,
    upper: float,
    tolerance: float,
    effort: float | None = None,
    velocity: float | None = None,
) -> Fact:
    joint = posed.mover(link)
    if joint.type not in ("revolute", "prismatic"):
        return False, None
    if joint.limit is None:
        return False, None
    found = np.array(joint.limit)
    if joint.type == "revolute":
        found[:2] = np.degrees(found[:2])
    fine = near(found[:2], (lower, upper), tolerance)
    rest = [
        (actual, wanted)
        for actual, wanted in zip(found[2:], (effort, velocity), strict=True)
        if wanted is not None
    ]
    return fine and all(near(actual, wanted, 1e-6) for actual, wanted in rest), found[
        : 2 + len(rest)
    ]


def joint_axis(
    posed: Posed,
    link: str,
    relative_to: str,
    direction: Sequence[float],
    tolerance: float,
    either_way: bool = False,
    through: Sequence[float] | None = None,
    distance: float = 0.002,
) -> Fact:
    posed.pose(link, relative_to)
    joint = posed.mover(link)
    if joint.type == "floating":
        return False, None
    axis, point = _line(posed, joint, relative_to)
    off = angle_between(axis, direction)
    if (min(off, 180 - off) if either_way else off) > tolerance + SLACK:
        return False, axis
    if through is None:
        return True, axis
    gap = np.linalg.norm(np.cross(point - through, axis))
    return bool(gap <= distance + SLACK), gap


def kinematics_match_reference(
    posed: Posed,
    links: Sequence[str],
    match: str,
    tolerance: float,
    angle: float,
    *,
    reference: Robot,
) -> Fact:
    """Compare at many positions of its own; only what holds at nearly none or at most of them is decided."""
    assert match == "order"
    posed = Posed(posed.robot)
    base = next(iter(reference.trees))
    base = (
        base
        if base in posed.robot.links
        else max(posed.robot.trees, key=lambda root: len(posed.robot.trees[root]))
    )
    expected = Posed(reference)
    shares = []
    for link in links:
        path = posed.path(link, base)
        chains = [
            [joint for joint in way[::-1] if joint.type != "fixed"]
            for way in (path, expected.path(link, expected.root(link)))
        ]
        if any(joint.is_mimic for joint in path):
            raise Unsure
        if len(chains[0]) != len(chains[1]):
            return False, None
        if any(one.type == "prismatic" or one.type in ("planar", "floating") for one in chains[0]):
            return False, None
        limits = np.array([joint.limit[:2] for joint in chains[1] if joint.limit])
        positions = np.vstack(
            [
                np.zeros(len(limits)),
                _RANDOM[:, : len(limits)] * (limits[:, 1] - limits[:, 0]) + limits[:, 0],
            ]
        )
        poses = [
            _chained(one, link, chain, positions)
            for one, chain in zip((posed, expected), chains, strict=True)
        ]
        gaps = np.linalg.norm(poses[0][:, :3, 3] - poses[1][:, :3, 3], axis=1)
        turns = np.einsum("nji,njk->nik", poses[0][:, :3, :3], poses[1][:, :3, :3])
        angles = np.degrees(np.arccos(np.clip((np.einsum("nii->n", turns) - 1) / 2, -1, 1)))
        is_off = (gaps > tolerance + SLACK) | (angles > angle + SLACK)
        if is_off[0] or is_off.mean() > 0.5:
            return False, None
        shares.append(max(gaps.max() / tolerance, angles.max() / angle))
    if max(shares) > 0.9:
        raise Unsure
    return True, None


def _chained(posed: Posed, link: str, chain: Sequence[Joint], positions: Matrix) -> Matrix:
    """Return T_root_link at many positions of the joints of a chain (rows)."""
    found = np.broadcast_to(np.eye(4), (len(positions), 4, 4))
    last = posed.root(link)
    for joint, angles in zip(chain, positions.T, strict=True):
        length = np.linalg.norm(joint.axis)
        if length == 0:
            raise Missing("pose", joint.name)
        turns = np.broadcast_to(np.eye(4), found.shape).copy()
        turns[:, :3, :3] = [turn(joint.axis / length, angle) for angle in angles]
        found = found @ posed.pose(joint.child, last) @ turns
        last = joint.child
    return found @ posed.pose(link, last)
