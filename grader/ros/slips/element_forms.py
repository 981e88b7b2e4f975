"""The elements of a URDF in another form: as text, as children, in another place."""

from itertools import starmap

from grader.base import markup
from grader.base.element_edits import (
    attributes_text,
    empty_element,
    renamed_tag,
    with_attribute,
    without_element,
)
from grader.base.grouping import Strings, StringsByName
from grader.base.markup import WORD_OF_VALUE
from grader.base.patterns import on_use
from grader.base.slips import Slip, Slips, make_slip
from grader.base.source import Edits, Source
from grader.base.text import cut, quoted
from grader.ros.slips.nodes import find_place
from grader.ros.xacro.xacro_nodes import XacroNode
from grader.ros.xml.broken_tags import read_attributes
from grader.ros.xml.urdf_format import ATTRIBUTES, CHILDREN, PARTS, REQUIRED, TAGS

_MAX_SHOWN = 60  # characters of a value
_NUMBER = on_use(r"[-+]?(?:\d++\.?\d*+|\.\d++)(?:[eE][-+]?\d++)?|.*\$[{(].*")
_POSE = 6  # numbers of a pose
_BY_ATTRIBUTES = {
    ("size",): "box",
    ("radius",): "sphere",
    ("length", "radius"): "cylinder",
}
# Elements of other tools that are none of these.
_NO_SHAPES = (
    "plane",
    "ellipsoid",
    "cone",
    "pyramid",
    "capsule",
    "prism",
    "wedge",
    "torus",
    "ring",
    "circle",
)
# Elements that belong under <robot>, whatever tool reads them.
_OF_ROBOT = ("gazebo", "transmission", "ros2_control")
_OF_OTHERS = ("gazebo", "transmission")  # in which other elements have the names of a URDF's
_REPEATED = ("visual", "collision", *_OF_ROBOT, *CHILDREN["robot"])
_XACRO = ("xacro:macro", "xacro:if", "xacro:unless")


def element_slips(root: XacroNode) -> Slips:
    """Yield the elements of a robot that are written in another form than a URDF has."""
    waiting: list[tuple[XacroNode, tuple[XacroNode, ...]]] = [(root, ())]
    while waiting:
        node, around = waiting.pop()
        parent = around[-1].tag if around else ""
        if node.tag not in _OF_ROBOT or around[1:]:
            yield from _find_slips(node, around, parent)
        if node.tag not in _OF_OTHERS:
            waiting += [(child, (*around, node)) for child in reversed(node.elements)]


def _find_slips(node: XacroNode, around: tuple[XacroNode, ...], parent: str) -> Slips:
    if node.tag in TAGS:
        yield from _with_attributes_inside(node)
    if node.tag == "origin" and {*node.attributes} == {"xyz"}:
        yield from _pose_in_one_attribute(node)
    if parent == "geometry" and node.tag not in TAGS:
        yield from _named_otherwise(node)
    if node.tag in TAGS or node.tag.startswith("xacro:"):
        yield from _attributes_beside(node)
    if len(around) > 1:
        yield from _misplaced(node, around[-1], around[-2])
    if node.tag in CHILDREN["geometry"] and parent in ("visual", "collision"):
        yield from _without_geometry(node, around[-1])
    if node.tag == "joint" and parent != "transmission":
        yield from _ends_in_one_tag(node)


def _with_attributes_inside(node: XacroNode) -> Slips:
    """Yield the element whose attributes are its text or its children, as in SDF."""
    if not node.children:
        return
    absent = [name for name in TAGS[node.tag].attributes if name not in node.attributes]
    text = node.text
    values: StringsByName = {}
    removed: list[XacroNode] = []
    if text and not node.elements:
        values = _values_of_text(node.tag, text, absent)
    elif not text:
        values, removed = _values_of_children(node, absent)
    if not values:
        return
    source, start = find_place(node)
    shown = quoted(cut(" ".join(values.values()), _MAX_SHOWN))
    if text or len(removed) == len(node.elements):
        edits = _as_empty_element(source, start, node, values)
    else:
        end = markup.name_end(source.text, start)
        head = source.edit(start, end, source.text[start:end] + attributes_text(values))
        edits = (head, *(without_element(*find_place(child)) for child in removed))
    names = " and ".join(values)
    reaction = f"ROS 2 reads no {names} of <{node.tag}> from what is inside of it"
    assumption = f"{shown} in <{node.tag}> is read as {attributes_text(values).strip()}"
    yield make_slip(edits, reaction, assumption)


def _as_empty_element(source: Source, start: int, node: XacroNode, values: StringsByName) -> Edits:
    """Return the edit that writes an element with attributes in place of what is inside of it."""
    end = markup.head_end(source.text, start)[0]
    head = source.text[start : end - 1].rstrip()
    closing = "/>"
    if node.tag in CHILDREN:  # a link or a joint: others may follow
        closing = f"></{node.tag}>"
    whole = markup.element_end(source.text, start)
    return (source.edit(start, whole, f"{head}{attributes_text(values)}{closing}"),)


def _values_of_text(tag: str, text: str, absent: list[str]) -> StringsByName:
    """Return the attributes that the text of an element stands for."""
    if "=" in text:
        given = read_attributes(tag, text) or {}
        is_right = all(name in absent and _fits(name, value) for name, value in given.items())
        return given if is_right else {}
    tokens = WORD_OF_VALUE.findall(text)
    if tag == "origin" and absent[:2] == ["xyz", "rpy"] and len(tokens) == _POSE:
        if all(map(_NUMBER.fullmatch, tokens)):
            return {"xyz": " ".join(tokens[:3]), "rpy": " ".join(tokens[3:])}
        return {}
    needed = [name for name in _main_attributes(tag) if name in absent]
    if len(_main_attributes(tag)) == 1 and len(needed) == 1 and _fits(needed[0], text):
        return {needed[0]: " ".join(tokens)}
    return {}


def _attributes_beside(parent: XacroNode) -> Slips:
    """Yield the elements that are attributes of one beside them: <rpy> beside <origin>."""
    for node in parent.elements:
        name = node.tag
        value = _read_value(node)
        if name in TAGS or name not in PARTS or not _fits(name, value):
            continue
        owners = [
            other
            for other in parent.elements
            if name in ATTRIBUTES.get(other.tag, ()) and name not in other.attributes
        ]
        if len(owners) != 1:
            continue
        given = " ".join(WORD_OF_VALUE.findall(value))
        head = with_attribute(*find_place(owners[0]), name, given)
        edits = (head, without_element(*find_place(node)))
        reaction = f"ROS 2 ignores <{name}> in <{parent.tag}>"
        assumption = f"<{name}> is read as an attribute of <{owners[0].tag}>"
        yield Slip(edits, reaction, assumption, edits[1].location)


def _pose_in_one_attribute(node: XacroNode) -> Slips:
    """Yield the origin whose xyz has the numbers of rpy, too."""
    tokens = WORD_OF_VALUE.findall(node.attributes["xyz"])
    if len(tokens) == _POSE and all(map(_NUMBER.fullmatch, tokens)):
        place = find_place(node)
        edits = (
            with_attribute(*place, "rpy", " ".join(tokens[3:])),
            with_attribute(*place, "xyz", " ".join(tokens[:3])),
        )
        assumption = "the last three numbers of xyz are read as rpy"
        yield make_slip(edits, "xyz of <origin> has six numbers", assumption)


def _main_attributes(tag: str) -> Strings:
    """Return the attributes without which an element says nothing."""
    if tag == "axis":
        return ("xyz",)
    return REQUIRED[tag]


def _fits(name: str, text: str) -> bool:
    """Return whether a text has the numbers of an attribute, or is one word."""
    tokens = WORD_OF_VALUE.findall(text)
    parts = PARTS.get(name, ())
    if parts:
        return len(tokens) == len(parts) and all(map(_NUMBER.fullmatch, tokens))
    return len(tokens) == 1


def _values_of_children(
    node: XacroNode, absent: list[str]
) -> tuple[StringsByName, list[XacroNode]]:
    """Return the attributes that the children of an element stand for, and these children."""
    values = {}
    removed = []
    known = CHILDREN.get(node.tag, ())
    for child in node.elements:
        name = child.tag
        if node.tag in ("parent", "child") and name in ("link", "name"):
            name = "link"
        if name not in absent or name in values or name in known:
            continue
        value = _read_value(child)
        if _fits(name, value):
            values[name] = " ".join(WORD_OF_VALUE.findall(value))
            removed.append(child)
    return values, removed


def _read_value(node: XacroNode) -> str:
    """Return the one value that an element has: its text, or that of its only attribute."""
    text = node.text
    if node.elements or (text and node.attributes) or len(node.attributes) > 1:
        return ""
    return text or next(iter(node.attributes.values()), "")


def _named_otherwise(node: XacroNode) -> Slips:
    """Yield the shape of another word that has the attributes of one: <cube size="1 2 3"/>."""
    given = node.attributes
    shape = _BY_ATTRIBUTES.get(tuple(sorted(given)), "")
    is_fitting = all(starmap(_fits, given.items()))
    if not shape or not is_fitting or node.tag.lower() in _NO_SHAPES or ":" in node.tag:
        return
    source, start = find_place(node)
    reaction = f"ROS 2 ignores <{node.tag}> in <geometry>"
    assumption = f"<{node.tag}> is read as <{shape}>"
    yield make_slip(renamed_tag(source, start, shape), reaction, assumption)


def _misplaced(node: XacroNode, parent: XacroNode, around: XacroNode) -> Slips:
    """Yield the element that belongs beside the one that it is in: <axis> in <child>."""
    tag = node.tag
    if (tag not in TAGS and tag not in _OF_ROBOT) or tag in ATTRIBUTES.get(parent.tag, ()):
        return
    if parent.tag not in TAGS or tag in CHILDREN.get(parent.tag, ()):
        return
    siblings = [child.tag for child in around.elements]
    if around.tag == "robot" or around.tag in _XACRO:
        is_right = tag in CHILDREN["robot"] or tag in _OF_ROBOT
    else:
        is_right = tag in CHILDREN.get(around.tag, ()) or tag == parent.tag
    if not is_right or (tag in siblings and tag not in _REPEATED):
        return
    source, start = find_place(node)
    outer = find_place(parent)[1]
    end = markup.element_end(source.text, outer)
    indent = markup.indentation(source.text, outer)
    newline = "\r\n" if "\r\n" in source.text else "\n"
    last = markup.element_end(source.text, start)
    block = source.text[start:last]
    # Without the end of the line, which may be of what is inserted to close the parent.
    removed = source.edit(start - len(markup.indentation(source.text, start)), last, "")
    moved = source.edit(end, end, f"{newline}{indent}{markup.indented(block, indent, newline)}")
    reaction = f"<{tag}> is inside of <{parent.tag}>, where nothing reads it"
    assumption = f"<{tag}> is read beside <{parent.tag}>"
    yield Slip((removed, moved), reaction, assumption, source.at(start))


def _without_geometry(node: XacroNode, parent: XacroNode) -> Slips:
    """Yield the shape that is directly in <visual> or <collision>."""
    if any(child.tag == "geometry" for child in parent.elements):
        return
    if sum(child.tag in CHILDREN["geometry"] for child in parent.elements) != 1:
        return
    source, start = find_place(node)
    end = markup.element_end(source.text, start)
    text = source.text[start:end]
    edit = source.edit(start, end, f"<geometry>{text}</geometry>")
    reaction = f"<{parent.tag}> has <{node.tag}> without <geometry>"
    assumption = f"<{node.tag}> is read inside of <geometry>"
    yield make_slip((edit,), reaction, assumption)


def _ends_in_one_tag(joint: XacroNode) -> Slips:
    """Yield the joint whose parent and child are attributes of one tag."""
    present = {child.tag for child in joint.elements}
    for node in joint.elements:
        given = node.attributes
        names = ("", "")
        if node.tag == "parent" and {*given} == {"link", "child"}:
            names = ("link", "child")
        elif node.tag == "child" and {*given} == {"link", "parent"}:
            names = ("parent", "link")
        elif node.tag not in TAGS and {*given} == {"parent", "child"}:
            names = ("parent", "child")
        if not names[0] or node.elements or present & ({"parent", "child"} - {node.tag}):
            continue
        source, start = find_place(node)
        end = markup.element_end(source.text, start)
        parent, child = (given[name] for name in names)
        new = "".join(
            [empty_element("parent", {"link": parent}), empty_element("child", {"link": child})]
        )
        reaction = f"<{node.tag}> has the parent and the child of a joint"
        assumption = f"the parent is read as {quoted(parent)} and the child as {quoted(child)}"
        yield make_slip((source.edit(start, end, new),), reaction, assumption)
    if {"parent", "child"} <= joint.attributes.keys() and not present & {"parent", "child"}:
        yield from _ends_as_attributes(joint)


def _ends_as_attributes(joint: XacroNode) -> Slips:
    """Yield the joint whose parent and child are its attributes."""
    source, start = find_place(joint)
    end, is_empty = markup.head_end(source.text, start)
    kept = {
        name: text for name, text in joint.attributes.items() if name not in ("parent", "child")
    }
    ends = [empty_element(name, {"link": joint.attributes[name]}) for name in ("parent", "child")]
    head = f"<joint{attributes_text(kept)}>{''.join(ends)}"
    if is_empty:
        head += "</joint>"
    reaction = "<joint> has its parent and its child as attributes"
    assumption = "the attributes parent and child of <joint> are read as elements"
    yield make_slip((source.edit(start, end, head),), reaction, assumption)
