"""The URDF of a submission, as one of four states."""

from typing import NamedTuple

from grader.package.package import Package
from grader.problems import Problem
from grader.robot.catalogue import RAW_XACRO
from grader.robot.reader import Reading, read_urdf
from grader.source import Source


class OtherCandidate(NamedTuple):
    """A file that could have been graded, and why another one is."""

    path: str
    reason: str


# These are no dataclasses: making each one takes 0.3 ms of the start of every command.


class Absent:
    """No file of the submission is a URDF."""

    __slots__ = ()


class Unreadable(NamedTuple):
    """The URDF is too large or damaged; `reason` is a sentence that names the file."""

    path: str
    reason: str


class NeedsExpansion(NamedTuple):
    """The URDF is xacro that could not be expanded here, and `reason` says why; `reading` is of the unexpanded text."""

    path: str
    data: bytes
    reading: Reading
    reason: str

    @property
    def source(self) -> Source:
        """The text that the student wrote."""
        return self.reading.source

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The note that the file is xacro: the other problems of the unexpanded text mean nothing."""
        return tuple(problem for problem in self.reading.problems if problem.kind is RAW_XACRO)


class Read(NamedTuple):
    """The URDF was read, even if ROS 2 rejects it; `reading` is of the expanded text if it is xacro."""

    path: str
    data: bytes
    reading: Reading
    is_expanded: bool = False

    @property
    def source(self) -> Source:
        """The text that the student wrote."""
        return Source(self.path, self.data.decode("utf-8", "replace")) if self.is_expanded else self.reading.source

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Every problem of the file."""
        return self.reading.problems


Urdf = Absent | Unreadable | NeedsExpansion | Read


def read_as_ros(data: bytes, path: str, package: Package | None) -> Read | NeedsExpansion:
    """Read a URDF as ROS 2 gets it: expanded if the package's launch file runs xacro on it, or else if its name says xacro."""
    reading = read_urdf(data, path)
    if not any(problem.kind is RAW_XACRO for problem in reading.problems):
        return Read(path, data, reading)
    name = path.rpartition("/")[2]
    readers = package.robot_readers(name) if package is not None else set()
    is_xacro = readers == {"xacro"} if readers else ".xacro" in name and not name.endswith(".urdf")
    if not is_xacro:
        return Read(path, data, reading)
    from grader.xacro.properties import expand  # late: most URDFs are no xacro

    expanded = expand(reading.source.text)
    if expanded is None:
        reason = f"{name} is xacro, which cannot be expanded here: run `ros2 run xacro xacro {name}`"
        return NeedsExpansion(path, data, reading, reason)
    return Read(path, data, read_urdf(expanded.encode("utf-8", "surrogateescape"), path), is_expanded=True)
