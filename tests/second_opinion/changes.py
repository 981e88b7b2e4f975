"""Changes of a URDF: values near a tolerance, mistakes of students, and rewritings that change nothing."""

import copy
from collections.abc import Callable, Sequence
from math import pi
from random import Random
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

from tests.second_opinion.elements import rotation

_SHAPES = (
    '<box size="0.2 0.2 0.05"/>',
    '<cylinder radius="0.1" length="0.05"/>',
    '<sphere radius="0.05"/>',
    '<box size="0 0 0"/>',
)
_TYPES = ("fixed", "continuous", "revolute", "prismatic", "floating", "planar")
# How far the criteria allow a number to be off, by the attribute that has it.
_TOLERANCES = {
    "xyz": 0.002,
    "rpy": pi / 180,
    "size": 0.002,
    "radius": 0.002,
    "length": 0.002,
    "rgba": 0.01,
    "value": 0.01,
    "lower": pi / 180,
    "upper": pi / 180,
    "effort": 1e-6,
    "velocity": 1e-6,
}


def _some(random: Random, elements: list[ET.Element]) -> ET.Element:
    return random.choice(elements) if elements else ET.Element("none")


def _attribute(random: Random, robot: ET.Element, names: Sequence[str]) -> tuple[ET.Element, str]:
    found = [
        (element, name) for element in robot.iter() for name in element.attrib if name in names
    ]
    return random.choice(found) if found else (ET.Element("none", {"xyz": "0 0 0"}), "xyz")


def _text(value: float) -> str:
    return repr(round(float(value), 12)) if abs(value) < 1e6 else repr(float(value))


def _change_number(random: Random, robot: ET.Element) -> None:
    """Change a number by about the tolerance, by exactly that, or grossly."""
    element, name = _attribute(random, robot, [*_TOLERANCES, "ixx", "iyy", "izz", "ixy"])
    values = [float(piece) for piece in element.get(name, "").split()]
    if not values:
        return
    place = random.randrange(len(values))
    tolerance = _TOLERANCES.get(name, abs(values[place]) * 0.03)
    step = tolerance * random.choice(
        (1, 1, 1 - 1e-3, 1 + 1e-3, 0.5, 2, 10, random.uniform(0, 3), random.uniform(0, 100))
    )
    value = values[place]
    values[place] = random.choice(
        (
            value + step,
            value - step,
            value + step,
            value - step,
            -value,
            0.0,
            value * 10,
            value / 2,
            value * 1000,
            value * pi / 180,
        )
    )
    if name == "rgba" and random.random() < 0.9:
        values[place] = min(max(values[place], 0.0), 1.0)
    element.set(name, " ".join(map(_text, values)))


def _change_all(random: Random, robot: ET.Element) -> None:
    """Give an element other units, swap its numbers, or omit one."""
    element, name = _attribute(random, robot, ("xyz", "rpy", "size"))
    values = element.get(name, "").split()
    match random.randrange(4):
        case 0:
            values = [_text(float(value) * random.choice((1000, 100, 0.001))) for value in values]
        case 1:
            random.shuffle(values)
        case 2:
            values = [_text(-float(value)) for value in values]
        case _:
            values = (
                values[:-1]
                if random.random() < 0.3
                else [f"+{value}" if value[0] not in "+-" else f" {value} " for value in values]
            )
    element.set(name, " ".join(values))


def _rotate(random: Random, robot: ET.Element) -> None:
    """Rotate an origin by a quarter, a half or a little."""
    origin = _some(random, robot.findall(".//origin"))
    values = [float(value) for value in origin.get("rpy", "0 0 0").split(" ") if value]
    if len(values) == 3:
        values[random.randrange(3)] += random.choice(
            (pi / 2, -pi / 2, pi, 1.57, random.uniform(-0.05, 0.05), random.uniform(-3, 3))
        )
        origin.set("rpy", " ".join(map(_text, values)))


def _remove_attribute(random: Random, robot: ET.Element) -> None:
    element, name = _attribute(
        random, robot, ("xyz", "rpy", "rgba", "effort", "lower", "size", "radius", "ixx")
    )
    element.attrib.pop(name, None)


def _remove_element(random: Random, robot: ET.Element) -> None:
    parents = [
        (parent, child)
        for parent in robot.iter()
        for child in parent
        if child.tag not in ("parent", "child")
    ]
    parent, child = random.choice(parents)
    parent.remove(child)


def _reparent(random: Random, robot: ET.Element) -> None:
    links, joint = (
        [link.get("name", "") for link in robot.findall("link")],
        _some(random, robot.findall("joint")),
    )
    end = joint.find("parent")
    if end is not None and links:
        end.set("link", random.choice(links))


def _misspell(random: Random, robot: ET.Element) -> None:
    element, name = _attribute(random, robot, ("link", "name"))
    element.set(name, element.get(name, "") + random.choice(("x", "_link", "")))


def _swap_ends(random: Random, robot: ET.Element) -> None:
    joint = _some(random, robot.findall("joint"))
    parent, child = joint.find("parent"), joint.find("child")
    if parent is not None and child is not None:
        parent.attrib, child.attrib = child.attrib, parent.attrib


def _retype(random: Random, robot: ET.Element) -> None:
    joint = _some(random, robot.findall("joint"))
    joint.set("type", random.choice(_TYPES))
    if random.random() < 0.8 and joint.find("limit") is None:
        ET.SubElement(joint, "limit", {"lower": "-1", "upper": "1", "effort": "1", "velocity": "1"})


def _axis(random: Random, robot: ET.Element) -> None:
    axis = _some(random, robot.findall(".//axis"))
    some = " ".join(_text(random.uniform(-1, 1)) for _ in range(3))
    axis.set(
        "xyz",
        random.choice(
            (
                "1 0 0",
                "0 1 0",
                "0 0 1",
                "0 0 -1",
                "0 -1 0",
                "0 0 2.5",
                "0 0.0174 1",
                "0 0.018 1",
                "0 0 0",
                some,
            )
        ),
    )


def _reshape(random: Random, robot: ET.Element) -> None:
    geometry = _some(random, robot.findall(".//geometry"))
    geometry[:] = [ET.fromstring(random.choice(_SHAPES))]


def _another_shape(random: Random, robot: ET.Element) -> None:
    """Add a shape to a link, often a smaller one, sometimes twice the same."""
    link = _some(random, robot.findall("link"))
    tag = random.choice(("visual", "visual", "collision"))
    shape = random.choice(_SHAPES)
    numbers = " ".join(_text(random.choice((0.0, random.uniform(-0.2, 0.2)))) for _ in range(3))
    material = random.choice(
        (
            "",
            '<material name="gray"/>',
            '<material name="m"><color rgba="0.5 0 0 0"/></material>',
            '<material name="none"/>',
        )
    )
    new = ET.fromstring(
        f'<{tag}><origin xyz="{numbers}"/><geometry>{shape}</geometry>{material if tag == "visual" else ""}</{tag}>'
    )
    same = link.find(tag)
    link.insert(
        random.randrange(len(link) + 1),
        copy.deepcopy(same) if same is not None and random.random() < 0.3 else new,
    )


def _joint_between(random: Random, robot: ET.Element) -> None:
    """Split a joint in two with a link between them, where the robot stays the same unless a number is added."""
    joint = _some(random, robot.findall("joint"))
    parent = joint.find("parent")
    if parent is None or robot.find("link[@name='between']") is not None:
        return
    first = ET.SubElement(
        robot,
        "joint",
        {"name": "first_half", "type": random.choice(("fixed", "fixed", "fixed", "continuous"))},
    )
    ET.SubElement(first, "parent", {"link": parent.get("link", "")})
    ET.SubElement(first, "child", {"link": "between"})
    origin = joint.find("origin")
    if origin is not None:
        first.append(copy.deepcopy(origin))
        joint.remove(origin)
    if random.random() < 0.2:
        joint.append(ET.Element("origin", {"xyz": f"{random.choice((0.002, 0.0021, 0.01))} 0 0"}))
    parent.set("link", "between")
    ET.SubElement(robot, "link", {"name": "between"})


def _turn_frame(random: Random, robot: ET.Element) -> None:
    """Turn the frame of a link, and undo it in what is placed in that frame: only the frame itself is another."""
    joint = _some(random, robot.findall("joint"))
    child = joint.find("child")
    name = child.get("link") if child is not None else None
    angles = [random.choice((0, pi / 2, pi, random.uniform(-3, 3))) for _ in range(3)]
    turned = rotation(*angles)
    try:
        _place(joint, np.eye(3), turned)
        for element in robot.findall(f"link[@name='{name}']/*"):
            _place(element, turned.T, np.eye(3))
        for other in robot.findall("joint"):
            if (end := other.find("parent")) is not None and end.get("link") == name:
                _place(other, turned.T, np.eye(3))
        if (axis := joint.find("axis")) is not None:
            axis.set(
                "xyz",
                " ".join(
                    map(_text, turned.T @ [float(value) for value in axis.get("xyz", "").split()])
                ),
            )
    except (TypeError, ValueError):
        return  # an earlier change left no three numbers


def _place(element: ET.Element, before: np.ndarray[Any, Any], after: np.ndarray[Any, Any]) -> None:
    """Turn what an origin places: the frame around it before, or what is in it after."""
    origin = element.find("origin")
    if origin is None:
        origin = ET.SubElement(element, "origin")
    xyz, rpy = (
        [float(value) for value in origin.get(name, "0 0 0").split()] for name in ("xyz", "rpy")
    )
    turned = before @ rotation(*rpy) @ after
    origin.set("xyz", " ".join(map(_text, before @ np.array(xyz))))
    pitch = np.arctan2(-turned[2, 0], np.hypot(turned[0, 0], turned[1, 0]))
    if np.hypot(turned[0, 0], turned[1, 0]) < 1e-9:
        angles = (0.0, pitch, np.arctan2(-turned[0, 1], turned[1, 1]))
    else:
        angles = (
            np.arctan2(turned[2, 1], turned[2, 2]),
            pitch,
            np.arctan2(turned[1, 0], turned[0, 0]),
        )
    origin.set("rpy", " ".join(repr(float(angle)) for angle in angles))


def _mirror(random: Random, robot: ET.Element) -> None:
    """Mirror a joint left to right, as students copy a wheel."""
    origin = _some(random, robot.findall("joint/origin"))
    for name, place in (("xyz", 1), ("rpy", 0)):
        values = origin.get(name, "0 0 0").split()
        if len(values) == 3 and random.random() < 0.7:
            values[place] = _text(-float(values[place]))
            origin.set(name, " ".join(values))


def _swap_links(random: Random, robot: ET.Element) -> None:
    links = robot.findall("link")
    if len(links) > 1:
        one, other = random.sample(links, 2)
        one[:], other[:] = list(other), list(one)


def _material(random: Random, robot: ET.Element) -> None:
    visual = _some(random, robot.findall(".//visual"))
    for material in visual.findall("material"):
        visual.remove(material)
    rgba = random.choice(
        (
            "0 0.6 0 1",
            "0.7 0.7 0.7 1",
            "1 1 1 1",
            "0.75 0.75 0.75 1",
            "0.9 0.9 0.9",
            "0 0 2 1",
            "0.7 0.71 0.7 0",
        )
    )
    inner = random.choice((f'<color rgba="{rgba}"/>', f'<color rgba="{rgba}"/>', ""))
    visual.append(
        ET.fromstring(
            f'<material name="{random.choice(("own", "gray", "", "green"))}">{inner}</material>'
        )
    )


def _shuffle(random: Random, robot: ET.Element) -> None:
    children = list(robot)
    random.shuffle(children)
    robot[:] = children


def _mimic(random: Random, robot: ET.Element) -> None:
    joints = robot.findall("joint")
    if len(joints) > 1:
        one, other = random.sample(joints, 2)
        ET.SubElement(one, "mimic", {"joint": other.get("name", "")})


_Change = Callable[[Random, ET.Element], None]
CHANGES: tuple[_Change, ...] = (
    *[_change_number] * 12,
    *[_turn_frame] * 3,
    *[_rotate] * 3,
    *[_change_all] * 2,
    _remove_attribute,
    _remove_element,
    _reparent,
    _misspell,
    _swap_ends,
    _retype,
    _axis,
    _reshape,
    *[_another_shape] * 2,
    *[_joint_between] * 2,
    *[_mirror] * 2,
    _swap_links,
    _material,
    _shuffle,
    _mimic,
)
