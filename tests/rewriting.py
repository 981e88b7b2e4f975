"""Random ways to write the same robot: other frames, other order, other numbers, other text, same behaviour.

Every step changes the file but nothing that the lab's criteria measure. A step changes only the elements that it can use,
so that a robot with a mistake in it can be rewritten, too.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from itertools import permutations, product
from math import atan2, cos, hypot, pi, sin
from random import Random
from typing import Any

import numpy as np
from hypothesis import strategies as st
from lxml import etree

Element = etree._Element
Matrix = np.ndarray[Any, np.dtype[np.floating[Any]]]
Step = Callable[[st.DrawFn, Element], None]

_VECTORS = frozenset({"xyz", "rpy", "size", "rgba"})
_SCALARS = frozenset(
    {
        "radius",
        "length",
        "value",
        "ixx",
        "ixy",
        "ixz",
        "iyy",
        "iyz",
        "izz",
        "effort",
        "velocity",
        "damping",
        "k_velocity",
    }
)
_COMMENTS = ("<!---->", "<!-- a robot -->", '<!-- <link name="ghost"/> -->', "<!--\n  0.6 / 4\n  -->", "<!-- $ & % -->")
_DECLARATIONS = (
    "",
    '<?xml version="1.0"?>',
    "<?xml version='1.0' encoding='UTF-8'?>\n",
    '\n\n  <?xml version="1.0" ?>\n',
    '\ufeff<?xml version="1.0"?>',
    '<?xml version="1.0"?>\n<?xml version="1.0"?>\n',
    "<!-- first a comment -->",
)
_FLIP = np.diag([1.0, -1.0, -1.0, 1.0])


def parse(data: bytes) -> Element:
    """Return the element tree of a URDF, without comments and blank space."""
    return etree.fromstring(data, etree.XMLParser(remove_comments=True, remove_blank_text=True))


def matrix(xyz: Iterable[float], rpy: Iterable[float]) -> Matrix:
    """Return the 4 x 4 matrix of an origin: Rz(yaw) Ry(pitch) Rx(roll), written out as a product."""
    roll, pitch, yaw = rpy
    about_x = np.array([[1, 0, 0], [0, cos(roll), -sin(roll)], [0, sin(roll), cos(roll)]])
    about_y = np.array([[cos(pitch), 0, sin(pitch)], [0, 1, 0], [-sin(pitch), 0, cos(pitch)]])
    about_z = np.array([[cos(yaw), -sin(yaw), 0], [sin(yaw), cos(yaw), 0], [0, 0, 1]])
    result: Matrix = np.eye(4)
    result[:3, :3] = about_z @ about_y @ about_x
    result[:3, 3] = list(xyz)
    return result


def angles(rotation: Matrix) -> tuple[float, float, float]:
    """Return roll, pitch and yaw of a rotation; the roll is 0 if the pitch is a quarter turn."""
    level = hypot(rotation[0, 0], rotation[1, 0])
    pitch = atan2(-rotation[2, 0], level)
    if level < 1e-7:
        return 0.0, pitch, atan2(-rotation[0, 1], rotation[1, 1])
    return atan2(rotation[2, 1], rotation[2, 2]), pitch, atan2(rotation[1, 0], rotation[0, 0])


def written(values: Iterable[float]) -> str:
    """Return numbers as an attribute contains them."""
    return " ".join(f"{value:.13g}" for value in values)


def numbers_of(element: Element | None, attribute: str, default: str = "0 0 0") -> list[float]:
    """Return the numbers of an attribute."""
    text = default if element is None else element.get(attribute, default)
    return [float(piece) for piece in text.split()]


def pose(owner: Element) -> Matrix:
    """Return the pose in the `<origin>` of a joint or a visual."""
    origin = owner.find("origin")
    return matrix(numbers_of(origin, "xyz"), numbers_of(origin, "rpy"))


def put(owner: Element, transform: Matrix) -> None:
    """Write a pose into the `<origin>` of a joint or a visual."""
    origin = owner.find("origin")
    if origin is None:
        origin = etree.SubElement(owner, "origin")
    origin.set("xyz", written(transform[:3, 3]))
    origin.set("rpy", written(angles(transform)))


def link_named(tree: Element, name: str) -> Element | None:
    """Return the link of this name."""
    return next((link for link in tree.iterchildren("link") if link.get("name") == name), None)


def end(joint: Element, role: str) -> Element:
    """Return the `<parent>` or `<child>` of a joint."""
    found = joint.find(role)
    assert found is not None
    return found


def parent_joint(tree: Element, link: str) -> Element | None:
    """Return the joint whose child is this link."""
    return next((joint for joint in tree.iterchildren("joint") if end(joint, "child").get("link") == link), None)


def move_frame(tree: Element, link: Element, change: Matrix) -> None:
    """Move a link's frame by `change`, given in the frame, and everything in the link back: nothing else moves."""
    name = link.get("name", "")
    held = parent_joint(tree, name)
    assert held is not None
    back = np.linalg.inv(change)
    put(held, pose(held) @ change)
    axis = held.find("axis")
    if axis is not None:
        axis.set("xyz", written(back[:3, :3] @ numbers_of(axis, "xyz")))
    for element in link:
        put(element, back @ pose(element))
    for joint in tree.iterchildren("joint"):
        if end(joint, "parent").get("link") == name:
            put(joint, back @ pose(joint))


def fresh(tree: Element, kind: str) -> str:
    """Return a name that nothing in the robot has."""
    return f"extra_{kind}_{len(tree)}"


def add_joint(tree: Element, name: str, parent: str, child: str, transform: Matrix) -> Element:
    """Add a fixed joint."""
    joint = etree.SubElement(tree, "joint", {"name": name, "type": "fixed"})
    etree.SubElement(joint, "parent", {"link": parent})
    etree.SubElement(joint, "child", {"link": child})
    put(joint, transform)
    return joint


# --- What may be drawn ------------------------------------------------------------------------------------------------

_lengths = st.floats(-1, 1).map(lambda value: round(value, 6))
_turns = st.sampled_from((0.0, pi / 2, -pi / 2, pi, 1.57, 0.3)) | st.floats(-3.1, 3.1).map(
    lambda value: round(value, 6)
)
_rotations = st.builds(matrix, st.just((0.0, 0.0, 0.0)), st.tuples(_turns, _turns, _turns))
_poses = st.builds(matrix, st.tuples(_lengths, _lengths, _lengths), st.tuples(_turns, _turns, _turns))
_about_z = st.builds(lambda turn: matrix((0, 0, 0), (0, 0, turn)), _turns)
_along_z = st.builds(lambda slide, turn: matrix((0, 0, slide), (0, 0, turn)), _lengths, _turns)
_QUARTERS = tuple(
    np.block([[signed, np.zeros((3, 1))], [np.zeros((1, 3)), np.eye(1)]])
    for order in permutations(range(3))
    for signs in product((1.0, -1.0), repeat=3)
    if np.linalg.det(signed := np.eye(3)[list(order)] * signs) > 0
)


def _one_of(draw: st.DrawFn, elements: Iterable[Element]) -> Element | None:
    found = list(elements)
    return draw(st.sampled_from(found)) if found else None


# --- Steps that move frames and pictures ------------------------------------------------------------------------------


def split_joint(draw: st.DrawFn, tree: Element) -> None:
    """Put an empty link into the middle of a joint, before it if it moves. The name stays in the chain."""
    joint = _one_of(draw, tree.iterchildren("joint"))
    assert joint is not None
    middle = fresh(tree, "link")
    etree.SubElement(tree, "link", {"name": middle})
    whole, first = pose(joint), draw(_poses)
    second = np.linalg.inv(first) @ whole
    parent, child = end(joint, "parent"), end(joint, "child")
    if joint.get("type") == "fixed" and draw(st.booleans()):
        add_joint(tree, fresh(tree, "joint"), middle, child.get("link", ""), second)
        put(joint, first)
        child.set("link", middle)
    else:
        add_joint(tree, fresh(tree, "joint"), parent.get("link", ""), middle, first)
        put(joint, second)
        parent.set("link", middle)


def add_hub(draw: st.DrawFn, tree: Element) -> None:
    """Let a wheel's joint turn a hub to which the wheel is fixed, somewhere along the joint's axis."""
    joint = _one_of(draw, (joint for joint in tree.iterchildren("joint") if joint.get("type") == "continuous"))
    if joint is None or not _turns_about_z(joint):
        return
    hub, child, shift = fresh(tree, "link"), end(joint, "child"), draw(_along_z)
    etree.SubElement(tree, "link", {"name": hub})
    put(joint, pose(joint) @ shift)
    add_joint(tree, fresh(tree, "joint"), hub, child.get("link", ""), np.linalg.inv(shift))
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


def turn_lidar_frame(draw: st.DrawFn, tree: Element) -> None:
    """Turn the lidar's frame in place; the visual stays."""
    link = link_named(tree, "lidar")
    if link is not None and parent_joint(tree, "lidar") is not None:
        move_frame(tree, link, draw(_rotations))


def turn_visual(draw: st.DrawFn, tree: Element) -> None:
    """Turn a shape within its own symmetry, a box onto any of its sides: it looks the same."""
    visual = _one_of(draw, tree.iterfind("link/visual"))
    assert visual is not None
    shape = visual.find("geometry/*")
    assert shape is not None
    match shape.tag:
        case "box":
            turn = draw(st.sampled_from(_QUARTERS))
            shape.set("size", written(np.abs(turn[:3, :3].T) @ numbers_of(shape, "size")))
        case "cylinder":
            turn = draw(_about_z) @ draw(st.sampled_from((np.eye(4), _FLIP)))
        case _:
            turn = draw(_rotations)
    put(visual, pose(visual) @ turn)


def _turns_about_z(joint: Element) -> bool:
    x, y, z = numbers_of(joint.find("axis"), "xyz", "1 0 0")
    return joint.get("type") == "fixed" or (hypot(x, y) < 1e-9 * abs(z))


# --- Steps that say the same in other values --------------------------------------------------------------------------


def other_angles(draw: st.DrawFn, tree: Element) -> None:
    """Write a rotation with additional full turns, or by its other three angles."""
    origin = _one_of(draw, tree.iter("origin"))
    assert origin is not None
    roll, pitch, yaw = numbers_of(origin, "rpy")
    if draw(st.booleans()):
        roll, pitch, yaw = roll + pi, pi - pitch, yaw + pi
    turns = draw(st.tuples(*[st.integers(-3, 3)] * 3))
    origin.set("rpy", written(angle + 2 * pi * turn for angle, turn in zip((roll, pitch, yaw), turns, strict=True)))


def scale_axis(draw: st.DrawFn, tree: Element) -> None:
    """Scale an axis."""
    axis = _one_of(draw, tree.iter("axis"))
    assert axis is not None
    factor = 10 ** draw(st.floats(-3, 3))
    axis.set("xyz", written(factor * number for number in numbers_of(axis, "xyz")))


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
        if all(numbers_of(shape, str(name)))
    ]
    count = draw(st.integers(1, 3))
    off = st.floats(-0.001 / count, 0.001 / count)
    for _ in range(count):
        element, name = draw(st.sampled_from(locations + sizes))
        element.set(name, written(value + draw(off) for value in numbers_of(element, name)))


def shade(draw: st.DrawFn, tree: Element) -> None:
    """Change colours by at most 0.005 per channel; white may be any light grey, and grey may be transparent."""
    if tree.get("shaded"):
        return
    tree.set("shaded", "true")
    for colour in tree.iter("color"):
        material = colour.getparent()
        assert material is not None
        *channels, alpha = numbers_of(colour, "rgba")
        if alpha == 0:
            continue
        if material.get("name") == "white" and min(channels) == max(channels) >= 0.75:
            channels = [draw(st.floats(0.755, 0.995))] * 3
        if material.get("name") == "gray":
            alpha = draw(st.floats(0.1, 1))
        changed = [value + draw(st.floats(-0.005, 0.005)) for value in (*channels, alpha)]
        colour.set("rgba", written(min(1.0, max(0.0, value)) for value in changed))


# --- Steps that add what changes nothing ------------------------------------------------------------------------------


def add_link(draw: st.DrawFn, tree: Element) -> None:
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
    shapes = (("box", {"size": "0 0 0"}), ("sphere", {"radius": "0"}), ("cylinder", {"radius": "0", "length": "1"}))
    tag, sizes = draw(st.sampled_from(shapes))
    footprint = link_named(tree, "base_footprint")
    link = footprint if draw(st.booleans()) else _one_of(draw, tree.iterchildren("link"))
    if link is None:
        return
    if link is footprint and draw(st.booleans()):
        visual = _add_shape(link, "visual", "box", {"size": "1 1 1"})
        material = etree.SubElement(visual, "material", {"name": fresh(tree, f"material_{len(link)}")})
        etree.SubElement(material, "color", {"rgba": "1 0 0 0"})
    else:
        _add_shape(link, "visual", tag, sizes)


def add_physics(draw: st.DrawFn, tree: Element) -> None:
    """Give a link a collision shape or an inertia, or a joint damping and effort limits."""
    link, joint = _one_of(draw, tree.iterchildren("link")), _one_of(draw, tree.iterchildren("joint"))
    assert link is not None
    assert joint is not None
    match draw(st.sampled_from(("collision", "inertial", "dynamics", "limit"))):
        case "collision":
            put(_add_shape(link, "collision", "box", {"size": "2 2 2"}), draw(_poses))
        case "inertial" if link.find("inertial") is None:
            inertial = etree.SubElement(link, "inertial")
            etree.SubElement(inertial, "mass", {"value": "1.5"})
            moments = {"ixx": "1", "ixy": "0", "ixz": "0", "iyy": "1", "iyz": "0", "izz": "1"}
            etree.SubElement(inertial, "inertia", moments)
        case "dynamics" if joint.find("dynamics") is None:
            etree.SubElement(joint, "dynamics", {"damping": "0.1"})
        case "limit" if joint.find("limit") is None and joint.get("type") in ("fixed", "continuous"):
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


def shuffle(draw: st.DrawFn, tree: Element) -> None:
    """Shuffle the elements inside each element."""
    for owner in [tree, *tree.iter("link", "joint", "visual", "inertial")]:
        children = list(owner)
        order = (
            draw(st.permutations(children))
            if owner is tree
            else Random(draw(st.integers(0, 99))).sample(children, len(children))
        )
        for child in children:
            owner.remove(child)
        owner.extend(order)


def materials_into_links(draw: st.DrawFn, tree: Element) -> None:
    """Define a material inside the first visual that uses it."""
    material = _one_of(draw, tree.iterchildren("material"))
    if material is None:
        return
    user = next(
        (other for other in tree.iterfind("link/visual/material") if other.get("name") == material.get("name")), None
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
    turn_lidar_frame,
    turn_visual,
    other_angles,
    scale_axis,
    nudge,
    shade,
    add_link,
    add_invisible,
    add_physics,
    add_unknown_elements,
)
LAST: tuple[Step, ...] = (shuffle, materials_into_links, materials_into_links, rename_materials, repeat_origin)


# --- Text -------------------------------------------------------------------------------------------------------------


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
        attributes = [(name, value) for name, value in element.attrib.items() if name not in ("nudged", "shaded")]
        if self.orders:
            self.random.shuffle(attributes)
        inside = [self.attribute(str(name), str(value)) for name, value in attributes]
        space = [pick(loose) for _ in inside]
        opening = f"<{element.tag}{''.join(map(''.join, zip(space, inside, strict=True)))}"
        children = [self.text(child) for child in element]
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
        if self.numbers and name in _VECTORS:
            pieces = [self.number(piece) for piece in value.split(" ")]
            value = "".join(f"{' ' * self.random.randint(1, 3)}{piece}" for piece in pieces)
            value += " " * self.random.randint(0, 2)
        elif self.numbers and name in _SCALARS:
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
    style = draw(_styles)
    text = f"{draw(st.sampled_from(_DECLARATIONS))}{style.blank_space()}{style.text(robot)}{style.blank_space()}"
    if draw(st.booleans()):
        text = text.replace("\n", "\r\n")
    return text.encode()


def rewritings(tree: Element) -> st.SearchStrategy[bytes]:
    """Draw other texts for the robot in the tree, after up to twelve random steps, and some of those that come last."""
    first = st.lists(st.sampled_from(BEHAVING), max_size=12)
    last = st.sets(st.integers(0, len(LAST) - 1)).map(lambda chosen: [LAST[index] for index in sorted(chosen)])
    return st.builds(lambda one, other: one + other, first, last).flatmap(lambda steps: rewritten(tree, steps))
