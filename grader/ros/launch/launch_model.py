"""The nodes that a launch file starts and the files that it names.

The state while its actions are visited is here too.
"""

import posixpath
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from operator import attrgetter
from typing import Any, Literal, NamedTuple, Protocol, cast

from grader.base.grouping import Strings
from grader.base.records import Named, Record
from grader.base.source import Location, Source
from grader.ros.installation.places import PREFIX
from grader.ros.known.releases import Release, Releases, is_before
from grader.ros.launch.lifecycle_events import StateEvent
from grader.ros.launch.started_commands import StartedCommand
from grader.ros.python.budget import Budget
from grader.ros.python.parse import Position
from grader.ros.python.values import (
    Call,
    EvaluationFails,
    EvaluationSignal,
    Lacking,
    Unknown,
    Value,
)

MAX_STEPS = 50_000
# the launch configuration that has the namespace of what follows, as in launch_ros
NAMESPACE = "ros_namespace"
STATE_PUBLISHER = "robot_state_publisher"
ORDER = attrgetter("location.line", "location.column", "message")  # of faults
Purpose = Literal["urdf", "rviz", "include", "read", "parameters"]


When = bool | None  # whether an action is executed; None if that is unknown
# Strings by names; None for one that is not known.
_Texts = tuple[tuple[str, str | None], ...]


@dataclass(frozen=True, slots=True)
class Contents:
    """The contents of a file, read by open, cat or xacro.

    `arguments` are those of xacro; None for an unknown value.
    """

    path: str
    by: str
    arguments: _Texts = ()
    stops_at_stderr: bool = False  # whether launch stops if the program writes a warning
    is_deprecated: bool = False  # whether xacro has an option of which it warns


class UnknownText(Unknown):
    """A value that is not known, but certainly is a text."""

    is_text = True


class UnknownTable(UnknownText):
    """A table of parameters that is not known, whose names are not known either."""

    is_text = False


class FileText(UnknownText):
    """The text of a file, as a Python function gives it."""

    def __init__(self, reason: str, at: Position, contents: Contents) -> None:
        super().__init__(reason, at)
        self.contents = contents


Resolved = str | Contents | Unknown


def texts_by_name(table: Mapping[Any, Value]) -> _Texts:
    """Return the values in a table by their names; None for one that is no known text."""
    return tuple(
        (str(name), value if isinstance(value, str) else None) for name, value in table.items()
    )


def not_evaluated(reason: str) -> str:
    """Return a reason with the words that say what it means."""
    return reason if "evaluated" in reason else f"{reason}, which is not evaluated"


class Machine(Protocol):
    """What is installed on the machine of a launch file.

    This is what builds of the packages of the workspace install, and ROS 2.
    """

    def open_installed(self, path: str) -> tuple[bytes, str] | None:
        """Return an installed file by its path below the prefix.

        Returns its bytes, and its path in the workspace.
        """

    def has_package(self, name: str) -> bool:
        """Return whether a package certainly is on the machine."""

    def misspelt_package(self, name: str) -> str | None:
        """Return the package of the workspace that a name stands for.

        The name is that of a package that certainly is not there.
        """

    def files_in(self, folder: str) -> "Sequence[str] | None":
        """Return the names of the installed files in a folder below the prefix.

        Returns None where they are not all known.
        """

    def has_program(self, package: str, name: str) -> When:
        """Return whether a package has a program; None where this is not known."""


class Context(Record, frozen=False):
    """The path of the installed launch file, and what launch knows when it executes an action.

    `arguments` are the launch configurations. With `has_others` there may be more of them, which a
    file that is not read declares.
    """

    path: str
    machine: Machine
    arguments: dict[str, Resolved] = field(default_factory=dict)
    has_others: bool = False
    when: When = True  # whether the file is launched at all
    # What SetRemap and SetParameter give to all nodes, by the configurations that launch_ros keeps
    # them in: lists, which groups share, as there. None is one that is not known.
    to_all: "dict[str, list[Any]]" = field(default_factory=dict)
    # The paths of the launch files that include this one, the first one first.
    included_by: Strings = ()
    # errors in the current action, after which it is evaluated as it is meant
    faults: list[tuple[str, Position]] = field(default_factory=list)
    given: frozenset[str] = frozenset()  # the launch arguments that the file is included with
    reads: list[tuple[Contents, Position]] = field(
        default_factory=list
    )  # that the current action needs
    budget: Budget = field(
        default_factory=partial(Budget, MAX_STEPS)
    )  # of all files that are launched
    releases: Releases = ()  # whose Python reads the files; none: that of Jazzy

    def copy(self) -> "Context":
        """Return a context whose launch configurations change on their own."""
        return replace(self, arguments=dict(self.arguments), to_all=dict(self.to_all))

    def find_text(self, path: str) -> str | None:
        """Return the text of a file.

        Returns None for one that is not installed below the prefix, or is no text.
        """
        if not path.startswith(f"{PREFIX}/"):
            return None
        opened = self.machine.open_installed(posixpath.normpath(path).removeprefix(f"{PREFIX}/"))
        if opened is None:
            return None
        try:
            return opened[0].decode().replace("\r\n", "\n")
        except UnicodeDecodeError:
            return None


class ParameterValue(Named):
    """The value that a parameter is given, and where it is written.

    The value is a scalar or a list of them or Unknown. If its name is in a file, its place is there
    too; of a call in a launch file, which may be elsewhere, also that of the parameters.
    """

    value: Any
    location: Location
    named_at: Location | None = None
    text: str = ""  # of a dict, which rcl reads as the value
    given_at: Location | None = None

    @property
    def name_location(self) -> Location:
        """Where its name is written, as far as that is known."""
        return self.named_at or self.given_at or self.location

    @property
    def remark(self) -> str:
        """What explains that it is no text; empty where nothing does."""
        return f" (launch_ros writes {self.text!r} without quotes)" if self.text else ""


class GivenParameters(Named):
    """Parameters that a node is given at once.

    They are those of a file, by the path that launch has of it, or `values`.
    """

    location: Location
    path: str = ""
    values: Mapping[str, ParameterValue] = {}
    # whether the values are for the node by its full name, not for every node of the process
    is_named: bool = False
    node: str = ""  # or for the node of this name only
    is_plain: bool = True  # whether launch replaces no substitutions in the file
    unknown: str = ""  # why they are not known


class StartedNode(NamedTuple):
    """A program that is started.

    `when` is True, False where a condition prevents it, None if known at run time only.

    `frame_prefix` is what robot_state_publisher puts before the name of each link; None where it is
    known at run time. The same holds for `namespace`, for the `remaps` of names, and for all that
    follows.
    """

    package: str
    executable: str
    when: When
    location: Location
    frame_prefix: str | None = ""
    namespace: str | None = ""
    remaps: tuple[Strings, ...] | None = ()
    has_description: bool = False  # whether it is given the robot itself, not only by a topic
    node_name: str | None = ""  # the one that it is given; empty if it keeps that of its program
    arguments: tuple[str | None, ...] | None = None  # the words after the program
    parameters: tuple[GivenParameters, ...] | None = None  # later ones count; see parameters_of
    # The paths below the prefix of the launch files by which its own is included.
    included_by: Strings = ()
    has_prefix: bool = False  # whether another program starts it, such as a terminal
    is_component: bool = False  # whether a container loads it; its program is the class

    def topic(self, name: str) -> str | None:
        """Return the topic that the node has for a name in its program.

        Returns None where it is known at run time.
        """
        # A rule for one node of the process, node:name:=other, is not resolved.
        if (
            self.namespace is None
            or self.remaps is None
            or any(":" in rule[0] for rule in self.remaps)
        ):
            return None
        full = self.full_name(name)
        rules = (rule[1] for rule in self.remaps if self.full_name(rule[0]) == full)
        return self.full_name(next(rules, full))

    def full_name(self, name: str) -> str:
        """Return a name with the namespace.

        ~ is the name that the node is given, and stays if it is given none.
        """
        if name.startswith("~/") and self.node_name:
            name = f"{self.node_name}{name[1:]}"
        if name.startswith("/"):
            return name
        return f"/{(self.namespace or '').strip('/')}/{name}".replace("//", "/")

    @property
    def program(self) -> tuple[str, str]:
        """The package and the program."""
        return self.package, self.executable

    @property
    def program_path(self) -> str:
        """The package and the program as one text: `demo_nodes_cpp/talker`."""
        return "/".join(self.program)

    @property
    def name(self) -> str:
        """The package and the program, once where they are called the same."""
        return self.executable if self.package == self.executable else self.program_path

    @property
    def program_name(self) -> str:
        """The name of the program that is this node, also if its class is loaded as a component."""
        from grader.ros.known.end_rows import program_of_component  # late: few files need its rows

        if "::" not in self.executable:
            return self.name
        program = program_of_component(self.package, self.executable)
        return self._replace(executable=program).name

    @property
    def is_state_publisher(self) -> bool:
        """Whether it is robot_state_publisher, as a program or as a component."""
        return STATE_PUBLISHER in (self.executable, self.program_name)


class LoadedComponent(Named):
    """A class that a launch file loads into a container of rclcpp_components.

    What is not known of it is None.

    `container` is the full name of a container that the launch file asks for by its name; empty for
    one that it starts for the component.
    """

    package: str | None
    plugin: str | None  # sensors::Lidar
    when: When  # as that of a node
    location: Location
    loaded_at: Location  # by which action
    container: str | None = ""
    # As a program would be started, whose name is the plug-in; None where that is not known.
    node: StartedNode | None = None


class Container(Named):
    """A node that a launch file starts to load components, by its full name, if it is known."""

    name: str | None
    when: When
    location: Location


class NamedFile(Named):
    """A file that the launch file names.

    `path` begins with a stand-in where a folder depends on the machine.
    """

    purpose: Purpose
    path: str | None
    location: Location
    reason: str = ""  # why the path is unknown, or what is wrong with it
    is_certain: bool = True  # False where it is unknown
    by: str = ""  # the program that reads it, if there is one: xacro, cat, open or decode
    arguments: _Texts = ()  # that xacro gets
    stops_at_stderr: bool = False  # whether launch stops if xacro writes a warning
    is_deprecated: bool = False  # whether xacro has an option of which it warns


class PassedArguments(Named):
    """The launch arguments that an include passes to a launch file, by its path below the prefix.

    The value of one is None where it is not known. `when` is None where it is not known whether the
    file is included.
    """

    path: str
    values: _Texts
    location: Location
    when: When = True


class LaunchFault(Named):
    """An error that stops the launch or a node, or something unknown, with its location."""

    message: str
    location: Location
    lacks: Lacking = ""  # what another launch file, or the user, may give
    argument: str = ""  # that a function does not have
    hint: str = ""  # what may be meant, for the end of the message
    follows_error: bool = False  # unknown because an error before certainly stops Python


class _LaterWord(Named):
    """A class, an action, a substitution or a use of them that releases before one do not have."""

    message: str
    since: Release
    location: Location


class StuckNode(Named):
    """A node that the events of a launch file leave in a state, though one would activate it."""

    node: Location
    state: str
    waiting: Location  # the handler, or the event, that never comes


class Launch(Named):
    """The result of a launch file and of those that it includes."""

    source: Source
    syntax: LaunchFault | None = None  # set where the file itself cannot be read
    nodes: tuple[StartedNode, ...] = ()
    references: tuple[NamedFile, ...] = ()
    faults: tuple[LaunchFault, ...] = ()
    unknown: tuple[LaunchFault, ...] = ()  # what may start more
    doubts: tuple[LaunchFault, ...] = ()  # what may stop the launch
    declared: Strings = ()  # the launch arguments that it and the files that it includes declare
    values: tuple[tuple[str, str], ...] = ()  # of these, as far as they are known
    passed: tuple[PassedArguments, ...] = ()
    commands: tuple[StartedCommand, ...] = ()
    components: tuple[LoadedComponent, ...] = ()  # which may start more than is known
    containers: tuple[Container, ...] = ()  # likewise
    forgotten: tuple[
        StartedNode, ...
    ] = ()  # created in the file, but not part of its LaunchDescription
    unread: str = ""  # why the file was not read at all: too large, damaged
    later: tuple[_LaterWord, ...] = ()  # evaluated as the releases do that have it
    stuck: tuple[StuckNode, ...] = ()

    def in_releases(self, releases: Collection[Release]) -> "Launch":
        """Return the launch file as some releases launch it.

        What all of them lack stops it. With none, every release will do.
        """
        faults = list(self.faults)
        for word in self.later:
            if releases and all(is_before(release, word.since) for release in releases):
                faults.append(LaunchFault(word.message, word.location))
        if len(faults) == len(self.faults):
            return self
        return self._replace(faults=tuple(sorted(set(faults), key=ORDER)), later=())

    def named(self, *purposes: Purpose) -> tuple[NamedFile, ...]:
        """Return the files that are named for one of these purposes."""
        return tuple(reference for reference in self.references if reference.purpose in purposes)

    @property
    def rviz_paths(self) -> list[str]:
        """The paths of RViz files that it names, as far as they are known."""
        return [reference.path for reference in self.named("rviz") if reference.path is not None]

    @property
    def command_texts(self) -> Strings:
        """The commands that it executes besides nodes, each as one line."""
        return tuple(command.text for command in self.commands if command.when is not False)

    @property
    def more(self) -> str:
        """Why it may start more than is known; empty where it does not."""
        is_read = not self.syntax and not self.unread
        if self.unknown:
            return self.unknown[0].message
        if is_read:
            return ""
        return "a launch file cannot be read"

    def with_components(self) -> "Launch":
        """Return the launch file with its components among its nodes.

        What an action does all of whose components are known is no longer unknown.
        """
        if not self.components and not self.containers:
            return self
        unknown_at = set()
        nodes = []
        for component in self.components:
            if not component.node:
                unknown_at.add(component.loaded_at)
            else:
                nodes.append(component.node)
        actions = [component.loaded_at for component in self.components]
        actions += [container.location for container in self.containers]
        known_at = {*actions} - unknown_at
        unknown = tuple(row for row in self.unknown if row.location not in known_at)
        doubts = tuple(row for row in self.doubts if row.location not in known_at)
        return self._replace(nodes=(*self.nodes, *nodes), unknown=unknown, doubts=doubts)

    def list_frames(self, link: str) -> tuple[str | None, ...]:
        """Return the frames of a link that robot_state_publisher publishes.

        A rubric may prefix them. Returns None if they are unknown.

        tf2 ignores a slash at the start.
        """
        publishers = [
            node for node in self.nodes if node.is_state_publisher and node.when is not False
        ]
        prefixes = dict.fromkeys(node.frame_prefix for node in publishers) or [""]
        return tuple(
            prefix if prefix is None else (prefix + link.removeprefix(prefix)).removeprefix("/")
            for prefix in prefixes
        )


class Findings(Record, frozen=False):
    """The findings so far in one launch file.

    `sets_parameters` says whether an action gives parameters to all nodes.
    """

    locate: Callable[[Position], Location]
    nodes: list[StartedNode] = field(default_factory=list)
    references: list[NamedFile] = field(default_factory=list)
    faults: list[LaunchFault] = field(default_factory=list)
    unknown: list[LaunchFault] = field(default_factory=list)
    doubts: list[LaunchFault] = field(default_factory=list)
    declared: list[str] = field(default_factory=list)
    values: list[tuple[str, str]] = field(default_factory=list)
    passed: list[PassedArguments] = field(default_factory=list)
    commands: list[StartedCommand] = field(default_factory=list)
    components: list[LoadedComponent] = field(default_factory=list)
    containers: list[Container] = field(default_factory=list)
    later: list[_LaterWord] = field(default_factory=list)
    # the events that change states, and None for each that is not known
    state_events: list[StateEvent | None] = field(default_factory=list)
    sets_parameters: bool = False
    is_silent: bool = False  # while what may never be executed is visited

    def add_fault(
        self,
        message: str,
        at: Position,
        lacks: Lacking = "",
        argument: str = "",
        hint: str = "",
    ) -> None:
        """Add an error that stops the launch."""
        self.faults.append(LaunchFault(message, self.locate(at), lacks, argument, hint))

    def add_unknown(self, reason: str, at: Position, *, follows_error: bool = False) -> None:
        """Add what may start more than is found."""
        fault = LaunchFault(reason, self.locate(at), follows_error=follows_error)
        self.unknown.append(fault)

    def add_doubt(self, reason: str, at: Position) -> None:
        """Add what may stop the launch."""
        self.doubts.append(LaunchFault(not_evaluated(reason), self.locate(at)))

    def add_later(self, what: str, since: str, at: Position, hint: str = "") -> None:
        """Add what is wrong before a release: "there is no action 'bool_arg'"."""
        message = f"{what} before {since.title()}{hint}"
        self.later.append(_LaterWord(message, cast("Release", since), self.locate(at)))

    def add_undecided(self, reason: str, at: Position) -> None:
        """Add what may start more, or stop the launch."""
        self.add_unknown(reason, at)
        self.add_doubt(reason, at)

    def add(self, signal: EvaluationSignal, at: Position, when: When) -> None:
        """Add what ends an action.

        An error is added only if it certainly is executed. `at` is the position of the action.
        """
        if self.is_silent or when is False:
            return
        at = signal.at or at
        if not isinstance(signal, EvaluationFails):
            self.add_doubt(str(signal), at)
        elif when:
            self.add_fault(str(signal), at, signal.lacks, signal.argument)
        else:
            self.add_doubt(f"whether this is executed is not evaluated: {signal}", at)

    def refer(
        self,
        purpose: Purpose,
        path: Resolved | None,
        call: Call,
        value: Value = None,
        wrong: str = "",
    ) -> None:
        """Add the file that an action names, why it is unknown which, or what is wrong with it."""
        location = self.locate(_position(value, call))
        match path:
            case Unknown(reason=reason):
                self.references.append(NamedFile(purpose, None, location, reason, is_certain=False))
            case Contents():
                file = NamedFile(
                    purpose,
                    path.path,
                    location,
                    by=path.by,
                    arguments=path.arguments,
                    stops_at_stderr=path.stops_at_stderr,
                    is_deprecated=path.is_deprecated,
                )
                self.references.append(file)
            case _:
                self.references.append(NamedFile(purpose, path, location, wrong))


def _position(value: Value, call: Call) -> Position:
    """Return the position of the call that gives a value; of open(path).read() that of open."""
    if isinstance(value, list | tuple):
        value = next((part for part in value if isinstance(part, Call)), None)
    if isinstance(value, Call | FileText):
        return value.at
    return call.at
