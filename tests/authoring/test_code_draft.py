"""`grader rubric new` of a package of nodes: what it asks of components, frames, recordings and markers."""

import json
from pathlib import Path

import pytest

from tests.command_line import run

_FILES = {
    "beacon/package.xml": """
<package format="3">
  <name>beacon</name>
  <version>1.0.0</version>
  <description>A beacon.</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>rclpy</depend>
  <depend>visualization_msgs</depend>
  <exec_depend>launch</exec_depend>
  <exec_depend>launch_ros</exec_depend>
  <exec_depend>ros2bag</exec_depend>
  <exec_depend>tf2_ros</exec_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
    "beacon/CMakeLists.txt": """
cmake_minimum_required(VERSION 3.16)
project(beacon)
find_package(ament_cmake REQUIRED)
install(PROGRAMS beacon.py DESTINATION lib/${PROJECT_NAME})
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_package()
""",
    "beacon/beacon.py": """#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from visualization_msgs.msg import Marker


class Beacon(Node):
    def __init__(self):
        super().__init__('beacon')
        self.declare_parameter('light.frame_id', 'light')
        self.frame = self.get_parameter('light.frame_id').value
        self.markers = self.create_publisher(Marker, 'beacon', 10)
        self.create_timer(1.0, self.flash)

    def flash(self):
        marker = Marker()
        marker.header.frame_id = self.frame
        self.markers.publish(marker)


rclpy.init()
rclpy.spin(Beacon())
""",
    "beacon/launch/beacon.launch.py": """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('record', default_value='false'),
        Node(package='beacon', executable='beacon.py', parameters=[{'light.frame_id': 'light'}]),
        Node(package='tf2_ros', executable='static_transform_publisher',
             arguments=['--z', '2', '--frame-id', 'map', '--child-frame-id', 'light']),
        ExecuteProcess(cmd=['ros2', 'bag', 'record', '-o', 'run', '/beacon'],
                       condition=IfCondition(LaunchConfiguration('record'))),
    ])
""",
}
_LAUNCH = "beacon/launch/beacon.launch.py"


def write(folder: Path, edits: tuple[tuple[str, str, str], ...] = ()) -> Path:
    """Write the package with edits of its files, and return its folder."""
    texts = dict(_FILES)
    for path, old, new in edits:
        assert texts[path].count(old) == 1
        texts[path] = texts[path].replace(old, new)
    for path, text in texts.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text.lstrip(), encoding="utf-8")
    return folder


def lost(rubric: Path, submission: Path) -> list[str]:
    """Return the criteria for which a submission loses points."""
    options = ("--rubric", rubric, "--format", "json", "--hints", "none")
    done = run(("grade", submission, *options))
    results = json.loads(done.stdout)["results"]
    return [result["id"] for result in results if result["points"] != result["max_points"]]


@pytest.mark.parametrize(
    ("edits", "expected"),
    [
        ((), []),
        (((_LAUNCH, "{'light.frame_id': 'light'}", "{'light.frame_id': 'lamp'}"),), ["beacon-light-frame-id-parameter-is"]),
        (((_LAUNCH, "'run', '/beacon'],", "'run', '/rosout'],"),), ["beacon-launch-py-records-starts"]),
        (((_LAUNCH, ",\n                       condition=IfCondition(LaunchConfiguration('record'))", ""),), ["beacon-launch-py-records-nothing-starts"]),
        ((("beacon/beacon.py", "        marker.header.frame_id = self.frame\n", ""),("beacon/beacon.py", "        self.frame = self.get_parameter('light.frame_id').value\n", "")), ["markers-without-problems"]),
    ],
)  # fmt: skip
def test_what_a_draft_asks(
    edits: tuple[tuple[str, str, str], ...], expected: list[str], tmp_path: Path
) -> None:
    """Each mistake fails one criterion of the draft, and the reference none."""
    rubric = tmp_path / "lab.toml"
    reference = write(tmp_path / "reference")
    assert run(("rubric", "new", rubric, "--from", reference)).returncode == 0
    assert lost(rubric, write(tmp_path / "submission", edits)) == expected


def test_a_launch_file_that_always_records(tmp_path: Path) -> None:
    """Its draft asks for the recording under the default arguments."""
    rubric = tmp_path / "lab.toml"
    condition = ",\n                       condition=IfCondition(LaunchConfiguration('record'))"
    reference = write(tmp_path / "reference", ((_LAUNCH, condition, ""),))
    assert run(("rubric", "new", rubric, "--from", reference)).returncode == 0
    assert lost(rubric, write(tmp_path / "submission")) == ["beacon-launch-py-records-starts"]


_PROGRAM = "beacon/beacon.py"
_SERVER = """        self.create_subscription(LaserScan, 'scan', self.look, qos_profile_sensor_data)
        self.ranges = self.create_publisher(Range, 'range', 10)
        self.declare_parameter('period', 1.0)
        self.server = ActionServer(
            self, Fibonacci, 'count', self.count, goal_callback=self.accept, cancel_callback=self.stop)

    def look(self, scan):
        message = Range()
        message.header.frame_id = 'light'
        self.ranges.publish(message)

    def accept(self, goal):
        return GoalResponse.ACCEPT if goal.order < 5 else GoalResponse.REJECT

    def stop(self, goal):
        return CancelResponse.ACCEPT

    def count(self, goal):
        goal.publish_feedback(Fibonacci.Feedback())
        if goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.succeed()
        return Fibonacci.Result()

    def flash(self):
"""
_CODE = (
    ("beacon/package.xml", "  <depend>visu", "  <depend>example_interfaces</depend>\n  <depend>sensor_msgs</depend>\n  <depend>visu"),
    (_PROGRAM, "from rclpy.node", "from example_interfaces.action import Fibonacci\nfrom rclpy.action import ActionServer, CancelResponse, GoalResponse\nfrom rclpy.node"),
    (_PROGRAM, "from visu", "from rclpy.qos import qos_profile_sensor_data\nfrom sensor_msgs.msg import LaserScan, Range\nfrom visu"),
    (_PROGRAM, "\n    def flash(self):\n", _SERVER),
    (_PROGRAM, "self.create_timer(1.0", "self.create_timer(self.get_parameter('period').value"),
    (_LAUNCH, "'light.frame_id': 'light'", "'light.frame_id': 'light', 'period': 0.5"),
)  # fmt: skip


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("'light'\n", "'lamp'\n", "range-publishes"),
        ("        goal.publish_feedback(Fibonacci.Feedback())\n", "", "count-serves-action"),
        (", cancel_callback=self.stop", "", "count-serves-action"),
        (" if goal.order < 5 else GoalResponse.REJECT", "", "count-serves-action"),
        ("self.look, qos_profile_sensor_data", "self.look, 10", "beacon-launch-py-subscribes-node-runs"),
        ("self.get_parameter('period').value", "0.5", "beacon-period-uses-parameter"),
    ],
)  # fmt: skip
def test_what_a_draft_asks_of_code(old: str, new: str, expected: str, tmp_path: Path) -> None:
    """The frame of a sensor, goals of actions, the quality of what others publish, and parameters."""
    rubric = tmp_path / "lab.toml"
    reference = write(tmp_path / "reference", _CODE)
    assert run(("rubric", "new", rubric, "--from", reference)).returncode == 0
    assert lost(rubric, reference) == []
    assert lost(rubric, write(tmp_path / "submission", (*_CODE, (_PROGRAM, old, new)))) == [
        expected
    ]


def test_mutants_of_what_a_draft_asks_of_code(tmp_path: Path) -> None:
    """A test of the rubric makes each of these mistakes, and the criteria find them."""
    rubric = tmp_path / "lab.toml"
    assert (
        run(("rubric", "new", rubric, "--from", write(tmp_path / "reference", _CODE))).returncode
        == 0
    )
    result = json.loads(run(("rubric", "test", rubric, "--format", "json")).stdout)
    survivors = {mutant["family"] for mutant in result["survivors"]}
    kinds = {"feedback removed", "cancel rejected", "goal accepted", "parameter ignored"}
    assert survivors.isdisjoint(kinds)
