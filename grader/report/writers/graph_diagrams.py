"""A graph as Mermaid and as DOT: nodes joined by their topics, services and actions; and frames."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.text import printable
from grader.report.shown_graph import VERBS, ShownGraph, find_severity
from grader.workspace.api import PART_UNKNOWN, GraphEnd, GraphNode

_PLAIN = on_use(r"[^A-Za-z0-9_/ .,':*()-]")
_MERMAID_SHAPES = {"topic": ("([", "])"), "service": ("{{", "}}"), "action": ("[[", "]]")}
_MERMAID_LINES = {"": "-->", "dashed": "-.->", "broken": "--x"}
_DOT_SHAPES = {"node": "box", "service": "hexagon", "action": "octagon"}
_DOT_LINES = {"": "", "dashed": "style=dashed", "broken": "arrowhead=tee"}
_MAX_ALONE = 6  # ends of a node that connect to nothing
_COLOURS = {"error": "#b3261e", "warning": "#7d4e00"}
_TO_NAME = ("publisher", "client", "action client")  # a request goes from the client


class DiagramBox(NamedTuple):
    """A node, a topic, service or action, or a frame."""

    id: str
    kind: str  # node, topic, service, action or frame
    name: str
    type: str = ""  # the program of a node
    severity: str = ""  # of what is found at it; empty without
    is_certain: bool = True
    group: str = ""  # what it is a part of, such as a namespace
    alone: Strings = ()  # what a node does that nothing else takes part in

    @property
    def lines(self) -> Strings:
        """What stands in it, as it can be printed."""
        below = self.alone if self.kind == "node" else (self.type,)
        return tuple(map(printable, filter(None, (self.name, *below))))


class _DiagramArrow(NamedTuple):
    """An arrow between boxes, by their ids."""

    source: str
    target: str
    look: str  # dashed or broken; empty for neither
    words: str = ""


class Diagram(NamedTuple):
    """What is drawn of a graph: the boxes of nodes, names and frames in this order, and arrows.

    What a program of another package publishes or serves and nothing asks for is not drawn.
    """

    boxes: tuple[DiagramBox, ...]
    arrows: tuple[_DiagramArrow, ...]


def make_diagram(shown: ShownGraph) -> Diagram:
    """Return what is drawn of a graph."""
    names: dict[tuple[str, str, int], DiagramBox] = {}
    nodes = []
    arrows = []
    for number, node in shown.nodes:
        alone = []
        for end in node.ends:
            severity = find_severity(shown.findings_at(node, end))
            partners = shown.partners(number, end)
            if not partners and not severity:
                if _is_drawn_alone(shown, number, end):
                    alone.append(f"{VERBS[end.kind]} {end.name}")
                continue
            # A name of which a part is not known may be another one for each node.
            own_number = number if PART_UNKNOWN in end.name else -1
            key = (end.carrier, end.name, own_number)
            before = names.get(key) or DiagramBox(f"t{len(names)}", end.carrier, end.name)
            names[key] = before._replace(
                type=before.type or end.type,
                severity=min(filter(None, (before.severity, severity)), default=""),
            )
            fault = next((each.fault for _, each in partners if each.fault), "")
            arrows.append(_arrow_at(f"n{number}", node, end, before.id, fault))
        nodes.append(_node_box(shown, number, node, alone))
    frames, transforms = _draw_transforms(shown)
    return Diagram((*nodes, *names.values(), *frames), (*arrows, *transforms))


def _is_drawn_alone(shown: ShownGraph, number: int, end: GraphEnd) -> bool:
    is_near = shown.node in ("", shown.graph.nodes[number].label)
    return is_near and not shown.is_offered_only(number, end)


def _arrow_at(
    node_id: str, node: GraphNode, end: GraphEnd, name_id: str, fault: str
) -> _DiagramArrow:
    """Return the arrow between a node and the name of one of its ends."""
    look = "dashed" if end.doubt or node.doubt else ""
    if fault:
        look = "broken"
    if end.kind in _TO_NAME:
        return _DiagramArrow(node_id, name_id, look, fault)
    return _DiagramArrow(name_id, node_id, look, fault)


def _node_box(shown: ShownGraph, number: int, node: GraphNode, alone: Sequence[str]) -> DiagramBox:
    severity = find_severity(shown.list_findings(number))
    group = node.namespace.removesuffix("/")
    listed = list(alone[:_MAX_ALONE])
    if len(alone) > _MAX_ALONE:
        listed.append(f"and {len(alone) - _MAX_ALONE} more")
    is_certain = not node.doubt
    return DiagramBox(
        f"n{number}", "node", node.label, node.program, severity, is_certain, group, tuple(listed)
    )


def _draw_transforms(shown: ShownGraph) -> tuple[list[DiagramBox], list[_DiagramArrow]]:
    """Return the frames and the transforms between them."""
    frames: dict[str, DiagramBox] = {}
    arrows = []
    for each in shown.transforms:
        for name in (each.parent, each.child):
            frames.setdefault(
                name, DiagramBox(f"f{len(frames)}", "frame", name, group="Transforms")
            )
        look = "" if each.is_certain else "dashed"
        pair = (frames[each.parent].id, frames[each.child].id)
        words = each.words if each.source != "robot" else ""
        arrows.append(_DiagramArrow(*pair, look, words))
    return list(frames.values()), arrows


def _groups(diagram: Diagram) -> Iterator[tuple[str, str, list[DiagramBox]]]:
    """Yield the boxes of each group, with its number and title; those of none first."""
    boxes = sorted(diagram.boxes, key=lambda box: box.group)
    for number, (title, inside) in enumerate(groupby(boxes, lambda box: box.group)):
        yield f"s{number}", title, list(inside)


def graph_mermaid(shown: ShownGraph) -> str:
    """Return a graph as Mermaid, which GitHub, GitLab and Obsidian draw."""
    return "\n".join(["flowchart LR", *_mermaid_lines(make_diagram(shown))]) + "\n"


def _mermaid_lines(diagram: Diagram) -> Iterator[str]:
    for number, title, boxes in _groups(diagram):
        if title:
            yield f'  subgraph {number}["{_mermaid(title)}"]'
        for box in boxes:
            start, end = _MERMAID_SHAPES.get(box.kind, ("[", "]"))
            mark = f":::{box.severity}" if box.severity else ""
            yield f'  {box.id}{start}"{"<br/>".join(map(_mermaid, box.lines))}"{end}{mark}'
        if title:
            yield "  end"
    for source, target, look, words in diagram.arrows:
        label = f'|"{_mermaid(words)}"|' if words else ""
        yield f"  {source} {_MERMAID_LINES[look]}{label} {target}"
    for severity, colour in _COLOURS.items():
        if any(box.severity == severity for box in diagram.boxes):
            yield f"  classDef {severity} stroke:{colour},stroke-width:3px"


def _mermaid(text: str) -> str:
    """Return a text for a label between quotes, in which any other character is an entity."""
    return _PLAIN.sub(lambda match: f"#{ord(match[0])};", printable(text))


def graph_dot(shown: ShownGraph) -> str:
    """Return a graph in DOT, which Graphviz draws."""
    return "\n".join(["digraph graph_of_launch {", *_dot_lines(make_diagram(shown)), "}"]) + "\n"


def _dot_lines(diagram: Diagram) -> Iterator[str]:
    yield "  rankdir=LR;"
    yield '  node [fontname="sans-serif"];'
    for number, title, boxes in _groups(diagram):
        if title:
            yield f"  subgraph cluster_{number} {{ label={_dot(title)};"
        for box in boxes:
            looks = f"label={_dot(*box.lines)}, shape={_DOT_SHAPES.get(box.kind, 'ellipse')}"
            if not box.is_certain:
                looks += ", style=dashed"
            if box.severity:
                looks += f', color="{_COLOURS[box.severity]}", penwidth=3'
            yield f"  {box.id} [{looks}];"
        if title:
            yield "  }"
    for source, target, look, words in diagram.arrows:
        details = ", ".join(filter(None, (_DOT_LINES[look], words and f"label={_dot(words)}")))
        yield f"  {source} -> {target}{f' [{details}]' if details else ''};"


def _dot(*lines: str) -> str:
    """Return lines as one quoted text of DOT."""
    escaped = [printable(line).replace("\\", "\\\\").replace('"', '\\"') for line in lines]
    text = "\\n".join(escaped)
    return f'"{text}"'
