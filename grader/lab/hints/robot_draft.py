"""The edits of the elements of a robot in the text that they are written in."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import starmap
from typing import TYPE_CHECKING, cast

from grader.base import markup
from grader.base.element_edits import (
    attributes_text,
    element_text,
    empty_element,
    escaped,
    merged,
    renamed_attribute,
    renamed_tag,
    with_attribute,
    with_child,
    with_element,
    without_element,
)
from grader.base.grouping import StringsByName
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Edit, Edits, Source
from grader.lab.hints.edits import Proposal
from grader.lab.hints.robot_numbers import read_values
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Robot
from grader.ros.urdf.reader import Reading
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import PARTS

if TYPE_CHECKING:
    from grader.ros.xacro.expansion import ExpandedSource
    from grader.ros.xacro.rewriting import ExpandedEdits, NumberDefinition


_MAX_WAYS = 4
_COMMENT = on_use(r"(?<![ \t])[ \t]*+<!--.*?(?:-->|\Z)", re.DOTALL)
_Elements = dict[str, Element]  # by name
_Ways = list[Edits]  # to make one change


class Set(Named):
    """A new value of an attribute of an element.

    With a tag, it is that of its child of this tag, which may be missing.
    """

    owner: Element
    tag: str
    attribute: str
    value: str

    @property
    def element(self) -> Element | None:
        """The element whose attribute it is; None where it is missing."""
        if self.tag:
            return find_child(self.owner, self.tag)
        return self.owner


class Draft:
    """A robot that is being edited.

    It has its elements, what they are called, and the edits of their text.
    """

    def __init__(self, root: Element, robot: Robot, source: Source) -> None:
        self.root = root
        self.robot = robot
        self.source = source
        self.is_broken = False  # whether tags in the text are broken
        self._elements = list(root.iter())
        self._tags = {element: tag for tag, element in enumerate(self._elements)}
        self._parents = Configuration(robot).known_parents

    @classmethod
    def of(cls, reading: Reading) -> "Draft | None":
        """Return the draft of a robot that could be read."""
        if reading.elements is None or not reading.robot:
            return None
        draft = cls(reading.elements, reading.robot, reading.source)
        draft.is_broken = reading.root is None
        return draft

    def links(self) -> Iterator[Element]:
        """Yield the links."""
        return self.root.iterchildren("link")

    def joints(self) -> Iterator[Element]:
        """Yield the joints."""
        return self.root.iterchildren("joint")

    def link(self, name: str) -> Element | None:
        """Return the first link of this name; a link without a name has an empty one."""
        return self._links.get(name)

    @cached_property
    def _links(self) -> _Elements:
        return {link.get("name") or "": link for link in reversed(list(self.links()))}

    def find_joint(self, link: str) -> Element | None:
        """Return the parent joint of a link, also one whose parent does not exist."""
        joint = self._parents.get(link)
        if joint and joint.location is not None:
            return self._elements[joint.location.tag]
        return self._joints.get(link)

    @cached_property
    def _joints(self) -> _Elements:
        return {read_end(joint, "child"): joint for joint in reversed(list(self.joints()))}

    def material(self, name: str) -> Element | None:
        """Return the first definition of a material that counts.

        It is under the robot, else in a visual.
        """
        return self._materials.get(name)

    @cached_property
    def _materials(self) -> _Elements:
        own_materials = list(self.root.iterchildren("material"))
        materials: _Elements = {}
        # One without content only names another one.
        for material in (*own_materials, *self.root.iter("material")):
            if len(material):
                materials.setdefault(material.get("name") or "", material)
        for material in own_materials:
            materials.setdefault(material.get("name") or "", material)
        return materials

    def owner(self, element: Element) -> Element:
        """Return the child of the root that an element is or is in.

        It is the root itself for the root.
        """
        while (parent := element.getparent()) is not None and parent is not self.root:
            element = parent
        return element

    def find_link(self, element: Element) -> str:
        """Return the link that an element belongs to: of a joint its child.

        It is empty for a material.
        """
        owner = self.owner(element)
        if owner.tag == "joint":
            return read_end(owner, "child")
        if owner.tag == "link":
            return owner.get("name") or ""
        return ""

    def describe(self, element: Element, tag: str = "", known: Collection[str] = ()) -> str:
        """Return what an element, or its child with a tag, is called.

        An example is the visual origin of 'lidar', if `known`.
        """
        owner = self.owner(element)
        path = [tag] if tag else []
        inner = element
        while inner is not owner and inner is not self.root:
            path.insert(0, str(inner.tag))
            inner = inner.getparent()  # type: ignore[assignment]
        # The geometry around a shape says nothing.
        path = [name for name in path[:-1] if name != "geometry"] + path[-1:]
        if owner.tag != "link" or not path:
            path.insert(0, str(owner.tag))
        name = self.find_link(owner) if owner.tag in ("link", "joint") else owner.get("name") or ""
        what = path[0] if len(path) == 1 else f"{path[0]} {path[-1]}"
        if name not in known:
            own_name = owner.get("name") if what == "joint" else None
            return f"the {what} {own_name!r}" if own_name else f"the {what}"
        if what == "link":
            return f"the link {name!r}"
        return f"the {what} of {name!r}"

    def _place(self, element: Element) -> tuple[Source, int]:
        """Return the text that an element is written in, and where it starts there."""
        return self.source.element(self._tags[element])

    def text(self, element: Element) -> str:
        """Return an element as it is written in the file, without comments."""
        return _COMMENT.sub("", element_text(*self._place(element)))

    def line(self, element: Element) -> int:
        """Return the line of an element, from 1."""
        return self.source.tag(self._tags[element]).line

    @cached_property
    def _expanded(self) -> "ExpandedEdits | None":
        """The edits of the source if xacro expanded it.

        An element is not written there as it is read.
        """
        if not self.source.is_expanded:
            return None
        from grader.ros.xacro.rewriting import ExpandedEdits  # late: most robots are not xacro

        return ExpandedEdits(cast("ExpandedSource", self.source))

    @property
    def is_refused(self) -> bool:
        """Whether xacro refuses something, so that elements may be missing for that."""
        return self.source.is_expanded and cast("ExpandedSource", self.source).is_refused

    def corrections(self, names: Sequence[str]) -> list[Proposal]:
        """Return edits that may correct what xacro refuses; `names` are those that may be meant."""
        if self._expanded:
            return list(starmap(Proposal, self._expanded.corrections(names)))
        return []

    def numbers(self, element: Element, attribute: str) -> "list[NumberDefinition]":
        """Return the definitions of the numbers from which xacro computes an attribute."""
        if not self._expanded:
            return []
        return self._expanded.numbers(self._tags[element], attribute)

    def _siblings(
        self, element: Element, attribute: str, sets: Iterable[Set]
    ) -> dict[Element, str]:
        """Return the values that are set for the elements that come from the same text as one."""
        if not self._expanded:
            return {}
        same = {self._elements[tag] for tag in self._expanded.siblings(self._tags[element])}
        values = {}
        for change in sets:
            if change.attribute == attribute and change.element in same:
                values[change.element] = change.value
        return values

    def shared(self, sets: Iterable[Set]) -> frozenset[str]:
        """Return the links whose elements share a text of xacro with those that are set."""
        if not self._expanded:
            return frozenset()
        links: set[str] = set()
        for change in sets:
            if change.element is not None:
                siblings = self._expanded.siblings(self._tags[change.element])
                links.update(self.find_link(self._elements[tag]) for tag in siblings)
        return frozenset(links)

    def ways(self, sets: Collection[Set]) -> _Ways:
        """Return the ways to set values; attributes and elements that are missing are added."""
        ways: _Ways = [()]
        attributes: dict[Element, dict[str, str]] = {}
        children: dict[tuple[Element, str], dict[str, str]] = {}
        done = set()
        for change in dict.fromkeys(sets):
            element = change.element
            name = change.attribute
            if element is None:
                children.setdefault((change.owner, change.tag), {})[name] = change.value
            elif (element, name) in done:
                continue
            elif name in element.attrib:
                siblings = self._siblings(element, name, sets)
                done |= {(sibling, name) for sibling in siblings}
                value = change.value
                if PARTS.get(name):  # numbers
                    value = merged(element.get(name) or "", value)
                ways_of_value = self._list_ways(element, name, value, siblings)
                ways = [before + edits for before in ways for edits in ways_of_value]
                ways = ways[:_MAX_WAYS]
            else:
                attributes.setdefault(element, {})[name] = change.value
        added: list[Edit] = []
        for element, values in attributes.items():
            added += self.add_attributes(element, values)
        for (owner, tag), values in children.items():
            added += self.insert(owner, empty_element(tag, values))
        ways_that_change = []
        for edits in self._exchanged(sets, ways)[:_MAX_WAYS]:
            every_edit = dict.fromkeys((*edits, *added))
            ways_that_change.append(tuple(edit for edit in every_edit if edit.old != edit.new))
        return ways_that_change

    def _exchanged(self, sets: Collection[Set], ways: _Ways) -> _Ways:
        """Return the ways to set values: two that are exchanged get the text of each other.

        If names give both values, they may also be defined the wrong way round.
        """
        element = next((one.element for one in sets), None)
        if element is None or len(sets) != 2 or any(one.element is not element for one in sets):
            return ways
        first, second = sets
        wanted = [
            read_values(element.get(second.attribute)),
            read_values(element.get(first.attribute)),
        ]
        if not all(wanted) or [read_values(first.value), read_values(second.value)] != wanted:
            return ways
        place = self._place(element)
        first_text = _attribute_text(*place, first.attribute)
        second_text = _attribute_text(*place, second.attribute)
        if first_text is None or second_text is None:
            return ways
        edits = (
            with_attribute(*place, first.attribute, second_text),
            with_attribute(*place, second.attribute, first_text),
        )
        if "$" in first_text and "$" in second_text:
            return [*ways[:1], edits]
        return [edits]

    def _list_ways(
        self, element: Element, attribute: str, value: str, others: Mapping[Element, str]
    ) -> _Ways:
        """Return the ways to give an attribute another text.

        Elements that come from the same text get others.
        """
        tag = self._tags[element]
        wanted = {tag: (element.get(attribute) or "", escaped(value))}
        for other, text in others.items():
            wanted[self._tags[other]] = (other.get(attribute) or "", escaped(text))
        if self._expanded:
            return self._expanded.rewrites(attribute, wanted)
        source, start = self.source.element(tag)
        rewritten = self._rewrite_broken(element, {attribute: value})
        if rewritten is not None:
            return [rewritten] if rewritten else []
        return [(with_attribute(source, start, attribute, escaped(value)),)]

    def exchange(self, *elements: Element, attribute: str) -> Edits:
        """Return the edits with which two elements exchange the text of an attribute.

        The text stays as it is written.
        """
        places = [self._place(element) for element in elements]
        texts = []
        for source, start in places:
            text = _attribute_text(source, start, attribute)
            if text is not None:
                texts.append(text)
        if len(texts) != 2 or texts[0] == texts[1]:
            return ()
        return tuple(
            with_attribute(source, start, attribute, text)
            for (source, start), text in zip(places, reversed(texts), strict=True)
        )

    def write_text(self, element: Element, text: str) -> Edits:
        """Return the edit that gives an element another text.

        It is None where it has children, or xacro evaluates it.
        """
        tag = self._tags[element]
        wanted = {tag: ((element.text or "").strip(), escaped(text))}
        if self._expanded:
            ways = self._expanded.rewrites("", wanted)
            if ways:
                return ways[0]
        source, start = self.source.element(tag)
        head, _ = markup.head_end(source.text, start)
        end = source.text.rfind("</", head, markup.element_end(source.text, start))
        if end < 0 or not {"$", "<"}.isdisjoint(source.text[head:end]):
            return ()
        return (source.edit(head, end, escaped(text)),)

    def rename_attribute(self, element: Element, old: str, new: str) -> Edits:
        """Return the edit that gives an attribute another name."""
        return renamed_attribute(*self._place(element), old, new)

    def rename_tag(self, element: Element, new: str) -> Edits:
        """Return the edits that give an element another name, at its start and at its end."""
        return renamed_tag(*self._place(element), new)

    def add_attributes(self, element: Element, values: StringsByName) -> Edits:
        """Return the edit that adds attributes to an element, or writes a broken tag with them."""
        rewritten = self._rewrite_broken(element, values)
        if rewritten is not None:
            return rewritten
        source, start = self._place(element)
        end = markup.name_end(source.text, start)
        return (source.edit(start, end, f"{source.text[start:end]}{attributes_text(values)}"),)

    def _rewrite_broken(self, element: Element, values: StringsByName) -> Edits | None:
        """Return the edit of a broken tag that gets attributes; None if it is not broken."""
        if not self.is_broken:
            return None
        from grader.ros.xml.repair import rewritten_tag  # late: its patterns take long

        source, start = self._place(element)
        given = {str(name): str(value) for name, value in element.attrib.items()}
        return rewritten_tag(source, start, str(element.tag), {**given, **values})

    def insert(self, parent: Element, xml: str) -> Edits:
        """Return the edit that inserts an element as the first child of another one."""
        return (with_child(*self._place(parent), xml),)

    def remove(self, element: Element) -> Edits:
        """Return the edit that removes an element."""
        return (without_element(*self._place(element)),)

    def replace(self, element: Element, xml: str) -> Edits:
        """Return the edit that replaces an element."""
        return (with_element(*self._place(element), xml),)


def _attribute_text(source: Source, start: int, name: str) -> str | None:
    """Return the text of an attribute of the start tag at an offset, as it is written."""
    span = markup.attribute(source.text, start, name)
    if not span:
        return None
    return source.text[span.value_start : span.value_end]


def read_end(joint: Element, role: str) -> str:
    """Return the name of the link that is the parent or child of a joint."""
    end_element = find_child(joint, role)
    if end_element is not None:
        return end_element.get("link") or ""
    return ""


def find_child(element: Element, tag: str) -> Element | None:
    """Return the first child with this tag, which alone counts."""
    return next(element.iterchildren(tag), None)
