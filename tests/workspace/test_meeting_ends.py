"""Types of topics whose ends are opened by different kinds of nodes: own code, programs, controllers and bridges."""

import pytest

from tests.workspace.rovers import CONTROLLERS, HORN, LAUNCH, MORE, Edit, problems_of

_HORN = "Node(package='rover', executable='horn'),"
_SCANNER = (
    "Node(package='pointcloud_to_laserscan', executable='pointcloud_to_laserscan_node', "
    "remappings=[('cloud_in', 'cloud'), ('scan', 'drive')]),"
)
_TELEOP = (
    "Node(package='teleop_twist_keyboard', executable='teleop_twist_keyboard', "
    "remappings=[('cmd_vel', 'drive')], parameters=[{'stamped': VALUE}], prefix='xterm -e'),"
)
_BRIDGE = "Node(package='ros_gz_bridge', executable='parameter_bridge', arguments=['ROW']),"
_FILTER = (
    "Node(package='robot_localization', executable='ekf_node', parameters=[{'publish_tf': False}]),"
)
_STAMPED = (HORN, "Twist", "TwistStamped")
_LOCAL = "\njoint_state_broadcaster:\n  ros__parameters: {use_local_topics: true}\nwheels:\n  ros__"


def _with(more: str, *edits: Edit) -> list[Edit]:
    return [(LAUNCH, MORE, more), *edits]


def _heard(topic: str) -> Edit:
    return (HORN, "'drive'", f"'{topic}'")


WRONG: list[tuple[str, list[Edit]]] = [
    (
        (
            "REF007 rover/horn.py:9 the topic /drive is subscribed to with geometry_msgs.msg.Twist, but published "
            "with sensor_msgs.msg.LaserScan by pointcloud_to_laserscan_node (rover/launch/rover.launch.py:24)"
        ),
        _with(_SCANNER + _HORN),
    ),
    (
        (
            "REF007 rover/horn.py:9 the topic /drive is subscribed to with geometry_msgs.msg.TwistStamped, but "
            "published with geometry_msgs.msg.Twist by teleop_twist_keyboard (rover/launch/rover.launch.py:24)"
        ),
        _with(_TELEOP.replace("VALUE", "False") + _HORN, _STAMPED),
    ),
    (
        (
            "REF007 rover/horn.py:9 the topic /joint_states is subscribed to with geometry_msgs.msg.Twist, but "
            "published with sensor_msgs.msg.JointState (rover/config/controllers.yaml:4)"
        ),
        _with(_HORN, _heard("joint_states")),
    ),
    (
        (
            "REF007 launch/rover.launch.py:24 the topic /wheels/cmd_vel is published with geometry_msgs.msg.Twist, "
            "but the controller subscribes to it with geometry_msgs.msg.TwistStamped (rover/config/controllers.yaml:6)"
        ),
        _with(_BRIDGE.replace("ROW", "/wheels/cmd_vel@geometry_msgs/msg/Twist[gz.msgs.Twist")),
    ),
    (
        (
            "REF007 launch/rover.launch.py:24 the topic /odometry/filtered is subscribed to with geometry_msgs.msg.Twist, "
            "but published with nav_msgs.msg.Odometry by ekf_node (rover/launch/rover.launch.py:24)"
        ),
        _with(
            _FILTER
            + _BRIDGE.replace("ROW", "/odometry/filtered@geometry_msgs/msg/Twist]gz.msgs.Twist")
        ),
    ),
]


@pytest.mark.parametrize(("problem", "edits"), WRONG, ids=[row[0][:80] for row in WRONG])
def test_another_type_is_one_problem(problem: str, edits: list[Edit]) -> None:
    """It is named once, for each source of the two ends, and nothing else is reported."""
    assert problems_of(*edits) == [problem]


CORRECT: list[tuple[str, list[Edit]]] = [
    (
        "a program that its parameter fits",
        _with(_TELEOP.replace("VALUE", "True") + _HORN, _STAMPED),
    ),
    (
        "a parameter that is not known",
        _with(_TELEOP.replace("VALUE", "os.path.isdir('a')") + _HORN, _STAMPED),
    ),
    (
        "joint states below the name of the broadcaster",
        _with(_HORN, _heard("joint_states"), (CONTROLLERS, "\nwheels:\n  ros__", _LOCAL)),
    ),
]


@pytest.mark.parametrize(("name", "edits"), CORRECT, ids=[row[0] for row in CORRECT])
def test_what_fits_is_no_problem(name: str, edits: list[Edit]) -> None:
    """A parameter decides what is published."""
    assert problems_of(*edits) == [], name
