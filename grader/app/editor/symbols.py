"""The names that files define, as editors list them."""

from collections.abc import Sequence

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.app.editor.session import EditorSession, SupersededError
from grader.app.editor.text_ranges import TextRanges
from grader.base.errors import GraderError
from grader.ros.api import Configuration

_KINDS = {
    "frame": lsp.SymbolKind.Object,
    "link": lsp.SymbolKind.Object,
    "joint": lsp.SymbolKind.Property,
    "controller": lsp.SymbolKind.Class,
    "node": lsp.SymbolKind.Class,
    "parameter": lsp.SymbolKind.Variable,
    "launch argument": lsp.SymbolKind.Variable,
    "xacro argument": lsp.SymbolKind.Variable,
    "topic": lsp.SymbolKind.Event,
}
_MOST = 500


def in_document(look: Look, place: TextPlace) -> list[lsp.DocumentSymbol]:
    """Return the names that a file defines, in the order of the file.

    Those of a robot are a tree: below a link the joints that it is the parent of, below a joint its
    child. In a launch file, they are the nodes that it starts and its arguments.
    """
    ranges = place.ranges(look)
    symbols = []
    started = look.names.started_in(place.path)
    for one in started:
        at = ranges.range(one.location)
        word = lsp.Range(at.start, at.start)
        symbols.append(lsp.DocumentSymbol(one.name, lsp.SymbolKind.Class, at, word, one.detail))
    for each in look.names.defined_in(place.path):
        if started and each.kind != "launch argument":
            continue
        at = ranges.range(each.location)
        kind = _KINDS.get(each.kind, lsp.SymbolKind.Constant)
        symbols.append(lsp.DocumentSymbol(each.name, kind, at, at, detail=each.kind))
    symbols.sort(key=lambda symbol: (symbol.range.start.line, symbol.range.start.character))
    robot = look.robots.get(place.path)
    return _as_tree(symbols, robot) if robot and robot.roots else symbols


def _as_tree(
    symbols: Sequence[lsp.DocumentSymbol], robot: Configuration
) -> list[lsp.DocumentSymbol]:
    """Return symbols of which those of a robot are below each other."""
    links = {symbol.name: symbol for symbol in symbols if symbol.detail == "link"}
    joints = {symbol.name: symbol for symbol in symbols if symbol.detail == "joint"}
    nested = set()
    for joint in robot.robot.joints:
        parent = links.get(joint.parent)
        child = links.get(joint.child)
        between = joints.get(joint.name)
        if parent is None or between is None or child is None:
            continue
        between.detail = f"{joint.type} joint"
        for above, below in ((parent, between), (between, child)):
            above.children = [*(above.children or ()), below]
            nested.add(id(below))
    return [symbol for symbol in symbols if id(symbol) not in nested]


def in_workspace(session: EditorSession, query: str) -> list[lsp.SymbolInformation]:
    """Return the names of a workspace that hold a text, each definition once."""
    try:
        look = session.look()
    except (GraderError, SupersededError):
        return []
    ranges = TextRanges(look, session.files.root)
    symbols = []
    for each in look.names.holding(query, _MOST):
        kind = _KINDS.get(each.kind, lsp.SymbolKind.Constant)
        place = ranges.place(each.location)
        symbols.append(lsp.SymbolInformation(place, each.name, kind, container_name=each.kind))
    return symbols
