"""Transforms that nodes look up: both frames exist, and something connects them."""

from pathlib import Path

import pytest

from tests.workspace.carts import agreement_of
from tests.workspace.test_cpp_nodes import messages

pytestmark = pytest.mark.slow

_NODE = """\
import rclpy
from rclpy.node import Node
from tf2_ros import Buffer, TransformListener


class Finder(Node):
    def __init__(self):
        super().__init__('finder')
        self.declare_parameter('goal', 'laser'); self.get_parameter('goal')
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.buffer.LOOKUP


def main():
    rclpy.init()
    rclpy.spin(Finder())
"""
_LAUNCH = """\
from launch import LaunchDescription
from launch.substitutions import Command, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    robot = Command(['cat ', PathJoinSubstitution([FindPackageShare('seeker'), 'seeker.urdf'])])
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': robot}]),
        Node(package='seeker', executable='finder'),
        MORE
    ])
"""
_FILES = {
    "seeker/package.xml": """\
<package format="3">
  <name>seeker</name><version>0.0.0</version><description>A seeker.</description>
  <maintainer email="a@b.example">A</maintainer><license>Apache-2.0</license>
  <depend>rclpy</depend><depend>tf2_ros</depend><depend>robot_state_publisher</depend>
  <depend>nav2_amcl</depend><depend>joy</depend><depend>diff_drive_controller</depend><depend>controller_manager</depend>
  <export><build_type>ament_python</build_type></export>
</package>
""",
    "seeker/setup.py": """\
from setuptools import setup

setup(
    name='seeker', version='0.0.0', packages=['seeker'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/seeker']),
        ('share/seeker', ['package.xml', 'seeker.urdf', 'seeker.launch.py']),
    ],
    entry_points={'console_scripts': ['finder = seeker.finder:main']},
)
""",
    "seeker/setup.cfg": "[install]\ninstall_scripts=$base/lib/seeker\n",
    "seeker/resource/seeker": "",
    "seeker/seeker/__init__.py": "",
    "seeker/seeker.urdf": """\
<robot name="seeker">
  <link name="base_link"/>
  <link name="laser"/>
  <joint name="laser_joint" type="fixed"><parent link="base_link"/><child link="laser"/></joint>
</robot>
""",
}
_STATIC = (
    "Node(package='tf2_ros', executable='static_transform_publisher', "
    "arguments=['--frame-id', 'map', '--child-frame-id', 'PLACE']),"
)


def _found(lookup: str, more: str = "") -> list[tuple[str, str, bool]]:
    """Return what does not agree where a node looks up a transform, and more nodes run."""
    node = _NODE.replace("LOOKUP", lookup)
    files = _FILES | {
        "seeker/seeker/finder.py": node,
        "seeker/seeker.launch.py": _LAUNCH.replace("MORE", more),
    }
    found = agreement_of(files).mismatches
    return [(it.family, it.message, it.is_certain) for it in found]


_TIME = "rclpy.time.Time()"
_NOW = "self.get_clock().now()"
_APART = _STATIC.replace("PLACE", "tower")  # a tree of its own
_OF_MAP = f"lookup_transform('map', 'laser', {_TIME})"


@pytest.mark.parametrize(
    ("lookup", "more"),
    [
        (_OF_MAP, _APART),
        (f"lookup_transform('/map', 'laser', {_TIME})", _APART),
        (f"lookup_transform_async('map', self.get_parameter('goal').value, {_TIME})", _APART),
        (f"lookup_transform(source_frame='laser', target_frame='map', time={_TIME})", _APART),
        (f"lookup_transform_full('map', {_NOW}, 'laser', {_NOW}, 'odom')", _APART),
        (_OF_MAP, _APART + "Node(package='joy', executable='joy_node'),"),
    ],
)
def test_frames_that_nothing_connects(lookup: str, more: str) -> None:
    """Both frames are published, and the transform between them never is."""
    message = "nothing that is started connects 'map' and 'laser', so this lookup fails"
    assert _found(lookup, more) == [("transforms", message, False)]


@pytest.mark.parametrize(
    ("lookup", "more"),
    [
        (f"lookup_transform('base_link', 'laser', {_TIME})", _APART),
        (_OF_MAP, _STATIC.replace("PLACE", "base_link")),
        (_OF_MAP, _APART + _STATIC.replace("map", "tower").replace("PLACE", "base_link")),
        (_OF_MAP, ""),  # another terminal may run what publishes the map
        (_OF_MAP, _APART + "Node(package='nav2_amcl', executable='amcl'),"),
        (_OF_MAP, _APART + "Node(package='other', executable='other'),"),
        (_OF_MAP, _APART + "ExecuteProcess(cmd=['ros2', 'bag', 'play', 'drive']),"),
        (_OF_MAP, _APART + "Node(package='tf2_ros', executable='static_transform_publisher', arguments=[LaunchConfiguration('a')]),"),
        (_OF_MAP, _APART + "Node(package='controller_manager', executable='ros2_control_node'),"),
        (f"can_transform('map', 'laser', {_TIME})", _APART),  # it asks whether there is one
        (f"lookup_transform('map', name(), {_TIME})", _APART),
        (f"lookup_transform('map', *frames, {_TIME})", _APART),
        (f"{_OF_MAP}; TransformBroadcaster(self)", _APART),
        (f"{_OF_MAP}; self.create_publisher(TFMessage, '/tf', 10)", _APART),
        (f"frames.{_OF_MAP}", _APART),  # not of a buffer of tf2
        (f"lookup_transform('base_link', 'optional', {_TIME})", ""),
        (f"lookup_transform('base_link', 'tower', {_TIME})", _STATIC.replace("map", "tower").replace("PLACE", "base_link")),
        (f"lookup_transform('world_2', 'laser', {_TIME})", "Node(package='nav2_amcl', executable='amcl', parameters=[{'global_frame_id': 'world_2'}]),"),
    ],
)  # fmt: skip
def test_frames_that_may_be_connected(lookup: str, more: str) -> None:
    """What publishes a transform, or may publish one, connects frames."""
    assert [it for it in _found(lookup, more) if it[0] in ("transforms", "frames")] == []


def test_a_static_transform_may_be_the_root() -> None:
    """A frame above the robot need not be anything else; a similar name is wrong."""
    static = _STATIC.replace("map", "arena").replace("PLACE", "base_link")
    assert _found(f"lookup_transform('arena', 'laser', {_TIME})", static) == []
    [found] = _found("clear()", static.replace("arena", "lase"))
    assert found[0] == "frames"


def test_links_under_a_prefix() -> None:
    """The frames of the robot are those with the prefix of its robot_state_publisher."""
    prefixed = _LAUNCH.replace(
        "{'robot_description'", "{'frame_prefix': 'r1/', 'robot_description'"
    )
    for name in ("r1/laser", "r1/base_link"):
        files = _FILES | {
            "seeker/seeker/finder.py": _NODE.replace("LOOKUP", f"lookup_transform('{name}', 'r1/laser', {_TIME})"),
            "seeker/seeker.launch.py": prefixed.replace("MORE", ""),
        }  # fmt: skip
        assert agreement_of(files).mismatches == ()


def test_a_frame_that_is_not_there() -> None:
    """It is a mistake of frames, and said once."""
    [found] = _found(f"lookup_transform('base_link', 'lasr', {_TIME})")
    assert found[0] == "frames"
    assert found[1].startswith("lookup_transform: there is no frame 'lasr'; did you mean")


def test_frames_in_cpp(tmp_path: Path) -> None:
    """A node in C++ looks them up in the same way."""
    old = 'get_parameter("frame_id").as_string(), "lamp_link"'
    edit = ("beacon/src/watcher.cpp", old, '"tower", "lamp_link"')
    static = _STATIC.replace("PLACE", "tower")
    launch = ("beacon/launch/beacon.launch.py", "    ])", f"        {static}\n    ])")
    [found] = [it for it in messages(tmp_path, edit, launch) if it[0] != "dependencies"]
    assert found[0] == "transforms"
    assert found[1].startswith("nothing that is started connects 'tower' and 'lamp_link', so")
