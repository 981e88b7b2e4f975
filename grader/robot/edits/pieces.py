"""Pieces of edits: what is set or changed, named by what is wrong with it."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.robot.edits.draft import Draft
from grader.robot.edits.elements import Set, child_of
from grader.robot.edits.numbers import Values, values_of, words_of_change
from grader.source import Edits
from grader.xml.parsing import Element
from grader.xml.urdf_format import TAGS

ENDS = ("parent", "child")

# The ranks of pieces: values of a sibling of the student's own design; the reference's; the student's own, corrected;
# several at once, or another structure.
SIBLING, REFERENCE, OWN, STRUCTURE = range(4)


class Piece(NamedTuple):
    """An edit that may undo a mistake: values to set, or edits of the text; what is wrong, what to do, and the link.

    The `rank` orders pieces that gain as much.
    """

    cause: str
    action: str
    link: str
    sets: tuple[Set, ...] = ()
    edits: Edits = ()
    rank: int = REFERENCE
    around: Element | None = None  # the element that changes


Numbers = tuple[list[str], Values, Values]  # what changes, the old numbers, the new ones


class _Words(NamedTuple):
    """The words of a change."""

    cause: str
    action: str


def _words(sets: Sequence[Set], tag: str) -> _Words:
    """Return what is wrong with the values of one element, and what to do."""
    names = " and ".join(one.attribute for one in sets)
    what = "{}" if tag in ENDS else f"the {names} of {{}}"
    if sets[0].element is None:
        return _Words("{} is missing", f"add <{tag}>")
    if all(one.attribute not in one.element.attrib for one in sets if one.element is not None):
        return _Words(f"{what} is missing", f"add {what}")
    changes = [change for one in sets for change in [_change(one, tag, is_one=len(sets) == 1)] if change]
    if len(changes) < len(sets):
        return _Words(what, f"set {what} to {' and '.join(one.value for one in sets)}")
    return _words_of_numbers(changes, TAGS[tag].attributes[sets[-1].attribute].unit)


def _words_of_numbers(changes: Sequence[Numbers], unit: str) -> _Words:
    """Return what is wrong with numbers that all change, by the mistakes that people make."""
    parts = [part for change in changes for part in change[0]]
    old = tuple(value for change in changes for value in change[1])
    new = tuple(value for change in changes for value in change[2])
    cause, action = words_of_change("{} of [place]", parts, unit, old, new)
    return _Words(*(text.replace("[place]", "{}") for text in (cause, action)))


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
        action: str,
        edits: Edits = (),
        *,
        sets: tuple[Set, ...] = (),
        rank: int = REFERENCE,
        link: str = "",
        tag: str = "",
    ) -> Piece:
        """Return a piece that changes an element, or its child with a tag; {} in the texts stands for its name."""
        place = self.draft.describe(element, tag, self.known)
        around = element if element.getparent() is self.draft.root else element.getparent()
        cause, action = (text.replace("{}", place) for text in (cause, action))
        return Piece(cause, action, link or self.draft.link_of(element), sets, edits, rank, around)

    def of_sets(self, sets: Sequence[Set], rank: int = REFERENCE) -> Piece:
        """Return the piece that sets values of one element, named by what is wrong with them."""
        first = sets[0]
        words = _words(sets, first.tag or str(first.owner.tag))
        return self.piece(first.owner, *words, sets=self.with_twins(sets), rank=rank, tag=first.tag)

    def each(self, sets: Sequence[Set]) -> Iterator[Piece]:
        """Yield the pieces that set each value alone, and all together."""
        yield from (self.of_sets([one]) for one in sets)
        if len(sets) > 1:
            yield self.of_sets(sets)

    def with_twins(self, sets: Sequence[Set]) -> tuple[Set, ...]:
        """Return values of a visual's origin or shape with those of the collision (and inertial) that was the same."""
        found = [*sets]
        for one in [*found]:
            owner, tag = (one.owner, one.tag) if one.tag else (one.owner.getparent(), str(one.owner.tag))
            if owner is not None and (tag == "origin" or owner.tag == "geometry"):
                alike = [twin for twin in twins_of(owner) if self._is_twin(owner, twin, tag, one)]
                found += [Set(twin, tag, one.attribute, one.value) for twin in alike]
        return tuple(found)

    def _is_twin(self, owner: Element, twin: Element, tag: str, one: Set) -> bool:
        """Return whether another element has the value that a visual has, and the reference does not say otherwise."""
        mine, its = (_value(child_of(found, tag), tag, one.attribute) for found in (owner, twin))
        is_inertial = twin.tag == "inertial"
        if mine != its or (is_inertial and not mine.strip("0 ")) or (tag != "origin" and child_of(twin, tag) is None):
            return False
        like = self.reference.link(self.draft.link_of(owner))
        part = twin.tag if tag == "origin" else "collision"
        other = child_of(like, str(part)) if like is not None else None
        place = child_of(other, "geometry") if other is not None and tag != "origin" else other
        found = child_of(place, tag) if place is not None else None
        return other is None or _value(found, tag, one.attribute) == normal(tag, one.attribute, one.value)

    def moved(self, element: Element, parent: Element) -> Piece:
        """Return the piece that moves an element into another one."""
        text = self.draft.text(element)
        there = self.draft.append(text) if parent is self.draft.root else self.draft.insert(parent, text)
        was = element.getparent()
        cause = f"<{element.tag}> is inside <{was.tag if was is not None else ''}>; it belongs in <{parent.tag}>"
        edits = (*self.draft.remove(element), *there)
        piece = self.piece(element, cause, f"move <{element.tag}> into <{parent.tag}>", edits)
        return piece._replace(around=parent)


def twins_of(owner: Element) -> list[Element]:
    """Return what may equal a visual, or its geometry: that of the collision; for a visual also the inertial."""
    visual = owner.getparent() if owner.tag == "geometry" else owner
    link = visual.getparent() if visual is not None and visual.tag == "visual" else None
    if link is None or visual is None:
        return []
    index = [*link.iterchildren("visual")].index(visual)
    twins = [*link.iterchildren("collision")][index : index + 1]
    if owner.tag == "geometry":
        return [found for twin in twins for found in twin.iterchildren("geometry")][:1]
    return [*twins, *(link.iterchildren("inertial") if index == 0 else ())]


def unique(pieces: Iterable[Piece]) -> list[Piece]:
    """Return the pieces that change something, each once."""
    found: dict[object, Piece] = {}
    for piece in pieces:
        found.setdefault((piece.sets, piece.edits), piece)
    return [piece for piece in found.values() if piece.sets or piece.edits]


def _value(element: Element | None, tag: str, attribute: str) -> str:
    return normal(tag, attribute, element.get(attribute) if element is not None else None)


def _change(one: Set, tag: str, *, is_one: bool) -> Numbers | None:
    """Return the parts of the numbers that are set, the old and the new ones; None for a text."""
    known = TAGS[tag].attributes.get(one.attribute) if tag in TAGS else None
    if known is None or not known.parts:
        return None
    text = one.element.get(one.attribute) if one.element is not None else None
    old = values_of(known.default if text is None else text)
    if len(old) != len(known.parts) and not is_one:
        old = old or (0.0,) * len(known.parts)
    return [part or one.attribute for part in known.parts], old, values_of(one.value)


def normal(tag: str, attribute: str, text: str | None) -> str:
    """Return a value as it is compared: numbers without needless digits, the default where there is none."""
    known = TAGS[tag].attributes.get(attribute) if tag in TAGS else None
    if text is None:
        text = known.default or "" if known is not None else ""
    is_read = known is not None and known.parts and (len(known.parts) > 1 or text == text.rstrip())
    values = values_of(text) if is_read else ()
    return " ".join(f"{value + 0.0:.6g}" for value in values) if values else text
