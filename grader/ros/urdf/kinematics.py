"""Forward kinematics: the pose of every link with the joints at given positions.

It also says why a pose is undefined.
"""

from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress
from dataclasses import field
from functools import cached_property
from math import isfinite, nan
from typing import NamedTuple, overload

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import Strings
from grader.base.records import Record
from grader.base.text import quoted
from grader.base.transforms import (
    IDENTITY,
    Transform,
    Vector,
    rotation_about,
    unit,
)
from grader.ros.urdf.joint_reader import MOVING_TYPES
from grader.ros.urdf.link_tree import parent_joints, selected_name
from grader.ros.urdf.model import Joint, Joints, Link, Robot

_Chain = tuple[Joint, ...]  # joints from one link to another

_POSE = "pose below joint"  # what is missing where a joint leaves it undefined


class _Frame(NamedTuple):
    """The frame of a link, as a pose in its frame group.

    After a joint with an undefined pose a new group begins: the poses in it are still defined
    relative to each other, and one defect does not hide another.
    """

    root: str
    # the link that poses are relative to: the root, or the child of a joint with an undefined pose
    group: str
    pose: Transform  # T_group_link
    depth: int  # the number of groups above


class _Frames:
    """The frames of a robot's links, with its joints at the `given` positions (rad or m) or at 0.

    Each is computed once, when it is asked for, from the nearest known one above.
    """

    def __init__(self, robot: Robot, parents: Joints, given: Mapping[str, float]) -> None:
        self._robot = robot
        self._parents = parents
        self._given = given
        self._mimicked: dict[str, float] = {}  # the positions of mimic joints
        self._known: dict[str, _Frame] = {}
        # links on or below a loop of joints, with one link's name for the loop
        self._loops: dict[str, str] = {}

    def of(self, link: str) -> _Frame:
        """Return the frame of a link.

        Raises MissingElement where it is not there, or in no tree.
        """
        frame = self._known.get(link)
        if frame:
            return frame
        return self._solve(link)

    def _solve(self, link: str) -> _Frame:
        self._robot.link(link)
        parents = self._parents
        known = self._known
        joints: dict[str, Joint] = {}
        name = link
        while name not in known and name in parents:
            if name in self._loops or name in joints:
                loop = self._loops.get(name) or min(joints)
                self._loops.update(dict.fromkeys(joints, loop))
                message = (
                    f"link {quoted(link)} is on or below a loop of joints, so it is in no tree"
                )
                raise MissingElement(
                    "connection", loop, message=message, location=self._robot.link(link).location
                )
            joints[name] = parents[name]
            name = parents[name].parent
        frame = known.get(name) or known.setdefault(name, _Frame(name, name, IDENTITY, 0))
        for joint in reversed(joints.values()):
            motion = _compute_motion(joint, self.position(joint))
            pose = None
            if joint.origin and motion:
                pose = joint.origin.placed_in(frame.pose)
                pose = pose if motion is IDENTITY else pose @ motion
            if pose is not None and isfinite(sum(pose.translation)):
                frame = _Frame(frame.root, frame.group, pose, frame.depth)
            else:
                frame = _Frame(frame.root, joint.child, IDENTITY, frame.depth + 1)
            known[joint.child] = frame
        return frame

    def position(self, joint: Joint) -> float:
        """Return the position of a joint: its own, that of the joint it mimics, or 0.

        Returns NaN if xacro leaves it open.
        """
        if joint.name in self._given or (not joint.mimic and "mimic" not in joint.unresolved):
            return self._given.get(joint.name, 0.0)
        # It is 0 if the chain of mimics ends at a joint that does not exist, or forms a loop.
        # The positions of the joints between are kept: long chains are followed once.
        followers = {}
        value = 0.0
        while joint.name not in followers:
            given = self._mimicked.get(joint.name, self._given.get(joint.name))
            if given is None and "mimic" in joint.unresolved:
                value = nan
                break
            if given is not None or not joint.mimic:
                value = given or 0.0
                break
            followers[joint.name] = joint
            if not self._robot.has_joint(joint.mimic.joint):
                break
            joint = self._robot.joint(joint.mimic.joint)
        else:
            self._mimicked.update(dict.fromkeys(followers, 0.0))
            return 0.0
        for name, follower in reversed(followers.items()):
            assert follower.mimic  # no other joint is a follower
            value = self._mimicked[name] = follower.mimic.multiplier * value + follower.mimic.offset
        return value


def _undefined_pose(joint: Joint, robot: Robot) -> MissingElement:
    """Return the error for a pose that this joint leaves undefined.

    Raises NotDecided where xacro leaves it open.
    """
    for part in ("origin", "axis", ""):
        if part in joint.unresolved:
            joint.unresolved[part].check()
    at = joint.axis_location and joint.axis_location._replace(attribute="xyz")
    if not joint.origin:
        reason = "the joint's origin cannot be read"
        if "origin" in joint.unresolved:
            at = joint.unresolved["origin"].location
        else:
            at = joint.location and joint.location._replace(inside="origin")
    elif joint.axis is None:
        reason = "the joint's axis cannot be read"
    elif unit(joint.axis) is None:
        reason = "the joint's axis is 0 0 0"
    else:
        for leader in _mimic_leaders(joint, robot):
            if "mimic" in leader.unresolved:
                leader.unresolved["mimic"].check()
        reason = "the joint's numbers are too large"
        at = joint.location
    message = f"the pose is undefined: {reason}"
    detail = f" (joint {quoted(joint.name)})"
    is_rejected = not joint.origin or joint.axis is None
    return MissingElement(
        _POSE, joint.name, message=message, detail=detail, location=at, costs_once=is_rejected
    )


def _mimic_leaders(joint: Joint, robot: Robot) -> Iterable[Joint]:
    """Return a joint, the joint that it mimics, the one that this mimics, and so on."""
    chain = {joint.name: joint}
    while joint.mimic:
        name = joint.mimic.joint
        if name in chain or not robot.has_joint(name):
            break
        joint = robot.joint(name)
        chain[joint.name] = joint
    return chain.values()


def _compute_motion(joint: Joint, position: float) -> Transform | None:
    """Return T_origin_child.

    Returns None if it is undefined, as it is for every position about a zero axis (KDL).

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
        # KDL divides by the axis' length before it uses the position. An unreadable axis matters
        # only if the joint moves.
        return IDENTITY if joint.axis is None and not position else None
    if joint.type == "planar" or not position:
        return IDENTITY
    return _motion_along(joint, direction, position)


def _motion_along(joint: Joint, direction: Vector, position: float) -> Transform:
    """Return a motion along the axis of a prismatic joint, or about that of another one."""
    if joint.type == "prismatic":
        x, y, z = direction
        return Transform(translation=(x * position, y * position, z * position))
    return Transform(rotation_about(direction, position))


def _check_position(joint: Joint, position: float) -> None:
    """Raise ValueError for a position that a joint of this type cannot have."""
    if not joint.has_position:
        raise ValueError(
            f"joint {quoted(joint.name)} is {joint.type or 'without type'}: it cannot move"
        )
    if not isfinite(position):
        raise ValueError(f"joint {quoted(joint.name)} cannot be at {position}")


class _Views(NamedTuple):
    """What the configurations of a robot share.

    This is the robot and its parent joints, as checks read them and as known.
    """

    robot: Robot
    parent_joints: Joints
    known_parents: Joints


def _make_views(known: Robot, *, is_guarded: bool) -> _Views:
    parents = parent_joints(known)
    if not is_guarded:
        return _Views(known, parents, parents)
    from grader.ros.urdf.open_values import guarded  # late: few robots have open values

    return _Views(*guarded(known, parents), parents)


class Configuration(Record):
    """A robot with its joints at positions: where each link is, relative to any other.

    A position is in radians for a joint that turns, in metres for one that slides; joints without
    one are at 0. Grading makes one of the robot that was read, with its joints at 0 or where the
    rubric says, and each check of a robot gets it; `moved` and `at` return the same robot with its
    joints elsewhere. A mimic joint follows its leader, unless it has a position itself. Planar and
    floating joints stay at 0. Links without a parent joint are roots, so a forest is solved tree by
    tree. Every link is solved once: linear in the number of links, without recursion.

    >>> from grader.ros.urdf.model import Joint, Link, Origin, Robot
    >>> arm = Joint("shoulder", "prismatic", "base", "arm", Origin((0.0, 0.0, 0.5)))
    >>> robot = Configuration(Robot("r", (Link("base"), Link("arm")), (arm,)))
    >>> robot.pose("arm", relative_to="base").translation
    (0.0, 0.0, 0.5)
    >>> robot.moved("shoulder", 0.25).pose("arm").translation
    (0.25, 0.0, 0.5)

    Raises MissingElement for a position of a joint that is not there, ValueError for one that it
    cannot have.
    """

    known: Robot  # as it was read: its open values can be read
    # radians or metres; the other joints are at 0
    positions: Mapping[str, float] = field(default_factory=dict)
    # reading what is open in `robot` raises NotDecided
    is_guarded: bool = field(default=False, kw_only=True)
    _relative: dict[tuple[str, str | None], Transform] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        for name, position in self.positions.items():
            _check_position(self.known.joint(name), position)

    @cached_property
    def _views(self) -> _Views:
        return _make_views(self.known, is_guarded=self.is_guarded)

    @cached_property
    def _frames(self) -> _Frames:
        return _Frames(self.known, self.known_parents, self.positions)

    @property
    def robot(self) -> Robot:
        """The robot as checks read it."""
        return self._views.robot

    @property
    def parent_joints(self) -> Joints:
        """The parent joints of links as checks read them; a root has none."""
        return self._views.parent_joints

    @property
    def known_parents(self) -> Joints:
        """The parent joints of links as they are known."""
        return self._views.known_parents

    def link(self, name: str) -> Link:
        """Return the link of this name; raises MissingElement."""
        return self.robot.link(name)

    def joint(self, name: str) -> Joint:
        """Return the joint of this name; raises MissingElement."""
        return self.robot.joint(name)

    @property
    def roots(self) -> Strings:
        """The links without a parent joint, in file order."""
        return tuple(link.name for link in self.robot.links if link.name not in self.parent_joints)

    @property
    def main_tree(self) -> Strings:
        """The links of the largest tree, its root first; empty if every link is in a loop."""
        trees = {root: [root] for root in self.roots}
        for name in self.parent_joints:
            with suppress(MissingElement):
                trees[self.find_root(name)].append(name)
        largest = max(trees.values(), key=len, default=[])
        return tuple(largest)

    def find_root(self, link: str) -> str:
        """Return the root of the tree that a link is in.

        Raises MissingElement for a link on a loop of joints.
        """
        return self._frames.of(link).root

    def pose(self, link: str, *, relative_to: str | None = None) -> Transform:
        """Return T_root_link, or T_relative_link: the link's frame in another link's frame.

        Raises MissingElement where there is no such link, no chain of joints between the two, or no
        defined pose (an axis of length zero, an origin that cannot be read).
        """
        pose = self._relative.get((link, relative_to))
        if not pose:
            pose = self._relative[link, relative_to] = self._solve_relative(link, relative_to)
        return pose

    def _solve_relative(self, link: str, relative_to: str | None) -> Transform:
        if relative_to == link:
            self.link(link)
            return IDENTITY
        frame = self._frames.of(link)
        base = self._frames.of(relative_to if relative_to is not None else frame.root)
        if frame.root != base.root:
            self.known.check_complete()
            roots = " and ".join(sorted((frame.root, base.root)))
            message = (
                f"{quoted(link)} is not connected to {quoted(relative_to or base.root)} by joints"
            )
            absent = f"joint of {link}" if frame.root == link and self.are_joints_in_place else ""
            at = self.link(link).location
            raise MissingElement("connection", roots, message=message, location=at, absent=absent)
        if frame.group != base.group:
            deeper = max(
                frame, base, key=lambda either: either.depth
            )  # the chain crosses into the deeper group
            raise _undefined_pose(self.known_parents[deeper.group], self.known)
        if relative_to is None or relative_to == frame.group:
            return frame.pose
        pose = base.pose.inverse() @ frame.pose
        if not isfinite(sum(pose.translation)):
            raise _undefined_pose(self.between(relative_to, link)[-1], self.robot)
        return pose

    @property
    def are_joints_in_place(self) -> bool:
        """Whether each joint connects two links that are there.

        None of them may be meant for another link.
        """
        has_link = self.known.has_link
        return all(has_link(joint.parent) and has_link(joint.child) for joint in self.known.joints)

    def axis(self, joint: str | Joint) -> Vector:
        """Return the unit axis of a joint in its child link's frame.

        Raises MissingElement if it has no direction.
        """
        if isinstance(joint, str):
            joint = self.joint(joint)
        direction = unit(joint.axis) if joint.axis is not None else None
        if direction is None:
            raise _undefined_pose(joint, self.robot)
        return direction

    @overload
    def chain(self, link: str) -> _Chain: ...

    @overload
    def chain(self, link: str, *, above: str | None) -> _Chain | None: ...

    def chain(self, link: str, *, above: str | None = None) -> _Chain | None:
        """Return the joints that lead to a link, top down, from its root or from `above`.

        Returns None if that is not above it.

        Raises MissingElement for a link that is not there, NotDecided where the type of one of the
        joints is not known.
        """
        self.link(link)
        joints: list[Joint] = []
        name = link
        while (
            name != above and name in self.parent_joints and len(joints) <= len(self.parent_joints)
        ):
            joints.append(self.parent_joints[name])
            name = self.parent_joints[name].parent
        if above is not None and name != above:
            self.link(above)
            return None
        if self.robot.rejected:
            for joint in joints:
                if "@type" in joint.unresolved:
                    joint.unresolved["@type"].check()
        return tuple(reversed(joints))

    def between(self, one: str, other: str) -> _Chain:
        """Return the joints on the path from one link to another.

        Raises MissingElement where there is no path.
        """
        below = self.chain(other, above=one)
        if below is not None:
            return below
        up = self.chain(one)
        down = self.chain(other)
        if self.find_root(one) != self.find_root(other):
            self.pose(other, relative_to=one)
        shared = 0
        while shared < min(len(up), len(down)) and up[shared] is down[shared]:
            shared += 1
        return (*reversed(up[shared:]), *down[shared:])

    def moving_joint(self, link: str) -> Joint:
        """Return the joint that moves a link: the last joint above it that is not fixed.

        Raises MissingElement where nothing above it moves, NotDecided where the type of a joint
        above it is not known.
        """
        path = self.chain(link)
        types = {joint.type for joint in path} - {"fixed"}
        if not types:
            self.known.check_complete()
        joint = _last_moving(
            path, link, types, f"no joint above {quoted(link)} moves; one should turn or slide"
        )
        if joint.type in MOVING_TYPES:
            return joint
        kind = f"the type {quoted(joint.type)}, which does not exist" if joint.type else "no type"
        message = f"the joint that moves {quoted(link)} has {kind}"
        at = joint.location
        raise MissingElement(
            "moving joint", link, message=message, location=at and at._replace(attribute="type")
        )

    def joint_between(self, one: str, other: str, types: Collection[str], message: str) -> Joint:
        """Return the last joint with one of the types on the path from one link to another.

        Raises MissingElement where there is none.
        """
        return _last_moving(self.between(one, other), other, types, message)

    def selected_name(self, name: str) -> str:
        """Return the name that a selector means, and any other text as it is.

        Raises MissingElement, NotDecided.
        """
        return selected_name(self.known, self.known_parents, name)

    def selected_or_name(self, name: str) -> str:
        """Return the link that a selector means.

        A name, or a selector that means no single link, is returned as it is.
        """
        try:
            return selected_name(self.robot, self.parent_joints, name)
        except (MissingElement, NotDecided):
            return name

    def moved(self, joint: str | Joint, position: float) -> "Configuration":
        """Return the same robot with one joint elsewhere.

        Raises ValueError for a position that it cannot have.
        """
        if isinstance(joint, str):
            joint = self.joint(joint)
        _check_position(joint, position)
        return self.at({**self.positions, joint.name: position})

    def at(self, positions: Mapping[str, float]) -> "Configuration":
        """Return the same robot with its joints at other positions, which are not validated."""
        return _MovedConfiguration(
            self.known, positions, is_guarded=self.is_guarded, shared_views=self._views
        )

    def displacement(self, link: str, joint: Joint, angle: float, *, relative_to: str) -> Transform:
        """Return the motion of points on a link when a joint moves by `angle` from here.

        The joint turns or slides; `angle` is in rad or m.

        Both the points and the motion are in the frame of `relative_to`.
        """
        self.axis(joint)  # raises where it has no direction
        chain = self.chain(link, above=relative_to) or ()
        if joint in chain and not self.positions and all(not above.known.mimic for above in chain):
            T_relative_joint = self.pose(joint.child, relative_to=relative_to)
            turn = (
                _compute_motion(joint, angle) or IDENTITY
            )  # everything below the joint turns together
            return T_relative_joint @ turn @ T_relative_joint.inverse()
        moved = self.moved(joint, self.position(joint) + angle).pose(link, relative_to=relative_to)
        return moved @ self.pose(link, relative_to=relative_to).inverse()

    def position(self, joint: Joint) -> float:
        """Return the position of a joint: its own, that of the joint that it mimics, or 0."""
        return self._frames.position(joint.known)


class _MovedConfiguration(Configuration):
    """A configuration that another one made by moving joints.

    It shares what positions do not change, and does not validate positions.
    """

    shared_views: _Views = field(kw_only=True)

    def __post_init__(self) -> None:
        pass  # the positions are those of joints of the robot

    @cached_property
    def _views(self) -> _Views:
        return self.shared_views


def _last_moving(path: _Chain, link: str, types: Collection[str], message: str) -> Joint:
    """Return the last joint with one of the types on the path to a link.

    Raises MissingElement where there is none.
    """
    moving = [joint for joint in path if joint.type in types]
    if not moving:
        raise MissingElement(
            "moving joint", link, message=message, location=path[-1].location if path else None
        )
    return moving[-1]
