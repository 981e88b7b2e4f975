"""Topics and names of well-known programs, and gains of controllers: a mistake each, and what is right as well."""

import pytest

from tests.workspace.rovers import CONTROLLERS, LAUNCH, MORE, PILOT, ROBOT, Edit, problems_of

pytestmark = pytest.mark.slow

_EKF = "Node(package='robot_localization', executable='ekf_node', parameters=[{{'publish_tf': False, {}}}]),"
_CLOUD = (
    "Node(package='pointcloud_to_laserscan', executable='pointcloud_to_laserscan_node', "
    "remappings=[('cloud_in', '/drive')]), Node(package='rover', executable='pilot'),"
)
_AMCL = "Node(package='nav2_amcl', executable='amcl', remappings=[RULES]),"
_RVIZ = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/KIND
      Enabled: true
      Name: Where
      Topic: {Value: /drive}
  Global Options: {Fixed Frame: base_link}
"""
_LIFT = """\
    lifter:
      type: joint_trajectory_controller/JointTrajectoryController
    wheels:
"""
_SPAWN = "Node(package='controller_manager', executable='spawner', arguments=['lifter']),"


def _with(more: str, *edits: Edit) -> list[Edit]:
    return [(LAUNCH, MORE, more), *edits]


def _images(more: str) -> list[Edit]:
    return _with(
        more,
        (PILOT, "geometry_msgs.msg import Twist", "sensor_msgs.msg import Image"),
        (PILOT, "(Twist, ", "(Image, "),
        (PILOT, "publish(Twist())", "publish(Image())"),
    )


def _shown(kind: str) -> list[Edit]:
    return _with(
        "Node(package='rover', executable='pilot'),",
        ("config/rover.rviz", "", _RVIZ.replace("KIND", kind)),
    )


def _lifted(parameters: str, *, is_spawned: bool = True) -> list[Edit]:
    """Return a controller of the arm with some parameters."""
    section = f"lifter:\n  ros__parameters: {{joints: [lift], {parameters}}}\nwheels:\n  ros__"
    return _with(
        _SPAWN if is_spawned else "",
        (CONTROLLERS, "    wheels:\n", _LIFT),
        (CONTROLLERS, "\nwheels:\n  ros__", f"\n{section}"),
        (
            ROBOT,
            '"position">\n',
            (
                '"effort"/><command_interface name="velocity"/>\n'
                '      <command_interface name="position">\n'
            ),
        ),
    )


WRONG: list[tuple[str, list[Edit]]] = [
    (
        (
            "REF021 launch/rover.launch.py:24 pointcloud_to_laserscan_node reads /drive with "
            "sensor_msgs.msg.PointCloud2, but it is published with sensor_msgs.msg.Image "
            "(rover/rover/pilot.py:9)"
        ),
        _images(_CLOUD),
    ),
    (
        (
            "REF021 launch/rover.launch.py:24 imu0 reads /wheels/odom with sensor_msgs.msg.Imu, but it "
            "is published with nav_msgs.msg.Odometry (rover/config/controllers.yaml:6)"
        ),
        _with(_EKF.format("'imu0': '/wheels/odom'")),
    ),
    (
        (
            "REF021 launch/rover.launch.py:24 odom0 reads /odom, which nothing publishes; did you mean "
            "/wheels/odom (rover/config/controllers.yaml:6)?"
        ),
        _with(_EKF.format("'odom0': 'odom'")),
    ),
    (
        (
            "REF024 launch/rover.launch.py:24 amcl has no topic 'initial_pose', so its remapping does "
            "nothing; did you mean initialpose?"
        ),
        _with(_AMCL.replace("RULES", "('initial_pose', '/a'), ('/map', '/b'), ('__node', 'c')")),
    ),
    (
        (
            "REF021 config/rover.rviz:6 the display 'Where' reads geometry_msgs.msg.PoseStamped, but "
            "/drive is published with geometry_msgs.msg.Twist (rover/rover/pilot.py:9)"
        ),
        _shown("Pose"),
    ),
    (
        (
            "REF026 config/controllers.yaml:11 lifter commands the effort of 'lift' without gains, so "
            "it moves nothing: give it gains.lift.p"
        ),
        _lifted("command_interfaces: [effort]"),
    ),
    (
        (
            "REF026 config/controllers.yaml:11 lifter commands the velocity of 'lift' without gains, so "
            "it moves nothing: give it gains.lift.p"
        ),
        _lifted("command_interfaces: [velocity], gains: {lift: {p: 0.0}}"),
    ),
]


@pytest.mark.parametrize(("problem", "edits"), WRONG, ids=[it[0][:80] for it in WRONG])
def test_a_mistake_is_one_problem(problem: str, edits: list[Edit]) -> None:
    """It is named, and nothing else is reported."""
    assert problems_of(*edits) == [problem]


CORRECT: list[tuple[str, list[Edit]]] = [
    ("another topic of images", _images(_CLOUD.replace("'/drive'", "'/cloud'"))),
    ("the topic of the controller", _with(_EKF.format("'odom0': '/wheels/odom', 'two_d': 'odom'"))),
    (
        "a topic that another node may publish",
        _with(_EKF.format("'odom0': 'odom'") + "Node(package='driver', executable='driver'),"),
    ),
    (
        "a topic of Gazebo Classic",
        _with(
            _EKF.format("'odom0': 'odom'"),
            (
                ROBOT,
                "</robot>",
                '<gazebo><plugin filename="libgazebo_ros_p3d.so"/></gazebo></robot>',
            ),
        ),
    ),
    (
        "an input that is published",
        _with(
            _EKF.format("'odom0': 'odom'")
            + "Node(package='ros_gz_bridge', executable='parameter_bridge', arguments=["
            "'/odom@nav_msgs/msg/Odometry[gz.msgs.Odometry']),"
        ),
    ),
    ("an input without another topic", _with(_EKF.format("'imu0': 'imu'"))),
    ("names that the program has", _with(_AMCL.replace("RULES", "('initialpose', '/a')"))),
    ("both names", _with(_AMCL.replace("RULES", "('initialpose', '/a'), ('initial_pose', '/a')"))),
    ("a name of nothing", _with(_AMCL.replace("RULES", "('odometry', '/a')"))),
    ("a display of another topic", _shown("TF")),
    ("positions", _lifted("command_interfaces: [position]")),
    ("gains", _lifted("command_interfaces: [effort], gains: {lift: {p: 2.0}}")),
    (
        "velocities without a loop",
        _lifted("command_interfaces: [velocity], open_loop_control: true"),
    ),
    ("two interfaces", _lifted("command_interfaces: [effort, velocity]")),
    (
        "a controller that nothing starts",
        _lifted("command_interfaces: [effort]", is_spawned=False),
    ),
]


@pytest.mark.parametrize("edits", [it[1] for it in CORRECT], ids=[it[0] for it in CORRECT])
def test_what_fits_is_not_reported(edits: list[Edit]) -> None:
    """What is right, and what is not known."""
    found = [it.partition(" ")[0] for it in problems_of(*edits)]
    assert {"REF021", "REF024", "REF026"}.isdisjoint(found), problems_of(*edits)


def test_a_file_without_controllers_is_named() -> None:
    """The controller manager gets no type of what spawners start; with one it is the other file's mistake."""
    empty: list[Edit] = [
        (CONTROLLERS, "    joint_state_broadcaster:\n", ""),
        (CONTROLLERS, "      type: joint_state_broadcaster/JointStateBroadcaster\n", ""),
        (CONTROLLERS, "    wheels:\n      type: diff_drive_controller/DiffDriveController\n", ""),
    ]
    found = [it for it in problems_of(*empty) if "REF003" in it]
    assert found == [
        (
            "REF003 launch/rover.launch.py:17 no parameter file of the controller manager has the type of "
            "'joint_state_broadcaster' and 'wheels'"
        )
    ]
    assert [it for it in problems_of(*empty[:2]) if "no parameter file" in it] == []
    unread: Edit = (LAUNCH, "parameters=[controllers]", "parameters=[controllers, input()]")
    assert [it for it in problems_of(*empty, unread) if "REF003" in it] == []
    broken: Edit = ("config/other.yaml", "", "a: [\n")
    assert [it for it in problems_of(*empty, broken) if "REF003" in it] == []
