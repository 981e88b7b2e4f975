"""Mass, centre of mass and inertia of uniform solids, alone or together.

Principal moments of an inertia tensor are here too.

The formulas for box, cylinder, sphere and half sphere, the parallel axis theorem and the rotation
of a tensor are those of textbooks of dynamics (Featherstone, Rigid Body Dynamics Algorithms, 2008,
section 2.13).
"""

from collections.abc import Iterable
from itertools import combinations, combinations_with_replacement
from math import hypot, isfinite, nan

from grader.base.records import Named
from grader.base.transforms import Rotation, Transform, Vector, add_up, dot, minus, weighted_mean
from grader.ros.urdf.model import (
    INERTIA,
    Box,
    Capsule,
    Collision,
    Geometry,
    Inertial,
    Mesh,
    Origin,
    Sphere,
    Visual,
)
from grader.ros.urdf.overlap import penetration
from grader.ros.urdf.shapes import Shape, UnknownShape, bounding_radius

Tensor = tuple[
    float, float, float, float, float, float
]  # ixx, ixy, ixz, iyy, iyz, izz as in a URDF, kg m^2


class MassProperties(Named):
    """The mass of a body in kg, its centre of mass in m, and its inertia about that.

    The inertia is along the axes of one frame.
    """

    mass: float
    centre: Vector
    inertia: Tensor


class Solid(Named):
    """Shapes of one density that are fixed to each other, each with its pose in one frame."""

    shapes: tuple[tuple[Shape, Transform], ...]

    @classmethod
    def of(cls, placed: Iterable[tuple[Geometry, Origin]]) -> "Solid":
        """Return the solid of shapes with their origins. Raises UnknownShape for a mesh."""
        shapes = []
        for geometry, origin in placed:
            if isinstance(geometry, Mesh):
                raise UnknownShape(geometry)
            shapes.append((geometry, origin.placed_in()))
        return cls(tuple(shapes))

    @property
    def size(self) -> float:
        """An upper bound on the distance of two of its points, in metres.

        For a single shape, it is that distance.
        """
        balls = [(pose.translation, bounding_radius(shape)) for shape, pose in self.shapes]
        return max(
            hypot(*minus(one, other)) + radius + reach
            for (one, radius), (other, reach) in combinations_with_replacement(balls, 2)
        )

    def difference(self, inertial: Inertial) -> "_SolidDifference":
        """Return how an <inertial> differs from it.

        Raises ValueError where its volume cannot be computed.
        """
        T_link_inertial = inertial.origin.placed_in()
        given = MassProperties(
            inertial.mass,
            T_link_inertial.translation,
            turned(inertial.inertia, T_link_inertial.rotation),
        )
        expected = uniform_solid(self.shapes, inertial.mass)
        largest = principal_moments(expected.inertia)[2]
        percent = nan
        if largest > 0.0:
            percent = 100.0 * largest_difference(given.inertia, expected.inertia) / largest
        distance = hypot(*minus(given.centre, expected.centre))
        return _SolidDifference(inertial, given, expected, percent, distance)

    def overlaps(self, allowed: float) -> bool:
        """Return whether two of its shapes overlap by more than `allowed` metres."""
        pairs = combinations(self.shapes, 2)
        return any(penetration(*one, *other, allowed) > 0.0 for one, other in pairs)


class _SolidDifference(Named):
    """How an <inertial> differs from a uniform solid of its mass.

    It has the inertia about any axis, in percent of the largest principal moment of the solid, and
    the centres of mass in metres.

    Both are in the frame of the link.
    """

    inertial: Inertial
    given: MassProperties
    solid: MassProperties
    percent: float
    distance: float

    def components(self, tolerance: float) -> list[tuple[str, float, float]]:
        """Return the names of the numbers of the <inertia> that are off.

        Each has what it is and should be, along the axes in which it is given. The tolerance is in
        percent.
        """
        expected = turned(self.solid.inertia, self.inertial.origin.placed_in().inverse().rotation)
        # Of a symmetric matrix that is more off, one number is.
        allowed = tolerance / 100.0 * principal_moments(expected)[2] / 3.0
        numbers = zip(INERTIA, self.inertial.inertia, expected, strict=True)
        return [row for row in numbers if not abs(row[1] - row[2]) <= allowed]


def solid_inertia(shape: Shape, mass: float) -> Tensor:
    """Return the inertia of a uniform solid about its centre, along the axes of the shape."""
    if isinstance(shape, Box):
        x, y, z = (edge * edge for edge in shape.size)
        return (mass * (y + z) / 12.0, 0.0, 0.0, mass * (x + z) / 12.0, 0.0, mass * (x + y) / 12.0)
    squared = shape.radius * shape.radius
    if isinstance(shape, Sphere):
        every = 0.4 * mass * squared
        return (every, 0.0, 0.0, every, 0.0, every)
    if isinstance(shape, Capsule):
        return _capsule_inertia(abs(shape.radius), abs(shape.length), mass)
    across = mass * (3.0 * squared + shape.length * shape.length) / 12.0
    return (across, 0.0, 0.0, across, 0.0, 0.5 * mass * squared)


def _capsule_inertia(radius: float, length: float, mass: float) -> Tensor:
    """Return the inertia of a uniform capsule: a cylinder, and two half spheres at its ends."""
    caps = mass * (4.0 * radius) / (4.0 * radius + 3.0 * length)
    cylinder = mass - caps
    squared = radius * radius
    along = 0.5 * cylinder * squared + 0.4 * caps * squared
    across = cylinder * (3.0 * squared + length * length) / 12.0
    # The centre of mass of a half sphere is 3/8 of its radius from its flat side.
    across += caps * (0.4 * squared + length * length / 4.0 + 3.0 / 8.0 * length * radius)
    return (across, 0.0, 0.0, across, 0.0, along)


def uniform_solid(shapes: Iterable[tuple[Shape, Transform]], mass: float) -> MassProperties:
    """Return the mass properties of shapes of one density and of this mass together.

    Each comes with its T_frame_shape.

    What two shapes share counts twice. Raises ValueError for shapes without a volume, and for
    numbers that are too large.
    """
    placed = [(shape, pose, shape.volume) for shape, pose in shapes]
    total = add_up(volume for _, _, volume in placed)
    if not (total > 0.0 and isfinite(total)):
        raise ValueError("the shapes have no volume that can be computed")
    parts = [(shape, pose, mass * (volume / total)) for shape, pose, volume in placed]
    return together(
        MassProperties(part, pose.translation, turned(solid_inertia(shape, part), pose.rotation))
        for shape, pose, part in parts
    )


def with_volume(elements: Iterable[Visual | Collision]) -> list[tuple[Geometry, Origin]]:
    """Return the shapes that have a volume, or may have one because they are meshes.

    Each is there once, with its origin.
    """
    placed = dict.fromkeys((element.geometry, element.origin) for element in elements)
    shapes = []
    for shape, origin in placed:
        has_volume = isinstance(shape, Mesh) or shape.volume > 0.0
        if has_volume and not shape.is_empty:
            shapes.append((shape, origin))
    return shapes


def together(bodies: Iterable[MassProperties]) -> MassProperties:
    """Return the mass properties of bodies that are fixed to each other.

    The sum of their masses must not be 0.
    """
    every = list(bodies)
    mass = add_up(body.mass for body in every)
    centre = weighted_mean([(body.mass, body.centre) for body in every])
    moved = [shifted(body.inertia, body.mass, minus(body.centre, centre)) for body in every]
    return MassProperties(mass, centre, _tensor(map(add_up, zip(*moved, strict=True))))


def turned(inertia: Tensor, T_a_b: Rotation) -> Tensor:
    """Return an inertia that is given along the axes of b along the axes of a."""
    xx, xy, xz, yy, yz, zz = inertia
    rows = (T_a_b[:3], T_a_b[3:6], T_a_b[6:])
    first, second, third = (
        (a * xx + b * xy + c * xz, a * xy + b * yy + c * yz, a * xz + b * yz + c * zz)
        for a, b, c in rows
    )
    return (
        dot(first, rows[0]),
        dot(first, rows[1]),
        dot(first, rows[2]),
        dot(second, rows[1]),
        dot(second, rows[2]),
        dot(third, rows[2]),
    )


def shifted(inertia: Tensor, mass: float, offset: Vector) -> Tensor:
    """Return the inertia of a body about a point at `offset` (m) from its centre of mass.

    This is the parallel axis theorem.
    """
    x, y, z = offset
    away = (y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y)
    return _tensor(about + mass * square for about, square in zip(inertia, away, strict=True))


def largest_difference(a: Tensor, b: Tensor) -> float:
    """Return the largest moment, in size, of the difference of two inertias, about any axis.

    Returns NaN where it overflows.
    """
    moments = principal_moments(_tensor(one - other for one, other in zip(a, b, strict=True)))
    return max(abs(moments[0]), abs(moments[2]))


def principal_moments(inertia: Tensor) -> Vector:
    """Return the principal moments, smallest first; NaN for numbers that are too large."""
    import numpy as np  # late: most rubrics examine no inertia

    if not (isfinite(sum(inertia)) and all(map(isfinite, inertia))):
        return (nan, nan, nan)
    xx, xy, xz, yy, yz, zz = inertia
    smallest, middle, largest = np.linalg.eigvalsh(
        ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    ).tolist()
    return (smallest, middle, largest)


def _tensor(values: Iterable[float]) -> Tensor:
    xx, xy, xz, yy, yz, zz = values
    return (xx, xy, xz, yy, yz, zz)
