"""Rewritings of a robot, each of a family: another file, the same robot. A step returns whether it changed anything."""

import re
from collections import Counter
from collections.abc import Callable, Collection
from random import Random
from typing import NamedTuple

from lxml import etree

from grader.checks.check import EQUIVALENTS
from grader.mutation.trees import (
    XACRO,
    add_joint,
    end,
    fresh,
    move_frame,
    origin,
    own_elements,
    parent_joint,
    pose,
    set_pose,
    some,
    vector_of,
)
from grader.robot.transforms import Transform, unit
from grader.xml.parsing import Element
from grader.xml.urdf_format import PARTS

_SORTED = ("link", "joint", "material", "visual", "collision")  # of these the order does not matter
_SLIDING = "prismatic"
_TURNING = ("revolute", "continuous")
_COMMENTS = ("", " a robot ", ' <link name="ghost"/> ', "\n  0.6 / 4\n  ", " $ & % ")
_NUMBER = re.compile(r"(?<![\w.+-])-?(?:0|[1-9]\d*)(?:\.\d+)?(?![\w.])")  # that xacro writes as it is
_MAX_DIGITS = 12  # that survive the conversion to a float and back
_MAX_PROPERTIES = 8


class RewritingRules(NamedTuple):
    """What a rewriting must leave as it is: the names `named`, and the frames for which `may_move` is false."""

    named: Collection[str]
    may_move: Callable[[str], bool]


Rewriting = Callable[[Random, Element, RewritingRules], bool]


def shuffle(random: Random, tree: Element, _: RewritingRules) -> bool:
    """Change the order of elements: links, joints and materials, and those inside of each."""
    free = ("joint", "material", "collision") if _has_shared_material(tree) else _SORTED
    for owner in [tree, *own_elements(tree, "link", "joint", "visual", "collision", "inertial")]:
        ranks = {child.tag: random.random() for child in owner}  # of several origins the first counts
        order = {child: random.random() if child.tag in free else ranks[child.tag] for child in owner}
        owner[:] = sorted(owner, key=order.__getitem__)
    return True


def _has_shared_material(tree: Element) -> bool:
    """Return whether a visual defines a material that another one uses: the first definition counts, from there on."""
    known = {material.get("name") for material in tree.iterchildren("material")}
    names = [found.get("name") for found in own_elements(tree, "material") if found.getparent() is not tree]
    return any(names.count(name) > 1 and name not in known for name in set(names))


def split_joints(random: Random, tree: Element, _: RewritingRules) -> bool:
    """Put an empty link into the middle of fixed joints; their names stay in the chain."""
    fixed = [joint for joint in tree.iterchildren("joint") if joint.get("type") == "fixed"]
    for joint in some(random, fixed):
        split_joint(tree, joint, _any_pose(random), is_first=random.random() < 0.5)
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


def move_frames(random: Random, tree: Element, rules: RewritingRules) -> bool:
    """Move the frames of links together with what is in them, where nothing refers to the frame."""
    links = [link for link in tree.iterchildren("link") if rules.may_move(link.get("name", ""))]
    moved = False
    for link in some(random, links):
        joint = parent_joint(tree, link.get("name", ""))
        change = _free_move(random, joint) if joint is not None else None
        if change is not None:
            move_frame(tree, link, change)
            moved = True
    return moved


def _free_move(random: Random, joint: Element) -> Transform | None:
    """Return a change of a child's frame that leaves the motion of the joint as it is; None if there is none."""
    kind, change = joint.get("type"), _any_pose(random)
    if kind in ("fixed", _SLIDING):
        return change
    axis = unit(vector_of(joint.find("axis"), "xyz", "1 0 0"))
    if kind not in _TURNING or axis is None:
        return None
    x, y, z = axis
    slide = random.uniform(-1, 1)
    return Transform(translation=(x * slide, y * slide, z * slide)) @ Transform(change.rotation)


# The elements that have or use the name of a link, joint or material, with the attribute.
_NAMED = {
    "link": (("link", "name"), ("parent", "link"), ("child", "link")),
    "joint": (("joint", "name"), ("mimic", "joint")),
    "material": (("material", "name"),),
}


def rename_links(random: Random, tree: Element, rules: RewritingRules) -> bool:
    """Rename links and materials that nothing but this file refers to."""
    renamed = [_rename(random, tree, rules, tag) for tag in ("link", "material")]
    return any(renamed)


def rename_joints(random: Random, tree: Element, rules: RewritingRules) -> bool:
    """Rename joints that nothing but this file refers to."""
    children = [end(joint, "child").get("link") for joint in tree.iterchildren("joint")]
    is_tree = len(set(children)) == len(children)  # of two parents, the joint that is last by name counts
    return is_tree and _rename(random, tree, rules, "joint")


def _rename(random: Random, tree: Element, rules: RewritingRules, tag: str) -> bool:
    uses = [(element, attribute) for owner, attribute in _NAMED[tag] for element in own_elements(tree, owner)]
    names = dict.fromkeys(element.get(attribute, "") for element, attribute in uses if element.tag == tag)
    chosen = some(random, [name for name in names if name and name not in rules.named])
    for name in chosen:
        new = f"{name}_{random.randint(2, 99)}x"
        for element, attribute in uses:
            if element.get(attribute) == name:
                element.set(attribute, new)
    return bool(chosen)


def change_layout(random: Random, tree: Element, _: RewritingRules) -> bool:
    """Change the order of attributes, and add comments; `text_of` changes the white space."""
    for element in [*own_elements(tree, "*")]:
        attributes = [*element.attrib.items()]
        random.shuffle(attributes)
        element.attrib.clear()
        element.attrib.update(attributes)
        if random.random() < 0.2:
            element.addprevious(etree.Comment(random.choice(_COMMENTS)))
    return True


def use_properties(random: Random, tree: Element, _: RewritingRules) -> bool:
    """Write numbers that occur more than once as properties of xacro."""
    values = [(it, str(key)) for it in own_elements(tree, "*") for key in it.attrib if PARTS.get(str(key))]
    counts = Counter(number for it, key in values for number in _NUMBER.findall(it.get(key, "")))
    repeated = [number for number, count in counts.items() if count > 1 and len(number) <= _MAX_DIGITS]
    if not repeated or _has_dollar(tree):
        return False
    chosen = random.sample(repeated, min(len(repeated), _MAX_PROPERTIES))
    names = {number: f"number_{index}" for index, number in enumerate(chosen)}
    for it, key in values:
        it.set(
            key,
            _NUMBER.sub(lambda found: f"${{{names[found[0]]}}}" if found[0] in names else found[0], it.get(key, "")),
        )
    for number, name in names.items():
        tree.insert(0, etree.Element(f"{{{XACRO}}}property", {"name": name, "value": number}))
    return True


def use_macro(random: Random, tree: Element, _: RewritingRules) -> bool:
    """Write a link as a macro of xacro."""
    links = [link for link in tree.iterchildren("link") if link.get("name")]
    if not links or _has_dollar(tree):
        return False
    link = random.choice(links)
    tree.replace(link, etree.Element(f"{{{XACRO}}}part", {"name": link.get("name", "")}))
    macro = etree.Element(f"{{{XACRO}}}macro", {"name": "part", "params": "name"})
    link.set("name", "${name}")
    macro.append(link)
    tree.insert(0, macro)
    return True


def _has_dollar(tree: Element) -> bool:
    """Return whether xacro would evaluate something in a tree."""
    return b"$" in etree.tostring(tree)


def _any_pose(random: Random) -> Transform:
    xyz = [round(random.uniform(-1, 1), 6) for _ in range(3)]
    return origin(xyz, [round(random.uniform(-3, 3), 6) for _ in range(3)])


LAYOUT, *AS_XACRO = EQUIVALENTS[-3:]
STEPS: dict[str, Rewriting] = dict(
    zip(
        EQUIVALENTS,
        (shuffle, split_joints, move_frames, rename_links, rename_joints, change_layout, use_properties, use_macro),
        strict=True,
    )
)
