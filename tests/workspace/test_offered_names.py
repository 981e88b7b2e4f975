"""What may be written at a place of a file: the kinds of places that the walk of completion does not have."""

from collections.abc import Iterator

import pytest

from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.ros.known.releases import StatedReleases
from grader.workspace.index.offered_at import offered_at
from grader.workspace.index.offers import Offer
from grader.workspace.index.typed_places import read_typed_place
from grader.workspace.model.workspace import Workspace
from grader.workspace.opening.all_robots import read_workspace
from tests.command_line import ROOT
from tests.workspace.random_edits import files_of

pytestmark = pytest.mark.slow

_SECTION = "{}:\n  ros__parameters:\n    |"
_NODE = "<launch><node pkg='diffdrive_robot' exec='drive_circle.py'>"


@pytest.fixture(scope="module")
def diffdrive() -> Workspace:
    return _workspace("rubrics/diffdrive")


@pytest.fixture(scope="module")
def ferry() -> Workspace:
    return _workspace("tests/editor/ferry")


def _workspace(folder: str) -> Workspace:
    tree = overlaid(make_tree("ws", (), ()), files_of(ROOT / folder))
    return read_workspace(tree, "ws", URDF_LIMIT, {}, stated=StatedReleases(("jazzy",))).workspace


def _offers(workspace: Workspace, path: str, text: str) -> dict[str, Offer]:
    """Return what is offered at `|` in a text, by its names, the best first."""
    before, _, after = text.partition("|")
    place = read_typed_place(path, before + after, len(before))
    return {offer.name: offer for offer in offered_at([workspace], place)} if place else {}


@pytest.mark.parametrize(
    ("section", "name", "known"),
    [
        ("diff_drive_controller", "wheel_radius", "type: double"),
        ("controller_manager", "update_rate", "type: int"),
        ("amcl", "alpha1", "default: 0.2"),
        ("drive_circle", "speed", "declared at diffdrive_robot/scripts/drive_circle.py:12"),
    ],
)
def test_parameters_of_a_node(diffdrive: Workspace, section: str, name: str, known: str) -> None:
    """The keys of a controller, a well-known node and an own one have what is known of them."""
    offer = _offers(diffdrive, "a.yaml", _SECTION.format(section))[name]
    assert known in offer.text.split("\n")


def test_parameters_of_the_release_alone(diffdrive: Workspace) -> None:
    """A parameter of older releases is not offered, and keys of tables are."""
    text = _SECTION.format("diff_drive_controller")
    assert "use_stamped_vel" not in _offers(diffdrive, "a.yaml", text)
    below = text.replace("|", "linear:\n      x:\n        |")
    assert "max_velocity" in _offers(diffdrive, "a.yaml", below)
    assert "linear" in _offers(diffdrive, "a.yaml", text)


def test_nothing_is_known_of_the_parameters_of_other_nodes(diffdrive: Workspace) -> None:
    """What every node may have is offered."""
    assert {*_offers(diffdrive, "a.yaml", _SECTION.format("nobody"))} == {"plugin", "use_sim_time"}


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("a.py", "from geometry_msgs.msg import (Point,\n    Pose|", "Pose"),
        ("a.py", "from sensor|", "sensor_msgs.msg"),
        ("src/ferry_deck/ferry_deck/scale.py", "self.get_parameter('|", "rate"),
        ("a.py", "from ferry_msgs.msg import Load as L\ndef go(self, a: L):\n    a.header.|", "stamp"),
        ("a.py", "from ferry_msgs.srv import Tare\ncreate_service(Tare, 'x', self.go)\ndef go(self, a, b):\n    b.|", "success"),
        ("a.py", "from ferry_msgs.action import Lift\nActionClient(self, L|", "Lift"),
        ("a.py", "from ferry_msgs.srv import Tare\nself.create_client(T|", "Tare"),
        ("a.py", "name = unknown.|", ""),
        ("a.py", "# create_publisher(Load, '|", ""),
        ("a.py", "'''text\n'''\nm.frame_id = '|", "hook_link"),
        ("a.py", "create_publisher(Load, '/|", "/load"),
        ("a.cpp", "auto m = std::make_unique<ferry_msgs::msg::Load>();\nm->header.|", "frame_id"),
        ("a.cpp", "void f(const ferry_msgs::srv::Tare::Request::SharedPtr asked) {\n  asked->|", "offset"),
        ("a.cpp", "/* 1\n2 */ sensor_|", "sensor_msgs::msg"),
        ("a.cpp", "// sensor_|", ""),
        ("src/ferry_hoist/src/hoist.cpp", '#include "ferry_hoist/|', "limits.hpp"),
        ("a.cpp", "#include <geometry|", "geometry_msgs/msg/"),
    ],
)  # fmt: skip
def test_names_in_code(ferry: Workspace, path: str, text: str, expected: str) -> None:
    """Types, fields, parameters and frames are offered in code; nothing in a comment."""
    offered = _offers(ferry, path, text)
    assert expected in offered if expected else offered == {}


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("a.launch.xml", f"{_NODE}<param name='|", "speed"),
        ("a.launch.xml", f"{_NODE}<remap from='|", "cmd_vel"),
        ("a.launch.xml", "<launch><node pkg='controller_manager' exec='ros2_control_node'><remap from='|",
         "/diff_drive_controller/cmd_vel"),
        ("a.launch.xml", "<launch><node exec='|' pkg='rviz2'>", "rviz2"),
        ("a.launch.xml", "<launch><!-- <node exec='|", ""),
        ("a.launch.xml", "<launch><node |", "exec"),
        ("a.launch.xml", "<launch><node pkg='nav2_amcl' exec='amcl'><remap from='|", "initialpose"),
        ("a.launch.py", "Node(name='|', package='diffdrive_robot', executable='drive_circle.py')",
         "drive_circle"),
        ("a.launch.py", "IncludeLaunchDescription(f('online_async_launch.py'), launch_arguments={'|",
         "slam_params_file"),
        ("a.urdf", "<robot><link name='a'><gazebo reference='|", "base_link"),
        ("a.urdf", "<robot><gazebo |", ""),
        ("a.urdf", "<robot>text |", ""),
        ("a.urdf", "<robot><!-- <link> --><link name='a'><visual/></link><|", "joint"),
        ("a.urdf", "</joint><|", ""),
        ("a.urdf", '<mesh filename="package://diff|', "diffdrive_robot"),
        ("a.xacro", "<robot><xacro:macro name='a' params='x y:=\"1 2\"'><link name='${|", "y"),
        ("a.xacro", "<robot><xacro:macro name='a'><|", "link"),
        ("package.xml", "<package><export><|", "build_type"),
        ("CMakeLists.txt", "# find_package(|", ""),
        ("CMakeLists.txt", "add_library(leg a.cpp)\ntarget_link_libraries(arm |", "leg"),
        ("CMakeLists.txt", "find_package(rclcpp)\ntarget_link_libraries(arm |", "rclcpp::rclcpp"),
        ("CMakeLists.txt", "ament_pa|", "ament_package"),
        ("diffdrive_robot/CMakeLists.txt", "install(PROGRAMS |", "scripts/drive_circle.py"),
        ("diffdrive_robot/CMakeLists.txt", "install(DIRECTORY |", "urdf"),
        ("a.rviz", "Displays:\n  - Topic:\n      Value: |", "/diff_drive_controller/odom"),
        ("a.rviz", "Displays:\n  - Class: rviz|", "rviz_default_plugins/Grid"),
        ("a.rviz", "Displays:\n  - Description Topic:\n      Value: |", "/robot_description"),
        ("a.yaml", "- ros_topic_name: |", "/cmd_vel"),
        ("a.yaml", "- gz_type_name: |\n  ros_type_name: sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan"),
        ("a.yaml", "- ros_type_name: |", "sensor_msgs/msg/LaserScan"),
        ("a.yaml", "- direction: |", "GZ_TO_ROS"),
        ("a.yaml", "|", "amcl"),
        ("a.yaml", "# |", ""),
        ("a.yaml", "amcl:\n  |", "ros__parameters"),
        ("a.yaml", "amcl: {ros__parameters: {a: 1, scan_topic: |", "/diff_drive_controller/odom"),
        ("a.yaml", "amcl:\n  ros__parameters:\n    base_frame_id: |", "base_link"),
        ("a.yaml", "a:\n  ros__parameters:\n    joints:\n      - |", "left_wheel_joint"),
        ("a.yaml", "controller_manager:\n  ros__parameters:\n    a:\n      |", "type"),
        ("a.yaml", "bt_navigator:\n  ros__parameters:\n    navigators: [|", "navigate_to_pose"),
        ("a.txt", "|", ""),
    ],
)  # fmt: skip
def test_names_in_files(diffdrive: Workspace, path: str, text: str, expected: str) -> None:
    """What is offered fits the element, the command or the table around; elsewhere it is nothing."""
    offered = _offers(diffdrive, path, text)
    assert expected in offered if expected else offered == {}


def test_attributes_that_are_written_are_not_offered(diffdrive: Workspace) -> None:
    """The others say their unit, and whether the element needs them."""
    assert [*_offers(diffdrive, "a.urdf", '<origin rpy="0 0 0" |')] == ["xyz", "quat_xyzw"]
    [box] = _offers(diffdrive, "a.urdf", "<robot><box |").values()
    assert (box.name, box.detail, box.text) == ("size", "x y z in m", "needed")


def test_those_that_begin_so_are_first(diffdrive: Workspace) -> None:
    """All packages that are released follow, which are many."""
    names: Iterator[str] = iter(_offers(diffdrive, "package.xml", "<package><depend>turtle|"))
    assert next(names).startswith("turtle")
