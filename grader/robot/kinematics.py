"""Forward kinematics: where every link is when the joints are at given positions."""

from collections.abc import Mapping
from math import isfinite
from typing import NamedTuple

from grader.errors import MissingElement
from grader.robot.model import Joint, Link, Robot, Visual
from grader.robot.motion import Position, check_position, motion_of, past
from grader.robot.parent_joints import holding_joints
from grader.robot.transforms import IDENTITY, Transform, Vector, unit
from grader.source import Spot
from grader.text import quoted


class Configuration:
    """A robot with its joints at `positions`: radians or metres; the joints that are not named are at 0.

    A planar joint takes x, y (metres in the plane across its axis) and an angle; a floating joint takes x, y, z, roll,
    pitch, yaw. A mimic joint follows, unless it is named itself. Links that no joint leads to are roots, so a forest is
    solved tree by tree. Every link is solved once: linear in the number of links, without recursion.
    """

    def __init__(
        self,
        robot: Robot,
        positions: Mapping[str, Position] | None = None,
        *,
        holding: Mapping[str, Joint] | None = None,
    ) -> None:
        """`holding` is holding_joints(robot), if it is known already; positions are taken as checked then.

        Raises MissingElement for a joint that is not there, ValueError for a position of the wrong shape.
        """
        self.robot = robot
        self.positions = dict(positions or {})
        self.holding = holding_joints(robot) if holding is None else holding
        self._relative: dict[tuple[str, str | None], Transform] = {}
        if holding is None:
            for name, position in self.positions.items():
                check_position(robot.joint(name), position)
        self.shown: dict[str, tuple[Visual, ...]] = {}  # kept by those who ask what a link shows
        self._placed: dict[str, _Placed] = {}
        self._lost: dict[str, str] = {}  # links on or behind a loop of joints, with one name for the loop
        self._followed: dict[str, float] = {}

    def link(self, name: str) -> Link:
        """The link of this name; raises MissingElement."""
        return self.robot.link(name)

    def joint(self, name: str) -> Joint:
        """The joint of this name; raises MissingElement."""
        return self.robot.joint(name)

    @property
    def roots(self) -> tuple[str, ...]:
        """The links that no joint holds, in file order."""
        return tuple(link.name for link in self.robot.links if link.name not in self.holding)

    def root_of(self, link: str) -> str:
        """The root of the tree that a link belongs to; raises MissingElement for a link on a loop of joints."""
        return self._place(link).root

    def pose(self, link: str, *, relative_to: str | None = None) -> Transform:
        """T_root_link, or T_relative_link: the link's frame in another link's frame.

        Raises MissingElement where there is no such link, no chain of joints between the two, or no defined pose
        (an axis of length zero, an origin that cannot be read).
        """
        known = self._relative.get((link, relative_to))
        if known is None:
            known = self._relative[link, relative_to] = self._solve_relative(link, relative_to)
        return known

    def _solve_relative(self, link: str, relative_to: str | None) -> Transform:
        if relative_to == link:
            self.link(link)
            return IDENTITY
        ours = self._place(link)
        theirs = self._place(relative_to) if relative_to is not None else self._place(ours.root)
        if ours.root != theirs.root:
            roots = " and ".join(sorted((ours.root, theirs.root)))
            message = f"no chain of joints leads from {quoted(relative_to or theirs.root)} to {quoted(link)}"
            raise MissingElement("connection", roots, message=message, location=_spot(self.link(link)))
        if ours.island != theirs.island:
            deeper = max(ours, theirs, key=lambda each: each.depth)  # the way crosses into the deeper island
            raise _undefined(self.holding[deeper.island])
        if relative_to is None or relative_to == ours.island:
            return ours.pose
        pose = theirs.pose.inverse() @ ours.pose
        if not isfinite(sum(pose.translation)):
            raise _undefined(self.between(relative_to, link)[-1])
        return pose

    def axis(self, joint: str | Joint) -> Vector:
        """The unit axis of a joint in its child link's frame; raises MissingElement where it has no direction."""
        found = self.joint(joint) if isinstance(joint, str) else joint
        direction = unit(found.axis) if found.axis is not None else None
        if direction is None:
            raise _undefined(found)
        return direction

    def chain(self, link: str, *, above: str | None = None) -> tuple[Joint, ...] | None:
        """The joints that lead to a link, top down, from its root or from the link `above`; None if that is not above."""
        self.link(link)
        joints: list[Joint] = []
        name = link
        while name != above and name in self.holding and len(joints) <= len(self.holding):
            joints.append(self.holding[name])
            name = self.holding[name].parent
        if above is not None and name != above:
            self.link(above)
            return None
        return tuple(reversed(joints))

    def between(self, one: str, other: str) -> tuple[Joint, ...]:
        """The joints on the way from one link to another; raises MissingElement where there is no way."""
        below = self.chain(other, above=one)
        if below is not None:
            return below
        up, down = self.chain(one) or (), self.chain(other) or ()
        if self.root_of(one) != self.root_of(other):
            self.pose(other, relative_to=one)
        shared = 0
        while shared < min(len(up), len(down)) and up[shared] is down[shared]:
            shared += 1
        return (*reversed(up[shared:]), *down[shared:])

    def moved(self, joint: str | Joint, position: Position) -> "Configuration":
        """The same robot with one joint elsewhere; raises ValueError for a position that it cannot have."""
        found = self.joint(joint) if isinstance(joint, str) else joint
        check_position(found, position)
        return Configuration(self.robot, {**self.positions, found.name: position}, holding=self.holding)

    def displacement(self, link: str, joint: Joint, angle: float, *, relative_to: str) -> Transform:
        """Where points on a link go, both seen from another link, when a joint that turns or slides moves by `angle` from here."""
        self.axis(joint)  # raises where it has no direction
        way = self.chain(link, above=relative_to) or ()
        if joint in way and not self.positions and all(each.mimic is None for each in way):
            T_relative_joint = self.pose(joint.child, relative_to=relative_to)  # what is behind the joint turns as one
            turn = motion_of(joint, angle)
            return T_relative_joint @ (turn or IDENTITY) @ T_relative_joint.inverse()
        position = self.position(joint)
        assert isinstance(position, int | float)  # its position is one number
        moved = self.moved(joint, position + angle).pose(link, relative_to=relative_to)
        return moved @ self.pose(link, relative_to=relative_to).inverse()

    def position(self, joint: Joint) -> Position:
        """Where a joint is: its own position, that of the joint that it mimics, or 0."""
        if joint.mimic is None or joint.name in self.positions:
            return self.positions.get(joint.name, 0.0)
        return self._mimicked(joint)

    def _mimicked(self, joint: Joint) -> float:
        """A mimic joint's position. What is found on the way is kept: long chains are followed once."""
        way: list[Joint] = []
        followed: set[str] = set()
        value = (
            0.0  # of a joint that does not exist or is not moved by one number, and of joints that go round in a circle
        )
        while joint.name not in followed:
            own = self._followed.get(joint.name, self.positions.get(joint.name))
            if own is not None or joint.mimic is None:
                value = own if isinstance(own, int | float) else 0.0
                break
            way.append(joint)
            followed.add(joint.name)
            if not self.robot.has_joint(joint.mimic.joint):
                break
            joint = self.joint(joint.mimic.joint)
        else:
            self._followed.update(dict.fromkeys(followed, 0.0))
            return 0.0
        for each in reversed(way):
            assert each.mimic is not None  # only such joints are put on the way
            value = self._followed[each.name] = each.mimic.multiplier * value + each.mimic.offset
        return value

    def _place(self, link: str) -> "_Placed":
        """Where a link is. Links are placed when they are asked for, each once, from the nearest placed link above.

        Behind a joint with an undefined pose a new island begins: the poses behind it are still known relative to each
        other, and one defect does not hide another.
        """
        found = self._placed.get(link)
        return found if found is not None else self._solve(link)

    def _solve(self, link: str) -> "_Placed":
        self.link(link)
        holding, placed = self.holding, self._placed
        way: dict[str, Joint] = {}
        name = link
        while name not in placed and name in holding:
            if name in self._lost or name in way:
                raise self._lose(link, name, way)
            way[name] = holding[name]
            name = holding[name].parent
        above = placed.get(name) or placed.setdefault(name, _Placed(name, name, IDENTITY, 0))
        for joint in reversed(way.values()):
            pose = past(above.pose, joint, self.position(joint))
            if pose is not None and isfinite(sum(pose.translation)):
                above = _Placed(above.root, above.island, pose, above.depth)
            else:
                above = _Placed(above.root, joint.child, IDENTITY, above.depth + 1)
            placed[joint.child] = above
        return above

    def _lose(self, link: str, name: str, way: Mapping[str, Joint]) -> MissingElement:
        loop = self._lost.get(name) or min(way)
        self._lost.update(dict.fromkeys(way, loop))
        message = f"link {quoted(link)} hangs on a loop of joints: it is in no tree"
        return MissingElement("connection", loop, message=message, location=_spot(self.link(link)))


class _Placed(NamedTuple):
    """Where a link is: the root of its tree, the link from which its pose is measured, T_island_link, and how many
    islands are above its own.
    """

    root: str
    island: str
    pose: Transform
    depth: int


def _undefined(joint: Joint) -> MissingElement:
    mark, attribute, inside = joint.mark, None, None
    if joint.origin is None:
        reason = "its origin cannot be read"
        inside = "origin"
    elif joint.axis is None:
        reason = "its axis cannot be read"
        mark, attribute = joint.axis_mark, "xyz"
    elif unit(joint.axis) is None:
        reason = "its axis is 0 0 0"
        mark, attribute = joint.axis_mark, "xyz"
    else:
        reason = "its numbers are too large"
    message, detail = f"the pose of a joint's child is undefined: {reason}", f" (joint {quoted(joint.name)})"
    spot = Spot(mark, attribute, inside) if mark is not None else None
    return MissingElement("pose behind joint", joint.name, message=message, detail=detail, location=spot)


def _spot(link: Link) -> Spot | None:
    return Spot(link.mark) if link.mark is not None else None
