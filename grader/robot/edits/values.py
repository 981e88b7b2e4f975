"""Edits of the numbers of a link: where it is, and what it shows."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.edits import FITTED, KNOWN, SOLVED, TOGETHER, TRIED, Proposal
from grader.robot.edits.draft import Draft, Edits, child_of
from grader.robot.edits.families import BLIND, COMPONENTS, Change, HalfLength, Slot, Values, is_close, named, written
from grader.robot.edits.poses import Poses, halves_of_joint, halves_of_visual
from grader.robot.numbers import NumberError, numbers
from grader.xml.parsing import Element

_ZERO: Values = (0.0, 0.0, 0.0)
_DEFAULTS = {("origin", "xyz"): _ZERO, ("origin", "rpy"): _ZERO, ("axis", "xyz"): (1.0, 0.0, 0.0)}


class Number(NamedTuple):
    """Numbers of an element: the child that has them, its attribute, whose they are, and the expected values with their ranks."""

    owner: Element
    tag: str
    attribute: str
    of: str
    wanted: tuple[tuple[Values, int], ...]


def joint_values(draft: Draft, reference: Draft, poses: Poses, link: str) -> Iterator[Proposal]:
    """Yield edits of the origin and the axis of the parent joint of a link."""
    halves = tuple(halves_of_joint(draft.robot, link))
    return _proposals(draft, tuple(_of_joint(draft, reference, poses, link)), halves, link)


def visual_values(draft: Draft, reference: Draft, poses: Poses, link: str) -> Iterator[Proposal]:
    """Yield edits of the origins and the sizes of the visuals of a link."""
    halves = tuple(halves_of_visual(draft.robot, link))
    yield from _proposals(draft, tuple(_of_visuals(draft, reference, poses, link)), halves, link)
    own = draft.link(link)
    for cylinder in own.iter("cylinder") if own is not None else ():
        radius, length = cylinder.get("radius"), cylinder.get("length")
        if cylinder.getparent() is not None and radius and length and radius != length:
            for one in draft.set(cylinder, "radius", length)[:1]:
                for other in draft.set(cylinder, "length", radius)[:1]:
                    cause, action = "radius and length{} are swapped", "swap radius and length{}"
                    yield Proposal((*one, *other), cause, action, f"the visual of {link!r}", link, TRIED)


def _proposals(draft: Draft, found: Sequence[Number], halves: tuple[HalfLength, ...], link: str) -> Iterator[Proposal]:
    for number in found:
        slot = _slot(number, halves)
        is_missing = slot.attribute == "axis" and not slot.is_given
        for wanted, rank in number.wanted:
            if not is_close(slot.attribute, slot.values, wanted):
                change, is_named = named(slot, wanted)
                if is_missing:
                    change = Change(change.values, "the <axis>{} is missing: ROS 2 uses 1 0 0", "add an <axis>{}")
                yield from _changed(draft, number, change, link, SOLVED if is_named and rank > SOLVED else rank)
        for family in () if is_missing else BLIND:
            for change in family(slot):
                yield from _changed(draft, number, change, link, TRIED)


def together(draft: Draft, reference: Draft, poses: Poses, link: str) -> Iterator[Proposal]:
    """Place a link as the reference does: the origin and axis of its joint and the origin of its visual, all at once."""
    edits: Edits = ()
    for number in (*_of_joint(draft, reference, poses, link), *_of_visuals(draft, reference, poses, link)):
        slot = _slot(number, ())
        known = [values for values, rank in number.wanted if rank == KNOWN]
        if known and not is_close(slot.attribute, slot.values, known[0]):
            ways = with_values(draft, number.owner, number.tag, {number.attribute: known[0]})
            edits += ways[0] if ways else ()
    if len(edits) > 1:
        of = f"the link {link!r}"
        yield Proposal(
            edits, "the frame{} and the shape in it", "correct the frame{} and the shape in it", of, link, TOGETHER
        )


def _slot(number: Number, halves: tuple[HalfLength, ...]) -> Slot:
    child = child_of(number.owner, number.tag) if number.tag else number.owner
    text = child.get(number.attribute) if child is not None else None
    default = _DEFAULTS.get((number.tag, number.attribute), ())
    name = _slot_name(number.tag, number.attribute)
    values = values_of(text) if text is not None else default
    return Slot(name, values if len(values) <= len(COMPONENTS.get(name, values)) else (), halves, text is not None)


def _slot_name(tag: str, attribute: str) -> str:
    return "axis" if tag == "axis" else attribute


def values_of(text: str) -> Values:
    """Return the numbers of an attribute; none where ROS 2 cannot read it."""
    try:
        return tuple(numbers(text))
    except NumberError:
        return ()


def _changed(draft: Draft, number: Number, change: Change, link: str, rank: int) -> Iterator[Proposal]:
    for edits in with_values(draft, number.owner, number.tag, {number.attribute: change.values}):
        yield Proposal(edits, change.cause, change.action, number.of, link, rank)


def with_values(draft: Draft, owner: Element, tag: str, values: dict[str, Values]) -> list[Edits]:
    """Return the ways to set numbers of a child of an element, which is inserted where it is missing."""
    child = child_of(owner, tag) if tag else owner
    if child is None:
        attributes = " ".join(f'{name}="{written(vector)}"' for name, vector in values.items())
        return [draft.insert(owner, f"<{tag} {attributes}/>")]
    ways: list[Edits] = [()]
    for name, vector in values.items():
        ways = [before + more for before in ways for more in draft.set(child, name, written(vector))]
    return ways


def _of_joint(draft: Draft, reference: Draft, poses: Poses, link: str) -> Iterator[Number]:
    joint, other = draft.joint_of(link), reference.joint_of(link)
    if joint is None:
        return
    of = f"the joint of {link!r}"
    turns = joint.get("type") not in ("fixed", "floating")
    for tag, attribute in (("origin", "xyz"), ("origin", "rpy"), *((("axis", "xyz"),) if turns else ())):
        known = (
            *_of(other, tag, attribute),
            *(poses.given(link, "xyz") if (tag, attribute) == ("origin", "xyz") else ()),
        )
        yield Number(
            joint,
            tag,
            attribute,
            of,
            _wanted(_slot_name(tag, attribute), known, poses.joint(link, tag, attribute)),
        )


def _of_visuals(draft: Draft, reference: Draft, poses: Poses, link: str) -> Iterator[Number]:
    own, other = draft.link(link), reference.link(link)
    if own is None:
        return
    of, expected = f"the visual of {link!r}", child_of(other, "visual") if other is not None else None
    for index, visual in enumerate(own.iterchildren("visual")):
        for attribute in ("xyz", "rpy"):
            solved = poses.visual(link, index, attribute)
            yield Number(
                visual, "origin", attribute, of, _wanted(attribute, _of(expected, "origin", attribute), solved)
            )
        shape, like = _shape(visual), _shape(expected) if expected is not None else None
        for name in ("size", "radius", "length", "scale") if shape is not None else ():
            if shape is not None and shape.get(name) is not None:
                values = like.get(name) if like is not None else None
                known = (*((values_of(values),) if values is not None else ()), *poses.given(link, name))
                yield Number(shape, "", name, of, _wanted(name, known, ()))


def _shape(visual: Element) -> Element | None:
    geometry = child_of(visual, "geometry")
    return next(geometry.iterchildren(), None) if geometry is not None else None


def _of(owner: Element | None, tag: str, attribute: str) -> tuple[Values, ...]:
    """Return what the reference has, which is the default where it has nothing."""
    if owner is None:
        return ()
    child = child_of(owner, tag)
    text = child.get(attribute) if child is not None else None
    values = values_of(text) if text is not None else _DEFAULTS[tag, attribute]
    return (values,) if values else ()


def _wanted(attribute: str, known: Iterable[Values], solved: Iterable[Values]) -> tuple[tuple[Values, int], ...]:
    """Return expected values with their ranks, each once."""
    found: list[tuple[Values, int]] = []
    for values, rank in (*((values, KNOWN) for values in known), *((values, FITTED) for values in solved)):
        if not any(is_close(attribute, values, other) for other, _ in found):
            found.append((values, rank))
    return tuple(found)
