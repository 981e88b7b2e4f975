"""Facts about the joint above a link: its type, its frame, its axis, its limits, its dynamics, what it mimics."""

from collections.abc import Callable, Iterator
from math import isfinite
from typing import Any

from grader.authoring.fact import Fact, Omission, direction, exact, length, lengths, shown, whole_angle, whole_degrees
from grader.authoring.solution import Solution
from grader.errors import MissingElement, NotDecided
from grader.robot.model import Joint

_A = {"fixed": "a fixed", "continuous": "a continuous", "revolute": "a revolute", "prismatic": "a prismatic"}
_WITH_AXIS = ("continuous", "revolute", "prismatic", "planar")
_SLIDING_TOLERANCE = 0.002  # m: the default of joint_limits is in degrees


def joint_facts(solution: Solution, joint: Joint) -> Iterator[Fact | Omission]:
    """Yield what is true of a joint and of the frame of the link below it."""
    for rule in _RULES:
        try:
            fact = rule(solution, joint)
        except (MissingElement, NotDecided) as error:  # an axis of length zero
            yield Omission(f"{joint.child}: {rule.__name__.strip('_')}", str(error))
            continue
        if fact is not None:
            yield fact


def _type(solution: Solution, joint: Joint) -> Fact:
    del solution
    kind, link, parent = joint.type, joint.child, joint.parent
    title = f"{_A.get(kind, f'a {kind}').capitalize()} joint connects {link} to {parent}"
    return Fact(link, "joint", title, "held_by", {"link": link, "parent": parent, "joint_type": kind})


def _frame(solution: Solution, joint: Joint) -> Fact:
    link, parent = joint.child, joint.parent
    pose = solution.robot.pose(link, relative_to=parent)
    xyz, rpy = lengths(pose.translation), [whole_angle(angle) for angle in pose.rpy]
    title = f"The frame {link} is at {shown(xyz)} m in {parent}"
    title += f", turned by rpy {shown(map(whole_degrees, pose.rpy))} degrees" if any(rpy) else ", not turned"
    arguments = {"link": link, "relative_to": parent, "xyz": xyz, **({"rpy": rpy} if any(rpy) else {})}
    return Fact(link, "frame", title, "frame_at", arguments)


def _axis(solution: Solution, joint: Joint) -> Fact | None:
    if joint.type not in _WITH_AXIS:
        return None
    link, parent = joint.child, joint.parent
    along = direction(solution.robot.pose(link, relative_to=parent).rotate(solution.robot.axis(joint)))
    verb = "slides along" if joint.type == "prismatic" else "turns about"
    title = f"The joint of {link} {verb} {shown(along)} in {parent}"
    return Fact(link, "axis", title, "joint_axis", {"link": link, "relative_to": parent, "direction": along})


def _limits(solution: Solution, joint: Joint) -> Fact | None:
    del solution
    limit, turns = joint.limit, joint.type == "revolute"
    if limit is None or not (turns or joint.type == "prismatic"):
        return None
    lower, upper = ((whole_degrees if turns else length)(end) for end in (limit.lower, limit.upper))
    title = f"The joint of {joint.child} {'turns' if turns else 'slides'} from {shown([lower])} to {shown([upper])}"
    title += " degrees" if turns else " m"
    arguments: dict[str, Any] = {"link": joint.child, "lower": lower, "upper": upper}
    given = {"effort": limit.effort, "velocity": limit.velocity}
    arguments |= {name: exact(value) for name, value in given.items() if isfinite(value)}
    units = ("N m", "rad/s") if turns else ("N", "m/s")
    title += "".join(
        f", {name} {shown([given[name]])} {unit}" for name, unit in zip(given, units, strict=True) if name in arguments
    )
    return Fact(
        joint.child, "limits", title, "joint_limits", arguments | ({} if turns else {"tolerance": _SLIDING_TOLERANCE})
    )


def _dynamics(solution: Solution, joint: Joint) -> Fact | None:
    del solution
    if joint.dynamics is None or joint.type == "fixed":
        return None
    friction, damping = exact(joint.dynamics.friction), exact(joint.dynamics.damping)
    title = f"The joint of {joint.child} has friction {shown([friction])} and damping {shown([damping])}"
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
    title = f"The joint of {joint.child} mimics that of {leader}, multiplier {shown([multiplier])}, offset {shown([offset])}"
    arguments = {"link": joint.child, "leader": leader, "multiplier": multiplier, "offset": offset}
    return Fact(joint.child, "mimic", title, "mimics", arguments)


_RULES: tuple[Callable[[Solution, Joint], Fact | None], ...] = (
    _type,
    _frame,
    _axis,
    _limits,
    _dynamics,
    _mimic,
)
