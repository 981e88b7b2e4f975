"""The recorded transforms: which frame was published in which, where, and when."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.base.transforms import Transform, rotation_from_quaternion
from grader.ros.recording.recorded_topics import (
    RecordedTopic,
    find_pose,
    find_value,
    read_stamp,
)

_TRANSLATION = ("transform", "translation")
_ROTATION = ("transform", "rotation")


class RecordedTransform(NamedTuple):
    """T_parent_child at a time in seconds."""

    time: float
    pose: Transform


class RecordedFrames:
    """The transforms of a recording: `{child: {parent: transforms}}`, names without a first slash.

    As tf2 does, it ignores a slash before the names in transforms.
    """

    def __init__(self, topics: Iterable[RecordedTopic]) -> None:
        self.parents: dict[str, dict[str, list[RecordedTransform]]] = {}
        for topic in topics:
            for parent, child, transform in _read_transforms(topic):
                parents = self.parents.setdefault(child, {})
                parents.setdefault(parent, []).append(transform)

    @property
    def names(self) -> frozenset[str]:
        """The names of all frames."""
        parents = {parent for each in self.parents.values() for parent in each}
        return frozenset(parents | self.parents.keys())

    @property
    def roots(self) -> list[str]:
        """The frames without a parent."""
        return sorted(self.names - self.parents.keys())

    def find_prefix(self, links: Sequence[str]) -> str:
        """Return the frame_prefix of the robot with these links: rover/."""
        names = self.names
        if any(link in names for link in links):
            return ""
        prefixes = {
            name.removesuffix(link) for name in names for link in links if name.endswith(f"/{link}")
        }
        return min(prefixes, key=lambda prefix: (len(prefix), prefix), default="")


def _read_transforms(topic: RecordedTopic) -> Iterator[tuple[str, str, RecordedTransform]]:
    """Yield parent, child and transform of all messages of a topic."""
    for time, message in topic.messages:
        transforms = find_value(message, "transforms")
        for stamped in transforms if isinstance(transforms, list) else ():
            numbers = find_pose(stamped, _TRANSLATION, _ROTATION)
            if numbers:
                x, y, z, a, b, c, d = numbers
                pose = Transform(rotation_from_quaternion((a, b, c, d)), (x, y, z))
                at = read_stamp(stamped) or time
                parent = str(find_value(stamped, "header", "frame_id")).lstrip("/")
                child = str(find_value(stamped, "child_frame_id")).lstrip("/")
                yield parent, child, RecordedTransform(at, pose)
