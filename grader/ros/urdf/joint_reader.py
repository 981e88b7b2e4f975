"""Joints as urdfdom reads them (`joint.cpp`), and the names they refer to.

Each defect rejects the whole file.
"""

from math import inf

from grader.base.text import quoted
from grader.base.transforms import FULL_TURN, X_AXIS, Vector, add_up, unit
from grader.ros.urdf import urdf_problems
from grader.ros.urdf.diagnostics import ElementReader, Problems, first_children
from grader.ros.urdf.model import (
    Calibration,
    Dynamics,
    Joint,
    Limit,
    Mimic,
    Origin,
    Robot,
    SafetyController,
)
from grader.ros.urdf.versions import WITH_CHECKED_VALUES
from grader.ros.xml.parsing import Element, Elements
from grader.ros.xml.urdf_format import JOINT_TYPES

MOVING_TYPES = ("continuous", "revolute", "prismatic", "planar", "floating")
_WITH_LIMIT = ("revolute", "prismatic")
_CHANGES = ("acceleration", "deceleration", "jerk")
_REJECTED = "ROS 2 rejects the file"
_MAX_NAMED = 12  # links in a message
_MAX_STEPS = 20  # of a loop in a message
_MAX_DEGREES = 720.0  # more is no range in degrees, but a large number that stands for "no limit"


def read_joint(element: Element, problems: Problems) -> Joint:
    """Read one joint; a value that cannot be read is a problem, and None in the joint."""
    name = element.get("name", "")
    kind = element.get("type", "")
    label = quoted(name)
    if element.get("name") is None:
        message = f"this joint has no name; {_REJECTED}"
        problems.add(urdf_problems.JOINT_WITHOUT_NAME, message, element)
    _check_type(element, kind, label, problems)
    inside = first_children(element)
    parent = _link_name(element, inside, "parent", label, problems)
    child = _link_name(element, inside, "child", label, problems)
    origin_reader = ElementReader(problems, urdf_problems.BAD_JOINT_ORIGIN)
    origin: Origin | None = origin_reader.origin(inside.get("origin"))
    if origin_reader.failed:
        origin = None
    axis = _read_axis(element, inside.get("axis"), kind, problems)
    limit = _read_limit(element, inside.get("limit"), kind, problems)
    if kind in ("floating", "planar"):
        how = "does not publish it" if kind == "floating" else "treats it as fixed"
        message = f"joint {label} is {kind}: robot_state_publisher {how}"
        problems.add(urdf_problems.UNPUBLISHED_JOINT, message, element, "type")
    unresolved = problems.parts(element)
    if "" in unresolved:  # then a missing element may be there all the same
        origin = origin if "origin" in inside else None
        axis = axis if "axis" in inside else None
    return Joint(
        name=name,
        type=kind,
        parent=parent,
        child=child,
        origin=origin,
        axis=axis,
        limit=limit,
        mimic=_read_mimic(inside.get("mimic"), problems),
        dynamics=_read_dynamics(inside.get("dynamics"), problems),
        safety_controller=_read_safety(inside.get("safety_controller"), problems),
        calibration=_read_calibration(inside.get("calibration"), problems),
        location=problems.location(element),
        axis_location=problems.location(inside["axis"]) if "axis" in inside else None,
        unresolved=unresolved,
    )


def _check_type(element: Element, kind: str, label: str, problems: Problems) -> None:
    if element.get("type") is None:
        problems.add(urdf_problems.TYPE_MISSING, f"joint {label} has no type; {_REJECTED}", element)
    elif kind not in JOINT_TYPES:
        guess = problems.did_you_mean(kind.strip(), JOINT_TYPES)
        if kind.strip().lower() in JOINT_TYPES:
            guess = f"; write {kind.strip().lower()!r}, in lower case and without spaces"
        message = f"joint {label} has the unknown type {quoted(kind)}; {_REJECTED}{guess}"
        problems.add(urdf_problems.TYPE_UNKNOWN, message, element, "type")


def _link_name(
    element: Element, inside: Elements, role: str, label: str, problems: Problems
) -> str:
    """Return the link that a joint names as its parent or child; empty if it names none."""
    end = inside.get(role)
    link = end.get("link") if end is not None else None
    if not link:
        message = f'joint {label} has no {role} link (<{role} link="..."/>); {_REJECTED}'
        at = element if end is None else end
        problems.add(urdf_problems.NO_PARENT_OR_CHILD, message, at, "link")
    return link or ""


def _read_axis(
    element: Element, axis: Element | None, kind: str, problems: Problems
) -> Vector | None:
    if kind in ("fixed", "floating"):
        return X_AXIS  # urdfdom ignores it, well-formed or not
    if axis is None:
        if kind in MOVING_TYPES:
            message = "this joint has no <axis>; ROS 2 uses the x axis, 1 0 0"
            problems.add(urdf_problems.DEFAULT_AXIS, message, element)
        return X_AXIS
    reader = ElementReader(problems, urdf_problems.BAD_AXIS)
    direction = reader.vector(axis, "xyz")
    if reader.failed:
        return None
    if unit(direction) is None:
        message = (
            "this axis has length 0; ROS 2 loads it, but every pose below this joint is undefined"
        )
        problems.add(urdf_problems.ZERO_AXIS, message, axis, "xyz")
    elif (
        abs(add_up(component * component for component in direction) - 1.0) > 0.02
    ):  # 0.71 0.71 0 is rounded only
        message = "only the direction of an axis counts: ROS 2 normalizes it"
        problems.add(urdf_problems.SCALED_AXIS, message, axis, "xyz")
    return direction


def _read_limit(
    element: Element, limit: Element | None, kind: str, problems: Problems
) -> Limit | None:
    if limit is None:
        if kind in _WITH_LIMIT:
            message = f"a {kind} joint needs <limit> with effort and velocity; {_REJECTED}"
            problems.add(urdf_problems.LIMIT_MISSING, message, element, "type")
        return None
    reader = ElementReader(problems, urdf_problems.BAD_LIMIT)
    if problems.format.version >= WITH_CHECKED_VALUES:
        lower, upper, effort, velocity = _checked_limits(limit, kind, reader)
    else:
        lower = reader.number(limit, "lower")
        upper = reader.number(limit, "upper")
        effort = reader.number(limit, "effort")
        velocity = reader.number(limit, "velocity")
        for attribute in _CHANGES:
            if attribute in limit.attrib:
                problems.ignores(limit, attribute, WITH_CHECKED_VALUES)
    if kind in _WITH_LIMIT and lower >= upper and not reader.failed:
        message = f"lower {lower:g} is not below upper {upper:g}: the joint cannot move"
        problems.add(
            urdf_problems.EMPTY_RANGE,
            message,
            limit,
            "lower" if "lower" in limit.attrib else "upper",
        )
    if kind == "revolute":
        _check_degrees(limit, {"lower": lower, "upper": upper}, problems)
    return Limit(lower, upper, effort, velocity, problems.location(limit))


def _checked_limits(
    limit: Element, kind: str, reader: ElementReader
) -> tuple[float, float, float, float]:
    """Return lower, upper, effort and velocity in a file of version 1.2.

    They are without limit if they are not given, and never negative but for positions.
    """
    if kind in _WITH_LIMIT:
        for attribute in ("lower", "upper"):
            if attribute not in limit.attrib:
                reason = f"<limit> has no {attribute}, which version 1.2 of URDF needs"
                reader.fail(reason, limit)
    lower = _given(limit, "lower", reader, -inf)
    upper = _given(limit, "upper", reader, inf)
    if lower > upper:
        reader.fail(f"lower {lower:g} is above upper {upper:g}", limit, "lower")
    values = {}
    for attribute in ("effort", "velocity", *_CHANGES):
        values[attribute] = _given(limit, attribute, reader, inf)
        if values[attribute] < 0.0:
            reader.fail(f"{attribute} is negative", limit, attribute)
    return lower, upper, values["effort"], values["velocity"]


def _given(limit: Element, attribute: str, reader: ElementReader, default: float) -> float:
    if attribute in limit.attrib:
        return reader.number(limit, attribute)
    return default


def _check_degrees(limit: Element, ends: dict[str, float], problems: Problems) -> None:
    for attribute, angle in ends.items():
        # Degrees are round numbers: 10 and 15 are also taken for degrees, 31.4 (five turns in
        # radians) is not.
        if FULL_TURN < abs(angle) <= _MAX_DEGREES and angle % 5 == 0:
            message = (
                f"{attribute} is in radians, and {angle:g} is more than a full turn: is it in "
                "degrees?"
            )
            problems.add(urdf_problems.LIMIT_IN_DEGREES, message, limit, attribute)
            return


def _read_mimic(element: Element | None, problems: Problems) -> Mimic | None:
    if element is None:
        return None
    reader = ElementReader(problems, urdf_problems.BAD_MIMIC)
    joint = element.get("joint")
    if joint is None:
        reader.fail("<mimic> has no joint", element)
    multiplier = reader.number(element, "multiplier")
    offset = reader.number(element, "offset")
    if reader.failed or joint is None:
        return None
    return Mimic(joint, multiplier, offset, problems.location(element))


def _read_dynamics(element: Element | None, problems: Problems) -> Dynamics | None:
    if element is None:
        return None
    reader = ElementReader(problems, urdf_problems.BAD_DYNAMICS)
    if "damping" not in element.attrib and "friction" not in element.attrib:
        reader.fail("<dynamics> has neither damping nor friction", element)
        return None
    return Dynamics(
        reader.number(element, "damping"),
        reader.number(element, "friction"),
        problems.location(element),
    )


def _read_safety(element: Element | None, problems: Problems) -> SafetyController | None:
    if element is None:
        return None
    reader = ElementReader(problems, urdf_problems.BAD_SAFETY)
    return SafetyController(
        reader.number(element, "k_velocity"),
        reader.number(element, "soft_lower_limit"),
        reader.number(element, "soft_upper_limit"),
        reader.number(element, "k_position"),
        problems.location(element),
    )


def _read_calibration(element: Element | None, problems: Problems) -> Calibration | None:
    if element is None:
        return None
    reader = ElementReader(problems, urdf_problems.BAD_CALIBRATION)
    rising = reader.number(element, "rising") if "rising" in element.attrib else None
    falling = reader.number(element, "falling") if "falling" in element.attrib else None
    return Calibration(rising, falling, problems.location(element))


def check_references(robot: Robot, problems: Problems) -> None:
    """Report links and joints that do not exist, and mimic joints that follow themselves."""
    links = [link.name for link in robot.links]
    joints = [joint.name for joint in robot.joints]
    # A link or joint whose name is open may be any of those that are missing.
    is_link_open = any("@name" in link.unresolved for link in robot.links)
    is_joint_open = any("@name" in joint.unresolved for joint in robot.joints)
    for joint in robot.joints:
        if not is_link_open:
            _check_ends(robot, joint, links, problems)
        if not is_joint_open:
            _check_mimic(robot, joint, joints, problems)
    if not is_joint_open:
        _check_controlled_joints(robot, joints, problems)
    for loop in _mimic_loops(robot):
        steps = " -> ".join(map(quoted, (*loop[:_MAX_STEPS], loop[0])))
        message = f"joint {quoted(loop[0])} mimics itself: {steps}"
        at = _child_element(robot.joint(loop[0]), "mimic", problems)
        problems.add(urdf_problems.MIMIC_TARGET, message, at, "joint")


def _check_mimic(robot: Robot, joint: Joint, joints: list[str], problems: Problems) -> None:
    """Report that a joint mimics one that does not exist."""
    mimic = joint.mimic
    if mimic and not robot.has_joint(mimic.joint):
        message = (
            f"joint {quoted(joint.name)} mimics {quoted(mimic.joint)}, which does not "
            f"exist{problems.did_you_mean(mimic.joint, joints)}"
        )
        at = _child_element(joint, "mimic", problems)
        problems.add(urdf_problems.MIMIC_TARGET, message, at, "joint")


def _check_ends(robot: Robot, joint: Joint, links: list[str], problems: Problems) -> None:
    """Report the links of a joint that do not exist."""
    for role, name in (("parent", joint.parent), ("child", joint.child)):
        if not name or robot.has_link(name):
            continue
        guess = problems.did_you_mean(name, links)
        if not guess:
            guess = f"; the links are: {', '.join(map(quoted, links[:_MAX_NAMED]))}"
        message = (
            f"the {role} link {quoted(name)} of joint {quoted(joint.name)} does not exist; "
            f"{_REJECTED}{guess}"
        )
        at = _child_element(joint, role, problems)
        problems.add(urdf_problems.UNKNOWN_LINK, message, at, "link")


def _check_controlled_joints(robot: Robot, joints: list[str], problems: Problems) -> None:
    """Report what controller_manager stops at.

    This is unknown joints in ros2_control, and hardware without plugin.
    """
    for system in problems.root.iterchildren("ros2_control"):
        for joint in system.iterchildren("joint"):
            name = joint.get("name")
            if name is not None and not robot.has_joint(name):
                message = (
                    f"ros2_control names the joint {quoted(name)}, which the robot does not have"
                )
                message += problems.did_you_mean(name, joints)
                problems.add(urdf_problems.CONTROLLED_JOINT, message, joint, "name")
        for hardware in system.iterchildren("hardware"):
            if hardware.find("plugin") is None:
                message = "<hardware> has no <plugin>, so controller_manager cannot load it"
                problems.add(urdf_problems.HARDWARE_PLUGIN, message, hardware)


def _child_element(joint: Joint, tag: str, problems: Problems) -> Element:
    element = problems.element(joint)
    child = element.find(tag)
    return element if child is None else child


def _mimic_loops(robot: Robot) -> list[list[str]]:
    targets = {joint.name: joint.mimic.joint for joint in robot.joints if joint.mimic}
    seen = set()
    loops = []
    for start in targets:
        path = []
        name = start
        while name in targets and name not in seen:
            seen.add(name)
            path.append(name)
            name = targets[name]
        if name in path:
            loops.append(path[path.index(name) :])
    return loops
