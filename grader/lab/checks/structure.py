"""Checks of the tree of links.

They are about its root, its joints, their types and names, and how many there are.
"""

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from grader.base.errors import MissingElement
from grader.base.grouping import StringsByName, known_values
from grader.base.names import did_you_mean
from grader.base.quantities import number_text
from grader.base.source import LazyLocation, place
from grader.base.text import counted, enumerated
from grader.base.toml_types import Count
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, judged, passed
from grader.lab.checks.visuals import visible
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint
from grader.ros.xml.urdf_format import JOINT_TYPES, JointType


def _breaks_under(arguments: Mapping[str, Any]) -> Collection[str]:
    """Splitting a fixed joint adds a link and a fixed joint."""
    is_counted = any(arguments.get(key) is not None for key in ("links", "joints", "fixed"))
    return ("fixed joints split",) if is_counted else ()


ABOUT = {
    "held_by": About(("parent", "child", "joint", "joint@type")),
    "joints_named": About(("joint@name",)),
    "root_of_tree": About(),
    "counts": About(("joint", "joint@type", "link"), breaks_under=_breaks_under),
}


def held_by(
    robot: Configuration, *, link: str, parent: str, joint_type: JointType, free: bool = False
) -> Outcome:
    """The joints from the parent to the link are one of the given type and otherwise only fixed
    joints.

    Args:
        link: The link that is examined.
        parent: The link that it should be connected to; other links may lie between.
        joint_type: The type of the one joint that is not fixed; fixed, if all must be fixed.
        free: Whether that joint must move by itself: without `<mimic>`, and without a velocity
            limit of 0.
    """
    chain = robot.chain(link, above=parent)
    if chain is None:
        return _not_below(robot, link, parent)
    if not chain:
        message = f"{link!r} is itself the parent; it should be the child of a joint"
        return failed(message, robot.link(link).location)
    joint = robot.parent_joints[link]
    at = place(joint.location, "type")
    moving = [joint for joint in chain if joint.type != "fixed"]
    wanted = [] if joint_type == "fixed" else [joint_type]
    if [joint.type for joint in moving] == wanted:
        if free and moving:
            blocked = _driven_or_blocked(moving[0], link)
            if blocked:
                return blocked
        connecting = (moving or [joint])[0].name
        return passed(f"the {joint_type} joint {connecting!r} connects {link!r} to {parent!r}")
    if not moving:
        message = f"{link!r} cannot move: its joint is fixed; it should be {joint_type}"
        raise MissingElement(
            "moving joint", link, message=message, detail=f" (joint {joint.name!r})", location=at
        )
    return _fail_other_joints(moving, link, parent, joint_type, at)


def _fail_other_joints(
    moving: Sequence[Joint], link: str, parent: str, joint_type: JointType, at: LazyLocation | None
) -> Outcome:
    """Return the failure of a link that several joints move, or one of another type."""
    unknown = [joint for joint in moving if joint.type not in JOINT_TYPES]
    if unknown:
        may_be_wanted = joint_type != "fixed" and len(unknown) == len(moving)
        return _fail_unknown_type(unknown[0], link, parent, may_be_wanted=may_be_wanted)
    if len(moving) > 1:
        names = enumerated([repr(joint.name) for joint in moving])
        expected = "only fixed joints" if joint_type == "fixed" else f"one {joint_type} joint"
        return failed(
            f"several joints move {link!r}; there should be {expected}",
            at,
            detail=f" (joints {names})",
        )
    message = f"the joint that moves {link!r} is {moving[0].type}; it should be {joint_type}"
    return failed(message, place(moving[0].location, "type"), detail=f" (joint {moving[0].name!r})")


def joints_named(robot: Configuration, *, parent: str, joints: StringsByName) -> Outcome:
    """The parent joints of the links have the given names (joint name: link name).

    A joint of the file with this name and this child counts, even if ROS 2 ignores it. Any joint
    between `parent` and the link may have the name. A link without a parent joint counts if a joint
    of that name has it as its parent.

    Args:
        parent: The link from which the path to each link starts.
        joints: The name of each joint, and the link below it.
    """
    wrong = []
    absent = {}
    is_certain = True  # that no joint is meant to be a missing one
    at = None
    for name, link in joints.items():
        joint = robot.parent_joints.get(link)
        if _is_named(robot, name, link, parent):
            continue
        robot.robot.check_complete()
        if not joint:
            thing = f"joint of {link}" if robot.robot.has_link(link) else link
            absent[thing] = f"no joint {name!r} connects {link!r}"
            is_certain &= thing == link or robot.are_joints_in_place
        else:
            wrong.append(
                (f"the joint of {link!r} should be named {name!r}", f", not {joint.name!r}")
            )
            at = at or place(joint.location, "name")
    if wrong:  # what is not there at all, other criteria report
        message = "; ".join(mistake + detail for mistake, detail in wrong)
        return failed(message, at)._replace(mistake="; ".join(mistake for mistake, _ in wrong))
    if absent:
        outcome = failed("; ".join(absent.values()))
        return outcome._replace(absent=tuple(absent) if is_certain else ())
    return passed(f"the joints are named {enumerated(map(repr, joints))}")


def root_of_tree(
    robot: Configuration, *, link: str, holds: str, links: list[str] | None = None
) -> Outcome:
    """A link is the root of the tree, and fixed joints lead from it to another link.

    Args:
        link: The link that should be the root.
        holds: The link that should be fixed to it.
        links: All links of the robot. If they are named, others that show and collide with nothing,
            such as `odom`, may be above the root, connected by fixed joints.
    """
    robot.link(link)
    chain = robot.chain(holds, above=link)
    joint = _joint_above_root(robot, link, links)
    if joint:
        message = f"{link!r} is not the root: it is below {joint.parent!r}"
        detail = f" (joint {joint.name!r})"
        message += (
            "; only frames without a shape, connected by fixed joints, may be above it"
            if links
            else ""
        )
        return failed(message, place(joint.location), detail=detail)
    if chain is None:
        return _not_below(robot, holds, link)
    loose = [joint for joint in chain if joint.type != "fixed"]
    if loose:
        message = f"a joint between {link!r} and {holds!r} is {loose[0].type}; it should be fixed"
        return failed(
            message, place(loose[0].location, "type"), detail=f" (joint {loose[0].name!r})"
        )
    if link in robot.parent_joints:
        place_in_tree = f"only frames are above {link!r}"
    else:
        place_in_tree = f"{link!r} is the root"
    if holds == link:
        return passed(place_in_tree)
    return passed(f"{place_in_tree}, and {holds!r} is fixed to it")


def counts(
    robot: Configuration,
    *,
    links: Count | None = None,
    joints: Count | None = None,
    moving: Count | None = None,
    revolute: Count | None = None,
    continuous: Count | None = None,
    prismatic: Count | None = None,
    fixed: Count | None = None,
) -> Outcome:
    """The tree has the given numbers of links and joints.

    Links and joints that no chain of joints connects to the root are not counted; of several trees,
    the largest one is counted.

    Args:
        links: The number of links.
        joints: The number of joints of all types.
        moving: The number of joints that are neither fixed nor mimic another joint.
        revolute: The number of revolute joints.
        continuous: The number of continuous joints.
        prismatic: The number of prismatic joints.
        fixed: The number of fixed joints.
    """
    wanted = {
        "link": links,
        "joint": joints,
        "moving joint": moving,
        "revolute joint": revolute,
        "continuous joint": continuous,
        "prismatic joint": prismatic,
        "fixed joint": fixed,
    }
    expected = known_values(wanted)
    counts_of_tree = _count_parts(robot, expected)
    actual = tuple(counts_of_tree[noun] for noun in expected)
    faults = []
    texts = []
    for noun, number in expected.items():
        count = counts_of_tree[noun]
        text = counted(count, noun)
        texts.append(text)
        if count != number:
            verb = "is" if count == 1 else "are"
            faults.append(f"there {verb} {text}; there should be {number}")
    message = "; ".join(faults) if faults else f"the tree has {enumerated(texts) or 'links'}"
    return judged(not faults, message, actual, tuple(expected.values()))


def _fail_unknown_type(wrong: Joint, link: str, parent: str, *, may_be_wanted: bool) -> Outcome:
    """Fail for a joint whose type does not exist.

    Raise MissingElement where it may be the one that is asked for.
    """
    kind = f"the type {wrong.type!r}, which does not exist" if wrong.type else "no type"
    message = f"a joint between {parent!r} and {link!r} has {kind}"
    detail = f"{did_you_mean(wrong.type, JOINT_TYPES)} (joint {wrong.name!r})"
    at = place(wrong.location, "type")
    if not may_be_wanted:
        return failed(message, at, detail=detail)
    raise MissingElement("moving joint", link, message=message, detail=detail, location=at)


def _joint_above_root(
    robot: Configuration, link: str, links: Collection[str] | None
) -> Joint | None:
    """Return the nearest joint that should not be above a link.

    Of a frame, one may be if the links are named.
    """
    parent_joint = robot.parent_joints.get(link)
    if not parent_joint or not links:
        return parent_joint
    robot.find_root(link)  # raises for a loop of joints
    wrong = (
        joint for joint in reversed(robot.chain(link)) if not _is_of_frame(robot, joint, links)
    )
    return next(wrong, None)


def _is_of_frame(robot: Configuration, joint: Joint, links: Collection[str]) -> bool:
    if joint.type != "fixed" or joint.parent in links or visible(robot, joint.parent):
        return False
    return all(collision.geometry.is_empty for collision in robot.link(joint.parent).collisions)


def _driven_or_blocked(joint: Joint, link: str) -> Outcome | None:
    """Return the failure of a joint that another one moves, or that has no velocity.

    It is None if it moves by itself.
    """
    if joint.mimic:
        leader = "itself" if joint.mimic.joint == joint.name else "another joint"
        message = f"the joint that moves {link!r} mimics {leader}; it should have no <mimic>"
        detail = f" (joint {joint.name!r} mimics {joint.mimic.joint!r})"
        return failed(message, place(joint.mimic.location, "joint"), detail=detail)
    if joint.limit and joint.limit.velocity <= 0.0:  # one that ROS 2 cannot read is NaN
        message = (
            f"the velocity limit of the joint that moves {link!r} is "
            f"{number_text(joint.limit.velocity)}"
        )
        at = place(joint.limit.location, "velocity")
        return failed(f"{message}; it should be more than 0", at, detail=f" (joint {joint.name!r})")
    return None


def _is_named(robot: Configuration, name: str, link: str, parent: str) -> bool:
    named = [joint for joint in robot.known.joints if joint.name == name]
    if any(joint.child == link for joint in named):
        return True
    if not robot.robot.has_link(link):
        return False
    parent_joint = robot.parent_joints.get(link)
    if not parent_joint:
        return any(joint.parent == link for joint in named)
    is_joined = robot.robot.has_link(parent) and robot.find_root(parent) == robot.find_root(link)
    path = robot.between(parent, link) if is_joined else ()
    return any(joint.known in named for joint in (*path, parent_joint))


def _not_below(robot: Configuration, link: str, parent: str) -> Outcome:
    robot.pose(link, relative_to=parent)  # raises where no joints connect the two
    joint = robot.parent_joints.get(link)
    if not joint:  # two links of one tree, the second without a parent joint: it is above the first
        above = robot.chain(parent, above=link)
        assert above
        message = (
            f"the parent and child of a joint are swapped: {link!r} is the parent; it should be "
            "the child"
        )
        return failed(message, place(above[0].location), detail=f" (joint {above[0].name!r})")
    message = f"the parent of {link!r} is {joint.parent!r}; it should be {parent!r}"
    return failed(
        message, place(joint.location, "link", "parent"), detail=f" (joint {joint.name!r})"
    )


def _count_parts(robot: Configuration, nouns: Collection[str]) -> Counter[str]:
    """Return the numbers of links and joints by kind in the largest tree.

    Raise NotDecided if xacro leaves one open.
    """
    tree = robot.main_tree
    part_counts = Counter({"link": len(tree), "joint": max(0, len(tree) - 1)})
    if {"link", "joint"}.issuperset(nouns):
        return part_counts
    for link in tree[1:]:
        joint = robot.parent_joints[link]
        part_counts[f"{joint.type} joint"] += 1
        if joint.type != "fixed" and not joint.mimic:
            part_counts["moving joint"] += 1
    return part_counts
