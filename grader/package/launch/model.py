"""The nodes that a launch file starts and the files that it names, and the state while its actions are visited."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from grader.source import Location, Source
from grader.static_python.parse import Position
from grader.static_python.values import Call, Unknown, Value

_MAX_STEPS = 50_000
STATE_PUBLISHER = "robot_state_publisher"
Purpose = Literal["urdf", "rviz", "include"]


@dataclass(frozen=True, slots=True)
class Contents:
    """The contents of a file, read by open, cat or xacro; by decode, if open is told how to read what is no UTF-8.

    `arguments` are those of xacro; None for an unknown value.
    """

    path: str
    by: str
    arguments: tuple[tuple[str, str | None], ...] = ()


Resolved = str | Contents | Unknown


@dataclass(slots=True)
class Context:
    """The folder of the installed launch file, the launch arguments so far, and the errors of the current action."""

    folder: str
    arguments: dict[str, Value] = field(default_factory=dict)
    errors: list[tuple[str, Position]] = field(default_factory=list)
    when: bool | None = True  # whether the file is launched at all
    steps_left: list[int] = field(default_factory=lambda: [_MAX_STEPS])  # counts down, also for included files

    def add_error(self, message: str, at: Position) -> None:
        """Add an error that stops the launch if it certainly executes the current action."""
        self.errors.append((message, at))


@dataclass(frozen=True, slots=True)
class StartedNode:
    """A program that is started. `when` is True, False where a condition prevents it, None if known at run time only.

    `frame_prefix` is what robot_state_publisher puts before the name of each link; None where it is known at run time.
    """

    package: str
    executable: str
    when: bool | None
    location: Location
    frame_prefix: str | None = ""

    @property
    def name(self) -> str:
        """The package and the program, once where they are called the same."""
        return self.executable if self.package == self.executable else f"{self.package}/{self.executable}"


@dataclass(frozen=True, slots=True)
class NamedFile:
    """A file that the launch file names. `path` begins with a stand-in where a folder depends on the machine."""

    purpose: Purpose
    path: str | None
    location: Location
    reason: str = ""  # why the path is unknown, or what is wrong with it
    sure: bool = True  # False where it is unknown
    by: str = ""  # the program that reads it, if there is one: xacro, cat, open or decode
    arguments: tuple[tuple[str, str | None], ...] = ()  # that xacro gets


@dataclass(frozen=True, slots=True)
class LaunchFault:
    """An error that stops the launch or a node, or something unknown, with its location."""

    message: str
    location: Location


@dataclass(frozen=True, slots=True)
class Launch:
    """The result of a launch file and of those that it includes."""

    source: Source
    syntax: LaunchFault | None = None  # set where the file itself cannot be read
    nodes: tuple[StartedNode, ...] = ()
    references: tuple[NamedFile, ...] = ()
    faults: tuple[LaunchFault, ...] = ()
    unknown: tuple[LaunchFault, ...] = ()  # what cannot be determined
    forgotten: tuple[StartedNode, ...] = ()  # created in the file, but not part of its LaunchDescription
    unread: str = ""  # why the file was not read at all: too large, damaged

    def named(self, *purposes: Purpose) -> tuple[NamedFile, ...]:
        """Return the files that are named for one of these purposes."""
        return tuple(reference for reference in self.references if reference.purpose in purposes)

    def frames_of(self, link: str) -> tuple[str | None, ...]:
        """Return the frames of a link that robot_state_publisher publishes (a rubric may prefix it); None if unknown.

        tf2 ignores a slash at the start.
        """
        publishers = [node for node in self.nodes if node.executable == STATE_PUBLISHER and node.when is not False]
        prefixes = dict.fromkeys(node.frame_prefix for node in publishers) or [""]
        return tuple(it if it is None else (it + link.removeprefix(it)).removeprefix("/") for it in prefixes)


@dataclass(slots=True)
class Findings:
    """The findings so far in one launch file. `sets_parameters`: an action gives parameters to all nodes."""

    locate: Callable[[Position], Location]
    nodes: list[StartedNode] = field(default_factory=list)
    references: list[NamedFile] = field(default_factory=list)
    faults: list[LaunchFault] = field(default_factory=list)
    unknown: list[LaunchFault] = field(default_factory=list)
    sets_parameters: bool = False

    def add_fault(self, message: str, at: Position) -> None:
        """Add an error that stops the launch."""
        self.faults.append(LaunchFault(message, self.locate(at)))

    def add_unknown(self, reason: str, at: Position) -> None:
        """Add something that cannot be determined; the same again only where others are between."""
        fault = LaunchFault(reason, self.locate(at))
        if fault not in self.unknown[-3:]:
            self.unknown.append(fault)

    def add_errors(self, context: Context, start: int, *, is_certain: bool) -> None:
        """Take the errors of an action from the context; they count if the action is certainly executed."""
        for message, at in context.errors[start:] if is_certain else ():
            self.add_fault(message, at)
        del context.errors[start:]

    def refer(self, purpose: Purpose, path: Resolved | None, call: Call, value: Value = None, wrong: str = "") -> None:
        """Add the file that an action names, why it is unknown which, or what is wrong with it."""
        location = self.locate(_position(value, call))
        match path:
            case Unknown(reason=reason):
                self.references.append(NamedFile(purpose, None, location, reason, sure=False))
            case Contents():
                self.references.append(NamedFile(purpose, path.path, location, by=path.by, arguments=path.arguments))
            case _:
                self.references.append(NamedFile(purpose, path, location, wrong))


def _position(value: Value, call: Call) -> Position:
    """Return the position of the call that gives a value; of open(path).read() that of open."""
    if isinstance(value, list | tuple):
        value = next((part for part in value if isinstance(part, Call)), None)
    while isinstance(value, Call) and value.owner is not None:
        value = value.owner
    return value.at if isinstance(value, Call) else call.at
