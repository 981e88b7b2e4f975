"""The elements of a robot as nodes of a tree, which is compared with that of the reference."""

from collections.abc import Mapping

from grader.hints.difference import Node, Step, paired
from grader.hints.robot.draft import Draft
from grader.hints.robot.elements import child_of, end_of
from grader.hints.robot.pieces import normal
from grader.xml.parsing import Element
from grader.xml.urdf_format import TAGS

_AXIS = ("1 0 0", "revolute", "continuous", "prismatic", "planar")
# The attributes that name a joint or a material, which a student may call otherwise.
_NAMES = {("mimic", "joint"): "joint", ("joint", "name"): "joint", ("material", "name"): "material"}


def wanted_value(step: Step) -> str | None:
    """Return the value that a step sets: that of the reference, else the default; None if there is none."""
    if step.verb == "set" and step.like is not None:
        return step.like.values[step.name]
    known = TAGS[step.own.tag].attributes.get(step.name) if step.own.tag in TAGS else None
    return known.default or None if known is not None else None


def node_of(element: Element, names: Mapping[str, Mapping[str, str]] | None = None) -> Node:
    """Return the node of an element, without values and elements that are the default."""
    tag = str(element.tag)
    values = {}
    for name, value in element.attrib.items():
        text = normal(tag, str(name), str(value))
        if tag in TAGS and str(name) in TAGS[tag].attributes and text == normal(tag, str(name), None):
            continue
        values[str(name)] = (names or {}).get(_NAMES.get((tag, str(name)), ""), {}).get(text, text)
    if tag not in TAGS and not len(element) and (element.text or "").strip():
        values[""] = (element.text or "").strip()
    children = [node_of(child, names) for child in element if isinstance(child.tag, str)]
    is_moving = tag != "joint" or element.get("type") in _AXIS[1:]
    children = [child for child in children if not _is_default(child, is_moving=is_moving)]
    return Node(tag, _keys(element, values), values, children, element)


def _keys(element: Element, values: Mapping[str, str]) -> tuple[str, ...]:
    name = values.get("name", "") or values.get("reference", "")
    if element.tag == "joint" and element.getparent() is not None and child_of(element, "child") is not None:
        return end_of(element, "child"), name
    return (name,) if name and element.tag not in ("visual", "collision") else ()


def _is_default(node: Node, *, is_moving: bool) -> bool:
    if node.tag == "axis":
        return not is_moving or node.values.get("xyz", "1 0 0") == "1 0 0"
    return node.tag == "origin" and not node.values


def translation(draft: Draft, reference: Draft) -> dict[str, dict[str, str]]:
    """Return what the joints and materials of the reference are called in the robot."""
    names: dict[str, dict[str, str]] = {"joint": {}, "material": {}}
    known = {joint.name for joint in reference.robot.joints}
    for joint in reference.joints():
        own = draft.joint_of(end_of(joint, "child"))
        is_there = any(it.get("name") == joint.get("name") for it in draft.joints())
        if own is not None and own.get("name") and own.get("name") not in known and not is_there:
            names["joint"][joint.get("name") or ""] = own.get("name") or ""
    mine = [node_of(found) for found in draft.root.iterchildren("material")]
    pairs = paired(mine, [node_of(found) for found in reference.root.iterchildren("material")])
    called = {like.values.get("name", ""): own_node.values.get("name") for own_node, like in pairs.both}
    names["material"] = {name: own_name for name, own_name in called.items() if own_name}
    return names
