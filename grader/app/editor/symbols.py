"""The names that files define, as editors list them."""

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.names_at import places_of
from grader.app.editor.places import TextPlace
from grader.app.editor.session import EditorSession, SupersededError
from grader.app.editor.text_ranges import TextRanges
from grader.base.errors import GraderError
from grader.ros.workspace.names import Definition

_KINDS = {
    "link": lsp.SymbolKind.Object,
    "frame": lsp.SymbolKind.Object,
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
    found = []
    defined = [it for it in look.names.in_file(place.path) if isinstance(it, Definition)]
    for each in places_of(look, defined):
        at = ranges.range(each.written or each.whole)
        kind = _KINDS.get(each.fact.kind, lsp.SymbolKind.Constant)
        found.append(lsp.DocumentSymbol(each.fact.name, kind, at, at, detail=each.fact.kind))
    return sorted(found, key=lambda it: (it.range.start.line, it.range.start.character))


def in_workspace(session: EditorSession, query: str) -> list[lsp.SymbolInformation]:
    """Return the names of a workspace that hold a text, each definition once."""
    try:
        look = session.look()
    except (GraderError, SupersededError):
        return []
    ranges = TextRanges(look, session.files.root)
    asked = query.lower()
    defined = []
    for fact in look.names.facts:
        if isinstance(fact, Definition) and asked in fact.name.lower():
            defined.append(fact)
    found = []
    for each in [*places_of(look, defined[:_MOST])]:
        place = ranges.place(each.written or each.whole)
        kind = _KINDS.get(each.fact.kind, lsp.SymbolKind.Constant)
        found.append(
            lsp.SymbolInformation(place, each.fact.name, kind, container_name=each.fact.kind)
        )
    return found
