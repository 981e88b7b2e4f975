"""Reads a launch file, whatever it is written in, and the launch files that it includes."""

import posixpath
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import PurePosixPath

from grader.package.launch.entities import read_frontend
from grader.package.launch.follow import CIRCLE, Follower, Include
from grader.package.launch.model import Fault, Launch, StartedNode
from grader.package.launch.places import HOME, PREFIX, SHARE, WORKING_FOLDER
from grader.package.launch.substitutions import Context
from grader.package.setup_py import place
from grader.source import Location, Source
from grader.static_python.library import plain_functions
from grader.static_python.machine import Library, Machine
from grader.static_python.parse import SyntaxFault, parse
from grader.static_python.values import Function, Made, Named, Spot, Unknown, Value

_ENTRY = "generate_launch_description"
_MODULE = "python_launch_file"  # what Python calls a launch file
_MOST_INCLUDES = 10

# Gives the bytes of an installed file and its path in the submission, by its path below the prefix; None for one not handed in.
Opener = Callable[[str], "tuple[bytes, str] | None"]


def read_launch(data: bytes, path: str, installed: str, opener: Opener) -> Launch:
    """Follow a launch file. `installed` is where a build puts it, below the prefix; never raises."""
    context = Context(posixpath.dirname(f"{PREFIX}/{installed}"))
    return _Reader(opener).read(data, path, installed, context)


class _Reader:
    """Reads a launch file and those that it includes, of which there may be so many and no more."""

    def __init__(self, opener: Opener) -> None:
        self.opener = opener
        self.left = _MOST_INCLUDES
        self.open: list[str] = []  # the launch files that are being read, one included by the other

    def read(self, data: bytes, path: str, installed: str, context: Context) -> Launch:
        """A launch file with what it includes."""
        inner: list[Launch] = []

        def include(target: str, arguments: Context) -> str:
            return self.include(posixpath.normpath(target).removeprefix(PREFIX + "/"), arguments, inner)

        self.open.append(installed)
        suffix = PurePosixPath(path).suffix.lower()
        if suffix in (".xml", ".yaml", ".yml"):
            own = _frontend(data, path, context, include, is_yaml=suffix != ".xml")
        else:
            own = _python(data, path, installed, context, include)
        self.open.pop()
        return replace(
            own,
            nodes=(*own.nodes, *(node for each in inner for node in each.nodes)),
            references=(*own.references, *(reference for each in inner for reference in each.references)),
            faults=(*own.faults, *(fault for each in inner for fault in each.faults)),
            unknown=(*own.unknown, *(unknown for each in inner for unknown in each.unknown)),
        )

    def include(self, target: str, arguments: Context, inner: list[Launch]) -> str:
        """Read an included file; what is returned says why it is not read, if it is not."""
        if target in self.open:
            return CIRCLE
        found = self.opener(target)
        if found is None:
            return f"it includes {target}, which the submission does not install"
        if self.left == 0:
            return "it includes more launch files than are followed"
        self.left -= 1
        made = self.read(*found, target, arguments)
        faults = (*made.faults, *filter(None, [made.syntax]))
        if arguments.when is not True:  # what is wrong in it, is so only if it is included
            made = replace(made, unknown=(*made.unknown, *faults))
        inner.append(replace(made, faults=faults if arguments.when is True else ()))
        return ""


def _frontend(data: bytes, path: str, context: Context, include: Include, *, is_yaml: bool) -> Launch:
    frontend = read_frontend(data, path, is_yaml=is_yaml)
    if frontend.description is None:
        return Launch(path, frontend.source, frontend.syntax)

    def where(spot: Spot) -> Location:
        return Location(path, spot.line, spot.column)

    follower = Follower(where, include, lambda _, spot, __: Unknown("this is not followed", spot))
    follower.description(frontend.description, context)
    follower.faults += [Fault(message, where(spot)) for message, spot in frontend.faults]
    follower.unknown += [Fault(message, where(spot)) for message, spot in frontend.unknown]
    return _launch(path, frontend.source, follower, ())


def _python(data: bytes, path: str, installed: str, context: Context, include: Include) -> Launch:
    code = parse(data, path)
    if isinstance(code, SyntaxFault):
        return Launch(path, code.source, Fault(f"Python cannot read the file: {code.message}", code.location))
    machine = Machine(code, _library(), special={"__file__": f"{PREFIX}/{installed}", "__name__": _MODULE})
    scope = machine.run()
    follower = Follower(lambda spot: place(code.source, spot), include, machine.follow)
    start = Location(path, 1, 1)
    match scope.names.get(_ENTRY):
        case Function() as entry:
            spot = Spot(entry.node.lineno, entry.node.col_offset + 1)
            description = machine.follow(entry, spot)
            wrong = _no_description(description)
            if wrong:
                follower.faults.append(Fault(wrong, follower.place(spot)))
            follower.description(description, context)
        case Unknown() | Named() | Made() as entry:
            follower.description(entry, context)
        case _ if machine.stopped or "*" in scope.names:
            follower.unknown.append(Fault("what it launches is told only by a run", start))
        case _:
            message = f"the file defines no function {_ENTRY}, which ros2 launch calls"
            follower.faults.append(Fault(message, start))
    if machine.stopped:
        follower.unknown.append(Fault(machine.stopped, start))
    follower.faults += [Fault(fault.message, follower.place(fault.at)) for fault in machine.faults]
    forgotten = [made for made in machine.made if made.name.endswith(".Node") and id(made) not in follower.seen]
    return _launch(path, code.source, follower, tuple(_forgotten(each, follower) for each in forgotten))


def _no_description(value: Value) -> str:
    """What is wrong with what generate_launch_description returns, if that can be told."""
    match value:
        case None:
            return f"{_ENTRY} does not return its LaunchDescription"
        case str() | int() | float() | list() | tuple() | dict():
            return f"{_ENTRY} returns no LaunchDescription([...])"
        case Made() if value.name.startswith(("launch.actions.", "launch_ros.actions.")):
            return f"{_ENTRY} returns no LaunchDescription([...])"
        case _:
            return ""


def _forgotten(made: Made, follower: Follower) -> StartedNode:
    given = (made.kwargs.get(name) for name in ("package", "executable"))
    package, executable = (each if isinstance(each, str) else "" for each in given)
    return StartedNode(package, executable, False, follower.place(made.at))


def _launch(path: str, source: Source, follower: Follower, forgotten: tuple[StartedNode, ...]) -> Launch:
    return Launch(
        path,
        source,
        None,
        tuple(follower.nodes),
        tuple(follower.files.references),
        tuple(sorted(set(follower.faults), key=lambda each: (each.location.line, each.location.column, each.message))),
        tuple(dict.fromkeys(follower.unknown)),
        forgotten,
    )


def _library() -> Library:
    """What a launch file asks of ROS 2 and of the machine."""

    def share(_: Machine, args: list[Value], kwargs: Mapping[str, Value], spot: Spot) -> Value:
        name = args[0] if args else kwargs.get("package_name", kwargs.get("package"))
        if isinstance(name, str):
            return f"{SHARE}/{name}"
        return name if isinstance(name, Unknown) else Unknown("which package is meant is told only by a run", spot)

    def share_path(machine: Machine, args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
        found = share(machine, args, kwargs, spot)
        return PurePosixPath(found) if isinstance(found, str) else found

    def home(_: Machine, args: list[Value], __: Mapping[str, Value], spot: Spot) -> Value:
        text = str(args[0]) if args and isinstance(args[0], str | PurePosixPath) else None
        if text is None:
            return Unknown("this path is told only by a run", spot)
        return text.replace("~", HOME, 1) if text.startswith("~") else text

    return {
        **plain_functions(WORKING_FOLDER),
        "ament_index_python.packages.get_package_share_directory": share,
        "ament_index_python.get_package_share_directory": share,
        "ament_index_python.packages.get_package_share_path": share_path,
        "ament_index_python.get_package_share_path": share_path,
        "ament_index_python.packages.get_package_prefix": lambda *_: PREFIX,
        "ament_index_python.get_package_prefix": lambda *_: PREFIX,
        "launch_ros.substitutions.FindPackageShare.find": share,
        "launch_ros.substitutions.find_package.FindPackageShare.find": share,
        "os.path.expanduser": home,
        "pathlib.Path.home": lambda *_: PurePosixPath(HOME),
        "os.path.expandvars": lambda _, __, ___, spot: Unknown("it depends on the environment", spot),
    }
