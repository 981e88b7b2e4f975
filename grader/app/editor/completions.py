"""The names that an editor offers at a place where one is written."""

from lsprotocol.types import CompletionItem, CompletionItemKind, CompletionList, Range, TextEdit

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace, readings
from grader.workspace.api import TypedPlace, offered_at, read_typed_place

_MAX_OFFERED = 500


def typed_place(place: TextPlace) -> TypedPlace | None:
    """Return what is around a place of a text; None where no name is typed."""
    offset = place.lines.offset(place.line, place.column)
    return read_typed_place(place.path, place.lines.text, offset)


def completions(look: Look, place: TextPlace) -> CompletionList:
    """Return the names that may be written at a place, in the order in which they are shown."""
    typed = typed_place(place)
    if not typed:
        return CompletionList(is_incomplete=False, items=[])
    looks = readings(look, place, keeps_line=False)
    offers = offered_at([other.opened.workspace for other in looks], typed)
    start = place.lines.make_position(typed.offset - len(typed.typed))
    extent = Range(start, place.lines.position(place.line, place.column))
    items = []
    for number, offer in enumerate(offers[:_MAX_OFFERED]):
        item = CompletionItem(offer.name, kind=CompletionItemKind.Value)
        item.detail = offer.detail
        item.documentation = offer.text or None
        item.sort_text = f"{number:03}"
        item.filter_text = offer.name
        item.text_edit = TextEdit(extent, offer.name)
        items.append(item)
    return CompletionList(is_incomplete=len(offers) > _MAX_OFFERED, items=items)
