"""What nodes in Python do wrong with actions is found, and what may be right is not."""

import pytest

from tests.nodes.test_nodes import nodes_of

_ACTION = """
import rclpy
from rclpy.action import ActionServer
from rclpy.node import Node
from example_interfaces.action import Fibonacci
class Look(Node):
    def __init__(self):
        super().__init__('look')
        ActionServer(self, Fibonacci, 'look', self.execute)
    def execute(self, goal):
        result = Fibonacci.Result()
"""
# The end of a function that executes a goal, and of which goals it sets no state.
ENDS = [
    ("return result", "its goal"),
    ("pass", ""),
    ("goal.succeed()\nreturn result", ""),
    ("keep(goal)\nreturn result", ""),
    (
        "if goal.x:\n    goal.canceled()\n    return result\nreturn result",
        "a goal that nobody cancels",
    ),
    ("if goal.x:\n    goal.canceled()\n    return result\ngoal.abort()\nreturn result", ""),
    ("try:\n    pass\nexcept ValueError:\n    goal.canceled()\n    return result", ""),
    (
        "match goal.x:\n    case 1:\n        return result\ngoal.canceled()",
        "a goal that nobody cancels",
    ),
    ("def inner():\n    return 1\ngoal.canceled()\nreturn result", ""),
]


@pytest.mark.parametrize(("end", "goals"), ENDS)
def test_goals_without_a_state(end: str, goals: str) -> None:
    """A function that executes goals sets the state of each one that it ends."""
    body = "".join(f"        {line}\n" for line in end.splitlines())
    faults = [fault for fault in nodes_of(_ACTION + body).faults if fault.rule == "goal-state"]
    said = [fault.message.partition(" of ")[2].partition(",")[0] for fault in faults]
    assert said == ([goals] if goals else [])


REJECTED = [
    ("return GoalResponse.REJECT", "answer", True),
    ("if request.order < 3:\n    return GoalResponse.REJECT\nreturn False", "answer", True),
    ("self.order = request.order", "answer", True),
    (
        "if request.order < 3:\n    return GoalResponse.REJECT\nreturn GoalResponse.ACCEPT",
        "answer",
        False,
    ),
    ("return self.decided(request)", "answer", False),
    ("raise NotImplementedError", "answer", False),
    ("def inner():\n    return 1\nreturn GoalResponse.REJECT", "answer", True),
    ("return await_(request)", "answer_later", False),
    ("return GoalResponse.REJECT", "other.answer", False),
    ("self.server.register_goal_callback(self.now)\nreturn GoalResponse.REJECT", "answer", False),
]


@pytest.mark.parametrize(("body", "given", "is_wrong"), REJECTED)
def test_a_server_that_rejects_each_goal(body: str, given: str, *, is_wrong: bool) -> None:
    """A function that never returns GoalResponse.ACCEPT rejects what it is asked."""
    statements = "".join(f"        {line}\n" for line in body.splitlines())
    text = (
        _ACTION.replace("self.execute", f"self.execute, goal_callback=self.{given}")
        + f"        goal.succeed()\n        return result\n    def answer(self, request):\n{statements}"
        + "    async def answer_later(self, request):\n        return GoalResponse.ACCEPT\n"
    )
    message = "answer() answers no goal with GoalResponse.ACCEPT, so rclpy rejects each, and executes none"
    messages = [fault.message for fault in nodes_of(text).faults if fault.rule == "goal-state"]
    assert messages == ([message] if is_wrong else [])


_LOOP = """
import rclpy
from rclpy.action import ActionServer
from rclpy.node import Node
from tf2_ros import Buffer, TransformListener
from example_interfaces.action import Fibonacci
class Look(Node):
    def __init__(self):
        super().__init__('look')
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        ActionServer(self, Fibonacci, 'look', self.execute)
    def where(self):
        return self.buffer.lookup_transform('a', 'b', rclpy.time.Time())
    def execute(self, goal):
        while rclpy.ok():
            self.where()
        goal.succeed()
        return Fibonacci.Result()
def main():
    rclpy.init()
    rclpy.spin(Look())
"""


@pytest.mark.parametrize(
    ("old", "new", "count"),
    [
        ("", "", 1),
        ("self.where()", "self.buffer.lookup_transform('a', 'b', rclpy.time.Time())", 1),
        ("self.where()", "self.unknown()", 0),
        ("def execute", "async def execute", 0),
        ("while rclpy.ok()", "if rclpy.ok()", 0),
        ("self.buffer, self)", "self.buffer, self, spin_thread=True)", 0),
        ("rclpy.spin(Look())", "rclpy.spin(Look(), executor=MultiThreadedExecutor())", 0),
        ("rclpy.spin(Look())", "run(Look())", 0),
    ],
)
def test_loops_of_goals_that_look_up_transforms(old: str, new: str, count: int) -> None:
    """With one thread, no transform is read until the loop ends."""
    faults = nodes_of(_LOOP.replace(old, new, 1) if old else _LOOP).faults
    assert len([fault for fault in faults if fault.rule == "callback-wait"]) == count
