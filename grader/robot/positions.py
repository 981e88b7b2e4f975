"""The position of each joint: given, mimicked or 0."""

from collections.abc import Mapping

from grader.robot.model import Joint, Robot
from grader.robot.motion import Position


class Positions:
    """The positions of a robot's joints, radians or metres; a mimic joint follows, unless it has a position of its own."""

    def __init__(self, robot: Robot, given: Mapping[str, Position]) -> None:
        self._robot = robot
        self._given = given
        self._mimicked: dict[str, float] = {}

    def of(self, joint: Joint) -> Position:
        """Return the position of a joint: its own, that of the joint that it mimics, or 0."""
        if joint.mimic is None or joint.name in self._given:
            return self._given.get(joint.name, 0.0)
        return self._follow(joint)

    def _follow(self, joint: Joint) -> float:
        """Return a mimic joint's position, keeping those of the joints between: long chains are followed once.

        It is 0 if the chain of mimics ends at a joint that does not exist or has no single number, or forms a loop.
        """
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
