"""A recording beside a robot: recorded transforms are forward kinematics over time.

robot_state_publisher stamps a transform with the time of the joint state, so the two are compared
by these times, never by those of the recorder. In public recordings of a TurtleBot3 and a Husky,
2,338 transforms were at most 2e-6 rad and 1e-16 m from those of the URDF.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from math import degrees, dist
from typing import NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.quantities import SLACK, in_degrees, in_millimetres
from grader.base.text import quoted
from grader.base.transforms import Transform, add_up, turn_between
from grader.ros.recording.frames import RecordedFrames, RecordedTransform
from grader.ros.recording.joint_positions import JointPositions, NearPosition
from grader.ros.recording.motion import Track
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint
from grader.ros.urdf.reader import read_urdf
from grader.ros.urdf.wheel_sizes import WheelSize, measure_wheel

_SAMPLES = 50  # transforms of a joint that are compared
_LEVEL = 0.9  # the part of a wheel's axis along y from which on it rolls along x (REP 103)
_SEEN, _TURNED = 1e-4, 0.1  # metres and degrees that are told
_ROUNDED = 1e-5  # degrees of an angle that the arc cosine makes of rounded numbers
_FIXED = (NearPosition(0.0),)


class _FrameDifference(NamedTuple):
    """How far a link was recorded from where the URDF has it, at its worst time."""

    link: str
    parent: str
    joint: Joint
    time: float
    metres: float
    degrees: float
    excess: float  # of the tolerances: above 1 is outside
    pose: Transform  # T_parent_link, as it was recorded

    def __str__(self) -> str:
        parts = [in_millimetres(self.metres)] if self.metres >= _SEEN else []
        if self.degrees >= _TURNED or not parts:
            parts.append(in_degrees(self.degrees))
        place = f"from where the URDF has it in {quoted(self.parent)}"
        return f"{quoted(self.link)} was recorded {' and '.join(parts)} {place}"


class FrameComparison:
    """The recorded transforms of a robot's joints, beside those of the URDF."""

    def __init__(
        self,
        robot: Configuration,
        frames: RecordedFrames,
        positions: Mapping[str, JointPositions],
        tolerance: float,
        angle: float,
    ) -> None:
        """Take the tolerances in metres and degrees."""
        self._robot = robot
        self._frames = frames
        self._positions = positions
        self._tolerance = tolerance
        self._angle = angle
        self._prefix = frames.find_prefix([link.name for link in robot.robot.links])
        self.unrecorded: list[Joint] = []  # whose transform is not there
        self.without_states: list[Joint] = []  # whose position is not there
        self.untimed: list[Joint] = []  # whose positions are of other times
        self.differences: list[_FrameDifference] = []

    def compare(self, without: Collection[str]) -> None:
        """Compare the links that joints move or hold, but for some."""
        for joint in self._robot.robot.joints:
            if joint.child in without or not (joint.has_position or joint.type == "fixed"):
                continue
            parent, transforms = self._find_transforms(joint)
            leader = self._find_leader(joint)
            if not transforms:
                self.unrecorded.append(joint)
            elif leader is None:
                self.without_states.append(joint)
            else:
                self._compare_joint(joint, parent, transforms, leader)

    def _find_transforms(self, joint: Joint) -> tuple[str, Sequence[RecordedTransform]]:
        """Return the parent and the transforms of a joint's link.

        The parent is another link than the joint's if nothing moves between the two.
        """
        parents = self._frames.parents.get(self._prefix + joint.child, {})
        if self._prefix + joint.parent in parents:
            return joint.parent, parents[self._prefix + joint.parent]
        for name, transforms in parents.items():
            parent = name.removeprefix(self._prefix)
            if self._robot.robot.has_link(parent) and self._is_rigid(parent, joint.child):
                return parent, transforms
        return "", ()

    def _is_rigid(self, parent: str, child: str) -> bool:
        try:
            path = self._robot.between(parent, child)
        except (MissingElement, NotDecided):
            return False
        return all(joint.type == "fixed" for joint in path)

    def _find_leader(self, joint: Joint) -> str | None:
        """Return the joint whose recorded positions move a joint: itself, or which it mimics.

        The result is empty for a fixed joint, None if none was recorded.
        """
        names = [joint.name]
        if joint.mimic:
            names.append(joint.mimic.joint)
        if joint.type == "fixed":
            return ""
        return next((name for name in names if name in self._positions), None)

    def _compare_joint(
        self, joint: Joint, parent: str, transforms: Sequence[RecordedTransform], leader: str
    ) -> None:
        worst = None
        for transform in transforms[:: max(1, len(transforms) // _SAMPLES)]:
            near = self._positions[leader].find_near(transform.time) if leader else _FIXED
            best = None
            for position, change in near:
                robot = self._robot.at({leader: position}) if leader else self._robot
                difference = self._measure(robot, joint, parent, transform, change)
                if not best or difference.excess < best.excess:
                    best = difference
            if best and (not worst or best.excess > worst.excess):
                worst = best
        if not worst:
            self.untimed.append(joint)
        elif not worst.excess <= 1.0:
            self.differences.append(worst)

    def _measure(
        self,
        robot: Configuration,
        joint: Joint,
        parent: str,
        transform: RecordedTransform,
        change: float,
    ) -> _FrameDifference:
        time, pose = transform
        meant = robot.pose(joint.child, relative_to=parent)
        metres = dist(meant.translation, pose.translation)
        angle = turn_between(meant.rotation, pose.rotation)
        excess = max(
            metres / (self._tolerance + change + SLACK),
            angle / (self._angle + degrees(change) + _ROUNDED),
        )
        return _FrameDifference(joint.child, parent, joint, time, metres, angle, excess, pose)


def read_description(texts: Iterable[str], robot: Configuration) -> Configuration | None:
    """Return the robot of several recorded descriptions that shares most links with a robot."""
    names = {link.name for link in robot.robot.links}
    robots = [read_urdf(text).robot for text in texts]
    known = [one for one in robots if one]
    if not known:
        return None
    return Configuration(max(known, key=lambda one: len(names & {link.name for link in one.links})))


class WheelTravel(NamedTuple):
    """How far a base drove forward by its wheels, in metres, and by its odometry meanwhile.

    A wheel may have several round shapes: the two distances are by the smallest and the largest.
    """

    smallest: float
    largest: float
    driven: float
    wheel: WheelSize  # the first one


def _list_wheels(robot: Configuration, links: Sequence[str]) -> list[WheelSize]:
    """Return the wheels on these links, or all that roll along x, those that do not steer first.

    Raises MissingElement or NotDecided for links without a wheel that can be measured.
    """
    if links:
        return [_measure_link(robot, link) for link in links]
    rolling = []
    for joint in robot.robot.joints:
        if joint.type == "continuous":
            wheel = measure_wheel(robot, joint, robot.find_root(joint.child))
            if wheel.radii and abs(wheel.axis[1]) > _LEVEL:
                rolling.append(wheel)
    driven = [wheel for wheel in rolling if not _is_steered(robot, wheel.joint)]
    return driven or rolling


def _measure_link(robot: Configuration, link: str) -> WheelSize:
    wheel = measure_wheel(robot, robot.moving_joint(link), robot.find_root(link))
    if not wheel.radii:
        raise NotDecided(f"the radius of {link!r} is not known", "the radius is not known")
    return wheel


def _is_steered(robot: Configuration, joint: Joint) -> bool:
    return any(above.has_position for above in robot.chain(joint.child)[:-1])


def measure_travel(
    robot: Configuration,
    links: Sequence[str],
    positions: Mapping[str, JointPositions],
    track: Track,
) -> WheelTravel:
    """Return how far the wheels on these links, or all, rolled while a base moved along a track.

    A wheel that is off the middle rolls farther in a turn, which the track tells. Raises
    MissingElement where no position was recorded, NotDecided where the distance is not certain.
    """
    wheels = _list_wheels(robot, links)
    if not wheels:
        raise NotDecided("no wheel of the URDF has a radius that is known", "no wheel is known")
    known = [wheel for wheel in wheels if wheel.joint.name in positions]
    if not known:
        raise missing_position(wheels[0].joint)
    start = max(positions[wheel.joint.name].times[0] for wheel in known)
    end = min(positions[wheel.joint.name].times[-1] for wheel in known)
    part = track.between(start, end)
    if part.poses[-1].time <= part.poses[0].time:
        raise NotDecided("odometry and joint states are of other times", "other times")
    rolled = list(_roll(known, positions, part))
    smallest = add_up(low for low, _ in rolled) / len(rolled)
    largest = add_up(high for _, high in rolled) / len(rolled)
    return WheelTravel(smallest, largest, part.forward, known[0])


def missing_position(joint: Joint) -> MissingElement:
    """Return the error for a joint without a recorded position."""
    name = joint.mimic.joint if joint.mimic else joint.name
    message = f"no position of the joint {name!r} was recorded"
    return MissingElement("recorded joint", name, message=message, location=joint.location)


def _roll(
    wheels: Sequence[WheelSize], positions: Mapping[str, JointPositions], track: Track
) -> Iterator[tuple[float, float]]:
    start = track.poses[0]
    end = track.poses[-1]
    for wheel in wheels:
        known = positions[wheel.joint.name].unwrapped()
        if not known:
            reason = f"the positions of '{wheel.joint.name}' wrap, and are too rare to be followed"
            raise NotDecided(reason, "positions wrap")
        turned = known.find_position(end.time) - known.find_position(start.time)
        aside = wheel.middle[1] * (end.yaw - start.yaw)
        distances = [turned * wheel.axis[1] * radius + aside for radius in wheel.radii]
        yield min(distances, key=abs), max(distances, key=abs)
