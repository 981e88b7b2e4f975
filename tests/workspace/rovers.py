"""A workspace with a rover of two driven wheels, a lidar and an arm joint, whose files say numbers of each other."""

from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.workspace.opening.all_robots import read_workspace
from grader.workspace.opening.opened import OpenedWorkspace
from grader.workspace.rules.name_problems import name_problems

Edit = tuple[
    str, str, str
]  # a file of the package, or with / of the workspace, a text in it, and what replaces that

_SETUP = """\
from glob import glob

from setuptools import setup

setup(
    name='rover',
    version='1.0.0',
    packages=['rover'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/rover']),
        ('share/rover', ['package.xml']),
        ('share/rover/urdf', glob('urdf/*')),
        ('share/rover/launch', glob('launch/*')),
        ('share/rover/config', glob('config/*')),
    ],
    entry_points={'console_scripts': ['pilot = rover.pilot:main', 'horn = rover.horn:main']},
)
"""
_MANIFEST = """\
<package format="3">
  <name>rover</name>
  <version>1.0.0</version>
  <description>A rover</description>
  <maintainer email="a@example.org">A</maintainer>
  <license>MIT</license>
  <exec_depend>robot_state_publisher</exec_depend>
  <exec_depend>controller_manager</exec_depend>
  <exec_depend>joint_state_broadcaster</exec_depend>
  <exec_depend>diff_drive_controller</exec_depend>
  <exec_depend>joint_state_publisher</exec_depend>
  <exec_depend>nav2_controller</exec_depend>
  <exec_depend>robot_localization</exec_depend>
  <exec_depend>teleop_twist_keyboard</exec_depend>
  <exec_depend>ros_gz_bridge</exec_depend>
  <exec_depend>tf2_ros</exec_depend>
  <exec_depend>rviz2</exec_depend>
  <exec_depend>rclpy</exec_depend>
  <exec_depend>geometry_msgs</exec_depend>
  <exec_depend>sensor_msgs</exec_depend>
  <export><build_type>ament_python</build_type></export>
</package>
"""
_ROBOT = """\
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="size" default="0.05"/> <xacro:property name="depth" value="$(arg size)"/>
  <xacro:property name="radius" value="0.05"/>
  <xacro:macro name="wheel" params="side y">
    <link name="${side}_wheel">
      <visual>
        <origin rpy="1.5708 0 0"/>
        <geometry><cylinder radius="${radius}" length="0.02"/></geometry>
      </visual>
    </link>
    <joint name="${side}_wheel_joint" type="continuous">
      <parent link="base_link"/>
      <child link="${side}_wheel"/>
      <origin xyz="0 ${y} 0"/>
      <axis xyz="0 1 0"/>
    </joint>
  </xacro:macro>
  <link name="base_link">
    <visual><geometry><box size="0.4 0.2 0.1"/></geometry></visual>
  </link>
  <xacro:wheel side="left" y="0.15"/>
  <xacro:wheel side="right" y="-0.15"/>
  <link name="laser"/>
  <joint name="laser_joint" type="fixed">
    <parent link="base_link"/>
    <child link="laser"/>
    <origin xyz="0.1 0 0.1"/>
  </joint>
  <link name="arm"/>
  <joint name="lift" type="revolute">
    <parent link="base_link"/>
    <child link="arm"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="5" velocity="2"/>
  </joint>
  <gazebo reference="laser">
    <sensor name="lidar" type="gpu_lidar">
      <topic>scan</topic>
      <update_rate>10</update_rate>
      <lidar><range><min>0.1</min><max>8.0</max></range></lidar>
    </sensor>
  </gazebo>
  <ros2_control name="system" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="left_wheel_joint"><command_interface name="velocity"/><state_interface name="position"/></joint>
    <joint name="right_wheel_joint"><command_interface name="velocity"/><state_interface name="position"/></joint>
    <joint name="lift">
      <command_interface name="position">
        <param name="min">-1</param>
        <param name="max">1</param>
      </command_interface>
    </joint>
  </ros2_control>
</robot>
"""
_CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: 50
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    wheels:
      type: diff_drive_controller/DiffDriveController
wheels:
  ros__parameters:
    left_wheel_names: [left_wheel_joint]
    right_wheel_names: [right_wheel_joint]
    wheel_separation: 0.3
    wheel_radius: 0.05
    publish_rate: 50.0
    base_frame_id: base_link
"""
_COSTMAP = """\
local_costmap:
  local_costmap:
    ros__parameters:
      robot_base_frame: base_link
      robot_radius: 0.25
      plugins: [obstacles]
      obstacles:
        plugin: "nav2_costmap_2d::ObstacleLayer"
        observation_sources: scan
        scan:
          topic: /scan
          data_type: LaserScan
          obstacle_max_range: 2.5
          expected_update_rate: 0.5
"""
_LIMITS = """\
joint_limits:
  lift:
    has_velocity_limits: true
    max_velocity: 1.5
"""
_LAUNCH = """\
import os

from launch import LaunchDescription
from launch.substitutions import Command, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare('rover')
    robot = Command(['xacro ', PathJoinSubstitution([share, 'urdf', 'rover.urdf.xacro'])])
    controllers = PathJoinSubstitution([share, 'config', 'controllers.yaml'])
    costmap = PathJoinSubstitution([share, 'config', 'costmap.yaml'])
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': robot}]),
        Node(package='controller_manager', executable='ros2_control_node',
             parameters=[controllers]),
        Node(package='controller_manager', executable='spawner',
             arguments=['joint_state_broadcaster']),
        Node(package='controller_manager', executable='spawner', arguments=['wheels']),
        Node(package='nav2_controller', executable='controller_server',
             parameters=[costmap]),
        # MORE
    ])
"""
_PILOT = """\
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Pilot(Node):
    def __init__(self):
        super().__init__('pilot')
        self.publisher = self.create_publisher(Twist, 'drive', 10)
        self.create_timer(0.1, self.send)

    def send(self):
        self.publisher.publish(Twist())


def main():
    rclpy.init()
    rclpy.spin(Pilot())
"""
_HORN = """\
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Horn(Node):
    def __init__(self):
        super().__init__('horn')
        self.create_subscription(Twist, 'drive', self.heard, 10)

    def heard(self, message):
        self.get_logger().info('beep')


def main():
    rclpy.init()
    rclpy.spin(Horn())
"""
FILES = {
    "rover/package.xml": _MANIFEST,
    "rover/setup.py": _SETUP,
    "rover/setup.cfg": "[install]\ninstall_scripts=$base/lib/rover\n",
    "rover/resource/rover": "",
    "rover/rover/__init__.py": "",
    "rover/rover/pilot.py": _PILOT,
    "rover/rover/horn.py": _HORN,
    "rover/urdf/rover.urdf.xacro": _ROBOT,
    "rover/config/controllers.yaml": _CONTROLLERS,
    "rover/config/costmap.yaml": _COSTMAP,
    "rover/config/joint_limits.yaml": _LIMITS,
    "rover/launch/rover.launch.py": _LAUNCH,
}
ROBOT, CONTROLLERS, COSTMAP = (
    "urdf/rover.urdf.xacro",
    "config/controllers.yaml",
    "config/costmap.yaml",
)
LAUNCH, LIMITS, PILOT, HORN = (
    "launch/rover.launch.py",
    "config/joint_limits.yaml",
    "rover/pilot.py",
    "rover/horn.py",
)
MORE = "# MORE"
_OTHERS = ("REF008", "REF009", "REF010", "REF042")  # what these tests do not ask for


def rover(*edits: Edit) -> OpenedWorkspace:
    """Return the workspace with some texts replaced."""
    files = dict(FILES)
    for file, old, new in edits:
        path = file[1:] if file.startswith("/") else f"rover/{file}"
        assert old in files.setdefault(path, old), (file, old)
        files[path] = files[path].replace(old, new)
    tree = overlaid(make_tree("ws", (), ()), {path: text.encode() for path, text in files.items()})
    return read_workspace(tree, "ws", URDF_LIMIT, {})


def problems_of(*edits: Edit) -> list[str]:
    """Return the problems of the workspace with some texts replaced, each with its code and place."""
    found = name_problems(rover(*edits).workspace)
    texts = []
    for problem in found:
        if problem.code not in _OTHERS:
            at = problem.location
            is_own = at.path.startswith("rover/")
            path = at.path.removeprefix("rover/") if is_own else f"/{at.path}"
            texts.append(f"{problem.code} {path}:{at.line} {problem.message}")
    return texts
