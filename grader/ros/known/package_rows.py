"""What is known of packages that are not submitted: rows of files in `packages`.

The file of one package is read when it is needed.

The fields of a row are the keys of the files.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, Literal

from grader.base.grouping import Strings, StringsByName
from grader.base.records import Named
from grader.ros.known.package_files import (
    IndexedKey,
    facts_in_file,
    packages_with,
    packages_with_files,
)
from grader.ros.known.typed_rows import read_row

_WheelNumber = Literal["radius", "diameter", "track", "pivots", "wheelbase", "half sum", "ring"]
_Names = Strings


class DecidingParameter(Named):
    """A parameter that decides something, with its default."""

    parameter: str
    default: Any
    off: Any = None  # the value with which it switches something off


class _TransformRow(Named):
    """A transform that a program or a controller publishes on /tf.

    It is published while the parameter `on` does not switch it off, and while the parameters in
    `if_equal` are equal.
    """

    parent: DecidingParameter  # the name of the frame
    child: DecidingParameter
    on: DecidingParameter
    if_equal: tuple[DecidingParameter, ...] = ()


class WheelRow(Named):
    """What a parameter with a number tells of the wheels of a robot.

    It is the radius or the diameter of the wheels in `of`; the track between the wheels or the
    pivots of two groups, left and right; the wheelbase between those of two groups, front and
    rear; half the track and half the wheelbase together, of four groups (left, right, front,
    rear); the ring on which wheels stand around the middle of the robot.

    `of` has groups, each of parameters that name joints; a number behind the name means one entry
    of a list. Where one of two parameters is given, the first counts.
    """

    number: _WheelNumber
    of: tuple[_Names, ...]
    unless: _Names = ()  # factors that correct the number


class GainsRow(Named):
    """The gains with which a controller computes the commands of one interface alone.

    There are gains for each joint, which are 0 by default, so that nothing moves.
    """

    joints: str  # a parameter
    interfaces: str  # a parameter
    names: _Names
    of: _Names  # the interfaces
    without: Mapping[str, str] = {}  # the parameter that switches this off for an interface


class _FeedbackRow(Named):
    """The state interface of each joint that a controller reads, as one of two that a switch names.

    It reads none where another switch is on.
    """

    joints: _Names  # parameters
    switch: str  # a parameter, which is on by default
    on: str  # the interface
    off: str
    unless: str  # the other switch, which is off by default


class CommandRow(Named):
    """A topic to which a program publishes commands.

    It has another type if a parameter has a value.
    """

    topic: str
    type: str
    parameter: str
    value: Any
    other_type: str


class ProgramRow(Named):
    """A program of a package: the node that it starts, and what this opens.

    Types of messages are written `geometry_msgs.msg.Twist`, topics as remappings replace them.
    """

    source: str = ""
    like: str = ""  # the program of the package that opens and publishes the same
    name: str | None = None  # of the node where its launch file gives none
    usual_names: _Names = ()  # of the node in launch files, or of its program
    children: _Names = ()  # nodes in its process, with own sections in parameter files
    ends_unless: _Names | None = None  # the options without which it ends by itself
    valued_options: _Names = ()  # that a value follows; the others are switches
    publishes_joint_states: bool = False  # of all joints
    reads_keys: bool = False  # from its terminal, without which it stops
    subscriptions: Mapping[str, str] = {}  # topics with their types
    publishers: Mapping[str, str] = {}
    names: _Names = ()  # further topics and services
    inputs: Mapping[str, str] = {}  # parameters that name topics, before a number, with the types
    command: CommandRow | None = None
    transforms: tuple[_TransformRow, ...] = ()


class ControllerRow(Named):
    """A class of controllers, whose type is `package/class`."""

    source: str = ""
    package: str = ""  # that has it, if this is not the one in its type
    joints: Mapping[str, str] = {}  # parameters with joints: their interface, or =its parameter
    subscriptions: Mapping[str, str] = {}  # topics below its name, with their types
    publishers: Mapping[str, str] = {}
    action: str = ""  # below its name
    publishes_joint_states: bool = False  # of all joints
    gains: GainsRow | None = None
    feedback: _FeedbackRow | None = None
    transforms: tuple[_TransformRow, ...] = ()
    wheels: Mapping[str, WheelRow] = {}  # by its parameters with numbers


class _LaunchFileRow(Named):
    """A launch file in the folder launch of a package."""

    # What it starts of robot_state_publisher, joint_state_publisher, joint_state_publisher_gui and
    # rviz2, with the defaults of its arguments.
    starts: _Names
    arguments: _Names | None = None  # None where not all are known


class PackageRow(Named):
    """What is known of a ROS package that is not submitted; of an unknown one that is nothing."""

    source: str = ""
    is_installed: bool = False  # with ROS 2, whether package.xml names it or not
    programs: _Names | None = None  # of any release; None where not all are known
    is_compared: bool = False  # whether launch files are compared with these programs
    # What no program of it has: other frames than those of shared_names.toml and of the robot; a
    # lifecycle node; a subscription of commands.
    without: tuple[Literal["frames", "lifecycle", "commands"], ...] = ()
    publishes_transforms: bool = False  # that may not be known here
    relays: bool = False  # what programs elsewhere publish and serve, with any type
    compares_time: bool = False  # of messages with its own clock
    holds_nodes: bool = False  # to which its programs give their parameter files
    launch_actions: _Names = ()  # that it adds to launch files in XML and YAML
    launches_no_clock: bool = False  # whether nothing in its launch files publishes /clock
    members: _Names = ()  # of a metapackage: the dependencies in its package.xml
    plugins: _Names = ()  # classes that parameter files name
    reads: _Names = ()  # parameters and arguments with files that are read, not written
    writes: _Names = ()  # files below its share folder, at run time
    program: Mapping[str, ProgramRow] = {}
    controller: Mapping[str, ControllerRow] = {}
    launch: Mapping[str, _LaunchFileRow] = {}

    @property
    def is_named(self) -> bool:
        """Whether it is known as a package, and not only for what a program of it opens."""
        return bool(
            self.is_installed
            or self.programs is not None
            or "frames" in self.without
            or self.members
            or self.controller
            or self.launch
            or any(program.name for program in self.program.values())
        )


_NO_PROGRAM = ProgramRow()
_NO_CONTROLLER = ControllerRow()
_NO_PACKAGE = PackageRow()


def package_row(package: str) -> PackageRow:
    """Return what is known of a package; an empty row for one without a file."""
    # A workspace has any names: only the rows of known packages are remembered.
    return _read_row(package) if package in packages_with_files() else _NO_PACKAGE


@cache
def _read_row(package: str) -> PackageRow:
    return read_row(PackageRow, facts_in_file(package))


def _rows_with(key: IndexedKey) -> Iterator[tuple[str, PackageRow]]:
    """Yield what is known of each package that has a fact, with its name."""
    for package in packages_with(key):
        yield package, package_row(package)


def program_row(package: str, program: str) -> ProgramRow:
    """Return what is known of a program; an empty row for an unknown one."""
    rows = package_row(package).program
    row = rows.get(program, _NO_PROGRAM)
    if not row.like:
        return row
    return rows[row.like]._replace(name=row.name, usual_names=row.usual_names)


def controller_row(kind: str | None) -> ControllerRow:
    """Return what is known of a type of controllers; an empty row for an unknown one."""
    package, _, name = (kind or "").partition("/")
    return package_row(package).controller.get(name, _NO_CONTROLLER)


def is_known_controller(kind: str | None) -> bool:
    """Return whether a type of controllers is known."""
    return controller_row(kind) is not _NO_CONTROLLER


def find_transforms(owner: str) -> tuple[_TransformRow, ...]:
    """Return the transforms that a program or a type of controllers publishes."""
    package, _, name = owner.partition("/")
    return program_row(package, name).transforms or controller_row(owner).transforms


def _programs(key: IndexedKey) -> Iterator[tuple[str, ProgramRow]]:
    """Yield the programs of packages that have a fact, as `package/program`."""
    for package, row in _rows_with(key):
        for name, program in row.program.items():
            yield f"{package}/{name}", program


@cache
def controller_types() -> _Names:
    """Return all known types of controllers."""
    types: list[str] = []
    for package, row in _rows_with("controller"):
        types += (f"{package}/{name}" for name in row.controller)
    return tuple(types)


@cache
def controller_actions() -> frozenset[str]:
    """Return the actions of controllers below their names."""
    actions: set[str] = set()
    for _, row in _rows_with("action"):
        actions.update(controller.action for controller in row.controller.values())
    return frozenset(actions - {""})


@cache
def launch_arguments() -> Mapping[str, _Names]:
    """Return the arguments of installed launch files, by their paths from share/ on."""
    arguments = {}
    for package, row in _rows_with("arguments"):
        for file, launch in row.launch.items():
            if launch.arguments is not None:
                arguments[f"share/{package}/launch/{file}"] = launch.arguments
    return arguments


@cache
def plugin_classes() -> _Names:
    """Return the plugins that parameter files name, as `nav2_behaviors::Spin`."""
    classes: list[str] = []
    for package, row in _rows_with("plugins"):
        classes += (f"{package}::{name}" for name in row.plugins)
    return tuple(classes)


@cache
def names_of_read_files() -> frozenset[str]:
    """Return the parameters and launch arguments that name a file which is read."""
    return frozenset(name for _, row in _rows_with("reads") for name in row.reads)


@cache
def added_launch_actions() -> frozenset[str]:
    """Return the actions that packages add to launch files in XML and YAML."""
    rows = _rows_with("launch_actions")
    return frozenset(name for _, row in rows for name in row.launch_actions)


@cache
def written_files() -> frozenset[str]:
    """Return the files that programs write below share folders at run time."""
    return frozenset(name for _, row in _rows_with("writes") for name in row.writes)


@cache
def usual_names() -> StringsByName:
    """Return the programs by the names that their nodes usually have."""
    return {usual: name for name, row in _programs("usual_names") for usual in row.usual_names}


@cache
def children_by_node() -> Mapping[str, _Names]:
    """Return the nodes that others make in their process, by the names of these."""
    rows = _programs("children")
    return {row.name: row.children for _, row in rows if row.name is not None and row.children}


@cache
def frame_parameters() -> frozenset[str]:
    """Return the parameters that name frames above those that programs and controllers place."""
    names: set[str] = set()
    for _, package in _rows_with("transforms"):
        rows = [row for program in package.program.values() for row in program.transforms]
        rows += [row for kind in package.controller.values() for row in kind.transforms]
        names.update(row.parent.parameter for row in rows)
    return frozenset(names)


@cache
def commands_that_end() -> _Names:
    """Return the commands that start programs which end by themselves."""
    ending = [name for name, row in _programs("ends_unless") if row.ends_unless is not None]
    return tuple(f"ros2 run {name.replace('/', ' ')}" for name in ending)


@cache
def _members() -> frozenset[str]:
    """Return the members of metapackages."""
    return frozenset(member for _, row in _rows_with("members") for member in row.members)


@cache
def known_packages() -> frozenset[str]:
    """Return the names of known packages, with the members of metapackages."""
    named = (package for package in packages_with_files() if package_row(package).is_named)
    return _members().union(named)


def is_known_package(name: str) -> bool:
    """Return whether a package is known, or a member of a metapackage."""
    return package_row(name).is_named or name in _members()


def find_programs(package: str) -> _Names:
    """Return the programs of a package that is installed with ROS 2, if all are known."""
    row = package_row(package)
    return (row.programs or ()) if row.is_installed else ()


def lacks_program(package: str, name: str) -> bool:
    """Return whether a package that is installed with ROS 2 certainly has no such program."""
    row = package_row(package)
    return row.is_installed and row.programs is not None and name not in row.programs
