"""The position of each joint and the frame of each link: forward kinematics down the tree, and why a pose is undefined."""

from collections.abc import Mapping
from math import isfinite
from typing import NamedTuple

from grader.errors import MissingElement
from grader.robot.model import Joint, Robot
from grader.robot.motion import Position, after_joint
from grader.robot.transforms import IDENTITY, Transform, unit
from grader.text import quoted


class Frame(NamedTuple):
    """The frame of a link, as a pose in its frame group.

    After a joint with an undefined pose a new group begins: the poses in it are still defined relative to each other, and one
    defect does not hide another.
    """

    root: str
    group: str  # the link that poses are relative to: the root, or the child of a joint with an undefined pose
    pose: Transform  # T_group_link
    depth: int  # the number of groups above


class Frames:
    """The frames of a robot's links, with its joints at the `given` positions (rad or m) or at 0.

    Each is computed once, when it is asked for, from the nearest known one above.
    """

    def __init__(self, robot: Robot, parents: Mapping[str, Joint], given: Mapping[str, Position]) -> None:
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
            pose = after_joint(frame.pose, joint, self.position(joint))
            if pose is not None and isfinite(sum(pose.translation)):
                frame = Frame(frame.root, frame.group, pose, frame.depth)
            else:
                frame = Frame(frame.root, joint.child, IDENTITY, frame.depth + 1)
            known[joint.child] = frame
        return frame

    def position(self, joint: Joint) -> Position:
        """Return the position of a joint: its own, that of the joint that it mimics, or 0."""
        if joint.mimic is None or joint.name in self._given:
            return self._given.get(joint.name, 0.0)
        # It is 0 if the chain of mimics ends at a joint that does not exist or has no single number, or forms a loop. The
        # positions of the joints between are kept: long chains are followed once.
        followers: dict[str, Joint] = {}
        value = 0.0
        while joint.name not in followers:
            own = self._mimicked.get(joint.name, self._given.get(joint.name))
            if own is not None or joint.mimic is None:
                value = own if isinstance(own, int | float) else 0.0
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


def undefined_pose(joint: Joint) -> MissingElement:
    """Return the error for a pose that is undefined because of this joint."""
    at = joint.axis_location and joint.axis_location._replace(attribute="xyz")
    if joint.origin is None:
        reason, at = "its origin cannot be read", joint.location and joint.location._replace(inside="origin")
    elif joint.axis is None:
        reason = "its axis cannot be read"
    elif unit(joint.axis) is None:
        reason = "its axis is 0 0 0"
    else:
        reason, at = "its numbers are too large", joint.location
    message, detail = f"the pose of a joint's child is undefined: {reason}", f" (joint {quoted(joint.name)})"
    return MissingElement("pose below joint", joint.name, message=message, detail=detail, location=at)
