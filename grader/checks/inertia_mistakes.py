"""The mistakes that explain a wrong inertia: what it would be the inertia of."""

from collections.abc import Iterator, Sequence
from itertools import combinations

from grader.robot.inertia import (
    MassProperties,
    Tensor,
    largest_difference,
    principal_moments,
    shifted,
    solid_inertia,
    turned,
)
from grader.robot.model import Box, Cylinder, Sphere
from grader.robot.shapes import Shape
from grader.robot.transforms import IDENTITY_ROTATION, Transform, Vector

_AXES: tuple[tuple[str, Vector], ...] = (("x", (1.0, 0.0, 0.0)), ("y", (0.0, 1.0, 0.0)), ("z", (0.0, 0.0, 1.0)))
_FIT = 0.02  # of the largest moment: an explanation is that close
_DISTINCT = 0.05  # of the largest moment: what an explanation changes is more
# How many times too large an inertia is, and the units that it then seems to be in.
_UNITS = (
    (1e3, "as if it were computed with grams"),
    (1e4, "as if it were computed with centimetres"),
    (1e6, "as if it were computed with millimetres"),
    (1e7, "as if it were given in g cm^2"),
    (1e9, "as if it were given in g mm^2"),
    (1e-3, "as if the mass were given in grams"),
)


def mistake_of(inertia: Tensor, solid: MassProperties, shapes: Sequence[tuple[Shape, Transform]]) -> str:
    """Return the known mistake that explains a wrong inertia of a solid, as a clause; empty if none does."""
    for cause, candidate in _candidates(solid, shapes):
        is_distinct = largest_difference(candidate, solid.inertia) > _DISTINCT * principal_moments(solid.inertia)[2]
        if is_distinct and _is_near(inertia, candidate):
            return f"it would fit if {cause}"
    return _scale_mistake(inertia, solid)


def _is_near(inertia: Tensor, candidate: Tensor) -> bool:
    return largest_difference(inertia, candidate) <= _FIT * principal_moments(candidate)[2]


def _candidates(solid: MassProperties, shapes: Sequence[tuple[Shape, Transform]]) -> Iterator[tuple[str, Tensor]]:
    """Yield the known mistakes in words, each with the inertia that results from it."""
    xx, xy, xz, yy, yz, zz = solid.inertia
    yield "ixy, ixz and iyz had the opposite sign", (xx, -xy, -xz, yy, -yz, zz)
    yield (
        "it were about the origin of the link, not about the centre of mass",
        shifted(solid.inertia, solid.mass, solid.centre),
    )
    if len(shapes) > 1:
        return
    (shape, pose), *_ = shapes
    name = type(shape).__name__.lower()
    for other, cause in _other_shapes(shape):
        yield cause, turned(solid_inertia(other, solid.mass), pose.rotation)
    if isinstance(shape, Cylinder):
        for axis, direction in _AXES:
            yield f"the axis of the cylinder were {axis}", _about(shape, solid.mass, direction)
    yield f"the {name} were not rotated", turned(solid_inertia(shape, solid.mass), IDENTITY_ROTATION)
    lengths = shape.size if isinstance(shape, Box) else (0.0, 0.0, shape.length) if isinstance(shape, Cylinder) else ()
    for length, (_, direction) in zip(lengths, _AXES, strict=False):
        x, y, z = pose.rotate(direction)
        end = (length * x / 2.0, length * y / 2.0, length * z / 2.0)
        yield f"it were about an end of the {name}, not about its centre", shifted(solid.inertia, solid.mass, end)


def _other_shapes(shape: Shape) -> Iterator[tuple[Shape, str]]:
    """Yield the shapes that are easily computed with instead, and the mistake."""
    if isinstance(shape, Box):
        for first, second in combinations(range(3), 2):
            size = list(shape.size)
            size[first], size[second] = size[second], size[first]
            names = f"{_AXES[first][0]} and {_AXES[second][0]}"
            yield Box((size[0], size[1], size[2])), f"the edges of the box along {names} were exchanged"
        return
    for factor, cause in ((2.0, "its diameter were the radius"), (0.5, "its radius were the diameter")):
        radius = factor * shape.radius
        yield Sphere(radius) if isinstance(shape, Sphere) else Cylinder(radius, shape.length), cause


def _about(cylinder: Cylinder, mass: float, axis: Vector) -> Tensor:
    """Return the inertia of a cylinder whose axis is one of those of its link."""
    across, *_, along = solid_inertia(cylinder, mass)
    x, y, z = (along if component else across for component in axis)
    return (x, 0.0, 0.0, y, 0.0, z)


def _scale_mistake(inertia: Tensor, solid: MassProperties) -> str:
    """Return how many times too large an inertia is, if that is its only mistake, and what may be the cause."""
    xx, xy, xz, yy, yz, zz = solid.inertia
    factor = (inertia[0] + inertia[3] + inertia[5]) / (xx + yy + zz)
    if not _is_near(inertia, (factor * xx, factor * xy, factor * xz, factor * yy, factor * yz, factor * zz)):
        return ""
    for unit, cause in _UNITS:
        if abs(factor / unit - 1.0) < _FIT:
            return f"it is {_times(factor)}, {cause}"
    return f"it is {_times(factor)}, as for a mass of {factor * solid.mass:.3g} kg"


def _times(factor: float) -> str:
    if factor >= 3.0:
        return f"{round_factor(factor)} times too large"
    if factor <= 1.0 / 3.0:
        return f"{round_factor(1.0 / factor)} times too small"
    return f"{100.0 * abs(factor - 1.0):.3g} % too {'large' if factor > 1.0 else 'small'}"


def round_factor(factor: float) -> str:
    """Return a factor or percentage rounded for reading: 61.2, 1,000."""
    return f"{factor:.3g}" if not 1e3 <= factor < 1e10 else f"{factor:,.0f}"
