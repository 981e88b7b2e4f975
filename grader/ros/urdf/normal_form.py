"""The normal form of a robot.

It is equal for files that differ only in what nobody can see, and what a copy can change.

What counts: every pose, shape, colour, mass, axis, limit, mimic and dynamics, the tree, and every
name that something refers to. These do not count: comments, white space, the order of elements, the
way in which numbers are written, defaults written out, rotations of a cylinder or sphere within its
symmetry, shapes without size, the length of an axis, and axes and limits that ROS 2 does not use
for a type of joint.
"""

from collections.abc import Collection, Iterable, Iterator
from functools import lru_cache
from typing import Any, NamedTuple

from grader.base.transforms import AXES, unit
from grader.files.reading import hash_bytes
from grader.ros.urdf.model import (
    Capsule,
    Collision,
    Cylinder,
    Dynamics,
    Geometry,
    Joint,
    Link,
    Origin,
    Robot,
    Sphere,
    Visual,
    compared_fields,
)
from grader.ros.urdf.reader import Reading
from grader.ros.xml.parsing import Element

_MODEL = ("link", "joint", "material")
_DIGITS, _DECIMALS = (
    6,
    12,
)  # significant digits, of which rounding leaves those after the 12th decimal open
_TURNING = ("continuous", "revolute", "prismatic", "planar")
_LIMITED = ("revolute", "prismatic")
_UNLIMITED = ("fixed", "floating")


def normal_form(
    robot: Robot, kept: Collection[str] = (), *, decimals: int = _DIGITS
) -> tuple[list[str], list[str]]:
    """Return the links and joints of a robot as texts, sorted.

    Names that nothing refers to do not count: those of the robot, of materials, of joints that no
    joint mimics, and of links without a joint. `kept` are names that something outside of the file
    refers to. Directions are rounded to `decimals`: with 2, half a turn that is written 3.14 is the
    same in both directions.
    """
    mimicked = {joint.mimic.joint for joint in robot.joints if joint.mimic}
    connected = {name for joint in robot.joints for name in (joint.parent, joint.child)}
    forms = _Forms(decimals)
    links = (forms.of_link(link, {*kept, *connected}) for link in robot.links)
    return _sorted(links), _sorted(
        forms.of_joint(joint, {*kept, *mimicked}) for joint in robot.joints
    )


def robot_hash(reading: Reading) -> str:
    """Return the hash of a robot's normal form, with the problems of its file.

    It is empty without a robot that has links.

    The problems count because ROS 2 ignores what is wrong: without them, different mistakes could
    give the same robot.
    """
    if not reading.robot or not reading.robot.links:
        return ""
    problems = sorted((problem.code, problem.message) for problem in reading.problems)
    return _hash((problems, normal_form(reading.robot), _extensions(reading.elements)))


def written_form(root: Element | None, *, is_handed_out: bool = False) -> str:
    """Return the hash of the links, joints and materials as they are written.

    Comments and white space do not count; names, order and the spelling of numbers do. Without
    other elements, such as `<gazebo>`, the hash is empty: `robot_hash` says who has the same.
    """
    children = list(root) if root is not None else []
    model = [child for child in children if child.tag in _MODEL]
    if model and (is_handed_out or len(model) < len(children)):
        return _hash(list(map(_content, model)))
    return ""


def _hash(content: object) -> str:
    return hash_bytes(repr(content).encode("utf-8", "backslashreplace"))


def _extensions(root: Element | None) -> list[tuple[Any, ...]]:
    """Return what the robot has besides links, joints and materials, such as <gazebo>, sorted."""
    others = (child for child in root if child.tag not in _MODEL) if root is not None else ()
    return sorted(map(_content, others), key=repr)


def _content(element: Element) -> tuple[Any, ...]:
    """Return an element and all in it, in document order.

    The numbers of children tell the levels apart.
    """
    return tuple(
        (
            str(inner.tag),
            sorted(inner.attrib.items()),
            " ".join((inner.text or "").split()),
            len(inner),
        )
        for inner in element.iter()
    )


def _sorted(forms: Iterable[object]) -> list[str]:
    """Return forms as texts, each once."""
    return sorted(set(map(repr, forms)))


class _Forms(NamedTuple):
    """The forms of the parts of a robot; directions are rounded to a number of decimals."""

    decimals: int

    def of_link(self, link: Link, kept: Collection[str]) -> object:
        inertial = link.inertial
        mass: tuple[object, ...] = ()
        if inertial:
            mass = (inertial.mass, inertial.inertia, *self._normalise_pose(inertial.origin))
        shapes = (
            _sorted(self._normalise_shapes(link.visuals)),
            _sorted(self._normalise_shapes(link.collisions)),
        )
        return link.name if link.name in kept else "", *shapes, _rounded(mass)

    def of_joint(self, joint: Joint, kept: Collection[str]) -> object:
        kind = joint.type
        limit = joint.limit if joint.type not in _UNLIMITED else None
        moving = (
            joint.mimic,
            joint.dynamics or Dynamics(),
            joint.safety_controller,
            joint.calibration,
        )
        return (
            joint.parent,
            joint.child,
            joint.name if joint.name in kept else "",
            kind,
            self._normalise_pose(joint.origin) if joint.origin else None,
            self._normalise_axis(joint),
            _rounded((limit.lower, limit.upper)) if limit and kind in _LIMITED else (),
            _rounded((limit.effort, limit.velocity)) if limit else (),
            _rounded(moving) if kind != "fixed" else (),
        )

    def _normalise_shapes(
        self, shapes: tuple[Visual, ...] | tuple[Collision, ...]
    ) -> Iterator[object]:
        for shape in shapes:
            if not shape.geometry.is_empty:
                material = shape.material if isinstance(shape, Visual) else None
                colour = (*material.rgba, material.texture) if material else ()
                position, rotation = self._normalise_pose(shape.origin, shape.geometry)
                yield position, _rounded(shape.geometry), rotation, colour

    def _normalise_pose(
        self, origin: Origin, geometry: Geometry | None = None
    ) -> tuple[Any, tuple[float, ...]]:
        """Return a position and a rotation, without what the symmetry of a shape hides.

        The symmetry of a cylinder is a line.
        """
        pose = origin.placed_in()
        rotation = self._normalise_direction(pose.rotation)
        match geometry:
            case Cylinder() | Capsule():
                line = self._normalise_direction(pose.rotate(AXES[2]))
                rotation = max(line, tuple(-value + 0.0 for value in line))  # either way
            case Sphere():
                rotation = ()
        return _rounded(pose.translation), rotation

    def _normalise_axis(self, joint: Joint) -> object:
        """Return the direction of an axis.

        For one without a direction, return what the file gives, and nothing for one without use.
        """
        if joint.type not in _TURNING:
            return ()
        axis = unit(joint.axis) if joint.axis is not None else None
        if axis is not None:
            return self._normalise_direction(axis)
        return joint.axis

    def _normalise_direction(self, values: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(round(value, self.decimals) + 0.0 for value in values)


def _rounded(value: Any) -> Any:
    """Return numbers without what computing with them may change.

    They may also be in tuples and elements.
    """
    if hasattr(value, "_fields"):
        return tuple(_rounded(getattr(value, name)) for name in compared_fields(type(value)))
    if isinstance(value, tuple):
        return tuple(map(_rounded, value))
    if isinstance(value, float):
        return _round_number(value)
    return value


@lru_cache(maxsize=1024)  # the robots of a class have many numbers in common
def _round_number(number: float) -> float:
    return float(f"{round(number, _DECIMALS):.{_DIGITS}g}") + 0.0
