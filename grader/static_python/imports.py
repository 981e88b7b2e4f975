"""Imports: the names that they bind, those that fail, and what undefined names most likely mean."""

import ast
import sys
from collections.abc import Sequence
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
_INSPECTED = frozenset({"os", "os.path", "glob", "pathlib", "sys", "shutil", "itertools", "re"})
_INSTALLED_WITH_ROS = ("distutils", "pkg_resources", "wheel", "launch", "launch_ros", "xacro", "ament_index_python")
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
}


@lru_cache(maxsize=256)
def import_error(module: str, name: str) -> str | None:
    """Return what is wrong with `import name` or `from module import name`; None where it works or this is unknown."""
    top = (module or name).split(".")[0]
    if module.startswith(".") or not top:
        return None
    homes = [home for home, names in _LAUNCH_NAMES.items() if name in names]
    if module in _LAUNCH_NAMES and homes and module not in homes:
        return f"{module} has no {name!r}: import it from {homes[-1]}"
    if module == "setuptools" and name not in _SETUPTOOLS and name != "*":
        return f"setuptools has no {name!r}{did_you_mean(name, _SETUPTOOLS_PUBLIC[:3])}"
    if module in _INSPECTED and name != "*":
        found = import_module(module)  # one of the few above, never a student's choice
        return None if hasattr(found, name) else f"{module} has no {name!r}{did_you_mean(name, dir(found))}"
    if top in sys.stdlib_module_names or top in _INSTALLED_WITH_ROS or top == "setuptools":
        return None
    guess = closest(top, ("os", "glob", "pathlib", "setuptools", "sys", "shutil"))
    return f"there is no module {top!r}; did you mean {guess!r}?" if guess and not top.startswith(guess) else None


def attribute_error(module: str, name: str) -> str | None:
    """Return what is wrong with `module.name`; None where it works or this is unknown."""
    return import_error(module, name) if module in _INSPECTED or module == "setuptools" else None


def is_always_installed(module: str) -> bool:
    """Return whether a module can be imported wherever ROS 2 packages are built."""
    top = module.split(".", maxsplit=1)[0]
    return top in sys.stdlib_module_names or top in ("setuptools", "distutils")


def imported_names(module: str, alias: ast.alias) -> dict[str, QualifiedName]:
    """Return what `import name` or `from module import name` binds; the name * represents unknown names."""
    if alias.name == "*":
        names: Sequence[str] = ["", *_LAUNCH_NAMES.get(module, ())]
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
