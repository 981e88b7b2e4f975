"""The form of a graph that does not depend on names: of nodes, topics, services and actions."""

import hashlib
from collections import defaultdict

from grader.base.grouping import Strings
from grader.workspace.graph.launch_graph import GraphEnd, GraphNode, LaunchGraph

_ROUNDS = 4  # in which a part of the graph gets to know its neighbours
_LEAST_ENDS = 6  # of own code: smaller graphs are often equal
_Parts = dict[Strings, str]  # a node by its number, or a topic by its name: what it is


_Neighbours = dict[Strings, list[tuple[str, Strings]]]


def graph_form(graph: LaunchGraph) -> str:
    """Return a hash of a graph, equal for graphs that differ in names only.

    It is empty for a graph with few ends in code of its own. What a node is, is its program if that
    is of another package, and the kinds, types and qualities of its ends.
    """
    own_ends = [end for node in graph.nodes for end in node.ends if _is_of_code(node, end)]
    if len(own_ends) < _LEAST_ENDS:
        return ""
    parts: _Parts = {}
    neighbours: _Neighbours = defaultdict(list)
    for number, node in enumerate(graph.nodes):
        place = ("node", str(number))
        is_own = any(_is_of_code(node, end) for end in node.ends)
        parts[place] = node.kind if is_own else f"{node.kind} {node.program}"
        for end in node.ends:
            name = (end.carrier, end.name)
            parts[name] = end.carrier
            look = f"{end.kind} {end.type} {end.qos}"
            neighbours[place].append((look, name))
            neighbours[name].append((look, place))
    for _ in range(_ROUNDS):
        parts = _refined(parts, neighbours)
    return _hash_text("\n".join(sorted(parts.values())))


def _is_of_code(node: GraphNode, end: GraphEnd) -> bool:
    """Return whether an end is written in code, and not known of a program."""
    return node.kind != "controller" and end.location != node.location


def _refined(parts: _Parts, neighbours: _Neighbours) -> _Parts:
    """Return what each part of a graph is, together with what its neighbours are."""
    refined = {}
    for place, what in parts.items():
        around = sorted(f"{look} {parts[other]}" for look, other in neighbours[place])
        refined[place] = _hash_text("\n".join([what, *around]))
    return refined


def _hash_text(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
