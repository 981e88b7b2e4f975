"""The graph of a workspace in which a name is another one: what a rename has to lead to."""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import suppress
from fnmatch import fnmatchcase

from grader.base.errors import NotDecided
from grader.base.grouping import Strings
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.launch_graph import LaunchGraph, unconnected_ends
from grader.workspace.index.names_in_graph import ComputedName
from grader.workspace.index.written_names import WrittenName
from grader.workspace.model.workspace import Workspace

PARAMETER = "parameter"  # the kind of a row
_ENDS = ("topic", "service", "action")
_NODES = ("node", "controller")
_SECTIONS = ("controller", "plugin section")  # which are parts of names of parameters
_FRAMES = ("link", "frame")
_Row = Strings


def renamed_owner(place: WrittenName, new: str) -> str:
    """Return the owner of a place when it has another name: the full name of a topic ends in it."""
    if place.kind in _ENDS and place.owner.endswith(place.name):
        return place.owner.removesuffix(place.name) + new
    return place.owner


def computed_like(
    names: Iterable[ComputedName], places: Collection[WrittenName]
) -> Iterator[ComputedName]:
    """Yield the names that no file writes and that may be the one of some places."""
    for computed in names:
        if any(_may_be(computed, place) for place in places):
            yield computed


def open_ends(workspace: Workspace, places: Collection[WrittenName]) -> Iterator[ComputedName]:
    """Yield what may have the other end of a topic of which a launch has one end only.

    These are programs of which not all ends are known, and launch files that are not read. Nothing
    is yielded where this takes too much work.
    """
    names = {(place.kind, place.owner) for place in places if place.kind in _ENDS}
    with suppress(NotDecided):
        for graph in make_graph(workspace).launched if names else ():
            alone = {(end.carrier, end.name) for end in unconnected_ends(graph)}
            for kind, name in names.intersection(alone):
                for node in graph.nodes:
                    if node.opens_more:
                        yield ComputedName(kind, name, node.location, node.opens_more)
                for unread in graph.unread:
                    yield ComputedName(kind, name, unread.location, unread.reason)


def _may_be(computed: ComputedName, place: WrittenName) -> bool:
    """Return whether a name that no file writes is, or may be, the one at a place."""
    if computed.kind == "frame":
        return place.kind in _FRAMES and fnmatchcase(place.name, computed.name)
    if computed.kind != place.kind:
        return False
    if computed.name == place.owner:
        return True
    return place.owner.startswith("/") and fnmatchcase(place.owner, computed.name)


def graph_under(
    workspace: Workspace,
    places: Collection[WrittenName],
    new: str,
    others: Collection[str] = (),
) -> Counter[_Row]:
    """Return the ends, nodes and transforms after each launch, with another name for some places.

    There are none where this takes too much work.

    Args:
        workspace: The packages and the robots.
        places: All places of a name.
        new: The other name.
        others: The files in which the name is another one, such as the link of another robot.
    """
    rows: Counter[_Row] = Counter()
    name = _renaming(places, new)
    try:
        for number, graph in enumerate(make_graph(workspace).launched):
            rows.update(_rows(graph, name, others, number))
    except NotDecided:
        rows.clear()
    return rows


def _rows(
    graph: LaunchGraph, name: "_Renaming", others: Collection[str], number: int
) -> Iterator[_Row]:
    """Yield the rows of a graph. The frames of other files keep their names."""
    for node in graph.nodes:
        program = f"{number} {node.kind} {node.location.path}:{node.location.line}"
        yield program, name("node", node.name)
        for given in node.parameters:
            yield program, PARAMETER, name(f"parameter of {node.program}", given.name)
        for end in node.ends:
            yield program, end.kind, name(end.carrier, end.name)
    for transform in graph.transforms:
        at = transform.location
        frames = (transform.parent, transform.child)
        if at.path not in others:
            frames = name("frame", transform.parent), name("frame", transform.child)
        yield f"{number} {at.path}:{at.line}", *frames


_Renaming = Callable[[str, str], str]


def _renaming(places: Collection[WrittenName], new: str) -> _Renaming:
    """Return what gives a name of the graph, of some kind, the name that it has afterwards."""
    kinds = {place.kind for place in places}
    full = {(place.kind, place.owner): renamed_owner(place, new) for place in places}
    old = {place.name for place in places}
    programs = set()
    for place in places:
        if place.kind == "parameter":
            package, _, executable = place.owner.partition("/")
            program = executable if package == executable else place.owner
            programs.add(f"parameter of {program}")

    def rename(kind: str, name: str) -> str:
        if kind == "frame":
            return new if name in old and not kinds.isdisjoint(_FRAMES) else name
        if kind.startswith("parameter of "):
            if name in old:
                return new if kind in programs else name
            if kinds.isdisjoint(_SECTIONS):
                return name
            return ".".join(new if part in old else part for part in name.split("."))
        if not kinds.isdisjoint(_NODES):
            parts = name.split("/")
            last = len(parts) if kind == "node" else len(parts) - 1
            renamed = [new if part in old else part for part in parts[:last]]
            return "/".join(renamed + parts[last:])
        return full.get((kind, name), name)

    return rename
