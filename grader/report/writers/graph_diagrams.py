"""A graph as Mermaid and as DOT: nodes joined by their topics, services and actions."""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.base.text import printable
from grader.report.shown_graph import ShownGraph, find_severity
from grader.workspace.api import GraphEnd, GraphNode

_PLAIN = re.compile(r"[^A-Za-z0-9_/ .:*()-]")
_MERMAID_SHAPES = {"topic": ("([", "])"), "service": ("{{", "}}"), "action": ("[[", "]]")}
_DOT_SHAPES = {"topic": "ellipse", "service": "hexagon", "action": "octagon"}
_COLOURS = {"error": "#b3261e", "warning": "#7d4e00"}


class _DiagramName(NamedTuple):
    """A topic, service or action between nodes."""

    kind: str
    name: str
    type: str
    severity: str  # of what is found at its ends; empty without


class _DiagramArrow(NamedTuple):
    """An arrow between a node and a name, by their numbers."""

    node: int
    name: int
    is_from_node: bool
    is_certain: bool
    fault: str


class Diagram(NamedTuple):
    """What is drawn of a graph: nodes, names between them, and arrows.

    What a program of another package publishes or serves and nothing asks for is not drawn.
    """

    nodes: tuple[tuple[int, GraphNode, str], ...]  # with their numbers and severities
    names: tuple[_DiagramName, ...]
    arrows: tuple[_DiagramArrow, ...]


def make_diagram(shown: ShownGraph) -> Diagram:
    """Return what is drawn of a graph."""
    names: dict[tuple[str, str, int], _DiagramName] = {}
    places: dict[tuple[str, str, int], int] = {}
    arrows: list[_DiagramArrow] = []
    nodes: list[tuple[int, GraphNode, str]] = []
    for number, node in shown.nodes:
        nodes.append((number, node, find_severity(shown.list_findings(number))))
        for end in node.ends:
            if not _is_drawn(shown, number, node, end):
                continue
            # A name of which a part is not known may be another one for each node.
            own_number = number if "*" in end.name else -1
            key = (end.carrier, end.name, own_number)
            place = places.setdefault(key, len(places))
            severity = find_severity(shown.findings_at(node, end))
            before = names.setdefault(key, _DiagramName(end.carrier, end.name, end.type, severity))
            names[key] = before._replace(
                type=before.type or end.type,
                severity=min(filter(None, (before.severity, severity)), default=""),
            )
            faults = [each.fault for _, each in shown.partners(number, end) if each.fault]
            # A request goes from the client to the service.
            is_from = end.kind in ("publisher", "client", "action client")
            is_certain = not (end.doubt or node.doubt)
            fault = faults[0] if faults else ""
            arrows.append(_DiagramArrow(number, place, is_from, is_certain, fault))
    return Diagram(tuple(nodes), tuple(names.values()), tuple(arrows))


def _is_drawn(shown: ShownGraph, number: int, node: GraphNode, end: GraphEnd) -> bool:
    """Return whether an end is drawn: with `--node`, one of the node or one that connects to it."""
    partners = shown.partners(number, end)
    if shown.node and node.label != shown.node and not partners:
        return False
    is_of_program = end.location == node.location
    return bool(partners) or not is_of_program or not end.is_offered


def graph_mermaid(shown: ShownGraph) -> str:
    """Return a graph as Mermaid, which GitHub, GitLab and Obsidian draw."""
    return "\n".join(["flowchart LR", *_mermaid_lines(make_diagram(shown))]) + "\n"


def _mermaid_lines(diagram: Diagram) -> Iterator[str]:
    for number, (namespace, nodes) in enumerate(_by_namespace(diagram)):
        indent = "  "
        if namespace != "/":
            yield f'  subgraph s{number}["{_mermaid(namespace)}"]'
            indent = "    "
        for index, node in nodes:
            yield f'{indent}n{index}["{_mermaid(node.label)}"]'
        if namespace != "/":
            yield "  end"
    for index, name in enumerate(diagram.names):
        start, end = _MERMAID_SHAPES[name.kind]
        kind = f"<br/>{_mermaid(name.type)}" if name.type else ""
        yield f'  t{index}{start}"{_mermaid(name.name)}{kind}"{end}'
    for arrow in diagram.arrows:
        line = "-->" if arrow.is_certain else "-.->"
        if arrow.fault:
            line = f'--x|"{_mermaid(arrow.fault)}"|'
        pair = [f"n{arrow.node}", f"t{arrow.name}"]
        source, target = pair if arrow.is_from_node else pair[::-1]
        yield f"  {source} {line} {target}"
    for severity, colour in _COLOURS.items():
        marked = [*_marked(diagram, severity)]
        if marked:
            yield f"  classDef {severity} stroke:{colour},stroke-width:3px"
            yield f"  class {','.join(marked)} {severity}"


def _by_namespace(diagram: Diagram) -> list[tuple[str, list[tuple[int, GraphNode]]]]:
    """Return the nodes by their namespaces, in the order of the launch file."""
    groups: dict[str, list[tuple[int, GraphNode]]] = {}
    for number, node, _ in diagram.nodes:
        groups.setdefault(node.namespace, []).append((number, node))
    return [*groups.items()]


def _marked(diagram: Diagram, severity: str) -> Iterator[str]:
    """Yield the nodes and names at which something of a severity is found."""
    for number, _, found_there in diagram.nodes:
        if found_there == severity:
            yield f"n{number}"
    for index, name in enumerate(diagram.names):
        if name.severity == severity:
            yield f"t{index}"


def _mermaid(text: str) -> str:
    """Return a text for a label between quotes, in which any other character is an entity."""
    return _PLAIN.sub(lambda match: f"#{ord(match[0])};", printable(text))


def graph_dot(shown: ShownGraph) -> str:
    """Return a graph in DOT, which Graphviz draws."""
    return "\n".join(["digraph graph_of_launch {", *_dot_lines(make_diagram(shown)), "}"]) + "\n"


def _dot_lines(diagram: Diagram) -> Iterator[str]:
    yield "  rankdir=LR;"
    yield '  node [fontname="sans-serif"];'
    severities = {number: severity for number, _, severity in diagram.nodes}
    for number, (namespace, nodes) in enumerate(_by_namespace(diagram)):
        if namespace != "/":
            yield f"  subgraph cluster_{number} {{ label={_dot(namespace)};"
        for index, node in nodes:
            style = "rounded" if not node.doubt else "rounded,dashed"
            colour = _dot_colour(severities[index])
            yield f'  n{index} [label={_dot(node.label)}, shape=box, style="{style}"{colour}];'
        if namespace != "/":
            yield "  }"
    for index, name in enumerate(diagram.names):
        label = _dot(name.name, name.type)
        shape = _DOT_SHAPES[name.kind]
        yield f"  t{index} [label={label}, shape={shape}{_dot_colour(name.severity)}];"
    for arrow in diagram.arrows:
        pair: Sequence[str] = [f"n{arrow.node}", f"t{arrow.name}"]
        source, target = pair if arrow.is_from_node else pair[::-1]
        looks = "" if arrow.is_certain else " [style=dashed]"
        if arrow.fault:
            looks = f" [arrowhead=tee, label={_dot(arrow.fault)}]"
        yield f"  {source} -> {target}{looks};"


def _dot_colour(severity: str) -> str:
    return f', color="{_COLOURS[severity]}", penwidth=3' if severity else ""


def _dot(*lines: str) -> str:
    """Return lines as one quoted text of DOT."""
    escaped = []
    for line in filter(None, lines):
        escaped.append(printable(line).replace("\\", "\\\\").replace('"', '\\"'))
    text = "\\n".join(escaped)
    return f'"{text}"'
