"""The elements of a robot, each with its name in words and its place in the text."""

import re
from collections.abc import Collection, Iterator
from typing import NamedTuple, Self

from grader.hints.edits import element_text
from grader.robot.link_tree import parent_joints
from grader.robot.model import Joint, Robot
from grader.robot.reader import Reading
from grader.source import Source
from grader.xml.parsing import Element

_COMMENT = re.compile(r"[ \t]*<!--.*?-->", re.DOTALL)


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


class RobotElements:
    """The elements of a robot, and what ROS 2 reads from them."""

    def __init__(self, root: Element, robot: Robot, source: Source) -> None:
        self.root = root
        self.robot = robot
        self.source = source
        self.is_broken = False  # whether tags in the text are broken
        self._elements = list(root.iter())
        self._tags = {element: tag for tag, element in enumerate(self._elements)}
        self._parents: dict[str, Joint] = parent_joints(robot)

    @classmethod
    def of(cls, reading: Reading) -> Self | None:
        """Return the elements of a robot that could be read."""
        if reading.elements is None or reading.robot is None:
            return None
        found = cls(reading.elements, reading.robot, reading.source)
        found.is_broken = reading.root is None
        return found

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

    def describe(self, element: Element, tag: str = "", known: Collection[str] = ()) -> str:
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

    def text(self, element: Element) -> str:
        """Return an element as it is written in the file, without comments."""
        source, start = self.source.element(self._tags[element])
        return _COMMENT.sub("", element_text(source, start))

    def line(self, element: Element) -> int:
        """Return the line of an element, from 1."""
        return self.source.tag(self._tags[element]).line


def end_of(joint: Element, role: str) -> str:
    """Return the name of the link that is the parent or child of a joint."""
    found = child_of(joint, role)
    return (found.get("link") or "") if found is not None else ""


def child_of(element: Element, tag: str) -> Element | None:
    """Return the first child with this tag, which alone counts."""
    return next(element.iterchildren(tag), None)
