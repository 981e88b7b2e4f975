"""Small workspaces whose graphs are tested: a package of Python with launch files, and one of C++."""

from collections.abc import Mapping

from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.workspace.graph.launch_graph import GraphNode, LaunchGraph
from grader.workspace.opening.all_robots import read_workspace
from grader.workspace.opening.opened import OpenedWorkspace

MANIFEST = """\
<package format="3">
  <name>{name}</name><version>1.0.0</version><description>D</description>
  <maintainer email="a@example.org">A</maintainer><license>MIT</license>
  <buildtool_depend>{build}</buildtool_depend><depend>rclpy</depend><depend>rclcpp</depend>
  <depend>rclcpp_components</depend><depend>std_msgs</depend>
  <export><build_type>{build}</build_type></export>
</package>
"""
SETUP = """\
from glob import glob
from setuptools import setup

setup(
    name='demo', version='1.0.0', packages=['demo'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/demo']),
        ('share/demo', ['package.xml']),
        ('share/demo/launch', glob('launch/*')),
        ('share/demo/config', glob('config/*')),
    ],
    entry_points={'console_scripts': ['talker = demo.talker:main', 'pair = demo.pair:main']},
)
"""
TALKER = """\
import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.declare_parameter('topic', 'chatter')
        self.declare_parameter('rate', 10)
        self.create_publisher(String, self.get_parameter('topic').value, 10)
        self.create_subscription(String, 'answer', print, 10)


def main():
    rclpy.init()
    rclpy.spin(Talker())
"""
PAIR = """\
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String


class First(Node):
    def __init__(self):
        super().__init__('first')
        self.create_publisher(String, 'chatter', 10)


class Second(Node):
    def __init__(self):
        super().__init__('second')
        self.create_subscription(String, 'chatter', print, 10)


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    executor.add_node(First())
    executor.add_node(Second())
    executor.spin()
"""
CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project(eyes)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
find_package(rclcpp_components REQUIRED)
find_package(std_msgs REQUIRED)
add_library(eye SHARED src/eye.cpp)
ament_target_dependencies(eye rclcpp rclcpp_components std_msgs)
rclcpp_components_register_nodes(eye "eyes::Eye")
install(TARGETS eye DESTINATION lib)
ament_package()
"""
EYE = """\
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
#include <std_msgs/msg/string.hpp>
namespace eyes {
class Eye : public rclcpp::Node {
public:
  explicit Eye(const rclcpp::NodeOptions & options) : Node("eye", options) {
    declare_parameter("gain", 1.0);
    pub_ = create_publisher<std_msgs::msg::String>("seen", rclcpp::SensorDataQoS());
  }
  rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
};
}
RCLCPP_COMPONENTS_REGISTER_NODE(eyes::Eye)
"""
FILES = {
    "demo/package.xml": MANIFEST.format(name="demo", build="ament_python"),
    "demo/setup.py": SETUP,
    "demo/setup.cfg": "[develop]\nscript_dir=$base/lib/demo\n[install]\ninstall_scripts=$base/lib/demo\n",
    "demo/resource/demo": "",
    "demo/demo/__init__.py": "",
    "demo/demo/talker.py": TALKER,
    "demo/demo/pair.py": PAIR,
    "eyes/package.xml": MANIFEST.format(name="eyes", build="ament_cmake"),
    "eyes/CMakeLists.txt": CMAKE,
    "eyes/src/eye.cpp": EYE,
}
HEAD = """\
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import ComposableNodeContainer, LoadComposableNodes, Node, SetRemap
from launch_ros.descriptions import ComposableNode

share = get_package_share_directory('demo')


def generate_launch_description():
    return LaunchDescription([
"""


def launch_file(*actions: str) -> str:
    """Return a launch file in Python with these actions."""
    return f"{HEAD}{''.join(f'        {action},{chr(10)}' for action in actions)}    ])\n"


def open_files(files: Mapping[str, str]) -> OpenedWorkspace:
    """Return a workspace of the package demo with further files, and the package eyes."""
    whole = {
        **FILES,
        **files,
    }
    tree = overlaid(make_tree("ws", (), ()), {path: text.encode() for path, text in whole.items()})
    return read_workspace(tree, "ws", URDF_LIMIT, {})


def graph_of_actions(*actions: str, **files: str) -> LaunchGraph:
    """Return the graph of a launch file with these actions.

    `files` are in the folder config of the package, with _ in place of the point of their names.
    """
    further = {f"demo/config/{name.replace('_', '.')}": text for name, text in files.items()}
    path = "demo/launch/demo.launch.py"
    return open_files({path: launch_file(*actions), **further}).launch_graph(path)


def ends_of(node: GraphNode) -> list[tuple[str, str, str]]:
    """Return the kind, name and type of each end of a node."""
    return [(end.kind, end.name, end.type) for end in node.ends]
