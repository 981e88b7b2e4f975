"""Forward kinematics: the pose of every link with the joints at given positions."""

from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from itertools import takewhile
from math import isfinite
from typing import NamedTuple

from grader.errors import MissingElement
from grader.robot.frames import Frames, check_position, motion_of, undefined_pose
from grader.robot.joints import MOVING_TYPES
from grader.robot.model import Joint, Link, Robot, Visual
from grader.robot.transforms import IDENTITY, Transform, Vector, unit
from grader.robot.tree import parent_joints
from grader.text import quoted


class _Views(NamedTuple):
    """What the configurations of a robot share: the robot and its parent joints, as checks read them and as known."""

    robot: Robot
    parent_joints: Mapping[str, Joint]
    known_parents: Mapping[str, Joint]


def _views_of(known: Robot, *, is_guarded: bool) -> _Views:
    parents = parent_joints(known)
    if not is_guarded:
        return _Views(known, parents, parents)
    from grader.robot.open_values import guarded  # late: few robots have open values

    return _Views(*guarded(known, parents), parents)


@dataclass(frozen=True, eq=False, repr=False)
class Configuration:
    """A robot with its joints at `positions`: where each link is, relative to any other.

    Checks get one with all joints at 0 and ask it for poses and axes; `moved` and `at` return the same robot with its
    joints elsewhere. A mimic joint follows its leader, unless it has a position itself. Planar and floating joints stay
    at 0. Links without a parent joint are roots, so a forest is solved tree by tree. Every link is solved once: linear
    in the number of links, without recursion.

    >>> from grader.robot.model import Joint, Link, Origin, Robot
    >>> arm = Joint("shoulder", "prismatic", "base", "arm", Origin((0.0, 0.0, 0.5)))
    >>> robot = Configuration(Robot("r", (Link("base"), Link("arm")), (arm,)))
    >>> robot.pose("arm", relative_to="base").translation
    (0.0, 0.0, 0.5)
    >>> robot.moved("shoulder", 0.25).pose("arm").translation
    (0.25, 0.0, 0.5)

    Raises MissingElement for a position of a joint that is not there, ValueError for one that it cannot have.
    """

    known: Robot  # as it was read: its open values can be read
    positions: Mapping[str, float] = field(default_factory=dict)  # radians or metres; the other joints are at 0
    is_guarded: bool = field(default=False, kw_only=True)  # reading what is open in `robot` raises NotDecided
    shown: dict[str, tuple[Visual, ...]] = field(default_factory=dict, init=False)  # a cache for the checks of visuals
    _relative: dict[tuple[str, str | None], Transform] = field(default_factory=dict, init=False)
    _shared: "_Views | None" = field(default=None, kw_only=True)  # of a configuration that differs in positions only

    def __post_init__(self) -> None:
        if self._shared is None:
            for name, position in self.positions.items():
                check_position(self.known.joint(name), position)

    @cached_property
    def _views(self) -> "_Views":
        return self._shared or _views_of(self.known, is_guarded=self.is_guarded)

    @cached_property
    def _frames(self) -> Frames:
        return Frames(self.known, self.known_parents, self.positions)

    @property
    def robot(self) -> Robot:
        """The robot as checks read it."""
        return self._views.robot

    @property
    def parent_joints(self) -> Mapping[str, Joint]:
        """The parent joints of links as checks read them; a root has none."""
        return self._views.parent_joints

    @property
    def known_parents(self) -> Mapping[str, Joint]:
        """The parent joints of links as they are known."""
        return self._views.known_parents

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
            raise undefined_pose(self.known_parents[deeper.group], self.known)
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
        return Configuration(self.known, positions, is_guarded=self.is_guarded, _shared=self._views)

    def displacement(self, link: str, joint: Joint, angle: float, *, relative_to: str) -> Transform:
        """Return the motion of points on a link when a turning or sliding joint moves by `angle` (rad, m) from here.

        Both the points and the motion are in the frame of `relative_to`.
        """
        self.axis(joint)  # raises where it has no direction
        chain = self.chain(link, above=relative_to) or ()
        if joint in chain and not self.positions and all(above.known.mimic is None for above in chain):
            T_relative_joint = self.pose(joint.child, relative_to=relative_to)
            turn = motion_of(joint, angle) or IDENTITY  # everything below the joint turns together
            return T_relative_joint @ turn @ T_relative_joint.inverse()
        moved = self.moved(joint, self.position(joint) + angle).pose(link, relative_to=relative_to)
        return moved @ self.pose(link, relative_to=relative_to).inverse()

    def position(self, joint: Joint) -> float:
        """Return the position of a joint: its own, that of the joint that it mimics, or 0."""
        return self._frames.position(joint.known)


def last_moving(path: tuple[Joint, ...], link: str, types: Collection[str], message: str) -> Joint:
    """Return the last joint with one of the types on the path to a link; raises MissingElement where there is none."""
    moving = [joint for joint in path if joint.type in types]
    if not moving:
        raise MissingElement("moving joint", link, message=message, location=path[-1].location if path else None)
    return moving[-1]
