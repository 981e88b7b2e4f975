"""Components that launch files load, and the containers for them: what is wrong, and what may be right."""

import pytest

from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.workspace.opening.all_robots import read_workspace
from grader.workspace.rules.reading import read_agreement

pytestmark = pytest.mark.slow

_MANIFEST = """\
<package format="3">
  <name>eyes</name>
  <version>1.0.0</version>
  <description>Eyes</description>
  <maintainer email="a@example.org">A</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>rclcpp</depend>
  <depend>rclcpp_components</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
_CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project(eyes)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
find_package(rclcpp_components REQUIRED)
add_library(eye SHARED src/eye.cpp)
ament_target_dependencies(eye rclcpp rclcpp_components)
rclcpp_components_register_nodes(eye "eyes::Eye")
install(TARGETS eye DESTINATION lib)
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_package()
"""
_CODE = """\
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
namespace eyes {
class Eye : public rclcpp::Node {
public:
  explicit Eye(const rclcpp::NodeOptions & options) : Node("eye", options) {
    declare_parameter("rate", 5);
  }
};
}
RCLCPP_COMPONENTS_REGISTER_NODE(eyes::Eye)
"""
_PYTHON = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import ComposableNodeContainer, LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    head = ComposableNodeContainer(
        name='head', namespace='', package='rclcpp_components', executable='component_container',
        composable_node_descriptions=[
            ComposableNode(package='eyes', plugin='eyes::Eye', name='left'),
        ],
    )
    return LaunchDescription([
        DeclareLaunchArgument('box', default_value='head'),
        head,
        LoadComposableNodes(
            target_container='head',
            composable_node_descriptions=[ComposableNode(package='eyes', plugin='eyes::Eye')],
        ),
        # MORE
    ])
"""
_XML = """\
<launch>
  <node_container pkg="rclcpp_components" exec="component_container" name="head" namespace="">
    <composable_node pkg="eyes" plugin="eyes::Eye" name="left" if="true">
      <param name="rate" value="5"/>
      <extra_arg name="use_intra_process_comms" value="true"/>
    </composable_node>
  </node_container>
  <load_composable_node target="head">
    <composable_node pkg="eyes" plugin="eyes::Eye" name="right"/>
  </load_composable_node>
</launch>
"""
_YAML = """\
launch:
- node_container:
    pkg: rclcpp_components
    exec: component_container
    name: head
    namespace: ''
    composable_node:
    - pkg: eyes
      plugin: eyes::Eye
      name: left
- load_composable_node:
    target: head
    composable_node:
    - {pkg: eyes, plugin: 'eyes::Eye', name: right}
"""
_FILES = {
    "package.xml": _MANIFEST,
    "CMakeLists.txt": _CMAKE,
    "src/eye.cpp": _CODE,
    "launch/eyes.launch.py": _PYTHON,
    "launch/eyes.launch.xml": _XML,
    "launch/eyes.launch.yaml": _YAML,
}
_LAUNCH, _CMAKE_FILE = "launch/eyes.launch.py", "CMakeLists.txt"
_OWN = "plugin='eyes::Eye', name"
_NEAR = (
    "the package 'eyes' registers no component 'eyes::Eey'; did you mean 'eyes::Eye' "
    "(eyes/CMakeLists.txt:8)?"
)
_WAITS = "nothing starts a container {}, for which launch waits without end; /head is started at eyes/launch/eyes.launch.{}"
_LOADED = (
    "LoadComposableNodes(target_container={}, composable_node_descriptions=["
    "ComposableNode(package='eyes', plugin='eyes::Eye')]),"
)


def _found(*edits: tuple[str, str, str]) -> list[tuple[str, bool]]:
    """Return what is wrong with some texts replaced, and whether it certainly is."""
    files = dict(_FILES)
    for file, old, new in edits:
        assert files[file].count(old) == 1, (file, old)
        files[file] = files[file].replace(old, new)
    texts = {f"eyes/{path}": text.encode() for path, text in files.items()}
    tree = overlaid(make_tree("ws", (), ()), texts)
    workspace = read_workspace(tree, "ws", URDF_LIMIT, {}).workspace
    return [(it.message, it.is_certain) for it in read_agreement(workspace).mismatches]


def test_components_that_are_registered() -> None:
    """A plugin that CMake registers is right, in each language of launch files."""
    assert _found() == []


@pytest.mark.parametrize(
    ("file", "old"),
    [
        (_LAUNCH, _OWN),
        ("launch/eyes.launch.xml", 'plugin="eyes::Eye" name="left"'),
        ("launch/eyes.launch.yaml", "plugin: eyes::Eye\n"),
    ],
)
def test_a_plugin_with_another_name(file: str, old: str) -> None:
    """A plugin that the package does not register certainly is not loaded."""
    assert _found((file, old, old.replace("Eye", "Eey"))) == [(_NEAR, True)]


def test_plugins_that_nothing_registers() -> None:
    """The message says what the package registers, if anything."""
    other = "the package 'eyes' registers no component 'Lidar'; it registers eyes::Eye"
    assert _found((_LAUNCH, _OWN, "plugin='Lidar', name")) == [(other, True)]
    none = "the package 'eyes' registers no component 'eyes::Eye'; it registers none"
    registers = 'rclcpp_components_register_nodes(eye "eyes::Eye")'
    assert {*_found((_CMAKE_FILE, registers, ""))} == {(none, True)}


def test_plugins_that_cmake_computes() -> None:
    """Where CMake may register more, only a similar name is reported, as a warning."""
    computed = 'rclcpp_components_register_nodes(eye "eyes::Eye" ${MORE})'
    register = (_CMAKE_FILE, 'rclcpp_components_register_nodes(eye "eyes::Eye")', computed)
    assert _found(register, (_LAUNCH, _OWN, "plugin='Lidar', name")) == []
    assert _found(register, (_LAUNCH, _OWN, "plugin='eyes::Eey', name")) == [(_NEAR, False)]
    mentioned = (_CMAKE_FILE, "ament_package()", "own_register(eyes::Eey)\nament_package()")
    assert _found(mentioned, (_LAUNCH, _OWN, "plugin='eyes::Eey', name")) == []


@pytest.mark.parametrize(
    ("file", "old", "place"),
    [
        (_LAUNCH, "target_container='head'", "py:10"),
        ("launch/eyes.launch.xml", 'target="head"', "xml:2"),
        ("launch/eyes.launch.yaml", "target: head", "yaml:3"),
    ],
)
def test_a_container_that_nothing_starts(file: str, old: str, place: str) -> None:
    """Launch waits for a container that a fully known launch file does not start."""
    wrong = (_WAITS.format("/heads", place), False)
    assert _found((file, old, old.replace("head", "heads"))) == [wrong]


def test_a_container_in_a_namespace() -> None:
    """The name of a container is asked for without the namespace of the launch file."""
    edit = (_LAUNCH, "name='head', namespace=''", "name='head', namespace='robot'")
    [(message, is_certain)] = _found(edit)
    assert message.startswith("nothing starts a container /head, ")
    assert not is_certain


@pytest.mark.parametrize(
    "more",
    [
        _LOADED.format("head"),
        _LOADED.format("LaunchConfiguration('box')"),
        _LOADED.format("LaunchConfiguration('boxes')"),
        _LOADED.format("'box', condition=IfCondition('false')"),
        "Node(package='rclcpp_components', executable='component_container', name='arm'),"
        + _LOADED.format("'/arm'"),
        "Node(package='rclcpp_components', executable='component_container'),"
        + _LOADED.format("'/ComponentManager'"),
        "Node(package='arm_driver', executable='driver', name='arm')," + _LOADED.format("'arm'"),
        "IncludeLaunchDescription('/opt/ros/jazzy/share/arm/launch/arm.launch.py'),"
        + _LOADED.format("'arm'"),
        "ComposableNodeContainer(name=LaunchConfiguration('boxes'), namespace='', "
        "package='rclcpp_components', executable='component_container')," + _LOADED.format("'arm'"),
        _LOADED.format("'box'").replace("e')", "e', condition=IfCondition('false'))"),
    ],
)
def test_containers_that_may_be_there(more: str) -> None:
    """A container that is started, or that something not known may start, is not missing."""
    assert [it for it in _found((_LAUNCH, "# MORE", more)) if "container" in it[0]] == []


def test_a_launch_file_without_containers() -> None:
    """A person may start the container with another launch file: the names of all are open."""
    assert _found((_LAUNCH, "        head,\n", "")) == []
