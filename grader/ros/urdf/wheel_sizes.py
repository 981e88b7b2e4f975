"""The wheels that joints turn: where they are, about which axis they turn, and how large they are.

Lengths are metres, in the frame of a link that is given. Only cylinders and spheres about the axis
of a joint have a size that is known; meshes have none.
"""

from collections.abc import Iterable, Iterator
from operator import itemgetter

from grader.base.grouping import group_values
from grader.base.records import Named
from grader.base.transforms import Z_AXIS, Vector, cross, dot, minus
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Collision, Cylinder, Joint, Sphere, Visual

_ALONG = 0.99  # the cosine of the angle between two directions that count as parallel
_OFF_AXIS = 0.05  # of the radius: how far from its axis the middle of a wheel may be


class WheelSize(Named):
    """The wheel of a joint.

    `axis` is the unit axis of the joint, `middle` the middle of the wheel, or the origin of the
    joint where no round shape is known. `radii` has those of all round shapes, the largest first,
    and `half_width` is None without one.
    """

    joint: Joint
    axis: Vector
    middle: Vector
    radii: tuple[float, ...] = ()
    half_width: float | None = None


def measure_wheel(robot: Configuration, joint: Joint, base: str) -> WheelSize:
    """Return the wheel that a joint turns, in the frame of the link `base`.

    A joint without a round shape about its axis may stand for others: the radii are then those of
    the joints that mimic it, or of those that it carries, as a steering joint does. Raises
    MissingElement where a pose or an axis is not defined, NotDecided where one is open.
    """
    size = _measure_own(robot, joint, base)
    if size.radii:
        return size
    for other in _standing_for(robot, joint):
        other_size = _measure_own(robot, other, base)
        if other_size.radii:
            return size._replace(radii=other_size.radii)
    return size


def _standing_for(robot: Configuration, joint: Joint) -> Iterator[Joint]:
    """Yield the joints that mimic a joint, and then those that turn below these and below it."""
    turning = [
        candidate
        for candidate in robot.robot.joints
        if candidate.has_position and candidate is not joint
    ]
    following = [
        candidate
        for candidate in turning
        if candidate.mimic and candidate.mimic.joint == joint.name
    ]
    yield from following
    below = {joint.child, *(follower.child for follower in following)}
    for link in list(below):
        below |= {*_links_below(robot, link)}
    for other in turning:
        if other.parent in below:
            yield other


def _measure_own(robot: Configuration, joint: Joint, base: str) -> WheelSize:
    """Return the wheel that the cylinders and spheres about the axis of a joint make.

    They are on its link and on those that are fixed to it.
    """
    T_base_joint = robot.pose(joint.child, relative_to=base)
    axis = T_base_joint.rotate(robot.axis(joint))
    shapes = []
    for link in _links_below(robot, joint.child, is_fixed=True):
        T_base_link = robot.pose(link, relative_to=base)
        elements: list[Collision | Visual] = list(robot.link(link).collisions)
        elements += robot.link(link).visuals
        for element in elements:
            shape = element.geometry
            if not isinstance(shape, Cylinder | Sphere):
                continue
            T_base_shape = element.origin.placed_in(T_base_link)
            half_width = 0.0
            if isinstance(shape, Cylinder):
                half_width = shape.length / 2.0
                if abs(dot(T_base_shape.rotate(Z_AXIS), axis)) < _ALONG:
                    continue
            away = cross(minus(T_base_shape.translation, T_base_joint.translation), axis)
            if dot(away, away) <= (_OFF_AXIS * shape.radius) ** 2:
                shapes.append((shape.radius, half_width, T_base_shape.translation))
    if not shapes:
        return WheelSize(joint, axis, T_base_joint.translation)
    shapes.sort(key=itemgetter(0), reverse=True)
    radii = tuple(radius for radius, _, _ in shapes)
    return WheelSize(joint, axis, shapes[0][2], radii, max(width for _, width, _ in shapes))


def _links_below(robot: Configuration, link: str, *, is_fixed: bool = False) -> Iterable[str]:
    """Return a link and those that joints connect to it, downward.

    With `is_fixed`, only fixed joints count.
    """
    children = group_values(
        (joint.parent, joint.child)
        for joint in robot.robot.joints
        if joint.type == "fixed" or not is_fixed
    )
    reached = {link: None}
    pending = [link]
    while pending:
        added = [child for child in children.get(pending.pop(), ()) if child not in reached]
        reached |= dict.fromkeys(added)
        pending += added
    return reached
