"""How a base moved, by its recorded odometry."""

from collections.abc import Sequence
from itertools import pairwise, starmap
from math import atan2, cos, hypot, isfinite, pi, remainder, sin
from typing import NamedTuple

from grader.base.errors import NotDecided
from grader.base.transforms import add_up
from grader.ros.recording.cdr import Message
from grader.ros.recording.recorded_topics import RecordedTopic, find_numbers

# Metres: a path is summed in steps of this length, as noise of an odometry that stands still would
# add up: it made 114 m of 10 m in a public recording.
_STEP = 0.02


class _PlanarPose(NamedTuple):
    """Where a base is in the plane at a time in seconds: metres, and radians that do not wrap."""

    time: float
    x: float
    y: float
    yaw: float


class Track(NamedTuple):
    """How a base moved: at least one pose, in order."""

    poses: tuple[_PlanarPose, ...]

    @property
    def forward(self) -> float:
        """The metres along the heading: backward ones count negative, and noise cancels."""
        return add_up(starmap(_step_ahead, pairwise(self.poses)))

    @property
    def path(self) -> float:
        """The metres that were driven in any direction."""
        length = 0.0
        last = self.poses[0]
        for pose in self.poses:
            step = hypot(pose.x - last.x, pose.y - last.y)
            if step >= _STEP:
                length = length + step
                last = pose
        end = self.poses[-1]
        return length + hypot(end.x - last.x, end.y - last.y)

    @property
    def end(self) -> tuple[float, float, float]:
        """The last pose in the frame of the first one: metres ahead and to the left, radians."""
        first = self.poses[0]
        last = self.poses[-1]
        x = last.x - first.x
        y = last.y - first.y
        ahead = x * cos(first.yaw) + y * sin(first.yaw)
        return ahead, y * cos(first.yaw) - x * sin(first.yaw), last.yaw - first.yaw

    def between(self, start: float, end: float) -> "Track":
        """Return the part between two times, with a pose at least."""
        poses = tuple(pose for pose in self.poses if start <= pose.time <= end)
        return Track(poses or self.poses[:1])


def _step_ahead(one: _PlanarPose, other: _PlanarPose) -> float:
    heading = (one.yaw + other.yaw) / 2
    return (other.x - one.x) * cos(heading) + (other.y - one.y) * sin(heading)


def read_track(topic: RecordedTopic) -> Track:
    """Return how a base moved by a topic with odometry.

    Raises NotDecided if no pose can be read, or the time goes back.
    """
    if topic.goes_back:
        reason = f"the time of {topic.name} goes back: it has two drives, or two publishers"
        raise NotDecided(reason, "the time goes back")
    poses: list[_PlanarPose] = []
    for time, message in topic.messages:
        place = _read_place(message)
        if place is None:
            continue
        x, y, yaw = place
        if poses:
            yaw = poses[-1].yaw + remainder(yaw - poses[-1].yaw, 2 * pi)
        poses.append(_PlanarPose(time, x, y, yaw))
    if not poses:
        raise NotDecided(f"no pose of {topic.name} can be decoded", "cannot be decoded")
    return Track(tuple(poses))


def _read_place(message: Message) -> tuple[float, float, float] | None:
    place = find_numbers(message, ("pose", "pose", "position"), "xy")
    quaternion = find_numbers(message, ("pose", "pose", "orientation"), "xyzw")
    if place is None or quaternion is None:
        return None
    yaw = _compute_yaw(quaternion)
    return (place[0], place[1], yaw) if isfinite(yaw) else None


def _compute_yaw(quaternion: Sequence[float]) -> float:
    x, y, z, w = quaternion
    return atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
