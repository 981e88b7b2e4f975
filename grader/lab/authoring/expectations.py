"""The expectations of a reference: what may be true of it.

They are arguments of checks that are to be tried on it.

Here are those of the robot: its file, links, joints and tree.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import permutations
from math import degrees, isfinite
from typing import Any, NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.quantities import point
from grader.base.text import counted, enumerated
from grader.base.transforms import rotation_from_rpy
from grader.lab.checks.collisions import shape_text
from grader.lab.checks.visuals import MAX_SHAPES
from grader.lab.submission.submission import Submission
from grader.ros.package.mesh_files import mesh_file
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Joint,
    Link,
    Mesh,
    Sphere,
    Visual,
)
from grader.ros.urdf.reader import Reading
from grader.ros.xml.elements import words_of_foreign
from grader.ros.xml.parsing import Element
from grader.workspace.rules.reading import read_agreement

_THE_FILE, _THE_ROBOT = "The file", "The robot"  # headings
_COUNTED = ("revolute", "continuous", "prismatic")
_SLIDING_TOLERANCE = 0.002  # m: the tolerance of other limits is in degrees
_MASS_TOLERANCE = 0.001  # kg; of a small mass, a share of it
_MASS_SHARE = 0.01
_LOOSE_INERTIA = 5.0  # percent, for a solution with rounded numbers
_MAX_TIPS = 20
_MAX_TIPS_IN_TITLE = 2


class Solution(NamedTuple):
    """A solution: its submission, its URDF and its robot.

    The URDF is as it was read, the robot is the one that ROS 2 loads, with the joints at 0.
    """

    submission: Submission
    reading: Reading
    robot: Configuration

    @property
    def root(self) -> Element:
        """The <robot> that it was read from."""
        assert self.reading.root is not None  # ROS 2 loads it
        return self.reading.root


class CarriedExpectation(NamedTuple):
    """What makes an expectation cost nothing: others that fail, by their words, and a check."""

    causes: Sequence[str]
    check: str
    arguments: Mapping[str, Any] = {}

    def after(self, *causes: str) -> "CarriedExpectation":
        """Return the same, after more mistakes."""
        return self._replace(causes=(*self.causes, *causes))


class Expectation(NamedTuple):
    """A check with arguments that the reference may pass."""

    about: str  # the heading
    check: str
    arguments: Mapping[str, Any]
    words: str  # of the id
    # what it is about: the name of a package, empty for the main one; None for the robot
    package: str | None = None
    carried: Sequence[CarriedExpectation] = ()
    otherwise: "Sequence[Expectation]" = ()  # tried in its place if the reference does not pass it
    title: str = ""  # default: what the check says
    args: Mapping[str, str | bool] = {}  # launch arguments
    # of the look or the numbers of a robot, or of a launch file that another one includes, which a
    # lab about controllers, nodes or worlds leaves free: see `has_programs`
    is_detail: bool = False
    is_recorded: bool = False  # of a recording, whose part needs all files

    def with_arguments(self, **arguments: Any) -> "Expectation":
        """Return the expectation with more arguments, or others."""
        return self._replace(arguments={**self.arguments, **arguments})


class Omission(NamedTuple):
    """Something of the reference that no criterion is about, and why."""

    what: str
    why: str
    # what would be a criterion of it, if the reference was corrected
    expectation: Expectation | None = None


Expectations = Iterator[Expectation | Omission]


def robot_expectations(solution: Solution) -> Expectations:
    """Yield what may be true of the file, of each link with its parent joint, and of the robot."""
    robot = solution.robot
    yield Expectation(_THE_FILE, "urdf_loads", {}, "urdf_loads")
    for link in robot.robot.links:
        yield from _visual_expectations(link)
        joint = robot.parent_joints.get(link.name)
        if joint:
            try:
                yield from _joint_expectations(robot, joint)
            except (MissingElement, NotDecided) as error:  # an axis of length zero
                yield Omission(f"{link.name} joint_axis", str(error))
        yield from _body_expectations(link)
    if robot.parent_joints:
        yield from _tree_expectations(solution)


def are_joints_free(solution: Solution) -> bool:
    """Return whether joints may have other names.

    Names that files use are compared with those of the robot.
    """
    agreement = read_agreement(solution.submission.workspace)
    return agreement.holds("frames") and agreement.holds("controllers")


def _link_expectation(link: str, check: str, title: str = "", /, **arguments: Any) -> Expectation:
    return Expectation(link, check, {"link": link, **arguments}, f"{link} {check}", title=title)


def _robot_expectation(check: str, title: str = "", /, **arguments: Any) -> Expectation:
    return Expectation(_THE_ROBOT, check, arguments, check, title=title)


def longest_title(start: str, items: Sequence[str], longest: int, otherwise: str) -> str:
    """Return a title with as many items as fit into it; the other one, if none does."""
    for most in range(len(items), 0, -1):
        title = f"{start} {enumerated(items, most)}"
        if len(title) <= longest:
            return title
    return otherwise


def _rounded(vector: Iterable[float], digits: int = 6) -> list[float]:
    """Return numbers without what rounding has added: 0.15 for 0.15000000000000002."""
    return [round(value, digits) + 0.0 for value in vector]


def _visual_expectations(link: Link) -> Expectations:
    """Yield what a link shows.

    The place and colour of a shape are yielded only if no other shape of the link is of its kind.
    """
    if len(link.visuals) > MAX_SHAPES:
        yield Omission(f"{link.name} visuals", f"it has more than {MAX_SHAPES}")
        return
    shown = [visual for visual in link.visuals if not visual.geometry.is_empty]
    kinds = Counter(type(visual.geometry) for visual in shown)
    for visual in shown:
        yield _size(link.name, visual)
        if kinds[type(visual.geometry)] == 1:
            is_mesh = isinstance(visual.geometry, Mesh)
            if len(kinds) == 1 or is_mesh:
                selected = {}
            else:
                selected = {"shape": type(visual.geometry).__name__.lower()}
            if visual.material and not visual.material.texture:
                colour = _rounded(visual.material.rgba, 4)
                shown_colour = _link_expectation(
                    link.name, "shows_colour", **selected, colour=colour
                )
                yield shown_colour._replace(is_detail=True)
            if not is_mesh:
                xyz = _rounded(visual.origin.xyz)
                axis = _axis(visual)
                yield _link_expectation(
                    link.name,
                    "centre_at",
                    _centre_title(link.name, visual, xyz, axis.get("axis")),
                    **selected,
                    relative_to=link.name,
                    xyz=xyz,
                    **axis,
                )
    for kind in (kind for kind, number in kinds.items() if number > 1):
        reason = "a check examines one shape of a kind"
        yield Omission(f"place and colour of each {kind.__name__.lower()} of {link.name}", reason)


def _centre_title(
    link: str, visual: Visual, xyz: Sequence[float], axis: Sequence[float] | None
) -> str:
    """Return where the centre of a shape is, and along what its axis lies if it is a cylinder."""
    shape = type(visual.geometry).__name__.lower()
    where = f"at {point(tuple(xyz))} m in its frame" if any(xyz) else "in its frame"
    along = f" and lies along {point(tuple(axis))}" if axis is not None else ""
    return f"the {shape} of {link!r} is centred {where}{along}"


def _size(link: str, visual: Visual) -> Expectation | Omission:
    match visual.geometry:
        case Box(size=size):  # along the axes of the link, whichever of its own they are
            first, *others = [
                _link_expectation(link, "shows_box", size=_rounded(edges))
                for edges in permutations(size)
            ]
            return first._replace(otherwise=others)
        case Cylinder(radius=radius, length=length):
            return _link_expectation(
                link, "shows_cylinder", radius=round(radius, 6), length=round(length, 6)
            )
        case Sphere(radius=radius):
            return _link_expectation(link, "shows_sphere", radius=round(radius, 6))
        case Capsule():
            return Omission(f"{link} size", "no check measures a capsule that a link shows")
        case mesh:
            file = "/".join(mesh_file(mesh.filename, is_expanded=True).steps)
            xyz = _rounded(visual.origin.xyz)
            rpy = _rounded(visual.origin.rpy)
            return _link_expectation(
                link, "shows_mesh", file=file, scale=_rounded(mesh.scale), xyz=xyz, rpy=rpy
            )


def _axis(visual: Visual) -> dict[str, Any]:
    """Return how the axis of a cylinder lies: 0 1 0 for what rpy="1.57 0 0" makes of it."""
    if not isinstance(visual.geometry, Cylinder):
        return {}
    return {"axis": _rounded(rotation_from_rpy(visual.origin.rpy)[2::3], 2), "angle": 1.0}


def _body_expectations(link: Link) -> Expectations:
    """Yield the mass and inertia of a link, and its collision shapes.

    If these are those that it shows, yield that.
    """
    if link.inertial:
        least = abs(link.inertial.mass) * _MASS_SHARE
        tolerance = {"tolerance": least} if least < _MASS_TOLERANCE else {}
        yield _link_expectation(link.name, "mass_is", mass=link.inertial.mass, **tolerance)
        inertia = partial(_inertia_expectation, link.name, link.inertial.mass)
        yield inertia()._replace(otherwise=[inertia(tolerance=_LOOSE_INERTIA)])
    if len(link.collisions) > MAX_SHAPES:
        yield Omission(f"{link.name} collisions", f"it has more than {MAX_SHAPES}")
        return
    only = {"only": True} if len(link.collisions) == 1 else {}
    shapes = [_collision(link.name, collision, only) for collision in link.collisions]
    if not any(not visual.geometry.is_empty for visual in link.visuals):
        yield from shapes
    elif shapes:
        # A link that shows something else collides as the reference does.
        checks = ("shows_box", "shows_cylinder", "shows_sphere", "centre_at")
        what_is_shown = [f"{link.name} {check}" for check in checks]
        known = [
            CarriedExpectation(what_is_shown, shape.check, shape.arguments)
            for shape in shapes
            if only and shape.check == "collides_as"
        ]
        shown = "shape" if len(shapes) == 1 else "shapes"
        title = f"{link.name!r} collides with the {shown} that it shows"
        match = _link_expectation(link.name, "collision_matches_visual", title)
        yield match._replace(otherwise=shapes if only else (), carried=known)


def _inertia_expectation(link: str, mass: float, **tolerance: float) -> Expectation:
    """Return the inertia of a link, which a wrong mass or collision shape does not cost, too."""
    title = f"the inertia of {link!r} is that of a uniform solid of its shapes"
    expectation = _link_expectation(link, "inertia_plausible", title, **tolerance)
    carried = []
    for cause, given in (
        ("mass_is", {"mass": mass}),
        ("collision_matches_visual", {"shown": True}),
    ):
        arguments = {**expectation.arguments, **given}
        carried.append(CarriedExpectation([f"{link} {cause}"], expectation.check, arguments))
    return expectation._replace(carried=carried)


def _collision(link: str, collision: Collision, only: Mapping[str, bool]) -> Expectation:
    match collision.geometry:
        case Box(size=size):
            shape: dict[str, Any] = {"box": _rounded(size)}
        case Cylinder(radius=radius, length=length):
            shape = {"cylinder": _rounded((radius, length))}
        case Capsule(radius=radius, length=length):
            shape = {"capsule": _rounded((radius, length))}
        case Sphere(radius=radius):
            shape = {"sphere": round(radius, 6)}
        case _:
            return _link_expectation(link, "collision_matches_visual")
    xyz = _rounded(collision.origin.xyz)
    rpy = _rounded(collision.origin.rpy, 4)
    rotated = ", rotated" if any(rpy) else ""
    title = (
        f"{link!r} collides as {shape_text(collision.geometry)} at {point(tuple(xyz))} m{rotated}"
    )
    return _link_expectation(link, "collides_as", title, **shape, xyz=xyz, rpy=rpy, **only)


def _joint_expectations(robot: Configuration, joint: Joint) -> Iterator[Expectation]:
    """Yield what may be true of the parent joint of a link.

    Raise MissingElement for an axis of length zero.
    """
    link = joint.child
    parent = joint.parent
    title = f"a {joint.type} joint connects {link!r} to {parent!r}"  # its name is free
    yield _link_expectation(link, "held_by", title, parent=parent, joint_type=joint.type)
    pose = robot.pose(link, relative_to=parent)
    xyz = _rounded(pose.translation)
    rpy = _rounded(pose.rpy, 4)
    if any(rpy):
        turned = f"with rpy = {point(tuple(_rounded(map(degrees, rpy), 1)))} (degrees)"
    else:
        turned = "not rotated"
    title = f"the frame {link!r} is at {point(tuple(xyz))} m in {parent!r}, {turned}"
    frame = _link_expectation(
        link, "frame_at", title, relative_to=parent, xyz=xyz, **({"rpy": rpy} if any(rpy) else {})
    )
    yield frame
    of_type = CarriedExpectation(
        (f"{link} held_by",), "frame_at", frame.arguments
    )  # a joint of another type has no such range
    if joint.limit and joint.type in ("revolute", "prismatic"):
        limits = _range_expectation(joint)
        if joint.mimic:
            opposite = _rounded(pose.rotate(robot.axis(joint)), 2)
            limits = limits.with_arguments(relative_to=parent, direction=opposite)
        yield limits._replace(carried=[of_type])
        for effort in _effort_expectations(joint):
            yield effort._replace(carried=[of_type])
    if joint.dynamics and joint.type != "fixed":
        friction = joint.dynamics.friction
        damping = joint.dynamics.damping
        title = f"the joint that moves {link!r} has friction {friction:g} and damping {damping:g}"
        yield _link_expectation(
            link, "joint_dynamics", title, friction=friction, damping=damping
        )._replace(is_detail=True)
    if joint.type not in ("continuous", "revolute", "prismatic", "planar"):
        return
    own_axis = robot.axis(joint)
    direction = _rounded(pose.rotate(own_axis), 2)
    follows = joint.mimic is not None and robot.robot.has_joint(joint.mimic.joint)
    if follows:
        yield _mimic_expectation(robot, joint, direction)
    lies = "is parallel to" if follows else "points along"
    title = (
        f"the axis of the joint that moves {link!r} {lies} {point(tuple(direction))} in {parent!r}"
    )
    either_way = {"either_way": True} if follows else {}
    axis = _link_expectation(
        link, "joint_axis", title, relative_to=parent, direction=direction, **either_way
    )
    in_own_frame = {**axis.arguments, "relative_to": link, "direction": _rounded(own_axis, 2)}
    yield axis._replace(
        carried=[CarriedExpectation([f"{link} frame_at"], "joint_axis", in_own_frame)]
    )


def _mimic_expectation(
    robot: Configuration, joint: Joint, direction: Sequence[float]
) -> Expectation:
    """Return how a joint follows another one, by its motion.

    The opposite axis with the opposite multiplier is the same.
    """
    mimic = joint.mimic
    assert mimic
    link = joint.child
    leader = robot.joint(mimic.joint).child
    moves = f"the joint that moves {link!r} follows the one that moves {leader!r}"
    times = "" if mimic.multiplier == 1 else f", {mimic.multiplier:g} times"
    plus = "" if mimic.offset == 0 else f", plus {mimic.offset:g}"
    return _link_expectation(
        link,
        "mimics",
        f"{moves}{times}{plus}",
        leader=leader,
        multiplier=mimic.multiplier,
        offset=mimic.offset,
        relative_to=joint.parent,
        direction=list(direction),
    )


def _range_expectation(joint: Joint) -> Expectation:
    """Return the range of a joint that turns or slides and has limits, in degrees or metres."""
    limit = joint.limit
    assert limit
    ends = (limit.lower, limit.upper)
    turns = joint.type == "revolute"
    lower, upper = _rounded(map(degrees, ends), 1) if turns else _rounded(ends)
    others = {} if turns else {"tolerance": _SLIDING_TOLERANCE}
    unit = "degrees" if turns else "m"
    title = f"the range of the joint that moves {joint.child!r} is {lower:g} to {upper:g} {unit}"
    return _link_expectation(joint.child, "joint_limits", title, lower=lower, upper=upper, **others)


def _effort_expectations(joint: Joint) -> Iterator[Expectation]:
    """Yield the maximum effort and velocity of a joint with limits."""
    assert joint.limit
    given = {"effort": joint.limit.effort, "velocity": joint.limit.velocity}
    known = {name: value for name, value in given.items() if isfinite(value)}
    if known:
        numbers = enumerated([f"{name} {value:g}" for name, value in known.items()])
        title = f"the joint that moves {joint.child!r} has {numbers}"
        expectation = _link_expectation(joint.child, "joint_limits", title, **known)
        yield expectation._replace(words=f"{joint.child} effort joint_limits", is_detail=True)


def _tree_expectations(solution: Solution) -> Iterator[Expectation]:
    """Yield the expectations of the whole tree of links.

    These are the names of joints that other elements use, the root, the numbers of joints, and
    how the tips move.
    """
    robot = solution.robot
    joints = robot.parent_joints.values()
    root = robot.main_tree[0]
    words = words_of_foreign(solution.root)
    used = {joint.name: joint.child for joint in joints if joint.name in words}
    if used and not are_joints_free(solution):
        yield _robot_expectation("joints_named", parent=root, joints=used)
    fixed = (joint.child for joint in joints if joint.parent == root and joint.type == "fixed")
    rooted = _robot_expectation("root_of_tree", link=root, holds=next(fixed, root))
    yield rooted
    about_types = _words_of_joints(joints, "held_by", "mimics")
    if_types_differ = CarriedExpectation(about_types, rooted.check, rooted.arguments)
    moving = [joint for joint in joints if joint.type != "fixed"]
    types = Counter(joint.type for joint in moving)
    numbers = {"moving": sum(not joint.mimic for joint in moving)}
    for joint_type in _COUNTED:
        numbers[joint_type] = types[joint_type]
    counts = _robot_expectation("counts", _joints_in_words(moving), **numbers)
    yield counts._replace(carried=[if_types_differ])
    tips = _moving_tips(robot)[:_MAX_TIPS]
    if tips:
        verb = "moves" if len(tips) == 1 else "move"
        names = enumerated(map(repr, tips), _MAX_TIPS_IN_TITLE)
        title = f"{names} {verb} as in the reference solution"
        about_poses = _words_of_joints(joints, "frame_at", "joint_axis", "mimics")
        if_poses_differ = CarriedExpectation(about_poses, "counts", numbers)
        motion = _robot_expectation("kinematics_match_reference", title, links=tips, match="order")
        yield motion._replace(carried=[if_poses_differ, if_types_differ])


def _joints_in_words(moving: Sequence[Joint]) -> str:
    """Return how many joints move, of which types, and how many of these follow another joint."""
    if not moving:
        return "no joint moves"
    leaders = Counter(joint.type for joint in moving if not joint.mimic)
    followers = Counter(joint.type for joint in moving if joint.mimic)
    if len(leaders) == 1 and not followers:
        [(joint_type, count)] = leaders.items()
        verb = "moves" if count == 1 else "move"
        return f"{counted(count, f'{joint_type} joint')} {verb}, and no other joint does"
    kinds = list(_kinds_in_words(leaders, followers))
    return f"the robot has {counted(len(moving), 'moving joint')}: {enumerated(kinds)}"


def _kinds_in_words(leaders: Counter[str], followers: Counter[str]) -> Iterator[str]:
    """Yield how many joints of each type move by themselves, and how many follow another one."""
    for joint_type, count in leaders.items():
        yield f"{count} {joint_type}"
    for joint_type, count in followers.items():
        verb = "follows" if count == 1 else "follow"
        yield f"{count} {joint_type} that {verb} another joint"


def _words_of_joints(joints: Iterable[Joint], *checks: str) -> Sequence[str]:
    """Return the words of the expectations that checks find about joints, each about its child."""
    return [f"{joint.child} {check}" for joint in joints for check in checks]


def _moving_tips(robot: Configuration) -> list[str]:
    """Return the links that hold no other link, and that a joint moves."""
    inner = {joint.parent for joint in robot.parent_joints.values()}
    tips = []
    for name in robot.main_tree:
        if name not in inner and any(joint.type != "fixed" for joint in robot.chain(name)):
            tips.append(name)
    return tips
