"""Edits of the numbers of a link: where it is, and what it shows."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from grader.edits import Proposal
from grader.robot.edits.draft import Draft, Edits, child_of
from grader.robot.edits.families import BLIND, Change, Slot, Values, is_close, named, written
from grader.robot.edits.poses import Poses, shapes_of
from grader.robot.numbers import NumberError, numbers
from grader.xml.parsing import Element

_ZERO: Values = (0.0, 0.0, 0.0)
_DEFAULTS = {("origin", "xyz"): _ZERO, ("origin", "rpy"): _ZERO, ("axis", "xyz"): (1.0, 0.0, 0.0)}


class Number(NamedTuple):
    """Numbers of an element: the child that has them, its attribute, whose they are, and the expected values."""

    owner: Element
    tag: str
    attribute: str
    of: str
    wanted: tuple[Values, ...]


def value_proposals(draft: Draft, reference: Draft, poses: Poses, link: str) -> Iterator[Proposal]:
    """Yield edits of the numbers of a link, its shapes and its parent joint: those to an expected value first."""
    found = [*_of_joint(draft, reference, poses, link), *_of_visuals(draft, reference, poses, link)]
    halves = tuple(shapes_of(draft.robot, link))
    slots = [(number, _slot(number, halves)) for number in found]
    tried: set[tuple[int, Values]] = set()
    for index, (number, slot) in enumerate(slots):
        for wanted in number.wanted:
            if slot.values is not None and not is_close(slot.values, wanted):
                yield from _changed(draft, number, named(slot, wanted), link)
                tried.add((index, wanted))
    for number, slot in slots:
        for family in BLIND:
            for change in family(slot):
                yield from (found._replace(is_blind=True) for found in _changed(draft, number, change, link))


def _slot(number: Number, halves: tuple[tuple[float, str], ...]) -> Slot:
    child = child_of(number.owner, number.tag) if number.tag else number.owner
    text = child.get(number.attribute) if child is not None else None
    default = _DEFAULTS.get((number.tag, number.attribute), ())
    return Slot(number.attribute, values_of(text) if text is not None else default, halves)


def values_of(text: str) -> Values:
    """Return the numbers of an attribute; none where ROS 2 cannot read it."""
    try:
        return tuple(numbers(text))
    except NumberError:
        return ()


def _changed(draft: Draft, number: Number, change: Change, link: str) -> Iterator[Proposal]:
    for edits in with_values(draft, number.owner, number.tag, {number.attribute: change.values}):
        yield Proposal(edits, change.cause, change.action, number.of, link)


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
    for tag, attribute in (("origin", "xyz"), ("origin", "rpy"), ("axis", "xyz")):
        solved = poses.joint(link, tag, attribute)
        yield Number(joint, tag, attribute, of, tuple(_once((*_of(other, tag, attribute), *solved))))


def _of_visuals(draft: Draft, reference: Draft, poses: Poses, link: str) -> Iterator[Number]:
    own, other = draft.link(link), reference.link(link)
    if own is None:
        return
    of, expected = f"the visual of {link!r}", child_of(other, "visual") if other is not None else None
    for index, visual in enumerate(own.iterchildren("visual")):
        for attribute in ("xyz", "rpy"):
            solved = poses.visual(link, index, attribute)
            yield Number(visual, "origin", attribute, of, tuple(_once((*_of(expected, "origin", attribute), *solved))))
        shape, like = _shape(visual), _shape(expected) if expected is not None else None
        for name in ("size", "radius", "length", "scale") if shape is not None else ():
            if shape is not None and shape.get(name) is not None:
                values = like.get(name) if like is not None else None
                yield Number(shape, "", name, of, (values_of(values),) if values is not None else ())


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


def _once(values: Iterable[Values]) -> Iterator[Values]:
    before: list[Values] = []
    for found in values:
        if not any(is_close(found, other) for other in before):
            before.append(found)
            yield found
