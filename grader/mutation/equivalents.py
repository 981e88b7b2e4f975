"""Equivalents of a reference: the same robot in another file, one of each family. Each must keep full marks."""

from collections.abc import Callable, Collection, Iterator
from typing import NamedTuple

from lxml import etree

from grader.checks.check import EQUIVALENTS
from grader.mutation.trees import (
    add_joint,
    copied,
    end,
    fresh,
    move_frame,
    origin,
    own_elements,
    parent_joint,
    pose,
    set_pose,
    text_of,
    vector_of,
)
from grader.robot.transforms import Transform, unit
from grader.xml.parsing import Element
from grader.xml.wanted_element import words_of_foreign

_SORTED = ("link", "joint", "material", "visual", "collision")  # of these the order does not matter
_MOVED = origin((0.31, -0.17, 0.23), (0.4, -0.7, 1.1))
_SLIDE = 0.19  # metres


class Equivalent(NamedTuple):
    """Another text for the robot: how it was rewritten, and the text with only its layout changed."""

    family: str
    text: str
    before: str


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
            yield Equivalent(family, text_of(tree), before)


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


REWRITINGS: dict[str, Rewriting] = dict(
    zip(EQUIVALENTS, (reorder, split_joints, move_frames, rename_links, rename_joints), strict=True)
)
