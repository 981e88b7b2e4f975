"""Pieces of edits: what is set or changed, named by what is wrong with it."""

from collections.abc import Sequence
from typing import NamedTuple

from grader.robot.edits.draft import Draft, Edits, Set, child_of
from grader.robot.edits.numbers import named, values_of
from grader.xml.parsing import Element
from grader.xml.urdf_format import TAGS

ENDS = ("parent", "child")

# The ranks of pieces: values of the reference; numbers that are solved for; another structure; numbers that no person would write;
# conventions of a whole robot.
KNOWN, SOLVED, STRUCTURE, FITTED, CONVENTION = range(5)


class Piece(NamedTuple):
    """An edit that may undo a mistake: values that are set, or edits of the text; what is wrong, what to do, and the link concerned.

    The `rank` orders pieces: the reference's own values come first, what fits comes later.
    """

    cause: str
    action: str
    link: str
    sets: tuple[Set, ...] = ()
    edits: Edits = ()
    rank: int = 0
    element: Element | None = None  # that it changes
    is_mistake: bool = False  # that people make, such as a sign: all its numbers belong together


class PieceMaker:
    """Makes pieces for a robot beside the reference's; `known` are names that may be told, because the reference has them."""

    def __init__(self, draft: Draft, reference: Draft) -> None:
        self.draft, self.reference = draft, reference
        links, materials = ([one.name for one in found] for found in (reference.robot.links, reference.robot.materials))
        self.known = {*links, *materials}
        self.wanted: dict[
            tuple[Element, str], str
        ] = {}  # what the reference has instead of values, by element and attribute

    def piece(
        self,
        element: Element,
        cause: str,
        action: str,
        *,
        tag: str = "",
        sets: tuple[Set, ...] = (),
        edits: Edits = (),
        rank: int = 0,
        link: str = "",
    ) -> Piece:
        """Return a piece that changes an element, or its child with a tag; {} in the texts stands for what it is called."""
        place = self.draft.described(element, tag, self.known)
        cause, action = (text.replace("{}", place) for text in (cause, action))
        return Piece(cause, action, link or self.draft.link_of(element), sets, edits, rank, element)

    def of_sets(self, sets: Sequence[Set], rank: int = 0) -> Piece:
        """Return the piece that sets values of one element, named by what is wrong with them."""
        first = sets[0]
        tag = first.tag or str(first.owner.tag)
        old: list[float] = []
        new: list[float] = []
        parts: list[str] = []
        unit = ""
        is_numeric, is_mistake = True, False
        missing = [one.attribute for one in sets if one.element is None or one.attribute not in one.element.attrib]
        for one in sets:
            known = TAGS[tag].attributes.get(one.attribute) if tag in TAGS else None
            before = _read(one, known.default if known else None)
            is_numeric = is_numeric and known is not None and bool(known.parts)
            if known is not None and known.parts:
                unit = known.unit
                old += (
                    before or [0.0] * len(known.parts) if len(before) != len(known.parts) and len(sets) > 1 else before
                )
                new += values_of(one.value)
                parts += [part or one.attribute for part in known.parts]
        names = " and ".join(one.attribute for one in sets)
        if first.element is None:
            cause, action = "{} is missing", f"add <{tag}>"
        elif missing and len(missing) == len(sets):
            cause, action = f"the {names} of {{}} is missing", f"add the {names} of {{}}"
        elif is_numeric:
            mistake = named("{} of [place]", parts, unit, tuple(old), tuple(new))
            cause, action = (text.replace("[place]", "{}") for text in mistake[:2])
            is_mistake = mistake.is_mistake
        else:
            what = "{}" if tag in ENDS else f"the {names} of {{}}"
            cause, action = what, f"set {what} to {' and '.join(one.value for one in sets)}"
        is_turned = unit == "rad" and sum(a != b for a, b in zip(old, new, strict=False)) > 1
        all_sets = self.with_twins(sets, is_known=rank == KNOWN)
        is_guess = (is_turned and not is_mistake) or (first.element is None and rank == SOLVED)
        rank = STRUCTURE if tag in ENDS else FITTED if is_guess else rank
        return self.piece(first.owner, cause, action, tag=first.tag, sets=all_sets, rank=rank)._replace(
            is_mistake=is_mistake
        )

    def with_twins(self, sets: Sequence[Set], *, is_known: bool = False) -> tuple[Set, ...]:
        """Return values of a visual's origin or shape with those of the collision (and inertial) that was the same."""
        found = [*sets]
        for one in sets:
            element = one.element
            for sibling in self.draft.siblings(element) if element is not None and is_known else ():
                wanted = self.wanted.get((sibling, one.attribute)) if sibling is not element else None
                found += [Set(sibling, "", one.attribute, wanted)] if wanted is not None else []
        for one in [*found]:
            owner, tag = (one.owner, one.tag) if one.tag else (one.owner.getparent(), str(one.owner.tag))
            if owner is None or (tag != "origin" and owner.tag != "geometry"):
                continue
            visual = owner if tag == "origin" else owner.getparent()
            link = visual.getparent() if visual is not None and visual.tag == "visual" else None
            if link is None:
                continue
            index = [*link.iterchildren("visual")].index(visual)  # type: ignore[arg-type]
            twins = [*link.iterchildren("collision")][index : index + 1]
            for twin in (*twins, *(link.iterchildren("inertial") if tag == "origin" and index == 0 else ())):
                inner = twin if tag == "origin" else child_of(twin, "geometry")
                if (
                    inner is not None
                    and (tag == "origin" or child_of(inner, tag) is not None)
                    and self._is_twin(owner, inner, tag, one)
                ):
                    found.append(Set(inner, tag, one.attribute, one.value))
        return tuple(found)

    def _is_twin(self, owner: Element, inner: Element, tag: str, one: Set) -> bool:
        """Return whether another element has the value that a visual has, and the reference does not say otherwise."""
        mine, its = (
            normal(tag, one.attribute, found.get(one.attribute) if found is not None else None)
            for found in (child_of(owner, tag), child_of(inner, tag))
        )
        if mine != its or (inner.tag == "inertial" and not mine.strip("0 ")):
            return False
        like = self.reference.link(self.draft.link_of(owner))
        part = inner if tag == "origin" else inner.getparent()
        other = child_of(like, str(part.tag)) if like is not None and part is not None else None
        if other is None:
            return True
        place = child_of(other, "geometry") if tag != "origin" else other
        found = child_of(place, tag) if place is not None else None
        return normal(tag, one.attribute, found.get(one.attribute) if found is not None else None) == normal(
            tag, one.attribute, one.value
        )

    def moved(self, element: Element, parent: Element) -> Piece:
        """Return the piece that moves an element into another one."""
        text = self.draft.text(element)
        there = self.draft.append(text) if parent is self.draft.root else self.draft.insert(parent, text)
        was = element.getparent()
        cause = f"<{element.tag}> is inside <{was.tag if was is not None else ''}>; it belongs in <{parent.tag}>"
        return self.piece(
            element, cause, f"move <{element.tag}> into <{parent.tag}>", edits=(*self.draft.remove(element), *there)
        )


def _read(one: Set, default: str | None) -> list[float]:
    element = one.element
    text = element.get(one.attribute) if element is not None else None
    return [*values_of(default if text is None else text)]


def normal(tag: str, attribute: str, text: str | None) -> str:
    """Return a value as it is compared: numbers without needless digits, the default where there is none."""
    known = TAGS[tag].attributes.get(attribute) if tag in TAGS else None
    if text is None:
        text = known.default or "" if known is not None else ""
    values = values_of(text) if known is not None and known.parts else ()
    return " ".join(f"{value + 0.0:.6g}" for value in values) if values else text
