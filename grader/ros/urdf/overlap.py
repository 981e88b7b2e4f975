"""The depth to which two shapes overlap.

Boxes, cylinders, capsules and spheres are convex and symmetric about their centres. Along a unit
direction u two of them overlap by `half_width(a, u) + half_width(b, u) - |u . c|`, c being the
vector between their centres. If no overlap is negative the shapes intersect, and the smallest one
is the distance that b must move to separate them: the separating axis test (Ericson, Real-Time
Collision Detection, 2004, section 5.2.1). Everything is computed in a's frame.
"""

from collections.abc import Iterator
from itertools import product
from math import copysign, hypot, inf

from grader.base.transforms import Transform, Vector, cross, dot, minus, unit
from grader.ros.urdf.model import Box, Capsule, Cylinder, Sphere
from grader.ros.urdf.shapes import Shape, bounding_radius, half_width, shrunk, straight_edges

# metres that sums of coordinates may lose, so that shapes set side by side count as touching
_ROUNDING = 1e-9
_STEPS = 60  # each leaves two thirds of an axis
_LEAN = 1e-5  # metres; cylinders that lean by less along their length count as parallel
# metres; longer lengths are scaled down, for products of four of them could overflow
_MAX_LENGTH = 1e6


def penetration(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, allowed: float = 0.0
) -> float:
    """Return the penetration depth of two shapes in metres if it is more than `allowed`.

    Otherwise return 0.0.

    Shapes that touch are separate. The depth is off by less than 0.1 mm, or by less than 1e-4 of
    the largest length where that is more than 10 m. Raises UnknownShape for a mesh.
    """
    limit = allowed + _ROUNDING
    reach = bounding_radius(a) + bounding_radius(b)
    if reach - hypot(*minus(T_w_b.translation, T_w_a.translation)) <= limit:
        return 0.0
    scale = 1.0
    if reach > _MAX_LENGTH:
        scale = min(reach / _MAX_LENGTH, 1e308)
        a = shrunk(a, scale)
        b = shrunk(b, scale)
        T_w_a = _scale_pose(T_w_a, scale)
        T_w_b = _scale_pose(T_w_b, scale)
    T_a_b = T_w_a.inverse() @ T_w_b
    depth = _overlap(a, b, T_a_b, least_overlap(a, b, T_a_b, limit / scale)) * scale
    return depth if depth > limit else 0.0


def least_overlap(a: Shape, b: Shape, T_a_b: Transform, limit: float = _ROUNDING) -> Vector:
    """Return the unit direction along which two shapes overlap least.

    It may also be one of an overlap up to the limit.

    A few directions are enough for parts that are side by side, and most are.
    """

    def overlap(direction: Vector) -> float:
        return _overlap(a, b, T_a_b, direction)

    best = (0.0, 0.0, 1.0)
    least = inf
    for direction in _likely_directions(a, b, T_a_b):
        amount = overlap(direction)
        if amount < least:
            best = direction
            least = amount
        if least <= limit:
            return best
    if not isinstance(a, Sphere) and not isinstance(b, Sphere) and _rims_matter(a, b, T_a_b):
        from grader.ros.urdf.edge_overlap import least_edge_overlap  # late: it loads numpy

        best = min(best, least_edge_overlap(a, b, T_a_b), key=overlap)
    return best


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
    edges_a = straight_edges(a)
    edges_b = [T_a_b.rotate(edge) for edge in straight_edges(b)]
    yield from edges_a
    yield from edges_b
    yield unit(T_a_b.translation) or (0.0, 0.0, 1.0)
    yield from _directions_of_round(a, b, T_a_b)
    for p, q in product(edges_a, edges_b):
        normal = cross(p, q)
        length = hypot(*normal)
        if length > _ROUNDING:
            yield (normal[0] / length, normal[1] / length, normal[2] / length)


def _directions_of_round(a: Shape, b: Shape, T_a_b: Transform) -> Iterator[Vector]:
    """Yield the unit directions from round shapes to the nearest points of the other shape."""
    c = T_a_b.translation
    if isinstance(a, Cylinder):
        x, y, _ = T_a_b.rotate(_vector_from_nearest(b, T_a_b.unrotate(c)))
        yield _unit_or_x((x, y, 0.0))
    if isinstance(b, Cylinder):
        x, y, _ = T_a_b.unrotate(_vector_from_nearest(a, c))
        yield T_a_b.rotate(_unit_or_x((x, y, 0.0)))
    if isinstance(b, Sphere):
        yield _unit_or_x(_outside(a, c))
    if isinstance(a, Sphere):
        yield T_a_b.rotate(_unit_or_x(_outside(b, T_a_b.unrotate(c))))
    if isinstance(b, Capsule):
        yield _unit_or_x(_outside(a, _nearest_of_axis(b, T_a_b, a)))
    if isinstance(a, Capsule):
        point = _nearest_of_axis(a, T_a_b.inverse(), b)
        yield T_a_b.rotate(_unit_or_x(_outside(b, point)))


def _unit_or_x(vector: Vector) -> Vector:
    """Return the unit vector of a direction; that of x for length zero."""
    return unit(vector) or (1.0, 0.0, 0.0)


def _vector_from_nearest(shape: Shape, point: Vector) -> Vector:
    """Return the vector to a point from the nearest point of a box.

    For a round shape, it is the vector from the centre.
    """
    if not isinstance(shape, Box):
        return point
    x, y, z = (
        copysign(max(abs(p) - abs(size) / 2.0, 0.0), p)
        for p, size in zip(point, shape.size, strict=True)
    )
    return (x, y, z)


def _outside(shape: Shape, point: Vector) -> Vector:
    """Return the vector to a point from the nearest point of a shape; zero for a point in it.

    Of a sphere or capsule the centre or the axis counts alone.
    """
    if isinstance(shape, Capsule):
        x, y, z = point
        return (x, y, copysign(max(abs(z) - abs(shape.length) / 2.0, 0.0), z))
    if not isinstance(shape, Cylinder):
        return _vector_from_nearest(shape, point)
    x, y, z = point
    out = max(1.0 - abs(shape.radius) / hypot(x, y), 0.0) if hypot(x, y) else 0.0
    return (x * out, y * out, copysign(max(abs(z) - abs(shape.length) / 2.0, 0.0), z))


def _nearest_of_axis(capsule: Capsule, T_other_capsule: Transform, other: Shape) -> Vector:
    """Return the point of a capsule's axis that is nearest to another shape, in the frame of that.

    The distance to a convex shape is a convex function along a line: it is cut in three again and
    again.
    """
    low = -abs(capsule.length) / 2.0
    high = abs(capsule.length) / 2.0

    def distance(z: float) -> float:
        return hypot(*_outside(other, T_other_capsule.apply((0.0, 0.0, z))))

    for _ in range(_STEPS):
        third = (high - low) / 3.0
        if distance(low + third) <= distance(high - third):
            high -= third
        else:
            low += third
    return T_other_capsule.apply((0.0, 0.0, (low + high) / 2.0))


def _rims_matter(a: Shape, b: Shape, T_a_b: Transform) -> bool:
    """Return whether a cylinder leans against all edges of the other shape by more than `_LEAN`.

    The overlap with a cylinder parallel to an edge, as most are, is a problem in the plane, without
    rims.
    """
    if not isinstance(a, Cylinder) and not isinstance(b, Cylinder):
        return False
    edges = product(straight_edges(a), map(T_a_b.rotate, straight_edges(b)))
    tilt = min((hypot(*cross(p, q)) for p, q in edges), default=0.0)
    return tilt * (bounding_radius(a) + bounding_radius(b)) > _LEAN
