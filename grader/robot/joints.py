"""Joints as urdfdom reads them (`joint.cpp`): every defect of a joint makes ROS 2 reject the whole file."""

from typing import Literal, get_args

from grader.problems import Kind
from grader.robot import catalogue
from grader.robot.diagnostics import Notes, Part, children
from grader.robot.model import Joint, Limit, Mimic
from grader.robot.transforms import Vector, unit
from grader.text import quoted
from grader.xml.parsing import Element

JointType = Literal["fixed", "continuous", "revolute", "prismatic", "floating", "planar"]
JOINT_TYPES: tuple[str, ...] = get_args(JointType)
MOVING_TYPES = ("continuous", "revolute", "prismatic", "planar", "floating")
_WITHOUT_AXIS = ("fixed", "floating")
_WITH_LIMIT = ("revolute", "prismatic")
_REJECTED = "ROS 2 loads nothing of the file"
_X_AXIS = (1.0, 0.0, 0.0)


def read_joint(element: Element, notes: Notes) -> Joint:
    """One joint with all that can be read of it; what cannot is noted and left None, or out."""
    name, kind = element.get("name"), element.get("type")
    label = quoted(name or "")
    if name is None:
        notes.add(catalogue.JOINT_WITHOUT_NAME, f"this joint has no name; {_REJECTED}", element)
    _check_type(element, kind, label, notes)
    inside = children(element)
    origin = Part(notes, catalogue.BAD_JOINT_ORIGIN, _REJECTED).origin(inside.get("origin"))
    axis = _read_axis(element, inside.get("axis"), kind or "", notes)
    limit = _read_limit(element, inside.get("limit"), kind or "", notes)
    mimic = _read_mimic(inside["mimic"], notes) if "mimic" in inside else None
    _check_extras(inside, notes)
    if kind in ("floating", "planar"):
        how = "does not publish it" if kind == "floating" else "treats it as fixed"
        notes.add(catalogue.UNPUBLISHED_JOINT, f"joint {label} is {kind}: robot_state_publisher {how}", element, "type")
    return Joint(
        name or "",
        kind or "",
        _linked(element, inside, "parent", label, notes),
        _linked(element, inside, "child", label, notes),
        origin,
        axis,
        limit,
        mimic,
        notes.location(element),
        notes.location(inside["axis"]) if "axis" in inside else None,
    )


def _check_type(element: Element, kind: str | None, label: str, notes: Notes) -> None:
    if kind is None:
        notes.add(catalogue.TYPE_MISSING, f"joint {label} has no type; {_REJECTED}", element)
    elif kind not in JOINT_TYPES:
        guess = notes.did_you_mean(kind.strip(), JOINT_TYPES)
        if kind.strip().lower() in JOINT_TYPES:
            guess = f"; write {kind.strip().lower()!r}, in lower case and without spaces"
        message = f"joint {label} has the type {quoted(kind)}, which does not exist: {_REJECTED}{guess}"
        notes.add(catalogue.TYPE_UNKNOWN, message, element, "type")


def _linked(element: Element, inside: dict[str, Element], role: str, label: str, notes: Notes) -> str:
    """The link that a joint names as its parent or child, empty where it names none."""
    named = inside.get(role)
    link = named.get("link") if named is not None else None
    if not link:
        message = f'joint {label} does not say which link is its {role} (<{role} link="..."/>); {_REJECTED}'
        notes.add(catalogue.NO_PARENT_OR_CHILD, message, element if named is None else named, "link")
    return link or ""


def _read_axis(element: Element, axis: Element | None, kind: str, notes: Notes) -> Vector | None:
    if kind in _WITHOUT_AXIS:
        return _X_AXIS  # urdfdom does not look at it, well-formed or not
    if axis is None:
        if kind in MOVING_TYPES:
            message = "this joint has no <axis>; ROS 2 takes the x axis, 1 0 0"
            notes.add(catalogue.DEFAULT_AXIS, message, element)
        return _X_AXIS
    direction = Part(notes, catalogue.BAD_AXIS, _REJECTED).vector(axis, "xyz")
    if direction is None:
        return None
    if unit(direction) is None:
        message = "this axis has the length 0; ROS 2 loads it, but every pose behind this joint is undefined"
        notes.add(catalogue.ZERO_AXIS, message, axis, "xyz")
    elif abs(sum(each * each for each in direction) - 1.0) > 0.02:
        message = "only the direction of an axis counts: ROS 2 makes its length 1"
        notes.add(catalogue.SCALED_AXIS, message, axis, "xyz")
    return direction


def _read_limit(element: Element, limit: Element | None, kind: str, notes: Notes) -> Limit | None:
    if limit is None:
        if kind in _WITH_LIMIT:
            message = f"a {kind} joint needs <limit> with effort and velocity; {_REJECTED}"
            notes.add(catalogue.LIMIT_MISSING, message, element, "type")
        return None
    part = Part(notes, catalogue.BAD_LIMIT, _REJECTED)
    lower, upper = part.number(limit, "lower", 0.0), part.number(limit, "upper", 0.0)
    effort, velocity = part.needed(limit, "effort"), part.needed(limit, "velocity")
    if part.bad:
        return None
    if kind in _WITH_LIMIT and lower >= upper:
        message = f"lower {lower:g} is not below upper {upper:g}: the joint cannot be moved"
        notes.add(catalogue.EMPTY_RANGE, message, limit, "lower" if "lower" in limit.attrib else "upper")
    return Limit(lower, upper, effort, velocity)


def _read_mimic(element: Element, notes: Notes) -> Mimic | None:
    part = Part(notes, catalogue.BAD_MIMIC, _REJECTED)
    joint = element.get("joint")
    if joint is None:
        part.fail("<mimic> has no joint", element)
    multiplier, offset = part.number(element, "multiplier", 1.0), part.number(element, "offset", 0.0)
    return None if part.bad or joint is None else Mimic(joint, multiplier, offset)


def _check_extras(inside: dict[str, Element], notes: Notes) -> None:
    """Check the parts that the model does not keep, but that ROS 2 rejects a file for."""
    if "dynamics" in inside:
        dynamics = inside["dynamics"]
        part = _check_numbers(dynamics, ("damping", "friction"), catalogue.BAD_DYNAMICS, notes)
        if dynamics.get("damping") is None and dynamics.get("friction") is None:
            part.fail("<dynamics> has neither damping nor friction", dynamics)
    if "safety_controller" in inside:
        safety = inside["safety_controller"]
        optional = ("soft_lower_limit", "soft_upper_limit", "k_position")
        _check_numbers(safety, optional, catalogue.BAD_SAFETY, notes).needed(safety, "k_velocity")
    if "calibration" in inside:
        _check_numbers(inside["calibration"], ("rising", "falling"), catalogue.BAD_CALIBRATION, notes)


def _check_numbers(element: Element, attributes: tuple[str, ...], kind: Kind, notes: Notes) -> Part:
    part = Part(notes, kind, _REJECTED)
    for each in attributes:
        part.number(element, each, 0.0)
    return part
