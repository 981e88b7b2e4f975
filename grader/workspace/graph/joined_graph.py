"""What runs after launch files are launched together, and what may be asked of it."""

from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import EndpointKind
from grader.workspace.graph.launch_graph import (
    Connection,
    GraphEnd,
    GraphNode,
    GraphTransform,
    LaunchGraph,
    Unread,
    connections_in,
    fault_between,
)
from grader.workspace.graph.launch_graphs import launched_alone
from grader.workspace.graph.launched_transforms import (
    is_for_transforms,
    transforms_in,
    unread_transforms,
)
from grader.workspace.graph.message_ways import (
    MessageWay,
    find_way,
    is_named,
    may_open,
    why_end_is_open,
    why_more,
)
from grader.workspace.graph.started_graph import started_graph
from grader.workspace.model.workspace import Workspace

_SENDS: Sequence[EndpointKind] = ("publisher",)
_READS: Sequence[EndpointKind] = ("subscription",)
_Launches = tuple[tuple[Workspace, int], ...]


class PlacedEnd(NamedTuple):
    """An end, its node, and why it, or its type, is not certain."""

    end: GraphEnd
    node: GraphNode
    doubt: str


class JoinedGraph(NamedTuple):
    """What runs after launch files are launched together, for the checks of rubrics.

    `join_launches` makes it. Its methods raise NotDecided where that takes too much work.
    """

    graph: LaunchGraph  # without the programs that cannot run
    launches: _Launches  # each by its number among the roots of a workspace
    unrun: frozenset[str]  # the names of programs that cannot run

    def find_way(self, start: str, end: str) -> MessageWay:
        """Return how messages of one topic lead to messages of another one."""
        return find_way(self.graph, start, end)

    def find_reader(self, topic: str) -> PlacedEnd | None:
        """Return what certainly reads a topic that another node certainly publishes.

        Their types and qualities of service fit.
        """
        sent = [placed for placed in self.ends(_SENDS, topic) if not placed.doubt]
        for reader in self.ends(_READS, topic):
            for publisher in sent:
                is_other = publisher.node is not reader.node and not reader.doubt
                if is_other and not fault_between(publisher.end, reader.end):
                    return reader
        return None

    def unfed(self, kind: str) -> Iterator[PlacedEnd]:
        """Yield what reads a type, or its stamped twin, on topics that nothing publishes."""
        plain = kind.removesuffix("Stamped")
        for node in self.graph.nodes:
            for end in node.ends:
                is_asking = end.kind == "subscription" and end.type.removesuffix("Stamped") == plain
                if is_asking and not self.ends(_SENDS, end.name):
                    yield PlacedEnd(end, node, why_end_is_open(node, end))

    def ends(self, kinds: Collection[EndpointKind], name: str) -> list[PlacedEnd]:
        """Return the ends of these kinds that have a name, or may have it."""
        ends = []
        for node in self.graph.nodes:
            for end in node.ends:
                if end.kind in kinds and is_named(end.name, name):
                    doubt = why_end_is_open(node, end)
                    doubt = doubt or ("" if end.type else "its type is not known")
                    ends.append(PlacedEnd(end, node, doubt))
        return ends

    def why_more_ends(self, kinds: Collection[EndpointKind]) -> Iterator[str]:
        """Yield why there may be more ends of these kinds."""
        for node in self.graph.nodes:
            if may_open(node, kinds):
                yield why_more(node)
        for unread in self.graph.unread:
            yield unread.reason

    def faulty_connections(self) -> Iterator[Connection]:
        """Yield the ends of one name that do not connect."""
        for connection in connections_in(self.graph):
            if connection.fault:
                yield connection

    def transforms(self) -> list[GraphTransform]:
        """Return the transforms; a frame that is not known is empty."""
        transforms: list[GraphTransform] = []
        for workspace, number in self.launches:
            transforms += transforms_in(workspace, number, self.unrun)
        return transforms

    def is_for_transforms(self, node: StartedNode) -> bool:
        """Return whether a node is started for the transforms that it publishes."""
        return any(is_for_transforms(workspace, node) for workspace, _ in self.launches)

    def unread_transforms(self) -> Iterator[Unread]:
        """Yield what may publish transforms that are not known."""
        for workspace, number in self.launches:
            yield from unread_transforms(workspace, number, self.graph, self.unrun)


def join_launches(
    workspace: Workspace, paths: Collection[str], unrun: Collection[str]
) -> JoinedGraph:
    """Return what runs after launch files are launched together, without some programs."""
    launches = tuple(launched_alone(workspace, path) for path in paths)
    nodes = []
    unread: list[Unread] = []
    for each in launches:
        graph = started_graph(*each)
        nodes += [node for node in graph.nodes if node.program not in unrun]
        unread += graph.unread
    joined = LaunchGraph("", tuple(nodes), unread=tuple(unread))
    return JoinedGraph(joined, launches, frozenset(unrun))
