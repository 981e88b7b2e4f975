"""The page of a graph: the drawing, its nodes with their ends, and the transforms."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from grader import __version__
from grader.base.text import counted, printable
from grader.report.drawing.graph_layout import Curve, DrawnBox, lay_out
from grader.report.inspection import problem_counts
from grader.report.pages.inspection_page import problem_card
from grader.report.pages.shell import Assets, render_page
from grader.report.pages.viewing import ProblemCard
from grader.report.shown_graph import ShownGraph, transform_tree
from grader.report.writers.graph_diagrams import Diagram, diagram_of
from grader.ros.api import GraphEnd, GraphTransform

_MAX_DEPTH = 20  # of a frame that is indented
_MAX_PARAMETERS = 20
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
    """What is drawn as a box, and how it looks."""

    lines: tuple[str, ...]
    kind: str  # node, topic, service or action
    severity: str
    is_certain: bool
    about: str  # for a screen reader, and on hover


class _Drawing(NamedTuple):
    """The boxes and arrows of a page, the latter with a class of the style."""

    boxes: list[tuple[DrawnBox, _Item]]
    arrows: list[tuple[Curve, str]]
    width: float
    height: float


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
    counts = [counted(len(graph.nodes), "node"), counted(len(shown.connections), "connection")]
    drawing = _draw(diagram_of(shown))
    values: dict[str, object] = {
        "version": __version__,
        "title": printable(graph.path),
        "counts": ", ".join(counts),
        "effect": problem_counts(shown.inspection),
        "verdict": "passed" if shown.inspection.is_passed else "failed",
        "drawing": drawing,
        "nodes": [*_cards(shown)],
        "frames": [*_frames(graph.transforms)],
        "lists": [*_lists(shown)],
    }
    assets = Assets(styles="text.css student.css graph.css", scripts="graph.js")
    return render_page("graph.html", values, {}, assets)


def _lists(shown: ShownGraph) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Yield lists with their titles: pairs of what is listed and where it is, or what brings it."""
    graph = shown.graph
    manual = [(end.name, " or ".join(programs)) for end, programs in shown.manual]
    yield "From another terminal", manual
    unread = [(each.reason, each.location.file_and_line) for each in graph.unread]
    yield "What may start more", unread
    ended = [(each.program, each.location.file_and_line) for each in graph.processes]
    yield "Programs that end, or are no nodes", ended


def _draw(diagram: Diagram) -> _Drawing:
    """Return the boxes and arrows of a diagram, and its size."""
    items = _items_of(diagram)
    pairs: dict[tuple[str, str], str] = {}
    for arrow in diagram.arrows:
        ends = (f"n{arrow.node}", f"t{arrow.name}")
        if ends[1] not in items:
            continue
        look = "" if arrow.is_certain else "dashed"
        if arrow.fault:
            look = "broken"
        pairs.setdefault(ends if arrow.is_from_node else ends[::-1], look)
    layout = lay_out({name: item.lines for name, item in items.items()}, [*pairs])
    arrows = [(each, pairs[each.source, each.target]) for each in layout.curves]
    boxes = [(layout.boxes[name], item) for name, item in items.items()]
    return _Drawing(boxes, arrows, layout.width, layout.height)


def _items_of(diagram: Diagram) -> dict[str, _Item]:
    """Return what is drawn as boxes: the nodes, and as many names as a page holds."""
    items: dict[str, _Item] = {}
    for number, node, severity in diagram.nodes:
        about = f"node {node.label}, {node.program}"
        label = (printable(node.label),)
        items[f"n{number}"] = _Item(label, "node", severity, not node.doubt, about)
    for number, name in enumerate(diagram.names[: max(0, _MAX_DRAWN - len(items))]):
        about = f"{name.kind} {name.name}, {name.type or 'type not known'}"
        lines = tuple(printable(line) for line in (name.name, name.type) if line)
        items[f"t{number}"] = _Item(lines, name.kind, name.severity, True, about)
    return items


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
            values = ", ".join(
                f"{each.name} = {each.value}" for each in node.parameters[:_MAX_PARAMETERS]
            )
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
    root = ""
    for depth, each in transform_tree(transforms):
        if depth == 0 and each.parent != root:
            root = each.parent
            yield _FrameRow("", root, "")
        words = f"  static, {each.by}" if each.is_static else f"  {each.by}"
        if not each.is_certain:
            words += " (not certain)"
        yield _FrameRow("  " * min(depth + 1, _MAX_DEPTH), each.child, words)
