"""The page of a graph: the drawing, its nodes with their ends, and the transforms."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from grader import __version__
from grader.base.text import counted, printable
from grader.report.drawing.graph_layout import DrawnBox, lay_out
from grader.report.inspection import problem_counts
from grader.report.pages.inspection_page import problem_card
from grader.report.pages.shell import Assets, render_page
from grader.report.pages.viewing import ProblemCard
from grader.report.shown_graph import ShownGraph
from grader.report.writers.graph_diagrams import Diagram, diagram_of
from grader.ros.api import GraphEnd, GraphTransform

_MAX_PROBLEMS = 100
_MAX_DRAWN = 250  # boxes: a page has at most 150 KB
_VERBS = {
    "publisher": "publishes",
    "subscription": "subscribes",
    "service": "serves",
    "client": "calls",
    "action server": "serves",
    "action client": "calls",
}


class _Item(NamedTuple):
    """A box of the drawing, and how it looks."""

    box: DrawnBox
    kind: str  # node, topic, service or action
    severity: str
    is_certain: bool
    about: str  # for a screen reader, and on hover


class _Arrow(NamedTuple):
    """An arrow of the drawing."""

    source: str
    target: str
    path: str
    look: str  # a class of the style


class _EndRow(NamedTuple):
    """An end in the table of its node."""

    verb: str
    name: str
    type: str
    partners: str
    place: str
    remark: str
    severity: str


class _NodeCard(NamedTuple):
    """A node with its ends and findings."""

    id: str
    title: str
    program: str
    place: str
    remarks: list[str]
    rows: list[_EndRow]
    problems: list[ProblemCard]


class _FrameRow(NamedTuple):
    """A transform in the tree."""

    indent: str
    child: str
    words: str


def graph_html(shown: ShownGraph) -> str:
    """Return a graph as an HTML page."""
    graph = shown.graph
    diagram = diagram_of(shown)
    names = diagram.names[: max(0, _MAX_DRAWN - len(diagram.nodes))]
    items, arrows, size = _drawing(diagram._replace(names=names))
    counts = [counted(len(graph.nodes), "node"), counted(len(shown.connections), "connection")]
    values: dict[str, object] = {
        "version": __version__,
        "title": printable(graph.path),
        "counts": ", ".join(counts),
        "effect": problem_counts(shown.inspection),
        "verdict": "passed" if shown.inspection.is_passed else "failed",
        "width": size[0],
        "height": size[1],
        "items": items,
        "arrows": arrows,
        "nodes": [*_cards(shown)],
        "frames": [*_frames(graph.transforms)],
        "manual": [(end.name, " or ".join(programs)) for end, programs in shown.manual],
        "unread": [(each.reason, each.location.file_and_line) for each in graph.unread],
        "processes": [(each.program, each.location.file_and_line) for each in graph.processes],
    }
    assets = Assets(styles="text.css student.css graph.css", scripts="graph.js")
    return render_page("graph.html", values, {}, assets)


def _drawing(diagram: Diagram) -> tuple[list[_Item], list[_Arrow], tuple[float, float]]:
    """Return the boxes and arrows of a diagram, and its size."""
    texts: dict[str, tuple[str, ...]] = {}
    looks: dict[str, tuple[str, str, bool, str]] = {}
    for number, node, severity in diagram.nodes:
        texts[f"n{number}"] = (printable(node.label),)
        about = f"node {node.label}, {node.program}"
        looks[f"n{number}"] = ("node", severity, not node.doubt, about)
    for number, name in enumerate(diagram.names):
        texts[f"t{number}"] = tuple(printable(line) for line in (name.name, name.type) if line)
        about = f"{name.kind} {name.name}, {name.type or 'type not known'}"
        looks[f"t{number}"] = (name.kind, name.severity, True, about)
    pairs: dict[tuple[str, str], str] = {}
    for arrow in diagram.arrows:
        if f"t{arrow.name}" not in texts:
            continue
        ends = (f"n{arrow.node}", f"t{arrow.name}")
        look = "broken" if arrow.fault else "" if arrow.is_certain else "dashed"
        pairs.setdefault(ends if arrow.is_from_node else ends[::-1], look)
    layout = lay_out(texts, [*pairs])
    items = [_Item(layout.boxes[name], *look) for name, look in looks.items()]
    arrows = [
        _Arrow(each.source, each.target, each.path, pairs[each.source, each.target])
        for each in layout.curves
    ]
    return items, arrows, (layout.width, layout.height)


def _cards(shown: ShownGraph) -> Iterator[_NodeCard]:
    """Yield the nodes with their ends; what a program serves that nothing asks for is a remark."""
    for number, node in shown.nodes:
        rows: list[_EndRow] = []
        unused: list[str] = []
        problems: dict[Any, None] = dict.fromkeys(shown.findings_of(number))
        for end in node.ends:
            partners = shown.partners(number, end)
            findings = shown.findings_at(node, end)
            problems |= dict.fromkeys(findings)
            if end.is_offered and end.location == node.location and not partners:
                unused.append(end.name)
                continue
            others = [
                f"{other.label}{' (does not connect)' if each.fault else ''}"
                for other, each in partners
            ]
            severity = findings[0].severity if findings else ""
            rows.append(_end_row(end, ", ".join(others), severity))
        remarks = [f"in the process of {node.inside}"] if node.inside else []
        if node.doubt:
            remarks.append(f"may not run: {node.doubt}")
        if node.opens_more:
            remarks.append(f"may open more: {node.opens_more}")
        if unused:
            remarks.append(f"nothing here asks for: {', '.join(unused)}")
        if node.parameters:
            values = ", ".join(f"{each.name} = {each.value}" for each in node.parameters[:20])
            remarks.append(f"parameters: {values}")
        cards = [problem_card(each, shown.inspection.source) for each in problems]
        place = node.location.file_and_line
        yield _NodeCard(f"n{number}", node.label, node.program, place, remarks, rows, cards)


def _end_row(end: GraphEnd, partners: str, severity: str) -> _EndRow:
    quality: Mapping[str, object] = {
        "depth": end.qos.depth,
        "reliability": end.qos.reliability,
        "durability": end.qos.durability,
    }
    words = [f"{name} {value}" for name, value in quality.items() if value is not None]
    words += [text for text in (end.note, end.doubt and f"not certain: {end.doubt}") if text]
    place = end.location.file_and_line
    remark = ", ".join(words).replace("_", " ")
    return _EndRow(
        _VERBS[end.kind], end.name, end.type, partners or "nothing known", place, remark, severity
    )


def _frames(transforms: tuple[GraphTransform, ...]) -> Iterator[_FrameRow]:
    """Yield the frames as a tree, each transform once."""
    children: dict[str, list[GraphTransform]] = {}
    for each in transforms:
        children.setdefault(each.parent, []).append(each)
    below = {each.child for each in transforms}
    roots = [parent for parent in children if parent not in below] or [*children][:1]
    seen: set[GraphTransform] = set()
    for root in roots:
        yield _FrameRow("", root, "")
        stack = [("  ", each) for each in reversed(children[root])]
        while stack:
            indent, each = stack.pop()
            if each in seen:
                continue
            seen.add(each)
            static = "static, " if each.is_static else ""
            doubt = "" if each.is_certain else " (not certain)"
            yield _FrameRow(indent, each.child, f"  {static}{each.by}{doubt}")
            deeper = f"{indent}  "[:40]
            stack += [(deeper, other) for other in reversed(children.get(each.child, []))]
