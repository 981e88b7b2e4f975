"""The topics of a recording, with their messages and times."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from itertools import pairwise
from math import isfinite
from typing import Any, NamedTuple

from grader.base.grouping import only_one
from grader.base.patterns import on_use
from grader.ros.recording.cdr import CannotDecode, Message, MessageDecoder
from grader.ros.recording.recorded import Channel

# Types whose headers other programs need: the time, and a frame that they look up.
_SENSED = frozenset(
    {
        "nav_msgs/msg/Odometry",
        "sensor_msgs/msg/CameraInfo",
        "sensor_msgs/msg/CompressedImage",
        "sensor_msgs/msg/Image",
        "sensor_msgs/msg/Imu",
        "sensor_msgs/msg/LaserScan",
        "sensor_msgs/msg/MagneticField",
        "sensor_msgs/msg/NavSatFix",
        "sensor_msgs/msg/PointCloud2",
        "sensor_msgs/msg/Range",
    }
)
JOINT_STATES = "sensor_msgs/msg/JointState"
_HEADER = "std_msgs/Header"
_STAMP = ("sec", "nanosec")
_NANOSECONDS = 1_000_000_000
_QOS = on_use(r"\b(reliability|durability): *(\w+)")
# Before Jazzy, recordings have the numbers of rmw.
_QOS_NUMBERS = {
    "reliability 1": "reliable",
    "reliability 2": "best_effort",
    "durability 1": "transient_local",
    "durability 2": "volatile",
}
_FEWEST = 3  # messages that have a rate
_SLOWER = 0.05  # by which two rates differ, as a part


class _TimedMessage(NamedTuple):
    """A decoded message and its time in seconds."""

    time: float
    message: Message


def find_value(message: object, *names: str) -> Any:
    """Return a field of a field of a message; None if its definition has none of this name."""
    for name in names:
        message = message.get(name) if isinstance(message, Mapping) else None
    return message


def find_numbers(message: object, place: Sequence[str], names: str) -> tuple[float, ...] | None:
    """Return the fields with names of one letter below a field; None if one is not finite."""
    values = [find_value(message, *place, name) for name in names]
    numbers = tuple(float(value) for value in values if isinstance(value, int | float))
    return numbers if len(numbers) == len(values) and all(map(isfinite, numbers)) else None


def find_pose(message: object, place: Sequence[str], turn: Sequence[str]) -> tuple[float, ...]:
    """Return a place and a quaternion in fields of a message; empty if a number is not finite."""
    numbers = find_numbers(message, place, "xyz")
    more = find_numbers(message, turn, "xyzw")
    return (numbers + more) if numbers is not None and more is not None else ()


def read_stamp(message: object) -> float | None:
    """Return the time in the header of a message in seconds; None without a header.

    That of transforms is in the first of them.
    """
    transforms = find_value(message, "transforms")
    if isinstance(transforms, list) and transforms:
        message = transforms[0]
    seconds, fraction = (find_value(message, "header", "stamp", name) for name in _STAMP)
    if isinstance(seconds, int) and isinstance(fraction, int):
        return seconds + fraction / _NANOSECONDS
    return None


def are_times(stamps: Sequence[float | None]) -> bool:
    """Return whether stamps tell the time: some are not 0, and none goes back."""
    known = [stamp for stamp in stamps if stamp is not None]
    if len(known) < len(stamps) or not any(known):
        return False
    return not _go_back(known)


def _go_back(times: Sequence[float]) -> bool:
    """Return whether one of these times is before the one that precedes it."""
    return any(later < earlier for earlier, later in pairwise(times))


def _compute_rate(times: Sequence[float]) -> float | None:
    span = times[-1] - times[0] if len(times) >= _FEWEST else 0.0
    return (len(times) - 1) / span if span else None


class RecordedTopic:
    """What was recorded on one topic.

    The time of a message is that of its header: the clock of a slow simulation, which the
    recorder's clock is not. It is the recorder's where headers tell no time.
    """

    def __init__(self, name: str, channels: Sequence[Channel]) -> None:
        self.name = name
        self._channels = channels

    @property
    def types(self) -> Mapping[str, int]:
        """How many messages of each type there are, also those that were not kept."""
        return {channel.type: len(channel.times) for channel in self._channels}

    @property
    def count(self) -> int:
        """How many messages there are."""
        return sum(len(channel.times) for channel in self._channels)

    @cached_property
    def recorder_times(self) -> Sequence[float]:
        """The recorder's times in seconds, in order."""
        times = [time for channel in self._channels for time in channel.times]
        return [time / _NANOSECONDS for time in sorted(times)]

    @cached_property
    def recorder_messages(self) -> Sequence[_TimedMessage]:
        """The decoded messages with the recorder's times, in their order."""
        decoded = _decode_all(self._channels, is_head=False)
        return [_TimedMessage(time / _NANOSECONDS, message) for time, message in decoded]

    @cached_property
    def stamps(self) -> Sequence[float | None]:
        """The times in the headers, which are all that is decoded of most messages."""
        return [read_stamp(message) for _, message in _decode_all(self._channels, is_head=True)]

    @cached_property
    def has_stamps(self) -> bool:
        """Whether the times of messages are those of their headers."""
        return are_times(self.stamps)

    @property
    def goes_back(self) -> bool:
        """Whether the time in the headers goes back, as it does if a simulation is reset."""
        return _go_back([stamp for stamp in self.stamps if stamp is not None])

    @cached_property
    def messages(self) -> Sequence[_TimedMessage]:
        """The decoded messages, in order of their times."""
        if not self.has_stamps:
            return self.recorder_messages
        return [
            _TimedMessage(read_stamp(message) or 0.0, message)
            for _, message in self.recorder_messages
        ]

    @cached_property
    def times(self) -> Sequence[float]:
        """The times of all messages in seconds, in order."""
        if self.has_stamps:
            return [stamp or 0.0 for stamp in self.stamps]
        return self.recorder_times

    @property
    def seconds(self) -> float:
        """How long the topic was recorded."""
        times = self.times
        return times[-1] - times[0] if times else 0.0

    @property
    def rate(self) -> float | None:
        """How many messages there are a second; None for too few."""
        return _compute_rate(self.times)

    @property
    def recorder_rate(self) -> float | None:
        """How many there are a second of the recorder's clock, if that is another rate.

        It is that of a simulation which does not run in real time.
        """
        rate = self.rate
        other = _compute_rate(self.recorder_times)
        is_other = rate is not None and other is not None and abs(rate - other) > _SLOWER * rate
        return other if is_other else None

    @property
    def qos(self) -> tuple[str | None, str | None]:
        """The reliability and durability of its publishers; None for what is not known."""
        text = "\n".join(channel.qos for channel in self._channels)
        told: dict[str, set[str]] = {"reliability": set(), "durability": set()}
        for key, word in _QOS.findall(text):
            told[key].add(_QOS_NUMBERS.get(f"{key} {word}", word))
        one, other = (only_one(words) for words in told.values())
        return one, other

    @property
    def is_sensed(self) -> bool:
        """Whether it is odometry or data of a sensor, whose frame other programs look up."""
        return not _SENSED.isdisjoint(self.types)

    @property
    def needs_stamps(self) -> bool:
        """Whether headers have to have a time: in a command, 0 means now."""
        return self.is_sensed or JOINT_STATES in self.types

    @property
    def is_large(self) -> bool:
        """Whether only the headers of its messages are decoded."""
        return any(channel.is_large for channel in self._channels)


def _decode_all(channels: Iterable[Channel], *, is_head: bool) -> list[tuple[int, Message]]:
    """Return the kept messages that can be decoded, by the recorder's times.

    Of large ones, only the headers are, and where only the head is asked for, of those with one.
    """
    decoded = []
    for channel in channels:
        decoder = MessageDecoder(channel.type, channel.definition)
        is_header = channel.is_large or (is_head and decoder.has_header)
        if is_header:
            decoder = MessageDecoder(_HEADER, "")
        for time, data in zip(channel.times, channel.messages, strict=False):
            with suppress(CannotDecode):
                message = decoder.decode(data)
                decoded.append((time, {"header": message} if is_header else message))
    decoded.sort(key=lambda pair: pair[0])
    return decoded
