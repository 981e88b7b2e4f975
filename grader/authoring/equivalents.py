"""Equivalents of a reference: the same robot in another file, one of each family. Each must keep full marks."""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator
from typing import NamedTuple

from lxml import etree

from grader.checks.check import EQUIVALENTS
from grader.robot.transforms import IDENTITY, Transform, Vector, rotation_from_rpy, unit
from grader.xacro.texts import INSTALLED
from grader.xml.parsing import Element
from grader.xml.urdf_format import PARTS
from grader.xml.wanted_element import FOREIGN, words_of_foreign

XACRO = "http://www.ros.org/wiki/xacro"
_FOUND = re.compile(rf"\Afile:/*{INSTALLED}/([^/]+)/share/\1/")


_SORTED = ("link", "joint", "material", "visual", "collision")  # of these the order does not matter
_COMMENTS = ("", " a robot ", ' <link name="ghost"/> ', "\n  0.6 / 4\n  ", " $ & % ")
_NUMBER = re.compile(r"(?<![\w.+-])-?(?:0|[1-9]\d*)(?:\.\d+)?(?![\w.])")  # that xacro writes as it is
_MAX_DIGITS = 12  # that survive the conversion to a float and back
_MOVED = Transform(rotation_from_rpy((0.4, -0.7, 1.1)), (0.31, -0.17, 0.23))
_SLIDE = 0.19  # metres


class Equivalent(NamedTuple):
    """Another text for the robot: how it was rewritten, and the text with only its layout changed."""

    family: str
    text: str
    before: str
    is_xacro: bool


class RewritingRules(NamedTuple):
    """What a rewriting must leave as it is: the names `named`, and, with `placed`, the frames of links that move."""

    named: Collection[str]
    placed: bool = False


Rewriting = Callable[[Element, RewritingRules], bool]  # returns whether it changed anything


def equivalents(root: Element, rules: RewritingRules) -> Iterator[Equivalent]:
    """Yield a rewriting of a robot of each family, which changes all that the rules and the family allow."""
    rules = rules._replace(named={*rules.named, *words_of_foreign(root)})
    before = text_of(copied(root))
    for family, rewriting in REWRITINGS.items():
        tree = copied(root)
        if rewriting(tree, rules):
            text = text_of(tree, "\t" if family == LAYOUT else "  ")
            yield Equivalent(family, text, before, family in AS_XACRO)


def reorder(tree: Element, _: RewritingRules) -> bool:
    """Reverse the order of elements: links, joints and materials, and those inside of each."""
    # A visual may use the material that another one defines before it.
    free = ("joint", "material", "collision") if tree.find("link/visual/material/*") is not None else _SORTED
    for owner in [tree, *own_elements(tree, "link", "joint", "visual", "collision", "inertial")]:
        kinds: dict[object, list[Element]] = {}  # of several origins the first counts
        for child in owner:
            kinds.setdefault(child.tag, []).insert(0 if child.tag in free else len(owner), child)
        owner[:] = [child for children in reversed(kinds.values()) for child in children]
    return True


def split_joints(tree: Element, _: RewritingRules) -> bool:
    """Put an empty link into the middle of fixed joints; each keeps its name, in turn of the upper and lower half."""
    fixed = [joint for joint in tree.iterchildren("joint") if joint.get("type") == "fixed"]
    for index, joint in enumerate(fixed):
        split_joint(tree, joint, _MOVED, is_first=index % 2 == 0)
    return bool(fixed)


def split_joint(tree: Element, joint: Element, first: Transform, *, is_first: bool) -> None:
    """Put an empty link into a joint, at `first` in the parent's frame; `is_first` if the upper half keeps the name."""
    middle, parent, child = fresh(tree, "link"), end(joint, "parent"), end(joint, "child")
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


def move_frames(tree: Element, rules: RewritingRules) -> bool:
    """Move the frames of links together with what is in them, where nothing refers to the frame."""
    moved = False
    for link in tree.iterchildren("link"):
        joint = parent_joint(tree, link.get("name", ""))
        change = _free_move(tree, joint, rules) if joint is not None and link.get("name") not in rules.named else None
        if change is not None:
            move_frame(tree, link, change)
            moved = True
    return moved


def _free_move(tree: Element, joint: Element, rules: RewritingRules) -> Transform | None:
    """Return a change of a child's frame that leaves the motion of the joint as it is; None if there is none.

    @root, @tip and @moved:2 name links by structure, whose frames are those that move, and those at the ends.
    """
    kind, child = joint.get("type"), end(joint, "child").get("link")
    is_tip = all(end(other, "parent").get("link") != child for other in tree.iterchildren("joint"))
    if rules.placed and (kind != "fixed" or is_tip):
        return None
    if kind in ("fixed", "prismatic"):
        return _MOVED
    axis = unit(vector_of(joint.find("axis"), "xyz", "1 0 0"))
    if kind not in ("revolute", "continuous") or axis is None:
        return None
    x, y, z = axis
    return Transform(translation=(x * _SLIDE, y * _SLIDE, z * _SLIDE)) @ Transform(_MOVED.rotation)


# The elements that have or use the name of a link, joint or material, with the attribute.
_NAMED = {
    "link": (("link", "name"), ("parent", "link"), ("child", "link")),
    "joint": (("joint", "name"), ("mimic", "joint")),
    "material": (("material", "name"),),
}


def rename_links(tree: Element, rules: RewritingRules) -> bool:
    """Rename links and materials that nothing but this file refers to."""
    renamed = [_rename(tree, rules, tag) for tag in ("link", "material")]
    return any(renamed)


def rename_joints(tree: Element, rules: RewritingRules) -> bool:
    """Rename joints that nothing but this file refers to."""
    children = [end(joint, "child").get("link") for joint in tree.iterchildren("joint")]
    is_tree = len(set(children)) == len(children)  # of two parents, the joint that is last by name counts
    return is_tree and _rename(tree, rules, "joint")


def _rename(tree: Element, rules: RewritingRules, tag: str) -> bool:
    uses = [(element, attribute) for owner, attribute in _NAMED[tag] for element in own_elements(tree, owner)]
    names = {element.get(attribute, "") for element, attribute in uses if element.tag == tag}
    chosen = names - {"", *rules.named}
    for element, attribute in uses:
        if (name := element.get(attribute)) in chosen:
            element.set(attribute, f"{name}_2x")
    return bool(chosen)


def change_layout(tree: Element, _: RewritingRules) -> bool:
    """Reverse the order of attributes, and add comments; `text_of` changes the white space."""
    for index, element in enumerate([*own_elements(tree, "*")]):
        attributes = [*reversed(element.attrib.items())]
        element.attrib.clear()
        element.attrib.update(attributes)
        if index % 5 == 0:
            element.addprevious(etree.Comment(_COMMENTS[index // 5 % len(_COMMENTS)]))
    return True


def use_properties(tree: Element, _: RewritingRules) -> bool:
    """Write numbers that occur more than once as properties of xacro."""
    values = [(it, str(key)) for it in own_elements(tree, "*") for key in it.attrib if PARTS.get(str(key))]
    counts = Counter(number for it, key in values for number in _NUMBER.findall(it.get(key, "")))
    repeated = [number for number, count in counts.items() if count > 1 and len(number) <= _MAX_DIGITS]
    if not repeated or _has_dollar(tree):
        return False
    names = {number: f"number_{index}" for index, number in enumerate(repeated)}

    def use(found: re.Match[str]) -> str:
        return f"${{{names[found[0]]}}}" if found[0] in names else found[0]

    for it, key in values:
        it.set(key, _NUMBER.sub(use, it.get(key, "")))
    for number, name in names.items():
        tree.insert(0, etree.Element(f"{{{XACRO}}}property", {"name": name, "value": number}))
    return True


def use_macro(tree: Element, _: RewritingRules) -> bool:
    """Write the first link as a macro of xacro."""
    link = next((link for link in tree.iterchildren("link") if link.get("name")), None)
    if link is None or _has_dollar(tree):
        return False
    tree.replace(link, etree.Element(f"{{{XACRO}}}part", {"name": link.get("name", "")}))
    macro = etree.Element(f"{{{XACRO}}}macro", {"name": "part", "params": "name"})
    link.set("name", "${name}")
    macro.append(link)
    tree.insert(0, macro)
    return True


def _has_dollar(tree: Element) -> bool:
    """Return whether xacro would evaluate something in a tree."""
    return b"$" in etree.tostring(tree)


LAYOUT, *AS_XACRO = EQUIVALENTS[-3:]
_ALL = (reorder, split_joints, move_frames, rename_links, rename_joints, change_layout, use_properties, use_macro)
REWRITINGS: dict[str, Rewriting] = dict(zip(EQUIVALENTS, _ALL, strict=True))


def copied(root: Element) -> Element:
    """Return a copy of a tree without comments; paths of meshes that $(find package) gave become package:// ones.

    Its root declares the namespace of xacro.
    """
    plain = etree.XMLParser(remove_comments=True, remove_pis=True, remove_blank_text=True)
    found = etree.fromstring(etree.tostring(root, with_tail=False), plain)
    copy = etree.Element(found.tag, dict(found.attrib), nsmap={"xacro": XACRO})
    copy.extend(list(found))
    for mesh in copy.iter("mesh"):
        if mesh.get("filename"):
            mesh.set("filename", _FOUND.sub(r"package://\1/", mesh.get("filename", "")))
    return copy


def text_of(tree: Element, indent: str = "  ") -> str:
    """Return a tree as text, without namespaces that are not used."""
    etree.cleanup_namespaces(tree)
    etree.indent(tree, indent)
    return etree.tostring(tree, encoding="unicode")


def own_elements(tree: Element, *tags: str) -> Iterator[Element]:
    """Yield the elements with these tags that ROS 2 reads: not those inside of elements for a simulator."""
    for child in tree:
        if child.tag not in FOREIGN:
            yield from child.iter(*tags)


def fresh(tree: Element, kind: str) -> str:
    """Return a name that nothing in the robot has."""
    return f"extra_{kind}_{len(tree)}"


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
    """Return the one joint whose child is this link; None of several."""
    found = [joint for joint in tree.iterchildren("joint") if end(joint, "child").get("link") == link]
    return found[0] if len(found) == 1 else None


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


def add_joint(tree: Element, name: str, parent: str, child: str, transform: Transform) -> Element:
    """Add a fixed joint."""
    joint = etree.SubElement(tree, "joint", {"name": name, "type": "fixed"})
    etree.SubElement(joint, "parent", {"link": parent})
    etree.SubElement(joint, "child", {"link": child})
    set_pose(joint, transform)
    return joint
