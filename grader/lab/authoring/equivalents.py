"""Equivalents of a reference: the same robot in another file, one of each rewriting.

Each must keep full marks.

`is_same_robot` tells whether a changed file is still the same robot.
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import NamedTuple

from lxml import etree

from grader.base.patterns import on_use
from grader.base.transforms import Transform, rotation_from_rpy, unit
from grader.lab.authoring.trees import (
    XACRO,
    attribute_text,
    copied,
    end,
    move_frame,
    own_elements,
    parent_joint,
    read_vector,
    split_joint,
    write_tree,
)
from grader.lab.checks.check import EQUIVALENTS
from grader.ros.package.robot_file import Read, Urdf
from grader.ros.urdf.normal_form import normal_form
from grader.ros.xml.elements import foreign_elements, words_of_foreign
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import PARTS

_SORTED = ("link", "joint", "material", "visual", "collision")  # of these the order does not matter
_COMMENTS = ("", " a robot ", ' <link name="ghost"/> ', "\n  0.6 / 4\n  ", " $ & % ")
_NUMBER = on_use(r"(?<![\w.+-])-?(?:0|[1-9]\d*)(?:\.\d+)?(?![\w.])")  # that xacro writes as it is
_MAX_DIGITS = 12  # that survive the conversion to a float and back
_MOVED = Transform(rotation_from_rpy((0.4, -0.7, 1.1)), (0.31, -0.17, 0.23))
_SLIDE = 0.19  # metres


class Equivalent(NamedTuple):
    """Another text for the robot.

    It says how it was rewritten, and has the text with only its layout changed.
    """

    rewriting: str
    text: str
    before: str
    is_xacro: bool


class RewritingRules(NamedTuple):
    """What a rewriting must leave as it is."""

    named: Collection[str]  # names
    placed: bool = False  # whether the frames of links that move stay


_Rewriting = Callable[[Element, RewritingRules], bool]  # returns whether it changed anything


def equivalents(root: Element, rules: RewritingRules) -> Iterator[Equivalent]:
    """Yield a robot as each rewriting leaves it.

    Each changes all that the rules and the rewriting allow.
    """
    rules = rules._replace(named={*rules.named, *words_of_foreign(root)})
    before = write_tree(copied(root))
    for rewriting, rewrite in _REWRITINGS.items():
        tree = copied(root)
        if rewrite(tree, rules):
            text = write_tree(tree, "\t" if rewriting == _LAYOUT else "  ")
            yield Equivalent(rewriting, text, before, rewriting in _AS_XACRO)


def _reorder(tree: Element, _: RewritingRules) -> bool:
    """Reverse the order of elements: links, joints and materials, and those inside of each."""
    # A visual may use the material that another one defines before it.
    free: Sequence[str] = _SORTED
    if tree.find("link/visual/material/*") is not None:
        free = ("joint", "material", "collision")
    for owner in [tree, *own_elements(tree, "link", "joint", "visual", "collision", "inertial")]:
        kinds: dict[object, list[Element]] = {}  # of several origins the first counts
        for child in owner:
            kinds.setdefault(child.tag, []).insert(0 if child.tag in free else len(owner), child)
        owner[:] = [child for children in reversed(kinds.values()) for child in children]
    return True


def _split_joints(tree: Element, _: RewritingRules) -> bool:
    """Put an empty link into the middle of fixed joints.

    Each keeps its name, in turn of the upper and lower half.
    """
    fixed = [joint for joint in tree.iterchildren("joint") if joint.get("type") == "fixed"]
    for index, joint in enumerate(fixed):
        split_joint(tree, joint, _MOVED, is_first=index % 2 == 0)
    return bool(fixed)


def _move_frames(tree: Element, rules: RewritingRules) -> bool:
    """Move the frames of links together with what is in them, where nothing refers to the frame."""
    moved = False
    for link in tree.iterchildren("link"):
        joint = parent_joint(tree, link.get("name", ""))
        if joint is not None and link.get("name") not in rules.named:
            change = _free_move(tree, joint, rules)
        else:
            change = None
        if change:
            move_frame(tree, link, change)
            moved = True
    return moved


def _free_move(tree: Element, joint: Element, rules: RewritingRules) -> Transform | None:
    """Return a change of a child's frame that leaves the motion of the joint as it is.

    It is None if there is none.

    @root, @tip and @moved:2 name links by structure, whose frames are those that move, and those at
    the ends.
    """
    kind = joint.get("type")
    child = end(joint, "child").get("link")
    is_tip = all(end(other, "parent").get("link") != child for other in tree.iterchildren("joint"))
    if rules.placed and (kind != "fixed" or is_tip):
        return None
    if kind in ("fixed", "prismatic"):
        return _MOVED
    axis = unit(read_vector(joint.find("axis"), "1 0 0"))
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


def _rename_links(tree: Element, rules: RewritingRules) -> bool:
    """Rename links and materials that nothing but this file refers to."""
    renamed = [_rename(tree, rules, tag) for tag in ("link", "material")]
    return any(renamed)


def _rename_joints(tree: Element, rules: RewritingRules) -> bool:
    """Rename joints that nothing but this file refers to."""
    children = [end(joint, "child").get("link") for joint in tree.iterchildren("joint")]
    is_tree = len(set(children)) == len(
        children
    )  # of two parents, the joint that is last by name counts
    return is_tree and _rename(tree, rules, "joint")


def _rename(tree: Element, rules: RewritingRules, tag: str) -> bool:
    uses = [
        (element, attribute)
        for owner, attribute in _NAMED[tag]
        for element in own_elements(tree, owner)
    ]
    names = {element.get(attribute, "") for element, attribute in uses if element.tag == tag}
    chosen = names - {"", *rules.named}
    for element, attribute in uses:
        if (name := element.get(attribute)) in chosen:
            element.set(attribute, f"{name}_2x")
    return bool(chosen)


def _turn_mimic_joints(tree: Element, rules: RewritingRules) -> bool:
    """Turn the axes of joints that follow others, and their numbers: they move as before.

    Wheels stay, and joints that something outside of the file refers to, or that others follow.
    """
    followed = {mimic.get("joint") for mimic in own_elements(tree, "mimic")}
    turned = False
    for joint in tree.iterchildren("joint"):
        mimic = joint.find("mimic")
        axis = joint.find("axis")
        name = joint.get("name", "")
        is_free = name not in rules.named and name not in followed
        if mimic is None or not is_free or joint.get("type") not in ("revolute", "prismatic"):
            continue
        if axis is None:
            axis = etree.SubElement(joint, "axis")
        axis.set("xyz", attribute_text(-value for value in read_vector(axis, "1 0 0")))
        for key, default in (("multiplier", "1"), ("offset", "0")):
            mimic.set(key, attribute_text([-float(mimic.get(key, default))]))
        for limit in joint.iterchildren("limit"):
            ends = [-float(limit.get(key, "0")) for key in ("upper", "lower")]
            for key, value in zip(("lower", "upper"), ends, strict=True):
                limit.set(key, attribute_text([value]))
        turned = True
    return turned


def _change_layout(tree: Element, _: RewritingRules) -> bool:
    """Reverse the order of attributes, and add comments; `write_tree` changes the white space."""
    for index, element in enumerate(list(own_elements(tree, "*"))):
        attributes = list(reversed(element.attrib.items()))
        element.attrib.clear()
        element.attrib.update(attributes)
        if index % 5 == 0:
            element.addprevious(etree.Comment(_COMMENTS[index // 5 % len(_COMMENTS)]))
    return True


def _use_properties(tree: Element, _: RewritingRules) -> bool:
    """Write numbers that occur more than once as properties of xacro."""
    values = [
        (element, str(key))
        for element in own_elements(tree, "*")
        for key in element.attrib
        if PARTS.get(str(key))
    ]
    counts = Counter(
        number for element, key in values for number in _NUMBER.findall(element.get(key, ""))
    )
    repeated = [
        number for number, count in counts.items() if count > 1 and len(number) <= _MAX_DIGITS
    ]
    if not repeated or _has_dollar(tree):
        return False
    names = {number: f"number_{index}" for index, number in enumerate(repeated)}

    def use(number_match: re.Match[str]) -> str:
        if number_match[0] in names:
            return f"${{{names[number_match[0]]}}}"
        return number_match[0]

    for element, key in values:
        element.set(key, _NUMBER.sub(use, element.get(key, "")))
    for number, name in names.items():
        tree.insert(0, etree.Element(f"{{{XACRO}}}property", {"name": name, "value": number}))
    return True


def _use_macro(tree: Element, _: RewritingRules) -> bool:
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


_LAYOUT, *_AS_XACRO = EQUIVALENTS[-3:]
_ALL = (
    _reorder,
    _split_joints,
    _move_frames,
    _rename_links,
    _rename_joints,
    _turn_mimic_joints,
    _change_layout,
    _use_properties,
    _use_macro,
)
_REWRITINGS = dict(zip(EQUIVALENTS, _ALL, strict=True))


def is_same_robot(one: Urdf, other: Urdf, kept: Collection[str]) -> bool:
    """Return whether two URDFs are the same robot.

    `kept` are names that something outside of the file refers to.

    ROS 2's verdict counts, the normal form of the robot, and the elements for simulators and
    controllers.
    """
    form = _counting_form(one, kept)
    return form is not None and form == _counting_form(other, kept)


def _counting_form(urdf: Urdf, kept: Collection[str]) -> object:
    """Return what counts of a file; None if no robot is read."""
    if not isinstance(urdf, Read) or not urdf.reading.robot or urdf.reading.root is None:
        return None
    robot = urdf.reading.robot
    root = urdf.reading.root
    foreign = [
        etree.tostring(child, with_tail=False)
        for child in sorted(
            foreign_elements(root), key=lambda child_element: str(child_element.tag)
        )
    ]
    form = normal_form(
        robot, {*kept, *words_of_foreign(root)}, decimals=2
    )  # half a turn may be written 3.14
    return urdf.loaded.verdict, urdf.reading.undetermined, foreign, form
