"""Forward kinematics: the pose of every link with the joints at given positions."""

from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import takewhile
from math import isfinite

from grader.errors import MissingElement
from grader.robot.frames import Frames, check_position, motion_of, undefined_pose
from grader.robot.joints import MOVING_TYPES
from grader.robot.model import Joint, Link, Robot, Visual
from grader.robot.transforms import IDENTITY, Transform, Vector, unit
from grader.robot.tree import parent_joints
from grader.text import quoted


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Configuration:
    """A robot with its joints at `positions`: radians or metres; the joints that are not named are at 0.

    A mimic joint follows, unless it is named itself. Planar and floating joints stay at 0. Links without a parent joint
    are roots, so a forest is solved tree by tree. Every link is solved once: linear in the number of links, without
    recursion.
    """

    known: Robot
    robot: Robot
    is_guarded: bool
    positions: Mapping[str, float]
    parent_joints: Mapping[str, Joint]
    shown: dict[str, tuple[Visual, ...]]  # a cache for the checks of what a link shows
    holding: Mapping[str, Joint]  # the parent joints as they are known
    _frames: Frames
    _relative: dict[tuple[str, str | None], Transform]

    def __init__(
        self,
        robot: Robot,
        positions: Mapping[str, float] | None = None,
        *,
        holding: Mapping[str, Joint] | None = None,
        is_guarded: bool = False,
    ) -> None:
        """`robot` becomes `known`. With `is_guarded`, reading what xacro leaves open in `self.robot` raises NotDecided.

        `holding` is parent_joints(robot), if it is known already; positions are not validated then.

        Raises MissingElement for a joint that is not there, ValueError for a position that it cannot have.
        """
        known, positions = robot, dict(positions or {})
        parents = found = parent_joints(known) if holding is None else holding
        if is_guarded:
            from grader.robot.open_values import guarded  # late: few robots have open values

            robot, joints = guarded(known)
            own = {id(old): joint for old, joint in zip(known.joints, joints, strict=True)}
            parents = {child: own[id(joint)] for child, joint in found.items()}
        if holding is None:
            for name, position in positions.items():
                check_position(known.joint(name), position)
        _frames = Frames(known, found, positions)
        vars(self).update(known=known, robot=robot, positions=positions, parent_joints=parents, shown={})
        vars(self).update(is_guarded=is_guarded, holding=found, _frames=_frames, _relative={})

    def link(self, name: str) -> Link:
        """Return the link of this name; raises MissingElement."""
        return self.robot.link(name)

    def joint(self, name: str) -> Joint:
        """Return the joint of this name; raises MissingElement."""
        return self.robot.joint(name)

    @property
    def roots(self) -> tuple[str, ...]:
        """The links without a parent joint, in file order."""
        return tuple(link.name for link in self.robot.links if link.name not in self.parent_joints)

    @property
    def main_tree(self) -> tuple[str, ...]:
        """The links of the largest tree, its root first; empty if every link is in a loop."""
        trees: dict[str, list[str]] = {root: [root] for root in self.roots}
        for name in self.parent_joints:
            with suppress(MissingElement):
                trees[self.root_of(name)].append(name)
        largest = max(trees.values(), key=len, default=[])
        return tuple(largest)

    def root_of(self, link: str) -> str:
        """Return the root of the tree that a link is in; raises MissingElement for a link on a loop of joints."""
        return self._frames.of(link).root

    def pose(self, link: str, *, relative_to: str | None = None) -> Transform:
        """Return T_root_link, or T_relative_link: the link's frame in another link's frame.

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
        frame = self._frames.of(link)
        base = self._frames.of(relative_to if relative_to is not None else frame.root)
        if frame.root != base.root:
            self.known.check_complete()
            roots = " and ".join(sorted((frame.root, base.root)))
            message = f"no chain of joints leads from {quoted(relative_to or base.root)} to {quoted(link)}"
            raise MissingElement("connection", roots, message=message, location=self.link(link).location)
        if frame.group != base.group:
            deeper = max(frame, base, key=lambda either: either.depth)  # the chain crosses into the deeper group
            raise undefined_pose(self.holding[deeper.group], self.known)
        if relative_to is None or relative_to == frame.group:
            return frame.pose
        pose = base.pose.inverse() @ frame.pose
        if not isfinite(sum(pose.translation)):
            raise undefined_pose(self.between(relative_to, link)[-1], self.robot)
        return pose

    def axis(self, joint: str | Joint) -> Vector:
        """Return the unit axis of a joint in its child link's frame; raises MissingElement if it has no direction."""
        found = self.joint(joint) if isinstance(joint, str) else joint
        direction = unit(found.axis) if found.axis is not None else None
        if direction is None:
            raise undefined_pose(found, self.robot)
        return direction

    def chain(self, link: str, *, above: str | None = None) -> tuple[Joint, ...] | None:
        """Return the joints that lead to a link, top down, from its root or from `above`; None if that is not above it.

        Raises MissingElement for a link that is not there, NotDecided where the type of one of the joints is not known.
        """
        self.link(link)
        joints: list[Joint] = []
        name = link
        while name != above and name in self.parent_joints and len(joints) <= len(self.parent_joints):
            joints.append(self.parent_joints[name])
            name = self.parent_joints[name].parent
        if above is not None and name != above:
            self.link(above)
            return None
        for joint in joints if self.robot.rejected else ():
            if "@type" in joint.unresolved:
                joint.unresolved["@type"].check()
        return tuple(reversed(joints))

    def between(self, one: str, other: str) -> tuple[Joint, ...]:
        """Return the joints on the path from one link to another; raises MissingElement where there is no path."""
        below = self.chain(other, above=one)
        if below is not None:
            return below
        up, down = self.chain(one) or (), self.chain(other) or ()
        if self.root_of(one) != self.root_of(other):
            self.pose(other, relative_to=one)
        shared = sum(1 for _ in takewhile(lambda pair: pair[0] is pair[1], zip(up, down, strict=False)))
        return (*reversed(up[shared:]), *down[shared:])

    def moving_joint(self, link: str) -> Joint:
        """Return the joint that moves a link: the last joint above it that is not fixed.

        Raises MissingElement where nothing above it moves, NotDecided where the type of a joint above it is not known.
        """
        path = self.chain(link) or ()
        types = {joint.type for joint in path} - {"fixed"}
        if not types:
            self.known.check_complete()
        joint = last_moving(path, link, types, f"no joint above {quoted(link)} moves; one should turn or slide")
        if joint.type in MOVING_TYPES:
            return joint
        kind = f"the type {quoted(joint.type)}, which does not exist" if joint.type else "no type"
        message, at = f"the joint that moves {quoted(link)} has {kind}", joint.location
        raise MissingElement("moving joint", link, message=message, location=at and at._replace(attribute="type"))

    def moved(self, joint: str | Joint, position: float) -> "Configuration":
        """Return the same robot with one joint elsewhere; raises ValueError for a position that it cannot have."""
        found = self.joint(joint) if isinstance(joint, str) else joint
        check_position(found, position)
        return self.at({**self.positions, found.name: position})

    def at(self, positions: Mapping[str, float]) -> "Configuration":
        """Return the same robot with its joints at other positions, which are not validated."""
        return Configuration(self.known, positions, holding=self.holding, is_guarded=self.is_guarded)

    def displacement(self, link: str, joint: Joint, angle: float, *, relative_to: str) -> Transform:
        """Return the motion of points on a link when a turning or sliding joint moves by `angle` (rad, m) from here.

        Both the points and the motion are in the frame of `relative_to`.
        """
        self.axis(joint)  # raises where it has no direction
        chain = self.chain(link, above=relative_to) or ()
        if joint in chain and not self.positions and all(self.as_known(above).mimic is None for above in chain):
            T_relative_joint = self.pose(joint.child, relative_to=relative_to)
            turn = motion_of(joint, angle) or IDENTITY  # everything below the joint turns together
            return T_relative_joint @ turn @ T_relative_joint.inverse()
        moved = self.moved(joint, self.position(joint) + angle).pose(link, relative_to=relative_to)
        return moved @ self.pose(link, relative_to=relative_to).inverse()

    def position(self, joint: Joint) -> float:
        """Return the position of a joint: its own, that of the joint that it mimics, or 0."""
        return self._frames.position(self.as_known(joint))

    def as_known(self, joint: Joint) -> Joint:
        """Return a parent joint as it is known, for code that decides itself what is open."""
        return self.holding[joint.child] if self.parent_joints.get(joint.child) is joint else joint


def last_moving(path: tuple[Joint, ...], link: str, types: Collection[str], message: str) -> Joint:
    """Return the last joint with one of the types on the path to a link; raises MissingElement where there is none."""
    moving = [joint for joint in path if joint.type in types]
    if not moving:
        raise MissingElement("moving joint", link, message=message, location=path[-1].location if path else None)
    return moving[-1]
