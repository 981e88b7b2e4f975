"""What is known of Gazebo: the file gazebo.toml."""

from collections.abc import Mapping, Sequence
from functools import cache

from grader.base.grouping import Strings, StringsByName
from grader.base.records import Named
from grader.ros.known.package_rows import WheelRow
from grader.ros.known.releases import RELEASES, Release, is_before
from grader.ros.known.typed_rows import read_file


class _SystemTransform(Named):
    """The elements of a system that name the frames of its transform."""

    parent: str
    child: str


class _SystemRow(Named):
    """A system of Gazebo: topics by the elements that name them, with the types of messages."""

    has_odometry: bool = False
    subscriptions: Mapping[str, str] = {}
    publishers: Mapping[str, str] = {}
    transform: _SystemTransform | None = None  # that it publishes on the topic in <tf_topic>
    wheels: Mapping[str, WheelRow] = {}


class _LibraryRow(Named):
    """The library of a plugin of Gazebo Classic."""

    wheels: Mapping[str, WheelRow]


class _SensorRow(Named):
    """A type of sensors: the types of the messages on its topics."""

    topic: str = ""
    below: Mapping[str, str] = {}  # the topic
    beside: Mapping[str, str] = {}
    system: str = ""  # without which it publishes nothing


class _SensorWord(Named):
    """An element of a sensor that Gazebo reads where another one of the same meaning is missing."""

    name: str
    meant: str
    of: Strings = ()  # types of sensors; none: of each
    since: Release = RELEASES[0]  # the first release whose Gazebo reads it
    until: Release = RELEASES[-1]  # the last one

    def is_read(self, kind: str, releases: Sequence[Release]) -> bool:
        """Return whether the Gazebo of each of some releases reads it in a sensor of a type.

        Without any, that of every release does.
        """
        if self.of and kind not in self.of:
            return False
        return not any(
            is_before(release, self.since) or is_before(self.until, release)
            for release in releases or RELEASES
        )


class _ClassicRow(Named):
    """What plugins of Gazebo Classic had in ROS 1, with what they have in ROS 2."""

    plugins: frozenset[str]  # of ROS 2, without what the names of their files have in common
    of_sensors: frozenset[str]  # those of them that sensors have
    elements: StringsByName
    libraries: StringsByName


class Gazebo(Named):
    """The words of Gazebo in robots, models and worlds."""

    frame_elements: Strings
    joint_elements: Strings
    odometry_elements: Strings  # with frames of odometry
    odometry_frames: Strings  # by default
    sensor_types: StringsByName  # older ones, with what they are called now
    sensor_words: tuple[_SensorWord, ...]
    known_sensors: frozenset[str]  # all types
    passive_systems: frozenset[str]
    system: Mapping[str, _SystemRow]
    library: Mapping[str, _LibraryRow]
    sensor: Mapping[str, _SensorRow]
    classic: _ClassicRow

    @property
    def odometry_systems(self) -> list[str]:
        """The systems that publish odometry."""
        return [name for name, row in self.system.items() if row.has_odometry]


NO_SYSTEM = _SystemRow()
NO_SENSOR = _SensorRow()


@cache
def gazebo() -> Gazebo:
    """Return the words of Gazebo."""
    return read_file(Gazebo, "gazebo")
