"""Two robots with paired joints: how far links of one are from those of the other with joints at the same positions."""

from collections.abc import Hashable, Iterable, Iterator, Sequence
from math import asin, degrees, dist, inf, isfinite, pi, sqrt
from typing import NamedTuple
from weakref import WeakKeyDictionary

from grader.errors import NotDecided
from grader.robot.frames import SINGLE
from grader.robot.kinematics import Configuration
from grader.robot.model import Joint, Robot
from grader.robot.transforms import Transform
from grader.text import quoted

_MAX_CHAIN = 500  # joints that lead to a link

_LEAST = 1e-9  # of a tolerance: below it, only rounding differs
# The poses of links of references, by what they are relative to, their names, and the joints with their positions.
_EXPECTED: WeakKeyDictionary[Configuration, dict[Hashable, tuple[Transform, ...]]] = WeakKeyDictionary()
_SEED = 20_260_115
_BETWEEN = 0.3  # of a range: a position that is neither an end nor the middle


class Offset(NamedTuple):
    """How far a link is from its place, in metres and degrees, with the joints at these positions."""

    link: str
    distance: float
    angle: float
    positions: tuple[float, ...]


class RobotPair(NamedTuple):
    """A robot and another one: their paired joints and links, and the links in whose frames poses are compared.

    Offsets are compared by how many times they are larger than the tolerances: metres of a distance, degrees of an
    angle.
    """

    robots: tuple[Configuration, Configuration]
    bases: tuple[str, str]
    links: Sequence[tuple[str, str]]
    joints: Sequence[tuple[Joint, Joint]]
    tolerance: float
    angle: float

    def offset(self, positions: tuple[float, ...]) -> Offset:
        """Return the largest offset at these positions of the joints."""
        pairs = zip(self.joints, positions, strict=True)
        own = {joint.name: position for (joint, _), position in pairs if joint.mimic is None}  # a mimic joint follows
        posed = self.robots[0].at(own)
        found = []
        for (name, _), wanted in zip(self.links, self._reference_poses(positions), strict=True):
            pose = posed.pose(name, relative_to=self.bases[0])
            distance = dist(pose.translation, wanted.translation)
            found.append(Offset(name, distance, _angle(pose, wanted), positions))
        return max(found, key=lambda offset: (self.times(offset), offset.distance))

    def _reference_poses(self, positions: tuple[float, ...]) -> tuple[Transform, ...]:
        """Return the poses of the other robot's links, computed once for all robots that are compared with it."""
        known = _EXPECTED.setdefault(self.robots[1], {})
        names, links = (tuple(joint.name for _, joint in self.joints), tuple(link for _, link in self.links))
        key = (self.bases[1], links, names, positions)
        if key not in known:
            posed = self.robots[1].at(dict(zip(names, positions, strict=True)))
            known[key] = tuple(posed.pose(link, relative_to=self.bases[1]) for link in links)
        return known[key]

    def times(self, offset: Offset) -> float:
        """Return how far an offset exceeds the tolerances, rounded, so that equal ones are equal; infinite for NaN."""
        shares = offset.distance / max(self.tolerance, _LEAST), offset.angle / max(self.angle, _LEAST)
        return max(round(share, 6) if share >= 0 else inf for share in shares)


def _angle(one: Transform, other: Transform) -> float:
    """Return the angle between two orientations in degrees: exact near 0, where the trace of the rotation is not."""
    return degrees(2.0 * asin(min(dist(one.rotation, other.rotation) / (2.0 * sqrt(2.0)), 1.0)))


def movers(robot: Configuration, base: str, links: Iterable[str]) -> dict[str, Joint]:
    """Return the joints that move links relative to a base by their names, along the chain to each link.

    Instead of a mimic joint it is the joint that leads it. Raises MissingElement, and NotDecided where a mimic is not
    known.
    """
    found: dict[str, Joint] = {}
    for link in links:
        chain = robot.between(base, link)
        if len(chain) > _MAX_CHAIN:
            raise NotDecided(f"more than {_MAX_CHAIN} joints lead to {quoted(link)}", "a chain has too many joints")
        for joint in chain:
            leader = _leader(robot.known, joint.known)
            if leader is not None and leader.type != "fixed":
                found.setdefault(leader.name, leader)
    return found


def _leader(robot: Robot, joint: Joint) -> Joint | None:
    """Return the joint that leads a mimic joint, perhaps over others; None where there is none."""
    passed: set[str] = set()
    while True:
        if "mimic" in joint.unresolved:
            joint.unresolved["mimic"].check()
        if joint.mimic is None:
            return joint
        passed.add(joint.name)
        if joint.mimic.joint in passed or not robot.has_joint(joint.mimic.joint):
            return None
        joint = robot.joint(joint.mimic.joint)


def singles(joints: Sequence[Joint]) -> Iterator[tuple[int, tuple[float, ...]]]:
    """Yield positions with one joint at an end of its range, or between, and the others at 0; each with its index."""
    for index, joint in enumerate(joints):
        low, high = _range(joint)
        for position in (low, high, low + _BETWEEN * (high - low)):
            yield index, tuple(position if other == index else 0.0 for other in range(len(joints)))


def random_positions(joints: Sequence[Joint], count: int) -> list[tuple[float, ...]]:
    """Return random positions within the ranges of joints, always the same ones."""
    from random import Random  # late: few rubrics need it, and it takes long to import

    random = Random(_SEED)  # noqa: S311  not for secrets
    ranges = [_range(joint) for joint in joints]
    return [tuple(low + (high - low) * random.random() for low, high in ranges) for _ in range(count)]


def _range(joint: Joint) -> tuple[float, float]:
    """Return the range of a joint in radians or metres; a joint without limits that does not turn freely stays at 0."""
    if joint.type == "continuous":
        return -pi, pi
    limit = joint.limit
    if joint.type not in SINGLE or limit is None or not isfinite(limit.upper - limit.lower):
        return 0.0, 0.0
    return limit.lower, limit.upper
