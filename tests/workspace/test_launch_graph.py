"""The graph of a launch file has the nodes, ends, transforms and processes that run after a launch."""

from typing import Any

import pytest

from grader.base.errors import NotDecided
from grader.workspace.graph import started_graph
from grader.workspace.graph.launch_graph import (
    GraphEnd,
    LaunchGraph,
    connections_in,
    unconnected_ends,
)
from grader.workspace.graph.manual_ends import manual_ends
from grader.workspace.graph.message_ways import find_way
from grader.workspace.model.given_files import GivenFiles
from tests.workspace.launch_graphs import (
    CMAKE,
    EYE,
    MANIFEST,
    TALKER,
    ends_of,
    graph_of_actions,
    launch_file,
    open_files,
)

_STRING = "std_msgs/msg/String"


def labels(graph: LaunchGraph) -> list[str]:
    """Return the labels of the nodes."""
    return [node.label for node in graph.nodes]


def connected(graph: LaunchGraph) -> list[tuple[str, str, str, str]]:
    """Return the connections: from, name, to, fault."""
    return [
        (
            graph.nodes[each.from_node].label,
            each.name,
            graph.nodes[each.to_node].label,
            each.fault,
        )
        for each in connections_in(graph)
    ]


def test_own_nodes_have_names_types_and_parameters() -> None:
    """Remappings, namespaces and parameters that name a topic hold; a program may have two nodes."""
    graph = graph_of_actions(
        "Node(package='demo', executable='talker', name='t', namespace='left',"
        " parameters=[{'topic': 'news', 'rate': 10}], remappings=[('answer', '/reply')])",
        "Node(package='demo', executable='pair')",
    )
    assert labels(graph) == ["/left/t", "/first", "/second"]
    talker = graph.nodes[0]
    assert ends_of(talker) == [
        ("publisher", "/left/news", _STRING),
        ("subscription", "/reply", _STRING),
    ]
    assert (talker.program, talker.kind, talker.namespace) == ("demo/talker", "program", "/left")
    assert [(each.name, each.value) for each in talker.parameters] == [("topic", "news")]
    assert talker.ends[0].location.file_and_line == "demo/demo/talker.py:11"
    assert connected(graph) == [("/first", "/chatter", "/second", "")]
    assert [end.name for end in unconnected_ends(graph)] == ["/left/news", "/reply"]


def test_what_a_run_decides_is_said() -> None:
    """Of a condition, a namespace and a parameter."""
    graph = graph_of_actions(
        "Node(package='demo', executable='talker', condition=IfCondition(os.environ.get('X', '')))",
        "Node(package='demo', executable='talker', name='b', namespace=os.environ.get('N'),"
        " parameters=[{'topic': os.environ.get('T')}])",
        "Node(package='demo', executable='pair', condition=IfCondition('false'))",
    )
    first, second = graph.nodes
    assert first.doubt == "whether it is started is known only at run time"
    assert (second.name, second.label) == ("", "(demo/talker)")
    assert {end.name for end in second.ends} == {"*"}
    assert all(end.doubt for end in second.ends)
    assert [each.program for each in graph.not_started] == ["demo/pair"]
    assert connected(graph) == []


def test_code_that_is_not_read_may_open_more() -> None:
    """Of a program that the package does not have, and of a program without a row."""
    graph = graph_of_actions(
        "Node(package='demo', executable='absent', name='a')",
        "Node(package='unknown_package', executable='thing', name='b')",
    )
    assert [node.opens_more for node in graph.nodes] == [
        "the code of absent is not read",
        "what unknown_package/thing opens is not known",
    ]
    assert labels(graph) == ["/a", "/b"]


_PYTHON = """ComposableNodeContainer(
            name='head', namespace='', package='rclcpp_components', executable='component_container',
            composable_node_descriptions=[
                ComposableNode(package='eyes', plugin='eyes::Eye', name='left', namespace='face',
                               parameters=[{'gain': 2.0}], remappings=[('seen', 'view')]),
                ComposableNode(package='demo_nodes_cpp', plugin='demo_nodes_cpp::Talker'),
                ComposableNode(package='eyes', plugin=LaunchConfiguration('nothing')),
                ComposableNode(package='eyes', plugin='eyes::Eye', condition=IfCondition('false')),
            ])"""


def test_components_are_nodes_of_their_class() -> None:
    """With their names, remappings and parameters, in the process of their container."""
    graph = graph_of_actions(_PYTHON)
    assert labels(graph) == ["/head", "/face/left", "/talker", "(a component)"]
    container, own, known, unknown = graph.nodes
    assert (container.kind, own.kind) == ("container", "component")
    assert (own.inside, own.program) == ("/head", "eyes/eyes::Eye")
    assert ends_of(own) == [("publisher", "/face/view", _STRING)]
    assert own.ends[0].qos.reliability == "best_effort"
    assert [(each.name, each.value) for each in own.parameters] == [("gain", 2.0)]
    assert ends_of(known) == [("publisher", "/chatter", _STRING)]
    assert unknown.opens_more == "which class is loaded is not evaluated"
    assert graph.unread == ()


_XML = """<launch>
  <node_container pkg="rclcpp_components" exec="component_container" name="head" namespace="">
    <composable_node pkg="eyes" plugin="eyes::Eye" name="left" namespace="face">
      <param name="gain" value="2.0"/><remap from="seen" to="view"/>
    </composable_node>
  </node_container>
  <load_composable_node target="/head">
    <composable_node pkg="eyes" plugin="eyes::Eye" name="right"><remap from="$(env A)" to="b"/></composable_node>
  </load_composable_node>
</launch>
"""
_YAML = """launch:
- node_container:
    pkg: rclcpp_components
    exec: component_container
    name: head
    namespace: ''
    composable_node:
    - pkg: eyes
      plugin: eyes::Eye
      name: left
      namespace: face
      param:
      - {name: gain, value: 2.0}
      remap:
      - {from: seen, to: view}
"""


@pytest.mark.parametrize(("ending", "text"), [("xml", _XML), ("yaml", _YAML)])
def test_components_in_xml_and_yaml(ending: str, text: str) -> None:
    """They are the same nodes as in Python."""
    path = f"demo/launch/demo.launch.{ending}"
    graph = open_files({path: text}).launch_graph(path)
    assert labels(graph)[:2] == ["/head", "/face/left"]
    assert ends_of(graph.nodes[1]) == [("publisher", "/face/view", _STRING)]
    assert [(each.name, each.value) for each in graph.nodes[1].parameters] == [("gain", 2.0)]
    if ending == "xml":
        assert (graph.nodes[2].label, graph.nodes[2].inside) == ("/right", "/head")
        assert [end.doubt for end in graph.nodes[2].ends] == ["a part of its name is computed"]


def test_a_component_gets_what_is_set_for_all_nodes() -> None:
    """Remappings of SetRemap; a namespace that is not known leaves its ends open."""
    graph = graph_of_actions(
        "SetRemap('seen', '/all')",
        "LoadComposableNodes(target_container='/head', composable_node_descriptions=["
        "ComposableNode(package='eyes', plugin='eyes::Eye', name='a'),"
        "ComposableNode(package='eyes', plugin='eyes::Eye', namespace=os.environ.get('N'))])",
    )
    first, second = graph.nodes
    assert (first.inside, ends_of(first)) == ("/head", [("publisher", "/all", _STRING)])
    assert (second.name, second.ends[0].name) == ("", "*")


_CONTROLLERS = """\
controller_manager:
  ros__parameters:
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    drive: {type: diff_drive_controller/DiffDriveController}
    odd: {type: odd_package/OddController}
drive:
  ros__parameters: {publish_limited_velocity: true}
"""
_SPAWNER = (
    "Node(package='controller_manager', executable='spawner',"
    " arguments=['joint_state_broadcaster', 'drive', 'odd', 'absent'])"
)
_MANAGER = (
    "Node(package='controller_manager', executable='ros2_control_node',"
    " parameters=[os.path.join(share, 'config', 'c.yaml')],"
    " remappings=[('/drive/cmd_vel', '/cmd_vel')])"
)


def test_controllers_are_nodes_in_the_process_of_their_manager() -> None:
    """A spawner is a process that ends; what nothing defines, or has no row, is said."""
    graph = graph_of_actions(_MANAGER, _SPAWNER, c_yaml=_CONTROLLERS)
    assert labels(graph) == [
        "/controller_manager",
        "/joint_state_broadcaster",
        "/drive",
        "/odd",
        "/absent",
    ]
    assert [each.program for each in graph.processes] == ["controller_manager/spawner"]
    _, broadcaster, drive, odd, absent = graph.nodes
    assert ("publisher", "/joint_states", "sensor_msgs/msg/JointState") in ends_of(broadcaster)
    assert ends_of(drive) == [
        ("publisher", "/drive/odom", "nav_msgs/msg/Odometry"),
        ("subscription", "/cmd_vel", "geometry_msgs/msg/TwistStamped"),
        ("publisher", "/drive/cmd_vel_out", "geometry_msgs/msg/TwistStamped"),
    ]
    assert (drive.inside, drive.kind) == ("/controller_manager", "controller")
    assert odd.opens_more == "what odd_package/OddController opens is not known"
    assert absent.opens_more == "no file defines it"


def test_the_controller_manager_may_be_in_gazebo() -> None:
    """It is a node, too, though no program of the launch is it."""
    graph = graph_of_actions(_SPAWNER, c_yaml=_CONTROLLERS)
    assert labels(graph)[:2] == ["/controller_manager", "/joint_state_broadcaster"]
    assert graph.nodes[0].program == "the controller manager"


_RVIZ = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/LaserScan
      Enabled: true
      Topic: {Value: /scan}
    - Class: rviz_default_plugins/RobotModel
      Enabled: true
      Description Topic: {Value: /robot_description}
    - Class: rviz_default_plugins/Map
      Enabled: false
      Topic: {Value: /map}
  Global Options: {Fixed Frame: odom}
  Tools:
    - Class: rviz_default_plugins/Interact
    - Class: rviz_default_plugins/SetGoal
      Topic: /goal
    - Hide Inactive Objects: true
"""
_BRIDGE_ROWS = """\
- {ros_topic_name: scan, gz_topic_name: lidar, ros_type_name: sensor_msgs/msg/LaserScan,
   gz_type_name: gz.msgs.LaserScan, direction: GZ_TO_ROS}
"""


def test_displays_read_what_a_bridge_publishes() -> None:
    """A bridge says what is on the side of Gazebo; a display that is off reads nothing."""
    graph = graph_of_actions(
        "Node(package='ros_gz_bridge', executable='parameter_bridge',"
        " parameters=[{'config_file': os.path.join(share, 'config', 'b.yaml')}])",
        "Node(package='rviz2', executable='rviz2',"
        " arguments=['-d', os.path.join(share, 'config', 'v.rviz')])",
        b_yaml=_BRIDGE_ROWS,
        v_rviz=_RVIZ,
    )
    assert connected(graph) == [("/ros_gz_bridge", "/scan", "/rviz", "")]
    bridge, rviz = graph.nodes
    assert bridge.ends[0].note == "lidar of Gazebo (gz.msgs.LaserScan)"
    read = [end.name for end in rviz.ends if end.kind == "subscription"]
    assert read == ["/scan", "/robot_description"]
    assert [end.name for end in rviz.ends if end.kind == "publisher"] == ["/goal"]


def test_included_files_of_other_packages_start_their_nodes() -> None:
    """Those that have rows, with their remappings; parameters that name topics leave them open."""
    graph = graph_of_actions(
        *(
            f"IncludeLaunchDescription(PythonLaunchDescriptionSource(os.path.join("
            f"get_package_share_directory('{package}'), 'launch', '{file}')){condition})"
            for package, file, condition in (
                ("nav2_bringup", "navigation_launch.py", ""),
                ("ros_gz_sim", "gz_sim.launch.py", ""),
                ("turtlebot3_gazebo", "unknown.launch.py", ""),
                (
                    "slam_toolbox",
                    "online_async_launch.py",
                    ", condition=IfCondition(os.environ.get('X', ''))",
                ),
                (
                    "nav2_bringup",
                    "localization_launch.py",
                    ", condition=IfCondition('false')",
                ),
            )
        )
    )
    names = labels(graph)
    assert names[0] == "/controller_server"
    assert "/lifecycle_manager_navigation" in names
    assert "/amcl" not in names
    assert graph.nodes[-1].label == "/slam_toolbox"
    assert graph.nodes[-1].doubt
    assert [each.program for each in graph.processes] == ["ros_gz_sim/gazebo"]
    commands = [end for end in graph.nodes[0].ends if end.name == "/cmd_vel_nav"]
    assert [end.type for end in commands] == [
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/TwistStamped",
    ]
    assert all(end.doubt for end in commands)
    pairs = connected(graph)
    assert ("/controller_server", "/follow_path", "/bt_navigator", "") in pairs
    assert [each.reason for each in graph.unread] != []


_TOPICS = """\
twist_mux:
  ros__parameters:
    topics:
      joystick: {topic: joy_vel, timeout: 0.5, priority: 99}
"""
_LOCKS = """\
twist_mux:
  ros__parameters:
    locks:
      stop: {topic: safety_stop, timeout: 0.0, priority: 255}
"""
_MUX = (
    "IncludeLaunchDescription(PythonLaunchDescriptionSource(os.path.join("
    "get_package_share_directory('twist_mux'), 'launch', 'twist_mux_launch.py')),"
    " launch_arguments={%s}.items())"
)
_MUX_FILES = (
    "'config_topics': os.path.join(share, 'config', 'topics.yaml'),"
    " 'config_locks': os.path.join(share, 'config', 'locks.yaml')"
)


def mux_graph(arguments: str) -> LaunchGraph:
    """Return the graph of a launch file that includes that of twist_mux with these arguments."""
    return graph_of_actions(_MUX % arguments, topics_yaml=_TOPICS, locks_yaml=_LOCKS)


def test_arguments_name_files_and_topics_of_an_included_file() -> None:
    """twist_mux reads two parameter files, and an argument names the topic that it publishes."""
    graph = mux_graph(f"'cmd_vel_out': 'base/cmd_vel', {_MUX_FILES}")
    assert labels(graph) == ["/twist_mux", "/twist_marker", "/joystick_relay"]
    assert connected(graph) == [
        ("/twist_mux", "/base/cmd_vel", "/twist_marker", ""),
        ("/joystick_relay", "/joy_vel", "/twist_mux", ""),
    ]
    lock = ("subscription", "/safety_stop", "std_msgs/msg/Bool")
    assert lock in ends_of(graph.nodes[0])


def test_without_its_arguments_an_included_file_has_its_defaults() -> None:
    """Of the topic; what a parameter file that is not known decides is open."""
    arguments = "'config_topics': os.path.join(share, 'config', 'topics.yaml')"
    mux, marker, _ = mux_graph(arguments).nodes
    assert ("subscription", "/twist_mux/cmd_vel", "geometry_msgs/msg/Twist") in ends_of(marker)
    names = [end.name for end in mux.ends if not end.doubt]
    assert names == ["/diagnostics"]


def test_an_argument_that_is_not_known_leaves_a_topic_open() -> None:
    """Only of the nodes that it renames."""
    arguments = f"'cmd_vel_out': os.environ.get('OUT'), {_MUX_FILES}"
    mux, marker, relay = mux_graph(arguments).nodes
    for node in (mux, marker):
        assert [end for end in node.ends if not end.doubt] == []
    assert ("publisher", "/joy_vel", "geometry_msgs/msg/Twist") in ends_of(relay)
    assert [end for end in relay.ends if end.doubt] == []


def test_parameters_decide_what_a_program_opens() -> None:
    """Names, by one or many parameters, types, and whether something is opened at all."""
    graph = graph_of_actions(
        "Node(package='twist_mux', executable='twist_mux',"
        " parameters=[{'topics.a.topic': 'joy_vel', 'topics.b.topic': os.environ.get('B'),"
        " 'use_stamped': True}])",
        "Node(package='robot_localization', executable='ekf_node', name='ekf',"
        " parameters=[{'odom0': 'odom', 'imu0': ''}])",
        "Node(package='joy_teleop', executable='joy_teleop', parameters=[{"
        "'drive': {'topic_name': 'cmd_vel', 'interface_type': 'geometry_msgs/msg/Twist'},"
        "'other': {'topic_name': 'x'}}])",
        "Node(package='nav2_amcl', executable='amcl', parameters=['/no/such/file.yaml'])",
        "Node(package='diff', executable='x', name='y')",
        "Node(package='moveit_ros_move_group', executable='move_group', parameters=[{"
        "'moveit_simple_controller_manager': {'arm': {'action_ns': 'follow',"
        " 'type': 'FollowJointTrajectory'}}}])",
    )
    mux, ekf, joy, amcl, _, moveit = graph.nodes
    arm = ("action client", "/arm/follow", "control_msgs/action/FollowJointTrajectory")
    assert arm in ends_of(moveit)
    assert ("subscription", "/joy_vel", "geometry_msgs/msg/TwistStamped") in ends_of(mux)
    assert ("publisher", "/cmd_vel_out", "geometry_msgs/msg/Twist") not in ends_of(mux)
    assert [end.name for end in mux.ends if end.doubt] == ["/*"]
    assert ("subscription", "/odom", "nav_msgs/msg/Odometry") in ends_of(ekf)
    assert ("subscription", "/cmd_vel", "geometry_msgs/msg/Twist") not in ends_of(ekf)
    assert ("publisher", "/cmd_vel", "geometry_msgs/msg/Twist") in ends_of(joy)
    assert ("publisher", "/x", "") in ends_of(joy)
    assert {end.name for end in amcl.ends if end.doubt} == {"/scan", "/map"}


def test_conditions_that_are_not_known_leave_an_end_open() -> None:
    """A parameter whose value is not known, or a file that is not read."""
    graph = graph_of_actions(
        "Node(package='teleop_twist_joy', executable='teleop_node',"
        " parameters=[{'publish_stamped_twist': LaunchConfiguration('nothing')}])",
        "Node(package='robot_localization', executable='ekf_node', parameters=['/no/file.yaml'])",
    )
    teleop, ekf = graph.nodes
    commands = [end for end in teleop.ends if end.kind == "publisher"]
    assert [bool(end.doubt) for end in commands] == [True, True]
    assert [bool(end.doubt) for end in ekf.ends if end.name == "/accel/filtered"] == [True]


def test_a_namespace_that_is_not_known_leaves_names_open() -> None:
    """Of a known program: the end of its names is known, and a private one has its node's name open."""
    graph = graph_of_actions(
        "Node(package='turtlesim', executable='turtlesim_node', namespace=os.environ.get('N'))",
        "Node(package='nav2_map_server', executable='map_server', name=os.environ.get('N'))",
    )
    turtle, server = graph.nodes
    assert (turtle.name, turtle.ends[0].name) == ("", "/turtle1/pose")
    assert turtle.ends[0].doubt
    services = [end.name for end in server.ends if end.kind == "service"]
    assert services == ["/*/map", "/*/load_map"]


def test_transforms_and_processes() -> None:
    """Static transforms have their frames, and other commands are processes."""
    static = "Node(package='tf2_ros', executable='static_transform_publisher', arguments=[{}])"
    graph = graph_of_actions(
        static.format("'0', '0', '1', '0', '0', '0', 'map', 'odom'"),
        static.format("'0', '0', '1', '0', '0', '0', 'map', 'odom'"),
        static.format("'0', '0', '1', '0', '0', '0', 'odom', 'odom'"),
        "ExecuteProcess(cmd=['ls', '-l'])",
        "DeclareLaunchArgument('gui', default_value='true')",
    )
    [transform] = graph.transforms
    assert (transform.parent, transform.child) == ("map", "odom")
    assert (transform.is_static, transform.is_certain) == (True, True)
    assert [each.program for each in graph.processes] == ["ls -l"]
    assert graph.arguments == (("gui", "true"),)


@pytest.mark.parametrize(
    ("words", "topics"),
    [
        ("'-o', 'run', '/scan', 'odom'", ["/scan", "/odom"]),
        ("'--topics', '/scan', '--storage', 'mcap', '-a'", ["/scan"]),
        ("'-a', '--output', '/tmp/run'", None),
    ],
)
def test_a_command_that_records_is_a_node(words: str, topics: list[str] | None) -> None:
    """It subscribes to the topics that it names; one that names none is a process."""
    graph = graph_of_actions(f"ExecuteProcess(cmd=['ros2', 'bag', 'record', {words}])")
    recorders = [node for node in graph.nodes if node.name == "/rosbag2_recorder"]
    recorded = [[end.name for end in node.ends] for node in recorders]
    assert recorded == ([] if topics is None else [topics])
    assert len(graph.processes) == (1 if topics is None else 0)


def test_a_command_under_a_condition() -> None:
    """One that does not start is no node, and one that may start is one in doubt."""
    process = "ExecuteProcess(cmd=['ros2', 'bag', 'record', '/scan'], condition=IfCondition({}))"
    assert graph_of_actions(process.format("'false'")).nodes == ()
    [recorder] = graph_of_actions(process.format("EnvironmentVariable('RECORD')")).nodes
    assert recorder.doubt


def test_a_launch_file_that_cannot_be_read_says_why() -> None:
    """Its graph is empty."""
    path = "demo/launch/demo.launch.py"
    graph = open_files({path: "def generate_launch_description(:\n"}).launch_graph(path)
    assert graph.nodes == ()
    assert [each.location.line for each in graph.unread] == [1]
    long = open_files({path: "#" * 2_000_000}).launch_graph(path)
    assert len(long.unread) == 1


def test_an_unknown_action_is_said() -> None:
    """What it starts is not known."""
    graph = graph_of_actions("Node(package=os.environ.get('P'), executable='x')")
    assert graph.nodes == ()
    assert graph.unread[0].reason.startswith("the program of a node is not evaluated")


@pytest.mark.parametrize("name", ["opened_by_code", "read", "spawned_controllers", "transforms_in"])
def test_what_takes_too_much_work_is_left_open(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """The rest of the graph is there."""

    def fail(*_: Any, **__: Any) -> Any:
        raise NotDecided("too much", "too much")

    monkeypatch.setattr(GivenFiles if name == "read" else started_graph, name, fail)
    graph = graph_of_actions(
        "Node(package='demo', executable='talker')",
        "Node(package='turtlesim', executable='turtlesim_node')",
        _SPAWNER,
        "Node(package='tf2_ros', executable='static_transform_publisher',"
        " arguments=['0', '0', '1', '0', '0', '0', 'map', 'odom'])",
        c_yaml=_CONTROLLERS,
    )
    talker, turtle = graph.nodes[:2]
    assert (talker.opens_more != "") is (name in ("opened_by_code", "read"))
    assert ("more work" in turtle.opens_more) is (name == "read")
    assert ("/drive" in labels(graph)) is (name != "spawned_controllers")
    assert (graph.transforms == ()) is (name == "transforms_in")


def test_ends_of_other_types_and_qualities_do_not_connect() -> None:
    """The reason is said."""
    graph = graph_of_actions(
        "Node(package='usb_cam', executable='usb_cam_node_exe', remappings=[('image_raw', 'chatter')])",
        "Node(package='demo', executable='pair')",
        "LoadComposableNodes(target_container='/x', composable_node_descriptions=["
        "ComposableNode(package='eyes', plugin='eyes::Eye', remappings=[('seen', 'chatter')])])",
    )
    faults = {(source, target): fault for source, _, target, fault in connected(graph)}
    assert faults["/usb_cam", "/second"] == "sensor_msgs/msg/Image is not std_msgs/msg/String"
    assert faults["/eye", "/second"] == "best effort is offered, reliable is asked for"
    assert faults["/first", "/second"] == ""


def test_what_another_terminal_brings() -> None:
    """Teleoperation publishes what a robot reads with the same type."""
    graph = graph_of_actions("Node(package='turtlesim', executable='turtlesim_node')")
    brought = {end.name: programs for end, programs in manual_ends(unconnected_ends(graph))}
    assert brought["/turtle1/cmd_vel"] == ["turtlesim/turtle_teleop_key"]
    assert "/turtle1/pose" not in brought
    other = GraphEnd("subscription", "/turtle1/cmd_vel", "a/msg/B", graph.nodes[0].location)
    assert manual_ends([other]) == []


def test_the_launch_file_that_includes_most_is_the_first() -> None:
    """Included ones come last, and can be shown on their own; launch arguments hold."""
    include = (
        "IncludeLaunchDescription(PythonLaunchDescriptionSource("
        "os.path.join(share, 'launch', 'part.launch.py')))"
    )
    opened = open_files(
        {
            "demo/launch/all.launch.py": launch_file(include),
            "demo/launch/one.launch.py": launch_file("Node(package='demo', executable='pair')"),
            "demo/launch/part.launch.py": launch_file(
                "DeclareLaunchArgument('on', default_value='true')",
                "Node(package='demo', executable='talker',"
                " condition=IfCondition(LaunchConfiguration('on')))",
            ),
        }
    )
    paths = opened.launch_files()
    assert paths == [f"demo/launch/{name}.launch.py" for name in ("all", "one", "part")]
    assert [labels(opened.launch_graph(path)) for path in paths] == [
        ["/talker"],
        ["/first", "/second"],
        ["/talker"],
    ]
    off = opened.under({"on": "false"}).launch_graph(paths[2])
    assert (labels(off), [each.program for each in off.not_started]) == ([], ["demo/talker"])


_BRANCHES = """\
import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        if self.declare_parameter('loud', False).value:
            self.create_publisher(String, 'loud', 10)
        self.create_publisher(String, 'quiet', 10)


def main():
    rclpy.init()
    rclpy.spin(Talker())


if __name__ == '__main__':
    main()
"""
_EYE_WITH_BRANCH = """\
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
#include <std_msgs/msg/string.hpp>
namespace eyes {
class Eye : public rclcpp::Node {
public:
  explicit Eye(const rclcpp::NodeOptions & options) : Node("eye", options) {
    if (declare_parameter("loud", false)) {
      a_ = create_publisher<std_msgs::msg::String>("loud", 10);
    }
    b_ = create_publisher<std_msgs::msg::String>("quiet", 10);
  }
  rclcpp::Publisher<std_msgs::msg::String>::SharedPtr a_, b_;
};
}
RCLCPP_COMPONENTS_REGISTER_NODE(eyes::Eye)
"""


def test_what_a_condition_in_code_decides_is_not_certain() -> None:
    """In Python and in C++."""
    path = "demo/launch/demo.launch.py"
    text = launch_file(
        "Node(package='demo', executable='talker')",
        "LoadComposableNodes(target_container='/x', composable_node_descriptions=["
        "ComposableNode(package='eyes', plugin='eyes::Eye')])",
    )
    files = {path: text, "demo/demo/talker.py": _BRANCHES, "eyes/src/eye.cpp": _EYE_WITH_BRANCH}
    for node in open_files(files).launch_graph(path).nodes:
        doubts = {end.name: end.doubt for end in node.ends}
        assert doubts == {
            "/loud": "a condition in the code decides whether it is opened",
            "/quiet": "",
        }


def test_a_well_known_program_in_the_workspace_has_its_row() -> None:
    """Where its code is not read whole."""
    path = "joy/launch/demo.launch.py"
    eye = (
        EYE.replace("eyes", "joy")
        .replace("Eye", "Joy")
        .replace('declare_parameter("gain", 1.0);', "open_other(*this);")
    )
    files = {
        "joy/package.xml": MANIFEST.format(name="joy", build="ament_cmake"),
        "joy/CMakeLists.txt": CMAKE.replace("eyes", "joy").replace("::Eye", "::Joy"),
        "joy/src/eye.cpp": eye,
        path: launch_file(
            "LoadComposableNodes(target_container='/x', composable_node_descriptions=["
            "ComposableNode(package='joy', plugin='joy::Joy')])"
        ),
    }
    [node] = open_files(files).launch_graph(path).nodes
    assert node.opens_more
    assert ("publisher", "/joy", "sensor_msgs/msg/Joy") in ends_of(node)


def test_tf_has_no_end() -> None:
    """A node whose own code publishes it has its other topics only."""
    code = TALKER.replace("'answer'", "'/tf'")
    path = "demo/launch/demo.launch.py"
    text = launch_file(
        "Node(package='demo', executable='talker')",
        "Node(package='rviz2', executable='rviz2')",
    )
    other = "other/rviz/a.rviz"
    files = {path: text, "demo/demo/talker.py": code, other: _RVIZ}
    files["other/package.xml"] = MANIFEST.format(name="other", build="ament_cmake")
    graph = open_files(files).launch_graph(path)
    assert [end.name for end in graph.nodes[0].ends] == ["/chatter"]
    assert [end.kind for end in graph.nodes[1].ends] == ["publisher"] * 3


_ROBOT = """<?xml version="1.0"?>
<robot name="cart"><link name="base"/>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so">
      <ros><namespace>/demo</namespace><remapping>cmd_vel:=go</remapping><remapping>bad</remapping></ros>
      <publish_odom>true</publish_odom>
    </plugin>
    <plugin name="other" filename="libother.so"/>
  </gazebo>
  <gazebo reference="base">
    <sensor name="lidar" type="ray">
      <plugin name="laser" filename="libgazebo_ros_ray_sensor.so">
        <ros><remapping>~/out:=scan</remapping></ros>
        <output_type>sensor_msgs/LaserScan</output_type>
      </plugin>
    </sensor>
    <sensor name="eye" type="camera">
      <plugin name="eye_plugin" filename="libgazebo_ros_camera.so"><camera_name>eye</camera_name></plugin>
      <plugin filename="libgazebo_ros_camera.so"/>
    </sensor>
  </gazebo>
</robot>
"""
_GAZEBO = (
    "IncludeLaunchDescription(PythonLaunchDescriptionSource(os.path.join("
    "get_package_share_directory('gazebo_ros'), 'launch', 'gazebo.launch.py')))"
)
_SPAWN = "Node(package='gazebo_ros', executable='spawn_entity.py', arguments=['-topic', 'a'])"


@pytest.mark.parametrize(
    ("start", "is_certain"),
    [
        ((_GAZEBO, _SPAWN), True),
        ((_GAZEBO,), False),
        (("ExecuteProcess(cmd=['gzserver', 'a.world'])", _SPAWN), True),
    ],
)
def test_plugins_of_gazebo_classic_are_nodes(start: tuple[str, ...], is_certain: bool) -> None:
    """With their namespaces and remappings, and by what their elements switch on."""
    path = "demo/launch/demo.launch.py"
    files = {path: launch_file(*start), "demo/urdf/cart.urdf": _ROBOT}
    graph = open_files(files).launch_graph(path)
    plugins = [node for node in graph.nodes if node.program.startswith("gazebo_plugins/")]
    assert [node.name for node in plugins] == ["/demo/drive", "/laser", "/eye_plugin", ""]
    drive, laser, camera, unnamed = plugins
    assert ends_of(drive) == [
        ("subscription", "/demo/go", "geometry_msgs/msg/Twist"),
        ("publisher", "/demo/odom", "nav_msgs/msg/Odometry"),
    ]
    assert ends_of(laser) == [("publisher", "/scan", "sensor_msgs/msg/LaserScan")]
    assert [end.name for end in camera.ends] == ["/eye/image_raw", "/eye/camera_info"]
    assert unnamed.ends == ()
    assert all((node.doubt == "") is is_certain for node in plugins)
    other = open_files({path: launch_file(_SPAWN), "demo/urdf/cart.urdf": _ROBOT})
    assert [node.name for node in other.launch_graph(path).nodes] == []


def test_a_bridge_of_images_publishes_what_its_arguments_name() -> None:
    """Options are none of them."""
    graph = graph_of_actions(
        "Node(package='ros_gz_image', executable='image_bridge', arguments=['camera/image', '--x'])"
    )
    image = ("publisher", "/camera/image", "sensor_msgs/msg/Image")
    assert ends_of(graph.nodes[0]) == [image]


def test_rviz_in_a_namespace_that_is_not_known() -> None:
    """Its displays may read another topic; a file that is broken is none."""
    rviz = (
        "Node(package='rviz2', executable='rviz2', namespace=os.environ.get('N'),"
        " arguments=['-d', os.path.join(share, 'config', 'v.rviz')])"
    )
    [node] = graph_of_actions(rviz, v_rviz=_RVIZ).nodes
    assert [(end.name, bool(end.doubt)) for end in node.ends] == [
        ("/scan", True),
        ("/robot_description", True),
        ("/goal", True),
    ]
    [node] = graph_of_actions(rviz, v_rviz="{").nodes
    assert {end.kind for end in node.ends} == {"publisher"}


def test_many_nodes_on_one_topic() -> None:
    """Of very many connections the first are there, and it is said."""
    path = "demo/launch/demo.launch.py"
    nodes = "*[Node(package='demo', executable='talker', name=f'n{i}') for i in range(150)]"
    files = {path: launch_file(nodes), "demo/demo/talker.py": TALKER.replace("answer", "chatter")}
    graph = open_files(files).launch_graph(path)
    assert len(graph.nodes) == 150
    assert len(connections_in(graph)) == 10_000
    assert graph.unread[-1].reason == "it has more connections, of which the first are listed"
    assert unconnected_ends(graph) == []


_COSTMAPS = """
local_costmap:
  local_costmap:
    ros__parameters:
      plugins: [obstacle_layer]
      obstacle_layer:
        plugin: nav2_costmap_2d::ObstacleLayer
        observation_sources: front
        front: {topic: /front/scan, data_type: LaserScan}
global_costmap:
  global_costmap:
    ros__parameters:
      plugins: [static_layer]
      static_layer: {plugin: nav2_costmap_2d::StaticLayer}
"""
_NAVIGATION = (
    "IncludeLaunchDescription(PythonLaunchDescriptionSource(os.path.join("
    "get_package_share_directory('nav2_bringup'), 'launch', 'navigation_launch.py')),"
    " launch_arguments={%s}.items())"
)


def test_a_costmap_is_a_node_in_the_process_of_its_server() -> None:
    """It has its own parameters, of the file that the launch file of Nav2 is given."""
    given = "'params_file': os.path.join(share, 'config', 'c.yaml')"
    graph = graph_of_actions(_NAVIGATION % given, c_yaml=_COSTMAPS)
    by_label = {node.label: node for node in graph.nodes}
    local = by_label["/local_costmap/local_costmap"]
    assert local.inside == "/controller_server"
    assert ("subscription", "/front/scan", "sensor_msgs/msg/LaserScan") in ends_of(local)
    assert ("publisher", "/local_costmap/costmap", "nav_msgs/msg/OccupancyGrid") in ends_of(local)
    outer = by_label["/global_costmap/global_costmap"]
    assert ("subscription", "/map", "nav_msgs/msg/OccupancyGrid") in ends_of(outer)
    way = find_way(graph, "/map", "/plan")
    labels_of_way = [graph.nodes[number].label for number in way.nodes]
    assert labels_of_way == ["/global_costmap/global_costmap", "/planner_server"]
    assert (way.arrives, way.doubt) == (True, "")


def test_without_a_file_the_parameters_of_nav2_are_not_known() -> None:
    """So it is not certain which topics it reads."""
    graph = graph_of_actions(_NAVIGATION % "")
    way = find_way(graph, "/front/scan", "/cmd_vel_nav")
    assert way.arrives and "may open more" in way.doubt
