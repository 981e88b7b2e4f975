"""Imports: the names that they bind, those that fail, and what undefined names most likely mean."""

import ast
import sys
from collections.abc import Collection, Mapping
from functools import lru_cache
from importlib import import_module

from grader.names import closest, did_you_mean
from grader.static_python.values import QualifiedName

_SETUPTOOLS_PUBLIC = ("setup", "find_packages", "find_namespace_packages", "Command", "Distribution", "Extension")
_SETUPTOOLS = frozenset(
    {"setup", "find_packages", "find_namespace_packages", "Command", "Distribution", "Extension", "Require", "depends",
     "dist", "command", "errors", "extension", "PackageFinder", "PEP420PackageFinder", "sic",
     "SetuptoolsDeprecationWarning", "build_meta", "glob", "msvc", "monkey", "namespaces", "sandbox", "unicode_utils",
     "wheel", "windows_support", "version", "archive_util", "dep_util", "discovery", "config", "installer", "launch",
     "logging", "package_index", "convert_path", "findall", "distutils", "warnings", "modified"}
)  # fmt: skip
# Modules of the standard library that students' setup files import; their names are read from the modules themselves.
_INSPECTED = frozenset(
    {"os", "os.path", "glob", "pathlib", "sys", "shutil", "itertools", "re", "io", "typing", "datetime", "collections",
     "functools", "json", "math", "platform", "subprocess", "time", "random", "tempfile", "textwrap", "warnings",
     "contextlib", "fnmatch", "string", "operator", "configparser", "codecs", "logging", "errno", "stat"}
)  # fmt: skip
_COMMANDS = ("install", "develop", "build_py", "build_ext", "sdist", "egg_info", "test", "bdist_egg")
_INSTALLED_WITH_ROS = ("pkg_resources", "wheel", "launch", "launch_ros", "xacro", "yaml", "ament_index_python")
# What Python 3.12 has no more, or an older one that runs the grader has not yet.
_REMOVED = ("asynchat", "asyncore", "imp", "smtpd")
_ADDED = {"batched", "override", "TypeAliasType", "isjunction", "splitroot", "sumprod", "monitoring"}
PYTHON_3_12 = ("PythonFinalizationError",)  # built-in names that only a newer Python has
UNCERTAIN = "?"  # in place of a message: whether an import fails is not known
# The modules of ROS 2's launch and the names that are imported from them (ros2/launch and ros2/launch_ros, Jazzy).
_LAUNCH_NAMES: dict[str, tuple[str, ...]] = {
    "launch": ("LaunchDescription", "LaunchContext", "LaunchService"),
    "launch.actions": (
        "DeclareLaunchArgument", "ExecuteProcess", "GroupAction", "IncludeLaunchDescription", "LogInfo",
        "OpaqueFunction", "RegisterEventHandler", "SetEnvironmentVariable", "SetLaunchConfiguration", "TimerAction",
        "EmitEvent",
    ),
    "launch.conditions": (
        "IfCondition", "UnlessCondition", "LaunchConfigurationEquals", "LaunchConfigurationNotEquals",
    ),
    "launch.event_handlers": ("OnProcessExit", "OnProcessStart", "OnProcessIO", "OnShutdown", "OnExecutionComplete"),
    "launch.launch_description_sources": (
        "PythonLaunchDescriptionSource", "AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource",
    ),
    "launch.substitutions": (
        "Command", "EnvironmentVariable", "FindExecutable", "LaunchConfiguration", "PathJoinSubstitution",
        "PythonExpression", "TextSubstitution", "ThisLaunchFileDir",
    ),
    "launch_ros": (),
    "launch_ros.actions": (
        "Node", "LifecycleNode", "ComposableNodeContainer", "PushRosNamespace", "SetParameter", "SetRemap",
    ),
    "launch_ros.descriptions": ("ComposableNode", "ParameterValue", "ParameterFile"),
    "launch_ros.parameter_descriptions": ("ParameterValue", "ParameterFile"),
    "launch_ros.substitutions": ("FindPackageShare", "FindPackagePrefix", "FindPackage", "ExecutableInPackage"),
    "ament_index_python": ("get_package_share_directory", "get_package_share_path", "get_package_prefix"),
    "ament_index_python.packages": ("get_package_share_directory", "get_package_share_path", "get_package_prefix"),
}  # fmt: skip
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
    "os.linesep": "\n",
    "os.curdir": ".",
    "os.pardir": "..",
    "os.name": "posix",
    "sys.platform": "linux",
}


def import_error(module: str, name: str, exports: Mapping[str, Collection[str]]) -> str | None:
    """Return what is wrong with `import name` or `from module import name`: None where it works, UNCERTAIN, or why."""
    if module.startswith("."):
        return f"the file is in no package, so it cannot import {module}{'' if module.strip('.') else name}"
    if module in exports:
        if name in exports[module] or name == "*":
            return None
        homes = [home for home, names in exports.items() if name in names]
        return f"{module} has no {name!r}" + (
            f": import it from {homes[-1]}" if homes else did_you_mean(name, exports[module])
        )
    return _import_error(module, name)


@lru_cache(maxsize=256)
def _import_error(module: str, name: str) -> str | None:
    top, full = (module or name).split(".")[0], module or name
    homes = [home for home, names in _LAUNCH_NAMES.items() if name in names]
    if module in _LAUNCH_NAMES and homes and module not in homes:
        return f"{module} has no {name!r}: import it from {homes[-1]}"
    if top in _REMOVED:
        return f"there is no module {top!r} in Python 3.12"
    if name != "*" and (module in _INSPECTED or module == "setuptools"):
        return _missing_name(module, name)
    commands = [f"{home}.command.{command}" for home in ("setuptools", "distutils") for command in _COMMANDS]
    is_there = (
        top in _INSTALLED_WITH_ROS
        or full in ("setuptools", "distutils", "__future__", *_INSPECTED)
        or (full in commands and name in (full, full.rpartition(".")[2]))
        or (module, name) == ("distutils.core", "setup")
        or (top in sys.stdlib_module_names and full == top and not module)
    )
    guess = closest(top, ("os", "glob", "pathlib", "setuptools", "sys", "shutil"))
    if is_there or not guess or top.startswith(guess) or top in sys.stdlib_module_names or top == "setuptools":
        return None if is_there else UNCERTAIN
    return f"there is no module {top!r}; did you mean {guess!r}?"


def _missing_name(module: str, name: str) -> str | None:
    if module == "setuptools":
        missing, guess = name not in _SETUPTOOLS, did_you_mean(name, _SETUPTOOLS_PUBLIC[:3])
    else:
        found = import_module(module)  # one of the few above, never a student's choice
        missing, guess = not hasattr(found, name), did_you_mean(name, dir(found))
    return UNCERTAIN if name in _ADDED else f"{module} has no {name!r}{guess}" if missing else None


def attribute_error(module: str, name: str) -> str | None:
    """Return what is wrong with `module.name`; None where it works or this is unknown."""
    if module not in _INSPECTED and module != "setuptools":
        return None
    error = _import_error(module, name)
    return error if error != UNCERTAIN else None


def imported_names(module: str, alias: ast.alias, exports: Mapping[str, Collection[str]]) -> dict[str, QualifiedName]:
    """Return what `import name` or `from module import name` binds; the name * represents unknown names."""
    if alias.name == "*":
        names: Collection[str] = exports.get(module, ["", *_LAUNCH_NAMES.get(module, ())])
        if module == "setuptools":
            names = _SETUPTOOLS_PUBLIC
        elif module in _INSPECTED:
            found = import_module(module)
            names = getattr(found, "__all__", [name for name in dir(found) if not name.startswith("_")])
        return {name or "*": QualifiedName(f"{module}.{name or '*'}") for name in names}
    if module:
        return {alias.asname or alias.name: QualifiedName(f"{module}.{alias.name}")}
    top = alias.name.split(".")[0]
    return {alias.asname: QualifiedName(alias.name)} if alias.asname else {top: QualifiedName(top)}
