"""The graph of a launch file as reports show it, with the findings at what they concern."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from grader.base.grouping import Strings
from grader.base.problems import Problem
from grader.base.source import Location
from grader.report.inspection import Inspection, count_severities, problem_counts
from grader.workspace.api import (
    Connection,
    GraphEnd,
    GraphNode,
    GraphTransform,
    LaunchGraph,
    connections_in,
    manual_ends,
    unconnected_ends,
)

if TYPE_CHECKING:
    from grader.workspace.api import HeardTopic

VERBS = {
    "publisher": "publishes",
    "subscription": "subscribes",
    "service": "serves",
    "client": "calls",
    "action server": "serves action",
    "action client": "calls action",
}


@dataclass(frozen=True, eq=False)
class ShownGraph:
    """The graph of one launch file of a workspace, for the writers of its formats.

    `launches` are the paths of all launch files, of which the first is the one shown by default.
    """

    graph: LaunchGraph
    inspection: Inspection
    launches: Strings = ()
    node: str = ""  # the name of the only node that is asked for, with its neighbours
    heard: "Sequence[HeardTopic]" = ()  # what a recording has of it
    verbose: bool = False  # also parameters, and the services that nothing asks for

    @cached_property
    def connections(self) -> tuple[Connection, ...]:
        """The connections; with `node`, those of it."""
        connections = connections_in(self.graph)
        if not self.node:
            return connections
        labels = [node.label for node in self.graph.nodes]
        return tuple(
            each
            for each in connections
            if self.node in (labels[each.from_node], labels[each.to_node])
        )

    @cached_property
    def nodes(self) -> Sequence[tuple[int, GraphNode]]:
        """The nodes that are shown, with their numbers: with `node`, it and its neighbours."""
        numbered = list(enumerate(self.graph.nodes))
        if not self.node:
            return numbered
        shown = {number for each in self.connections for number in (each.from_node, each.to_node)}
        return [pair for pair in numbered if pair[0] in shown or pair[1].label == self.node]

    @property
    def transforms(self) -> Sequence[GraphTransform]:
        """The transforms; none with `node`."""
        return () if self.node else self.graph.transforms

    @cached_property
    def manual(self) -> Sequence[tuple[GraphEnd, list[str]]]:
        """The unconnected ends that programs of another terminal are made for, with these."""
        return manual_ends(unconnected_ends(self.graph))

    @cached_property
    def counts(self) -> str:
        """How many problems there are, and how many of them in the files of the launch."""
        files = {self.graph.path}
        for node in self.graph.nodes:
            files |= {node.location.path, *(end.location.path for end in node.ends)}
        here = set[Problem]()
        for (path, _), problems in self._problems_by_line.items():
            if path in files:
                here.update(problems)
        counts = problem_counts(self.inspection)
        if here.issuperset(self.inspection.problems):
            return counts
        return f"{counts} ({count_severities(here) or 'none'} in the files of this launch)"

    @cached_property
    def unknown_nodes(self) -> Sequence[GraphNode]:
        """The nodes that may open more than their ends."""
        return [node for node in self.graph.nodes if node.opens_more]

    @cached_property
    def _problems_by_line(self) -> dict[tuple[str, int], list[Problem]]:
        """The problems by the lines that they name."""
        by_line: dict[tuple[str, int], list[Problem]] = {}
        for problem in self.inspection.problems:
            places = [problem.location]
            if problem.related:
                places.append(problem.related)
            for place in places:
                by_line.setdefault((place.path, place.line), []).append(problem)
        return by_line

    def _at(self, location: Location) -> Sequence[Problem]:
        return self._problems_by_line.get((location.path, location.line), ())

    def findings_at(self, node: GraphNode, end: GraphEnd) -> Sequence[Problem]:
        """Return the problems that name the line of an end, if it has one of its own."""
        return self._at(end.location) if end.location != node.location else ()

    def list_findings(self, number: int) -> Sequence[Problem]:
        """Return the problems at a node that are at none of its ends.

        Of several nodes of one line, such as that of an include, the first one has them.
        """
        node = self.graph.nodes[number]
        if any(other.location == node.location for other in self.graph.nodes[:number]):
            return ()
        of_ends: set[Problem] = set()
        for end in node.ends:
            of_ends.update(self.findings_at(node, end))
        listed = []
        for problem in self.inspection.problems:
            if problem.around and problem.around == node.location:
                listed.append(problem)
        listed += self._at(node.location)
        return [problem for problem in dict.fromkeys(listed) if problem not in of_ends]

    def is_offered_only(self, number: int, end: GraphEnd) -> bool:
        """Return whether a program of another package offers an end that nothing asks for."""
        is_of_program = end.is_offered and end.location == self.graph.nodes[number].location
        return is_of_program and not self.partners(number, end)

    def partners(self, number: int, end: GraphEnd) -> Sequence[tuple[GraphNode, Connection]]:
        """Return the nodes at the other ends, each with the connection."""
        return self._partners.get((number, end), ())

    @cached_property
    def _partners(self) -> Mapping[tuple[int, GraphEnd], list[tuple[GraphNode, Connection]]]:
        """The nodes at the other ends of each end of a node."""
        partners: dict[tuple[int, GraphEnd], list[tuple[GraphNode, Connection]]] = {}
        nodes = self.graph.nodes
        for each in self.connections:
            offering = (each.from_node, each.from_end)
            asking = (each.to_node, each.to_end)
            partners.setdefault(offering, []).append((nodes[each.to_node], each))
            partners.setdefault(asking, []).append((nodes[each.from_node], each))
        return partners


def transform_tree(transforms: Sequence[GraphTransform]) -> Iterator[tuple[int, str, str]]:
    """Yield frames as a tree, each with its depth and with what publishes its transform.

    A root has the depth 0, and no words. A frame with several parents stands below each.
    """
    children: dict[str, list[GraphTransform]] = {}
    for each in transforms:
        children.setdefault(each.parent, []).append(each)
    below = {each.child for each in transforms}
    roots = [each for each in transforms if each.parent not in below]
    seen = set()
    root = ""
    stack = [(1, each) for each in reversed((*roots, *transforms))]  # the latter are in circles
    while stack:
        depth, each = stack.pop()
        if each not in seen:
            seen.add(each)
            if depth == 1 and each.parent != root:
                root = each.parent
                yield 0, root, ""
            yield depth, each.child, each.words
            stack += [(depth + 1, other) for other in reversed(children.get(each.child, []))]


def find_severity(problems: Sequence[Problem]) -> str:
    """Return the worst severity of problems; empty without any, and for notes."""
    severities = {problem.severity for problem in problems}
    for severity in ("error", "warning"):
        if severity in severities:
            return severity
    return ""
