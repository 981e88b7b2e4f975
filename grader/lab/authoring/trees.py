"""The element tree of a URDF, to rewrite a robot: poses, frames and joints."""

from collections.abc import Iterable, Iterator

from lxml import etree

from grader.base.patterns import on_use
from grader.base.transforms import (
    IDENTITY,
    Transform,
    Vector,
    rotation_from_quaternion,
    rotation_from_rpy,
)
from grader.ros.xacro.texts import INSTALLED
from grader.ros.xml.elements import FOREIGN
from grader.ros.xml.parsing import Element

XACRO = "http://www.ros.org/wiki/xacro"
_FOUND = on_use(rf"\Afile:/*{INSTALLED}/([^/]+)/share/\1/")


def copied(root: Element) -> Element:
    """Return a copy of a tree without comments.

    Paths of meshes that $(find package) gave become package:// ones.

    Its root declares the namespace of xacro.
    """
    plain = etree.XMLParser(remove_comments=True, remove_pis=True, remove_blank_text=True)
    parsed = etree.fromstring(etree.tostring(root, with_tail=False), plain)
    copy = etree.Element(parsed.tag, dict(parsed.attrib), nsmap={"xacro": XACRO})
    copy.extend(list(parsed))
    for mesh in copy.iter("mesh"):
        if mesh.get("filename"):
            mesh.set("filename", _FOUND.sub(r"package://\1/", mesh.get("filename", "")))
    return copy


def write_tree(tree: Element, indent: str = "  ") -> str:
    """Return a tree as text, without namespaces that are not used."""
    etree.cleanup_namespaces(tree)
    etree.indent(tree, indent)
    return etree.tostring(tree, encoding="unicode")


def origin(xyz: Iterable[float], rpy: Iterable[float]) -> Transform:
    """Return the transform of an origin."""
    x, y, z = xyz
    roll, pitch, yaw = rpy
    return Transform(rotation_from_rpy((roll, pitch, yaw)), (x, y, z))


def attribute_text(values: Iterable[float]) -> str:
    """Return numbers as an attribute contains them."""
    return " ".join(f"{value + 0.0:.13g}" for value in values)


def attribute_numbers(
    element: Element | None, attribute: str, default: str = "0 0 0"
) -> list[float]:
    """Return the numbers of an attribute."""
    text = default if element is None else element.get(attribute, default)
    return [float(piece) for piece in text.split()]


def read_vector(element: Element | None, default: str = "0 0 0") -> Vector:
    """Return the three numbers of `xyz`."""
    x, y, z = attribute_numbers(element, "xyz", default)
    return x, y, z


def pose(owner: Element) -> Transform:
    """Return the pose in the `<origin>` of a joint, a visual, a collision or an inertial."""
    origin_element = owner.find("origin")
    place = origin(
        attribute_numbers(origin_element, "xyz"), attribute_numbers(origin_element, "rpy")
    )
    version = owner.getroottree().getroot().get("version", "1.0")
    if origin_element is None or "quat_xyzw" not in origin_element.attrib:
        return place
    if version == "1.0":  # which ignores it
        return place
    x, y, z, w = attribute_numbers(origin_element, "quat_xyzw")
    return Transform(rotation_from_quaternion((x, y, z, w)), place.translation)


def set_pose(owner: Element, transform: Transform) -> None:
    """Write a pose into the `<origin>` of an element."""
    origin_element = owner.find("origin")
    if origin_element is None:
        if transform == IDENTITY:
            return
        origin_element = etree.SubElement(owner, "origin")
    origin_element.set("xyz", attribute_text(transform.translation))
    origin_element.set("rpy", attribute_text(transform.rpy))
    origin_element.attrib.pop("quat_xyzw", "")


def end(joint: Element, role: str) -> Element:
    """Return the `<parent>` or `<child>` of a joint."""
    end_element = joint.find(role)
    assert end_element is not None
    return end_element


def parent_joint(tree: Element, link: str) -> Element | None:
    """Return the one joint whose child is this link; None of several."""
    joints = [
        joint for joint in tree.iterchildren("joint") if end(joint, "child").get("link") == link
    ]
    if len(joints) == 1:
        return joints[0]
    return None


def move_frame(tree: Element, link: Element, change: Transform) -> None:
    """Move a link's frame by `change`, given in the frame.

    Everything in the link is moved back: nothing else moves.
    """
    name = link.get("name", "")
    held = parent_joint(tree, name)
    assert held is not None
    back = change.inverse()
    set_pose(held, pose(held) @ change)
    axis = held.find("axis")
    if axis is not None:
        axis.set("xyz", attribute_text(back.rotate(read_vector(axis))))
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


def own_elements(tree: Element, *tags: str) -> Iterator[Element]:
    """Yield the elements with these tags that ROS 2 reads.

    Those inside of elements for a simulator are not among them.
    """
    for child in tree:
        if child.tag not in FOREIGN:
            yield from child.iter(*tags)


def split_joint(tree: Element, joint: Element, first: Transform, *, is_first: bool) -> None:
    """Put an empty link into a joint, at `first` in the parent's frame.

    With `is_first`, the upper half keeps the name.
    """
    middle = fresh(tree, "link")
    parent = end(joint, "parent")
    child = end(joint, "child")
    etree.SubElement(tree, "link", {"name": middle})
    second = first.inverse() @ pose(joint)
    if is_first:
        add_joint(tree, fresh(tree, "joint"), middle, child.get("link", ""), second)
        set_pose(joint, first)
        child.set("link", middle)
    else:
        add_joint(tree, fresh(tree, "joint"), parent.get("link", ""), middle, first)
        set_pose(joint, second)
        parent.set("link", middle)
