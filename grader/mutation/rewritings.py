"""Rewritings of a robot, each of a family: another file, the same robot. A step returns whether it changed anything."""

from collections.abc import Callable, Collection
from math import pi
from random import Random
from typing import NamedTuple

from grader.mutation.trees import (
    add_joint,
    add_link,
    attribute_numbers,
    attribute_text,
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

_SORTED = ("link", "joint", "material", "visual", "collision")  # of these the order does not matter
_SLIDING = "prismatic"
_TURNING = ("revolute", "continuous")


class RewritingRules(NamedTuple):
    """What a rewriting must leave as it is: the names `named`, and the frames for which `may_move` is false."""

    named: Collection[str]
    may_move: Callable[[str], bool]


Rewriting = Callable[[Random, Element, RewritingRules], bool]


def shuffle(random: Random, tree: Element, around: RewritingRules) -> bool:
    """Change the order of elements: links, joints and materials, and those inside of each."""
    del around
    free = ("joint", "material", "collision") if _has_shared_material(tree) else _SORTED
    for owner in [tree, *own_elements(tree, "link", "joint", "visual", "collision", "inertial")]:
        children = list(owner)
        shuffled = random.sample(children, len(children))
        for child in children:
            owner.remove(child)
        owner.extend(_stable(children, shuffled, free))
    return True


def _has_shared_material(tree: Element) -> bool:
    """Return whether a visual defines a material that another one uses: the first definition counts, from there on."""
    known = {material.get("name") for material in tree.iterchildren("material")}
    names = [found.get("name") for found in own_elements(tree, "material") if found.getparent() is not tree]
    return any(names.count(name) > 1 and name not in known for name in set(names))


def _stable(before: list[Element], after: list[Element], free: tuple[str, ...]) -> list[Element]:
    """Return the shuffled elements with those whose order matters in it: the first of several origins counts."""
    queues: dict[str, list[Element]] = {}
    for element in before:
        if element.tag not in free:
            queues.setdefault(str(element.tag), []).append(element)
    return [queues[str(element.tag)].pop(0) if str(element.tag) in queues else element for element in after]


def split_joints(random: Random, tree: Element, around: RewritingRules) -> bool:
    """Put an empty link into the middle of fixed joints; their names stay in the chain."""
    del around
    fixed = [joint for joint in tree.iterchildren("joint") if joint.get("type") == "fixed"]
    for joint in some(random, fixed):
        split_joint(tree, joint, _any_pose(random), is_first=random.random() < 0.5)
    return bool(fixed)


def split_joint(tree: Element, joint: Element, first: Transform, *, is_first: bool) -> None:
    """Put an empty link into a joint, at `first` in the parent's frame; `is_first` if the upper half keeps the name."""
    middle, parent, child = fresh(tree, "link"), end(joint, "parent"), end(joint, "child")
    add_link(tree, middle)
    second = first.inverse() @ pose(joint)
    if is_first:
        add_joint(tree, fresh(tree, "joint"), middle, child.get("link", ""), second)
        set_pose(joint, first)
        child.set("link", middle)
    else:
        add_joint(tree, fresh(tree, "joint"), parent.get("link", ""), middle, first)
        set_pose(joint, second)
        parent.set("link", middle)


def move_frames(random: Random, tree: Element, around: RewritingRules) -> bool:
    """Move the frames of links together with what is in them, where nothing refers to the frame."""
    links = [link for link in tree.iterchildren("link") if around.may_move(link.get("name", ""))]
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


def turn_fully(random: Random, tree: Element, around: RewritingRules) -> bool:
    """Write rotations with additional full turns, or by their other three angles."""
    del around
    origins = list(own_elements(tree, "origin"))
    for found in some(random, origins):
        found.set("rpy", attribute_text(other_angles(random, attribute_numbers(found, "rpy"))))
    return bool(origins)


def other_angles(random: Random, rpy: list[float]) -> list[float]:
    """Return other angles of the same rotation."""
    roll, pitch, yaw = rpy
    if random.random() < 0.5:
        roll, pitch, yaw = roll + pi, pi - pitch, yaw + pi
    return [angle + 2 * pi * random.randint(-3, 3) for angle in (roll, pitch, yaw)]


def scale_axes(random: Random, tree: Element, around: RewritingRules) -> bool:
    """Scale axes of joints."""
    del around
    axes = list(own_elements(tree, "axis"))
    for axis in some(random, axes):
        factor = 10 ** random.uniform(-2, 2)
        axis.set("xyz", attribute_text(factor * number for number in attribute_numbers(axis, "xyz")))
    return bool(axes)


def rename_links(random: Random, tree: Element, around: RewritingRules) -> bool:
    """Rename links and materials that nothing but this file refers to."""
    return _rename_around(random, tree, around, ("link", "material"))


def rename_joints(random: Random, tree: Element, around: RewritingRules) -> bool:
    """Rename joints that nothing but this file refers to."""
    return _rename_around(random, tree, around, ("joint",))


def _rename_around(random: Random, tree: Element, around: RewritingRules, tags: tuple[str, ...]) -> bool:
    changed = False
    children = [end(joint, "child").get("link") for joint in tree.iterchildren("joint")]
    if "joint" in tags and len(set(children)) < len(children):  # of two parents, the joint that is last by name counts
        return False
    for tag in tags:
        elements = own_elements(tree, tag) if tag == "material" else tree.iterchildren(tag)
        names = dict.fromkeys(element.get("name", "") for element in elements)
        for name in some(random, [name for name in names if name and name not in around.named]):
            _rename(tree, tag, name, f"{name}_{random.randint(2, 99)}x")
            changed = True
    return changed


_REFERENCES = {"link": ("link",), "joint": ("joint",), "material": ()}


def _rename(tree: Element, tag: str, name: str, new: str) -> None:
    for element in own_elements(tree, "*"):
        if element.tag == tag and element.get("name") == name:
            element.set("name", new)
        for attribute in _REFERENCES[tag]:
            if element.get(attribute) == name and element.tag in ("parent", "child", "mimic"):
                element.set(attribute, new)


def _any_pose(random: Random) -> Transform:
    xyz = [round(random.uniform(-1, 1), 6) for _ in range(3)]
    return origin(xyz, [round(random.uniform(-3, 3), 6) for _ in range(3)])
