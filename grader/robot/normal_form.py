"""The normal form of a robot: equal for files that differ only in what a copy can change without changing the robot."""

from collections.abc import Callable
from dataclasses import fields
from functools import cache
from hashlib import sha256
from operator import attrgetter
from typing import Any

from grader.robot.model import Collision, Joint, Link, Robot, Visual
from grader.robot.reader import Reading
from grader.xml.parsing import Element

_MODEL = ("link", "joint", "material")
_NAMES = ("name", "material_name")  # of materials: nothing outside of the file refers to them


def normal_form(robot: Robot) -> tuple[list[str], list[str]]:
    """Return the links and joints of a robot as texts, sorted.

    Comments, white space, the order of elements and the way in which numbers are written do not count. Neither do names
    that nothing refers to: those of the robot, of materials, of joints that no joint mimics, and of links without a
    joint.
    """
    mimicked = {joint.mimic.joint for joint in robot.joints if joint.mimic is not None}
    connected = {name for joint in robot.joints for name in (joint.parent, joint.child)}
    links = (_with_name(link, connected) for link in robot.links)
    joints = (_with_name(joint, mimicked) for joint in robot.joints)
    return sorted(map(repr, links)), sorted(map(repr, joints))


def robot_hash(reading: Reading) -> str:
    """Return the hash of a robot's normal form, with the problems of its file; empty without a robot that has links.

    The problems count because ROS 2 ignores what is wrong: without them, different mistakes could give the same robot.
    """
    if reading.robot is None or not reading.robot.links:
        return ""
    problems = sorted((problem.code, problem.message) for problem in reading.problems)
    return _hash((problems, normal_form(reading.robot), _extensions(reading.elements)))


def written_form(root: Element | None, *, is_handed_out: bool = False) -> str:
    """Return the hash of the links, joints and materials as they are written.

    Comments and white space do not count; names, order and the spelling of numbers do. Without other elements, such as
    `<gazebo>`, the hash is empty: `robot_hash` says who has the same.
    """
    children = list(root) if root is not None else []
    model = [child for child in children if child.tag in _MODEL]
    return _hash([*map(_content, model)]) if model and (is_handed_out or len(model) < len(children)) else ""


def _hash(content: object) -> str:
    return sha256(repr(content).encode("utf-8", "backslashreplace")).hexdigest()


def _extensions(root: Element | None) -> list[tuple[Any, ...]]:
    """Return what the robot has besides links, joints and materials, such as <gazebo>, sorted."""
    others = (child for child in root if child.tag not in _MODEL) if root is not None else ()
    return sorted(map(_content, others), key=repr)


def _content(element: Element) -> tuple[Any, ...]:
    """Return an element and all in it, in document order; the numbers of children tell the levels apart."""
    return tuple(
        (str(inner.tag), sorted(inner.attrib.items()), " ".join((inner.text or "").split()), len(inner))
        for inner in element.iter()
    )


def _with_name(element: Link | Joint, kept: set[str]) -> tuple[Any, ...]:
    return element.name if element.name in kept else "", _plain(element, ignored=("name",))


def _plain(value: Any, ignored: tuple[str, ...] = _NAMES) -> Any:
    """Return a value of the model as plain tuples; locations do not count, as in comparisons."""
    kind: Any = type(value)
    if kind in (str, bool) or value is None:  # most values
        return value
    if kind is float:
        return value + 0.0  # -0.0 is 0.0
    if kind is not tuple:
        return tuple(map(_plain, _compared(kind, ignored)(value)))
    if value and type(value[0]) is float:
        return tuple(number + 0.0 for number in value)
    items = map(_plain, value)
    return tuple(sorted(items, key=repr)) if value and isinstance(value[0], Visual | Collision) else tuple(items)


@cache
def _compared(kind: Any, ignored: tuple[str, ...]) -> Callable[[Any], tuple[Any, ...]]:
    """Return what gets the name of a class and the fields that count."""
    names = getattr(kind, "_fields", ()) or (field.name for field in fields(kind) if field.compare)
    return attrgetter("__class__.__name__", *(name for name in names if name not in (*ignored, "location")))
