"""What escapes the reader is open: names that code, arguments and files of others may define."""

from collections.abc import Mapping

import pytest

from grader.base.problems import Problem
from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.workspace.opening.all_robots import read_workspace
from grader.workspace.opening.opened import OpenedWorkspace
from grader.workspace.rules.file_problems import listed_problems
from grader.workspace.rules.name_problems import name_problems

_MANIFEST = """\
<package format="3">
  <name>kit</name><version>0.1.0</version><description>A kit</description>
  <maintainer email="a@b.org">Ann</maintainer><license>MIT</license>
  <exec_depend>controller_manager</exec_depend><exec_depend>joint_trajectory_controller</exec_depend>
  <exec_depend>robot_state_publisher</exec_depend><exec_depend>xacro</exec_depend>
  <exec_depend>joint_state_publisher</exec_depend>
  <exec_depend>rclpy</exec_depend><exec_depend>ros_gz_bridge</exec_depend>
  <export><build_type>ament_python</build_type></export>
</package>
"""
_SETUP = """\
from glob import glob
from setuptools import setup
setup(
    name='kit', version='0.1.0', packages=['kit'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/kit']),
        ('share/kit', ['package.xml']),
        ('share/kit/launch', glob('launch/*')),
        ('share/kit/urdf', glob('urdf/*')),
        ('share/kit/config', glob('config/*')),
    ],
    entry_points={'console_scripts': ['mover = kit.mover:main']},
)
"""
_LAUNCH = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare('kit')
    robot = Command(['xacro ', PathJoinSubstitution([share, 'urdf', 'kit.urdf.xacro'])])
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': robot}]),
        Node(package='joint_state_publisher', executable='joint_state_publisher'),
        MORE
    ])
"""
_ROBOT = """\
<robot name="kit" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="tool" default="none"/> <xacro:property name="used" value="$(arg tool)"/>
  <link name="base"/><link name="arm"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  MORE
</robot>
"""
_CONTROL = """\
<ros2_control name="s" type="system"><hardware><plugin>mock_components/GenericSystem</plugin></hardware>
<joint name="shoulder">INTERFACES</joint></ros2_control>
"""
_MOVER = """\
import rclpy
from rclpy.node import Node


class Mover(Node):
    def __init__(self):
        super().__init__('mover')
        MORE


def main():
    rclpy.init()
    rclpy.spin(Mover())
"""
_MANAGER = (
    "Node(package='controller_manager', executable='ros2_control_node',"
    " parameters=[PathJoinSubstitution([share, 'config', 'control.yaml'])]),"
)
_CONTROLLER = """\
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters: {joints: [JOINT], command_interfaces: [INTERFACE], state_interfaces: [position]}
"""


def _kit(more: Mapping[str, str] = {}, **parts: str) -> OpenedWorkspace:
    """Return a workspace of the package kit with further files; `parts` fill its places MORE."""
    files = {
        "src/kit/package.xml": _MANIFEST,
        "src/kit/setup.py": _SETUP,
        "src/kit/setup.cfg": "[install]\ninstall_scripts=$base/lib/kit\n",
        "src/kit/resource/kit": "",
        "src/kit/kit/__init__.py": "",
        "src/kit/kit/mover.py": _MOVER.replace("MORE", parts.get("mover", "pass")),
        "src/kit/launch/kit.launch.py": _LAUNCH.replace("MORE", parts.get("launch", "")),
        "src/kit/urdf/kit.urdf.xacro": _ROBOT.replace("MORE", parts.get("robot", "")),
        **more,
    }
    tree = overlaid(make_tree("ws", (), ()), {path: text.encode() for path, text in files.items()})
    return read_workspace(tree, "ws", URDF_LIMIT, {})


def _names(kit: OpenedWorkspace) -> list[str]:
    """Return the problems of names, each with its code."""
    found: tuple[Problem, ...] = name_problems(kit.workspace)
    return [f"{it.code} {it.message}" for it in found]


def _started(parameters: str) -> str:
    return f"Node(package='kit', executable='mover', name='mover', parameters=[{parameters}]),"


@pytest.mark.parametrize(
    ("mover", "helper"),
    [
        ("declare = self.declare_parameter; declare('speed', 1.0)", ""),
        ("[*map(self.declare_parameter, ['speed'])]", ""),
        (
            "from kit.helper import Helper; h = Helper(); h.node = self; h.set_up()",
            "class Helper:\n    def set_up(self):\n        self.node.declare_parameter('speed', 1)\n",
        ),
    ],
)
def test_a_parameter_may_be_declared_by_another_name_of_the_method(mover: str, helper: str) -> None:
    """An alias and a helper that has the node may declare any parameter."""
    more = {"src/kit/kit/helper.py": helper}
    launch = _started("{'speed': 2.0}")
    assert _names(_kit(more, mover=mover, launch=launch)) == []
    [found] = _names(
        _kit(mover="self.declare_parameter('sped', 1.0); self.get_parameter('sped')", launch=launch)
    )
    assert found.startswith("REF004 the node 'mover': there is no parameter 'speed'")


@pytest.mark.parametrize(
    "interfaces",
    [
        '<command_interface name="$(arg tool)"/>',
        (
            '<command_interface name="position"/>'
            "<xacro:if value=\"${'$(arg tool)' == 'fast'}\">"
            '<command_interface name="velocity"/></xacro:if>'
        ),
    ],
)
def test_an_argument_may_choose_an_interface(interfaces: str) -> None:
    """A command interface that is computed, or stands under a condition, may be the one."""
    config = {
        "src/kit/config/control.yaml": _CONTROLLER.replace("JOINT", "shoulder").replace(
            "INTERFACE", "velocity"
        )
    }
    robot = _CONTROL.replace("INTERFACES", interfaces)
    assert _names(_kit(config, robot=robot, launch=_MANAGER)) == []
    robot = _CONTROL.replace("INTERFACES", '<command_interface name="position"/>')
    [found] = _names(_kit(config, robot=robot, launch=_MANAGER))
    assert found.startswith("REF003 arm_controller needs the command interface shoulder/velocity")


_FINGER = (
    '<link name="finger"/><joint name="NAME" type="prismatic"><parent link="arm"/>'
    '<child link="finger"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>'
)


@pytest.mark.parametrize(
    ("robot", "tool"),
    [
        (
            "<xacro:if value=\"${'$(arg tool)' == 'gripper'}\">" + _FINGER + "</xacro:if>",
            "",
        ),
        ('<xacro:include filename="$(arg tool)_tool.xacro"/>', "<robot>" + _FINGER + "</robot>"),
        (
            '<xacro:macro name="finger" params="side">'
            + _FINGER.replace("NAME", "${side}_slide")
            + '</xacro:macro><xacro:finger side="$(arg tool)"/>',
            "",
        ),
    ],
)
def test_an_argument_may_add_joints(robot: str, tool: str) -> None:
    """A joint of another value of an argument is no mistake: computed parts are a pattern."""
    joint = "gripper_slide"
    more = {
        "src/kit/config/control.yaml": _CONTROLLER.replace("JOINT", joint).replace(
            "INTERFACE", "position"
        )
    }
    empty = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"></robot>'
    more["src/kit/urdf/none_tool.xacro"] = empty
    if tool:
        more["src/kit/urdf/gripper_tool.xacro"] = tool.replace("NAME", joint)
    found = _names(_kit(more, robot=robot.replace("NAME", joint), launch=_MANAGER))
    assert not [it for it in found if joint in it]
    [found_without] = _names(_kit(more, launch=_MANAGER))[:1]
    assert found_without.startswith("REF002 arm_controller.joints: there is no joint")


def test_a_robot_of_another_package_may_have_any_joint() -> None:
    """Where a launch file loads a robot that is not there, no joint is certainly missing."""
    other = (
        "Node(package='robot_state_publisher', executable='robot_state_publisher', parameters=["
        "{'robot_description': Command(['xacro ', PathJoinSubstitution([FindPackageShare('other'),"
        " 'urdf', 'other.urdf.xacro'])])}]),"
    )
    config = {
        "src/kit/config/control.yaml": _CONTROLLER.replace("JOINT", "elbow").replace(
            "INTERFACE", "position"
        )
    }
    assert [it for it in _names(_kit(config, launch=_MANAGER + other)) if "REF002" in it] == []


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("src/kit/kit/paths.py", "path = f'{model}_tuning.yaml'"),
        ("src/kit/kit/paths.py", "path = model + '_tuning.yaml'"),
        ("src/kit/kit/paths.py", "path = '%s_tuning.yaml' % model"),
        ("src/kit/kit/paths.py", "path = '{}_tuning.yaml'.format(model)"),
        ("src/kit/kit/paths.py", "path = [LaunchConfiguration('model'), '_tuning.yaml']"),
        ("src/kit/kit/paths.py", "path = os.path.join(share, 'config', model + '.yaml')"),
        ("src/kit/kit/paths.py", "path = PathJoinSubstitution([share, 'config', model])"),
        ("src/kit/kit/paths.py", "name = 'config'\npath = share / name / model"),
        (
            "src/kit/launch/a.launch.xml",
            "<launch><let name='a' value='$(var m)_tuning.yaml'/></launch>",
        ),
        ("src/kit/src/a.cpp", 'auto path = model + "_tuning.yaml";'),
        ("README.md", "Edit small_tuning.yaml."),
        ("Dockerfile", "COPY small_tuning.yaml /"),
    ],
)
def test_a_text_may_make_the_name_of_a_file(path: str, text: str) -> None:
    """A file is used whose name a text makes of variables, also outside of packages."""
    config = {"src/kit/config/small_tuning.yaml": "a: 1"}
    assert [it for it in _names(_kit({**config, path: text})) if "REF010" in it] == []
    other = text.replace("_tuning", "_other").replace("config", "params").replace(".yaml'", ".txt'")
    if "README" not in path and "Dockerfile" not in path:
        found = _names(_kit({**config, path: other}))
        assert "REF010 no other file of the workspace names this file" in found


_BASE = _MANIFEST.replace(">kit<", ">base<")
_BASE_SETUP = (
    _SETUP.replace("'kit'", "'base'")
    .replace("/kit", "/base")
    .replace("['mover = kit.mover:main']", "[]")
)
_GUI = "Node(package='rqt_robot_steering', executable='rqt_robot_steering'),"
_INCLUDE = """\
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch_ros.substitutions import FindPackageShare
from launch.substitutions import PathJoinSubstitution


def generate_launch_description():
    return LaunchDescription([
        IncludeLaunchDescription(
            PathJoinSubstitution([FindPackageShare('kit'), 'launch', 'kit.launch.py'])),
    ])
"""


def test_the_package_of_a_launch_file_declares_what_it_starts() -> None:
    """A package that includes the launch file of another one declares that package alone."""
    more = {
        "src/base/package.xml": _BASE.replace("<export>", "<exec_depend>kit</exec_depend><export>"),
        "src/base/setup.py": _BASE_SETUP,
        "src/base/resource/base": "",
        "src/base/base/__init__.py": "",
        "src/base/launch/base.launch.py": _INCLUDE,
    }
    [found] = _names(_kit(more, launch=_GUI))
    assert found.startswith("REF008 package.xml of 'kit' does not declare 'rqt_robot_steering'")


def test_a_launch_file_under_another_name_is_one_mistake() -> None:
    """A build stops at the file that is not there; that the folder is not installed follows."""
    for named, codes in (("'launch/kit.launch.py'", []), ("'launch/kti.launch.py'", ["PKG012"])):
        setup = _SETUP.replace("glob('launch/*')", f"[{named}]")
        assert setup != _SETUP
        kit = _kit({"src/kit/setup.py": setup})
        found = [
            it.code for it in listed_problems(kit.workspace) if it.code in ("PKG012", "PKG022")
        ]
        assert found == codes


def test_a_dependency_within_export_does_not_count() -> None:
    """It is said where the dependency is."""
    exported = "<export><exec_depend>rqt_robot_steering</exec_depend>"
    manifest = _MANIFEST.replace("<export>", exported)
    [found] = _names(_kit({"src/kit/package.xml": manifest}, launch=_GUI))
    assert "is used here: <export> has it (line 8), where it has no effect" in found


def test_the_package_of_a_controller_need_not_be_the_start_of_its_type() -> None:
    """The gripper's controllers are those of gripper_controllers."""
    text = _CONTROLLER.replace(
        "joint_trajectory_controller/JointTrajectoryController",
        "position_controllers/GripperActionController",
    ).replace("joints: [JOINT]", "joint: shoulder")
    found = _names(_kit({"src/kit/config/control.yaml": text.replace("INTERFACE", "position")}))
    assert any("does not declare 'gripper_controllers'" in it for it in found)
    assert not any("'position_controllers'" in it for it in found)


def test_a_declared_package_has_controllers_of_its_own() -> None:
    """The type of a package that is not there is not compared with those of others."""
    text = _CONTROLLER.replace(
        "joint_trajectory_controller/Joint", "acme_controllers/ScaledJoint"
    ).replace("JOINT", "shoulder")
    more = {
        "src/kit/config/control.yaml": text.replace("INTERFACE", "position"),
        "src/kit/package.xml": _MANIFEST.replace(
            "<export>", "<exec_depend>acme_controllers</exec_depend><export>"
        ),
    }
    assert not any("no controller of the type" in it for it in _names(_kit(more)))


def test_an_action_of_a_controller_in_a_namespace_is_known() -> None:
    """The key of a parameter file may hold the namespace of a controller."""
    keys = _CONTROLLER.replace("controller_manager:", "left/controller_manager:").replace(
        "\narm_controller:", "\nleft/arm_controller:"
    )
    mover = (
        "from rclpy.action import ActionClient; from control_msgs.action import FollowJointTrajectory; "
        "self.c = ActionClient(self, FollowJointTrajectory, '/left/NAME/follow_joint_trajectory')"
    )
    text = keys.replace("JOINT", "shoulder").replace("INTERFACE", "position")
    more = {"src/kit/config/control.yaml": text}
    start = _MANAGER + _started("")

    def found_for(name: str) -> list[str]:
        kit = _kit(more, mover=mover.replace("NAME", name), launch=start)
        return [it for it in _names(kit) if "ActionClient" in it]

    assert found_for("arm_controller") == []
    [found] = found_for("arm_controler")
    assert found.startswith("REF003 ActionClient: there is no controller 'arm_controler'")


def test_a_file_of_opencv_is_no_yaml_of_ros() -> None:
    """OpenCV writes %YAML:1.0, which no node reads; another fault of YAML is reported."""
    for start, count in (("%YAML:1.0", 0), ("%YAML 1.0 2", 1)):
        kit = _kit({"src/kit/config/camera.yaml": f"{start}\n---\nfx: 1.0\n"})
        assert sum("this is not YAML" in it for it in _names(kit)) == count


_BRIDGE = """\
- ros_topic_name: imu
  gz_topic_name: NAME
  ros_type_name: sensor_msgs/msg/Imu
  gz_type_name: gz.msgs.IMU
  direction: GZ_TO_ROS
"""
_IMU = '<gazebo reference="base"><sensor name="imu" type="imu"><topic>kit/imu</topic></sensor></gazebo>'


@pytest.mark.parametrize(
    ("name", "parameters", "count"),
    [
        ("imu", "'use_sim_time': True", 1),
        ("imu", "'expand_gz_topic_names': True", 0),
        ("'{ns}/imu'", "'use_sim_time': True", 0),
    ],
)
def test_a_program_may_complete_the_topic_of_a_bridge(
    name: str, parameters: str, count: int
) -> None:
    """A name that a parameter expands, or a program fills in, is not compared with Gazebo's."""
    launch = (
        "Node(package='ros_gz_bridge', executable='parameter_bridge', parameters=[{'config_file': "
        f"PathJoinSubstitution([share, 'config', 'bridge.yaml']), {parameters}}}]),"
    )
    config = {"src/kit/config/bridge.yaml": _BRIDGE.replace("NAME", name)}
    found = _names(_kit(config, robot=_IMU, launch=launch))
    assert sum("no sensor publishes" in it for it in found) == count


def test_xacro_may_make_the_groups_of_a_robot() -> None:
    """Beside a description for MoveIt in xacro, no group is certainly missing."""
    group = '<robot name="kit"><group name="arm"><joint name="shoulder"/></group></robot>'
    more = {
        "src/kit/config/kit.srdf": group,
        "src/kit/config/kinematics.yaml": "hand: {kinematics_solver: a/B}",
    }
    assert any("there is no group 'hand'" in it for it in _names(_kit(more)))
    more["src/kit/config/hand.srdf.xacro"] = "<robot/>"
    assert not any("there is no group" in it for it in _names(_kit(more)))


def test_gazebo_may_have_joints_that_urdf_does_not() -> None:
    """A joint in <gazebo> is one for its plugins."""
    joint = '<gazebo><joint name="brace" type="ball"/></gazebo>'
    plugin = (
        '<gazebo><plugin name="p" filename="p.so"><joint_name>brace</joint_name></plugin></gazebo>'
    )
    assert _names(_kit(robot=joint + plugin)) == []
    [found] = _names(_kit(robot=plugin))
    assert found == "REF002 <joint_name>: there is no joint 'brace'"


def test_a_property_that_nothing_uses_needs_no_file() -> None:
    """The path in it is certainly wrong only where it is used."""
    written = '<xacro:property name="shape" value="$(find kit)/urdf/shape.yaml"/>'
    [found] = _names(_kit(robot=written))
    assert found.startswith("REF009 a build installs no share/kit/urdf/shape.yaml")
    used = '<xacro:property name="data" value="${xacro.load_yaml(shape)}"/>'
    assert any(it.startswith("REF001") for it in _names(_kit(robot=written + used)))


def test_what_is_not_known_of_a_robot_is_one_line() -> None:
    """Materials and links may be in the part that is not read."""
    robot = (
        '<xacro:include filename="$(find others)/a.xacro"/>'
        '<xacro:property name="a" value="$(find others)/b"/>'
        '<link name="${a}"><visual><geometry><box size="1 1 1"/></geometry>'
        '<material name="red"/></visual></link>'
    )
    kit = _kit(robot=robot)
    [one] = [it for it in kit.robots if it.path.endswith("kit.urdf.xacro")]
    problems = kit.find_problems(one)  # type: ignore[arg-type]
    assert [it.code for it in problems] == ["XACRO006"]
    assert "more place" in problems[0].message


def test_links_after_an_error_of_xacro_are_not_missing() -> None:
    """What xacro stops at may define them; only its own error is listed."""
    robot = (
        '<xacro:macro name="tip" params="a"><link name="tip"/></xacro:macro><xacro:tip b="1"/>'
        '<joint name="t" type="fixed"><parent link="tip"/><child link="base"/></joint>'
    )
    kit = _kit(robot=robot)
    problems = [it for one in kit.robots for it in kit.find_problems(one)]  # type: ignore[arg-type]
    assert {it.code for it in problems if it.severity == "error"} == {"XACRO003"}


def test_a_robot_has_the_defaults_of_its_arguments() -> None:
    """A value that a launch file computes is taken as the default of the argument."""
    robot = (
        '<xacro:arg name="mode" default="a"/><link name="$(arg mode)_tip"/>'
        '<joint name="t" type="fixed"><parent link="arm"/><child link="$(arg mode)_tip"/></joint>'
    )
    launch = _LAUNCH.replace(
        "'kit.urdf.xacro'])", "'kit.urdf.xacro']), ' mode:=', open('m').read()"
    )
    kit = _kit({"src/kit/launch/kit.launch.py": launch.replace("MORE", "")}, robot=robot)
    assert [len(it.robot.links) for it in kit.workspace.robots.known] == [3]


def test_a_part_without_a_name_is_no_robot() -> None:
    """A file of xacro that has no name, and that nothing includes, is a part."""
    kit = _kit({"src/kit/urdf/colours.xacro": "<robot><material name='m'/></robot>"})
    assert [it.path for it in kit.robots] == ["src/kit/urdf/kit.urdf.xacro"]


def test_a_build_may_need_what_git_has_not_fetched() -> None:
    """With the empty folder of a submodule, a stop of the build is not certain."""
    cmake = "cmake_minimum_required(VERSION 3.8)\nproject(low)\nadd_executable(a vendor/a.cpp)\n"
    files = {
        "low/package.xml": _MANIFEST.replace(">kit<", ">low<").replace(
            "ament_python", "ament_cmake"
        ),
        "low/CMakeLists.txt": cmake,
    }
    for folders, is_wrong in (((), True), (("low/vendor",), False)):
        tree = overlaid(
            make_tree("ws", (), folders), {path: text.encode() for path, text in files.items()}
        )
        kit = read_workspace(tree, "ws", URDF_LIMIT, {})
        assert any(it.code == "PKG012" for it in listed_problems(kit.workspace)) == is_wrong


def test_a_read_with_an_alternative_needs_no_declaration() -> None:
    """get_parameter stops for what is not declared, get_parameter_or does not."""
    launch = _started("")
    read = "self.get_parameterOR('speed')"
    assert _names(_kit(mover=read.replace("OR", "_or"), launch=launch)) == []
    [found] = _names(_kit(mover=read.replace("OR", ""), launch=launch))
    assert found.startswith("REF004 get_parameter: there is no parameter 'speed'")


def test_a_program_that_is_missing_is_named_once() -> None:
    """What the launch file cannot start is also a name that does not agree: one of both is said."""
    text = "<launch><node pkg='kit' exec='walker'/></launch>"
    kit = _kit({"src/kit/launch/walk.launch.xml": text})
    codes = [it.code for it in listed_problems(kit.workspace) if it.severity == "error"]
    assert codes == []
    [found] = _names(kit)
    assert found.startswith("REF006 the package 'kit' has no program 'walker'")


def test_a_place_that_several_robots_share_is_named_once() -> None:
    """The macro of two robots names a link that neither has."""
    part = (
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="paint">'
        '<gazebo reference="wheel"><mu1>1</mu1></gazebo></xacro:macro></robot>'
    )
    call = '<xacro:include filename="paint.xacro"/><xacro:paint/>'
    more = {
        "src/kit/urdf/paint.xacro": part,
        "src/kit/urdf/second.urdf.xacro": _ROBOT.replace("MORE", call).replace("kit", "second"),
    }
    found = [it for it in _names(_kit(more, robot=call)) if "no link 'wheel'" in it]
    assert len(found) == 1


_RAW = (
    '<robot name="raw" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:property name="a" value="0"/><link name="one"/><link name="two"/>'
    '<joint name="j" type="fixed"><parent link="one"/><child link="two"/>'
    '<origin rpy="${a} 0 0"/></joint></robot>'
)


@pytest.mark.parametrize("name", ["raw.xacro.urdf", "raw.urdf"])
def test_xacro_in_a_urdf_is_expanded_where_xacro_is_run(name: str) -> None:
    """The name says xacro, or a launch file runs it on a file of the folder."""
    [raw] = [it for it in _kit({f"src/kit/urdf/{name}": _RAW}).robots if "raw" in it.path]
    assert getattr(raw, "is_expanded", False)


def test_an_argument_may_choose_the_plugin_of_hardware() -> None:
    """Hardware whose plugin stands under a condition has one."""
    text = "<ros2_control name='s' type='system'><hardware>PLUGIN</hardware></ros2_control>"
    chosen = "<xacro:if value=\"${'$(arg tool)' == 'sim'}\"><plugin>a/B</plugin></xacro:if>"
    for plugin, codes in ((chosen, []), ("", ["URDF097"])):
        kit = _kit(robot=text.replace("PLUGIN", plugin))
        assert [it.code for one in kit.robots for it in kit.find_problems(one)] == codes  # type: ignore[arg-type]


def test_a_package_inside_another_one_is_not_built() -> None:
    """Colcon looks for no packages in a package; CMake installs its files with the folder."""
    outer = (
        "cmake_minimum_required(VERSION 3.8)\nproject(low)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY parts DESTINATION share/low)\nament_package()\n"
    )
    manifest = _MANIFEST.replace("ament_python", "ament_cmake")
    files = {
        "low/package.xml": manifest.replace(">kit<", ">low<"),
        "low/CMakeLists.txt": outer,
        "low/parts/old/package.xml": manifest.replace(">kit<", ">old<"),
        "low/parts/old/CMakeLists.txt": "project(old)\nadd_executable(a a.cpp)\n",
        "low/parts/old/config/a.yaml": "a: 1",
        "low/parts/old/launch/a.launch.py": _LAUNCH,
    }
    tree = overlaid(make_tree("ws", (), ()), {path: text.encode() for path, text in files.items()})
    low = read_workspace(tree, "ws", URDF_LIMIT, {})
    [package] = low.packages
    assert package.installed["share/low/parts/old/config/a.yaml"] == "parts/old/config/a.yaml"
    assert not any(it.code == "PKG012" for it in listed_problems(low.workspace))
    assert low.workspace.launches.files == ()


def test_a_file_that_an_argument_chooses_is_a_part() -> None:
    """What xacro includes by a computed name is no robot of its own."""
    include = '<xacro:property name="far" value="1"/><xacro:include filename="$(arg tool)_arm.urdf.xacro"/>'
    part = _ROBOT.replace("kit", "part").replace("MORE", '<link name="${far}"/>')
    kit = _kit({"src/kit/urdf/none_arm.urdf.xacro": part}, robot=include)
    assert [it.path for it in kit.robots] == ["src/kit/urdf/kit.urdf.xacro"]


def test_a_default_that_xacro_fails_at_is_not_assumed() -> None:
    """Where a launch file computes the value, a default that stops xacro leaves it open."""
    robot = '<xacro:arg name="model" default=""/><xacro:include filename="$(arg model).xacro"/>'
    launch = _LAUNCH.replace(
        "'kit.urdf.xacro'])", "'kit.urdf.xacro']), ' model:=', open('m').read()"
    )
    kit = _kit({"src/kit/launch/kit.launch.py": launch.replace("MORE", "")}, robot=robot)
    codes = {it.code for one in kit.robots for it in kit.find_problems(one)}  # type: ignore[arg-type]
    assert codes == {"XACRO006"}


def test_a_configuration_of_moveit_finds_files_by_their_usual_names() -> None:
    """A package that a builder of configurations is given needs no names of its files."""
    more = {
        "src/kit/config/small_tuning.yaml": "a: 1",
        "src/kit/package.xml": _MANIFEST,
        "demo/kit_demo.py": "from moveit_configs_utils import B\nB('arm', package_name='kit')\n",
    }
    assert not any("REF010" in it for it in _names(_kit(more)))
