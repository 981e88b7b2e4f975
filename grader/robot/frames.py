"""The motion of each joint and the frame of each link: forward kinematics down the tree; why a pose is undefined."""

from collections.abc import Iterable, Mapping
from math import isfinite, nan
from typing import NamedTuple

from grader.errors import MissingElement
from grader.robot.joints import MOVING_TYPES
from grader.robot.model import Joint, Origin, Robot
from grader.robot.transforms import IDENTITY, Transform, Vector, rotation_about, rotation_from_rpy, unit
from grader.text import quoted

SINGLE = ("revolute", "continuous", "prismatic")  # the types of joints that a position moves


class Frame(NamedTuple):
    """The frame of a link, as a pose in its frame group.

    After a joint with an undefined pose a new group begins: the poses in it are still defined relative to each other,
    and one defect does not hide another.
    """

    root: str
    group: str  # the link that poses are relative to: the root, or the child of a joint with an undefined pose
    pose: Transform  # T_group_link
    depth: int  # the number of groups above


class Frames:
    """The frames of a robot's links, with its joints at the `given` positions (rad or m) or at 0.

    Each is computed once, when it is asked for, from the nearest known one above.
    """

    def __init__(self, robot: Robot, parents: Mapping[str, Joint], given: Mapping[str, float]) -> None:
        self._robot, self._parents, self._given = robot, parents, given
        self._mimicked: dict[str, float] = {}  # the positions of mimic joints
        self._known: dict[str, Frame] = {}
        self._loops: dict[str, str] = {}  # links on or below a loop of joints, with one link's name for the loop

    def of(self, link: str) -> Frame:
        """Return the frame of a link; raises MissingElement where it is not there, or in no tree."""
        found = self._known.get(link)
        return found if found is not None else self._solve(link)

    def _solve(self, link: str) -> Frame:
        self._robot.link(link)
        parents, known = self._parents, self._known
        joints: dict[str, Joint] = {}
        name = link
        while name not in known and name in parents:
            if name in self._loops or name in joints:
                loop = self._loops.get(name) or min(joints)
                self._loops.update(dict.fromkeys(joints, loop))
                message = f"link {quoted(link)} is on or below a loop of joints, so it is in no tree"
                raise MissingElement("connection", loop, message=message, location=self._robot.link(link).location)
            joints[name] = parents[name]
            name = parents[name].parent
        frame = known.get(name) or known.setdefault(name, Frame(name, name, IDENTITY, 0))
        for joint in reversed(joints.values()):
            motion, pose = motion_of(joint, self.position(joint)), None
            if joint.origin is not None and motion is not None:
                pose = placed_by(frame.pose, joint.origin)
                pose = pose if motion is IDENTITY else pose @ motion
            if pose is not None and isfinite(sum(pose.translation)):
                frame = Frame(frame.root, frame.group, pose, frame.depth)
            else:
                frame = Frame(frame.root, joint.child, IDENTITY, frame.depth + 1)
            known[joint.child] = frame
        return frame

    def position(self, joint: Joint) -> float:
        """Return the position of a joint: its own, that of the joint it mimics, or 0; NaN if xacro leaves it open."""
        if joint.name in self._given or (joint.mimic is None and "mimic" not in joint.unresolved):
            return self._given.get(joint.name, 0.0)
        # It is 0 if the chain of mimics ends at a joint that does not exist, or forms a loop.
        # The positions of the joints between are kept: long chains are followed once.
        followers: dict[str, Joint] = {}
        value = 0.0
        while joint.name not in followers:
            own = self._mimicked.get(joint.name, self._given.get(joint.name))
            if own is None and "mimic" in joint.unresolved:
                value = nan
                break
            if own is not None or joint.mimic is None:
                value = own or 0.0
                break
            followers[joint.name] = joint
            if not self._robot.has_joint(joint.mimic.joint):
                break
            joint = self._robot.joint(joint.mimic.joint)
        else:
            self._mimicked.update(dict.fromkeys(followers, 0.0))
            return 0.0
        for name, follower in reversed(followers.items()):
            assert follower.mimic is not None  # no other joint is a follower
            value = self._mimicked[name] = follower.mimic.multiplier * value + follower.mimic.offset
        return value


def undefined_pose(joint: Joint, robot: Robot) -> MissingElement:
    """Return the error for a pose that this joint leaves undefined; raise NotDecided where xacro leaves it open."""
    for part in ("origin", "axis", ""):
        if part in joint.unresolved:
            joint.unresolved[part].check()
    at = joint.axis_location and joint.axis_location._replace(attribute="xyz")
    if joint.origin is None:
        reason, at = "the joint's origin cannot be read", joint.location and joint.location._replace(inside="origin")
        at = joint.unresolved["origin"].location if "origin" in joint.unresolved else at
    elif joint.axis is None:
        reason = "the joint's axis cannot be read"
    elif unit(joint.axis) is None:
        reason = "the joint's axis is 0 0 0"
    else:
        for leader in _leaders(joint, robot):
            if "mimic" in leader.unresolved:
                leader.unresolved["mimic"].check()
        reason, at = "the joint's numbers are too large", joint.location
    message, detail = f"the pose is undefined: {reason}", f" (joint {quoted(joint.name)})"
    return MissingElement("pose below joint", joint.name, message=message, detail=detail, location=at)


def _leaders(joint: Joint, robot: Robot) -> Iterable[Joint]:
    """Return a joint, the joint that it mimics, the one that this mimics, and so on."""
    found = {joint.name: joint}
    while joint.mimic is not None and joint.mimic.joint not in found and robot.has_joint(joint.mimic.joint):
        joint = robot.joint(joint.mimic.joint)
        found[joint.name] = joint
    return found.values()


def placed_by(T_frame_parent: Transform, origin: Origin) -> Transform:
    """Return T_frame_child: the frame that an origin places in its parent."""
    if origin.rpy == (0.0, 0.0, 0.0):
        return Transform(T_frame_parent.rotation, T_frame_parent.apply(origin.xyz))
    return T_frame_parent @ Transform(rotation_from_rpy(origin.rpy), origin.xyz)


def motion_of(joint: Joint, position: float) -> Transform | None:
    """Return T_origin_child; None if it is undefined, as it is for every position about a zero axis (KDL).

    A planar or floating joint stays at its origin: robot_state_publisher does not move it.
    """
    if joint.type not in MOVING_TYPES:
        return IDENTITY
    if not isfinite(position):
        return None  # a chain of mimic joints can overflow
    if joint.type == "floating":
        return IDENTITY
    direction = unit(joint.axis) if joint.axis is not None else None
    if direction is None:
        # KDL divides by the axis' length before it uses the position. An unreadable axis matters only if the joint
        # moves.
        return IDENTITY if joint.axis is None and not position else None
    return IDENTITY if joint.type == "planar" or not position else _along(joint, direction, position)


def _along(joint: Joint, direction: Vector, position: float) -> Transform:
    """Return a motion along the axis of a prismatic joint, or about that of another one."""
    if joint.type == "prismatic":
        x, y, z = direction
        return Transform(translation=(x * position, y * position, z * position))
    return Transform(rotation_about(direction, position))


def check_position(joint: Joint, position: float) -> None:
    """Raise ValueError for a position that a joint of this type cannot have."""
    if joint.type not in SINGLE:
        raise ValueError(f"joint {quoted(joint.name)} is {joint.type or 'without type'}: it cannot move")
    if not isfinite(position):
        raise ValueError(f"joint {quoted(joint.name)} cannot be at {position}")
