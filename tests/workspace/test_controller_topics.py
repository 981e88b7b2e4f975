"""Topics of controllers: their types, remappings of their process, and publishers that nothing subscribes to."""

import pytest

from grader.workspace.rules.names import Mismatch
from tests.workspace.carts import agreement_of, edited

pytestmark = pytest.mark.slow

_ALARM, _LAUNCH, _ROBOT_LAUNCH = (
    "cart_nodes/alarm.py",
    "launch/cart.launch.py",
    "launch/robot.launch.py",
)
_SPAWNER = 'Node(package="controller_manager", executable="spawner", arguments=["joint_state_broadcaster"]),'
_CONTROL = 'Node(package="controller_manager", executable="ros2_control_node", remappings=[("{}", "/cmd_vel")]),\n        '
_AT = "cart_bringup/config/controllers.yaml:6"
_STAMPED = "geometry_msgs.msg.TwistStamped"


def topic_problems(
    message: str,
    *more: tuple[str, str, str],
    old: str = "/wheel_controller/cmd_vel",
    topic: str = "cmd_vel",
) -> list[Mismatch]:
    """Return what is wrong with topics if the alarm sends velocities to the controller, with more edits."""
    publisher = f'self.declare_parameter("volume", 5)\n        self.create_publisher({message}, "{topic}", 10)'
    edits = (
        (_ALARM, 'self.declare_parameter("volume", 5)', publisher),
        (_ALARM, "import rclpy\n", f"import rclpy\nfrom geometry_msgs.msg import {message}\n"),
        (_ROBOT_LAUNCH, _SPAWNER, _CONTROL.format(old) + _SPAWNER),
        *more,
    )
    return [it for it in agreement_of(edited(*edits)).mismatches if it.family == "topics"]


def test_a_controller_gets_messages_of_its_type() -> None:
    """Stamped velocities agree with diff_drive_controller, by its full name or by the name below its own."""
    assert topic_problems("TwistStamped") == []
    assert topic_problems("TwistStamped", old="~/cmd_vel") == []
    assert topic_problems("TwistStamped", old="wheel_controller/cmd_vel") == []
    assert topic_problems("TwistStamped", old="/other", topic="/wheel_controller/cmd_vel") == []


@pytest.mark.parametrize(
    "rule", ["-r ~/cmd_vel:=/cmd_vel", "--ros-args --remap wheel_controller/cmd_vel:=cmd_vel"]
)
def test_a_spawner_remaps_the_topics_of_its_controllers(rule: str) -> None:
    """These arguments are for the nodes of the controllers alone."""
    old, new = (
        f'["wheel_controller", {more}"--param-file"'
        for more in ("", f'"--controller-ros-args", "{rule}", ')
    )
    assert topic_problems("TwistStamped", (_ROBOT_LAUNCH, old, new), old="/other") == []


def test_another_type_is_wrong_where_it_is_published() -> None:
    """Before Jazzy, a parameter lets the controller take unstamped velocities."""
    [found] = topic_problems("Twist")
    assert found.location.path == "cart_nodes/cart_nodes/alarm.py"
    assert found.is_certain
    assert found.message == (
        "the topic /cmd_vel is published with geometry_msgs.msg.Twist, but the controller subscribes to it with"
        f" {_STAMPED} ({_AT})"
    )
    older = (
        "config/controllers.yaml",
        "base_frame_id: base_link",
        "base_frame_id: base_link\n    use_stamped_vel: false",
    )
    assert topic_problems("Twist", older) == []


def test_a_controller_that_is_not_spawned_subscribes_to_nothing() -> None:
    """Nor does one whose process has remappings that are computed."""
    assert (
        topic_problems(
            "Twist", (_ROBOT_LAUNCH, '["wheel_controller"', '["joint_state_broadcaster"')
        )
        == []
    )
    assert topic_problems("Twist", old='" + name_of() + "') == []


def test_a_publisher_that_nothing_subscribes_to() -> None:
    """Without the remapping, the controller waits on its own topic; other nodes may subscribe, so it is a warning."""
    [found] = topic_problems("TwistStamped", old="/other")
    assert (found.message, found.is_certain) == (
        f"nothing subscribes to /cmd_vel; did you mean /wheel_controller/cmd_vel ({_AT})?",
        False,
    )
    assert topic_problems("TwistStamped", old="/other", topic="speed") == []
    assert topic_problems("Twist", old="/other") == []
