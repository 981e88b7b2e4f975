"""The names that files define, as editors list them."""

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.app.editor.session import EditorSession, SupersededError
from grader.app.editor.text_ranges import TextRanges
from grader.base.errors import GraderError

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
    """Return the names that a file defines, in the order of the file."""
    ranges = place.ranges(look)
    symbols = []
    for each in look.names.defined_in(place.path):
        at = ranges.range(each.location)
        kind = _KINDS.get(each.kind, lsp.SymbolKind.Constant)
        symbols.append(lsp.DocumentSymbol(each.name, kind, at, at, detail=each.kind))
    return sorted(
        symbols, key=lambda symbol: (symbol.range.start.line, symbol.range.start.character)
    )


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
