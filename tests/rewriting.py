"""Random ways to write the same robot: other frames, other order, other numbers, other text, same behaviour.

Every step changes the file but nothing that the lab's criteria measure. A step changes only the elements that it can use,
so that a robot with a mistake in it can be rewritten, too.
"""

from collections.abc import Callable, Iterable, Sequence
from itertools import product
from math import hypot, pi
from random import Random

from hypothesis import strategies as st
from lxml import etree

from grader.base.transforms import IDENTITY
from grader.lab.authoring.trees import (
    add_joint,
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
)
from grader.lab.authoring.trees import split_joint as split
from grader.ros.xml.parsing import Element
from tests.writing_style import Style

Step = Callable[[st.DrawFn, Element], None]

_DECLARATIONS = (
    "",
    '<?xml version="1.0"?>',
    "<?xml version='1.0' encoding='UTF-8'?>\n",
    '\n\n  <?xml version="1.0" ?>\n',
    '\ufeff<?xml version="1.0"?>',
    '<?xml version="1.0"?>\n<?xml version="1.0"?>\n',
    "<!-- first a comment -->",
)
_FLIP = origin((0, 0, 0), (pi, 0, 0))


def link_named(tree: Element, name: str) -> Element | None:
    """Return the link of this name."""
    return next((link for link in tree.iterchildren("link") if link.get("name") == name), None)


def parse(data: bytes) -> Element:
    """Return the element tree of a URDF, without comments and blank space."""
    return etree.fromstring(data, etree.XMLParser(remove_comments=True, remove_blank_text=True))


# --- What may be drawn ------------------------------------------------------------------------------------------------

_lengths = st.floats(-1, 1).map(lambda value: round(value, 6))
_turns = st.sampled_from((0.0, pi / 2, -pi / 2, pi, 1.57, 0.3)) | st.floats(-3.1, 3.1).map(
    lambda value: round(value, 6)
)
_rotations = st.builds(origin, st.just((0.0, 0.0, 0.0)), st.tuples(_turns, _turns, _turns))
_poses = st.builds(
    origin, st.tuples(_lengths, _lengths, _lengths), st.tuples(_turns, _turns, _turns)
)
_about_z = st.builds(lambda turn: origin((0, 0, 0), (0, 0, turn)), _turns)
_along_z = st.builds(lambda slide, turn: origin((0, 0, slide), (0, 0, turn)), _lengths, _turns)
_QUARTERS = tuple(
    origin((0, 0, 0), (pi / 2 * turn for turn in turns)) for turns in product(range(4), repeat=3)
)


def _one_of(draw: st.DrawFn, elements: Iterable[Element]) -> Element | None:
    found = list(elements)
    return draw(st.sampled_from(found)) if found else None


# --- Steps that move frames and pictures ------------------------------------------------------------------------------


def split_joint(draw: st.DrawFn, tree: Element) -> None:
    """Put an empty link into the middle of a joint, before it if it moves. The name stays in the chain."""
    joint = _one_of(draw, tree.iterchildren("joint"))
    assert joint is not None
    is_first = joint.get("type") == "fixed" and draw(st.booleans())
    split(tree, joint, draw(_poses), is_first=is_first)


def add_hub(draw: st.DrawFn, tree: Element) -> None:
    """Let a wheel's joint turn a hub to which the wheel is fixed, somewhere along the joint's axis."""
    joint = _one_of(
        draw, (joint for joint in tree.iterchildren("joint") if joint.get("type") == "continuous")
    )
    if joint is None or not _turns_about_z(joint):
        return
    hub, child, shift = fresh(tree, "link"), end(joint, "child"), draw(_along_z)
    etree.SubElement(tree, "link", {"name": hub})
    set_pose(joint, pose(joint) @ shift)
    add_joint(tree, fresh(tree, "joint"), hub, child.get("link", ""), shift.inverse())
    child.set("link", hub)


def move_wheel_frame(draw: st.DrawFn, tree: Element) -> None:
    """Slide a wheel's frame along its z axis and turn it about it; the visual stays."""
    link = link_named(tree, draw(st.sampled_from(("left_wheel", "right_wheel"))))
    joint = parent_joint(tree, link.get("name", "")) if link is not None else None
    if link is not None and joint is not None:
        move_frame(tree, link, draw(_along_z if _turns_about_z(joint) else _about_z))


def move_caster_frame(draw: st.DrawFn, tree: Element) -> None:
    """Put the caster's frame anywhere; the visual stays."""
    link = link_named(tree, "caster_wheel")
    if link is not None and parent_joint(tree, "caster_wheel") is not None:
        move_frame(tree, link, draw(_poses))


def turn_visual(draw: st.DrawFn, tree: Element) -> None:
    """Turn a shape within its own symmetry, a box onto any of its sides: it looks the same."""
    visual = _one_of(draw, tree.iterfind("link/visual"))
    assert visual is not None
    shape = visual.find("geometry/*")
    assert shape is not None
    match shape.tag:
        case "box":
            turn = draw(st.sampled_from(_QUARTERS))
            length, width, height = attribute_numbers(shape, "size")
            shape.set("size", attribute_text(map(abs, turn.unrotate((length, width, height)))))
        case "cylinder":
            turn = draw(_about_z) @ draw(st.sampled_from((IDENTITY, _FLIP)))
        case _:
            turn = draw(_rotations)
    set_pose(visual, pose(visual) @ turn)


def _turns_about_z(joint: Element) -> bool:
    x, y, z = attribute_numbers(joint.find("axis"), "xyz", "1 0 0")
    return joint.get("type") == "fixed" or (hypot(x, y) < 1e-9 * abs(z))


# --- Steps that say the same in other values --------------------------------------------------------------------------


def other_angles(draw: st.DrawFn, tree: Element) -> None:
    """Write rotations with additional full turns, or by their other three angles."""
    for found in _some(draw, own_elements(tree, "origin")):
        roll, pitch, yaw = attribute_numbers(found, "rpy")
        if draw(st.booleans()):
            roll, pitch, yaw = roll + pi, pi - pitch, yaw + pi
        found.set(
            "rpy",
            attribute_text(
                angle + 2 * pi * draw(st.integers(-3, 3)) for angle in (roll, pitch, yaw)
            ),
        )


def scale_axis(draw: st.DrawFn, tree: Element) -> None:
    """Scale axes of joints."""
    for axis in _some(draw, own_elements(tree, "axis")):
        factor = 10 ** draw(st.floats(-2, 2))
        axis.set(
            "xyz", attribute_text(factor * number for number in attribute_numbers(axis, "xyz"))
        )


def shuffle(draw: st.DrawFn, tree: Element) -> None:
    """Change the order of elements: links, joints and materials, and those inside of each."""
    random = Random(draw(st.integers(0, 2**32 - 1)))
    materials = [found.get("name") for found in own_elements(tree, "material")]
    is_shared = any(materials.count(name) > 1 for name in materials if not _is_defined(tree, name))
    free = ("joint", "material", "collision") + (() if is_shared else ("link", "visual"))
    for owner in [tree, *own_elements(tree, "link", "joint", "visual", "collision", "inertial")]:
        ranks = {
            child.tag: random.random() for child in owner
        }  # of several origins the first counts
        order = {
            child: random.random() if child.tag in free else ranks[child.tag] for child in owner
        }
        owner[:] = sorted(owner, key=order.__getitem__)


def _is_defined(tree: Element, material: str | None) -> bool:
    return any(found.get("name") == material for found in tree.iterchildren("material"))


def _some(draw: st.DrawFn, elements: Iterable[Element]) -> list[Element]:
    """Draw one to three elements, or none where there are none."""
    found = list(elements)
    return (
        draw(st.lists(st.sampled_from(found), min_size=1, max_size=3, unique=True)) if found else []
    )


def nudge(draw: st.DrawFn, tree: Element) -> None:
    """Move and resize a few things by at most 1 mm in all."""
    if tree.get("nudged"):
        return
    tree.set("nudged", "true")
    locations = [(origin, "xyz") for origin in tree.iter("origin")]
    sizes = [
        (shape, str(name))
        for shape in tree.iter("box", "cylinder", "sphere")
        for name in shape.attrib
        if all(attribute_numbers(shape, str(name)))
    ]
    count = draw(st.integers(1, 3))
    off = st.floats(-0.001 / count, 0.001 / count)
    for _ in range(count):
        element, name = draw(st.sampled_from(locations + sizes))
        element.set(
            name, attribute_text(value + draw(off) for value in attribute_numbers(element, name))
        )


def shade(draw: st.DrawFn, tree: Element) -> None:
    """Change colours by at most 0.005 per channel; white may be any light grey, and grey may be transparent."""
    if tree.get("shaded"):
        return
    tree.set("shaded", "true")
    for colour in tree.iter("color"):
        material = colour.getparent()
        assert material is not None
        *channels, alpha = attribute_numbers(colour, "rgba")
        if alpha < 0.02:  # what is not seen stays unseen
            continue
        if material.get("name") == "white" and min(channels) == max(channels) >= 0.71:
            channels = [draw(st.floats(0.715, 0.995))] * 3
        if material.get("name") == "gray":
            alpha = draw(st.floats(0.1, 1))
        changed = [value + draw(st.floats(-0.005, 0.005)) for value in (*channels, alpha)]
        colour.set("rgba", attribute_text(min(1.0, max(0.0, value)) for value in changed))


# --- Steps that add what changes nothing ------------------------------------------------------------------------------


def attach_link(draw: st.DrawFn, tree: Element) -> None:
    """Attach another link to the robot."""
    parent = _one_of(draw, tree.iterchildren("link"))
    assert parent is not None
    name = fresh(tree, "link")
    link = etree.SubElement(tree, "link", {"name": name})
    if draw(st.booleans()):
        _add_shape(link, "visual", "sphere", {"radius": "0.7"})
    add_joint(tree, fresh(tree, "joint"), parent.get("name", ""), name, draw(_poses))


def add_invisible(draw: st.DrawFn, tree: Element) -> None:
    """Give the footprint, or any other link, a visual without size; or the footprint a transparent one."""
    shapes = (
        ("box", {"size": "0 0 0"}),
        ("sphere", {"radius": "0"}),
        ("cylinder", {"radius": "0", "length": "1"}),
    )
    tag, sizes = draw(st.sampled_from(shapes))
    footprint = link_named(tree, "base_footprint")
    link = footprint if draw(st.booleans()) else _one_of(draw, tree.iterchildren("link"))
    if link is None:
        return
    if link is footprint and draw(st.booleans()):
        visual = _add_shape(link, "visual", "box", {"size": "1 1 1"})
        material = etree.SubElement(
            visual, "material", {"name": fresh(tree, f"material_{len(link)}")}
        )
        etree.SubElement(material, "color", {"rgba": "1 0 0 0"})
    else:
        _add_shape(link, "visual", tag, sizes)


def add_physics(draw: st.DrawFn, tree: Element) -> None:
    """Give a link a collision shape or an inertia, or a joint damping and effort limits."""
    link, joint = (
        _one_of(draw, tree.iterchildren("link")),
        _one_of(draw, tree.iterchildren("joint")),
    )
    assert link is not None
    assert joint is not None
    match draw(st.sampled_from(("collision", "inertial", "dynamics", "limit"))):
        case "collision":
            set_pose(_add_shape(link, "collision", "box", {"size": "2 2 2"}), draw(_poses))
        case "inertial" if link.find("inertial") is None:
            inertial = etree.SubElement(link, "inertial")
            etree.SubElement(inertial, "mass", {"value": "1.5"})
            moments = {"ixx": "1", "ixy": "0", "ixz": "0", "iyy": "1", "iyz": "0", "izz": "1"}
            etree.SubElement(inertial, "inertia", moments)
        case "dynamics" if joint.find("dynamics") is None:
            etree.SubElement(joint, "dynamics", {"damping": "0.1"})
        case "limit" if joint.find("limit") is None and joint.get("type") in (
            "fixed",
            "continuous",
        ):
            etree.SubElement(joint, "limit", {"effort": "10", "velocity": "1"})


def add_unknown_elements(draw: st.DrawFn, tree: Element) -> None:
    """Add tags and attributes that ROS 2 ignores."""
    owner = _one_of(draw, tree.iter("robot", "link", "joint", "visual", "origin"))
    assert owner is not None
    if draw(st.booleans()):
        etree.SubElement(etree.SubElement(owner, "gazebo"), "link", {"name": "base_link"})
    else:
        owner.set("comment", "yes & no")


def _add_shape(link: Element, role: str, tag: str, sizes: dict[str, str]) -> Element:
    shape = etree.SubElement(link, role)
    etree.SubElement(etree.SubElement(shape, "geometry"), tag, sizes)
    return shape


# --- Steps that must come last, in this order -------------------------------------------------------------------------


def materials_into_links(draw: st.DrawFn, tree: Element) -> None:
    """Define a material inside the first visual that uses it."""
    material = _one_of(draw, tree.iterchildren("material"))
    if material is None:
        return
    user = next(
        (
            other
            for other in tree.iterfind("link/visual/material")
            if other.get("name") == material.get("name")
        ),
        None,
    )
    if user is not None and not len(user):
        user.extend(list(material))
        tree.remove(material)


def rename_materials(draw: st.DrawFn, tree: Element) -> None:
    """Rename the materials."""
    suffix = draw(st.sampled_from(("", "_2", " plastic", "é")))
    for material in tree.iter("material"):
        material.set("name", f"{material.get('name', '')}{suffix}")


def repeat_origin(draw: st.DrawFn, tree: Element) -> None:
    """Repeat an origin with other numbers: the first counts."""
    origin = _one_of(draw, tree.iter("origin"))
    if origin is not None:
        origin.addnext(etree.Element("origin", {"xyz": "7 8 9", "rpy": "1 2 3"}))


BEHAVING: tuple[Step, ...] = (
    split_joint,
    add_hub,
    move_wheel_frame,
    move_caster_frame,
    turn_visual,
    other_angles,
    scale_axis,
    nudge,
    shade,
    attach_link,
    add_invisible,
    add_physics,
    add_unknown_elements,
)
LAST: tuple[Step, ...] = (
    shuffle,
    materials_into_links,
    materials_into_links,
    rename_materials,
    repeat_origin,
)


# --- Text -------------------------------------------------------------------------------------------------------------

_styles = st.builds(
    Style,
    random=st.integers(0, 2**32 - 1).map(Random),
    blanks=st.sampled_from((("\n",), ("",), (" ",), ("", " ", "\n", "\t", "\n\n    "))),
    quotes=st.sampled_from(('"', "'", "\"'")),
    numbers=st.booleans(),
    comments=st.booleans(),
    references=st.booleans(),
    orders=st.booleans(),
)


@st.composite
def rewritten(draw: st.DrawFn, tree: Element, steps: Sequence[Step]) -> bytes:
    """Return the text of the robot in the tree after these steps, in a random style."""
    robot = etree.fromstring(etree.tostring(tree))
    for step in steps:
        step(draw, robot)
    for mark in ("nudged", "shaded"):
        robot.attrib.pop(mark, "")
    style = draw(_styles)
    text = f"{draw(st.sampled_from(_DECLARATIONS))}{style.blank_space()}{style.text(robot)}{style.blank_space()}"
    if draw(st.booleans()):
        text = text.replace("\n", "\r\n")
    return text.encode()


def rewritings(tree: Element) -> st.SearchStrategy[bytes]:
    """Draw other texts for the robot in the tree, after up to twelve random steps, and some of those that come last."""
    first = st.lists(st.sampled_from(BEHAVING), max_size=12)
    last = st.sets(st.integers(0, len(LAST) - 1)).map(
        lambda chosen: [LAST[index] for index in sorted(chosen)]
    )
    return st.builds(lambda one, other: one + other, first, last).flatmap(
        lambda steps: rewritten(tree, steps)
    )
