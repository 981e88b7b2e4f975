"""Numbers that two files say of one thing, transforms, and companions: a mistake each, and what is right as well."""

import pytest

from tests.workspace.rovers import (
    CONTROLLERS,
    COSTMAP,
    HORN,
    LAUNCH,
    LIMITS,
    MORE,
    PILOT,
    ROBOT,
    Edit,
    problems_of,
)

pytestmark = pytest.mark.slow

_TF = "Node(package='tf2_ros', executable='static_transform_publisher', arguments=[{}]),"
_STATIC = _TF.format("'--frame-id', '{}', '--child-frame-id', '{}'")
_EKF = "Node(package='robot_localization', executable='ekf_node', name='ekf', parameters=[{{{}}}]),"
_TELEOP = (
    "Node(package='teleop_twist_keyboard', executable='teleop_twist_keyboard', "
    "remappings=[('cmd_vel', '/wheels/cmd_vel')], parameters=[{'stamped': STAMPED}], prefix='xterm -e'),"
)
_CLOCK = (
    "Node(package='ros_gz_bridge', executable='parameter_bridge', "
    "arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock']),"
)

_DIFF_DRIVE = """\
    left_wheel_names: [left_wheel_joint]
    right_wheel_names: [right_wheel_joint]
    wheel_separation: 0.3
    wheel_radius: 0.05
    publish_rate: 50.0
"""
_MECANUM = """\
      wheels_radius: 0.05
      sum_of_robot_center_projection_on_X_Y_axis: {}
"""
_SRDF = '<robot name="rover"></robot>\n'
_JOINTS = "Node(package='joint_state_publisher', executable='joint_state_publisher'),"
_BROADCASTER = """\
        Node(package='controller_manager', executable='spawner',
             arguments=['joint_state_broadcaster']),
"""
_STATES = """\
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
"""
_PUBLISHER = """\
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': robot}]),
"""
_PLUGIN = """\
  <gazebo>
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <left_joint>left_wheel_joint</left_joint>
      <right_joint>right_wheel_joint</right_joint>
      <wheel_separation>SEPARATION</wheel_separation>
      <wheel_radius>0.05</wheel_radius>
    </plugin>
  </gazebo>
</robot>
"""
_PILOT_NODE = "Node(package='rover', executable='pilot'), Node(package='rover', executable='horn'),"
_RVIZ = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/TF
      Enabled: true
      Name: TF
    - Class: rviz_default_plugins/TwistStamped
      Enabled: true
      Name: Where
      Topic: {Value: /drive, Reliability Policy: POLICY}
  Global Options: {Fixed Frame: base_link}
"""


def _with(more: str, *edits: Edit) -> list[Edit]:
    return [(LAUNCH, MORE, more), *edits]


def _teleop(stamped: str) -> list[Edit]:
    return _with(_TELEOP.replace("STAMPED", stamped))


def _gazebo(separation: str) -> list[Edit]:
    return [(ROBOT, "</robot>\n", _PLUGIN.replace("SEPARATION", separation))]


def _best_effort(policy: str) -> list[Edit]:
    return _with(
        _PILOT_NODE,
        (PILOT, "'drive', 10", "'drive', qos_profile_sensor_data"),
        (PILOT, "import Node\n", "import Node\nfrom rclpy.qos import qos_profile_sensor_data\n"),
        (HORN, "self.heard, 10", "self.heard, qos_profile_sensor_data"),
        (HORN, "import Node\n", "import Node\nfrom rclpy.qos import qos_profile_sensor_data\n"),
        ("config/rover.rviz", "", _RVIZ.replace("POLICY", policy)),
    )


WRONG: list[tuple[str, list[Edit]]] = [
    (
        (
            "REF017 config/controllers.yaml:12 wheel_separation is 0.6 m; the wheels of "
            "'left_wheel_joint' and 'right_wheel_joint' are apart by 0.3 m (0.28 to 0.32 m with the "
            "width of the wheels)"
        ),
        [(CONTROLLERS, "wheel_separation: 0.3", "wheel_separation: 0.6")],
    ),
    (
        (
            "REF018 config/controllers.yaml:12 wheel_separation is 0.4 m; the wheels of "
            "'left_wheel_joint' and 'right_wheel_joint' are apart by 0.3 m (0.28 to 0.32 m with the "
            "width of the wheels)"
        ),
        [(CONTROLLERS, "wheel_separation: 0.3", "wheel_separation: 0.4")],
    ),
    (
        (
            "REF018 config/controllers.yaml:13 wheel_radius is 0.1 m; the wheel of 'left_wheel_joint' "
            "has the radius 0.05 m"
        ),
        [(CONTROLLERS, "wheel_radius: 0.05", "wheel_radius: 0.1")],
    ),
    (
        (
            "REF028 config/joint_limits.yaml:4 'move_group' does not use lift.max_velocity: "
            "lift.has_velocity_limits is false (rover/config/joint_limits.yaml:3)"
        ),
        [
            (
                LIMITS,
                "has_velocity_limits: true\n    max_velocity: 1.5",
                "has_velocity_limits: false\n    max_velocity: 9.0",
            ),
            ("config/rover.srdf", _SRDF, _SRDF),
        ],
    ),
    (
        "REF017 config/controllers.yaml:13 wheel_radius is -0.05: a length is not negative",
        [(CONTROLLERS, "wheel_radius: 0.05", "wheel_radius: -0.05")],
    ),
    (
        (
            "REF017 config/controllers.yaml:10 left and right wheels are exchanged: "
            "'right_wheel_joint' is at y -0.15 m, 'left_wheel_joint' is at y 0.15 m in 'base_link'"
        ),
        [
            (CONTROLLERS, "left_wheel_names: [left", "left_wheel_names: [right"),
            (CONTROLLERS, "right_wheel_names: [right", "right_wheel_names: [left"),
        ],
    ),
    (
        (
            "REF018 config/controllers.yaml:10 a positive speed of 'left_wheel_joint' and "
            "'right_wheel_joint' drives toward -x of 'base_link': the axis should point to the left"
        ),
        [
            (
                ROBOT,
                '<axis xyz="0 1 0"/>\n    </joint>\n  </xacro',
                '<axis xyz="0 -1 0"/>\n    </joint>\n  </xacro',
            )
        ],
    ),
    (
        (
            "REF018 config/controllers.yaml:10 'left_wheel_joint' and 'right_wheel_joint' should turn "
            "about the axle from right to left, not about 1 0 0 in 'base_link'"
        ),
        [
            (
                ROBOT,
                '<axis xyz="0 1 0"/>\n    </joint>\n  </xacro',
                '<axis xyz="1 0 0"/>\n    </joint>\n  </xacro',
            )
        ],
    ),
    (
        (
            "REF018 config/controllers.yaml:10 the wheels of 'left_wheel_joint' and "
            "'right_wheel_joint' drive the robot toward -x of 'base_link': left and right are "
            "exchanged, and their axes point to the right"
        ),
        [
            (
                ROBOT,
                '<axis xyz="0 1 0"/>\n    </joint>\n  </xacro',
                '<axis xyz="0 -1 0"/>\n    </joint>\n  </xacro',
            ),
            (ROBOT, 'y="0.15"', 'y="-0.150"'),
            (ROBOT, 'y="-0.15"', 'y="0.15"'),
        ],
    ),
    (
        (
            "REF017 urdf/rover.urdf.xacro:58 wheel_separation is 0.15 m; the wheels of "
            "'left_wheel_joint' and 'right_wheel_joint' are apart by 0.3 m (0.28 to 0.32 m with the "
            "width of the wheels)"
        ),
        _gazebo("0.15"),
    ),
    (
        (
            "REF018 config/joint_limits.yaml:4 lift.max_velocity is 2.5; the joint 'lift' of the robot "
            "allows 2"
        ),
        [(LIMITS, "max_velocity: 1.5", "max_velocity: 2.5")],
    ),
    (
        (
            "REF018 urdf/rover.urdf.xacro:50 max of the command interface lift/position is 3; the "
            "joint 'lift' of the robot allows 1"
        ),
        [(ROBOT, '<param name="max">1<', '<param name="max">3<')],
    ),
    (
        (
            "REF018 urdf/rover.urdf.xacro:49 min of the command interface lift/position is -3; the "
            "joint 'lift' of the robot allows -1"
        ),
        [(ROBOT, '<param name="min">-1<', '<param name="min">-3<')],
    ),
    (
        (
            "REF018 config/controllers.yaml:14 wheels.publish_rate is 50 Hz; the controller manager "
            "updates its controllers 10 times a second"
        ),
        [(CONTROLLERS, "update_rate: 50", "update_rate: 10")],
    ),
    (
        (
            "REF018 config/costmap.yaml:13 scan.obstacle_max_range is 12 m; the lidar 'lidar' measures "
            "up to 8 m"
        ),
        [(COSTMAP, "max_range: 2.5", "max_range: 12.0")],
    ),
    (
        (
            "REF018 config/costmap.yaml:14 scan.expected_update_rate is 0.05 s; the lidar 'lidar' "
            "measures every 0.1 s"
        ),
        [(COSTMAP, "update_rate: 0.5", "update_rate: 0.05")],
    ),
    (
        (
            "REF018 config/costmap.yaml:5 local_costmap.robot_radius ends 0.1 m from 'base_link', "
            "where the link 'base_link' of the robot reaches 0.223 m"
        ),
        [(COSTMAP, "robot_radius: 0.25", "robot_radius: 0.1")],
    ),
    (
        (
            "REF018 config/costmap.yaml:5 local_costmap.footprint ends 0.1 m from 'base_link', where "
            "the link 'base_link' of the robot reaches 0.2 m"
        ),
        [
            (
                COSTMAP,
                "robot_radius: 0.25",
                'footprint: "[[0.1, 0.2], [0.1, -0.2], [-0.3, -0.2], [-0.3, 0.2]]"',
            )
        ],
    ),
    (
        (
            "REF018 launch/rover.launch.py:24 static_transform_publisher places 'laser' 141 mm and 0 "
            "degrees from where the joint 'laser_joint' of the robot places it"
        ),
        _with(_STATIC.format("base_link", "laser")),
    ),
    (
        (
            "REF019 launch/rover.launch.py:24 the frames 'laser' -> 'base_link' -> 'laser' are a "
            "cycle: tf2 has no transform of them"
        ),
        _with(
            _STATIC.format("laser", "base_link"),
            (CONTROLLERS, "publish_rate", "enable_odom_tf: false\n    publish_rate"),
        ),
    ),
    (
        (
            "REF019 launch/rover.launch.py:24 the quaternion of a static_transform_publisher is 0 0 0 "
            "0, which is no rotation: tf2 ignores the transform; without one it is 0 0 0 1"
        ),
        _with(_TF.format("'0', '0', '0', '0', '0', '0', '0', 'base_link', 'camera'")),
    ),
    (
        (
            "REF020 config/controllers.yaml:6 wheels publishes the transform from 'odom' to "
            "'base_link', and so does static_transform_publisher (rover/launch/rover.launch.py:24)"
        ),
        _with(_STATIC.format("odom", "base_link")),
    ),
    (
        (
            "REF020 config/controllers.yaml:6 wheels publishes the transform from 'odom' to "
            "'base_link', and so does ekf_node (rover/launch/rover.launch.py:24)"
        ),
        _with(_EKF.format("'publish_tf': True, 'odom0': '/wheels/odom'")),
    ),
    (
        (
            "REF019 config/controllers.yaml:15 wheels publishes 'laser' in 'odom', but the joint "
            "'laser_joint' of the robot places it in 'base_link': a frame has one parent"
        ),
        [(CONTROLLERS, "base_frame_id: base_link", "base_frame_id: laser")],
    ),
    (
        (
            "REF021 launch/rover.launch.py:24 joint_state_publisher and the controller "
            "'joint_state_broadcaster' both publish joint_states: the joints jump between their "
            "positions"
        ),
        _with(_JOINTS),
    ),
    (
        (
            "REF021 launch/rover.launch.py:15 nothing publishes joint_states, so the links of 3 moving "
            "joints such as 'left_wheel_joint' have no transform: start joint_state_publisher or a "
            "joint_state_broadcaster"
        ),
        [
            (LAUNCH, _BROADCASTER, ""),
            (CONTROLLERS, _STATES, ""),
        ],
    ),
    (
        (
            "REF021 launch/rover.launch.py:15 the controller manager waits for the topic "
            "robot_description, which nothing publishes: start robot_state_publisher"
        ),
        [(LAUNCH, _PUBLISHER, "")],
    ),
    (
        (
            "REF021 launch/rover.launch.py:24 two nodes are named /a: their parameters and services "
            "cannot be told apart; the other one is at rover/launch/rover.launch.py:24"
        ),
        _with("*[Node(package='rover', executable=it, name='a') for it in ('pilot', 'horn')],"),
    ),
    (
        (
            "REF021 launch/rover.launch.py:22 use_sim_time is true, but nothing publishes /clock: the "
            "time of the node stays 0"
        ),
        [(LAUNCH, "parameters=[costmap]", "parameters=[costmap, {'use_sim_time': True}]")],
    ),
    (
        (
            "REF021 launch/rover.launch.py:22 use_sim_time is true, but nothing publishes /clock: the "
            "time of the node stays 0"
        ),
        [
            (
                LAUNCH,
                "parameters=[costmap]",
                "parameters=[costmap, {'use_sim_time': True}]",  # as in a simulation
            ),
            (LAUNCH, MORE, "# a simulation in Gazebo has a clock"),
            (PILOT, "self.send)", "self.send)\n        self.get_clock()"),
        ],
    ),
    (
        (
            "REF021 launch/rover.launch.py:22 controller_server uses the time of the machine, but the "
            "simulation has its own clock (rover/launch/rover.launch.py:24): give the nodes "
            "use_sim_time"
        ),
        _with(_CLOCK),
    ),
    (
        (
            "REF021 rover/horn.py:9 /horn and /pilot both publish /drive: the robot obeys each in turn; "
            "twist_mux chooses one"
        ),
        _with(
            _PILOT_NODE,
            (
                HORN,
                "super().__init__('horn')\n",
                "super().__init__('horn')\n        self.create_publisher(Twist, 'drive', 10)\n",
            ),
        ),
    ),
    (
        (
            "REF021 rover/horn.py:9 the topic /camera/compressed carries "
            "sensor_msgs.msg.CompressedImage, and is subscribed to with sensor_msgs.msg.Image: "
            "subscribe to /camera, or with the other type"
        ),
        _with(
            _PILOT_NODE,
            (HORN, "Twist, 'drive'", "Image, 'camera/compressed'"),
            (HORN, "geometry_msgs.msg import Twist", "sensor_msgs.msg import Image"),
        ),
    ),
    (
        (
            "REF021 config/rover.rviz:9 the display 'Where' asks for reliable messages of /drive, "
            "which are published as best effort: it stays empty"
        ),
        _best_effort("Reliable"),
    ),
    (
        (
            "REF021 launch/rover.launch.py:24 teleop_twist_keyboard publishes /wheels/cmd_vel with "
            "geometry_msgs.msg.Twist, but the controller subscribes to it with "
            "geometry_msgs.msg.TwistStamped: set its parameter stamped"
        ),
        _teleop("False"),
    ),
    (
        (
            "REF004 config/controllers.yaml:8 the node /a/wheels gets nothing of 'wheels', which is "
            "the key of the node /wheels: write '/**/wheels', which matches any namespace"
        ),
        _with(
            "Node(package='rover', executable='pilot', name='wheels', namespace='a', parameters=[controllers]),"
        ),
    ),
    (
        "REF022 config/map.yaml:1 the path '/home/ann/map.pgm' is of one machine",
        [("config/map.yaml", "", "image: /home/ann/map.pgm\nresolution: 0.05\n")],
    ),
    (
        (
            "REF022 launch/rover.launch.py:24 the launch file ends with an error where the environment "
            "variable ROVER is not set: give it a default"
        ),
        _with("Node(package='rover', executable='pilot', name=os.environ['ROVER']),"),
    ),
]


@pytest.mark.parametrize(("problem", "edits"), WRONG, ids=[it[0][:70] for it in WRONG])
def test_a_mistake_is_one_problem(problem: str, edits: list[Edit]) -> None:
    """It is named with its place and both numbers, and nothing else is reported."""
    assert problems_of(*edits) == [problem]


_STAMPED: list[Edit] = _with(
    _PILOT_NODE,
    (PILOT, "import Twist\n", "import TwistStamped\n"),
    (PILOT, "(Twist, ", "(TwistStamped, "),
    (
        PILOT,
        "self.publisher.publish(Twist())",
        "message = TwistStamped()\n        message.header.frame_id = 'FRAME'\n        self.publisher.publish(message)",
    ),
    (HORN, "import Twist\n", "import TwistStamped\n"),
    (HORN, "(Twist, ", "(TwistStamped, "),
)
_UNSET: list[Edit] = [
    (
        PILOT,
        "super().__init__('pilot')\n",
        (
            "super().__init__('pilot')\n        self.declare_parameter('port', rclpy.Parameter.Type.STRING)\n"
            "        self.port = self.get_parameter('port').value\n"
        ),
    )
]


def _framed(frame: str) -> list[Edit]:
    return [(file, old, new.replace("FRAME", frame)) for file, old, new in _STAMPED]


CORRECT: list[tuple[str, list[Edit]]] = [
    ("the workspace as it is", []),
    ("a frame of the robot in a message", _framed("laser")),
    (
        "a parameter without a value that is given one",
        _with(
            "Node(package='rover', executable='pilot', parameters=[{'port': '/dev/a'}]),", *_UNSET
        ),
    ),
    (
        "a separation between the outer edges",
        [(CONTROLLERS, "separation: 0.3", "separation: 0.32")],
    ),
    (
        "a separation that is corrected",
        [
            (
                CONTROLLERS,
                "separation: 0.3",
                "separation: 0.4\n    wheel_separation_multiplier: 0.75",
            )
        ],
    ),
    (
        "a radius that an argument may change",
        [
            (ROBOT, 'value="0.05"', 'value="$(arg size)"'),
            (CONTROLLERS, "radius: 0.05", "radius: 0.1"),
        ],
    ),
    ("a plugin that agrees", _gazebo("0.3")),
    (
        "a limit that is not switched on, without MoveIt",
        [
            (
                LIMITS,
                "has_velocity_limits: true\n    max_velocity: 1.5",
                "has_velocity_limits: false\n    max_velocity: 9.0",
            )
        ],
    ),
    (
        "limits of a URDF that MoveIt does not read",
        [
            (LIMITS, "max_velocity: 1.5", "max_velocity: 1\n    max_effort: 5"),
            ("config/rover.srdf", _SRDF, _SRDF),
        ],
    ),
    (
        "a lower update rate than the default",
        [
            (CONTROLLERS, "    publish_rate: 50.0\n", ""),
            (CONTROLLERS, "update_rate: 50", "update_rate: 10"),
        ],
    ),
    (
        "a footprint around the robot",
        [
            (
                COSTMAP,
                "robot_radius: 0.25",
                'footprint: "[[0.3, 0.2], [0.3, -0.2], [-0.3, -0.2], [-0.3, 0.2]]"',
            )
        ],
    ),
    ("a static transform of its own", _with(_STATIC.format("base_link", "camera"))),
    (
        "a static transform that says what the joint says",
        _with(
            _TF.format(
                "'--x', '0.1', '--z', '0.1', '--frame-id', 'base_link', '--child-frame-id', 'laser'"
            )
        ),
    ),
    (
        "a filter in place of the controller",
        _with(
            _EKF.format("'publish_tf': True"),
            (CONTROLLERS, "publish_rate", "enable_odom_tf: false\n    publish_rate"),
        ),
    ),
    ("a filter that publishes no transform", _with(_EKF.format("'publish_tf': False"))),
    ("a filter of the map", _with(_EKF.format("'world_frame': 'map', 'map_frame': 'map'"))),
    (
        "joint states of some joints",
        _with(_JOINTS.replace("'),", "', parameters=[{'source_list': ['/a']}]),")),
    ),
    (
        "a name in two namespaces",
        _with(
            "*[Node(package='rover', executable='horn', name='a', namespace=it) for it in ('b', 'c')],"
        ),
    ),
    ("displays that ask for best effort", _best_effort("Best Effort")),
    ("stamped commands", _teleop("True")),
    (
        "the time of a simulation",
        _with(
            _CLOCK, (LAUNCH, "parameters=[costmap]", "parameters=[costmap, {'use_sim_time': True}]")
        ),
    ),
    (
        "robot_state_publisher without a clock",
        [(LAUNCH, "robot_description': robot", "robot_description': robot, 'use_sim_time': True")],
    ),
    (
        "a variable with a default",
        _with("Node(package='rover', executable='pilot', name=os.environ.get('ROVER', 'a')),"),
    ),
    (
        "a namespace that the file has",
        _with(
            "Node(package='rover', executable='pilot', name='wheels', namespace='a', parameters=[controllers]),",
            (CONTROLLERS, "wheels:\n  ros__parameters", "/**/wheels:\n  ros__parameters"),
        ),
    ),
]


@pytest.mark.parametrize("edits", [it[1] for it in CORRECT], ids=[it[0] for it in CORRECT])
def test_what_agrees_is_not_reported(edits: list[Edit]) -> None:
    """Another way to say the same, and what depends on something that is not known, is no problem."""
    assert problems_of(*edits) == []


_SIMULATED: Edit = (
    LAUNCH,
    "parameters=[costmap]",
    "parameters=[costmap, {'use_sim_time': True}]",
)
_INCLUDED = "IncludeLaunchDescription(PathJoinSubstitution([FindPackageShare('{}'), 'launch', 'a.launch.py'])),"
_IMPORTED: Edit = (
    LAUNCH,
    "from launch import LaunchDescription\n",
    (
        "from launch import LaunchDescription\n"
        "from launch.actions import ExecuteProcess, IncludeLaunchDescription\n"
    ),
)


@pytest.mark.parametrize(
    ("more", "has_clock"),
    [
        ("Node(package='webots_ros2_driver', executable='driver'),", True),
        ("Node(package='lidar_driver', executable='driver'),", False),
        ("ExecuteProcess(cmd=['fly', 'around']),", True),
        ("ExecuteProcess(cmd=['sleep', '1']),", False),
        ("ExecuteProcess(cmd=['gz', 'sim', '-r', 'empty.sdf']),", False),
        (_INCLUDED.format("some_robot"), True),
        (_INCLUDED.format("slam_toolbox").replace("a.launch.py", "online_async_launch.py"), False),
        (
            "Node(package='ros_gz_bridge', executable='parameter_bridge', arguments=[input()]),",
            True,
        ),
    ],
)
def test_a_clock_may_come_from_what_is_not_read(more: str, *, has_clock: bool) -> None:
    """A simulator, a command, or a launch file of another package may publish the time."""
    found = problems_of(*_with(more, _SIMULATED, _IMPORTED))
    assert any("/clock" in it for it in found) != has_clock, found


def test_a_page_or_a_program_may_publish_the_clock() -> None:
    """A page may tell people to start a simulation, and a program that is not started may be one."""
    page = ("README.md", "", "Start the simulation first.\n")
    program = ("rover/time.py", "", "from rosgraph_msgs.msg import Clock\n")
    for more in (page, program):
        assert not any("/clock" in it for it in problems_of(_SIMULATED, more))


def test_a_frame_of_a_message_exists() -> None:
    """A frame_id that no robot, transform or node defines is named with its line."""
    [problem] = problems_of(*_framed("lidar_frame"))
    assert problem == "REF002 rover/pilot.py:14 frame_id: there is no frame 'lidar_frame'"


def test_a_parameter_without_a_value_is_given_one() -> None:
    """A node that reads a parameter which has a type and no value stops, unless it is given one."""
    [problem] = problems_of(*_with("Node(package='rover', executable='pilot'),", *_UNSET))
    assert problem == (
        "REF004 launch/rover.launch.py:24 the node 'pilot' stops without a value of the parameter "
        "'port', which it declares without one (rover/rover/pilot.py:9)"
    )


def test_a_robot_with_too_many_parts_is_not_compared() -> None:
    """More wheels than a robot drives, and more links than a footprint is compared with, are open."""
    names = ", ".join(["left_wheel_joint"] * 20)
    wrong = (CONTROLLERS, "wheel_separation: 0.3", "wheel_separation: 0.4")
    many = (CONTROLLERS, "[left_wheel_joint]", f"[{names}]")
    assert problems_of(wrong) != []
    assert [it for it in problems_of(wrong, many) if "wheel_separation" in it] == []
    links = "".join(
        f'<link name="l{number}"/><joint name="j{number}" type="fixed">'
        f'<parent link="base_link"/><child link="l{number}"/></joint>'
        for number in range(300)
    )
    small = (COSTMAP, "robot_radius: 0.25", "robot_radius: 0.1")
    assert problems_of(small) != []
    assert problems_of(small, (ROBOT, "</robot>\n", f"{links}</robot>\n")) == []


@pytest.mark.parametrize(
    ("edits", "codes"),
    [
        ([("wheel_separation: 0.3", "wheel_separation: 0.6")], ["REF002", "REF017"]),
        (
            [
                ("right_wheel_names: [right_wheel_joint]", "right_wheel_names: [tmp]"),
                ("left_wheel_names: [left_weel_joint]", "left_wheel_names: [right_weel_joint]"),
                ("[tmp]", "[left_wheel_joint]"),
            ],
            ["REF017", "REF002"],
        ),
    ],
)
def test_a_misspelt_joint_hides_no_other_mistake(
    edits: list[tuple[str, str]], codes: list[str]
) -> None:
    """The numbers and sides of wheels are compared with the joint that is meant."""
    misspelt = ("[left_wheel_joint]", "[left_weel_joint]")
    found = problems_of(*[(CONTROLLERS, *edit) for edit in (misspelt, *edits)])
    assert [it.split()[0] for it in found] == codes


@pytest.mark.parametrize(
    ("total", "problems"),
    [
        ("0.25", []),
        (
            "0.7",
            [
                (
                    "REF018 config/controllers.yaml:16 "
                    "kinematics.sum_of_robot_center_projection_on_X_Y_axis is 0.7 m; half the track and half "
                    "the wheelbase of the robot together are 0.25 m (0.24 to 0.26 m with the width of the "
                    "wheels)"
                )
            ],
        ),
    ],
)
def test_the_sum_of_a_mecanum_drive_is_that_of_its_wheels(total: str, problems: list[str]) -> None:
    """The sum of half the wheelbase and half the track."""
    names = "".join(
        f"    {end}_{side}_wheel_command_joint_name: {end}_{side}_wheel_joint\n"
        for end in ("front", "rear")
        for side in ("left", "right")
    )
    wheels = "".join(
        f'  <xacro:wheel side="{end}_{side}" x="{x}" y="{y}"/>\n'
        for end, x in (("front", 0.1), ("rear", -0.1))
        for side, y in (("left", 0.15), ("right", -0.15))
    )
    found = problems_of(
        (ROBOT, 'params="side y"', 'params="side y x:=0"'),
        (ROBOT, 'xyz="0 ${y} 0"', 'xyz="${x} ${y} 0"'),
        (ROBOT, '  <link name="laser"/>\n', f'{wheels}  <link name="laser"/>\n'),
        (CONTROLLERS, "diff_drive_controller/DiffDrive", "mecanum_drive_controller/MecanumDrive"),
        (
            CONTROLLERS,
            _DIFF_DRIVE,
            f"{names}    kinematics:\n{_MECANUM.format(total)}",
        ),
    )
    assert found == problems
