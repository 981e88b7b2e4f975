"""Checks of the tree of links: whether ROS 2 loads it, its root, its joints, their types and names."""

from collections.abc import Mapping

from grader.checks.outcome import Outcome, failed, listing, passed, place
from grader.errors import MissingElement
from grader.names import did_you_mean
from grader.robot.joints import JOINT_TYPES, MOVING_TYPES, JointType
from grader.robot.kinematics import Configuration
from grader.robot.model import Joint
from grader.robot.reader import Reading

_UNLOADED = {"URDF083"}
_CONSEQUENCES = {"URDF080", "URDF081"}  # of a wrong name in a joint, as often as not


def urdf_loads(urdf: Reading) -> Outcome:
    """ROS 2 loads the URDF, and every link is in its one tree."""
    spoiling = [each for each in urdf.problems if each.kind.effect == "rejects" or each.code in _UNLOADED]
    if not spoiling and urdf.verdict != "rejected":
        return passed("ROS 2 loads the file and every link is in its one tree")
    causes = [each for each in spoiling if each.code not in _CONSEQUENCES]
    first = (causes or spoiling or list(urdf.problems))[0]
    more = max(0, len(spoiling) - 1)
    others = f" (and {more} more problem{'s' if more > 1 else ''} that keep{'' if more > 1 else 's'} it from loading)"
    return Outcome("failed", f"{first.message}{others if more else ''}", location=first.location)


def held_by(robot: Configuration, *, link: str, parent: str, joint_type: JointType) -> Outcome:
    """Joints lead from the parent down to the link, one of the given type and otherwise only fixed ones."""
    chain = robot.chain(link, above=parent)
    if chain is None:
        return _not_below(robot, link, parent)
    if not chain:
        return failed(f"{link!r} is itself the parent, so no joint holds it", place(robot.link(link).location))
    held = robot.parent_joints[link]
    at = place(held.location, "type")
    moving = [joint for joint in chain if joint.type != "fixed"]
    wanted = [] if joint_type == "fixed" else [joint_type]
    if [joint.type for joint in moving] == wanted:
        return passed(f"a {joint_type} joint, {(moving or [held])[0].name!r}, holds {link!r} to {parent!r}")
    if not moving:
        message = f"{link!r} cannot move: joint {held.name!r} is fixed, expected {joint_type}"
        raise MissingElement("moving joint", link, message=message, location=at)
    unknown = [joint for joint in moving if joint.type not in MOVING_TYPES]
    if unknown:
        wrong = unknown[0]
        guess = did_you_mean(wrong.type, JOINT_TYPES)
        kind = f"has the type {wrong.type!r}, which does not exist{guess}" if wrong.type else "has no type"
        message = f"joint {wrong.name!r}, which holds {link!r}, {kind}"
        if not wanted or len(unknown) < len(moving):
            return failed(message, place(wrong.location, "type"))
        raise MissingElement("moving joint", link, message=message, location=place(wrong.location, "type"))
    if len(moving) > 1:
        names = listing([joint.name for joint in moving])
        expected = "only fixed joints" if not wanted else f"one {joint_type} joint"
        return failed(f"several joints move {link!r}: {names}; expected {expected}", at)
    at = place(moving[0].location, "type")
    return failed(f"joint {moving[0].name!r}, which holds {link!r}, is {moving[0].type}, expected {joint_type}", at)


def joints_named(robot: Configuration, *, parent: str, joints: Mapping[str, str]) -> Outcome:
    """The joints that hold links have the given names (joint name: link name).

    The joint counts that holds the link, or is on the way to it from `parent`; where nothing holds the link, any joint
    of that name that has it as its child or parent.
    """
    wrong: list[str] = []
    at = None
    for name, link in joints.items():
        if _is_named(robot, name, link, parent):
            continue
        held = robot.parent_joints.get(link)
        at = at or (place(held.location, "name") if held else None)
        wrong.append(
            f"{link!r} is held by {held.name!r}, not {name!r}" if held else f"no joint {name!r} holds {link!r}"
        )
    if wrong:
        return failed("; ".join(wrong), at)
    return passed(f"the joints are named {listing(list(joints))}")


def _is_named(robot: Configuration, name: str, link: str, parent: str) -> bool:
    if not robot.robot.has_link(link):
        return False
    named = [joint for joint in robot.robot.joints if joint.name == name]
    held = robot.parent_joints.get(link)
    if held is not None:
        joined = robot.robot.has_link(parent) and robot.root_of(parent) == robot.root_of(link)
        way = robot.between(parent, link) if joined else (held,)
        return any(joint in named for joint in (*way, held))
    return any(link in (joint.child, joint.parent) for joint in named)


def root_of_tree(robot: Configuration, *, link: str, holds: str) -> Outcome:
    """A link is the root of the tree, and fixed joints lead from it to another link."""
    robot.link(link)
    chain = robot.chain(holds, above=link)
    if link in robot.parent_joints:
        held = robot.parent_joints[link]
        return failed(
            f"{link!r} is not the root: joint {held.name!r} makes it a child of {held.parent!r}", place(held.location)
        )
    if chain is None:
        return _not_below(robot, holds, link)
    loose = [joint for joint in chain if joint.type != "fixed"]
    if loose:
        message = f"joint {loose[0].name!r} between {link!r} and {holds!r} is {loose[0].type}, expected fixed"
        return failed(message, place(loose[0].location, "type"))
    return passed(f"{link!r} is the root, and {holds!r} is fixed to it")


def _not_below(robot: Configuration, link: str, parent: str) -> Outcome:
    robot.pose(link, relative_to=parent)  # raises where nothing joins the two
    held = robot.parent_joints.get(link)
    if held is None:
        above = _last(robot.chain(parent, above=link))
        message = f"{link!r} is above {parent!r}: joint {above.name!r} has them as parent and child the other way round"
        return failed(message, place(above.location))
    message = f"joint {held.name!r} holds {link!r} to {held.parent!r}, expected {parent!r} as the parent"
    return failed(message, place(held.location, "link", "parent"))


def _last(chain: tuple[Joint, ...] | None) -> Joint:
    assert chain  # two links of one tree, neither held from above the other, are above and below
    return chain[0]
