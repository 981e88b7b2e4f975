"""Whether two files are the same robot: up to what cannot be seen of it and what ROS 2 does not read.

What counts: ROS 2's verdict, every pose, shape, colour, mass, axis, limit, mimic and dynamics, the tree, the elements
for simulators and controllers, and every name that something refers to. What does not: numbers written otherwise,
defaults written out, full turns, turns of a shape within its symmetry, shapes without size or drawn twice, the length
of an axis, and axes and limits that ROS 2 does not use for a type of joint.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from math import dist
from typing import Any, NamedTuple

from grader.mutation.elements import FOREIGN
from grader.robot.frames import placed_by
from grader.robot.likeness import turn_between, ways
from grader.robot.model import Collision, Geometry, Joint, Link, Mesh, Robot, Visual
from grader.robot.shapes import is_empty
from grader.robot.transforms import IDENTITY, Transform, unit
from grader.submission.urdf import Read, Urdf
from grader.xml.parsing import Element

_NUMBER, _TINY = 1e-6, 1e-12  # relative, absolute
_LENGTH = 1e-6  # metres
_TURN = 4e-3  # of a rotation matrix: half a turn that is written 3.14 is the same in both directions
_ANGLE = 0.25  # degrees: the same turn
_TURNING = ("continuous", "revolute", "prismatic", "planar")
_LIMITED = ("revolute", "prismatic")
_UNLIMITED = ("fixed", "floating")
# What the model of a robot may not hold, with ROS 2's defaults.
_EXTRAS: Mapping[str, Mapping[str, str]] = {
    "dynamics": {"damping": "0", "friction": "0"},
    "safety_controller": {"soft_lower_limit": "0", "soft_upper_limit": "0", "k_position": "0", "k_velocity": ""},
    "calibration": {"rising": "", "falling": "", "reference_position": ""},
}


class Turn(NamedTuple):
    """A rotation, row by row, or a direction: compared more coarsely than lengths."""

    values: tuple[float, ...]


class Shown(NamedTuple):
    """A shape in the frame of its link, with its colour."""

    geometry: Geometry
    pose: Transform
    colour: tuple[object, ...] = ()


def is_same_robot(one: Urdf, other: Urdf, kept: Collection[str]) -> bool:
    """Return whether two URDFs are the same robot; `kept` are names that something outside of the file refers to."""
    if not isinstance(one, Read) or not isinstance(other, Read):
        return False
    if one.loaded.verdict != other.loaded.verdict or one.reading.undetermined != other.reading.undetermined:
        return False
    robot, changed = one.reading.robot, other.reading.robot
    if robot is None or changed is None:
        return False
    root, changed_root = one.reading.root, other.reading.root
    foreign = _foreign(root)
    said = {*kept, *_words(foreign)}
    if foreign != _foreign(changed_root) or not _same_links(robot, changed, said):
        return False
    return is_same(_joints(robot, root, said), _joints(changed, changed_root, said))


def _same_links(one: Robot, other: Robot, kept: Collection[str]) -> bool:
    mine, others = _links_by_name(one, kept), _links_by_name(other, kept)
    return list(mine) == list(others) and all(_same_link(mine[name], others[name]) for name in mine)


def _links_by_name(robot: Robot, kept: Collection[str]) -> dict[str, Link]:
    """Return the links by names, sorted; those that nothing refers to by a number."""
    connected = {name for joint in robot.joints for name in (joint.parent, joint.child)}
    named = (
        (link.name if link.name in connected or link.name in kept else f" {i}", link)
        for i, link in enumerate(robot.links)
    )
    return dict(sorted(named))


def _same_link(one: Link, other: Link) -> bool:
    pairs = ((one.visuals, other.visuals), (one.collisions, other.collisions))
    return all(is_same_set(_shapes(a), _shapes(b), is_same_shape) for a, b in pairs) and is_same(
        _mass(one), _mass(other)
    )


def _shapes(shapes: Sequence[Visual | Collision]) -> list[Shown]:
    found = []
    for shape in shapes:
        if not is_empty(shape.geometry):
            material = shape.material if isinstance(shape, Visual) else None
            colour = (*material.rgba, material.texture) if material is not None else ()
            found.append(Shown(shape.geometry, placed_by(IDENTITY, shape.origin), colour))
    return found


def _mass(link: Link) -> object:
    """Return the mass of a link, its centre, and its inertia about the axes of the link's frame."""
    if link.inertial is None:
        return None
    xx, xy, xz, yy, yz, zz = link.inertial.inertia
    pose = placed_by(IDENTITY, link.inertial.origin)
    columns = [pose.rotate(column) for column in ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))]
    rows = tuple(Transform(pose.rotation).rotate(row) for row in zip(*columns, strict=True))
    return link.inertial.mass, pose.translation, rows


def _joints(robot: Robot, root: Element | None, kept: Collection[str]) -> tuple[object, ...]:
    """Return everything about the joints that counts, sorted by the links that they connect."""
    mimicked = {joint.mimic.joint for joint in robot.joints if joint.mimic is not None}
    found = [] if root is None else list(root.iterchildren("joint"))
    extras = {element.get("name", ""): element for element in reversed(found)}
    forms = (_joint(joint, extras.get(joint.name), mimicked | set(kept)) for joint in robot.joints)
    return tuple(sorted(forms, key=lambda form: form[:4]))


def _joint(joint: Joint, element: Element | None, kept: Collection[str]) -> tuple[Any, ...]:
    kind = joint.type
    pose = placed_by(IDENTITY, joint.origin) if joint.origin is not None else None
    axis = (unit(joint.axis) if joint.axis is not None else None) if kind in _TURNING else ()
    limit = joint.limit if kind not in _UNLIMITED else None
    range_ = (limit.lower, limit.upper) if limit is not None and kind in _LIMITED else ()
    strength = (limit.effort, limit.velocity) if limit is not None else ()
    name = joint.name if joint.name in kept else ""
    moves = kind != "fixed"
    return (
        joint.parent, joint.child, name, kind,
        (pose.translation, Turn(pose.rotation)) if pose is not None else None,
        Turn(axis) if axis else axis,
        range_, strength,
        (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset) if joint.mimic is not None and moves else (),
        tuple(_extras(element)) if element is not None and moves else (),
    )  # fmt: skip


def _extras(element: Element) -> Iterator[object]:
    for tag, defaults in _EXTRAS.items():
        child = next(element.iterchildren(tag), None)
        attributes = {} if child is None else {key: str(value) for key, value in child.attrib.items()}
        yield tag, tuple(_value(attributes.get(name, default)) for name, default in defaults.items())


def _foreign(root: Element | None) -> tuple[object, ...]:
    """Return the elements below <robot> that are for simulators and controllers, as they are."""
    return () if root is None else tuple(_plain(child) for tag in FOREIGN for child in root.iterchildren(tag))


def _plain(element: Element) -> tuple[object, ...]:
    attributes = sorted((str(key), _value(str(value))) for key, value in element.attrib.items())
    return str(element.tag), tuple(attributes), _value(element.text or ""), tuple(map(_plain, element))


def _value(text: str) -> tuple[float | str, ...]:
    return tuple(map(_number, text.split()))


def _number(text: str) -> float | str:
    try:
        return float(text) + 0.0
    except ValueError:
        return text


def _words(value: object) -> Iterator[str]:
    if isinstance(value, tuple):
        for item in value:
            yield from _words(item)
    elif isinstance(value, str):
        yield value


def is_same(one: object, other: object) -> bool:
    """Return whether two values of plain tuples are equal, numbers up to rounding."""
    match one, other:
        case Turn(), Turn():
            pairs = zip(one.values, other.values, strict=True)
            return len(one.values) == len(other.values) and all(abs(a - b) <= _TURN for a, b in pairs)
        case tuple(), tuple():
            return len(one) == len(other) and all(map(is_same, one, other))
        case float() | int(), float() | int():
            return abs(one - other) <= max(_TINY, _NUMBER * max(abs(one), abs(other)))
        case _:
            return one == other


def is_same_set(one: Sequence[Any], other: Sequence[Any], same: Callable[[Any, Any], bool]) -> bool:
    """Return whether everything in each of two lists is in the other one; what is drawn twice looks the same."""
    return all(any(same(a, b) for b in other) for a in one) and all(any(same(a, b) for a in one) for b in other)


def is_same_shape(one: Shown, other: Shown) -> bool:
    """Return whether two shapes look the same: a box lies on any of its sides, a cylinder is turned about its axis."""
    if not is_same(one.colour, other.colour) or dist(one.pose.translation, other.pose.translation) > _LENGTH:
        return False
    match one.geometry, other.geometry:
        case Mesh(filename=a, scale=m), Mesh(filename=b, scale=n):
            return a == b and is_same(m, n) and turn_between(one.pose.rotation, other.pose.rotation) <= _ANGLE
        case (Mesh(), _) | (_, Mesh()):
            return False
        case a, b:
            found = ways(a, one.pose, b, other.pose)
            return any(size <= _LENGTH and angle <= _ANGLE for size, _, angle in found)
