"""Pieces of edits: what is set or changed, named by what is wrong with it."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.hints.robot.draft import Draft
from grader.hints.robot.elements import Set
from grader.hints.robot.numbers import Values, mistake_in, values_of
from grader.source import Edits
from grader.xml.parsing import Element
from grader.xml.urdf_format import TAGS

ENDS = ("parent", "child")

# The ranks of pieces: values of a sibling of the student's own design; the reference's; the student's own, corrected;
# several at once, or another structure.
SIBLING, REFERENCE, OWN, STRUCTURE = range(4)


class Piece(NamedTuple):
    """An edit that may undo a mistake: values to set, edits of the text, or both; what is wrong, and the link.

    The `rank` orders pieces that gain as much. `around` is the element that changes.
    """

    cause: str
    link: str
    sets: tuple[Set, ...] = ()
    edits: Edits = ()
    rank: int = REFERENCE
    around: Element | None = None


class PieceMaker:
    """Makes pieces for a robot beside the reference's; only `known` names are shown, because the reference has them."""

    def __init__(self, draft: Draft, reference: Draft) -> None:
        self.draft, self.reference = draft, reference
        links, materials = ([one.name for one in found] for found in (reference.robot.links, reference.robot.materials))
        self.known = {*links, *materials}

    def piece(
        self,
        element: Element,
        cause: str,
        edits: Edits = (),
        *,
        sets: tuple[Set, ...] = (),
        rank: int = REFERENCE,
        link: str = "",
        tag: str = "",
    ) -> Piece:
        """Return a piece that changes an element, or its child with a tag; {} in the cause stands for its name."""
        cause = cause.replace("{}", self.draft.describe(element, tag, self.known))
        around = element if element.getparent() is self.draft.root else element.getparent()
        return Piece(cause, link or self.draft.link_of(element), sets, edits, rank, around)

    def of_sets(self, sets: Sequence[Set], rank: int = REFERENCE) -> Piece:
        """Return the piece that sets values of one element, named by what is wrong with them."""
        first = sets[0]
        return self.piece(first.owner, _cause(sets), sets=tuple(sets), rank=rank, tag=first.tag)

    def each(self, sets: Sequence[Set]) -> Iterator[Piece]:
        """Yield the pieces that set each value alone, and all together."""
        yield from (self.of_sets([one]) for one in sets)
        if len(sets) > 1:
            yield self.of_sets(sets)

    def moved(self, element: Element, parent: Element) -> Piece:
        """Return the piece that moves an element into another one."""
        text = self.draft.text(element)
        was = element.getparent()
        cause = f"<{element.tag}> is inside <{was.tag if was is not None else ''}>; it belongs in <{parent.tag}>"
        return self.piece(element, cause, (*self.draft.remove(element), *self.draft.insert(parent, text)))._replace(
            around=parent
        )


def _cause(sets: Sequence[Set]) -> str:
    """Return what is wrong with the values of one element."""
    tag = sets[0].tag or str(sets[0].owner.tag)
    names = " and ".join(one.attribute for one in sets)
    what = "{}" if tag in ENDS else f"the {names} of {{}}"
    if sets[0].element is None:
        return "{} is missing"
    if all(one.attribute not in one.element.attrib for one in sets if one.element is not None):
        return f"{what} is missing"
    parts: list[str] = []
    old: Values = ()
    new: Values = ()
    for one in sets:
        known = TAGS[tag].attributes.get(one.attribute) if tag in TAGS else None
        text = one.element.get(one.attribute) if one.element is not None else None
        if known is None or not known.parts:
            return what
        parts += [part or one.attribute for part in known.parts]
        old, new = (*old, *values_of(known.default if text is None else text)), (*new, *values_of(one.value))
    return mistake_in(parts, TAGS[tag].attributes[sets[-1].attribute].unit, old, new)


def unique(pieces: Iterable[Piece]) -> list[Piece]:
    """Return the pieces that change something, each once."""
    found: dict[object, Piece] = {}
    for piece in pieces:
        found.setdefault((piece.sets, piece.edits), piece)
    return [piece for piece in found.values() if piece.sets or piece.edits]


def normal(tag: str, attribute: str, text: str | None) -> str:
    """Return a value as it is compared: numbers without needless digits, the default where there is none."""
    known = TAGS[tag].attributes.get(attribute) if tag in TAGS else None
    if text is None:
        text = known.default or "" if known is not None else ""
    is_read = known is not None and known.parts and (len(known.parts) > 1 or text == text.rstrip())
    values = values_of(text) if is_read else ()
    return " ".join(f"{value + 0.0:.6g}" for value in values) if values else text
