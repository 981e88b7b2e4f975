"""The distance between two shapes, or the depth to which they overlap.

Boxes, cylinders and spheres are convex and symmetric about their centres. Along a unit direction u two of them overlap
by `half_width(a, u) + half_width(b, u) - |u . c|`, c being the vector between their centres. If no overlap is negative
the shapes intersect, and the smallest one is the distance that b must move to separate them: the separating axis test
(Ericson, Real-Time Collision Detection, 2004, section 5.2.1). Otherwise the GJK distance is the gap (Gilbert, Johnson
and Keerthi, IEEE Journal of Robotics and Automation 4(2), 1988). Everything is computed in a's frame.
"""

from collections.abc import Iterator, Sequence
from itertools import chain, combinations, product
from math import copysign, hypot, inf
from typing import NamedTuple

from grader.robot.model import Box, Cylinder, Sphere
from grader.robot.shapes import Shape, bounding_radius, half_width, shrunk, straight_edges, support
from grader.robot.transforms import Transform, Vector, cross, dot, minus, unit

_ROUNDING = 1e-9  # metres that sums of coordinates may lose, so that shapes set side by side count as touching
_LEAN = 1e-5  # metres; cylinders that lean by less along their length count as parallel
_MAX_LENGTH = 1e6  # metres; longer lengths are scaled down, for products of four of them could overflow

_TOUCHING = 1e-7  # metres; shapes with a smaller gap touch
_GAP_ERROR = 1e-10  # metres between the two bounds on a gap; the error of its direction is the square root, much more
_MAX_STEPS = 200  # pairs of robot parts take fewer than 40; rounding errors may take more


class Separation(NamedTuple):
    """The distance between two shapes in metres, negative for a depth, and the unit direction from a to b of it.

    Moving b along the direction by the negative of the distance makes the shapes just touch.
    """

    distance: float
    direction: Vector


def separation(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> Separation:
    """Return the distance or the penetration depth of two shapes in metres, and its direction in the world.

    Off by less than 0.1 mm, or 1e-4 of the largest length where that is more than 10 m. Raises UnknownShape for a mesh.
    """
    size = max(bounding_radius(a), bounding_radius(b), *map(abs, T_w_a.translation + T_w_b.translation))
    scale = 1.0 if size <= _MAX_LENGTH else min(size, 1e308)
    a, b = shrunk(a, scale), shrunk(b, scale)
    T_a_b = _scale_pose(T_w_a, scale).inverse() @ _scale_pose(T_w_b, scale)
    direction = _separating_direction(a, b, T_a_b) or _least_overlap(a, b, T_a_b)
    return Separation(-_overlap(a, b, T_a_b, direction) * scale, T_w_a.rotate(direction))


def penetration(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, allowed: float = 0.0) -> float:
    """Return the penetration depth of two shapes in metres if it is more than `allowed`; otherwise 0.0.

    Shapes that touch are separate. A few directions are enough for parts that are side by side, and most are. Raises
    UnknownShape for a mesh.
    """
    limit = allowed + _ROUNDING
    if bounding_radius(a) + bounding_radius(b) - hypot(*minus(T_w_b.translation, T_w_a.translation)) <= limit:
        return 0.0
    T_a_b = T_w_a.inverse() @ T_w_b
    if any(_overlap(a, b, T_a_b, direction) <= limit for direction in _likely_directions(a, b, T_a_b)):
        return 0.0
    depth = -separation(a, T_w_a, b, T_w_b).distance
    return depth if depth > limit else 0.0


def _separating_direction(a: Shape, b: Shape, T_a_b: Transform) -> Vector | None:
    """Return the unit direction from a to b of the gap between their cores, or None if these touch or intersect.

    It points to the difference nearest the origin among those between points of b and of a. Each step bounds the gap
    from both sides.
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
    """Return the point nearest the origin on the line, plane or space through corners, if it is between them."""
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


def _scale_pose(pose: Transform, scale: float) -> Transform:
    x, y, z = pose.translation
    return Transform(pose.rotation, (x / scale, y / scale, z / scale))


def _overlap(a: Shape, b: Shape, T_a_b: Transform, direction: Vector) -> float:
    """Return the length that two shapes share along a unit direction; a negative one is a gap."""
    centres = abs(dot(direction, T_a_b.translation))
    return half_width(a, direction) + half_width(b, T_a_b.unrotate(direction)) - centres


def _likely_directions(a: Shape, b: Shape, T_a_b: Transform) -> Iterator[Vector]:
    """Yield unit directions, one of which shows for most separate shapes that they are separate.

    If no rim matters, the least overlap of intersecting shapes is along one of these.
    """
    c = T_a_b.translation
    edges_a = straight_edges(a)
    edges_b = [T_a_b.rotate(edge) for edge in straight_edges(b)]
    yield from edges_a
    yield from edges_b
    yield unit(c) or (0.0, 0.0, 1.0)
    if isinstance(a, Cylinder):
        x, y, _ = T_a_b.rotate(_beyond(b, T_a_b.unrotate(c)))
        yield unit((x, y, 0.0)) or (1.0, 0.0, 0.0)
    if isinstance(b, Cylinder):
        x, y, _ = T_a_b.unrotate(_beyond(a, c))
        yield T_a_b.rotate(unit((x, y, 0.0)) or (1.0, 0.0, 0.0))
    for p, q in product(edges_a, edges_b):
        normal = cross(p, q)
        length = hypot(*normal)
        if length > _ROUNDING:
            yield (normal[0] / length, normal[1] / length, normal[2] / length)


def _beyond(shape: Shape, point: Vector) -> Vector:
    """Return the vector to a point from the nearest point of a box, or from the centre of a round shape."""
    if not isinstance(shape, Box):
        return point
    x, y, z = (copysign(max(abs(p) - abs(size) / 2.0, 0.0), p) for p, size in zip(point, shape.size, strict=True))
    return (x, y, z)


def _least_overlap(a: Shape, b: Shape, T_a_b: Transform) -> Vector:
    """Return the unit direction from a to b along which two touching or intersecting shapes overlap least."""

    def overlap(direction: Vector) -> float:
        return _overlap(a, b, T_a_b, direction)

    best = min(_likely_directions(a, b, T_a_b), key=overlap)
    leaning = overlap(best) > _ROUNDING and _rims_matter(a, b, T_a_b)
    if leaning and not isinstance(a, Sphere) and not isinstance(b, Sphere):
        from grader.robot.edge_overlap import least_edge_overlap  # late: it loads numpy

        best = min(best, least_edge_overlap(a, b, T_a_b), key=overlap)
    x, y, z = best
    return best if dot(best, T_a_b.translation) >= 0.0 else (-x, -y, -z)


def _rims_matter(a: Shape, b: Shape, T_a_b: Transform) -> bool:
    """Return whether a cylinder leans against all edges of the other shape by more than `_LEAN`.

    The overlap with a cylinder parallel to an edge, as most are, is a problem in the plane, without rims.
    """
    if isinstance(a, Box) and isinstance(b, Box):
        return False
    edges = product(straight_edges(a), map(T_a_b.rotate, straight_edges(b)))
    tilt = min((hypot(*cross(p, q)) for p, q in edges), default=0.0)
    return tilt * (bounding_radius(a) + bounding_radius(b)) > _LEAN
