"""Whether everything in a robot is turned or moved alike, in comparison with a reference.

This is about the frames of a whole robot.

It finds any quarter turn and any move, for a note that each report has, without hints too.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import permutations, product
from math import dist, hypot

from grader.base.errors import MissingElement, NotDecided
from grader.base.records import Named
from grader.base.transforms import (
    IDENTITY,
    IDENTITY_ROTATION,
    Rotation,
    Transform,
    Vector,
    minus,
    turn_between,
)
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint, Link, Origin, Robot

_NEAR = 0.005  # metres
_MIN_POINTS = 4
_Pairs = list[tuple[Vector, Vector]]  # a point of the robot, and the same point of the reference


class Convention(Named):
    """How everything in a robot differs from the reference.

    It has the robot without that difference.
    """

    description: str
    robot: Robot


def find_convention(robot: Configuration, reference: Configuration, base: str) -> Convention | None:
    """Return how all is rotated by quarter turns or moved in the frame of `base`.

    Returns None if it is not, or not alike.

    One link may be elsewhere: its own mistake.
    """
    names = [link.name for link in reference.robot.links if robot.robot.has_link(link.name)]
    pairs = [
        pair
        for name in names
        if (pair := _matching_points(robot, reference, name, base)) is not None
    ]
    if len(pairs) < _MIN_POINTS or 2 * sum(dist(*pair) <= _NEAR for pair in pairs) >= len(pairs):
        # too few points, or most are where they should be: the quick answer for most robots
        return None
    count, T_base_other = max(
        (_fit_rotation(pairs, rotation) for rotation in _quarter_turns()), key=lambda fit: fit[0]
    )
    description = _describe_motion(T_base_other)
    if not description or count < max(_MIN_POINTS, len(pairs) - 1):
        return None
    return Convention(description, _reframe(robot, reference, base, T_base_other))


def _matching_points(
    robot: Configuration, reference: Configuration, link: str, base: str
) -> tuple[Vector, Vector] | None:
    """Return where the first shape of a link is in the frame of both robots' base.

    If the link has no shape, return where its frame is.
    """
    try:
        posed_visuals = [
            (each_robot.pose(link, relative_to=base), each_robot.link(link).visuals)
            for each_robot in (robot, reference)
        ]
    except (MissingElement, NotDecided):
        return None
    (T_ours, ours), (T_theirs, theirs) = posed_visuals
    if ours and theirs:
        return T_ours.apply(ours[0].origin.xyz), T_theirs.apply(theirs[0].origin.xyz)
    return T_ours.translation, T_theirs.translation


def _quarter_turns() -> Iterator[Rotation]:
    """Yield the 24 rotations that lay the axes over each other, no rotation first."""
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        rows = []
        for axis, sign in zip(order, signs, strict=True):
            row = [0.0, 0.0, 0.0]
            row[axis] = sign
            rows.append(row)
        (a, b, c), (d, e, f), (g, h, i) = rows
        if a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) > 0.0:
            yield a, b, c, d, e, f, g, h, i


def _fit_rotation(pairs: _Pairs, rotation: Rotation) -> tuple[int, Transform]:
    """Return how many points a rotation and the best translation lay over each other, and both."""
    from statistics import median  # late: most robots are not rotated

    turned = Transform(rotation)
    offsets = [minus(ours, turned.apply(theirs)) for ours, theirs in pairs]
    x, y, z = (round(median(values), 9) for values in zip(*offsets, strict=True))
    return sum(dist(offset, (x, y, z)) <= _NEAR for offset in offsets), Transform(
        rotation, (x, y, z)
    )


def _describe_motion(T: Transform) -> str:
    """Return a turn and a move in words; empty if there is none."""
    angle = turn_between(T.rotation, IDENTITY_ROTATION)
    words = []
    if angle > 1.0:
        about = [axis for axis, turn in zip("xyz", T.rpy, strict=True) if abs(turn) > 0.1]
        sign = "-" if len(about) == 1 and min(T.rpy) < -0.1 and angle < 179.0 else ""
        words.append(
            f"rotated by {sign}{round(angle)} degrees"
            + (f" about {about[0]}" if len(about) == 1 else "")
        )
    if hypot(*T.translation) > _NEAR:
        words.append(f"moved by {' '.join(f'{value:g}' for value in T.translation)} m")
    return " and ".join(words)


def _reframe(
    robot: Configuration, reference: Configuration, base: str, T_base_other: Transform
) -> Robot:
    """Return a robot with another frame of its base, and of each link that is turned alike.

    Nothing in the robot moves.
    """
    turned = Transform(T_base_other.rotation)
    frames = {base: T_base_other}
    for link in robot.robot.links:
        try:
            T_ours = T_base_other.inverse() @ robot.pose(link.name, relative_to=base)
            wanted = reference.pose(link.name, relative_to=base).rotation
        except (MissingElement, NotDecided):
            continue
        if turn_between((T_ours @ turned).rotation, wanted) + 1.0 < turn_between(
            T_ours.rotation, wanted
        ):
            frames.setdefault(link.name, turned)
    links = tuple(
        _reframe_link(link, frames.get(link.name, IDENTITY)) for link in robot.robot.links
    )
    joints = tuple(
        _reframe_joint(joint, frames.get(joint.parent, IDENTITY), frames.get(joint.child, IDENTITY))
        for joint in robot.robot.joints
    )
    return replace(robot.robot, links=links, joints=joints)


def _reframe_link(link: Link, T_link_other: Transform) -> Link:
    if T_link_other == IDENTITY:
        return link
    back = T_link_other.inverse()
    visuals = tuple(
        visual._replace(origin=_reframe_origin(back, visual.origin)) for visual in link.visuals
    )
    return link._replace(
        visuals=visuals,
        collisions=tuple(
            collision._replace(origin=_reframe_origin(back, collision.origin))
            for collision in link.collisions
        ),
    )


def _reframe_joint(joint: Joint, T_parent_other: Transform, T_child_other: Transform) -> Joint:
    if not joint.origin or (T_parent_other, T_child_other) == (IDENTITY, IDENTITY):
        return joint
    T_parent_child = joint.origin.placed_in(T_parent_other.inverse()) @ T_child_other
    origin = joint.origin._replace(xyz=T_parent_child.translation, rpy=T_parent_child.rpy)
    return joint._replace(
        origin=origin,
        axis=T_child_other.unrotate(joint.axis) if joint.axis is not None else None,
    )


def _reframe_origin(T: Transform, origin: Origin) -> Origin:
    moved = origin.placed_in(T)
    return origin._replace(xyz=moved.translation, rpy=moved.rpy)
