"""What runs after launch files are launched: nodes, their parameters, ends and transforms.

This is what `ros2 node list`, `param dump`, `topic info --verbose` and `view_frames` would show.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, lru_cache
from typing import TypeVar

from grader.base.records import Record
from grader.ros.launch.launch_model import ParameterValue, StartedNode
from grader.ros.nodes.node_facts import EndpointKind
from grader.workspace.graph.bridge_rows import BridgeRow, bridge_rows
from grader.workspace.graph.code_ends import END_SOURCES, End, EndSource
from grader.workspace.graph.launch_graph import GraphTransform, LaunchGraph
from grader.workspace.graph.node_ends import list_ends
from grader.workspace.graph.started_graph import started_graph
from grader.workspace.graph.transform_edges import edges_in
from grader.workspace.model.workspace import Workspace

_Row = TypeVar("_Row")
_Key = TypeVar("_Key", bound=Hashable)
_ENDS_A_PART = 16  # that are searched for those of a kind
# Those that are read, while what other programs open is known.
_READ: tuple[EndSource, ...] = ("code", "controller")


class Graph(Record):
    """What runs after each launch file of a workspace is launched on its own.

    `make_graph` makes it once; the rules of topics, services, messages and transforms ask it.

    The iterators charge the budget of the workspace for what they yield, and raise NotDecided.
    """

    workspace: Workspace

    @cached_property
    def launched(self) -> Sequence[LaunchGraph]:
        """What runs after each launch file, with controllers, components and included nodes."""
        count = len(self.workspace.launches.roots)
        return [started_graph(self.workspace, number) for number in range(count)]

    @cached_property
    def ends(self) -> Sequence[End]:
        """The ends of all nodes that are or may be started."""
        ends: list[End] = []
        for launch, (package, file) in enumerate(self.workspace.launches.roots):
            self.workspace.charge(1 + len(file.nodes))
            for node in file.nodes:
                if node.when is not False:
                    ends += list_ends(self.workspace, launch, package, node)
        return ends

    @cached_property
    def edges(self) -> Sequence[GraphTransform]:
        """The transforms of all nodes, whatever conditions say."""
        edges: list[GraphTransform] = []
        for launch in range(len(self.workspace.launches.roots)):
            edges += edges_in(self.workspace, launch)
        return edges

    def of_kind(self, *kinds: EndpointKind, sources: Sequence[EndSource] = _READ) -> list[End]:
        """Return the ends of some kinds whose names are known."""
        self.workspace.charge(1 + len(self.ends) // _ENDS_A_PART)
        ends = [end for end in self.ends if end.kind in kinds and end.source in sources]
        return [end for end in ends if end.is_known]

    def certain(self, kind: EndpointKind, *sources: EndSource) -> list[End]:
        """Return the ends of a kind whose names are known, of nodes that certainly are started."""
        return [end for end in self.of_kind(kind, sources=sources) if end.is_certain]

    def names_opened(self, kind: EndpointKind) -> set[str]:
        """Return the topics that something opens in one way.

        This includes the rows of bridges that nothing starts.
        """
        names = {end.name for end in self.of_kind(kind, sources=END_SOURCES)}
        for row in bridge_rows(self.workspace):
            if row.is_published if kind == "publisher" else row.is_read:
                names.add(f"/{row.ros}")
        return names

    @cached_property
    def names_read(self) -> set[str]:
        """The topics to which code subscribes under the names that it writes, if it is started."""
        names = set()
        for node in self.workspace.code.nodes:
            self.workspace.charge(1 + len(node.endpoints))
            for endpoint in node.endpoints:
                if endpoint.kind == "subscription" and endpoint.name is not None:
                    names.add(f"/{endpoint.name.removeprefix('/')}")
        return names

    def pairs(self, asking: Iterable[End], offering: Iterable[End]) -> Iterator[tuple[End, End]]:
        """Yield each end that asks for another one with each that offers it by its name."""
        by_name = grouped(offering, lambda end: end.name)
        for end in asking:
            others = by_name.get(end.name, ())
            self.workspace.charge(1 + len(others))
            for other in others:
                yield end, other

    def alike(self, end: End, others: Sequence[End]) -> Sequence[End]:
        """Return those of other ends that have the type of one, and are of its launch file."""
        self.workspace.charge(1 + len(others))
        key = end.launch, end.type
        return [other for other in others if (other.launch, other.type) == key]

    def bridged(self, ends: Iterable[End]) -> Iterator[tuple[End, BridgeRow]]:
        """Yield each row of a bridge with the ends from and to which it takes messages.

        This includes the rows of bridges that nothing starts.
        """
        by_name = grouped(ends, lambda end: end.name)
        for row in bridge_rows(self.workspace):
            others = by_name.get(f"/{row.ros}", ())
            self.workspace.charge(len(others))
            for end in others:
                if row.is_published if end.kind == "subscription" else row.is_read:
                    yield end, row

    def given(self, parameter: str) -> Iterator[tuple[StartedNode, ParameterValue]]:
        """Yield the nodes that are given a parameter of a name, each with its value."""
        for package, node in self.workspace.launches.placed_nodes:
            value = self.workspace.parameters.given_to(package, node).values.get(parameter)
            if value:
                yield node, value


@lru_cache(maxsize=3)  # as of facts
def make_graph(workspace: Workspace) -> Graph:
    """Return the graph of a workspace, which is made once."""
    return Graph(workspace)


def grouped(rows: Iterable[_Row], key: Callable[[_Row], _Key]) -> Mapping[_Key, Sequence[_Row]]:
    """Return rows by what they have in common."""
    groups: dict[_Key, list[_Row]] = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


def distinct(ends: Iterable[End]) -> list[End]:
    """Return the ends that differ: a loop starts a program often, with the same topics."""
    first: dict[object, End] = {}
    for end in ends:
        node = end.node
        of_node = (node.executable, node.when, node.namespace, node.remaps)
        first.setdefault((end.name, end.endpoint, end.launch, end.owner, of_node), end)
    return list(first.values())
