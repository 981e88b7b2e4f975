"""Whether two files are the same robot: their forms are equal. A form is what is read of a file that can matter.

What counts: ROS 2's verdict, every pose, shape, colour, mass, axis, limit, mimic and dynamics, the tree, the elements
for simulators and controllers, and every name that something refers to. What does not: numbers written otherwise,
defaults written out, full turns, turns of a shape within its symmetry, shapes without size or drawn twice, the length
of an axis, and axes and limits that ROS 2 does not use for a type of joint.
"""

from collections.abc import Collection, Iterator
from typing import Any

from grader.mutation.trees import FOREIGN, words_of_foreign
from grader.robot.frames import placed_by
from grader.robot.joint_elements import Dynamics
from grader.robot.model import Box, Collision, Cylinder, Geometry, Joint, Link, Mesh, Visual
from grader.robot.shapes import is_empty
from grader.robot.transforms import AXES, IDENTITY, Transform, Vector, unit
from grader.source import LazyLocation
from grader.submission.urdf import Read, Urdf
from grader.xml.parsing import Element

_DIGITS, _DECIMALS = 6, 12  # significant digits, of which rounding leaves those after the 12th decimal open
_TURN = 2  # decimals of a direction: half a turn that is written 3.14 is the same in both directions
_TURNING = ("continuous", "revolute", "prismatic", "planar")
_LIMITED = ("revolute", "prismatic")
_UNLIMITED = ("fixed", "floating")


def is_same_robot(one: Urdf, other: Urdf, kept: Collection[str]) -> bool:
    """Return whether two URDFs are the same robot; `kept` are names that something outside of the file refers to."""
    form = _form(one, kept)
    return form is not None and form == _form(other, kept)


def _form(urdf: Urdf, kept: Collection[str]) -> object:
    """Return what counts of a file, where the order does not matter as sets; None if no robot is read."""
    if not isinstance(urdf, Read) or urdf.reading.robot is None:
        return None
    robot, root = urdf.reading.robot, urdf.reading.root
    foreign = [_plain(child) for tag in FOREIGN for child in root.iterchildren(tag)] if root is not None else []
    named = {*kept, *(words_of_foreign(root) if root is not None else ())}
    mimicked = {joint.mimic.joint for joint in robot.joints if joint.mimic is not None}
    connected = {name for joint in robot.joints for name in (joint.parent, joint.child)}
    links = frozenset(_link(link, named | connected) for link in robot.links)
    joints = frozenset(_joint(joint, named | mimicked) for joint in robot.joints)
    return urdf.loaded.verdict, urdf.reading.undetermined, foreign, links, joints


def _link(link: Link, kept: Collection[str]) -> object:
    shapes = [frozenset(_shapes(found)) for found in (link.visuals, link.collisions)]
    return link.name if link.name in kept else "", *shapes, _rounded(_mass(link))


def _shapes(shapes: tuple[Visual, ...] | tuple[Collision, ...]) -> Iterator[object]:
    for shape in shapes:
        if not is_empty(shape.geometry):
            pose = placed_by(IDENTITY, shape.origin)
            material = shape.material if isinstance(shape, Visual) else None
            colour = (*material.rgba, material.texture) if material is not None else ()
            yield _rounded(pose.translation), _solid(shape.geometry, pose), _rounded(colour)


def _solid(geometry: Geometry, pose: Transform) -> object:
    """Return a shape that is turned, without what its symmetry hides: a box has three lengths along three lines."""
    match geometry:
        case Mesh(filename=file, scale=scale):
            return file, _rounded(scale), _turned(pose.rotation)
        case Box(size=size):
            return frozenset((_rounded(a), _line(pose.rotate(axis))) for a, axis in zip(size, AXES, strict=True))
        case Cylinder(radius=radius, length=length):
            return _rounded((radius, length)), _line(pose.rotate(AXES[2]))
        case sphere:
            return _rounded(sphere.radius)


def _line(direction: Vector) -> tuple[float, ...]:
    """Return a direction or its opposite: both are the same line."""
    turned = _turned(direction)
    return max(turned, _turned(tuple(-value for value in turned)))


def _turned(values: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(value, _TURN) + 0.0 for value in values)


def _mass(link: Link) -> tuple[Any, ...]:
    """Return the mass of a link, its centre, and its inertia about the axes of the link's frame."""
    if link.inertial is None:
        return ()
    xx, xy, xz, yy, yz, zz = link.inertial.inertia
    pose = placed_by(IDENTITY, link.inertial.origin)
    columns = [pose.rotate(column) for column in ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))]
    rows = tuple(Transform(pose.rotation).rotate(row) for row in zip(*columns, strict=True))
    return link.inertial.mass, pose.translation, rows


def _joint(joint: Joint, kept: Collection[str]) -> object:
    kind, limit = joint.type, joint.limit if joint.type not in _UNLIMITED else None
    pose = placed_by(IDENTITY, joint.origin) if joint.origin is not None else None
    axis = unit(joint.axis) if joint.axis is not None and kind in _TURNING else None
    moving = (joint.mimic, joint.dynamics or Dynamics(), joint.safety_controller, joint.calibration)
    return (
        joint.parent, joint.child, joint.name if joint.name in kept else "", kind,
        (_rounded(pose.translation), _turned(pose.rotation)) if pose is not None else None,
        (_turned(axis) if axis is not None else joint.axis) if kind in _TURNING else (),
        _rounded((limit.lower, limit.upper)) if limit is not None and kind in _LIMITED else (),
        _rounded((limit.effort, limit.velocity)) if limit is not None else (),
        _rounded(moving) if kind != "fixed" else (),
    )  # fmt: skip


def _plain(element: Element) -> tuple[object, ...]:
    """Return an element and all in it, with its numbers as numbers."""
    attributes = sorted((str(key), _values(str(value))) for key, value in element.attrib.items())
    return str(element.tag), attributes, _values(element.text or ""), [*map(_plain, element)]


def _values(text: str) -> list[object]:
    return [*map(_number, text.split())]


def _number(text: str) -> object:
    try:
        return repr(float(text) + 0.0)
    except ValueError:
        return text


def _rounded(value: Any) -> Any:
    """Return numbers, also those in tuples, without what computing with them may change."""
    match value:
        case LazyLocation():
            return None
        case tuple():
            return tuple(map(_rounded, value))
        case float():
            return float(f"{round(value, _DECIMALS):.{_DIGITS}g}") + 0.0
    return value
