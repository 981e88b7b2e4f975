"""The element tree of a URDF, to rewrite a robot: poses, frames and joints, and its text in ways that mean the same."""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from random import Random
from typing import TypeVar
from xml.sax.saxutils import escape

from lxml import etree

from grader.mutation.elements import FOREIGN
from grader.robot.transforms import IDENTITY, Transform, Vector, rotation_from_rpy
from grader.xacro.texts import INSTALLED
from grader.xml.parsing import Element
from grader.xml.urdf_format import PARTS

_Item = TypeVar("_Item")
_FOUND = re.compile(rf"\Afile:/*{INSTALLED}/([^/]+)/share/\1/")


def copied(root: Element) -> Element:
    """Return a copy of a tree without comments; paths of meshes that $(find package) gave become package:// ones."""
    copy = etree.fromstring(etree.tostring(root, with_tail=False))
    for element in list(copy.iter(etree.Comment, etree.ProcessingInstruction)):
        above = element.getparent()
        if above is not None:
            above.remove(element)
    for mesh in copy.iter("mesh"):
        if mesh.get("filename"):
            mesh.set("filename", _FOUND.sub(r"package://\1/", mesh.get("filename", "")))
    return copy


def origin(xyz: Iterable[float], rpy: Iterable[float]) -> Transform:
    """Return the transform of an origin."""
    x, y, z = xyz
    roll, pitch, yaw = rpy
    return Transform(rotation_from_rpy((roll, pitch, yaw)), (x, y, z))


def attribute_text(values: Iterable[float]) -> str:
    """Return numbers as an attribute contains them."""
    return " ".join(f"{value + 0.0:.13g}" for value in values)


def attribute_numbers(element: Element | None, attribute: str, default: str = "0 0 0") -> list[float]:
    """Return the numbers of an attribute."""
    text = default if element is None else element.get(attribute, default)
    return [float(piece) for piece in text.split()]


def vector_of(element: Element | None, attribute: str, default: str = "0 0 0") -> Vector:
    """Return the three numbers of an attribute."""
    x, y, z = attribute_numbers(element, attribute, default)
    return x, y, z


def pose(owner: Element) -> Transform:
    """Return the pose in the `<origin>` of a joint, a visual, a collision or an inertial."""
    found = owner.find("origin")
    return origin(attribute_numbers(found, "xyz"), attribute_numbers(found, "rpy"))


def set_pose(owner: Element, transform: Transform) -> None:
    """Write a pose into the `<origin>` of an element."""
    found = owner.find("origin")
    if found is None:
        if transform == IDENTITY:
            return
        found = etree.SubElement(owner, "origin")
    found.set("xyz", attribute_text(transform.translation))
    found.set("rpy", attribute_text(transform.rpy))


def end(joint: Element, role: str) -> Element:
    """Return the `<parent>` or `<child>` of a joint."""
    found = joint.find(role)
    assert found is not None
    return found


def parent_joint(tree: Element, link: str) -> Element | None:
    """Return the joint whose child is this link."""
    return next((joint for joint in tree.iterchildren("joint") if end(joint, "child").get("link") == link), None)


def move_frame(tree: Element, link: Element, change: Transform) -> None:
    """Move a link's frame by `change`, given in the frame, and everything in the link back: nothing else moves."""
    name = link.get("name", "")
    held = parent_joint(tree, name)
    assert held is not None
    back = change.inverse()
    set_pose(held, pose(held) @ change)
    axis = held.find("axis")
    if axis is not None:
        axis.set("xyz", attribute_text(back.rotate(vector_of(axis, "xyz"))))
    elif held.get("type") != "fixed":
        etree.SubElement(held, "axis", {"xyz": attribute_text(back.rotate((1.0, 0.0, 0.0)))})
    for element in link.iterchildren("visual", "collision", "inertial"):
        set_pose(element, back @ pose(element))
    for joint in tree.iterchildren("joint"):
        if end(joint, "parent").get("link") == name:
            set_pose(joint, back @ pose(joint))


def fresh(tree: Element, kind: str) -> str:
    """Return a name that nothing in the robot has."""
    return f"extra_{kind}_{len(tree)}"


def add_joint(tree: Element, name: str, parent: str, child: str, transform: Transform) -> Element:
    """Add a fixed joint."""
    joint = etree.SubElement(tree, "joint", {"name": name, "type": "fixed"})
    etree.SubElement(joint, "parent", {"link": parent})
    etree.SubElement(joint, "child", {"link": child})
    set_pose(joint, transform)
    return joint


def add_link(tree: Element, name: str) -> Element:
    """Add an empty link."""
    return etree.SubElement(tree, "link", {"name": name})


def own_elements(tree: Element, *tags: str) -> Iterator[Element]:
    """Yield the elements with these tags that ROS 2 reads: not those inside of elements for a simulator."""
    for child in tree:
        if child.tag not in FOREIGN:
            yield from child.iter(*tags)


def words_of_foreign(tree: Element) -> set[str]:
    """Return the words in the elements for simulators and controllers."""
    found = [element for tag in FOREIGN for child in tree.iterchildren(tag) for element in child.iter("*")]
    values = [value for element in found for value in (element.text or "", *map(str, element.attrib.values()))]
    return {word for value in values for word in value.split()}


def some(random: Random, items: Iterable[_Item]) -> Sequence[_Item]:
    """Return one to three items, or none where there are none."""
    found = list(items)
    return random.sample(found, min(len(found), random.randint(1, 3)))


_COMMENTS = ("<!---->", "<!-- a robot -->", '<!-- <link name="ghost"/> -->', "<!--\n  0.6 / 4\n  -->", "<!-- $ & % -->")


@dataclass(frozen=True, slots=True)
class Style:
    """Options for writing an element tree as text; the text is as plain as possible with all of them off."""

    random: Random
    blanks: tuple[str, ...] = ("\n",)
    quotes: str = '"'
    numbers: bool = False
    comments: bool = False
    references: bool = False
    orders: bool = False

    def text(self, element: Element) -> str:
        """Return an element as text."""
        pick = self.random.choice
        tight = self.blanks if self.orders else ("",)
        loose = [space for space in tight if space] or [" "]
        if element.tag in FOREIGN:  # a simulator may read anything in it
            return etree.tostring(element, encoding="unicode", with_tail=False)
        attributes = [(name, value) for name, value in element.attrib.items() if "}" not in str(name)]
        if self.orders:
            self.random.shuffle(attributes)
        inside = [self.attribute(str(name), str(value)) for name, value in attributes]
        space = [pick(loose) for _ in inside]
        opening = f"<{element.tag}{''.join(map(''.join, zip(space, inside, strict=True)))}"
        children = [self.text(child) for child in element]
        content = element.text or ""
        if content.strip() and not children:  # of an element that ROS 2 ignores
            return f"{opening}>{escape(content)}</{element.tag}>"
        if not children and not (self.orders and pick((True, False))):
            return f"{opening}{pick(tight)}/>"
        between = [self.blank_space() for _ in range(len(children) + 1)]
        body = "".join(map("".join, zip(between, [*children, ""], strict=True)))
        return f"{opening}{pick(tight)}>{body}</{element.tag}{pick(tight)}>"

    def blank_space(self) -> str:
        """Return the text between two elements."""
        comment = self.random.choice(_COMMENTS) if self.comments and self.random.random() < 0.2 else ""
        return f"{self.random.choice(self.blanks)}{comment}{self.random.choice(self.blanks)}"

    def attribute(self, name: str, value: str) -> str:
        """Return an attribute as text."""
        quote = self.random.choice(self.quotes)
        if self.numbers and len(PARTS.get(name, ())) > 1:
            pieces = [self.number(piece) for piece in value.split(" ")]
            value = "".join(f"{' ' * self.random.randint(1, 3)}{piece}" for piece in pieces)
            value += " " * self.random.randint(0, 2)
        elif self.numbers and PARTS.get(name):
            value = " " * self.random.randint(0, 2) + self.number(value)
        value = value.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
        if self.references and value and value[0].isalnum():
            value = f"&#{ord(value[0])};{value[1:]}"
        equals = f"{self.random.choice(self.blanks)}={self.random.choice(self.blanks)}" if self.orders else "="
        return f"{name}{equals}{quote}{value}{quote}"

    def number(self, text: str) -> str:
        """Return the same number in other digits."""
        try:
            value = Decimal(text)
        except InvalidOperation:
            return text
        sign = "-" if value.is_signed() else self.random.choice(("", "+"))
        value = value.copy_abs()
        forms = [f"{value:e}", f"{value:E}", f"{value:e}".replace("e-", "e-0")]
        if value.adjusted() > -20:
            plain = f"{value:f}"
            forms += [
                plain,
                f"0{plain}",
                f"{plain}0" if "." in plain else f"{plain}.",
                f"{plain}00" if "." in plain else f"{plain}.00",
            ]
            forms += [plain[1:]] if plain.startswith("0.") else []
        return sign + self.random.choice(forms)
