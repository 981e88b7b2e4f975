"""The frame of each link: forward kinematics down the tree, and why a pose is undefined."""

from collections.abc import Mapping
from math import isfinite
from typing import NamedTuple

from grader.errors import MissingElement
from grader.robot.model import Joint, Robot
from grader.robot.motion import after_joint
from grader.robot.positions import Positions
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
    """The frames of a robot's links. Each is computed once, when it is asked for, from the nearest known one above."""

    def __init__(self, robot: Robot, parents: Mapping[str, Joint], positions: Positions) -> None:
        self._robot, self._parents, self._positions = robot, parents, positions
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
                raise self._on_loop(link, name, joints)
            joints[name] = parents[name]
            name = parents[name].parent
        frame = known.get(name) or known.setdefault(name, Frame(name, name, IDENTITY, 0))
        for joint in reversed(joints.values()):
            pose = after_joint(frame.pose, joint, self._positions.of(joint))
            if pose is not None and isfinite(sum(pose.translation)):
                frame = Frame(frame.root, frame.group, pose, frame.depth)
            else:
                frame = Frame(frame.root, joint.child, IDENTITY, frame.depth + 1)
            known[joint.child] = frame
        return frame

    def _on_loop(self, link: str, name: str, joints: Mapping[str, Joint]) -> MissingElement:
        loop = self._loops.get(name) or min(joints)
        self._loops.update(dict.fromkeys(joints, loop))
        message = f"link {quoted(link)} is on or below a loop of joints, so it is in no tree"
        return MissingElement("connection", loop, message=message, location=self._robot.link(link).location)


def undefined_pose(joint: Joint) -> MissingElement:
    """Return the error for a pose that is undefined because of this joint."""
    location, attribute, inside = joint.axis_location, "xyz", ""
    if joint.origin is None:
        reason = "the joint's origin cannot be read"
        location, attribute, inside = joint.location, "", "origin"
    elif joint.axis is None:
        reason = "the joint's axis cannot be read"
    elif unit(joint.axis) is None:
        reason = "the joint's axis is 0 0 0"
    else:
        reason = "the joint's numbers are too large"
        location, attribute = joint.location, ""
    message, detail = f"the pose is undefined: {reason}", f" (joint {quoted(joint.name)})"
    at = location._replace(attribute=attribute or None, inside=inside or None) if location is not None else None
    return MissingElement("pose below joint", joint.name, message=message, detail=detail, location=at)
