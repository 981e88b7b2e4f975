"""What imports of Python's library and ROS 2's modules bind, and when they fail.

The functions of these that are evaluated are here too.

None of the functions reads a file.
"""

import ast
import posixpath
from collections.abc import Collection, Mapping
from enum import Enum
from functools import cache, lru_cache
from itertools import chain
from pathlib import PurePosixPath

from grader.base.names import closest, did_you_mean, near
from grader.base.text import first_part
from grader.ros.known.package_tables import python_table
from grader.ros.known.python_names import MODULES, python_names, python_version
from grader.ros.known.releases import RELEASES, Releases
from grader.ros.python.values import (
    EvaluationFails,
    FunctionTable,
    Items,
    PlainFunction,
    QualifiedName,
    Undetermined,
    Value,
    iterate,
)

MAX_PATH = 4_096  # characters
# stands for the name of the package's folder, which the workspace does not determine
PACKAGE_FOLDER = "<package>"
_OWN = ("dirname", "basename", "normpath", "split", "splitext", "isabs")
_NOT_MISSPELT = ("psutil", "setuptools", "distutils")
_INSTALLED_WITH_ROS = (
    "pkg_resources",
    "wheel",
    "launch",
    "launch_ros",
    "xacro",
    "yaml",
    "ament_index_python",
    # What launch_ros depends on: its package.xml.
    "lifecycle_msgs",
    "composition_interfaces",
    "osrf_pycommon",
    "rclpy",
)
# The names of ROS 2's launch that files use most (ros2/launch and ros2/launch_ros, Jazzy), by their
# modules.
_LAUNCH_NAMES = {
    "launch": ("LaunchDescription",),
    "launch.actions": (
        "DeclareLaunchArgument",
        "ExecuteProcess",
        "GroupAction",
        "IncludeLaunchDescription",
        "LogInfo",
        "OpaqueFunction",
        "RegisterEventHandler",
        "SetEnvironmentVariable",
        "SetLaunchConfiguration",
        "TimerAction",
    ),
    "launch.conditions": ("IfCondition", "UnlessCondition"),
    "launch.event_handlers": ("OnProcessExit", "OnProcessStart"),
    "launch.launch_description_sources": (
        "PythonLaunchDescriptionSource",
        "AnyLaunchDescriptionSource",
    ),
    "launch.substitutions": (
        "Command",
        "EnvironmentVariable",
        "FindExecutable",
        "LaunchConfiguration",
        "PathJoinSubstitution",
        "PythonExpression",
        "TextSubstitution",
        "ThisLaunchFileDir",
    ),
    "launch_ros.actions": ("Node", "PushRosNamespace", "SetParameter"),
    "launch_ros.parameter_descriptions": ("ParameterValue", "ParameterFile"),
    "launch_ros.substitutions": ("FindPackageShare",),
    "ament_index_python.packages": (
        "get_package_share_directory",
        "get_package_share_path",
        "get_package_prefix",
    ),
}
# The usual meaning of a name that is used without its import.
USUAL_NAMES = {
    "os": "os",
    "glob": "?glob",  # the module or its function; its use decides
    "path": "os.path",
    "join": "os.path.join",
    "Path": "pathlib.Path",
    "pathlib": "pathlib",
    "setuptools": "setuptools",
    "setup": "setuptools.setup",
    "find_packages": "setuptools.find_packages",
    "xacro": "xacro",
    **{name: f"{module}.{name}" for module, names in _LAUNCH_NAMES.items() for name in names},
}
# The attributes of modules whose values are known.
CONSTANTS = {
    "os.sep": "/",
    "os.path.sep": "/",
    "os.pathsep": ":",
    "os.linesep": "\n",
    "os.curdir": ".",
    "os.pardir": "..",
    "os.name": "posix",
    "sys.platform": "linux",
}


# Modules of Python whose functions change nothing that a file or launch sees, and cannot fail as
# they are used; and those of their functions that may.
_INERT = (
    *("datetime", "getpass", "locale", "logging", "platform", "random", "socket", "textwrap"),
    *("time", "typing", "types", "uuid", "warnings"),
)
_NOT_INERT = ("logging.config", "random.shuffle", "socket.create_connection")


def is_inert(name: str) -> bool:
    """Return whether a function of Python, by its full name, changes nothing and cannot fail.

    >>> is_inert("datetime.datetime.now"), is_inert("random.shuffle"), is_inert("os.remove")
    (True, False, False)
    """
    return first_part(name) in _INERT and not name.startswith(_NOT_INERT)


def usual_meaning(name: str) -> QualifiedName:
    """Return what a name usually means that is used without its import."""
    full = USUAL_NAMES.get(name)
    if full is None:
        return QualifiedName(f"?.{name}", is_defined=False)
    return QualifiedName(full)


class Uncertain(Enum):
    """What is not known of a statement."""

    IMPORT = "whether it fails"


def import_error(
    module: str,
    name: str,
    exports: Mapping[str, Collection[str]],
    releases: Releases = (),
) -> str | Uncertain | None:
    """Return what is wrong with `import name` or `from module import name`; None where it works."""
    if module.startswith("."):
        return (
            "the file is in no package, so it cannot import "
            f"{module}{'' if module.strip('.') else name}"
        )
    if module in exports:
        if name in exports[module] or name == "*":
            return None
        homes = [home for home, names in exports.items() if name in names]
        return f"{module} has no {name!r}" + (
            f": import it from {homes[-1]}" if homes else did_you_mean(name, exports[module])
        )
    full = module or name
    of_launch = {name for name in exports if name.startswith("launch")}
    meant = find_meant_module(full, of_launch | python_table().modules)
    if meant is not None:
        return f"there is no module {full!r}" + (f"; did you mean {meant!r}?" if meant else "")
    return _import_error(module, name, releases)


def find_meant_module(module: str, known: Collection[str]) -> str | None:
    """Return the module that one stands for that a package of ROS 2 certainly does not have.

    It is empty if any may be meant. The result is None for a module that may be there: all that
    launch and launch_ros have is known, of other packages only what is like one that is there.
    """
    top, _, below = module.partition(".")
    if top in python_table().of_ros1:
        return ""
    if not below or module in known:
        return None
    meant = near(module, [other for other in known if other.startswith(f"{top}.")])
    is_whole = top in {"launch", "launch_ros"}.intersection(known) and not below.startswith("_")
    is_lacking = f"{top}.{below.partition('.')[0]}" not in known
    return "" if meant is None and is_whole and is_lacking else meant


@lru_cache(maxsize=256)
def _import_error(module: str, name: str, releases: Releases) -> str | Uncertain | None:
    if name != "*" and module and python_names(module):
        return attribute_error(module, name, releases)
    full = module or name
    modules = python_names(MODULES, releases)
    top = full.split(".")[0]
    is_there = top in _INSTALLED_WITH_ROS or full in ("setuptools", "distutils")
    is_there |= f"{module}.{name}" in {*modules, "distutils.core.setup"}
    if is_there or full in modules:
        return None
    if top in modules or top in _NOT_MISSPELT:
        return Uncertain.IMPORT
    if top in python_names(MODULES, RELEASES):
        return f"there is no module {top!r}{_in_python(releases)}"
    guess = closest(top, ("os", "glob", "pathlib", "setuptools", "sys", "shutil"))
    if not guess or top.startswith(guess):
        return Uncertain.IMPORT
    return f"there is no module {top!r}; did you mean {guess!r}?"


def _in_python(releases: Releases) -> str:
    return f" in Python 3.{python_version(releases)}"


def attribute_error(module: str, name: str, releases: Releases = ()) -> str | None:
    """Return what is wrong with `module.name`; None where it works or this is unknown."""
    names = python_names(module, releases)
    if not names or name in names or name.startswith("_"):
        return None
    if f"{module}.{name}" in python_names(MODULES, releases):
        return None
    is_other = name in python_names(module, RELEASES)
    guess = _in_python(releases) if is_other else did_you_mean(name, sorted(names))
    return f"{module} has no {name!r}{guess}"


def imported_names(
    module: str, alias: ast.alias, exports: Mapping[str, Collection[str]]
) -> dict[str, Value]:
    """Return what `import name` or `from module import name` binds.

    The name * represents unknown names.
    """
    if alias.name == "*":
        return {
            name or "*": QualifiedName(f"{module}.{name}") for name in exports.get(module, [""])
        }
    if module:
        full = f"{module}.{alias.name}"
        return {alias.asname or alias.name: CONSTANTS.get(full, QualifiedName(full))}
    top = alias.name.split(".")[0]
    if alias.asname:
        return {alias.asname: QualifiedName(alias.name)}
    return {top: QualifiedName(top)}


@cache
def standard_functions(working_folder: str) -> FunctionTable:
    """Return the functions by full name.

    `working_folder` is where Python runs, as an absolute path.
    """

    def absolute(path: Value) -> str:
        return posixpath.normpath(posixpath.join(working_folder, path))

    def relative(path: Value, start: Value = ".") -> str:
        return posixpath.relpath(absolute(path) if path else path, absolute(start))

    path_functions = {
        "abspath": absolute,
        "realpath": absolute,
        "relpath": relative,
        "join": _join,
        **{name: getattr(posixpath, name) for name in _OWN},
    }
    of_paths = {
        **{f"os.path.{name}": function for name, function in path_functions.items()},
        **{f"pathlib.{name}": _path for name in ("Path", "PurePath", "PosixPath", "PurePosixPath")},
        **{
            f"pathlib.Path.{name}": lambda path: PurePosixPath(absolute(path))
            for name in ("resolve", "absolute")
        },
        "os.getcwd": lambda: working_folder,
        "os.fspath": lambda path: str(_require_path(path)),
        "pathlib.Path.cwd": lambda: PurePosixPath(working_folder),
    }
    return {
        **_FUNCTIONS,
        **{name: PlainFunction(name, run, "path") for name, run in of_paths.items()},
    }


def _require_path(value: Value) -> Value:
    if not isinstance(value, str | PurePosixPath):
        raise EvaluationFails(f"a path is a string, and this is of the type {type(value).__name__}")
    return value


def _join(first: Value, *parts: Value) -> str:
    if not all(isinstance(value, str | PurePosixPath) for value in (first, *parts)):
        message = (
            "os.path.join takes strings, and one argument is not a string: is a bracket misplaced?"
        )
        raise EvaluationFails(message)
    return _bounded(posixpath.join(first, *parts))


def _path(*parts: Value) -> PurePosixPath:
    return PurePosixPath(_bounded(str(PurePosixPath(*map(_require_path, parts)))))


def _bounded(path: str) -> str:
    if len(path) > MAX_PATH:
        raise Undetermined("a path grows too long")
    return path


def _no_print(
    *_: Value, sep: str = "", end: str = "", file: Value = None, flush: bool = False
) -> None:
    """Print nothing."""
    del sep, end, file, flush


def _set(*values: Value) -> set[Value]:
    return set(*map(list, map(iterate, values)))


_FUNCTIONS = {
    **{
        f"builtins.{name}": PlainFunction(name, lambda function: function, "holds")
        for name in ("staticmethod", "classmethod", "property")
    },
    "builtins.set": PlainFunction("set", _set, "holds"),
    "builtins.print": PlainFunction("print", _no_print, "holds"),
    "itertools.chain": PlainFunction(
        "chain", lambda *lists: Items(chain(*map(iterate, lists))), "holds"
    ),
    "itertools.chain.from_iterable": PlainFunction(
        "chain.from_iterable",
        lambda lists: Items(chain.from_iterable(map(iterate, iterate(lists)))),
        "holds",
    ),
}
