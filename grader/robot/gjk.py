"""The GJK distance: the direction of the gap between two separate convex shapes."""

from collections.abc import Sequence
from itertools import chain, combinations
from math import hypot, inf

from grader.robot.model import Sphere
from grader.robot.shapes import Shape, support
from grader.robot.transforms import Transform, Vector, cross, dot, minus

_TOUCHING = 1e-7  # metres; shapes with a smaller gap touch
_GAP_ERROR = 1e-10  # metres between the two bounds on a gap; the error of its direction is the square root, much more
_MAX_STEPS = 200  # pairs of robot parts take fewer than 40; rounding errors may take more


def separating_direction(a: Shape, b: Shape, T_a_b: Transform) -> Vector | None:
    """Return the unit direction from a to b of the gap between their cores, or None if these touch or intersect.

    It points to the difference nearest the origin among those between points of b and of a (Gilbert, Johnson and
    Keerthi, IEEE Journal of Robotics and Automation 4(2), 1988). Each step bounds the gap from both sides.
    """
    corners: Sequence[Vector] = ()
    nearest, shortest = T_a_b.translation, inf
    gap, best = 0.0, None
    for _ in range(_MAX_STEPS):
        length = hypot(*nearest)
        if length <= _TOUCHING:
            return None
        direction = (nearest[0] / length, nearest[1] / length, nearest[2] / length)
        corner = _near_end(a, b, T_a_b, direction)
        if dot(direction, corner) > gap:
            gap, best = dot(direction, corner), direction
        if length - gap <= _GAP_ERROR:
            break
        corners, nearest = _nearest_to_origin((corner, *corners))
        if len(corners) == 4 or hypot(*nearest) >= shortest:
            break  # the origin is between four corners, or they are closer together than the rounding error
        shortest = hypot(*nearest)
    return best


def _near_end(a: Shape, b: Shape, T_a_b: Transform, direction: Vector) -> Vector:
    """Return the difference between points of the cores of b and of a that is least along a direction.

    The core of a sphere is its centre: its radius shortens every gap alike.
    """
    x, y, z = T_a_b.translation
    if not isinstance(a, Sphere):
        u, v, w = support(a, direction)
        x, y, z = x - u, y - v, z - w
    if not isinstance(b, Sphere):
        u, v, w = T_a_b.rotate(support(b, T_a_b.unrotate(direction)))
        x, y, z = x - u, y - v, z - w
    return (x, y, z)


def _nearest_to_origin(corners: Sequence[Vector]) -> tuple[Sequence[Vector], Vector]:
    """Return the corners that span the point nearest the origin, the first among them, and that point."""
    first, *rest = corners
    best: tuple[Sequence[Vector], Vector] = ((first,), first)
    shortest = hypot(*first)
    for others in chain.from_iterable(combinations(rest, count) for count in range(1, len(rest) + 1)):
        foot = _foot(first, others)
        if foot is not None and hypot(*foot) < shortest:
            best, shortest = ((first, *others), foot), hypot(*foot)
    return best


def _foot(first: Vector, others: Sequence[Vector]) -> Vector | None:
    """Return the point nearest the origin on the line or plane, or in the space, through corners, if it is between them."""
    edges = [minus(other, first) for other in others]
    home = (-first[0], -first[1], -first[2])
    match edges:
        case [p]:
            whole, parts = dot(p, p), [dot(home, p)]
        case [p, q]:
            normal = cross(p, q)
            whole, parts = dot(normal, normal), [dot(cross(home, q), normal), dot(cross(p, home), normal)]
        case _:
            p, q, r = edges
            whole, parts = dot(p, cross(q, r)), [dot(home, cross(q, r)), dot(home, cross(r, p)), dot(home, cross(p, q))]
    weights = [part / whole for part in parts] if whole else [-1.0]
    if min(weights) < 0.0 or sum(weights) > 1.0:
        return None
    x, y, z = first
    for weight, (u, v, w) in zip(weights, edges, strict=True):
        x, y, z = x + weight * u, y + weight * v, z + weight * w
    return (x, y, z)
