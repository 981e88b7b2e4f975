"""Time stamps and frames of messages and transforms that own code sends, where readers need them.

Only code that never names them, and makes its messages itself, surely sends none.
"""

import re
from collections.abc import Mapping

from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.ros.known.package_rows import package_row
from grader.ros.nodes.node_facts import NodeFacts
from grader.workspace.graph.code_ends import End
from grader.workspace.graph.graph import Graph, make_graph
from grader.workspace.model.code_text import code_alone
from grader.workspace.model.text_files import CODE_ENDINGS
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_MESSAGE,
    Rule,
)

_STAMPED = frozenset(
    {
        *("sensor_msgs.msg.JointState", "sensor_msgs.msg.LaserScan", "sensor_msgs.msg.Imu"),
        *("sensor_msgs.msg.PointCloud2", "nav_msgs.msg.Odometry"),
    }
)
# What may set a stamp: its name, or a header as a whole; a file of a type does not.
_MAY_SET = on_use(r"stamp(?!ed\.h)|[Hh]eader\b(?!\s*+\.\s*+frame_id\b)")
# What is for RViz alone, or for what asks where it is, and what may set its frame.
_PLACED = {
    "visualization_msgs.msg.Marker": "Marker",
    "visualization_msgs.msg.MarkerArray": "Marker",
    "nav_msgs.msg.OccupancyGrid": "OccupancyGrid",
    "nav_msgs.msg.Path": "Path",
}
_MAY_PLACE = on_use(r"[Ff]rame|[Hh]eader\b(?!\s*+\.\s*+stamp\b)")
# Of robot_state_publisher: whether it publishes what is older than what it published last.
_IGNORES = "ignore_timestamp"


_MESSAGE_STAMP = Rule(
    "message-stamp",
    "messages",
    NO_MESSAGE,
    "Messages and transforms have a stamp where what reads them needs it.",
    why=(
        "tf2 ignores a second transform with the same stamp, and robot_state_publisher skips "
        "joint states that are not newer. The robot does not move in RViz."
    ),
    wrong="""
frame = TransformStamped()
frame.header.frame_id = 'odom'
frame.child_frame_id = 'base_link'
self.frames.sendTransform(frame)
""",
    right="""
frame = TransformStamped()
frame.header.stamp = self.get_clock().now().to_msg()
frame.header.frame_id = 'odom'
frame.child_frame_id = 'base_link'
self.frames.sendTransform(frame)
""",
    frame="joints/pilot.py",
)


_MESSAGE_FRAME = Rule(
    "message-frame",
    "messages",
    NO_MESSAGE,
    "Markers, maps and paths have the frame that they are in.",
    why="RViz shows none of them: it reports that the frame with the empty name does not exist.",
    wrong="""
marker = Marker()
marker.type = Marker.SPHERE
self.markers.publish(marker)
""",
    right="""
marker = Marker()
marker.header.frame_id = 'map'
marker.type = Marker.SPHERE
self.markers.publish(marker)
""",
    frame="joints/marker.py",
    at="rover/marker.py",
)


def message_stamp_facts(workspace: Workspace) -> Facts:
    """Yield messages and transforms without a stamp.

    robot_state_publisher publishes no transform for joint states that are as old as the last ones,
    and tf2 ignores transforms with the stamp of one that it has.
    """
    sources = _CodeSources(workspace)
    yield from _of_messages(make_graph(workspace), sources)
    for node in workspace.code.nodes:
        yield from _without_frame(node, sources)
        for transform in node.transforms:
            if transform.is_static:
                continue
            yield Compared("messages")
            if sources.lack(_MAY_SET, transform.location, "TransformStamped"):
                message = (
                    "the transform has no stamp, and tf2 ignores all after the first one: set "
                    "header.stamp to the time of the node's clock"
                )
                yield warning(_MESSAGE_STAMP, message, transform.location)
                break


def _without_frame(node: NodeFacts, sources: "_CodeSources") -> Facts:
    """Yield the publishers of a node of what has no frame, though it needs one."""
    for end in node.endpoints:
        name = _PLACED.get(end.type or "", "") if end.kind == "publisher" else ""
        if name:
            yield Compared("messages")
            if sources.lack(_MAY_PLACE, end.location, name):
                message = f"the {name} has no frame, so RViz does not show it: set header.frame_id"
                yield warning(_MESSAGE_FRAME, message, end.location)


def _of_messages(graph: Graph, sources: "_CodeSources") -> Mismatches:
    """Yield the publishers of messages without a stamp, which a program needs."""
    said = set()
    publishers = [end for end in graph.certain("publisher", "code") if end.type in _STAMPED]
    for sent, read in graph.pairs(publishers, graph.certain("subscription", "program")):
        at = sent.location
        name = (sent.type or "").rpartition(".")[2]
        if at in said or read.type != sent.type or not _compares_times(read):
            continue
        if not _passes_on(graph, sent) and sources.lack(_MAY_SET, at, name):
            said.add(at)
            message = (
                f"the {name} has no stamp, so {read.node.executable} does not use it: set "
                "header.stamp to the time of the node's clock"
            )
            yield warning(_MESSAGE_STAMP, message, at, read.location)


def _compares_times(end: End) -> bool:
    """Return whether a program certainly compares the times of messages."""
    if not end.node.is_state_publisher:
        return package_row(end.node.package).compares_time
    for given in end.node.parameters or ():
        if given.path or given.unknown or _IGNORES in given.values:
            return False
    return end.node.parameters is not None


def _passes_on(graph: Graph, sent: End) -> bool:
    """Return whether a node may publish messages that it receives."""
    received = graph.of_kind("subscription")
    return any(end.node is sent.node and end.type == sent.type for end in received)


class _CodeSources:
    """The code of packages by the paths of its files."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._sources: Mapping[str, Source] | None = None

    def lack(self, may_set: re.Pattern[str], at: Location, name: str) -> bool:
        """Return whether a file makes messages of a type, and nothing in it may set a field."""
        if self._sources is None:
            sources = self._workspace.texts.every_source(CODE_ENDINGS)
            self._sources = {source.path: source for source in sources}
        code_file = self._sources.get(at.path)
        if code_file is None:
            return False
        code = code_alone(code_file.text, code_file.path)
        made = rf"\b{name}\s*+\(" if at.path.endswith(".py") else rf"\b{name}\s++\w++\s*+[;{{(]"
        return not may_set.search(code) and re.search(made, code) is not None
