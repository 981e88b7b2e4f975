"""Buffers of transforms that nothing fills are found, and those that something may fill are not."""

import pytest

from tests.nodes.test_nodes import nodes_of

_HEAD = """
import tf2_ros
from rclpy.node import Node
from tf2_ros import Buffer
"""


def _faults_of(body: str, head: str = _HEAD) -> list[str]:
    statements = "".join(f"        {line}\n" for line in body.splitlines())
    methods = (
        "    def look(self):\n        return self.buffer.lookup_transform('a', 'b', self.now)\n"
        "    def now(self):\n        return None\n"
    )
    text = f"{head}\nclass Look(Node):\n    def __init__(self):\n        super().__init__('look')\n{statements}{methods}"
    return [fault.message for fault in nodes_of(text).faults if fault.rule == "buffer-listener"]


@pytest.mark.parametrize("made", ["Buffer()", "tf2_ros.Buffer()", "tf2_ros.buffer.Buffer()"])
def test_a_buffer_without_a_listener(made: str) -> None:
    """Nothing fills a buffer that is only asked."""
    message = "no TransformListener fills self.buffer: it never has a transform"
    assert _faults_of(f"self.buffer = {made}") == [message]


FILLED = [
    "self.buffer = Buffer()\nself.listener = tf2_ros.TransformListener(self.buffer, self)",
    "self.buffer = Buffer()\nfill(self.buffer)",
    "self.buffer = Buffer()\nself.buffer.set_transform(None, 'me')",
    "self.buffer = Buffer()\nself.buffer = Buffer()",
    "self.buffer = Other()",
    "self.other = Buffer()\nself.buffer = make()",
]


@pytest.mark.parametrize("body", FILLED)
def test_a_buffer_that_may_be_filled(body: str) -> None:
    """A buffer that something else is given, or that is made twice, may be filled."""
    assert _faults_of(body) == []
