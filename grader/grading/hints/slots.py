"""The numbers of a robot that may be wrong: those of the joints that move links, and of what links show."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.robot.edits.draft import Draft
from grader.robot.edits.elements import Set, child_of
from grader.robot.edits.numbers import Values, format_numbers, values_of
from grader.xml.parsing import Element
from grader.xml.urdf_format import CHILDREN, TAGS

_ADDED = ("origin", "axis")  # elements that a person adds to give them a value


class Slot(NamedTuple):
    """Numbers of one element: an attribute, or all attributes with one number each."""

    owner: Element
    tag: str
    attributes: tuple[str, ...]
    values: Values
    unit: str

    def sets(self, values: Values, text: Callable[[Values], str] = format_numbers) -> tuple[Set, ...]:
        """Return what is set to give the numbers these values."""
        if len(self.attributes) == 1:
            return (Set(self.owner, self.tag, self.attributes[0], text(values)),) if values != self.values else ()
        pairs = zip(self.attributes, values, self.values, strict=True)
        return tuple(Set(self.owner, self.tag, name, text((value,))) for name, value, old in pairs if value != old)


def slots(draft: Draft, shown: Sequence[str], moved: Sequence[str]) -> Iterator[Slot]:
    """Yield the numbers of the joints that move links, and of what links show."""
    links = _without_none(map(draft.link, shown))
    parts = [part for own in links for part in own.iterchildren("visual", "inertial")]
    colours = (draft.material(used.get("name") or "") for part in parts for used in part.iterchildren("material"))
    for owner in (*_without_none(map(draft.joint_of, moved)), *parts, *_without_none(colours)):
        tags = ("origin",) if owner.get("type") in ("fixed", "floating") else _ADDED
        for tag in (tag for tag in tags if tag in CHILDREN[str(owner.tag)]):
            yield from _slots(owner, tag)
        for element in owner.iterdescendants(*(tag for tag in TAGS if tag not in _ADDED)):
            yield from _slots(element, "")


def _without_none(found: Iterable[Element | None]) -> Iterator[Element]:
    return (element for element in found if element is not None)


def _slots(owner: Element, tag: str) -> Iterator[Slot]:
    """Yield the numbers of an element, or of its child (perhaps missing): those of a vector, else all together."""
    element, known = child_of(owner, tag) if tag else owner, TAGS[tag or str(owner.tag)].attributes
    names = [name for name, one in known.items() if one.parts]
    vectors = [name for name in names if len(known[name].parts) > 1]
    for those in (*([name] for name in vectors), [name for name in names if name not in vectors]):
        given: dict[str, Values] = {}
        for name in those:
            default = "1 0 0" if (tag, element) == ("axis", None) else known[name].default
            values = values_of(element.get(name, default) if element is not None else default)
            given |= {name: values} if len(values) == len(known[name].parts) else {}
        if given:
            unit = known[next(iter(given))].unit
            yield Slot(owner, tag, tuple(given), tuple(value for values in given.values() for value in values), unit)
