"""The facts that the geometric checks of a rubric ask about, decided a second time from docs/checks.md.

A function returns whether the fact holds, and the value that was measured, or None.
"""

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import replace
from itertools import combinations
from math import cos, degrees, radians
from typing import Any

import numpy as np

from tests.second_opinion.geometry import inertia, is_same_solid, overlap, reach, span
from tests.second_opinion.urdf import Joint, Link, Matrix, Robot, Shape, rotation, turn

Fact = tuple[bool, Any]
SLACK = 1e-9  # as docs/rubric-reference.md says, tolerances are inclusive: the floats 0.152 and 0.15 + 0.002 differ
_SMALL_TURN = 1e-3  # radians
_RANDOM = np.random.default_rng(11).random((40, 6))


class Missing(Exception):
    """What a fact is about does not exist; later facts about the same are skipped."""

    def __init__(self, *thing: str) -> None:
        super().__init__(*thing)
        self.thing = thing


class Undecided(Exception):
    """A person has to look."""


def near(actual: Any, expected: Any, tolerance: float) -> bool:
    """Return whether every number is within the tolerance."""
    return bool(np.all(np.abs(np.asarray(actual) - np.asarray(expected)) <= tolerance + SLACK))


def angle_between(one: Matrix, other: Any) -> float:
    """Return the angle between two vectors, in degrees."""
    other = np.asarray(other, float)
    return degrees(np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other))


class Unsure(Exception):
    """The fact depends on choices that the documentation leaves open, such as random positions: it is not compared."""


class Posed:
    """A robot with its joints at some positions."""

    def __init__(self, robot: Robot, positions: Mapping[str, float] | None = None) -> None:
        self.robot, self._poses = robot, robot.poses(positions or {})

    def link(self, name: str) -> Link:
        """Return a link."""
        if name not in self.robot.links:
            raise Missing("link", name)
        return self.robot.links[name]

    def pose(self, name: str, relative_to: str) -> Matrix:
        """Return T_relative_link."""
        self.link(name), self.link(relative_to)
        one, other = self._poses[name], self._poses[relative_to]
        if name == relative_to:
            return np.eye(4)
        if one.root != other.root:
            raise Missing("chain", *sorted((one.root, other.root)))
        if one.below != other.below:  # of two joints without a direction, the lower one
            raise Missing("pose", max(one.below, other.below, key=lambda joint: len(self.way_up(self.robot.child(joint)))))
        found: Matrix = np.linalg.inv(other.pose) @ one.pose
        return found

    def visuals(self, link: str) -> list[Shape]:
        """Return the visuals that have a size."""
        found = [shape for shape in self.link(link).visuals if shape.has_size]
        if not found:
            raise Missing("visual", link)
        return found

    def main(self, link: str, shape: str = "any") -> Shape:
        """Return the largest visual, of the named shape if the link has one."""
        every = self.visuals(link)
        return max([one for one in every if one.kind == shape] or every, key=lambda one: one.volume)

    def root(self, name: str) -> str:
        """Return the root of the tree of a link."""
        return self._poses[name].root

    def way_up(self, name: str) -> list[Joint]:
        """Return the joints from a link up to the root."""
        way: list[Joint] = []
        while name in self.robot.parents:
            way.append(self.robot.parents[name])
            name = way[-1].parent
        return way

    def path(self, link: str, base: str) -> list[Joint]:
        """Return the joints from a link up to another above it, or up to a common link and down."""
        self.link(link), self.link(base)
        ways = [self.way_up(link), self.way_up(base)]
        self.pose(link, base)
        shared = {joint.name for joint in ways[0]} & {joint.name for joint in ways[1]}
        return [joint for way in ways for joint in way if joint.name not in shared]

    def mover(self, link: str) -> Joint:
        """Return the lowest joint above a link that is not fixed."""
        self.link(link)
        name = link
        while name in self.robot.parents:
            joint = self.robot.parents[name]
            if joint.type != "fixed":
                return joint
            name = joint.parent
        raise Missing("moving joint", link)


def urdf_loads(posed: Posed) -> Fact:
    return posed.robot.loads, None


def shows_box(posed: Posed, link: str, size: Sequence[float], tolerance: float) -> Fact:
    edges = []
    for shape in _of_kind(posed, link, "box"):
        turned = np.abs(shape.pose[:3, :3])
        order = turned.argmax(axis=1)
        if sorted(order) == [0, 1, 2] and turned[range(3), order].min() >= cos(radians(1.0)):
            edges.append(np.abs(shape.size)[order])
    if not edges:
        return False, None
    best = min(edges, key=lambda found: np.abs(found - size).max())
    return near(best, size, tolerance), best


def shows_cylinder(posed: Posed, link: str, radius: float, length: float, tolerance: float) -> Fact:
    sizes = [np.abs(shape.size) for shape in _of_kind(posed, link, "cylinder")]
    best = min(sizes, key=lambda found: np.abs(found - (radius, length)).max())
    return near(best, (radius, length), tolerance), best


def shows_sphere(posed: Posed, link: str, radius: float, tolerance: float) -> Fact:
    best = min((abs(shape.size[0]) for shape in _of_kind(posed, link, "sphere")), key=lambda found: abs(found - radius))
    return near(best, radius, tolerance), best


def _of_kind(posed: Posed, link: str, kind: str) -> list[Shape]:
    found = [shape for shape in posed.visuals(link) if shape.kind == kind]
    if not found and posed.main(link).kind == "mesh":
        raise Undecided(link)
    if not found:
        raise Missing(kind, link)
    return found


def shows_colour(posed: Posed, link: str, colour: Sequence[float], tolerance: float, shape: str = "any") -> Fact:
    found = posed.main(link, shape).colour
    if found is None:
        return False, None
    found = found[: len(colour)]
    return near(found, colour, tolerance), found


def shows_grey(posed: Posed, link: str, at_least: float, tolerance: float) -> Fact:
    found = posed.main(link).colour
    if found is None:
        return False, None
    red_green_blue = found[:3]
    is_grey = max(red_green_blue) - min(red_green_blue) <= tolerance + SLACK
    return bool(is_grey and min(red_green_blue) >= at_least - SLACK), red_green_blue


def shows_nothing(posed: Posed, link: str) -> Fact:
    shown = [one for one in posed.link(link).visuals if one.has_size and (one.colour is None or one.colour[3] > 0)]
    return not shown, None


def held_by(posed: Posed, link: str, parent: str, joint_type: str) -> Fact:
    way = _below(posed, link, parent)
    types = [joint.type for joint in way or () if joint.type != "fixed"]
    if way and not types and joint_type != "fixed":
        raise Missing("moving joint", link)
    return way is not None and types == ([] if joint_type == "fixed" else [joint_type]), None


def _below(posed: Posed, link: str, parent: str) -> list[Joint] | None:
    """Return the joints from a link up to one above it; None where that is not above it."""
    posed.link(link), posed.link(parent)
    if posed.root(link) != posed.root(parent):
        raise Missing("chain", *sorted((posed.root(link), posed.root(parent))))
    way = posed.way_up(link)
    names = [link, *(joint.parent for joint in way)]
    if parent not in names:
        posed.pose(link, parent)
    return way[: names.index(parent)] if parent in names else None


def joints_named(posed: Posed, parent: str, joints: Mapping[str, str]) -> Fact:
    for name, link in joints.items():
        if link not in posed.robot.links:
            return False, None
        way = posed.way_up(link)
        uppers = [joint.parent for joint in way]
        way = way[: uppers.index(parent) + 1] if parent in uppers else way
        joints_of_link = way or [joint for joint in posed.robot.named if link in (joint.parent, joint.child)]
        if name not in [joint.name for joint in joints_of_link]:
            return False, None
    return True, None


def root_of_tree(posed: Posed, link: str, holds: str) -> Fact:
    posed.link(link), posed.link(holds)
    way = _below(posed, holds, link)
    return way is not None and link not in posed.robot.parents and all(joint.type == "fixed" for joint in way), None


def counts(posed: Posed, moving: int) -> Fact:
    tree = max(posed.robot.trees.values(), key=len)
    joints = [posed.robot.parents[link] for link in tree[1:]]
    number = sum(joint.type != "fixed" and not joint.is_mimic for joint in joints)
    return number == moving, (number,)


def frame_at(
    posed: Posed, link: str, relative_to: str, xyz: Sequence[float], tolerance: float, rpy: Sequence[float] = (0, 0, 0), angle: float = 180
) -> Fact:
    pose = posed.pose(link, relative_to)
    is_turned = angle < 180 and _angle(rotation(*rpy).T @ pose[:3, :3]) > angle + SLACK
    return near(pose[:3, 3], xyz, tolerance) and not is_turned, pose[:3, 3]


def _angle(turned: Matrix) -> float:
    """Return the angle of a rotation, in degrees."""
    sine = np.linalg.norm([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]]) / 2
    return degrees(np.arctan2(sine, (np.trace(turned) - 1) / 2))


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
    is_turned = angle < 90 and main.kind != "sphere" and min(tilt, 180 - tilt) > angle + SLACK
    return near(pose[:3, 3], xyz, tolerance) and not is_loose and not is_turned, None if is_loose else pose[:3, 3]


def _spans(posed: Posed, shapes: Sequence[Shape], link: str, relative_to: str, direction: Any) -> tuple[float, float]:
    if any(shape.kind == "mesh" for shape in shapes):
        raise Undecided(link)
    pose = posed.pose(link, relative_to)
    spans = [span(shape, pose @ shape.pose, np.asarray(direction, float)) for shape in shapes]
    return min(low for low, _ in spans), max(high for _, high in spans)


_UP = (0.0, 0.0, 1.0)


def bottom_at_height(posed: Posed, link: str, relative_to: str, height: float, tolerance: float, shape: str = "any") -> Fact:
    shapes = posed.visuals(link)
    if shape in {one.kind for one in shapes}:
        shapes = [posed.main(link, shape)]
    low = _spans(posed, shapes, link, relative_to, _UP)[0]
    return near(low, height, tolerance), low


def bottoms_at_height(posed: Posed, links: Sequence[str], relative_to: str, height: float, tolerance: float) -> Fact:
    posed.link(relative_to)
    lows, missing = _lows(posed, links, relative_to)
    fine = near(lows, height, tolerance)
    if fine and missing is not None:
        raise missing
    return fine, lows


def _lows(posed: Posed, links: Sequence[str], relative_to: str) -> tuple[list[float], Exception | None]:
    """Return the lowest points that can be measured, and why one of the others cannot: it does not hide them."""
    lows, missing = [], None
    for link in links:
        try:
            lows.append(_spans(posed, posed.visuals(link), link, relative_to, _UP)[0])
        except (Missing, Undecided) as error:
            missing = missing or error
    return lows, missing


def stands_on(posed: Posed, link: str, on: str, tolerance: float, shape: str = "any") -> Fact:
    shapes, lower = posed.visuals(link), posed.main(on, shape)
    bottom = _spans(posed, shapes, link, on, _UP)[0]
    top = _spans(posed, [lower], on, on, _UP)[1]
    fine = near(bottom, top, tolerance)
    directions = np.eye(3)[:2]
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
    depth = max(overlap(one, pose @ one.pose, other, other.pose) for one in shapes for other in others)
    return depth <= tolerance + SLACK, depth


def under_the_base(posed: Posed, link: str, base: str, wheels: Sequence[str], tolerance: float, angle: float) -> Fact:
    pose = posed.pose(base, link)
    lows, missing = _lows(posed, wheels, link)
    value = [*pose[:2, 3], *lows]
    fine = near(value, 0, tolerance) and _angle(pose[:3, :3]) <= angle + SLACK
    if fine and missing is not None:
        raise missing
    return fine, value


def _turning(posed: Posed, link: str, base: str) -> tuple[Joint, Matrix, Matrix]:
    """Return the turning joint next to a link on the path to the base, its axis, and a point on it, in the base's frame."""
    joint = next((joint for joint in posed.path(link, base) if joint.type in ("continuous", "revolute")), None)
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
    ends = [_extreme(shapes, pose, sign * above) for sign in (-1, 1)]
    moves = [(turn(axis, _SMALL_TURN) - np.eye(3)) @ (end - point) for end in ends]
    low, high = (move - above * (move @ above) for move in moves)
    if np.linalg.norm(low) < 1e-9 or np.linalg.norm(high - low) < 0.7 * _SMALL_TURN * ((ends[1] - ends[0]) @ above):
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
                point = np.array([*(local[:2] / across * size[0] if across else (0, 0)), np.sign(local[2]) * size[1] / 2])
            case _:
                point = local * size[0]
        reached = placed[:3, 3] @ direction + reach(shape, placed[:3, :3], direction[None])[0]
        if reached > far + 1e-12:
            best, far = placed[:3, :3] @ point + placed[:3, 3], reached
    return best


def axis_along(
    posed: Posed, link: str, axis: Sequence[float], relative_to: str, direction: Sequence[float], tolerance: float
) -> Fact:
    found = posed.pose(link, relative_to)[:3, :3] @ (np.asarray(axis) / np.linalg.norm(axis))
    return angle_between(found, direction) <= tolerance + SLACK, found


def turns_about_itself(posed: Posed, link: str, base: str, tolerance: float, angle: float, any_type: bool = False) -> Fact:
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
    posed: Posed, link: str, lower: float, upper: float, tolerance: float, effort: float | None = None, velocity: float | None = None
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
    rest = [(actual, wanted) for actual, wanted in zip(found[2:], (effort, velocity), strict=True) if wanted is not None]
    return fine and all(near(actual, wanted, 1e-6) for actual, wanted in rest), found[: 2 + len(rest)]


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
    posed: Posed, links: Sequence[str], match: str, tolerance: float, angle: float, *, reference: Robot
) -> Fact:
    """Compare at many positions of its own; only what holds at nearly none or at most of them is decided."""
    assert match == "order"
    posed = Posed(posed.robot)
    base = next(iter(reference.trees))
    base = base if base in posed.robot.links else max(posed.robot.trees, key=lambda root: len(posed.robot.trees[root]))
    expected = Posed(reference)
    shares = []
    for link in links:
        path = posed.path(link, base)
        chains = [[joint for joint in way[::-1] if joint.type != "fixed"] for way in (path, expected.path(link, expected.root(link)))]
        if any(joint.is_mimic for joint in path):
            raise Unsure
        if len(chains[0]) != len(chains[1]):
            return False, None
        if any(one.type == "prismatic" or one.type in ("planar", "floating") for one in chains[0]):
            return False, None
        limits = np.array([joint.limit[:2] for joint in chains[1] if joint.limit])
        positions = np.vstack([np.zeros(len(limits)), _RANDOM[:, : len(limits)] * (limits[:, 1] - limits[:, 0]) + limits[:, 0]])
        poses = [_chained(one, link, chain, positions) for one, chain in zip((posed, expected), chains, strict=True)]
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


def mass_is(posed: Posed, link: str, mass: float, tolerance: float) -> Fact:
    inertial = posed.link(link).inertial
    if inertial is None:
        raise Missing("inertial", link)
    return near(inertial[0], mass, tolerance), inertial[0]


def inertia_plausible(posed: Posed, link: str, tolerance: float) -> Fact:
    found = posed.link(link)
    if found.inertial is None:
        raise Missing("inertial", link)
    mass, centre, tensor = found.inertial
    moments = np.linalg.eigvalsh(tensor)
    if mass <= 0 or moments[0] <= 0 or moments[2] > (moments[0] + moments[1]) * (1 + SLACK):
        return False, None
    shapes = [shape for shape in found.collisions if shape.volume > 0] or [shape for shape in found.visuals if shape.volume > 0]
    if not shapes:
        raise Missing("visual", link)
    if any(shape.kind == "mesh" for shape in shapes):
        raise Undecided(link)
    shapes = [one for at, one in enumerate(shapes) if not any(_is_equal(one, other) for other in shapes[:at])]
    total = sum(shape.volume for shape in shapes)
    middle = sum((shape.volume / total * shape.pose[:3, 3] for shape in shapes), np.zeros(3))
    expected = np.zeros((3, 3))
    for shape in shapes:
        part, away = mass * shape.volume / total, shape.pose[:3, 3] - middle
        turned = shape.pose[:3, :3]
        expected += turned @ inertia(shape, part) @ turned.T + part * (away @ away * np.eye(3) - np.outer(away, away))
    size = max(
        np.linalg.norm(one.pose[:3, 3] - other.pose[:3, 3]) + one.radius + other.radius for one in shapes for other in shapes
    )
    is_off = np.linalg.norm(centre - middle) > max(0.002, 0.02 * size) + SLACK
    off = 100 * np.abs(np.linalg.eigvalsh(tensor - expected)).max() / np.linalg.eigvalsh(expected)[2]
    fine = bool(off <= tolerance + SLACK and not is_off)
    pairs = combinations(shapes, 2)
    if not fine and any(overlap(one, one.pose, other, other.pose) > 1e-9 for one, other in pairs):
        raise Undecided(link)
    return fine, off


def _is_equal(one: Shape, other: Shape) -> bool:
    return (one.kind, one.size) == (other.kind, other.size) and bool((one.pose == other.pose).all())


def collision_matches_visual(posed: Posed, link: str, tolerance: float) -> Fact:
    visuals, left = posed.visuals(link), [shape for shape in posed.link(link).collisions if shape.has_size]
    if any(shape.kind == "mesh" for shape in (*visuals, *left)):
        raise Undecided(link)
    if len(visuals) != len(left):
        return False, None
    for shape in visuals:
        same = [other for other in left if is_same_solid(shape, other, tolerance)]
        if not same:
            return False, None
        left.remove(min(same, key=lambda other: float(np.abs(other.pose - shape.pose).max())))
    return True, None


FACTS = {
    function.__name__: function
    for function in (
        urdf_loads, shows_box, shows_cylinder, shows_sphere, shows_colour, shows_grey, shows_nothing, held_by, joints_named,
        root_of_tree, counts, frame_at, centre_at, bottom_at_height, bottoms_at_height, stands_on, clear_of, under_the_base,
        rolls_forward, axis_along, turns_about_itself, joint_limits, joint_axis, kinematics_match_reference, mass_is, inertia_plausible, collision_matches_visual,
    )
}  # fmt: skip
