"""The page of a graph: the drawing, its nodes with their ends, and the transforms."""

from collections.abc import Iterator
from typing import NamedTuple

from grader import __version__
from grader.base.text import counted, cut, printable
from grader.report.drawing.graph_layout import Curve, DrawnBox, lay_out
from grader.report.inspection import Inspection
from grader.report.pages.inspection_page import problem_card
from grader.report.pages.shell import Assets, render_page
from grader.report.pages.viewing import GRAPH_SCRIPT, SOURCES, STYLES, GraphViewing, ProblemCard
from grader.report.shown_graph import VERBS, ShownGraph, transform_tree
from grader.report.writers.graph_diagrams import Diagram, DiagramBox, make_diagram
from grader.workspace.api import GraphEnd, GraphNode, LaunchGraph

_MAX_PARAMETERS = 20
# A page has at most 150 KB: so many boxes, rows of ends, findings and nodes are on it.
_MAX_DRAWN = 130
_MAX_ROWS = 150
_MAX_FINDINGS = 30
_MAX_NODES = 200
# On a page about something else, at most 20 KB are for a graph.
_MOST_FITTING = 60
_MAX_BYTES = 18_000
_BYTES_A_BOX, _BYTES_AN_ARROW = 420, 190  # of markup, without names
_MAX_LETTERS = 120  # of a text about a box, and of a list of names


class GraphDrawing(NamedTuple):
    """The boxes and arrows of a page, the latter with a class of the style."""

    boxes: list[tuple[DrawnBox, DiagramBox, str]]  # with what is said of each
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


def graph_html(shown: ShownGraph, viewing: GraphViewing | None = None) -> str:
    """Return a graph as an HTML page; that of `grader view` with `viewing`."""
    graph = shown.graph
    counts = [counted(len(graph.nodes), "node"), counted(len(shown.connections), "connection")]
    drawing = _draw(make_diagram(shown))
    values = {
        "version": __version__,
        "title": printable(graph.path),
        "counts": ", ".join(counts),
        "effect": shown.counts,
        "verdict": "passed" if shown.inspection.is_passed else "failed",
        "drawing": drawing,
        "nodes": list(_cards(shown)),
        "frames": list(transform_tree(graph.transforms)),
        "lists": list(_lists(shown)),
        "viewing": viewing,
    }
    assets = Assets(styles="text.css student.css graph.css", scripts="graph.js")
    if not viewing:
        return render_page("graph.html", values, {}, assets)
    assets = assets._replace(
        styles=f"{assets.styles} {STYLES}",
        scripts=f"{assets.scripts} {GRAPH_SCRIPT}",
        sources=SOURCES,
    )
    data = {"view": {"number": viewing.number, "address": viewing.address}}
    return render_page("graph.html", values, data, assets)


def fitting_drawing(graph: LaunchGraph) -> GraphDrawing | None:
    """Return the drawing of a graph for a page on something else: as much as such a page holds.

    It is None without nodes.
    """
    if not graph.nodes:
        return None
    shown = ShownGraph(graph, Inspection(graph.path))
    diagram = make_diagram(shown)
    drawing = _draw(diagram, _MOST_FITTING)
    while len(drawing.boxes) > 1 and _estimate_size(drawing) > _MAX_BYTES:
        drawing = _draw(diagram, len(drawing.boxes) * 2 // 3)
    return drawing


def _estimate_size(drawing: GraphDrawing) -> int:
    """Return about how many bytes of markup a drawing has."""
    size = _BYTES_AN_ARROW * len(drawing.arrows)
    for box, _, about in drawing.boxes:
        size += _BYTES_A_BOX + len(about) + sum(map(len, box.lines))
    return size


def _lists(shown: ShownGraph) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Yield lists with their titles: pairs of what is listed and where it is, or what brings it."""
    graph = shown.graph
    manual = [(end.name, " or ".join(programs)) for end, programs in shown.manual]
    yield "From another terminal", manual
    unread = [(each.reason, each.location.file_and_line) for each in graph.unread]
    yield "What may start more", unread
    ended = [(each.program, each.location.file_and_line) for each in graph.processes]
    yield "Programs that end, or are no nodes", ended


def _draw(diagram: Diagram, most: int = _MAX_DRAWN) -> GraphDrawing:
    """Return so many boxes of a diagram with their arrows, and its size; frames are listed."""
    boxes = {box.id: box for box in diagram.boxes[:most] if box.kind != "frame"}
    pairs: dict[tuple[str, str], str] = {}
    for source, target, look, _ in diagram.arrows:
        if source in boxes and target in boxes:
            pairs.setdefault((source, target), look)
    layout = lay_out({name: box.lines for name, box in boxes.items()}, list(pairs))
    arrows = []
    for each in layout.curves:
        arrows.append((each, pairs[each.source, each.target]))
    placed = []
    for box in boxes.values():
        placed.append((layout.boxes[box.id], box, _about(box)))
    return GraphDrawing(placed, arrows, layout.width, layout.height)


def _about(box: DiagramBox) -> str:
    """Return what is said of a box on hover, and to a screen reader."""
    return cut(f"{box.kind} {box.name}, {box.type or 'type not known'}", _MAX_LETTERS)


def _cards(shown: ShownGraph) -> Iterator[_NodeCard]:
    """Yield the nodes with their ends and findings, as many as a page holds."""
    rows_left = _MAX_ROWS
    findings_left = _MAX_FINDINGS
    for number, node in shown.nodes[:_MAX_NODES]:
        rows = list(_list_rows(shown, number, node))
        problems = dict.fromkeys(shown.list_findings(number))
        for end in node.ends:
            problems |= dict.fromkeys(shown.findings_at(node, end))
        findings = list(problems)[:findings_left]
        remarks = list(_remarks_on(shown, number, node))
        hidden = len(rows) - rows_left
        if hidden > 0:
            remarks.append(f"{counted(hidden, 'further end')} (--format json lists all)")
        yield _NodeCard(
            id=f"n{number}",
            title=node.label,
            program=node.program,
            place=node.location.file_and_line,
            remarks=remarks,
            rows=rows[:rows_left],
            problems=[problem_card(each, shown.inspection.source) for each in findings],
        )
        rows_left = max(0, rows_left - len(rows))
        findings_left -= len(findings)


def _list_rows(shown: ShownGraph, number: int, node: GraphNode) -> Iterator[_EndRow]:
    """Yield the ends of a node, without what it offers and nothing asks for."""
    for end in node.ends:
        if shown.is_offered_only(number, end):
            continue
        others = []
        for other, connection in shown.partners(number, end):
            others.append(f"{other.label} (does not connect)" if connection.fault else other.label)
        findings = shown.findings_at(node, end)
        severity = findings[0].severity if findings else ""
        yield _end_row(end, cut(", ".join(others), _MAX_LETTERS), severity)


def _remarks_on(shown: ShownGraph, number: int, node: GraphNode) -> Iterator[str]:
    """Yield what is said of a node besides its ends."""
    if node.inside:
        yield f"in the process of {node.inside}"
    if node.doubt:
        yield f"may not run: {node.doubt}"
    if node.opens_more:
        yield f"may open more: {node.opens_more}"
    unused = [end.name for end in node.ends if shown.is_offered_only(number, end)]
    if unused:
        yield f"nothing here asks for: {', '.join(unused)}"
    if node.parameters:
        values = [f"{each.name} = {each.value}" for each in node.parameters[:_MAX_PARAMETERS]]
        yield f"parameters: {', '.join(values)}"


def _end_row(end: GraphEnd, partners: str, severity: str) -> _EndRow:
    quality = {
        "depth": end.qos.depth,
        "reliability": end.qos.reliability,
        "durability": end.qos.durability,
    }
    words = [f"{name} {value}" for name, value in quality.items() if value is not None]
    words += [text for text in (end.note, end.doubt and f"not certain: {end.doubt}") if text]
    place = end.location.file_and_line
    remark = ", ".join(words).replace("_", " ")
    return _EndRow(
        VERBS[end.kind], end.name, end.type, partners or "nothing known", place, remark, severity
    )
