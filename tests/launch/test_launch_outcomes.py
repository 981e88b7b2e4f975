"""Launch files against what ROS 2's own launch did with them (Jazzy; processes not started, rclpy replaced).

`launch_cases.json` are whole files; `launch_outcomes.json` are actions that were put into a file of a robot, at random. No
file passes that launch stops at, and none fails that it starts; what is known of an action stays known. Those with `since` were refused then (3.4.3),
and are right from this update of Jazzy on, by its changelog.
"""

import json
from pathlib import Path
from typing import Any

import pytest

from grader.ros.launch.launch_file import read_launch
from tests.command_line import ROOT
from tests.launch.launch_samples import Installed

pytestmark = pytest.mark.slow

_HERE = Path(__file__).parent
_CASES = json.loads((_HERE / "launch_cases.json").read_text("utf-8"))
_ACTIONS = json.loads((_HERE / "launch_outcomes.json").read_text("utf-8"))
_REFERENCE = ROOT / "rubrics" / "lab6" / "my_robot"
_INNER = b"""\
from launch import LaunchDescription
from launch.actions import LogInfo
def generate_launch_description():
    return LaunchDescription([LogInfo(msg='in')])
"""
_FILES = {
    "share/my_robot/my_robot.urdf": (_REFERENCE / "urdf" / "my_robot.urdf").read_bytes(),
    "share/my_robot/my_robot.rviz": (_REFERENCE / "rviz" / "my_robot.rviz").read_bytes(),
    "share/my_robot/launch/inner.launch.py": _INNER,
}
_INSTALLED = {
    "rviz2",
    "robot_state_publisher",
    "joint_state_publisher",
    "joint_state_publisher_gui",
    "my_robot",
    "a",
    "b",
}
_IMPORTS = """\
import os
from pathlib import Path
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.event_handlers import *
from launch.events import Shutdown as ShutdownEvent
from launch.launch_description_sources import *
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.descriptions import ComposableNode, ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackageShare, ExecutableInPackage, FindPackagePrefix


def generate_launch_description():
"""
_XML = """\
<launch>
  <arg name="a" default="true"/>
  <arg name="n" default="3"/>
{action}
  <node pkg="joint_state_publisher" exec="joint_state_publisher"/>
  <node pkg="robot_state_publisher" exec="robot_state_publisher">
    <param name="robot_description" value="$(command 'cat $(find-pkg-share my_robot)/my_robot.urdf')" type="str"/>
  </node>
  <node pkg="rviz2" exec="rviz2" args="-d $(find-pkg-share my_robot)/my_robot.rviz"/>
</launch>
"""
_YAML = """\
launch:
  - arg: {{name: a, default: "true"}}
  - arg: {{name: "n", default: "3"}}
{action}
  - node: {{pkg: joint_state_publisher, exec: joint_state_publisher}}
  - node:
      pkg: robot_state_publisher
      exec: robot_state_publisher
      param:
        - name: robot_description
          value: "$(command 'cat $(find-pkg-share my_robot)/my_robot.urdf')"
          type: str
  - node: {{pkg: rviz2, exec: rviz2, args: "-d $(find-pkg-share my_robot)/my_robot.rviz"}}
"""


class _Installed(Installed):
    def has_package(self, name: str) -> bool:
        return name in _INSTALLED

    def misspelt_package(self, name: str) -> str | None:
        """Return the package that a name stands for."""

    def files_in(self, folder: str) -> tuple[str, ...]:
        """Return the names of the files in a folder."""
        return tuple(
            path.rpartition("/")[2] for path in self.files if path.rpartition("/")[0] == folder
        )

    def has_program(self, package: str, name: str) -> bool:
        del name
        return package != "my_robot"


def outcome(text: str, language: str) -> bool | None:
    """Return whether a launch file starts the robot and RViz; None where this needs manual grading."""
    path = f"launch/view.launch.{language}"

    launch = read_launch(text.encode(), path, f"share/my_robot/{path}", _Installed(_FILES))
    if launch.syntax is not None or launch.faults:
        return False
    if launch.doubts:
        return None
    read = (
        it
        for it in launch.references
        if it.path is not None and (it.by or it.purpose in ("read", "include"))
    )
    if any((it.path or "").removeprefix("/<prefix>/") not in _FILES for it in read):
        return False
    started = {node.name for node in launch.nodes if node.when}
    is_open = launch.unknown or any(node.when is None for node in launch.nodes)
    return True if started >= {"rviz2", "robot_state_publisher"} else None if is_open else False


@pytest.mark.parametrize("case", _CASES["cases"], ids=lambda case: case["name"])
def test_a_file(case: dict[str, Any]) -> None:
    """It is judged as launch does, or not at all."""
    text = (
        case["text"].replace("<imports>\n", _CASES["imports"]).replace("<nodes>\n", _CASES["nodes"])
    )
    assert outcome(text, case["language"]) in (case["starts"], None)


@pytest.mark.parametrize("language", ["py", "xml", "yaml"])
def test_actions(language: str) -> None:
    """Each is judged as launch does; where `known` says so, it is judged."""
    rows = [row for row in _ACTIONS if row["language"] == language]
    wrong = [
        row
        for row in rows
        if (found := outcome(_text(row), language)) is not row["starts"]
        and not _is_open(found, row)
    ]
    assert len(rows) > 100
    assert wrong == []


def _is_open(found: bool | None, row: dict[str, Any]) -> bool:
    return found is None and not row["known"]


def _text(row: dict[str, Any]) -> str:
    action: str = row["action"]
    if row["language"] != "py":
        return (_XML if row["language"] == "xml" else _YAML).format(action=action)
    declared = "DeclareLaunchArgument('a', default_value='true'), DeclareLaunchArgument('n', default_value='3')"
    return f"{_IMPORTS}{_CASES['nodes'].partition(chr(10))[2]}    return LaunchDescription([{declared}, {action}, jsp, rsp, rviz])\n"
