"""Functions with which a Python launch file asks for folders of ROS 2 and of the machine."""

from pathlib import PurePosixPath

from grader.package.launch.places import HOME, PREFIX, SHARE, WORKING_FOLDER
from grader.static_python.evaluation import Evaluation, FunctionTable
from grader.static_python.functions import standard_functions
from grader.static_python.inspection import path_text
from grader.static_python.values import Call, Unknown, Value

_AMENT_INDEX = ("ament_index_python", "ament_index_python.packages")
_FIND = (
    "launch_ros.substitutions.FindPackageShare.find",
    "launch_ros.substitutions.find_package.FindPackageShare.find",
)


def launch_functions() -> FunctionTable:
    """Return the functions by full name; the folders that they return are stand-ins."""
    return {
        **standard_functions(WORKING_FOLDER),
        **dict.fromkeys([*_FIND, *(f"{module}.get_package_share_directory" for module in _AMENT_INDEX)], _share),
        **dict.fromkeys((f"{module}.get_package_share_path" for module in _AMENT_INDEX), _share_path),
        **dict.fromkeys((f"{module}.get_package_prefix" for module in _AMENT_INDEX), lambda *_: PREFIX),
        "os.path.expanduser": _expanduser,
        "os.path.expandvars": lambda _, call: Unknown("the environment is known only at run time", call.at),
        "pathlib.Path.home": lambda *_: PurePosixPath(HOME),
    }


def _share(_: Evaluation, call: Call) -> Value:
    name = call.argument(0, "package_name", "package")
    if isinstance(name, str):
        return f"{SHARE}/{name}"
    return name if isinstance(name, Unknown) else Unknown("the package is known only at run time", call.at)


def _share_path(evaluation: Evaluation, call: Call) -> Value:
    found = _share(evaluation, call)
    return PurePosixPath(found) if isinstance(found, str) else found


def _expanduser(_: Evaluation, call: Call) -> Value:
    text = path_text(call.args[0]) if call.args else None
    if text is None:
        return Unknown("a path is known only at run time", call.at)
    return text.replace("~", HOME, 1) if text.startswith("~") else text
