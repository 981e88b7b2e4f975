"""Checks that compare a robot with the rubric's reference solution.

They say how its links move, and because of which joint.
"""

from collections.abc import Hashable, Iterable, Iterator, Sequence
from math import asin, degrees, dist, inf, isfinite, pi, sqrt
from typing import Annotated, Literal, NamedTuple
from weakref import WeakKeyDictionary

from grader.base.errors import MissingElement, NotDecided, RubricError
from grader.base.names import similar_there
from grader.base.quantities import SLACK, in_degrees, in_millimetres, point
from grader.base.source import place
from grader.base.text import counted, enumerated, quoted
from grader.base.toml_types import Constraint, NonNegative
from grader.base.transforms import Transform
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint, Robot

_Positions = tuple[float, ...]  # of joints
_Joints = dict[str, Joint]  # by name


ABOUT = {
    "kinematics_match_reference": About(
        ("joint/origin",),
        # They are paired by name, or by their order along the chains to the links.
        breaks_under=lambda given: () if given.get("match") == "order" else ("joints renamed",),
    )
}

_MatchBy = Literal["name", "order"]
_Samples = Annotated[
    int,
    Constraint(
        "from 1 to 10000", lambda value: 1 <= value <= 10_000, {"minimum": 1, "maximum": 10_000}
    ),
]
_MAX_JOINTS = 8  # in a message
_MAX_CHAIN = 500  # joints that lead to a link
_LEAST = 1e-9  # of a tolerance: below it, only rounding differs
# The poses of links of references, by what they are relative to, their names, and the joints with
# their positions.
_EXPECTED: WeakKeyDictionary[Configuration, dict[Hashable, tuple[Transform, ...]]] = (
    WeakKeyDictionary()
)
_SEED = 20_260_115
_BETWEEN = 0.3  # of a range: a position that is neither an end nor the middle


def kinematics_match_reference(
    robot: Configuration,
    reference: Configuration,
    *,
    links: list[str],
    samples: _Samples = 100,
    tolerance: NonNegative = 0.002,
    angle: NonNegative = 1.0,
    match: _MatchBy = "name",
    relative_to: str = "",
) -> Outcome:
    """The links move as in the reference solution when the joints move within its limits.

    Poses are compared with all joints at 0, with one joint at an end of its range or between, and
    at random positions, which are always the same. Mimic joints follow. An additional joint that
    moves a link makes the check fail.

    Args:
        links: The links whose motion is compared.
        samples: The number of random positions of all joints.
        tolerance: How far the origin of a link may be off, in metres.
        angle: How far the orientation of a link may be off, in degrees.
        match: How joints are paired: by their names, or in their order along the chains to the
            links.
        relative_to: The link in whose frame poses are compared; by default the root of the
            reference, or that of the robot if it has no link of this name.
    """
    bases = _find_bases(robot, reference, links, relative_to)
    pairs = [(_link_name(robot, link), _name_in_reference(reference, link)) for link in links]
    joints = _pair_joints(robot, reference, bases, pairs, match)
    if isinstance(joints, Outcome):
        return joints
    return _MotionComparison((robot, reference), bases, pairs, joints, tolerance, angle).outcome(
        samples
    )


def _link_name(robot: Configuration, link: str) -> str:
    name = robot.selected_name(link)
    robot.link(name)
    return name


def _name_in_reference(reference: Configuration, link: str) -> str:
    """Return the name of a link of the reference.

    Raises RubricError, because no student can do anything about it.
    """
    try:
        return _link_name(reference, link)
    except (MissingElement, NotDecided) as error:
        raise RubricError((f"the reference solution cannot be compared with: {error}",)) from None


def _find_bases(
    robot: Configuration, reference: Configuration, links: Sequence[str], relative_to: str
) -> tuple[str, str]:
    """Return the links in whose frames the poses of the robot and of the reference are compared."""
    if relative_to:
        return _link_name(robot, relative_to), _name_in_reference(reference, relative_to)
    root = reference.find_root(_name_in_reference(reference, links[0]))
    return root if robot.robot.has_link(root) else _link_name(robot, "@root"), root


def _pair_joints(
    robot: Configuration,
    reference: Configuration,
    bases: tuple[str, str],
    pairs: Sequence[tuple[str, str]],
    match: _MatchBy,
) -> list[tuple[Joint, Joint]] | Outcome:
    """Return the joints of the robot that move links, each with that of the reference.

    If they do not pair, return the failure.
    """
    own_movers = _find_movers(robot, bases[0], [link for link, _ in pairs])
    others = _find_movers(reference, bases[1], [link for _, link in pairs])
    shown = _list_names([link for link, _ in pairs])
    if match == "order":
        if len(own_movers) != len(others):
            message = (
                f"{counted(len(own_movers), 'joint')} on the chains to {shown}; there should be "
                f"{len(others)}"
            )
            return failed(message, detail=f" (joints {_list_names(own_movers) or 'none'})")
        joints = list(zip(own_movers.values(), others.values(), strict=True))
    else:
        _check_names(robot, list(others))
        joints = [(robot.joint(name), joint) for name, joint in others.items()]
        for name, joint in own_movers.items():
            if name not in others:
                message = f"a joint on the chains to {shown} has no counterpart in the reference"
                return failed(message, joint.location, detail=f" (joint {quoted(name)})")
    for joint, expected in joints:
        failure = _wrong_type(joint, expected)
        if failure:
            return failure
    return joints


def _list_names(names: Sequence[str] | _Joints) -> str:
    return enumerated(map(quoted, names), _MAX_JOINTS)


def _check_names(robot: Configuration, names: Sequence[str]) -> None:
    """Raise MissingElement for joints that are not there."""
    missing = [name for name in names if not robot.robot.has_joint(name)]
    if not missing:
        return
    known = tuple(joint.name for joint in robot.robot.joints)
    message = f"there is no joint {enumerated(map(quoted, missing), _MAX_JOINTS, 'and no joint')}"
    guess = similar_there(missing[0], known) or f"; the file has: {_list_names(known) or 'none'}"
    raise MissingElement("joint", missing[0], known, message=message, detail=guess)


def _wrong_type(joint: Joint, other: Joint) -> Outcome | None:
    """Return the failure of a joint that cannot move as its counterpart does.

    An example is a prismatic one for a wheel.
    """
    if (
        joint.type == other.type
        or {joint.type, other.type} <= {"revolute", "continuous"}
        or not other.has_position
    ):
        return None
    message = f"the joint is {joint.type or 'of no type'}; it should be {other.type}"
    return failed(message, place(joint.location, "type"), detail=f" (joint {quoted(joint.name)})")


class _Offset(NamedTuple):
    """How far a link is from its place, in metres and degrees.

    The joints are at these positions.
    """

    link: str
    distance: float
    angle: float
    positions: _Positions

    @property
    def text(self) -> str:
        """The distance and the angle in words."""
        return f"{in_millimetres(self.distance)} and {in_degrees(self.angle)}"


class _MotionComparison(NamedTuple):
    """A robot and the reference, with their paired joints and links.

    It also has the links in whose frames poses are compared.

    Offsets are compared by how many times they are larger than the tolerances: metres of a
    distance, degrees of an angle.
    """

    robots: tuple[Configuration, Configuration]
    bases: tuple[str, str]
    links: Sequence[tuple[str, str]]
    joints: Sequence[tuple[Joint, Joint]]
    tolerance: float
    angle: float

    def outcome(self, samples: int) -> Outcome:
        """Return whether the offsets are within the tolerances.

        They are measured with all joints at 0, one joint moved, or all of them.

        If they are not, it is the largest offset, and when the robots differ.
        """
        joints = [joint for _, joint in self.joints]
        zero = self._offset((0.0,) * len(joints))
        alone = [(index, self._offset(positions)) for index, positions in _single_positions(joints)]
        sampled = map(self._offset, _random_positions(joints, samples) if joints else ())
        offsets = [zero, *(offset for _, offset in alone), *sampled]
        worst = max(offsets, key=self._times)  # of equal ones, that of the simplest position
        if self._is_within(worst):
            counts = f"{counted(len(offsets), 'position')} of {counted(len(joints), 'joint')}"
            return passed(
                f"{self._links_text()} as in the reference at {counts}: at most {worst.text} off"
            )
        wrong = dict.fromkeys(index for index, offset in alone if not self._is_within(offset))
        cause = ""
        at = self.robots[0].link(worst.link).location
        if not self._is_within(zero):
            if zero is not worst:
                cause = f"; it is already {zero.text} off with all joints at 0"
            else:
                cause = ""
        elif wrong:
            differing = [self.joints[index][0] for index in wrong]
            at = differing[0].axis_location or differing[0].location
            names = enumerated([quoted(joint.name) for joint in differing], _MAX_JOINTS, "or")
            cause = f"; it differs as soon as {names} moves"
        message = f"{worst.link!r} does not move as in the reference: it is {worst.text} off"
        outcome = failed(message, at, detail=f" with {self._positions_text(worst)}{cause}")
        if worst.distance <= self.tolerance + SLACK:
            return outcome._replace(
                measured=worst.angle, expected=0.0, tolerance=self.angle, unit="deg"
            )
        return outcome._replace(
            measured=worst.distance, expected=0.0, tolerance=self.tolerance, unit="m"
        )

    def _offset(self, positions: _Positions) -> _Offset:
        """Return the largest offset at these positions of the joints."""
        pairs = zip(self.joints, positions, strict=True)
        own_positions = {
            joint.name: position for (joint, _), position in pairs if not joint.mimic
        }  # a mimic joint follows
        posed = self.robots[0].at(own_positions)
        offsets = []
        for (name, _), wanted in zip(self.links, self._reference_poses(positions), strict=True):
            pose = posed.pose(name, relative_to=self.bases[0])
            distance = dist(pose.translation, wanted.translation)
            offsets.append(_Offset(name, distance, _angle_between(pose, wanted), positions))
        return max(offsets, key=lambda offset: (self._times(offset), offset.distance))

    def _reference_poses(self, positions: _Positions) -> tuple[Transform, ...]:
        """Return the poses of the reference's links.

        They are computed once for all robots that are compared with it.
        """
        known = _EXPECTED.setdefault(self.robots[1], {})
        names = tuple(joint.name for _, joint in self.joints)
        links = tuple(link for _, link in self.links)
        key = (self.bases[1], links, names, positions)
        if key not in known:
            posed = self.robots[1].at(dict(zip(names, positions, strict=True)))
            known[key] = tuple(posed.pose(link, relative_to=self.bases[1]) for link in links)
        return known[key]

    def _times(self, offset: _Offset) -> float:
        """Return how far an offset exceeds the tolerances, rounded, so that equal ones are equal.

        It is infinite for NaN.
        """
        shares = (
            offset.distance / max(self.tolerance, _LEAST),
            offset.angle / max(self.angle, _LEAST),
        )
        return max(round(share, 6) if share >= 0 else inf for share in shares)

    def _is_within(self, offset: _Offset) -> bool:
        return offset.distance <= self.tolerance + SLACK and offset.angle <= self.angle + SLACK

    def _links_text(self) -> str:
        names = [quoted(link) for link, _ in self.links]
        return f"{enumerated(names, _MAX_JOINTS)} {'moves' if len(names) == 1 else 'move'}"

    def _positions_text(self, offset: _Offset) -> str:
        if not any(offset.positions):
            return "all joints at 0"
        moved = []
        for (joint, _), position in zip(self.joints, offset.positions, strict=True):
            if joint.type == "prismatic":
                value = position
                unit = "m"
            else:
                value = degrees(position)
                unit = "degrees"
            if position:
                moved.append(f"{quoted(joint.name)} at {point((value,))} {unit}")
        return enumerated(moved, _MAX_JOINTS)


def _angle_between(one: Transform, other: Transform) -> float:
    """Return the angle between two orientations in degrees.

    It is exact near 0, where the trace of the rotation is not.
    """
    return degrees(2.0 * asin(min(dist(one.rotation, other.rotation) / (2.0 * sqrt(2.0)), 1.0)))


def _find_movers(robot: Configuration, base: str, links: Iterable[str]) -> _Joints:
    """Return the joints that move links relative to a base by their names.

    They are along the chain to each link.

    Instead of a mimic joint it is the joint that leads it. Raises MissingElement, and NotDecided
    where a mimic is not known.
    """
    movers: _Joints = {}
    for link in links:
        chain = robot.between(base, link)
        if len(chain) > _MAX_CHAIN:
            raise NotDecided(
                f"more than {_MAX_CHAIN} joints lead to {quoted(link)}",
                "a chain has too many joints",
            )
        for joint in chain:
            leader = _find_leader(robot.known, joint.known)
            if leader and leader.type != "fixed":
                movers.setdefault(leader.name, leader)
    return movers


def _find_leader(robot: Robot, joint: Joint) -> Joint | None:
    """Return the joint that leads a mimic joint, perhaps over others; None where there is none."""
    passed = set()
    while True:
        if "mimic" in joint.unresolved:
            joint.unresolved["mimic"].check()
        if not joint.mimic:
            return joint
        passed.add(joint.name)
        if joint.mimic.joint in passed or not robot.has_joint(joint.mimic.joint):
            return None
        joint = robot.joint(joint.mimic.joint)


def _single_positions(joints: Sequence[Joint]) -> Iterator[tuple[int, _Positions]]:
    """Yield positions with one joint at an end of its range, or between, and the others at 0.

    Each comes with its index.
    """
    for index, joint in enumerate(joints):
        low, high = _joint_range(joint)
        for position in (low, high, low + _BETWEEN * (high - low)):
            positions = [0.0] * len(joints)
            positions[index] = position
            yield index, tuple(positions)


def _random_positions(joints: Sequence[Joint], count: int) -> list[_Positions]:
    """Return random positions within the ranges of joints, always the same ones."""
    from random import Random  # late: few rubrics need it, and it takes long to import

    random = Random(_SEED)  # noqa: S311  not for secrets
    ranges = [_joint_range(joint) for joint in joints]

    def positions() -> _Positions:
        return tuple(low + (high - low) * random.random() for low, high in ranges)

    return [positions() for _ in range(count)]


def _joint_range(joint: Joint) -> tuple[float, float]:
    """Return the range of a joint in radians or metres.

    A joint without limits that does not turn freely stays at 0.
    """
    if joint.type == "continuous":
        return -pi, pi
    limit = joint.limit
    if not joint.has_position or not limit or not isfinite(limit.upper - limit.lower):
        return 0.0, 0.0
    return limit.lower, limit.upper
