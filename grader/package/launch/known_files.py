"""Launch files of well-known ROS 2 packages, which submissions include but do not contain: the nodes they start."""

import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

from grader.package.launch.model import STATE_PUBLISHER, Contents, Context, Findings, Purpose, StartedNode
from grader.package.launch.places import PREFIX, ROS, SHARE
from grader.python.values import Call, Unknown

_RVIZ = "rviz2"
_GIVEN: Mapping[str, Purpose] = {STATE_PUBLISHER: "urdf", _RVIZ: "rviz"}  # the nodes that are given a file


# Packages that ROS 2 consists of, or that labs take for granted, whether package.xml names them or not.
_OF_ROS = frozenset(
    {"rviz2", "robot_state_publisher", "joint_state_publisher", "joint_state_publisher_gui", "xacro", "tf2_ros",
     "rclpy", "rclcpp", "launch", "launch_ros", "ros2launch", "turtlesim", "demo_nodes_cpp", "demo_nodes_py",
     "rqt_graph", "rqt_gui", "tf2_tools", "rosbag2", "ros2bag", "teleop_twist_keyboard"}
)  # fmt: skip


def is_of_ros(package: str) -> bool:
    """Return whether a package is on every machine that runs ROS 2 in a lab."""
    return package in _OF_ROS or package in _starts()


@cache
def _starts() -> Mapping[str, Mapping[str, Sequence[str]]]:
    """Return the nodes that the launch files of well-known packages start, by package and name of the file."""
    table: dict[str, dict[str, list[str]]] = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
    return table


def start_known_file(findings: Findings, path: str, call: Call, context: Context) -> bool:
    """Add what an included launch file of a well-known package starts; return whether the path is that of one."""
    prefix, _, name = path.rpartition("/share/")
    package, _, file = name.partition("/launch/")
    nodes = _starts().get(package, {}).get(file) if prefix.startswith((PREFIX, ROS)) else None
    if nodes is None:
        return False
    findings.nodes += [StartedNode(node, node, context.when, findings.locate(call.at)) for node in nodes]
    for node in nodes:
        if node in _GIVEN and package != "urdf_launch":
            findings.refer(_GIVEN[node], Unknown(f"{name} decides which file {node} gets", call.at), call)
    if package == "urdf_launch":
        _refer_files(findings, call, context, is_shown=_RVIZ in nodes)
    return True


def _refer_files(findings: Findings, call: Call, context: Context, *, is_shown: bool) -> None:
    """Add the files that the arguments of urdf_launch name."""
    given = [context.arguments.get(key) for key in ("urdf_package", "urdf_package_path")]
    match given:
        case [str() as package, str() as urdf]:
            findings.refer("urdf", Contents(f"{SHARE}/{package}/{urdf}", "xacro"), call)
        case _:
            unknown = next(value for value in given if not isinstance(value, str))
            is_missing = None in given or isinstance(unknown, Contents)
            message = "urdf_launch needs the arguments urdf_package and urdf_package_path"
            findings.refer("urdf", None if is_missing else unknown, call, wrong=message)
    opened = context.arguments.get("rviz_config")
    if is_shown and opened is None:
        message = "urdf_launch is included without rviz_config, so it opens its own configuration, not the lab's"
        findings.refer("rviz", None, call, wrong=message)
    elif is_shown:
        findings.refer("rviz", opened, call)
