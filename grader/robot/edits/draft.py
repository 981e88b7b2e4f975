"""The elements of a robot, each with its place in the text, and the edits of them."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple

from grader import markup
from grader.edits import merged, text_of, with_attribute, with_child, with_element, with_sibling, without_element
from grader.robot.model import Joint, Robot
from grader.robot.reader import Reading
from grader.robot.tree import parent_joints
from grader.source import Edits, Location, Source
from grader.xml.parsing import Element, make_element
from grader.xml.urdf_format import PARTS

_COMMENT = re.compile(r"[ \t]*<!--.*?-->", re.DOTALL)
_ESCAPES = (("&", "&amp;"), ("<", "&lt;"), ('"', "&quot;"))
_MAX_WAYS = 6


class Set(NamedTuple):
    """A new value of an attribute: of an element, or, with a tag, of its child of this tag, which may be missing."""

    owner: Element
    tag: str
    attribute: str
    value: str

    @property
    def element(self) -> Element | None:
        """The element whose attribute it is; None where it is missing."""
        return child_of(self.owner, self.tag) if self.tag else self.owner


class Draft:
    """A robot that is being edited: its elements, and the robot that ROS 2 reads from them."""

    def __init__(self, root: Element, robot: Robot, source: Source) -> None:
        self.root = root
        self.robot = robot
        self.source = source
        self._elements = list(root.iter())
        self._tags = {element: tag for tag, element in enumerate(self._elements)}
        self._parents: dict[str, Joint] = parent_joints(robot)

    @classmethod
    def of(cls, reading: Reading) -> "Draft | None":
        """Return the draft of a robot that could be read."""
        if reading.root is None or reading.robot is None:
            return None
        return cls(reading.root, reading.robot, reading.source)

    def links(self) -> Iterator[Element]:
        """Yield the links."""
        return self.root.iterchildren("link")

    def joints(self) -> Iterator[Element]:
        """Yield the joints."""
        return self.root.iterchildren("joint")

    def link(self, name: str) -> Element | None:
        """Return the first link of this name; a link without a name has an empty one."""
        return next((link for link in self.links() if (link.get("name") or "") == name), None)

    def joint_of(self, link: str) -> Element | None:
        """Return the parent joint of a link, also one whose parent does not exist."""
        joint = self._parents.get(link)
        if joint is not None and joint.location is not None:
            return self._elements[joint.location.tag]
        return next((joint for joint in self.joints() if end_of(joint, "child") == link), None)

    def material(self, name: str) -> Element | None:
        """Return the first definition of a material that counts: under the robot, else in a visual."""
        own = [found for found in self.root.iterchildren("material") if found.get("name") == name]
        inside = (found for found in self.root.iter("material") if found.get("name") == name and len(found))
        return next((found for found in own if len(found)), next(inside, next(iter(own), None)))

    def owner(self, element: Element) -> Element:
        """Return the child of the root that an element is or is in; the root itself for the root."""
        while (parent := element.getparent()) is not None and parent is not self.root:
            element = parent
        return element

    def link_of(self, element: Element) -> str:
        """Return the link that an element belongs to: of a joint its child; empty for a material."""
        owner = self.owner(element)
        return (
            end_of(owner, "child") if owner.tag == "joint" else (owner.get("name") or "") if owner.tag == "link" else ""
        )

    def described(self, element: Element, tag: str = "", known: Collection[str] = ()) -> str:
        """Return what an element, or its child with a tag, is called: the visual origin of 'lidar', if `known`."""
        owner, path = self.owner(element), [tag] if tag else []
        inner = element
        while inner is not owner and inner is not self.root:
            path.insert(0, str(inner.tag))
            inner = inner.getparent()  # type: ignore[assignment]
        path = [name for index, name in enumerate(path) if name != "geometry" or index == len(path) - 1]
        if owner.tag != "link" or not path:
            path.insert(0, str(owner.tag))
        name = self.link_of(owner) if owner.tag in ("link", "joint") else owner.get("name") or ""
        what = " ".join(path[:1] + path[1:][-1:])
        return (
            f"the {what} of {name!r}"
            if name in known and what != "link"
            else f"the link {name!r}"
            if name in known
            else f"the {what}"
        )

    def siblings(self, element: Element) -> list[Element]:
        """Return the elements that come from the same text of xacro, with this one."""
        return [self._elements[tag] for tag in self.source.siblings(self._tags[element])]

    def _siblings(self, element: Element, attribute: str, sets: Iterable[Set]) -> dict[Element, str]:
        """Return the values that are set for the elements that come from the same text as one."""
        same = [it for it in self.siblings(element) if it is not element]
        return {it: one.value for it in same for one in sets if one.attribute == attribute and one.element is it}

    def ways(self, sets: Collection[Set]) -> list[Edits]:
        """Return the ways to set values; attributes and elements that are missing are added."""
        found: list[Edits] = [()]
        attributes: dict[Element, dict[str, str]] = {}
        children: dict[tuple[Element, str], dict[str, str]] = {}
        done: set[tuple[Element, str]] = set()
        for one in dict.fromkeys(sets):
            element = one.element
            if element is not None and (element, one.attribute) in done:
                continue
            if element is None:
                children.setdefault((one.owner, one.tag), {})[one.attribute] = one.value
            elif one.attribute in element.attrib:
                others = self._siblings(element, one.attribute, sets)
                done |= {(it, one.attribute) for it in others}
                is_numeric = bool(PARTS.get(one.attribute))
                value = merged(element.get(one.attribute) or "", one.value) if is_numeric else one.value
                ways = self._written(element, one.attribute, value, others)
                found = [(*before, *more) for before in found for more in ways]
            else:
                attributes.setdefault(element, {})[one.attribute] = one.value
        added = [self.add_attributes(element, values) for element, values in attributes.items()]
        added += [self.insert(owner, empty_element(tag, values)) for (owner, tag), values in children.items()]
        rest = tuple(edit for edits in added for edit in edits)
        return [tuple(dict.fromkeys((*edits, *rest))) for edits in found[:_MAX_WAYS]]

    @contextmanager
    def supposing(self, sets: Iterable[Set]) -> Iterator[None]:
        """Give the elements themselves other values for a while, not their text."""
        before: list[tuple[Element, str, str | None]] = []
        added: list[Element] = []
        for one in sets:
            element = one.element
            if element is None:
                element = make_element(one.tag, {}, one.owner)
                added.append(element)
            before.append((element, one.attribute, element.get(one.attribute)))
            element.set(one.attribute, one.value)
        try:
            yield
        finally:
            for element, attribute, value in reversed(before):
                element.attrib.pop(attribute)
                if value is not None:
                    element.set(attribute, value)
            for element in added:
                element.getparent().remove(element)  # type: ignore[union-attr]

    def text(self, element: Element) -> str:
        """Return an element as it is written in the file, without comments."""
        source, start = self.source.element(self._tags[element])
        return _COMMENT.sub("", text_of(source, start))

    def line(self, element: Element) -> int:
        """Return the line of an element, from 1."""
        return self.source.tag(self._tags[element]).line

    def _written(self, element: Element, attribute: str, value: str, others: Mapping[Element, str]) -> list[Edits]:
        """Return the ways to give an attribute another text, and elements that come from the same text others."""
        tag = self._tags[element]
        wanted = {tag: (element.get(attribute) or "", escaped(value))}
        wanted |= {self._tags[it]: (it.get(attribute) or "", escaped(text)) for it, text in others.items()}
        ways = self.source.rewrites(attribute, wanted)
        if ways is not None:
            return ways
        source, start = self.source.element(tag)
        return [(with_attribute(source, start, attribute, escaped(value)),)]

    def write_text(self, element: Element, text: str) -> Edits:
        """Return the edit that gives an element another text; none where it has children, or xacro evaluates it."""
        tag = self._tags[element]
        ways = self.source.rewrites("", {tag: ((element.text or "").strip(), escaped(text))})
        if ways:
            return ways[0]
        source, start = self.source.element(tag)
        head, is_empty = markup.head_end(source.text, start)
        end = source.text.rfind("</", head, markup.element_end(source.text, start))
        if is_empty or end < 0 or not {"$", "<"}.isdisjoint(source.text[head:end]):
            return ()
        return (source.edit(head, end, escaped(text)),)

    def rename_attribute(self, element: Element, old: str, new: str) -> Edits:
        """Return the edit that gives an attribute another name."""
        source, start = self.source.element(self._tags[element])
        found = markup.attribute(source.text, start, old)
        if found is None:
            return ()
        return (source.edit(found.start, found.end, f"{new}{source.text[found.start + len(old) : found.end]}"),)

    def rename_tag(self, element: Element, new: str) -> Edits:
        """Return the edits that give an element another name, at its start and at its end."""
        source, start = self.source.element(self._tags[element])
        text, end = source.text, markup.name_end(source.text, start)
        edits: Edits = (source.edit(start, end, f"<{new}"),)
        closing = text.rfind("</", start, markup.element_end(text, start))
        if not markup.head_end(text, start)[1] and closing >= 0:
            tail = text.index(">", closing) + 1
            edits += (source.edit(closing, tail, f"</{new}>"),)
        return edits

    def wrap(self, element: Element, tag: str) -> Edits:
        """Return the edits that put an element into a new one."""
        source, start = self.source.element(self._tags[element])
        end = markup.element_end(source.text, start)
        return source.edit(start, start, f"<{tag}>"), source.edit(end, end, f"</{tag}>")

    def add_attributes(self, element: Element, values: Mapping[str, str]) -> Edits:
        """Return the edit that adds attributes to an element."""
        source, start = self.source.element(self._tags[element])
        end = markup.name_end(source.text, start)
        added = "".join(f' {name}="{escaped(value)}"' for name, value in values.items())
        added = self.source.adapted(self._tags[element], added)
        return (source.edit(start, end, f"{source.text[start:end]}{added}"),)

    def places(self) -> dict[Location, tuple[Element, str | None]]:
        """Return the element, and the attribute, that is at each place of the file."""
        found: dict[Location, tuple[Element, str | None]] = {}
        for element, tag in self._tags.items():
            found.setdefault(self.source.tag(tag), (element, None))
            for attribute in map(str, element.keys()):
                found.setdefault(self.source.tag(tag, attribute), (element, attribute))
        return found

    def insert(self, parent: Element, xml: str) -> Edits:
        """Return the edit that inserts an element as the first child of another one."""
        tag = self._tags[parent]
        return (with_child(*self.source.element(tag), self.source.adapted(tag, xml)),)

    def append(self, xml: str) -> Edits:
        """Return the edit that inserts an element after the last one of the robot."""
        for last in self.root.iterchildren(reversed=True):
            place = self.source.tag(self._tags[last])
            if place.path == self.source.path and not place.calls:  # not in a macro of xacro, nor in another file
                return (with_sibling(*self.source.element(self._tags[last]), xml),)
        return self.insert(self.root, xml)

    def remove(self, element: Element) -> Edits:
        """Return the edit that removes an element."""
        source, start = self.source.element(self._tags[element])
        return (without_element(source, start),)

    def replace(self, element: Element, xml: str) -> Edits:
        """Return the edit that replaces an element."""
        source, start = self.source.element(self._tags[element])
        return (with_element(source, start, xml),)


def end_of(joint: Element, role: str) -> str:
    """Return the name of the link that is the parent or child of a joint."""
    found = child_of(joint, role)
    return (found.get("link") or "") if found is not None else ""


def child_of(element: Element, tag: str) -> Element | None:
    """Return the first child with this tag, which alone counts."""
    return next(element.iterchildren(tag), None)


def empty_element(tag: str, values: Mapping[str, str]) -> str:
    """Return the text of an element without content."""
    attributes = "".join(f' {name}="{escaped(value)}"' for name, value in values.items())
    return f"<{tag}{attributes}/>"


def escaped(value: str) -> str:
    """Return a text as an attribute contains it."""
    for character, entity in _ESCAPES:
        value = value.replace(character, entity)
    return value
