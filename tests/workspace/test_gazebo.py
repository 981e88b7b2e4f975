"""A robot in Gazebo: its topics and sensors, bridges, the world that it is created in, and the time."""

import pytest

from grader.workspace.rules.names import Correction
from tests.workspace.carts import agreement_of, sure

pytestmark = pytest.mark.slow

_BRIDGE = """\
- {topic_name: clock, ros_type_name: rosgraph_msgs/msg/Clock, gz_type_name: gz.msgs.Clock, direction: GZ_TO_ROS}
- {topic_name: scan, ros_type_name: sensor_msgs/msg/LaserScan, gz_type_name: gz.msgs.LaserScan, direction: GZ_TO_ROS}
- {topic_name: imu, ros_type_name: sensor_msgs/msg/Imu, gz_type_name: gz.msgs.IMU, direction: GZ_TO_ROS}
- {topic_name: odom, ros_type_name: nav_msgs/msg/Odometry, gz_type_name: gz.msgs.Odometry, direction: GZ_TO_ROS}
- {topic_name: cmd_vel, ros_type_name: geometry_msgs/msg/Twist, gz_type_name: gz.msgs.Twist, direction: ROS_TO_GZ}
"""
_ROBOT = """\
<robot name="scout">
  <link name="base_link"/>
  <gazebo reference="base_link">
    <sensor name="lidar" type="gpu_lidar"><topic>scan</topic></sensor>
    <sensor name="imu" type="imu"><topic>imu</topic></sensor>
    <sensor name="bumper" type="custom"><topic>bumped</topic></sensor>
  </gazebo>
  <gazebo>
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <topic>cmd_vel</topic><odom_topic>/odom</odom_topic><tf_topic/>
    </plugin>
  </gazebo>
</robot>
"""
_WORLD = """\
<sdf version="1.10">
  <world name="arena">
    <plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
    <plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>
    <plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>
  </world>
</sdf>
"""
_LAUNCH = """\
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import Command, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("scout")
    robot = Command(["cat ", PathJoinSubstitution([share, "scout.urdf"])])
    return LaunchDescription([
        IncludeLaunchDescription(
            PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"]),
            launch_arguments={"gz_args": PathJoinSubstitution([share, "arena.sdf"])}.items()),
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{"robot_description": robot}]),
        Node(package="ros_gz_sim", executable="create", arguments=["-world", "arena", "-topic", "robot_description"]),
        Node(package="ros_gz_bridge", executable="parameter_bridge",
             parameters=[{"config_file": PathJoinSubstitution([share, "bridge.yaml"])}]),
        Node(package="scout", executable="drive.py", parameters=[{"use_sim_time": True}]),
    ])
"""
_DRIVE = """#!/usr/bin/env python3
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Drive(Node):
    def __init__(self):
        super().__init__("drive")
        self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", print, 10)


def main():
    rclpy.init()
    rclpy.spin(Drive())


main()
"""
_FILES = {
    "scout/models/shelf/model.sdf": '<sdf version="1.10"><model name="shelf"/></sdf>',
    "scout/bridge.yaml": _BRIDGE,
    "scout/scout.urdf": _ROBOT,
    "scout/arena.sdf": _WORLD,
    "scout/scout.launch.py": _LAUNCH,
    "scout/drive.py": _DRIVE,
    "scout/CMakeLists.txt": """\
cmake_minimum_required(VERSION 3.8)
project(scout)
find_package(ament_cmake REQUIRED)
install(FILES bridge.yaml scout.urdf arena.sdf scout.launch.py DESTINATION share/${PROJECT_NAME})
install(PROGRAMS drive.py DESTINATION lib/${PROJECT_NAME})
ament_package()
""",
    "scout/package.xml": """\
<package format="3">
  <name>scout</name><version>0.0.0</version><description>A scout.</description>
  <maintainer email="a@b.example">A</maintainer><license>Apache-2.0</license>
  <depend>rclpy</depend><depend>geometry_msgs</depend><depend>sensor_msgs</depend>
  <exec_depend>robot_state_publisher</exec_depend><exec_depend>ros_gz_sim</exec_depend>
  <exec_depend>ros_gz_bridge</exec_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
}
_EYE = (
    '<model name="scout"><link name="base_link"/><link name="post_link"><sensor name="eye" type="camera">'
    "<gz_frame_id>{}</gz_frame_id></sensor></link></model></world>"
)
_LASER = (
    "{topic_name: scan, ros_type_name: sensor_msgs/msg/LaserScan, gz_type_name: gz.msgs.LaserScan"
)
_INFO = (
    "- {topic_name: eye/image/camera_info, ros_type_name: sensor_msgs/msg/CameraInfo, "
    "gz_type_name: gz.msgs.CameraInfo, direction: GZ_TO_ROS}\n"
)
_AT_BRIDGE, _AT_ROBOT = "scout/bridge.yaml:2", "scout/scout.urdf:10"


def problems(*edits: tuple[str, str, str]) -> list[str]:
    """Return what certainly is wrong after edits: a file, a text in it, and a new one."""
    texts = dict(_FILES)
    for name, old, new in edits:
        assert old in texts[f"scout/{name}"]
        texts[f"scout/{name}"] = texts[f"scout/{name}"].replace(old, new)
    found = sure(agreement_of(texts))
    assert {it.family for it in found} <= {"topics", "programs", "files", "parameters", "frames"}
    return [it.message for it in found]


@pytest.mark.parametrize(
    ("edits", "message"),
    [
        (
            [("bridge.yaml", "gz.msgs.IMU", "gz.msgs.Imu")],
            "the bridge does not convert sensor_msgs/msg/Imu and gz.msgs.Imu; write gz.msgs.IMU",
        ),
        (
            [("bridge.yaml", "gz.msgs.IMU", "IMU")],
            "the bridge does not convert sensor_msgs/msg/Imu and IMU; write gz.msgs.IMU",
        ),
        (
            [("bridge.yaml", "gz_type_name: gz.msgs.IMU", "gz_type_name: ")],
            "the bridge does not convert sensor_msgs/msg/Imu and an empty type; write gz.msgs.IMU",
        ),
        (
            [("bridge.yaml", "sensor_msgs/msg/Imu", "sensor_msgs/msg/Image")],
            "the bridge does not convert sensor_msgs/msg/Image and gz.msgs.IMU; write sensor_msgs/msg/Imu",
        ),
        (
            [("bridge.yaml", "direction: ROS_TO_GZ}", "direction: ROS_TO_GZ")],
            ("this is not YAML: while parsing a flow mapping did not find expected ',' or '}'"),
        ),
        (
            [("bridge.yaml", "direction: ROS_TO_GZ", "direction: GZ_TO_ROS")],
            f"the topic cmd_vel is bridged GZ_TO_ROS, but Gazebo reads it ({_AT_ROBOT}): write ROS_TO_GZ",
        ),
        (
            [
                (
                    "bridge.yaml",
                    "gz.msgs.Odometry, direction: GZ_TO_ROS",
                    "gz.msgs.Odometry, direction: ROS_TO_GZ",
                )
            ],
            f"the topic odom is bridged ROS_TO_GZ, but Gazebo publishes it ({_AT_ROBOT}): write GZ_TO_ROS",
        ),
        (
            [("bridge.yaml", "gz.msgs.Odometry,", "gz.msgs.OdometryWithCovariance,")],
            f"the topic odom of Gazebo has gz.msgs.Odometry ({_AT_ROBOT}), not gz.msgs.OdometryWithCovariance",
        ),
        (
            [
                (
                    "bridge.yaml",
                    _LASER,
                    _LASER.replace(
                        "{topic_name: scan", "{ros_topic_name: scan, gz_topic_name: lidar"
                    ),
                )
            ],
            "no sensor publishes 'lidar' in Gazebo; did you mean 'scan' (scout/scout.urdf:4)?",
        ),
        (
            [
                (
                    "bridge.yaml",
                    "{topic_name: cmd_vel",
                    "{ros_topic_name: cmd_vel, gz_topic_name: command",
                )
            ],
            f"nothing reads 'command' in Gazebo; did you mean 'cmd_vel' ({_AT_ROBOT})?",
        ),
        (
            [("bridge.yaml", _BRIDGE.splitlines(keepends=True)[0], "")],
            "drive.py waits for the time of the simulation, but no bridge takes clock from Gazebo",
        ),
        (
            [
                (
                    "arena.sdf",
                    '    <plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>\n',
                    "",
                )
            ],
            (
                "the world has no plugin gz::sim::systems::Sensors, so the sensor 'lidar' (scout/scout.urdf:4) publishes"
                " nothing"
            ),
        ),
        (
            [("scout.launch.py", '"-world", "arena"', '"-world", "empty"')],
            "the robot is created in the world 'empty', but the world of scout/arena.sdf is 'arena'",
        ),
        (
            [("scout.launch.py", '"-topic", "robot_description"', '"-topic", "robot"')],
            "the robot is created from /robot, but robot_state_publisher publishes /robot_description",
        ),
        (
            [
                (
                    "scout.launch.py",
                    'parameters=[{"config_file": PathJoinSubstitution([share, "bridge.yaml"])}]',
                    "name='b'",
                ),
                (
                    "drive.py",
                    '        self.create_subscription(LaserScan, "scan", print, 10)\n',
                    "",
                ),
            ],
            "the bridge has no topics: neither arguments, nor the parameter config_file",
        ),
        (
            [("bridge.yaml", "direction: ROS_TO_GZ", "direction: ROS_TO_G")],
            "the bridge leaves out the row: it has no direction 'ROS_TO_G'; did you mean ROS_TO_GZ?",
        ),
        (
            [("bridge.yaml", "gz_type_name: gz.msgs.IMU, ", "")],
            "the bridge leaves out the row: it has no gz_type_name",
        ),
        (
            [("bridge.yaml", "sensor_msgs/msg/Imu", "sensor_msgs/Imu")],
            "the bridge has no type 'sensor_msgs/Imu'; did you mean sensor_msgs/msg/Imu?",
        ),
        (
            [("bridge.yaml", "sensor_msgs/msg/Imu", "sensor_msgs/msg/IMU")],
            "the bridge has no type 'sensor_msgs/msg/IMU'; did you mean sensor_msgs/msg/Imu?",
        ),
        (
            [
                (
                    "scout.launch.py",
                    'executable="parameter_bridge",',
                    'executable="parameter_bridge", arguments=["clock", "a@b/msg/C[gz.msgs.D"],',
                )
            ],
            "the bridge ends with an error at the argument 'clock': write TOPIC@ROS_TYPE[GZ_TYPE",
        ),
        (
            [
                (
                    "scout.urdf",
                    "</gazebo>\n  <gazebo>",
                    '<sensor name="eye" type="camera"><topic>eye/image</topic></sensor></gazebo>\n  <gazebo>',
                ),
                ("bridge.yaml", "- {topic_name: odom", f"{_INFO}- {{topic_name: odom"),
            ],
            (
                "no sensor publishes 'eye/image/camera_info' in Gazebo; did you mean 'eye/camera_info'"
                " (scout/scout.urdf:7)?"
            ),
        ),
        (
            [("scout.launch.py", '"-topic", "robot_description"', '"-name", "scout"')],
            "create ends with an error: it needs -file, -param, -string or -topic",
        ),
        (
            [("drive.py", "LaserScan", "PointCloud2")],
            (
                "the topic /scan has sensor_msgs.msg.PointCloud2 here, but is published by the bridge with"
                f" sensor_msgs.msg.LaserScan ({_AT_BRIDGE})"
            ),
        ),
        (
            [("drive.py", "import Twist", "import TwistStamped as Twist")],
            (
                "the topic /cmd_vel has geometry_msgs.msg.TwistStamped here, but is subscribed to by the bridge with"
                " geometry_msgs.msg.Twist (scout/bridge.yaml:5)"
            ),
        ),
        (
            [
                (
                    "arena.sdf",
                    "  </world>",
                    "    <include><uri>model://shelv</uri></include>\n  </world>",
                )
            ],
            "there is no model 'shelv'; did you mean 'shelf'?",
        ),
        (
            [("arena.sdf", "  </world>", _EYE.format("base_lnik"))],
            "<gz_frame_id>: there is no frame 'base_lnik'; did you mean 'base_link' (scout/scout.urdf:2)?",
        ),
        (
            [("drive.py", "#!/usr/bin/env python3\n", "")],
            "Linux cannot execute drive.py: its first line is not #!/usr/bin/env python3",
        ),
        (
            [("drive.py", "python3\n", "python3\r\n")],
            "Linux cannot execute drive.py: its first line ends as on Windows, with CR LF",
        ),
        (
            [("CMakeLists.txt", "install(PROGRAMS drive.py", "install(FILES drive.py")],
            "a build installs 'drive.py' without the right to execute it: write install(PROGRAMS ...)",
        ),
    ],
)
def test_what_gazebo_does_not_do_is_named(edits: list[tuple[str, str, str]], message: str) -> None:
    """One mistake is one problem, and says what there is."""
    assert problems(*edits) == [message]


@pytest.mark.parametrize(
    "edits",
    [
        [],
        [("bridge.yaml", "direction: ROS_TO_GZ", "direction: BIDIRECTIONAL")],
        [("bridge.yaml", "gz.msgs.IMU", "ignition.msgs.IMU")],
        [("scout.launch.py", '"-world", "arena", ', "")],
        [("arena.sdf", "  </world>", _EYE.format("post_link"))],
        [("arena.sdf", "  </world>", _EYE.format("base_link"))],
        [("arena.sdf", "  </world>", _EYE.format("tower"))],
        [("arena.sdf", "  </world>", _EYE.format("base_lnik").replace('"base_link"', '"top"'))],
        [
            (
                "arena.sdf",
                "  </world>",
                "    <include><uri>model://shelf/model.sdf</uri></include>\n  </world>",
            )
        ],
        [("arena.sdf", "  </world>", "    <include><uri>model://sun</uri></include>\n  </world>")],
        [
            (
                "arena.sdf",
                "  </world>",
                "    <include><uri>https://fuel.example/shelve</uri></include>\n  </world>",
            )
        ],
        [("scout.launch.py", '"-topic", "robot_description"', '"-file", "/tmp/robot.sdf"')],
        [
            (
                "arena.sdf",
                '<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>',
                "",
            ),
            (
                "arena.sdf",
                '<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>',
                "",
            ),
            (
                "arena.sdf",
                '<plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>',
                "",
            ),
        ],
        [
            ("bridge.yaml", _BRIDGE.splitlines(keepends=True)[0], ""),
            ("scout.launch.py", '"use_sim_time": True', '"use_sim_time": False'),
        ],
        [
            ("bridge.yaml", _BRIDGE.splitlines(keepends=True)[0], ""),
            (
                "scout.launch.py",
                'FindPackageShare("ros_gz_sim"), "launch"',
                'FindPackageShare("other_sim"), "launch"',
            ),
        ],
        [
            (
                "bridge.yaml",
                "{topic_name: cmd_vel",
                "{ros_topic_name: cmd_vel, gz_topic_name: /model/scout/cmd_vel",
            )
        ],
        [
            (
                "CMakeLists.txt",
                "install(PROGRAMS drive.py",
                "install(FILES drive.py PERMISSIONS OWNER_EXECUTE",
            ),
            (
                "CMakeLists.txt",
                "PERMISSIONS OWNER_EXECUTE DESTINATION lib/${PROJECT_NAME}",
                "DESTINATION lib/${PROJECT_NAME} PERMISSIONS OWNER_READ OWNER_EXECUTE",
            ),
        ],
    ],
)
def test_what_agrees_or_is_not_known_is_no_problem(edits: list[tuple[str, str, str]]) -> None:
    """Worlds without systems get those of Gazebo; other packages may bridge the time."""
    assert problems(*edits) == []


@pytest.mark.parametrize(
    ("right", "wrong", "message"),
    [
        ("gz.msgs.IMU", "gz.msgs.Imu", "the bridge does not convert"),
        ("ROS_TO_GZ", "GZ_TO_ROS", "the topic cmd_vel is bridged GZ_TO_ROS"),
    ],
)
def test_what_is_wrong_is_shown_where_it_is_written(right: str, wrong: str, message: str) -> None:
    """Not at the topic, and with the right word; a launch file may also be one by its folder."""
    texts = {
        name: text.replace("scout.launch.py", "launch/scout.py") for name, text in _FILES.items()
    }
    texts["scout/launch/scout.py"] = texts.pop("scout/scout.launch.py")
    texts["scout/bridge.yaml"] = texts["scout/bridge.yaml"].replace(right, wrong)
    [found] = sure(agreement_of(texts))
    assert found.message.startswith(message)
    line = texts["scout/bridge.yaml"].splitlines()[found.location.line - 1]
    assert line[found.location.column - 1 :].startswith(wrong)
    assert found.corrections == (Correction(found.location, wrong, right),)


@pytest.mark.parametrize(
    ("old", "new", "meant"),
    [
        ("gz.msgs.IMU", "gz.msgs.Imu", [("gz.msgs.Imu", "gz.msgs.IMU")]),
        (
            "sensor_msgs/msg/Imu",
            "sensor_msgs/msg/Image",
            [("sensor_msgs/msg/Image", "sensor_msgs/msg/Imu")],
        ),
        ("gz_type_name: gz.msgs.IMU", "gz_type_name: ", []),
    ],
)
def test_the_type_that_is_wrong_is_corrected(
    old: str, new: str, meant: list[tuple[str, str]]
) -> None:
    """That of ROS, if the topic of Gazebo has the other; an empty one has no place for the whole type."""
    texts = dict(_FILES)
    texts["scout/bridge.yaml"] = texts["scout/bridge.yaml"].replace(old, new)
    [found] = sure(agreement_of(texts))
    assert [(it.old, it.new) for it in found.corrections] == meant


def test_frames_of_odometry_exist() -> None:
    """A system publishes those that it names, or those below the name of the model that the robot is created as."""
    publisher = """Node(package="tf2_ros", executable="static_transform_publisher",
        arguments=["--frame-id", "PARENT", "--child-frame-id", "laser"]),"""
    named = _ROBOT.replace("<tf_topic/>", "<child_frame_id>carriage</child_frame_id>")
    cases = [
        ("scout/odom", _ROBOT, 0),
        ("scout/base_link", _ROBOT, 0),
        ("carriage", named, 0),
        ("carriage", _ROBOT, 1),
    ]
    for parent, robot, count in (*cases, ("rover/odom", _ROBOT, 1)):
        at = _LAUNCH.rindex("]")
        launch = _LAUNCH[:at] + publisher.replace("PARENT", parent) + _LAUNCH[at:]
        texts = {**_FILES, "scout/scout.urdf": robot, "scout/scout.launch.py": launch}
        found = [it.message for it in sure(agreement_of(texts)) if it.family == "frames"]
        assert len(found) == count, (parent, found)


def test_a_world_in_which_no_robot_is_created_needs_no_systems_for_it() -> None:
    """The robot's sensors need systems only where a launch file creates the robot."""
    world = ("arena.sdf", "Imu", "Other")
    assert len(problems(world)) == 1
    assert (
        problems(world, ("scout.launch.py", 'executable="create"', 'executable="gzserver"')) == []
    )


def test_options_that_create_does_not_have_are_named() -> None:
    """It ignores them, so each is a warning; negative numbers are no options, and a dash is an underscore."""
    given = '"-world", "arena", "-topic", "robot_description"'
    options = '"-x", "-1.0", "-allow-renaming", "-entity", "scout", "-nam", "a", "--ros-args", "-r", "a:=b"'
    launch = _LAUNCH.replace(given, f"{given}, {options}")
    assert launch != _LAUNCH
    found = agreement_of({**_FILES, "scout/scout.launch.py": launch})
    messages = [it.message for it in found.mismatches if it.rule.name == "create-option"]
    assert messages == [
        "create has no option -entity, and ignores it; did you mean -name?",
        "create has no option -nam, and ignores it; did you mean -name?",
    ]
    assert not any(it.is_certain for it in found.mismatches)
    unknown = _LAUNCH.replace(given, f"{given}, unknown(), '-entity'")
    mismatches = agreement_of({**_FILES, "scout/scout.launch.py": unknown}).mismatches
    assert [it for it in mismatches if it.rule.name == "create-option"] == []


_FRAMES = "<frame_id>odom</frame_id><child_frame_id>base_link</child_frame_id>"
_TRANSFORMS = (
    "- {topic_name: FROM, ros_type_name: tf2_msgs/msg/TFMessage, gz_type_name: gz.msgs.Pose_V, "
    "direction: GZ_TO_ROS}\n"
)
_EKF = 'Node(package="robot_localization", executable="ekf_node"),\n        Node(package="scout"'


def test_a_bridge_publishes_transforms_of_gazebo() -> None:
    """A filter beside a system of Gazebo whose transforms a bridge takes to /tf is a second owner."""

    def found(topic: str, frames: str = _FRAMES, remaps: str = "") -> list[str]:
        robot = _ROBOT.replace("<tf_topic/>", f"<tf_topic>/{topic}</tf_topic>{frames}")
        launch = _LAUNCH.replace('Node(package="scout"', _EKF)
        launch = launch.replace(
            'executable="parameter_bridge",', f'executable="parameter_bridge",{remaps}'
        )
        texts = {
            **_FILES,
            "scout/scout.urdf": robot,
            "scout/scout.launch.py": launch,
            "scout/bridge.yaml": _BRIDGE + _TRANSFORMS.replace("FROM", topic),
        }
        every = agreement_of(texts).mismatches
        return [it.message for it in every if it.family == "transforms"]

    message = (
        "ekf_node publishes the transform from 'odom' to 'base_link', and so does the system "
        "DiffDrive of Gazebo (scout/scout.urdf:9)"
    )
    assert found("tf") == found("odom/tf", remaps='remappings=[("/odom/tf", "/tf")],') == [message]
    assert found("odom/tf") == found("tf", "") == found("tf", _FRAMES, 'namespace="a",') == []


def test_a_sensor_without_a_topic_is_a_warning() -> None:
    """Gazebo makes a long name for it; a model that is not submitted may still publish the short one."""
    robot = _ROBOT.replace("<topic>imu</topic>", "")
    mismatches = agreement_of({**_FILES, "scout/scout.urdf": robot}).mismatches
    [found] = [it for it in mismatches if it.rule.name != "simulated-node"]
    assert found.message == (
        "nothing publishes 'imu' in Gazebo: the sensor 'imu' has no <topic> (scout/scout.urdf:5)"
    )
    assert not found.is_certain
