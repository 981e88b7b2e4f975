"""What the files of a recording hold: channels with their messages as bytes, within limits."""

from array import array
from typing import Literal, NamedTuple

from grader.base.errors import RecordingError
from grader.base.text import size_text
from grader.files import limits
from grader.ros.recording.compression import is_zstd, unpack

_HEAD = 512  # bytes of a message that is too large to be kept: its header has the time and frame
# The types of messages that are counted, and of which only the head is kept.
_LARGE = frozenset(
    {"sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/PointCloud2"}
)
_MAX_TEXT = 4 * 1024 * 1024  # characters of all names and definitions

_NoteKind = Literal["unclosed", "damaged", "missing", "renamed", "no metadata", "limit"]


class Note(NamedTuple):
    """What is unusual about the files of a recording."""

    kind: _NoteKind
    text: str

    @property
    def is_loss(self) -> bool:
        """Whether messages are, or may be, lost."""
        return self.kind not in ("renamed", "no metadata")


class Channel:
    """The messages of one type on one topic, in the order of the files.

    `times` has the recorder's time of each message in nanoseconds, also of those beyond what is
    kept. `messages` has the bytes of the first ones.
    """

    def __init__(self, topic: str, type_name: str, definition: str, qos: str = "") -> None:
        self.topic = topic
        self.type = type_name
        self.definition = definition
        self.qos = qos  # of its publishers, in YAML
        self.times = array("q")
        self.messages: list[bytes] = []
        self.size = 0

    @property
    def is_large(self) -> bool:
        """Whether only the heads of its messages are kept."""
        return self.type in _LARGE

    def count_wanted(self, size: int) -> int:
        """Return how many bytes of a message of some size are kept."""
        if self.is_large or size > limits.MAX_MESSAGE_SIZE:
            return min(size, _HEAD)
        return size


class Collector:
    """The channels that the files of a recording fill, up to the limits."""

    def __init__(self) -> None:
        self.channels: dict[tuple[str, str], Channel] = {}
        self._notes: set[Note] = set()
        self._messages = self._kept = self._unpacked = self._described = 0

    @property
    def notes(self) -> tuple[Note, ...]:
        """What is unusual about the files, in order."""
        return tuple(sorted(self._notes))

    def note(self, kind: _NoteKind, text: str) -> None:
        """Add a note."""
        self._notes.add(Note(kind, text))

    def open_channel(
        self, topic: str, type_name: str, definition: str, qos: str = ""
    ) -> Channel | None:
        """Return the channel of a topic and a type; None beyond the limit of topics."""
        topic = f"/{topic.lstrip('/')}"
        channel = self.channels.get((topic, type_name))
        if not channel:
            if len(self.channels) >= limits.MAX_TOPICS:
                self.note("limit", f"only the first {limits.MAX_TOPICS} topics were read")
                return None
            self._described += len(topic) + len(type_name) + len(definition) + len(qos)
            if self._described > _MAX_TEXT:
                self.note("limit", "its names and definitions are too long")
                return None
            channel = Channel(topic, type_name, definition, qos)
            self.channels[topic, type_name] = channel
        return channel

    def add(self, channel: Channel, time: int, data: bytes) -> None:
        """Add a message with the recorder's time in nanoseconds."""
        self._messages += 1
        if self._messages > limits.MAX_MESSAGES:
            raise RecordingError(f"more than {limits.MAX_MESSAGES:,} messages", is_limit=True)
        if not 0 <= time < 2**63:
            self.note("damaged", "a message has an impossible time")
            return
        if is_zstd(data):
            limit = channel.count_wanted(limits.MAX_MESSAGE_SIZE)
            try:
                data = unpack("zstd", data, limit, is_cut=True)
            except RecordingError as error:
                if error.is_limit:
                    raise
                self.note("damaged", "a message cannot be decompressed")
            self.spend(len(data))
        is_whole = len(channel.messages) == len(channel.times)
        channel.times.append(time)
        size = channel.size + len(data)
        total = self._kept + len(data)
        if is_whole and size <= limits.MAX_TOPIC_SIZE and total <= limits.MAX_KEPT_SIZE:
            channel.messages.append(data)
            channel.size = size
            self._kept = total
        else:
            self.note("limit", f"only the first messages of {channel.topic} were kept")

    def spend(self, size: int) -> None:
        """Count decompressed bytes; raises RecordingError beyond the limit."""
        self._unpacked += size
        if self._unpacked > limits.MAX_RECORDING_UNPACKED:
            limit = size_text(limits.MAX_RECORDING_UNPACKED)
            raise RecordingError(f"more than {limit} after decompression", is_limit=True)
