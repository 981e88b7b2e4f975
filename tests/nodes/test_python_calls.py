"""Calls with arguments that Python does not bind, or that are exchanged: each stops the program."""

from collections.abc import Sequence

import pytest

from grader.base.element_edits import edited
from grader.ros.known.package_tables import call_signatures
from grader.ros.known.releases import Release
from tests.nodes.programs import slips_of

SCRIPT = """\
import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger
from tf2_ros import Buffer, TransformListener


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.talk = self.create_publisher(String, "talk", 10)
        self.create_subscription(String, "hear", self.hear, 10)
        self.create_timer(0.5, self.tick)
        self.reset = self.create_client(Trigger, "reset")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)

    def tick(self):
        self.talk.publish(String(data="on"))
        self.reset.call_async(Trigger.Request())

    def hear(self, message):
        self.buffer.lookup_transform("map", "base_link", rclpy.time.Time())


def main():
    rclpy.init()
    node = Talker()
    rclpy.spin(node)


if __name__ == "__main__":
    main()
"""
WRONG = [
    (
        'super().__init__("talker")',
        "super().__init__()",
        "super().__init__() lacks its argument node_name",
    ),
    (
        '(String, "talk", 10)',
        '(String, "talk")',
        "create_publisher() lacks its argument qos_profile",
    ),
    (
        '(String, "talk", 10)',
        '("talk", String, 10)',
        "create_publisher() gets msg_type and topic in the",
    ),
    ('(String, "talk", 10)', '("talk", 10)', "create_publisher() lacks its argument msg_type"),
    (
        '"hear", self.hear, 10)',
        '"hear", 10, self.hear)',
        "create_subscription() gets callback and qos_profile",
    ),
    (
        '"hear", self.hear, 10)',
        '"hear", self.hear)',
        "create_subscription() lacks its argument qos_profile",
    ),
    ('"hear", self.hear, 10)', '"hear", 10)', "create_subscription() lacks its argument callback"),
    ('(String, "hear", self.hear, 10)', "()", "create_subscription() lacks its argument msg_type"),
    (
        "(0.5, self.tick)",
        "(self.tick, 0.5)",
        "create_timer() gets timer_period_sec and callback in the",
    ),
    (
        "(0.5, self.tick)",
        "(self.tick, 1 / 20)",
        "create_timer() gets timer_period_sec and callback",
    ),
    (
        "(0.5, self.tick)",
        "(lambda: None, 0.5)",
        "create_timer() gets timer_period_sec and callback",
    ),
    ("(0.5, self.tick)", "(0.5)", "create_timer() lacks its argument callback"),
    (
        "(0.5, self.tick)",
        "(callback=self.tick)",
        "create_timer() lacks its argument timer_period_sec",
    ),
    ("(0.5, self.tick)", "(0.5, calback=self.tick)", "create_timer() has no argument calback"),
    ("(0.5, self.tick)", "(0.5, self.tick, callback=None)", "create_timer() gets callback twice"),
    (
        '(Trigger, "reset")',
        '("reset", Trigger)',
        "create_client() gets srv_type and srv_name in the",
    ),
    ('publish(String(data="on"))', "publish()", "publish() lacks its argument msg"),
    (
        '(String(data="on"))',
        '(String(data="on"), 10)',
        "publish() takes 1 argument without a name",
    ),
    ("(Trigger.Request())", "()", "call_async() lacks its argument request"),
    (
        "TransformListener(self.buffer, self)",
        "TransformListener(self.buffer)",
        "TransformListener() lacks",
    ),
    (", rclpy.time.Time())", ")", "lookup_transform() lacks its argument time"),
    (
        "rclpy.init()",
        "rclpy.init(None)",
        "rclpy.init() takes no argument without a name, and gets 1",
    ),
    ("rclpy.init()", "rclpy.init(arg=None, context=None)", "rclpy.init() has no argument arg"),
    ("rclpy.init()", "rclpy.init(seed=1, context=None)", "rclpy.init() has no argument seed"),
    ("rclpy.spin(node)", "rclpy.spin()", "rclpy.spin() lacks its argument node"),
]
RIGHT = [
    ("(0.5, self.tick)", "(callback=self.tick, timer_period_sec=0.5)"),
    ("(0.5, self.tick)", "(*pair)"),
    ("(0.5, self.tick)", "(**pair)"),
    ("(0.5, self.tick)", "(period, tick)"),
    ("(0.5, self.tick)", "(1.0 if rclpy.ok() else 0, self.tick)"),
    ("self.create_timer(0.5, self.tick)", "self.make(0.5)"),
    ("    def tick(self):", "    def create_timer(self):\n        pass\n\n    def tick(self):"),
    (
        "        self.create_timer(",
        "        if rclpy.ok():\n            self.create_timer(self.tick)\n        self.create_timer(",
    ),
    ("self.talk.publish(", "self.talk = None\n        self.talk.publish("),
    ("rclpy.spin(node)", "rclpy.spin(node, executor=None)"),
    ("rclpy.init()", "rclpy.init(args=None, signal_handler_options=None)"),
]


def reactions(text: str, releases: Sequence[Release] = ("jazzy",)) -> list[str]:
    """Return what stops a program; with its corrections, nothing does."""
    return [slip.reaction for slip in slips_of(text, releases)]


@pytest.mark.parametrize(("old", "new", "reaction"), WRONG)
def test_a_wrong_call_is_named(old: str, new: str, reaction: str) -> None:
    """It is the only slip, and its correction leaves none."""
    assert old in SCRIPT
    text = SCRIPT.replace(old, new)
    [slip] = slips_of(text, ["jazzy"])
    assert slip.reaction.startswith(reaction)
    corrected = edited(text, slip.location.path, slip.edits)
    assert corrected is not None
    assert reactions(corrected) == []


@pytest.mark.parametrize(("old", "new"), RIGHT)
def test_a_right_or_an_unknown_call_is_none(old: str, new: str) -> None:
    """Names, unpacked arguments, a method of its own and what may not run are no mistakes."""
    assert old in SCRIPT
    assert reactions(SCRIPT) == reactions(SCRIPT.replace(old, new)) == []


def test_a_release_decides_which_arguments_there_are() -> None:
    """What Humble does not have is wrong only there; a release that nobody read may have more."""
    text = SCRIPT.replace("(0.5, self.tick)", "(0.5, self.tick, autostart=False)")
    assert reactions(text) == reactions(text, ["humble", "jazzy"]) == []
    assert reactions(text, ["humble"]) == ["create_timer() has no argument autostart"]
    newer = SCRIPT.replace("(0.5, self.tick)", "(0.5, self.tick, delay=1)")
    assert reactions(newer, ["jazzy"]) == ["create_timer() has no argument delay"]
    assert reactions(newer, ["lyrical"]) == []


def test_each_signature_says_which_arguments_are_required() -> None:
    """The rows are words: names, with = where there is a default, and stars."""
    for name, row in call_signatures().items():
        for words in row.values():
            names = [word.strip("*=") for word in words.split()]
            assert len(set(names)) == len(names), name
            assert all(not word or word.isidentifier() for word in names), name
