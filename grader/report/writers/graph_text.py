"""A graph on a terminal: the nodes in the order of the launch file, and what they connect to."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from rich.console import Console
from rich.text import Text

from grader.base.problems import Problem
from grader.base.source import Location
from grader.base.text import counted, enumerated, printable
from grader.report.shown_graph import VERBS, ShownGraph, transform_tree
from grader.report.writers.inspection_terminal import describe_topic
from grader.report.writers.terminal_page import INDENT, SEVERITY_LOOKS, Page
from grader.ros.api import Qos
from grader.workspace.api import Connection, GraphEnd, GraphNode, GraphTransform

_MAX_LISTED = 12
_MAX_INDENT = 40
_NESTED = 2 * INDENT


def graph_text(shown: ShownGraph, console: Console) -> None:
    """Print a graph."""
    page = Page(console, [])
    page.inset(_head(shown), indent=0)
    nodes = [place for place in shown.nodes if not shown.node or place[1].label == shown.node]
    doubts = _repeated_doubts([node for _, node in nodes])
    for doubt, name in doubts.items():
        page.inset(f"{name}: {printable(doubt)}", "dim", 0)
    for number, node in nodes:
        _add_node(page, shown, number, node, doubts)
    if not shown.node:
        _add_manual(page, shown)
        _add_heard(page, shown)
        _add_transforms(page, shown.transforms)
        graph = shown.graph
        ended = [(each.program, each.location) for each in graph.processes]
        _add_places(page, "Programs that end, or are no nodes", ended)
        not_started = [(each.program, each.location) for each in graph.not_started]
        _add_places(page, "Not started under these arguments", not_started)
        _add_places(page, "What may start more", graph.unread)
        _add_launches(page, shown)
    page.print()


def _head(shown: ShownGraph) -> Text:
    """Return how many nodes and connections there are, and what an inspection finds."""
    graph = shown.graph
    broken = sum(bool(each.fault) for each in shown.connections)
    counts = [
        counted(len(graph.nodes), "node"),
        counted(len(shown.connections) - broken, "connection"),
        counted(len(graph.transforms), "transform"),
    ]
    if broken:
        counts.insert(2, f"{counted(broken, 'pair')} not connected")
    style = "green" if shown.inspection.is_passed else "bold red"
    if graph.unread:
        counts.append(f"read in part ({_unread_lines(shown)} not evaluated)")
    return Text.assemble(
        (printable(graph.path), "bold"),
        f": {', '.join(counts)}; ",
        (shown.counts, style),
    )


def _unread_lines(shown: ShownGraph) -> str:
    """Return which lines were not evaluated, or how many, with the verb."""
    places = {each.location[:2]: each.location for each in shown.graph.unread}
    if len(places) > 1:
        return f"{len(places)} lines were"
    [place] = places.values()
    is_here = place.path == shown.graph.path
    return f"line {place.line} was" if is_here else f"{printable(place.file_and_line)} was"


def _repeated_doubts(nodes: Sequence[GraphNode]) -> dict[str, str]:
    """Return what stands at ends for each doubt that several of them have."""
    counts = Counter(end.doubt for node in nodes for end in node.ends if end.doubt)
    repeated = [doubt for doubt, count in counts.items() if count > 1]
    if len(repeated) == 1:
        return {repeated[0]: "not certain"}
    return {
        doubt: f"not certain, reason {number}" for number, doubt in enumerate(repeated, start=1)
    }


def _add_node(
    page: Page, shown: ShownGraph, number: int, node: GraphNode, doubts: Mapping[str, str]
) -> None:
    """Add a node with its ends; `doubts` are explained above."""
    title = Text(printable(node.label), "bold")
    if node.name:
        title.append(f"  {printable(node.program)}", "")
    if node.inside:
        title.append(f" in {printable(node.inside)}")
    title.append(f"  {printable(node.location.file_and_line)}", "dim")
    page.title(title, style="")
    for word, reason in (("may not run", node.doubt), ("may open more", node.opens_more)):
        if reason:
            page.inset(f"{word}: {printable(reason)}", "dim")
    _add_findings(page, shown.list_findings(number))
    quiet: dict[str, list[str]] = {}
    for end in node.ends:
        findings = shown.findings_at(node, end)
        # A known program offers it whether it is used or not.
        if shown.is_offered_only(number, end) and not (end.doubt or findings):
            quiet.setdefault(VERBS[end.kind], []).append(printable(end.name))
            continue
        partners = shown.partners(number, end)
        line = _end_line(shown, end, partners, doubts.get(end.doubt, ""))
        if end.location != node.location:
            line.append(f"  {printable(end.location.file_and_line)}", "dim")
        page.inset(line, indent=_NESTED, head=Text(" " * INDENT))
        _add_findings(page, findings)
    _add_details(page, shown, node, quiet)


def _add_details(
    page: Page, shown: ShownGraph, node: GraphNode, quiet: Mapping[str, list[str]]
) -> None:
    """Add what a node offers and nothing asks for, by verbs, and its parameters.

    Services and parameters are there if the whole is asked for.
    """
    is_whole = shown.verbose or shown.node
    for verb, names in quiet.items():
        if is_whole or verb == VERBS["publisher"]:
            listed = enumerated(names, _MAX_LISTED)
            page.inset(f"{verb}, and nothing here asks for: {listed}", "dim", _NESTED, Text("  "))
    values = [f"{printable(each.name)} = {_value(each.value)}" for each in node.parameters]
    if values and is_whole:
        page.inset(f"parameters: {enumerated(values)}", "dim", _NESTED, Text("  "))


def _end_line(
    shown: ShownGraph,
    end: GraphEnd,
    partners: Sequence[tuple[GraphNode, Connection]],
    doubt: str,
) -> Text:
    """Return an end with its type and quality, and what is at the other end.

    `doubt` stands for a reason that is explained above.
    """
    line = Text(f"{VERBS[end.kind]} ")
    line.append(printable(end.name), "bold" if not end.doubt else "")
    details = [printable(end.type) or "type not known", *_quality(end.qos)]
    line.append(f" [{', '.join(details)}]", "dim")
    if end.note:
        line.append(f" {printable(end.note)}", "dim")
    arrow = " -> " if end.is_offered else " <- "
    for index, (other, connection) in enumerate(partners[:_MAX_LISTED]):
        line.append(arrow if index == 0 else ", ")
        is_broken = bool(connection.fault)
        line.append(printable(other.label), "bold red" if is_broken else "cyan")
        if is_broken:
            line.append(f" (does not connect: {printable(connection.fault)})", "red")
        elif connection.doubt:
            line.append(" (perhaps)", "dim")
    if len(partners) > _MAX_LISTED:
        line.append(f" and {len(partners) - _MAX_LISTED} more")
    if not partners:
        is_known = not (shown.unknown_nodes or shown.graph.unread)
        line.append(f"{arrow}nothing {'here' if is_known else 'that is known'}", "dim")
    if end.doubt:
        line.append(f" ({doubt or f'not certain: {printable(end.doubt)}'})", "dim")
    return line


def _quality(qos: Qos) -> Iterator[str]:
    if qos.depth is not None:
        yield f"depth {qos.depth}"
    if qos.reliability is not None and qos.reliability != "reliable":
        yield printable(qos.reliability.replace("_", " "))
    if qos.durability is not None and qos.durability != "volatile":
        yield printable(qos.durability.replace("_", " "))


def _add_findings(page: Page, problems: Sequence[Problem]) -> None:
    for problem in problems:
        head = Text(f"{' ' * INDENT}{problem.severity} ", SEVERITY_LOOKS[problem.severity])
        place = printable(problem.location.file_and_line)
        page.inset(f"{problem.label} {printable(problem.message)} ({place})", "", _NESTED, head)


def _value(value: object) -> str:
    text = printable(str(value).lower() if isinstance(value, bool) else str(value))
    return text if len(text) <= _MAX_INDENT else f"{text[:_MAX_INDENT]}..."


def _add_manual(page: Page, shown: ShownGraph) -> None:
    if shown.manual:
        page.title("From another terminal")
    for end, programs in shown.manual:
        verb = "is read" if end.kind == "subscription" else "is open"
        page.inset(f"{printable(end.name)} {verb}: {enumerated(programs, _MAX_LISTED, 'or')}")


def _add_heard(page: Page, shown: ShownGraph) -> None:
    """Add what a recording has of each topic, and how it differs."""
    if shown.heard:
        page.title("Recorded")
    for topic, publishers, differences in shown.heard:
        details = ", ".join([describe_topic(topic), *_quality(Qos(None, *topic.qos))])
        arrow = f" <- {enumerated(publishers, _MAX_LISTED)}" if publishers else ""
        line = f"{printable(topic.name)} [{details}]{printable(arrow)}"
        page.inset(Text.assemble(line, (f" {'; '.join(differences)}".rstrip(), "red")))


def _add_transforms(page: Page, transforms: Sequence[GraphTransform]) -> None:
    """Add the transforms as a tree."""
    if transforms:
        page.title("Transforms")
    for depth, frame, words in transform_tree(transforms):
        line = Text(printable(frame)).append(f"  {printable(words)}".rstrip(), "dim")
        page.inset(line, indent=INDENT + min(INDENT * depth, _MAX_INDENT))


def _add_places(page: Page, title: str, rows: Sequence[tuple[str, Location]]) -> None:
    """Add texts, each with its place."""
    if rows:
        page.title(title)
    for text, at in rows:
        place = printable(at.file_and_line)
        page.inset(Text.assemble(printable(text), (f"  {place}", "dim")))


def _add_launches(page: Page, shown: ShownGraph) -> None:
    others = [path for path in shown.launches if path != shown.graph.path]
    if others:
        page.title("Other launch files, for --launch")
    for path in others[:_MAX_LISTED]:
        page.inset(printable(path))
    if len(others) > _MAX_LISTED:
        page.inset(f"... and {len(others) - _MAX_LISTED} more (--format json lists all)", "dim")
