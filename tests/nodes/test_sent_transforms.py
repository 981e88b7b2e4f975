"""The transforms that nodes give to a broadcaster are known with parent and child, or open."""

import pytest

from grader.ros.nodes.node_facts import NodeFacts, NodeTransform
from tests.nodes.test_cpp_nodes import node_of as cpp_node_of
from tests.nodes.test_nodes import nodes_of

_CLASS = """
import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from std_msgs.msg import Header
from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster


class Odometry(Node):
    def __init__(self):
        super().__init__('odometry')
        self.declare_parameter('publish_tf', True)
        self.is_on = self.get_parameter('publish_tf').value
        self.sender = TransformBroadcaster(self)
        self.static = StaticTransformBroadcaster(self)
        self.kept = TransformStamped()
        self.kept.header.frame_id = 'map'
        self.kept.child_frame_id = 'odom'

    def step(self, message):
        t = TransformStamped()
{}


def main():
    rclpy.init()
    rclpy.spin(Odometry())
"""
_SET = "t.header.frame_id = 'odom'; t.child_frame_id = 'base'"
_SEND = "self.sender.sendTransform(t)"
_MADE = "u = TransformStamped(header=Header(frame_id='odom'), child_frame_id='base')"
_UNKNOWN = [(None, None)]
PYTHON = [
    (f"{_SET}\n{_SEND}", [("odom", "base")]),
    (f"{_SET}\nself.sender.sendTransform([t])", [("odom", "base")]),
    (f"{_SET}\nself.sender.sendTransform(transform=t)", [("odom", "base")]),
    ("self.sender.sendTransform([self.kept])", [("map", "odom")]),
    (
        f"{_MADE}\nself.sender.sendTransform(u)",
        [("odom", "base")],
    ),
    ("u = TransformStamped(child_frame_id='base')\nself.sender.sendTransform(u)", [(None, "base")]),
    (
        "for name in ['a', 'b']:\n    t.header.frame_id = 'odom'; t.child_frame_id = name\n    "
        + _SEND,
        [("odom", "a"), ("odom", "b")],
    ),
    (
        "for name in ['a', 'b']:\n    t.header.frame_id = name; t.child_frame_id = name\n    "
        + _SEND,
        _UNKNOWN,
    ),
    (
        f"{_SET}\n{_SEND}\nt.header.frame_id = 'base'; t.child_frame_id = 'arm'\n{_SEND}",
        [("odom", "base"), ("base", "arm")],
    ),
    (f"{_SET}\nif message:\n    t.child_frame_id = 'other'\n{_SEND}", [("odom", None)]),
    (f"{_SEND}\n{_SET}\nt.child_frame_id = 'arm'", [("odom", None)]),
    ("self.sender.sendTransform(made(message))", _UNKNOWN),
    ("self.sender.sendTransform(*message)", _UNKNOWN),
    (f"t.header = message.header\n{_SEND}", _UNKNOWN),
]


def frames(node: NodeFacts) -> list[tuple[str | None, str | None]]:
    """Return parent and child of the transforms of a node."""
    return [(sent.parent.name, sent.child.name) for sent in node.transforms]


def sent_by(statements: str) -> tuple[NodeTransform, ...]:
    """Return the transforms of a node in Python whose method has these statements."""
    indented = "".join(f"        {line}\n" for line in statements.splitlines())
    [node] = nodes_of(_CLASS.format(indented)).nodes
    return node.transforms


@pytest.mark.parametrize(("statements", "expected"), PYTHON)
def test_transforms_of_python(
    statements: str, expected: list[tuple[str | None, str | None]]
) -> None:
    """What a field is set to before it is sent counts, if nothing decides it at run time."""
    sent = sent_by(statements)
    assert [(each.parent.name, each.child.name) for each in sent] == expected


CONDITIONS = [
    (_SEND, False),
    (f"if message:\n    {_SEND}", False),
    (f"if self.is_on and message:\n    {_SEND}", True),
    (
        f"if not self.get_parameter('publish_tf').value:\n    return\nif message:\n    {_SEND}",
        False,
    ),
    (f"if self.get_parameter('publish_tf').value:\n    {_SEND}", True),
]


@pytest.mark.parametrize(("statements", "is_conditional"), CONDITIONS)
def test_a_parameter_may_switch_a_transform_off(statements: str, *, is_conditional: bool) -> None:
    """Another condition, as whether a message is there, holds sooner or later."""
    [sent] = sent_by(f"{_SET}\n{statements}")
    assert (sent.is_conditional, sent.is_static) == (is_conditional, False)


def test_a_static_broadcaster_is_known() -> None:
    """By the class that makes it."""
    [sent] = sent_by(f"{_SET}\nself.static.sendTransform(t)")
    assert sent.is_static


_STAMPED = "geometry_msgs::msg::TransformStamped t;"
_CPP_SET = 't.header.frame_id = "odom"; t.child_frame_id = "base";'
_CPP_SEND = "sender_->sendTransform(t);"
_CPP_MEMBERS = """
std::unique_ptr<tf2_ros::TransformBroadcaster> sender_;
std::shared_ptr<tf2_ros::StaticTransformBroadcaster> static_;
geometry_msgs::msg::TransformStamped kept_;
void set() { kept_.header.frame_id = "map"; kept_.child_frame_id = "odom"; }
"""
CPP = [
    (_STAMPED + _CPP_SET + _CPP_SEND, [("odom", "base")]),
    ("sender_->sendTransform(kept_);", [("map", "odom")]),
    (_STAMPED + _CPP_SET + 't.child_frame_id = "arm";' + _CPP_SEND, [("odom", None)]),
    (
        _STAMPED + 'fill(t.child_frame_id); t.header.frame_id = "odom";' + _CPP_SEND,
        [("odom", None)],
    ),
    ("sender_->sendTransform(made());", _UNKNOWN),
    ("sendTransform(kept_);", [("map", "odom")]),
]


@pytest.mark.parametrize(("statements", "expected"), CPP)
def test_transforms_of_cpp(statements: str, expected: list[tuple[str | None, str | None]]) -> None:
    """What is set once in the function counts, else what is set once elsewhere."""
    assert frames(cpp_node_of(statements, members=_CPP_MEMBERS)) == expected


CPP_CONDITIONS = [
    ("if (ready()) { %s }", False),
    ('if (get_parameter("publish_tf").as_bool()) { %s }', False),
    ('bool on = declare_parameter("publish_tf", true); if (on) { %s }', True),
]


@pytest.mark.parametrize(("statements", "is_conditional"), CPP_CONDITIONS)
def test_a_parameter_may_switch_a_transform_of_cpp_off(
    statements: str, *, is_conditional: bool
) -> None:
    """Where a variable has the value of the parameter."""
    [sent] = cpp_node_of(
        _STAMPED + _CPP_SET + statements % "static_->sendTransform(t);", members=_CPP_MEMBERS
    ).transforms
    assert (sent.is_conditional, sent.is_static) == (is_conditional, True)


_AT_1 = "(1.0, 0.0, 0.0)"
POSES = [
    (f"{_SET}\nt.transform.translation.x = 1.0\n{_SEND}", _AT_1),
    (f"{_SET}\n{_SEND}", "(0.0, 0.0, 0.0)"),
    (f"{_SET}\nt.transform.translation.x = message\n{_SEND}", ""),
    (f"{_SET}\nt.transform.translation.x += 1.0\n{_SEND}", ""),
    (f"{_SET}\nt.transform.translation = message\n{_SEND}", ""),
    (f"{_SET}\nself.fill(t)\n{_SEND}", ""),
    (f"{_SET}\nplace = t.transform.translation\nplace.x = 1.0\n{_SEND}", ""),
    (f"{_SET}\nt.transform.translation.x, other = 1.0, 2.0\n{_SEND}", ""),
    (f"{_SET}\nturn(t.transform.rotation)\n{_SEND}", ""),
    (f"{_SET}\nfill(t)\n{_SEND}", ""),
    (
        f"{_SET}\nt.transform.translation.x = 1.0\nprint(f'{{t}}', t.transform.translation.x)\n{_SEND}",
        _AT_1,
    ),
    (f"{_SET}\nt = message\n{_SEND}", ""),
    (f"u = made(1)\n{_SEND.replace('(t)', '(u)')}", ""),
    (
        "self.sender.sendTransform(TransformStamped(transform=Transform(translation=Vector3(x=1.0))))",
        _AT_1,
    ),
    ("self.sender.sendTransform(TransformStamped(transform=message))", ""),
    ("v = Vector3(x=1.0)\nself.sender.sendTransform(TransformStamped(transform=v))", ""),
    ("self.sender.sendTransform(TransformStamped(message))", ""),
    ("u = TransformStamped(transform=Transform())\nself.sender.sendTransform(u)", ""),
    ("self.sender.sendTransform(message)", ""),
]


@pytest.mark.parametrize(("statements", "place"), POSES)
def test_poses_of_python(statements: str, place: str) -> None:
    """Numbers that code sets are known, and nothing else."""
    [sent] = sent_by(statements)
    assert (str(sent.pose.translation) if sent.pose is not None else "") == place


def test_a_list_of_transforms() -> None:
    """What is added to it is sent, under the condition of the addition."""
    start = f"{_SET}\nu = TransformStamped()\nu.header.frame_id = 'base'\nu.child_frame_id = 'arm'"
    listed = (
        f"{start}\nall = [t]\nif self.is_on:\n    all.append(u)\nself.sender.sendTransform(all)"
    )
    sent = [(each.child.name, each.is_conditional) for each in sent_by(listed)]
    assert sent == [("base", False), ("arm", True)]
    for more, names in (("all.extend(message)", ["base", None]), ("all += message", [None])):
        text = f"{start}\nall = [t]\n{more}\nself.sender.sendTransform(all)"
        assert [each.child.name for each in sent_by(text)] == names


CPP_POSES = [
    ("t.transform.translation.x = 1.0;", _AT_1),
    ("t.transform.translation.x = 1; t.transform.rotation.w = 1.0;", _AT_1),
    ("t.transform.translation.x = 1.0; t.transform.translation.x = 2.0;", ""),
    ("t.transform.translation.x = reading();", ""),
    ("t.transform.translation = reading();", ""),
    ("fill(t); t.transform.translation.x = 1.0;", ""),
    ("auto & other = t;", ""),
    ("auto & place = t.transform.translation; place.x = 1.0;", ""),
    ("tf2::convert(turned, t.transform.rotation);", ""),
    ("t.transform.translation.set__x(1.0);", ""),
    ("t.transform.translation.x = 1.0; log(t.transform.translation.x, t.header.frame_id);", _AT_1),
]


@pytest.mark.parametrize(("statements", "place"), CPP_POSES)
def test_poses_of_cpp(statements: str, place: str) -> None:
    """Of a local variable that no function gets."""
    text = _STAMPED + _CPP_SET + statements + _CPP_SEND
    [sent] = cpp_node_of(text, members=_CPP_MEMBERS).transforms
    assert (str(sent.pose.translation) if sent.pose is not None else "") == place


def test_the_pose_of_a_member_of_cpp_is_not_known() -> None:
    """Any function may set it."""
    [sent] = cpp_node_of("sender_->sendTransform(kept_);", members=_CPP_MEMBERS).transforms
    assert sent.pose is None
