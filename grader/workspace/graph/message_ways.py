"""How messages find a way from a topic to another one through the nodes of a graph.

What a node receives goes on in all that it sends: what its code does with it is not examined. The
goals of actions carry it on as well; whether requests of services do is not known, nor whether two
nodes of one process share what they receive.
"""

from collections.abc import Collection, Iterator, Sequence
from fnmatch import fnmatchcase

from grader.base.names import last_part
from grader.base.records import Named
from grader.ros.nodes.node_facts import EndpointKind
from grader.workspace.graph.launch_graph import (
    OPPOSITES,
    PART_UNKNOWN,
    GraphEnd,
    GraphNode,
    LaunchGraph,
    fault_between,
)

_Doubted = Iterator[tuple[int, str]]  # the numbers of nodes, each with a doubt

_SENDING = ("publisher", "client", "action client")
# What publishes only what a person asks for.
_BY_PERSON = frozenset({"rviz2"})
_BRIDGES = ("ros_gz_bridge", "ros_ign_bridge", "ros_gz_image")


class MessageWay(Named):
    """A way of messages from a topic to another one: the numbers of the nodes in their order.

    If it does not arrive, the nodes are those that messages certainly reach.
    """

    nodes: tuple[int, ...]
    arrives: bool = True
    doubt: str = ""  # why it is not certain that it arrives


def find_way(graph: LaunchGraph, start: str, end: str) -> MessageWay:
    """Return how messages of one topic lead to messages of another one.

    A way that is certain is returned before a shorter one that is not.
    """
    certain = _WaySearch(graph, is_certain=True).way(start, end)
    if certain.arrives:
        return certain
    possible = _WaySearch(graph, is_certain=False).way(start, end)
    if possible.arrives:
        return possible
    if graph.unread:
        return MessageWay((), doubt=graph.unread[0].reason)
    return certain


def why_end_is_open(node: GraphNode, end: GraphEnd) -> str:
    """Return why it is not certain that a node has an end, for a message; empty if it is."""
    if node.doubt:
        return f"{node.label}: {node.doubt}"
    article = "an" if "action" in end.kind else "a"
    return f"{article} {end.kind} of {node.label}: {end.doubt}" if end.doubt else ""


def why_more(node: GraphNode) -> str:
    """Return why a node may open more than its ends, for a message."""
    return f"{node.label} may open more: {node.opens_more}"


class _NumberedEnd(Named):
    """An end of the node with a number."""

    node: int
    end: GraphEnd


class _WaySearch:
    """A search through nodes and ends: either of those that are certain, or of all."""

    def __init__(self, graph: LaunchGraph, *, is_certain: bool) -> None:
        self._nodes = graph.nodes
        self._is_certain = is_certain
        self._ends = []
        self._by_name: dict[tuple[str, str], list[_NumberedEnd]] = {}
        self._in_part = []  # the ends of whose names a part is not known
        self._reading_more = []
        self._held_by = _processes_by_held(graph.nodes)
        self._in_process: dict[int | None, list[int]] = {}
        for number, node in enumerate(graph.nodes):
            known = [end for end in node.ends if not (is_certain and why_end_is_open(node, end))]
            self._ends.append(known)
            if node.process is not None and not node.inside:
                self._in_process.setdefault(node.process, []).append(number)
            for end in known:
                placed = _NumberedEnd(number, end)
                if PART_UNKNOWN in end.name:
                    self._in_part.append(placed)
                else:
                    self._by_name.setdefault((end.kind, end.name), []).append(placed)
            if not is_certain and _may_read_more(node):
                self._reading_more.append(number)

    def way(self, start: str, end: str) -> MessageWay:
        """Return the shortest way between two topics, or what messages of the first one reach."""
        doubts = {}
        before: dict[int, int] = {}
        waiting = []
        for number, doubt in self._readers(start):
            if number not in doubts:
                doubts[number] = doubt
                waiting.append(number)
        for number in waiting:  # grows
            why = self._doubt_of_sending(number, end)
            if why is not None:
                return MessageWay((*_path(number, before),), doubt=doubts[number] or why)
            for other, why in self._next_to(number):
                if other not in doubts:
                    doubts[other] = doubts[number] or why
                    before[other] = number
                    waiting.append(other)
        return MessageWay(tuple(waiting), arrives=False)

    def _readers(self, topic: str) -> _Doubted:
        """Yield the nodes that read a topic, without those that connect to no publisher of it."""
        sent = [
            placed.end
            for placed in self._named("publisher", topic)
            if not why_end_is_open(self._nodes[placed.node], placed.end)
        ]
        for placed in self._named("subscription", topic):
            is_met = not sent or any(not fault_between(other, placed.end) for other in sent)
            if is_met and self._carries(placed.node):
                yield placed.node, self._find_doubt(placed)
        for number in self._reading_more:
            if self._carries(number):
                yield number, why_more(self._nodes[number])

    def _named(self, kind: str, name: str) -> list[_NumberedEnd]:
        """Return the ends of a kind that have a name, first those that certainly have it."""
        placed = list(self._by_name.get((kind, name), ()))
        for other in self._in_part:
            if other.end.kind == kind and fnmatchcase(name, other.end.name):
                placed.append(other)
        return placed

    def _doubt_of_sending(self, number: int, topic: str) -> str | None:
        """Return why it is not certain that a node publishes a topic; None if it does not."""
        for placed in self._named("publisher", topic):
            if placed.node == number:
                return self._find_doubt(placed)
        node = self._nodes[number]
        return why_more(node) if not self._is_certain and _may_send_more(node) else None

    def _find_doubt(self, placed: _NumberedEnd) -> str:
        """Return why it is not certain that a message goes through an end of a node."""
        node = self._nodes[placed.node]
        if node.program.startswith(_BRIDGES):
            return "what Gazebo does with a message is not known"
        return why_end_is_open(node, placed.end)

    def _carries(self, number: int) -> bool:
        """Return whether what a node receives may go on in what it sends."""
        node = self._nodes[number]
        if last_part(node.program) in _BY_PERSON:
            return False
        return not (self._is_certain and node.program.startswith(_BRIDGES))

    def _next_to(self, number: int) -> _Doubted:
        """Yield the nodes that get what a node sends, each with why that is not certain."""
        node = self._nodes[number]
        for end in self._ends[number]:
            doubt = why_end_is_open(node, end)
            if end.kind == "client":
                doubt = doubt or f"what {node.label} asks of {end.name} is not known"
            if end.kind in _SENDING and not (doubt and self._is_certain):
                for placed in self._named(OPPOSITES[end.kind], end.name):
                    offered, asked = (end, placed.end) if end.is_offered else (placed.end, end)
                    if self._carries(placed.node) and not fault_between(offered, asked):
                        yield placed.node, doubt or self._find_doubt(placed)
        for other in self._held_by.get(number, ()):
            yield other, self._nodes[other].doubt
        if not self._is_certain:
            for other in self._in_process.get(node.process, ()):
                label = self._nodes[other].label
                if other != number:
                    yield other, f"what {node.label} shares with {label} is not known"
            yield from self._possibly_next_to(node)

    def _possibly_next_to(self, node: GraphNode) -> _Doubted:
        """Yield the nodes that may get what a node sends, as one of both may open more."""
        if _may_send_more(node):
            for other, ends in enumerate(self._ends):
                if ends and self._carries(other):
                    yield other, why_more(node)
        for other in self._reading_more:
            if self._carries(other):
                yield other, why_more(self._nodes[other])


def _processes_by_held(nodes: Sequence[GraphNode]) -> dict[int, list[int]]:
    """Return the node whose process holds another one, as that of a costmap, which it reads.

    Nodes of a container, and controllers of a manager, have nothing to do with it.
    """
    numbers: dict[str, list[int]] = {}
    for number, node in enumerate(nodes):
        numbers.setdefault(node.label, []).append(number)
    held = {}
    for number, node in enumerate(nodes):
        if node.inside and node.kind == "program":
            held[number] = numbers.get(node.inside, [])
    return held


def _path(number: int, before: dict[int, int]) -> list[int]:
    path = [number]
    while path[-1] in before:
        path.append(before[path[-1]])
    return path[::-1]


def is_named(name: str, other: str) -> bool:
    """Return whether an end has a name, or may have it."""
    return fnmatchcase(other, name) if PART_UNKNOWN in name else name == other


def may_open(node: GraphNode, kinds: Collection[EndpointKind]) -> bool:
    """Return whether a node may open more than its ends, of one of these kinds."""
    if "publisher" in kinds and _may_send_more(node):
        return True
    return bool(node.opens_more) and (
        _may_read_more(node) if "subscription" in kinds else not node.opens_only
    )


def _may_read_more(node: GraphNode) -> bool:
    return bool(node.opens_more) and node.opens_only != "publishers"


def _may_send_more(node: GraphNode) -> bool:
    return bool(node.opens_more) and node.opens_only != "subscriptions"
