"""Whether a mutant is the same robot: their forms are equal. A form is what is read of a file that can matter.

What counts: ROS 2's verdict, every pose, shape, colour, mass, axis, limit, mimic and dynamics, the tree, the elements
for simulators and controllers, and every name that something refers to. What does not: defaults written out, rotations
of a cylinder or sphere within its symmetry, shapes without size, the length of an axis, and axes and limits that ROS 2
does not use for a type of joint.
"""

from collections.abc import Collection, Iterator
from typing import Any

from lxml import etree

from grader.robot.frames import placed_by
from grader.robot.model import Collision, Cylinder, Dynamics, Geometry, Joint, Link, Sphere, Visual
from grader.robot.shapes import is_empty
from grader.robot.transforms import AXES, IDENTITY, Transform, Vector, unit
from grader.source import LazyLocation
from grader.submission.urdf import Read, Urdf
from grader.xml.wanted_element import foreign_elements, words_of_foreign

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
    if not isinstance(urdf, Read) or urdf.reading.robot is None or urdf.reading.root is None:
        return None
    robot, root = urdf.reading.robot, urdf.reading.root
    foreign = [
        etree.tostring(child, with_tail=False) for child in sorted(foreign_elements(root), key=lambda it: str(it.tag))
    ]
    named = {*kept, *words_of_foreign(root)}
    mimicked = {joint.mimic.joint for joint in robot.joints if joint.mimic is not None}
    connected = {name for joint in robot.joints for name in (joint.parent, joint.child)}
    links = frozenset(_link(link, named | connected) for link in robot.links)
    joints = frozenset(_joint(joint, named | mimicked) for joint in robot.joints)
    return urdf.loaded.verdict, urdf.reading.undetermined, foreign, links, joints


def _link(link: Link, kept: Collection[str]) -> object:
    shapes = [frozenset(_shapes(found)) for found in (link.visuals, link.collisions)]
    inertial = link.inertial
    mass = (inertial.mass, inertial.inertia, _pose(placed_by(IDENTITY, inertial.origin))) if inertial else ()
    return link.name if link.name in kept else "", *shapes, _rounded(mass)


def _shapes(shapes: tuple[Visual, ...] | tuple[Collision, ...]) -> Iterator[object]:
    for shape in shapes:
        if not is_empty(shape.geometry):
            pose = placed_by(IDENTITY, shape.origin)
            material = shape.material if isinstance(shape, Visual) else None
            colour = (*material.rgba, material.texture) if material is not None else ()
            yield _rounded(pose.translation), _rounded(shape.geometry), _rotation(shape.geometry, pose), colour


def _rotation(geometry: Geometry, pose: Transform) -> tuple[float, ...]:
    """Return the rotation of a shape without what its symmetry hides: a cylinder has a line, in both directions."""
    match geometry:
        case Cylinder():
            turned = _turned(pose.rotate(AXES[2]))
            return max(turned, tuple(-value + 0.0 for value in turned))
        case Sphere():
            return ()
    return _turned(pose.rotation)


def _turned(values: tuple[float, ...] | Vector) -> tuple[float, ...]:
    return tuple(round(value, _TURN) + 0.0 for value in values)


def _pose(pose: Transform) -> tuple[Any, ...]:
    return _rounded(pose.translation), _turned(pose.rotation)


def _joint(joint: Joint, kept: Collection[str]) -> object:
    kind, limit = joint.type, joint.limit if joint.type not in _UNLIMITED else None
    axis = unit(joint.axis) if joint.axis is not None and kind in _TURNING else None
    moving = (joint.mimic, joint.dynamics or Dynamics(), joint.safety_controller, joint.calibration)
    return (
        joint.parent, joint.child, joint.name if joint.name in kept else "", kind,
        _pose(placed_by(IDENTITY, joint.origin)) if joint.origin is not None else None,
        (_turned(axis) if axis is not None else joint.axis) if kind in _TURNING else (),
        _rounded((limit.lower, limit.upper)) if limit is not None and kind in _LIMITED else (),
        _rounded((limit.effort, limit.velocity)) if limit is not None else (),
        _rounded(moving) if kind != "fixed" else (),
    )  # fmt: skip


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
