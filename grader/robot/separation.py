"""How far two shapes stand apart, or how deep one sits in the other.

Boxes, cylinders and spheres are convex and symmetric about their centres. Along a unit direction u two of them overlap
by `half_width(a, u) + half_width(b, u) - |u . c|`, c being the vector between their centres. Where no overlap is
negative the shapes cut into each other, and the smallest one is how far b must move to come free: the separating axis
test (Ericson, Real-Time Collision Detection, 2004, section 5.2.1). Everything is worked out in a's frame.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, combinations, product
from math import atan2, ceil, copysign, hypot, inf, pi, sqrt
from typing import TYPE_CHECKING, Any

from grader.robot.model import Box, Cylinder, Sphere
from grader.robot.shapes import Shape, half_width, support
from grader.robot.transforms import Transform, Vector, cross, dot, minus, unit

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, np.dtype[np.float64]]

_ROUNDING = 1e-9  # metres; what sums of coordinates may lose, so that shapes set side by side count as touching
_GAP_ERROR = 1e-7  # metres; how far the two bounds on a gap may stay apart
_GAP_STEPS = 200  # pairs of robot parts take fewer than 40; the cap is for what rounding may do
_SAGITTA = 4e-5  # metres from a rim to the polygon that stands for it; two of these are less than 0.1 mm
_BEND = 4e-6  # the same relative to the radius, so that a rim of more than 10 m has no more corners than one of 10 m
_LARGEST = 1e6  # metres; longer lengths are scaled down, for products of four of them could overflow


@dataclass(frozen=True, slots=True)
class Separation:
    """The gap between two shapes in metres, negative for a depth, and the unit direction from a to b it is measured in.

    Moving b along the direction by the negative of the distance makes the shapes just touch.
    """

    distance: float
    direction: Vector


def separation(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> Separation:
    """The gap or the penetration depth of two shapes in metres, and its direction in the world.

    Off by less than 0.1 mm, or 1e-4 of the largest length where that is more than 10 m. Raises UnknownShape for a mesh.
    """
    size = max(_radius(a), _radius(b), *map(abs, T_w_a.translation + T_w_b.translation))
    scale = 1.0 if size <= _LARGEST else min(size, 1e308)
    a, b = _shrunk(a, scale), _shrunk(b, scale)
    T_a_b = _moved_in(T_w_a, scale).inverse() @ _moved_in(T_w_b, scale)
    direction = _widest_gap(a, b, T_a_b) or _least_overlap(a, b, T_a_b)
    return Separation(-_overlap(a, b, T_a_b, direction) * scale, T_w_a.rotate(direction))


def penetration(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, allowed: float = 0.0) -> float:
    """How deep two shapes sit in each other, metres, where that is more than `allowed`; 0.0 everywhere else.

    Shapes that touch are apart. For parts that stand side by side a look along a few directions is enough, and those
    are most. Raises UnknownShape for a mesh.
    """
    limit = allowed + _ROUNDING
    if _radius(a) + _radius(b) - hypot(*minus(T_w_b.translation, T_w_a.translation)) <= limit:
        return 0.0
    T_a_b = T_w_a.inverse() @ T_w_b
    if any(_overlap(a, b, T_a_b, direction) <= limit for direction in _likely_directions(a, b, T_a_b)):
        return 0.0
    depth = -separation(a, T_w_a, b, T_w_b).distance
    return depth if depth > limit else 0.0


def _radius(shape: Shape) -> float:
    """The radius of the smallest ball about a shape's centre that holds it."""
    if isinstance(shape, Box):
        x, y, z = shape.size
        return hypot(x / 2.0, y / 2.0, z / 2.0)
    if isinstance(shape, Cylinder):
        return hypot(shape.radius, shape.length / 2.0)
    return half_width(shape, (0.0, 0.0, 1.0))


def _shrunk(shape: Shape, scale: float) -> Shape:
    if scale == 1.0:
        return shape
    if isinstance(shape, Box):
        x, y, z = shape.size
        return Box((x / scale, y / scale, z / scale))
    if isinstance(shape, Cylinder):
        return Cylinder(shape.radius / scale, shape.length / scale)
    return Sphere(shape.radius / scale)


def _moved_in(pose: Transform, scale: float) -> Transform:
    x, y, z = pose.translation
    return Transform(pose.rotation, (x / scale, y / scale, z / scale))


def _overlap(a: Shape, b: Shape, T_a_b: Transform, direction: Vector) -> float:
    """The length that two shapes share along a unit direction; a negative one is a gap."""
    centres = abs(dot(direction, T_a_b.translation))
    return half_width(a, direction) + half_width(b, T_a_b.unrotate(direction)) - centres


def _likely_directions(a: Shape, b: Shape, T_a_b: Transform) -> Iterator[Vector]:
    """Unit directions in which shapes that do not cut into each other are mostly seen to be apart.

    Where no rim matters the least overlap of shapes that do cut into each other is along one of these.
    """
    c = T_a_b.translation
    edges_a = _straight_edges(a)
    edges_b = [T_a_b.rotate(edge) for edge in _straight_edges(b)]
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
    """The way to a point from what is nearest to it of a box, or from the centre of a round shape."""
    if not isinstance(shape, Box):
        return point
    x, y, z = (copysign(max(abs(p) - abs(size) / 2.0, 0.0), p) for p, size in zip(point, shape.size, strict=True))
    return (x, y, z)


def _straight_edges(shape: Shape) -> list[Vector]:
    """The directions of the straight lines on a shape, which are the normals of its flat faces too."""
    if isinstance(shape, Box):
        return [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    return [(0.0, 0.0, 1.0)] if isinstance(shape, Cylinder) else []


def _widest_gap(a: Shape, b: Shape, T_a_b: Transform) -> Vector | None:
    """The unit direction from a to b of the gap between their cores, or None where these touch or cut into each other.

    It points to what is nearest the origin among all differences between points of b and of a (Gilbert, Johnson and
    Keerthi, IEEE Journal of Robotics and Automation 4(2), 1988). Each step bounds the gap from both sides.
    """
    corners: Sequence[Vector] = ()
    nearest, shortest = T_a_b.translation, inf
    gap, best = 0.0, None
    for _ in range(_GAP_STEPS):
        length = hypot(*nearest)
        if length <= _GAP_ERROR:
            return None
        direction = (nearest[0] / length, nearest[1] / length, nearest[2] / length)
        corner = _near_end(a, b, T_a_b, direction)
        if dot(direction, corner) > gap:
            gap, best = dot(direction, corner), direction
        if length - gap <= _GAP_ERROR:
            break
        corners, nearest = _nearest_to_origin((corner, *corners))
        if len(corners) == 4 or hypot(*nearest) >= shortest:
            break  # the origin is between four corners, or they are too close together for rounding to tell more
        shortest = hypot(*nearest)
    return best


def _near_end(a: Shape, b: Shape, T_a_b: Transform, direction: Vector) -> Vector:
    """The difference between points of the cores of b and of a that lies least far along a direction.

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
    """What is nearest the origin between up to four corners, and the corners it rests on: the first is one of them."""
    first, *rest = corners
    best: tuple[Sequence[Vector], Vector] = ((first,), first)
    shortest = hypot(*first)
    for others in chain.from_iterable(combinations(rest, count) for count in range(1, len(rest) + 1)):
        foot = _foot(first, others)
        if foot is not None and hypot(*foot) < shortest:
            best, shortest = ((first, *others), foot), hypot(*foot)
    return best


def _foot(first: Vector, others: Sequence[Vector]) -> Vector | None:
    """The point nearest the origin on the line or plane, or in the space, through corners, if it lies between them."""
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


def _least_overlap(a: Shape, b: Shape, T_a_b: Transform) -> Vector:
    """The unit direction from a to b along which two shapes that touch or cut into each other overlap least."""

    def overlap(direction: Vector) -> float:
        return _overlap(a, b, T_a_b, direction)

    best = min(_likely_directions(a, b, T_a_b), key=overlap)
    leaning = overlap(best) > _ROUNDING and _rims_matter(a, b, T_a_b)
    if leaning and not isinstance(a, Sphere) and not isinstance(b, Sphere):
        best = min(best, _least_overlap_at_rims(a, b, T_a_b), key=overlap)
    x, y, z = best
    return best if dot(best, T_a_b.translation) >= 0.0 else (-x, -y, -z)


def _rims_matter(a: Shape, b: Shape, T_a_b: Transform) -> bool:
    """Whether there is a cylinder that leans against all edges of the other shape by more than `_SAGITTA` allows.

    A cylinder parallel to an edge, as most are, makes the overlap a flat problem, which has no rims.
    """
    if isinstance(a, Box) and isinstance(b, Box):
        return False
    edges = product(_straight_edges(a), map(T_a_b.rotate, _straight_edges(b)))
    tilt = min((hypot(*cross(p, q)) for p, q in edges), default=0.0)
    return tilt * (_radius(a) + _radius(b)) > _SAGITTA / 4.0


def _least_overlap_at_rims(a: Box | Cylinder, b: Box | Cylinder, T_a_b: Transform) -> Vector:
    """The unit normal of least overlap among those that two straight edges, an edge and a rim, or two rims span.

    Were the rims polygons, these and the normals of flat faces would be all that the separating axis test needs; a rim
    stands out from its polygon by no more than `_SAGITTA`. Two more rounds look closer about the best normal.
    """
    import numpy as np  # not at the top: loading it takes longer than a grading run, and most robots' parts stay clear

    rotation = np.array(T_a_b.rotation).reshape(3, 3)
    straight = np.array([*_straight_edges(a), *map(T_a_b.rotate, _straight_edges(b))])
    sides = ((a, np.eye(3)), (b, rotation))
    rims = [(frame, _all_around(shape.radius)) for shape, frame in sides if isinstance(shape, Cylinder)]
    best = straight[0]
    for _ in range(3):
        lines = [np.outer(np.cos(turns), f[:, 0]) + np.outer(np.sin(turns), f[:, 1]) for f, turns in rims]
        spans = [np.cross(p[:, None], q).reshape(-1, 3) for p, q in combinations([straight, *lines], 2)]
        normals = np.concatenate(spans)
        lengths = np.linalg.norm(normals, axis=1)
        normals = normals[lengths > _ROUNDING] / lengths[lengths > _ROUNDING, None]
        overlaps = _half_widths(a, normals) + _half_widths(b, normals @ rotation) - abs(normals @ T_a_b.translation)
        best = normals[overlaps.argmin()]
        rims = [(f, _closer(turns, atan2(best @ f[:, 0], -(best @ f[:, 1])))) for f, turns in rims]
    x, y, z = best.tolist()
    return (x, y, z)


def _all_around(radius: float) -> list[float]:
    """The directions of a polygon's edges as angles over half a turn; across the polygon they come again."""
    sagitta = max(_SAGITTA, _BEND * abs(radius))
    count = max(2, ceil(pi / 2.0 * sqrt(abs(radius) / sagitta / 2.0)))  # for 1 - cos(t) is no more than t**2 / 2
    return [step * pi / count for step in range(count)]


def _closer(turns: list[float], middle: float) -> list[float]:
    return [middle + (turns[1] - turns[0]) * (step / 8.0 - 1.0) for step in range(17)]


def _half_widths(shape: Box | Cylinder, directions: "Array") -> "Array":
    """`half_width` for directions of shape (n, 3)."""
    x, y, z = directions.T
    if isinstance(shape, Box):
        a, b, c = shape.size
        widths: Array = (abs(a * x) + abs(b * y) + abs(c * z)) / 2.0
    else:
        widths = abs(shape.radius) * (x * x + y * y) ** 0.5 + abs(shape.length / 2.0 * z)
    return widths
