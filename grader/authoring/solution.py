"""The reference solution that a rubric is made from, in the order in which its facts are listed."""

from collections.abc import Mapping
from functools import cached_property

from grader.robot.kinematics import Configuration
from grader.robot.model import Joint, Link
from grader.robot.reader import Reading
from grader.submission.submission import Submission


class Solution:
    """A solution that ROS 2 loads: its submission, its URDF as it was read, and its robot with the joints at 0."""

    def __init__(self, submission: Submission, reading: Reading, robot: Configuration) -> None:
        self.submission, self.reading, self.robot = submission, reading, robot

    @cached_property
    def links(self) -> tuple[Link, ...]:
        """Its links, each after its parent, and before the next child of that."""
        children: dict[str, list[str]] = {}
        for joint in self.robot.robot.joints:
            children.setdefault(joint.parent, []).append(joint.child)
        waiting, found = [self.root], []
        while waiting:
            found.append(self.robot.link(waiting.pop()))
            waiting += reversed(children.get(found[-1].name, []))
        return tuple(found)

    @property
    def root(self) -> str:
        """The link that has no parent joint."""
        return self.robot.main_tree[0]

    @property
    def joints(self) -> Mapping[str, Joint]:
        """The parent joints, by the link below."""
        return self.robot.parent_joints

    @property
    def moving_joints(self) -> tuple[Joint, ...]:
        """The joints that are not fixed, in the order of the links that they move."""
        above = (self.joints.get(link.name) for link in self.links)
        return tuple(joint for joint in above if joint is not None and joint.type != "fixed")

    @cached_property
    def tips(self) -> tuple[str, ...]:
        """The last links of the chains that move."""
        inner = {joint.parent for joint in self.joints.values()}
        ends = (link.name for link in self.links if link.name not in inner)
        return tuple(name for name in ends if any(it.type != "fixed" for it in self.robot.chain(name) or ()))
