"""The elements of a robot, each with its place in the text, and the edits of them."""

from collections.abc import Iterator

from grader import markup
from grader.edits import merged, text_of, with_attribute, with_child, with_element, with_sibling, without_element
from grader.robot.model import Joint, Robot
from grader.robot.reader import Reading
from grader.robot.tree import parent_joints
from grader.source import Edit, Source
from grader.xml.parsing import Element

Edits = tuple[Edit, ...]
_ESCAPES = (("&", "&amp;"), ("<", "&lt;"), ('"', "&quot;"))


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
        """Return the first link of this name."""
        return next((link for link in self.links() if link.get("name") == name), None)

    def joint_of(self, link: str) -> Element | None:
        """Return the parent joint of a link, also one whose parent does not exist."""
        joint = self._parents.get(link)
        if joint is not None and joint.location is not None:
            return self._elements[joint.location.tag]
        return next((joint for joint in self.joints() if end_of(joint, "child") == link), None)

    def material(self, name: str) -> Element | None:
        """Return the first definition of a material that counts: under the robot, else in a visual."""
        everywhere = (*self.root.iterchildren("material"), *self.root.iter("material"))
        return next((found for found in everywhere if found.get("name") == name and len(found)), None)

    def text(self, element: Element) -> str:
        """Return an element as it is written in the file."""
        source, start = self.source.element(self._tags[element])
        return text_of(source, start)

    def line(self, element: Element) -> int:
        """Return the line of an element, from 1."""
        return self.source.tag(self._tags[element]).line

    def set(self, element: Element, attribute: str, value: str) -> list[Edits]:
        """Return the ways to give an attribute another value."""
        old, tag = element.get(attribute) or "", self._tags[element]
        ways = self.source.rewrites(tag, attribute, old, escaped(value))
        if ways is not None:
            return ways
        source, start = self.source.element(tag)
        return [(with_attribute(source, start, attribute, merged(old, escaped(value))),)]

    def exchange(self, one: Element, other: Element, attribute: str) -> Edits:
        """Return the edits that exchange what two elements have in an attribute, as it is written."""
        places = [self.source.element(self._tags[element]) for element in (one, other)]
        found = [(source.text, markup.attribute(source.text, start, attribute)) for source, start in places]
        values = [text[it.value_start : it.value_end] for text, it in found if it is not None]
        if len(values) < len(places):
            return ()
        return tuple(
            with_attribute(*place, attribute, value) for place, value in zip(places, reversed(values), strict=True)
        )

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
        tag = self._tags[element]
        return (with_element(*self.source.element(tag), self.source.adapted(tag, xml)),)


def end_of(joint: Element, role: str) -> str:
    """Return the name of the link that is the parent or child of a joint."""
    found = child_of(joint, role)
    return (found.get("link") or "") if found is not None else ""


def child_of(element: Element, tag: str) -> Element | None:
    """Return the first child with this tag, which alone counts."""
    return next(element.iterchildren(tag), None)


def escaped(value: str) -> str:
    """Return a text as an attribute contains it."""
    for character, entity in _ESCAPES:
        value = value.replace(character, entity)
    return value
