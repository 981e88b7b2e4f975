"""What a Python file means by names that it has not imported, and which of its imports cannot work."""

import sys
from importlib import import_module
from types import ModuleType

from grader.names import closest, did_you_mean

# What is meant where a name is used without its import.
MODULES = {
    "os": "os",
    "glob": "?glob",  # the module or its function: how it is used tells
    "path": "os.path",
    "join": "os.path.join",
    "Path": "pathlib.Path",
    "pathlib": "pathlib",
    "setup": "setuptools.setup",
    "setuptools": "setuptools",
    "find_packages": "setuptools.find_packages",
    "xacro": "xacro",
    "LaunchDescription": "launch.LaunchDescription",
    "Node": "launch_ros.actions.Node",
    "Command": "launch.substitutions.Command",
    "LaunchConfiguration": "launch.substitutions.LaunchConfiguration",
    "PathJoinSubstitution": "launch.substitutions.PathJoinSubstitution",
    "FindPackageShare": "launch_ros.substitutions.FindPackageShare",
    "ParameterValue": "launch_ros.parameter_descriptions.ParameterValue",
    "DeclareLaunchArgument": "launch.actions.DeclareLaunchArgument",
    "IncludeLaunchDescription": "launch.actions.IncludeLaunchDescription",
    "PythonLaunchDescriptionSource": "launch.launch_description_sources.PythonLaunchDescriptionSource",
    "IfCondition": "launch.conditions.IfCondition",
    "UnlessCondition": "launch.conditions.UnlessCondition",
    "get_package_share_directory": "ament_index_python.packages.get_package_share_directory",
    "get_package_share_path": "ament_index_python.packages.get_package_share_path",
}
_SETUPTOOLS = frozenset(
    {"setup", "find_packages", "find_namespace_packages", "Command", "Distribution", "Extension", "Require", "depends",
     "dist", "command", "errors", "extension", "PackageFinder", "PEP420PackageFinder", "sic", "SetuptoolsDeprecationWarning",
     "build_meta", "glob", "msvc", "monkey", "namespaces", "sandbox", "unicode_utils", "wheel", "windows_support", "version",
     "archive_util", "dep_util", "discovery", "config", "installer", "launch", "logging", "package_index", "convert_path",
     "findall", "distutils", "warnings", "modified"}
)  # fmt: skip
# Modules of the standard library that students' setup files import; what is in them is looked up there.
_LOOKED_UP = frozenset({"os", "os.path", "glob", "pathlib", "sys", "shutil", "itertools", "re"})
_OTHERS = frozenset({"distutils", "pkg_resources", "wheel", "launch", "launch_ros", "xacro", "ament_index_python"})


# Where the names of ROS 2's launch are imported from (ros2/launch and ros2/launch_ros, Jazzy).
_HOMES: dict[str, tuple[str, ...]] = {
    "launch": ("LaunchDescription", "LaunchContext", "LaunchService"),
    "launch.actions": (
        "DeclareLaunchArgument", "ExecuteProcess", "GroupAction", "IncludeLaunchDescription", "LogInfo", "OpaqueFunction",
        "RegisterEventHandler", "SetEnvironmentVariable", "SetLaunchConfiguration", "TimerAction", "EmitEvent",
    ),
    "launch.conditions": ("IfCondition", "UnlessCondition", "LaunchConfigurationEquals", "LaunchConfigurationNotEquals"),
    "launch.event_handlers": ("OnProcessExit", "OnProcessStart", "OnProcessIO", "OnShutdown", "OnExecutionComplete"),
    "launch.launch_description_sources": (
        "PythonLaunchDescriptionSource", "AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource",
    ),
    "launch.substitutions": (
        "Command", "EnvironmentVariable", "FindExecutable", "LaunchConfiguration", "PathJoinSubstitution",
        "PythonExpression", "TextSubstitution", "ThisLaunchFileDir",
    ),
    "launch_ros": (),
    "launch_ros.actions": ("Node", "LifecycleNode", "ComposableNodeContainer", "PushRosNamespace", "SetParameter", "SetRemap"),
    "launch_ros.descriptions": ("ComposableNode", "ParameterValue", "ParameterFile"),
    "launch_ros.parameter_descriptions": ("ParameterValue", "ParameterFile"),
    "launch_ros.substitutions": ("FindPackageShare", "FindPackagePrefix", "FindPackage", "ExecutableInPackage"),
    "ament_index_python": ("get_package_share_directory", "get_package_share_path", "get_package_prefix"),
    "ament_index_python.packages": ("get_package_share_directory", "get_package_share_path", "get_package_prefix"),
}  # fmt: skip


def _misplaced(module: str, name: str) -> str | None:
    """What is wrong with taking a name of launch's from one of its modules, if it is in another one."""
    if module not in _HOMES or name in _HOMES[module]:
        return None
    homes = [home for home, names in _HOMES.items() if name in names]
    return f"{module} has no {name!r}: it is in {homes[-1]}" if homes else None


def some_names(module: str) -> tuple[str, ...]:
    """Some of what `from module import *` brings, of modules of launch's."""
    return _HOMES.get(module, ())


def import_fault(module: str, name: str) -> str | None:
    """What is wrong with `import name`, or with `from module import name`, if that can be told; else None."""
    top = (module or name).split(".")[0]
    if module.startswith(".") or not top:
        return None
    misplaced = _misplaced(module, name)
    if misplaced is not None:
        return misplaced
    if top == "setuptools":
        if module == "setuptools" and name not in _SETUPTOOLS and name != "*":
            return (
                f"setuptools has no {name!r}{did_you_mean(name, ('setup', 'find_packages', 'find_namespace_packages'))}"
            )
        return None
    if module in _LOOKED_UP and name != "*":
        found = _looked_up(module)
        if not hasattr(found, name):
            return f"{module} has no {name!r}{did_you_mean(name, dir(found))}"
        return None
    if top in sys.stdlib_module_names or top in _OTHERS:
        return None
    guess = closest(top, ("os", "glob", "pathlib", "setuptools", "sys", "shutil"))
    return f"there is no module {top!r}; did you mean {guess!r}?" if guess and not top.startswith(guess) else None


def attribute_fault(module: str, name: str) -> str | None:
    """What is wrong with `module.name`, if that can be told; else None."""
    return import_fault(module, name) if module in _LOOKED_UP or module == "setuptools" else None


def public_names(module: str) -> tuple[str, ...] | None:
    """What `from module import *` brings; None where that cannot be told."""
    if module == "setuptools":
        return ("setup", "find_packages", "find_namespace_packages", "Command", "Distribution", "Extension")
    if module not in _LOOKED_UP:
        return None
    found = _looked_up(module)
    return tuple(getattr(found, "__all__", [name for name in dir(found) if not name.startswith("_")]))


def is_at_hand(module: str) -> bool:
    """Whether a module can be imported wherever ROS 2 is built."""
    return module.split(".", maxsplit=1)[0] in {*sys.stdlib_module_names, "setuptools", "distutils"}


def _looked_up(module: str) -> ModuleType:
    return import_module(module)  # one of the few modules above, never a student's choice
