"""A recording as few numbers for the script of a page, which moves the robot as it was recorded."""

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from math import isfinite
from typing import Any, NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.text import cut, printable
from grader.report.drawing.space import list_rows
from grader.ros.api import Configuration, Joint, RecordedTopic, Recording, find_pose

_PLACE = ("pose", "pose", "position")
_TURN = ("pose", "pose", "orientation")
_UNIT = 10_000_000  # steps of a second, a metre, a radian and 1
_MAX_NUMBERS = 10_000  # some 80 kB
_MAX_NUMBER = 1e6  # metres, radians and seconds: more is a fault
_TOLERANCES = (0.005, 3.0)  # metres and degrees that a frame may be off
_LOGGED = on_use(r"\[(?:DEBUG|INFO|WARN|ERROR|FATAL)\] \[(\d{1,12}\.\d{1,9})\].*")
_MAX_LOGGED, _MAX_TEXT = 200, 200  # messages; characters


class Playback(NamedTuple):
    """A recording that a page plays, and the output of a terminal of the same run."""

    recording: Recording
    log: bytes | None

    def data(self, robot: Configuration) -> dict[str, Any] | None:
        """Return how a robot moved; None if neither its joints nor its base did.

        Each column has a number for each time: the seconds since the first one, the pose of the
        link `base` (a place and a quaternion), and the positions of joints. Its numbers are the
        differences of whole steps. `wrong` are links that were recorded elsewhere, each at its
        worst time, and `log` the messages of the log with their times.
        """
        states = self.recording.joint_positions
        joints = [joint for joint in robot.robot.joints if joint.name in states and joint.axis]
        topics = self.recording.odometry[:1]
        base = self._find_base(topics, robot)
        if not base:
            topics = self.recording.joint_states[:1] if joints else []
        frames = [(time, pose) for time, pose in _read_poses(topics) if pose or not base]
        if len(frames) < 2:
            return None
        shown = frames[:: -(-len(frames) * (8 + len(joints)) // _MAX_NUMBERS)]
        times = [time for time, _ in shown]
        columns = zip(*(pose for _, pose in shown if pose), strict=True)
        return {
            "path": self.recording.path,
            "unit": _UNIT,
            "times": _list_steps(time - times[0] for time in times),
            "base": base,
            "pose": list(map(_list_steps, columns)),
            "joints": self._list_positions(joints, times),
            "wrong": list(self._list_wrong(robot)),
            "log": list(self._list_logged(topics[0])),
        }

    def _list_positions(
        self, joints: Iterable[Joint], times: Sequence[float]
    ) -> dict[str, list[int]]:
        """Return the positions of joints at some times, as steps."""
        positions = {}
        for joint in joints:
            known = self.recording.joint_positions[joint.name]
            if joint.type == "continuous":
                known = known.unwrapped() or known
            positions[joint.name] = _list_steps(map(known.find_position, times))
        return positions

    def _find_base(self, topics: Iterable[RecordedTopic], robot: Configuration) -> str:
        """Return the link whose poses odometry has; empty if they cannot be shown."""
        for topic in topics:
            names = {message.get("child_frame_id", "") for _, message in topic.messages}
            name = last_part(min(names, default=""))
            if len(names) == 1 and robot.robot.has_link(name) and not topic.goes_back:
                return name
        return ""

    def _list_wrong(self, robot: Configuration) -> Iterator[dict[str, Any]]:
        """Yield the links that were recorded elsewhere than the URDF has them."""
        try:
            comparison = self.recording.compare_frames(robot, *_TOLERANCES, ())
        except (MissingElement, NotDecided):
            return
        for one in comparison.differences:
            pose = list_rows(one.pose)
            if all(map(isfinite, pose)):
                yield {"link": one.link, "parent": one.parent, "pose": pose, "text": str(one)}

    def _list_logged(self, topic: RecordedTopic) -> Iterator[tuple[float, str]]:
        """Yield the messages of the log that were printed meanwhile, by the recorder's clock."""
        recorded = topic.recorder_times
        times = topic.times
        text = (self.log or b"").decode(errors="replace")
        for match in islice(_LOGGED.finditer(text), _MAX_LOGGED):
            printed = float(match[1])
            if recorded[0] <= printed <= recorded[-1]:
                index = min(bisect_left(recorded, printed), len(times) - 1)
                shown = cut(printable(match[0]), _MAX_TEXT)
                yield round(times[index] - times[0], 3), shown


def _read_poses(
    topics: Iterable[RecordedTopic],
) -> Iterator[tuple[float, tuple[float, ...]]]:
    """Yield the times of messages with their poses, if they have any."""
    for topic in topics:
        for time, message in topic.messages:
            yield time, find_pose(message, _PLACE, _TURN)


def _list_steps(values: Iterable[float]) -> list[int]:
    """Return numbers as the differences of whole steps, of which the script makes the sums."""
    steps = []
    last = 0
    for value in values:
        now = round(max(-_MAX_NUMBER, min(_MAX_NUMBER, value)) * _UNIT)
        steps.append(now - last)
        last = now
    return steps
