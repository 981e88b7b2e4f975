"""Reads a launch file, whatever it is written in, and the launch files that it includes."""

import posixpath
from collections.abc import Callable, Mapping
from pathlib import PurePosixPath

from grader.robot.source import Location, Source
from grader.submission.launch.entities import read_frontend
from grader.submission.launch.follow import Follower
from grader.submission.launch.model import Fault, Launch, StartedNode
from grader.submission.launch.places import HOME, PREFIX, SHARE, WORKING_FOLDER
from grader.submission.launch.substitutions import Context
from grader.submission.python.library import plain_functions
from grader.submission.python.machine import Library, Machine
from grader.submission.python.parse import SyntaxFault, parse
from grader.submission.python.values import Function, Made, Spot, Unknown, Value
from grader.submission.setup_py import place

_ENTRY = "generate_launch_description"
_MOST_INCLUDES = 10

# Gives the bytes of an installed file and its path in the submission, by its path below the prefix; None for one not handed in.
Opener = Callable[[str], "tuple[bytes, str] | None"]


def read_launch(data: bytes, path: str, installed: str, opener: Opener, budget: list[int] | None = None) -> Launch:
    """Follow a launch file. `installed` is where a build puts it, below the prefix; never raises."""
    left = budget if budget is not None else [_MOST_INCLUDES]
    context = Context(posixpath.dirname(f"{PREFIX}/{installed}"))
    return _follow(data, path, installed, opener, context, left)


def _follow(data: bytes, path: str, installed: str, opener: Opener, context: Context, left: list[int]) -> Launch:
    inner: list[Launch] = []

    def include(target: str, arguments: Context) -> bool:
        found = opener(posixpath.normpath(target).removeprefix(PREFIX + "/"))
        if found is None:
            return False
        if left[0] > 0:
            left[0] -= 1
            inner.append(
                _follow(*found, posixpath.normpath(target).removeprefix(PREFIX + "/"), opener, arguments, left)
            )
        return True

    suffix = PurePosixPath(path).suffix.lower()
    if suffix in (".xml", ".yaml", ".yml"):
        own = _frontend(data, path, context, include, is_yaml=suffix != ".xml")
    else:
        own = _python(data, path, installed, context, include)
    return Launch(
        path,
        own.source,
        own.syntax,
        (*own.nodes, *(node for each in inner for node in each.nodes)),
        (*own.references, *(reference for each in inner for reference in each.references)),
        (*own.faults, *(fault for each in inner for fault in (*each.faults, *filter(None, [each.syntax])))),
        (*own.unknown, *(unknown for each in inner for unknown in each.unknown)),
        own.forgotten,
    )


def _frontend(
    data: bytes, path: str, context: Context, include: Callable[[str, Context], bool], *, is_yaml: bool
) -> Launch:
    frontend = read_frontend(data, path, is_yaml=is_yaml)
    if frontend.description is None:
        return Launch(path, frontend.source, frontend.syntax)

    def where(spot: Spot) -> Location:
        return Location(path, spot.line, spot.column)

    follower = Follower(where, include, lambda _, spot: Unknown("this is not followed", spot))
    follower.description(frontend.description, context)
    follower.faults += [Fault(message, where(spot)) for message, spot in frontend.faults]
    return _launch(path, frontend.source, follower, ())


def _python(
    data: bytes, path: str, installed: str, context: Context, include: Callable[[str, Context], bool]
) -> Launch:
    code = parse(data, path)
    if isinstance(code, SyntaxFault):
        return Launch(path, code.source, Fault(f"Python cannot read the file: {code.message}", code.location))
    machine = Machine(code, _library(), special={"__file__": f"{PREFIX}/{installed}"})
    scope = machine.run()
    follower = Follower(lambda spot: place(code.source, spot), include, machine.follow)
    entry = scope.names.get(_ENTRY)
    description: Value = None
    if isinstance(entry, Function):
        description = machine.follow(entry, Spot(entry.node.lineno, entry.node.col_offset + 1))
    if not isinstance(entry, Function | Unknown):
        follower.faults.append(
            Fault(f"the file defines no function {_ENTRY}, which ros2 launch calls", Location(path, 1, 1))
        )
    elif isinstance(entry, Function) and description is None:
        where = follower.place(Spot(entry.node.lineno, entry.node.col_offset + 1))
        follower.faults.append(Fault(f"{_ENTRY} does not return its LaunchDescription", where))
    follower.description(description if description is not None else entry, context)
    if machine.stopped:
        follower.unknown.append(Fault(machine.stopped, Location(path, 1, 1)))
    follower.faults += [Fault(fault.message, follower.place(fault.at)) for fault in machine.faults]
    forgotten = [made for made in machine.made if made.name.endswith(".Node") and id(made) not in follower.seen]
    return _launch(path, code.source, follower, tuple(_forgotten(each, follower) for each in forgotten))


def _forgotten(made: Made, follower: Follower) -> StartedNode:
    package, executable = made.kwargs.get("package"), made.kwargs.get("executable")
    return StartedNode(str(package), str(executable), False, follower.place(made.at))


def _launch(path: str, source: Source, follower: Follower, forgotten: tuple[StartedNode, ...]) -> Launch:
    return Launch(
        path,
        source,
        None,
        tuple(follower.nodes),
        tuple(follower.references),
        tuple(sorted(follower.faults, key=lambda each: (each.location.line, each.location.column))),
        tuple(follower.unknown),
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
