"""The computation graph of one launch file, as it can be shown: nodes, their ends, and transforms.

It is what `ros2 node list`, `ros2 topic info --verbose` and `view_frames` would show of a launch,
with where each part is written, and why a part is not certain.
"""

from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any, Literal, NamedTuple, get_args

from grader.base.errors import NotDecided
from grader.base.grouping import Strings
from grader.base.records import Named
from grader.base.source import Location
from grader.base.transforms import Transform
from grader.ros.known.end_rows import OnlyMore
from grader.ros.nodes.node_facts import EndpointKind, Qos

GraphNodeKind = Literal["program", "component", "container", "controller"]
GRAPH_NODE_KINDS: tuple[GraphNodeKind, ...] = get_args(GraphNodeKind)
_ConnectionKind = Literal["topic", "service", "action"]
_TransformSource = Literal["robot", "static", "code", "program", "controller", "Gazebo"]
CONNECTION_KINDS: tuple[_ConnectionKind, ...] = get_args(_ConnectionKind)
OFFERS: Mapping[EndpointKind, EndpointKind] = {
    "publisher": "subscription",
    "service": "client",
    "action server": "action client",
}
OPPOSITES: Mapping[EndpointKind, EndpointKind] = {
    **OFFERS,
    **{asking: offering for offering, asking in OFFERS.items()},
}
CARRIES: Mapping[EndpointKind, _ConnectionKind] = {
    "publisher": "topic",
    "subscription": "topic",
    "service": "service",
    "client": "service",
    "action server": "action",
    "action client": "action",
}
# Of what is at the other end of a topic, by the words of rubrics: rmw/qos_profiles.h.
_QUALITIES: Mapping[str, Qos] = {
    "default": Qos(10, "reliable", "volatile"),
    "sensor_data": Qos(5, "best_effort", "volatile"),
    "transient_local": Qos(1, "reliable", "transient_local"),
}
PART_UNKNOWN = "*"  # in a name
_MAX_CONNECTIONS = 10_000


class GraphEnd(NamedTuple):
    """An end of a topic, service or action of a node.

    `doubt` says why it is not certain that the node has it, with this name; it is empty if it is.
    """

    kind: EndpointKind
    name: str  # in full; PART_UNKNOWN stands for what is not known of it
    type: str  # sensor_msgs/msg/LaserScan; empty if it is not known
    location: Location
    qos: Qos = Qos()
    doubt: str = ""
    note: str = ""  # what is on the other side of a bridge, or shows it

    @property
    def carrier(self) -> _ConnectionKind:
        """What it is an end of."""
        return CARRIES[self.kind]

    @property
    def is_offered(self) -> bool:
        """Whether it sends or serves, so that arrows lead away from it."""
        return self.kind in OFFERS


class GivenValue(Named):
    """A parameter that a node is given, and that differs from its default, or has none."""

    name: str
    value: Any
    location: Location


class GraphNode(Named):
    """A node that runs, or may run, after a launch file is launched."""

    name: str  # in full: /left/driver; empty where it is not known
    program: str  # demo_nodes_cpp/talker, a class of components, or the type of a controller
    kind: GraphNodeKind
    location: Location
    ends: tuple[GraphEnd, ...] = ()
    doubt: str = ""  # why it may not run
    opens_more: str = ""  # why it may open more than its ends
    parameters: tuple[GivenValue, ...] = ()
    inside: str = ""  # the full name of the container or manager whose process it is in
    opens_only: OnlyMore = ""
    process: int | None = None  # the number of the Node that starts its process, if that is known

    @property
    def label(self) -> str:
        """Its name, or its program where the name is not known."""
        return self.name or f"({self.program})"

    @property
    def namespace(self) -> str:
        """The namespace of its name."""
        return self.name.rpartition("/")[0] or "/"


class EndedProcess(Named):
    """A program of a launch that is no node, or ends when it has done its work."""

    program: str
    location: Location
    doubt: str = ""  # why it may not be started


class GraphTransform(NamedTuple):
    """A transform that something publishes, or may publish; a frame that is not known is empty.

    Rules that say that two programs place one frame read those that are certain; rules that say
    that nothing connects two frames read all.
    """

    parent: str
    child: str
    source: _TransformSource
    is_certain: bool
    by: str
    location: Location
    is_static: bool = False
    pose: Transform | None = None  # T_parent_child, where it never changes and is known
    # The topics of joint states without which robot_state_publisher does not publish it.
    needs: Strings = ()
    named_at: Location | None = None  # where a parameter has the name of the child

    @property
    def is_known(self) -> bool:
        """Whether both frames are known."""
        return bool(self.parent and self.child)

    @property
    def words(self) -> str:
        """What publishes it, for people."""
        words = f"static, {self.by}" if self.is_static else self.by
        return words if self.is_certain else f"{words} (not certain)"


class Unread(Named):
    """What may start more, or is not read, and where."""

    reason: str
    location: Location


class LaunchGraph(Named):
    """What runs after one launch file is launched on its own, in the order of the file."""

    path: str  # of the launch file
    nodes: tuple[GraphNode, ...] = ()
    processes: tuple[EndedProcess, ...] = ()
    not_started: tuple[EndedProcess, ...] = ()  # under these arguments
    transforms: tuple[GraphTransform, ...] = ()
    unread: tuple[Unread, ...] = ()
    arguments: tuple[tuple[str, str], ...] = ()  # that it declares, with their values


class Connection(Named):
    """Two ends of one name: the numbers of the nodes, and their ends.

    Messages go from the first one to the second; of a service and an action, the first one serves.
    """

    kind: _ConnectionKind
    name: str
    from_node: int
    from_end: GraphEnd
    to_node: int
    to_end: GraphEnd
    fault: str = ""  # why they do not connect: the type, or the quality of service
    doubt: str = ""  # why it is not certain that they do


def connections_in(graph: LaunchGraph) -> tuple[Connection, ...]:
    """Return each pair of ends that have one name, in the order of the nodes that offer them.

    Where it is not certain that a node has an end, one of another type connects nothing: another
    parameter may give it the type of the other end. Many nodes on one topic have many pairs, of
    which the first ones are returned.
    """
    return tuple(islice(_connections(graph), _MAX_CONNECTIONS))


def has_more_connections(graph: LaunchGraph) -> bool:
    """Return whether a graph has more connections than are returned."""
    return next(islice(_connections(graph), _MAX_CONNECTIONS, None), None) is not None


def _connections(graph: LaunchGraph) -> Iterator[Connection]:
    asking: dict[tuple[str, str], list[tuple[int, GraphEnd]]] = {}
    for number, node in enumerate(graph.nodes):
        for end in node.ends:
            if not end.is_offered and PART_UNKNOWN not in end.name:
                asking.setdefault((end.kind, end.name), []).append((number, end))
    for number, node in enumerate(graph.nodes):
        for end in node.ends:
            others = asking.get((OPPOSITES[end.kind], end.name), ()) if end.is_offered else ()
            for other_number, other in others:
                fault = fault_between(end, other)
                doubt = end.doubt or other.doubt
                if fault and doubt:
                    continue
                doubt = doubt or node.doubt or graph.nodes[other_number].doubt
                yield Connection(
                    end.carrier, end.name, number, end, other_number, other, fault, doubt
                )


def fault_between(offered: GraphEnd, asked: GraphEnd) -> str:
    """Return why two ends do not connect; empty if they do, as far as is known."""
    if offered.type and asked.type and offered.type != asked.type:
        return f"{offered.type} is not {asked.type}"
    return _fault_of_quality(offered.qos, asked.qos)


def _fault_of_quality(given: Qos, wanted: Qos) -> str:
    """Return why a quality of service is not what is asked for; empty if it is, or is not known."""
    if given.reliability == "best_effort" and wanted.reliability == "reliable":
        return "best effort is offered, reliable is asked for"
    if given.durability == "volatile" and wanted.durability == "transient_local":
        return "volatile is offered, transient local is asked for"
    return ""


def fault_with_others(kind: EndpointKind, qos: Qos, others: str) -> str:
    """Return why an end of a topic does not connect to one with a quality that a rubric names.

    Raises NotDecided where the quality of the end is not known.
    """
    if None in (qos.reliability, qos.durability):
        raise NotDecided("cannot determine statically which quality of service a topic has")
    pair = (qos, _QUALITIES[others]) if kind == "publisher" else (_QUALITIES[others], qos)
    return _fault_of_quality(*pair)


def connected_part(graph: LaunchGraph) -> LaunchGraph:
    """Return a graph with nothing but the ends that have another one, and the nodes of these."""
    names = {(end.kind, end.name) for node in graph.nodes for end in node.ends}
    nodes = []
    for node in graph.nodes:
        ends = [end for end in node.ends if (OPPOSITES[end.kind], end.name) in names]
        if ends:
            nodes.append(node._replace(ends=tuple(ends)))
    return graph._replace(nodes=tuple(nodes))


def unconnected_ends(graph: LaunchGraph) -> list[GraphEnd]:
    """Return the ends that nothing of the launch is known to connect to, each name once."""
    first: dict[tuple[EndpointKind, str], GraphEnd] = {}
    for node in graph.nodes:
        for end in node.ends:
            first.setdefault((end.kind, end.name), end)
    return [end for (kind, name), end in first.items() if (OPPOSITES[kind], name) not in first]
