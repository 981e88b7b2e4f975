"""Facts about the joints of a robot and the robot: that it loads, its root, how many joints move, how its tips move."""

from collections import Counter
from math import isfinite
from typing import Any

from grader.checks.measures.elements import foreign_words
from grader.checks.measures.fact import (
    THE_FILE,
    THE_ROBOT,
    Fact,
    Facts,
    Solution,
    direction,
    exact,
    in_title,
    length,
    lengths,
    of_joints,
    whole_angle,
    whole_degrees,
)
from grader.robot.model import Joint
from grader.text import counted, enumerated

_A = {"fixed": "a fixed", "continuous": "a continuous", "revolute": "a revolute", "prismatic": "a prismatic"}
_WITH_AXIS = ("continuous", "revolute", "prismatic", "planar")
_SLIDING_TOLERANCE = 0.002  # m: the default of joint_limits is in degrees


def _type(solution: Solution, joint: Joint) -> Fact:
    del solution
    kind, link, parent = joint.type, joint.child, joint.parent
    title = f"{_A.get(kind, f'a {kind}').capitalize()} joint connects {link} to {parent}"
    return Fact(link, "joint", title, "held_by", {"link": link, "parent": parent, "joint_type": kind})


def _frame(solution: Solution, joint: Joint) -> Fact:
    link, parent = joint.child, joint.parent
    pose = solution.robot.pose(link, relative_to=parent)
    xyz, rpy = lengths(pose.translation), [whole_angle(angle) for angle in pose.rpy]
    title = f"The frame {link} is at {in_title(xyz)} m in {parent}"
    title += f", rotated by rpy {in_title(map(whole_degrees, pose.rpy))} degrees" if any(rpy) else ", not rotated"
    arguments = {"link": link, "relative_to": parent, "xyz": xyz, **({"rpy": rpy} if any(rpy) else {})}
    return Fact(link, "frame", title, "frame_at", arguments)


def _axis(solution: Solution, joint: Joint) -> Fact | None:
    if joint.type not in _WITH_AXIS:
        return None
    link, parent = joint.child, joint.parent
    along = direction(solution.robot.pose(link, relative_to=parent).rotate(solution.robot.axis(joint)))
    verb = "slides along" if joint.type == "prismatic" else "turns about"
    title = f"The joint of {link} {verb} {in_title(along)} in {parent}"
    return Fact(link, "axis", title, "joint_axis", {"link": link, "relative_to": parent, "direction": along})


def _limits(solution: Solution, joint: Joint) -> Fact | None:
    del solution
    limit, turns = joint.limit, joint.type == "revolute"
    if limit is None or not (turns or joint.type == "prismatic"):
        return None
    lower, upper = ((whole_degrees if turns else length)(end) for end in (limit.lower, limit.upper))
    verb = "turns" if turns else "slides"
    title = f"The joint of {joint.child} {verb} from {in_title([lower])} to {in_title([upper])}"
    title += " degrees" if turns else " m"
    arguments: dict[str, Any] = {"link": joint.child, "lower": lower, "upper": upper}
    given = {"effort": limit.effort, "velocity": limit.velocity}
    arguments |= {name: exact(value) for name, value in given.items() if isfinite(value)}
    units = ("N m", "rad/s") if turns else ("N", "m/s")
    title += "".join(
        f", {name} {in_title([given[name]])} {unit}"
        for name, unit in zip(given, units, strict=True)
        if name in arguments
    )
    return Fact(
        joint.child, "limits", title, "joint_limits", arguments | ({} if turns else {"tolerance": _SLIDING_TOLERANCE})
    )


def _dynamics(solution: Solution, joint: Joint) -> Fact | None:
    del solution
    if joint.dynamics is None or joint.type == "fixed":
        return None
    friction, damping = exact(joint.dynamics.friction), exact(joint.dynamics.damping)
    title = f"The joint of {joint.child} has friction {in_title([friction])} and damping {in_title([damping])}"
    return Fact(
        joint.child,
        "dynamics",
        title,
        "joint_dynamics",
        {"link": joint.child, "friction": friction, "damping": damping},
    )


def _mimic(solution: Solution, joint: Joint) -> Fact | None:
    if joint.mimic is None or joint.type == "fixed" or not solution.robot.robot.has_joint(joint.mimic.joint):
        return None
    leader = solution.robot.joint(joint.mimic.joint).child
    multiplier, offset = exact(joint.mimic.multiplier), exact(joint.mimic.offset)
    title = (
        f"The joint of {joint.child} mimics that of {leader}, "
        f"multiplier {in_title([multiplier])}, offset {in_title([offset])}"
    )
    arguments = {"link": joint.child, "leader": leader, "multiplier": multiplier, "offset": offset}
    return Fact(joint.child, "mimic", title, "mimics", arguments)


types = of_joints("type", _type)
frames = of_joints("frame", _frame)
axes = of_joints("axis", _axis)
limits = of_joints("limits", _limits)
dynamics = of_joints("dynamics", _dynamics)
mimics = of_joints("mimic", _mimic)


_COUNTED = ("revolute", "continuous", "prismatic")
_MAX_TIPS = 20


def loading(solution: Solution) -> Facts:
    """Yield that ROS 2 loads the file."""
    del solution
    title = "ROS 2 loads the URDF, and all links form one tree"
    yield Fact("urdf", "loads", title, "urdf_loads", about=THE_FILE)


def roots(solution: Solution) -> Facts:
    """Yield the root of the tree, with a link that is fixed to it, if there are joints."""
    if not solution.joints:
        return
    root = solution.root
    fixed = (joint.child for joint in solution.joints.values() if joint.parent == root and joint.type == "fixed")
    holds = next(fixed, root)
    title = f"{root} is the root of the tree{f', and {holds} is fixed to it' if holds != root else ''}"
    yield Fact("root", "", title, "root_of_tree", {"link": root, "holds": holds}, about=THE_ROBOT)


def counts(solution: Solution) -> Facts:
    """Yield the numbers of joints that move, if there are joints."""
    if not solution.joints:
        return
    kinds = Counter(joint.type for joint in solution.moving_joints)
    moving = sum(joint.mimic is None for joint in solution.moving_joints)
    numbers = {"moving": moving, **{kind: kinds[kind] for kind in _COUNTED}}
    listed = [f"{kinds[kind]} {kind}" for kind in _COUNTED if kinds[kind]]
    title = f"{counted(moving, 'joint')} can be moved{f': {enumerated(listed)}' if listed else ''}"
    title += " (with those that mimic)" if moving != len(solution.moving_joints) else ""
    yield Fact("joint", "counts", title, "counts", numbers, about=THE_ROBOT)


def motions(solution: Solution) -> Facts:
    """Yield that the last links of the chains that move do so as those of the reference."""
    tips = list(solution.tips[:_MAX_TIPS])
    if tips:
        title = f"{enumerated(tips, 4)} {'moves' if len(tips) == 1 else 'move'} as in the reference solution"
        arguments = {"links": tips, "match": "order"}
        yield Fact("motion", "", title, "kinematics_match_reference", arguments, about=THE_ROBOT)


def names(solution: Solution) -> Facts:
    """Yield the names of joints that other elements use."""
    words = foreign_words(solution.reading.root) if solution.reading.root is not None else set()
    joints = {solution.joints[link.name].name: link.name for link in solution.links if link.name in solution.joints}
    used = {name: link for name, link in joints.items() if name in words}
    if used:
        title = f"The joints that controllers use are named {enumerated(list(used))}"
        arguments = {"parent": solution.root, "joints": used}
        yield Fact("joint", "names", title, "joints_named", arguments, about=THE_ROBOT)
