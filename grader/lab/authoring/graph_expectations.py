"""Expectations of what a reference connects after a launch: transforms, and ways of messages."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from grader.base.errors import NotDecided
from grader.base.quantities import point
from grader.base.transforms import Vector
from grader.files.limits import ROBOT_ENDINGS
from grader.lab.authoring.expectations import Expectation
from grader.lab.submission.submission import Submission
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.package.package import Package
from grader.workspace.api import GraphEnd, GraphNode, GraphTransform, join_launches

# Types of what sensors publish, and of what moves a robot.
_OF_SENSORS = ("sensor_msgs/msg/", "nav_msgs/msg/Odometry")
_OF_COMMANDS = (
    "geometry_msgs/msg/Twist",
    "geometry_msgs/msg/TwistStamped",
    "ackermann_msgs/msg/",
    "trajectory_msgs/msg/JointTrajectory",
    "std_msgs/msg/Float64MultiArray",
)
_CLOCK = "/clock"  # which says nothing of what a node is for
# The kinds of ends for which `node_runs` asks.
_SEEN = ("publisher", "service", "action server", "client", "action client")
_MAX_WAYS, _MAX_TRANSFORMS = 4, 12  # of one launch file
_DECIMALS = 6  # of metres and radians


class LaunchConnections:
    """What a launch file of a reference connects, for the expectations of its package."""

    def __init__(self, submission: Submission, package: Package, path: str) -> None:
        self._workspace = submission.workspace
        self._graph = join_launches(self._workspace, [package.path(path)], ())
        self._own_packages = tuple(f"{each.name}/" for each in submission.packages)

    def expectations(self) -> Iterator[Expectation]:
        """Yield the transforms and the ways of messages that certainly are there."""
        for transform in list(self._published())[:_MAX_TRANSFORMS]:
            parent = transform.parent
            child = transform.child
            expectation = self._expectation(
                "publishes_transform", child, parent=parent, child=child
            )
            expectation = expectation._replace(title=f"{child!r} is published below {parent!r}")
            if transform.is_static and transform.pose:
                xyz = _rounded(transform.pose.translation)
                placed = expectation.with_arguments(xyz=xyz, rpy=_rounded(transform.pose.rpy))
                title = f"{child!r} is published at {point(tuple(xyz))} m in {parent!r}"
                expectation = placed._replace(title=title, otherwise=(expectation,))
            yield expectation
        ways = list(self._ways())[:_MAX_WAYS]
        for start, end in ways:
            expectation = self._expectation(
                "connects", f"{start} {end}", **{"from": start, "to": end}
            )
            expectation = expectation._replace(title=f"messages find a way from {start} to {end}")
            if self._is_obeyed(end):
                title = f"messages find a way from {start} to what reads {end}"
                expectation = expectation.with_arguments(read=True)._replace(title=title)
            yield expectation
        arrived = {end for _, end in ways}
        for topic in [each for each in self._commands() if each not in arrived]:
            arguments = {"from": topic, "to": topic, "read": True}
            expectation = self._expectation("connects", topic, **arguments)
            yield expectation._replace(title=f"what is published on {topic} is read")

    @property
    def has_ends_of_robot(self) -> bool:
        """Whether a robot opens topics, such as those of its sensors in Gazebo."""
        return any(node.location.path.endswith(ROBOT_ENDINGS) for node in self._graph.graph.nodes)

    def needed(self, launch: Launch, nodes: Sequence[str], *, are_ends_asked: bool) -> list[str]:
        """Return the nodes that are needed for more than what other expectations ask for.

        These are transforms, and what own nodes open, if that is asked: then a solution may divide
        its nodes over programs as it likes.
        """
        by_program: dict[str, list[GraphTransform]] = {}
        for transform in self._transforms():
            by_program.setdefault(transform.by, []).append(transform)
        replaced = set()
        for node in launch.nodes:
            sent = [transform.is_certain for transform in by_program.get(node.executable, [])]
            is_own = self._workspace.find_package(node) is not None
            # Of another program, what else it may publish is not known.
            is_known = all(sent) if is_own else any(sent)
            is_asked = bool(sent) and is_known and self._graph.is_for_transforms(node)
            if is_own and are_ends_asked:
                is_asked = is_asked or (is_known and (bool(sent) or self._is_seen(node)))
            if is_asked:
                replaced.add(node.name)
        return [name for name in nodes if name not in replaced]

    def _is_seen(self, node: StartedNode) -> bool:
        """Return whether all nodes of an own program are read, and one certainly opens an end."""
        own_nodes = [each for each in self._graph.graph.nodes if each.program == node.name]
        is_read = not any(each.doubt or each.opens_more for each in own_nodes)
        seen = [end for each in own_nodes for end in each.ends if end.kind in _SEEN]
        return is_read and any(not end.doubt and end.type for end in seen)

    def _expectation(self, check: str, words: str, **arguments: Any) -> Expectation:
        return Expectation("", check, arguments, f"{words} {check}", package="")

    def _transforms(self) -> list[GraphTransform]:
        """Return the transforms, without those of the robots; none if that is too much work."""
        of_robots = set()
        try:
            for robot in self._workspace.robots.known:
                of_robots |= {joint.child for joint in robot.robot.joints}
            transforms = self._graph.transforms()
        except NotDecided:
            return []
        return [transform for transform in transforms if transform.child not in of_robots]

    def _published(self) -> Iterator[GraphTransform]:
        """Yield the transforms that certainly are published, the first of each pair of frames."""
        by_frames: dict[tuple[str, str], GraphTransform] = {}
        for transform in self._transforms():
            if transform.is_certain:
                by_frames.setdefault((transform.parent, transform.child), transform)
        yield from by_frames.values()

    def _is_obeyed(self, topic: str) -> bool:
        """Return whether a node of another package certainly reads what is published."""
        reader = self._graph.find_reader(topic)
        return reader is not None and not self._is_own(reader.node)

    def _commands(self) -> Iterator[str]:
        """Yield the topics of commands of own nodes that nodes of other packages obey."""
        sent = []
        for node in self._graph.graph.nodes:
            if self._is_own(node):
                sent += [end for end in node.ends if end.type.startswith(_OF_COMMANDS)]
        for topic in _topics(sent, "publisher"):
            if self._is_obeyed(topic):
                yield topic

    def _ways(self) -> Iterator[tuple[str, str]]:
        """Yield the topics between which own nodes take messages from other nodes to other ones."""
        nodes = self._graph.graph.nodes
        starts, ends = self._outer_topics(nodes)
        for start in starts:
            for end_name in ends:
                way = self._graph.find_way(start, end_name)
                is_certain = way.arrives and not way.doubt
                if is_certain and all(self._is_own(nodes[number]) for number in way.nodes):
                    yield start, end_name

    def _outer_topics(self, nodes: Sequence[GraphNode]) -> tuple[list[str], list[str]]:
        """Return the topics that own nodes read from other nodes, and those that they send these.

        Those of sensors and commands, whose other nodes may be on the robot, are among them.
        """
        own_ends = [
            end for node in nodes if self._is_own(node) for end in node.ends if not end.doubt
        ]
        others = [end for node in nodes if not self._is_own(node) for end in node.ends]
        read = _topics(own_ends, "subscription")
        sent = _topics(own_ends, "publisher")
        read_by_others = _topics(others, "subscription")
        sent_by_others = _topics(others, "publisher")
        starts = [
            name
            for name, kind in read.items()
            if name not in sent and (name in sent_by_others or kind.startswith(_OF_SENSORS))
        ]
        ends = [
            name
            for name, kind in sent.items()
            if name not in read and (name in read_by_others or kind.startswith(_OF_COMMANDS))
        ]
        return starts, ends

    def _is_own(self, node: GraphNode) -> bool:
        return node.program.startswith(self._own_packages) and not node.doubt


def _rounded(values: Vector) -> list[float]:
    """Return numbers as a rubric writes them."""
    return [round(value, _DECIMALS) + 0.0 for value in values]


def _topics(ends: Iterable[GraphEnd], kind: str) -> dict[str, str]:
    """Return the topics of the ends of a kind, each with its first type."""
    topics: dict[str, str] = {}
    for end in ends:
        if end.kind == kind and end.name != _CLOCK:
            topics.setdefault(end.name, end.type)
    return topics
