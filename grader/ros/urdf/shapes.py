"""The size of a robot's shapes, and how far a placed shape differs from another one.

The size is support points, extents, volumes.

Lengths are metres. A negative size counts as its absolute value: urdfdom accepts it, and a shape
that is symmetric about its centre does not change when it is mirrored. Shapes are compared as
solids: symmetries, such as the turn of a sphere, do not count.
"""

from collections.abc import Iterator
from itertools import permutations, product
from math import asin, degrees, hypot, inf, nan
from typing import NamedTuple

from grader.base.records import Named
from grader.base.text import quoted
from grader.base.transforms import AXES, Transform, Vector, dot, minus, turn_between, unit
from grader.ros.urdf.model import Box, Capsule, Cylinder, Geometry, Mesh, Sphere

Shape = Box | Cylinder | Capsule | Sphere  # whose size is known, in metres
_Difference = tuple[float, float, float]  # of size, of turn and of angle

# relative to its length; a direction that leans less from a face's normal means the whole face
_TIE = 1e-9
_TOUCH = 1e-9  # metres
_MESH_ANGLE = 1.0  # degrees that two poses of a mesh may differ, whose points are not known
# the signs of four corners of a box; the others are opposite to these
_CORNERS = tuple(product((1.0,), (1.0, -1.0), (1.0, -1.0)))


class UnknownShape(ValueError):
    """The size of a shape is needed, but not known; `geometry` is that shape."""

    def __init__(self, geometry: Mesh) -> None:
        super().__init__(
            f"the size of mesh {quoted(geometry.filename)} is unknown: mesh files are not opened"
        )
        self.geometry = geometry


def half_width(geometry: Geometry, direction: Vector) -> float:
    """Return the extent (m) of a shape from its centre along a unit direction of its frame.

    Raises UnknownShape for a mesh.

    This is the shape's support function (Ericson, Real-Time Collision Detection, 2004, section
    4.3). The cylinder's `hypot` has no cancellation near its axis, which `sqrt(1 - z * z)` would
    have.
    """
    x, y, z = direction
    if isinstance(geometry, Box):
        a, b, c = geometry.size
        return (abs(a * x) + abs(b * y) + abs(c * z)) / 2.0
    if isinstance(geometry, Cylinder):
        return abs(geometry.length * z) / 2.0 + abs(geometry.radius) * hypot(x, y)
    if isinstance(geometry, Capsule):
        return abs(geometry.length * z) / 2.0 + abs(geometry.radius)
    if isinstance(geometry, Sphere):
        return abs(geometry.radius)
    raise UnknownShape(geometry)


def support(geometry: Geometry, direction: Vector) -> Vector:
    """Return the farthest point of a shape along a direction of its frame.

    Returns the middle of the farthest points if several tie.

    It is in metres, in the shape's frame; the direction need not be unit, and a zero one gives the
    centre. Raises UnknownShape for a mesh.
    """
    x, y, z = direction
    tie = _TIE * max(abs(x), abs(y), abs(z))
    if isinstance(geometry, Box):
        a, b, c = geometry.size
        return (_signed_half(a, x, tie), _signed_half(b, y, tie), _signed_half(c, z, tie))
    if isinstance(geometry, Cylinder):
        outward = unit((x, y, 0.0)) if hypot(x, y) > tie else None
        radius = abs(geometry.radius)
        x, y, _ = outward or (0.0, 0.0, 0.0)
        return (radius * x, radius * y, _signed_half(geometry.length, z, tie))
    if isinstance(geometry, Capsule | Sphere):
        radius = abs(geometry.radius)
        end = 0.0
        if isinstance(geometry, Capsule):
            end = _signed_half(geometry.length, z, tie)
        x, y, z = unit(direction) or (0.0, 0.0, 0.0)
        return (radius * x, radius * y, radius * z + end)
    raise UnknownShape(geometry)


def straight_edges(geometry: Geometry) -> list[Vector]:
    """Return the directions of the straight edges of a shape.

    They are the normals of its flat faces too. For a capsule, it is that of its axis.
    """
    if isinstance(geometry, Box):
        return [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    if isinstance(geometry, Cylinder | Capsule):
        return [(0.0, 0.0, 1.0)]
    return []


def bounding_radius(shape: Shape) -> float:
    """Return the radius of the smallest ball about a shape's centre that contains it."""
    if isinstance(shape, Box):
        x, y, z = shape.size
        return hypot(x / 2.0, y / 2.0, z / 2.0)
    if isinstance(shape, Cylinder):
        return hypot(shape.radius, shape.length / 2.0)
    return half_width(shape, (0.0, 0.0, 1.0))


def shrunk(shape: Shape, scale: float) -> Shape:
    """Return a shape with its lengths divided by a scale."""
    if isinstance(shape, Box):
        x, y, z = shape.size
        return Box((x / scale, y / scale, z / scale))
    if isinstance(shape, Cylinder | Capsule):
        return type(shape)(shape.radius / scale, shape.length / scale)
    return Sphere(shape.radius / scale)


def _signed_half(size: float, component: float, tie: float) -> float:
    if abs(component) <= tie:
        return 0.0
    if component > 0.0:
        return abs(size) / 2.0
    return -abs(size) / 2.0


class ShapeDifference(Named):
    """The differences of two shapes in metres.

    They are how far the centres are apart, the largest difference of a size, and how far the turn
    of one against the other moves a point of the surface. `angle` is that turn in degrees.
    """

    apart: float
    size: float
    turn: float
    angle: float

    @property
    def largest(self) -> float:
        """The largest of the differences in metres; NaN where they overflow."""
        three = (self.apart, self.size, self.turn)
        if sum(three) < inf:
            return max(three)
        return nan


class PlacedShape(NamedTuple):
    """A shape with its pose in a frame, T_frame_shape."""

    geometry: Geometry
    pose: Transform

    def extent(self, direction: Vector) -> tuple[float, float]:
        """Return the smallest and largest coordinate along a unit direction of the frame.

        They are in metres.

        Raises UnknownShape for a mesh.
        """
        middle = dot(self.pose.translation, direction)
        half = half_width(self.geometry, self.pose.unrotate(direction))
        return (middle - half, middle + half)

    def farthest(self, direction: Vector) -> Vector:
        """Return the farthest point along a direction of the frame.

        Returns the middle of the farthest points if several tie.

        It is in metres, in the frame. Raises UnknownShape for a mesh.
        """
        return self.pose.apply(support(self.geometry, self.pose.unrotate(direction)))

    def is_around(self, other: "PlacedShape") -> bool:
        """Return whether another shape is inside of this one, as far as its bounding box tells.

        It is False where one is a mesh.
        """
        if isinstance(self.geometry, Mesh) or isinstance(other.geometry, Mesh):
            return False
        x, y, z = (half_width(other.geometry, axis) for axis in AXES)
        T_self_other = self.pose.inverse() @ other.pose
        corners = product((-x, x), (-y, y), (-z, z))
        return all(_contains(self.geometry, T_self_other.apply(corner)) for corner in corners)

    def mismatch(
        self, other: "PlacedShape", tolerance: float, *, turned: bool = True
    ) -> ShapeDifference | None:
        """Return how two shapes differ, with as few differences as their symmetries allow.

        Those count that are beyond a tolerance.

        It is None for shapes of different kinds, and for different meshes. Without `turned`, their
        orientations do not count.
        """
        apart = hypot(*minus(self.pose.translation, other.pose.translation))
        differences = []
        for size, turn, angle in _differences_by_pose(*self, *other):
            if turned:
                differences.append(ShapeDifference(apart, size, turn, angle))
            else:
                differences.append(ShapeDifference(apart, size, 0.0, 0.0))

        def count_beyond(difference: ShapeDifference) -> int:
            return (not difference.size <= tolerance) + (not difference.turn <= tolerance)

        return min(differences, key=count_beyond, default=None)


def _contains(shape: Shape, at: Vector) -> bool:
    """Return whether a shape contains a point (m) in its frame, or touches it."""
    x, y, z = map(abs, at)
    if isinstance(shape, Box):
        a, b, c = (abs(edge) / 2.0 + _TOUCH for edge in shape.size)
        return x <= a and y <= b and z <= c
    if isinstance(shape, Sphere):
        return hypot(x, y, z) <= abs(shape.radius) + _TOUCH
    z -= abs(shape.length) / 2.0
    if isinstance(shape, Capsule) and z > 0.0:
        return hypot(x, y, z) <= abs(shape.radius) + _TOUCH
    return hypot(x, y) <= abs(shape.radius) + _TOUCH and z <= _TOUCH


def _differences_by_pose(
    a: Geometry, T_w_a: Transform, b: Geometry, T_w_b: Transform
) -> Iterator[_Difference]:
    """Yield the difference of size, turn and angle for each way to lay a shape over another.

    Aligned axes come first.
    """
    match a, b:
        case Sphere(), Sphere():
            yield _size_difference(a.radius, b.radius), 0.0, 0.0
        case Cylinder() | Capsule(), Cylinder() | Capsule() if type(a) is type(b):
            yield _long_difference(a, T_w_a, b, T_w_b)
        case Box(), Box():
            yield from _box_differences(a, T_w_a, b, T_w_b)
        case Mesh(), Mesh() if a == b:
            angle = turn_between(T_w_a.rotation, T_w_b.rotation)
            yield 0.0, 0.0 if angle <= _MESH_ANGLE else inf, angle


def _long_difference(
    a: Cylinder | Capsule, T_w_a: Transform, b: Cylinder | Capsule, T_w_b: Transform
) -> _Difference:
    """Return the size, turn and angle of the difference of two cylinders, or of two capsules."""
    size = max(_size_difference(a.radius, b.radius), _size_difference(a.length, b.length))
    lean = _nearest_chord(T_w_a.rotate(AXES[2]), T_w_b.rotate(AXES[2]))
    return size, hypot(*lean) * bounding_radius(a), _chord_angle(lean)


def _box_differences(a: Box, T_w_a: Transform, b: Box, T_w_b: Transform) -> Iterator[_Difference]:
    """Yield the size, turn and angle of the difference for each order of a box's edges."""
    axes_of_a = [T_w_a.rotate(axis) for axis in AXES]
    axes_of_b = [T_w_b.rotate(axis) for axis in AXES]
    for order in permutations(range(3)):
        sizes = []
        leans = []
        for one, other in enumerate(order):
            sizes.append(_size_difference(a.size[one], b.size[other]))
            leans.append(_nearest_chord(axes_of_a[one], axes_of_b[other]))
        yield max(sizes), _corner_motion(a.size, leans), max(map(_chord_angle, leans))


def _size_difference(one: float, other: float) -> float:
    return abs(one - other)  # a negative size is a mistake, which simulators refuse


def _nearest_chord(one: Vector, other: Vector) -> Vector:
    """Return the vector from a unit vector to another or to its opposite, whichever is nearer."""
    side = 1.0 if dot(one, other) >= 0.0 else -1.0
    return (side * other[0] - one[0], side * other[1] - one[1], side * other[2] - one[2])


def _chord_angle(chord: Vector) -> float:
    """Return the angle in degrees between the unit vectors that a vector connects."""
    return degrees(2.0 * asin(min(1.0, hypot(*chord) / 2.0)))


def _corner_motion(size: Vector, leans: list[Vector]) -> float:
    """Return how far the farthest corner of a box moves.

    The directions of its edges change by these vectors.
    """
    motions = []
    for signs in _CORNERS:
        x = y = z = 0.0
        for sign, edge, lean in zip(signs, size, leans, strict=True):
            half = sign * edge / 2.0
            x += half * lean[0]
            y += half * lean[1]
            z += half * lean[2]
        motions.append(hypot(x, y, z))
    return max(motions)
