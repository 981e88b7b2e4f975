"""A recording: what is in its files, and what that says of the robot."""

from collections.abc import Collection, Mapping, Sequence
from functools import cached_property
from hashlib import sha256

from grader.base.grouping import group_values, texts_among
from grader.ros.recording.frames import RecordedFrames
from grader.ros.recording.joint_positions import JointPositions, read_joint_positions
from grader.ros.recording.recorded import Channel, Note
from grader.ros.recording.recorded_robot import (
    FrameComparison,
)
from grader.ros.recording.recorded_topics import JOINT_STATES, RecordedTopic, find_value
from grader.ros.urdf.kinematics import Configuration

_DESCRIPTION = "robot_description"
_ODOMETRY = "nav_msgs/msg/Odometry"
TRANSFORMS = "tf2_msgs/msg/TFMessage"


class Recording:
    """A recording as it was read; its messages are decoded when they are asked for.

    `recording_files.py` makes it. Checks compare what it says with what a rubric asks for, and
    with the URDF.
    """

    def __init__(self, path: str, channels: Sequence[Channel], notes: tuple[Note, ...]) -> None:
        self.path = path
        self.channels = channels
        self.notes = notes
        by_topic = group_values((channel.topic, channel) for channel in channels)
        self.topics = {name: RecordedTopic(name, by_topic[name]) for name in sorted(by_topic)}

    @property
    def count(self) -> int:
        """How many messages there are."""
        return sum(topic.count for topic in self.topics.values())

    @property
    def hash(self) -> str:
        """The hash of its messages, whatever the names and the format of its files."""
        digest = sha256()
        for channel in sorted(self.channels, key=lambda channel: (channel.topic, channel.type)):
            for time, data in sorted(zip(channel.times, channel.messages, strict=False)):
                digest.update(f"{channel.topic} {time} ".encode() + data)
        return digest.hexdigest()

    @property
    def losses(self) -> tuple[Note, ...]:
        """Why messages are, or may be, missing."""
        return tuple(note for note in self.notes if note.is_loss)

    def list_of_type(self, type_name: str) -> list[RecordedTopic]:
        """Return the topics with messages of a type, those with the plainest names first."""
        topics = [topic for topic in self.topics.values() if topic.types.get(type_name)]
        return sorted(topics, key=lambda topic: (topic.name.count("/"), len(topic.name)))

    @property
    def odometry(self) -> list[RecordedTopic]:
        """The topics with odometry."""
        return self.list_of_type(_ODOMETRY)

    @property
    def joint_states(self) -> list[RecordedTopic]:
        """The topics with the positions of joints."""
        return self.list_of_type(JOINT_STATES)

    @cached_property
    def joint_positions(self) -> Mapping[str, JointPositions]:
        """The recorded positions of joints, by their names."""
        return read_joint_positions(self.joint_states)

    @property
    def descriptions(self) -> list[str]:
        """The recorded robot descriptions, the last one of each topic."""
        named = [topic for topic in self.topics.values() if topic.name.endswith(_DESCRIPTION)]
        texts = [
            find_value(topic.messages[-1].message, "data") for topic in named if topic.messages
        ]
        return texts_among(texts)

    @cached_property
    def frames(self) -> RecordedFrames:
        """The recorded transforms."""
        return RecordedFrames(self.list_of_type(TRANSFORMS))

    @property
    def named_frames(self) -> list[tuple[RecordedTopic, str]]:
        """The frames that headers name of data that other programs look up, each once."""
        named = []
        for topic in self.topics.values():
            if topic.is_sensed:
                frames = {
                    find_value(message, "header", "frame_id") for _, message in topic.messages
                }
                named += [(topic, str(frame)) for frame in sorted(filter(None, frames))]
        return named

    def compare_frames(
        self, robot: Configuration, tolerance: float, angle: float, without: Collection[str]
    ) -> FrameComparison:
        """Return its transforms beside those of a robot, but for those of some links.

        The tolerances are in metres and degrees.
        """
        comparison = FrameComparison(robot, self.frames, self.joint_positions, tolerance, angle)
        comparison.compare(without)
        return comparison

    @property
    def seconds(self) -> float:
        """How long it lasts, by the clock of the headers.

        Of topics without headers, the recorder's time is scaled as it passed beside that clock.
        """
        stamped = [topic for topic in self.topics.values() if topic.has_stamps]
        scale = 1.0
        if stamped:
            longest = max(stamped, key=lambda topic: _span(topic.recorder_times))
            span = _span(longest.recorder_times)
            scale = longest.seconds / span if span else 1.0
        spans = [topic.seconds for topic in stamped]
        spans += [_span(topic.recorder_times) * scale for topic in self.topics.values()]
        return max(spans, default=0.0)


def _span(times: Sequence[float]) -> float:
    return times[-1] - times[0] if times else 0.0
