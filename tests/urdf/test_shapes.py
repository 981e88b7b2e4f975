"""Support points, extents and volumes, compared with points on the surfaces and with closed forms."""

from collections.abc import Callable
from math import cos, hypot, pi, sin
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.transforms import IDENTITY, Transform, Vector, dot, rotation_from_rpy, unit
from grader.ros.urdf.model import Box, Capsule, Cylinder, Geometry, Mesh, Sphere
from grader.ros.urdf.shapes import (
    PlacedShape,
    Shape,
    UnknownShape,
    half_width,
    support,
)

_sizes = st.floats(-3, 1).map(lambda power: 10.0**power) | st.sampled_from((0.0, -0.3, 1.0))
shapes = (
    st.builds(Box, st.tuples(_sizes, _sizes, _sizes))
    | st.builds(Cylinder, _sizes, _sizes)
    | st.builds(Capsule, _sizes, _sizes)
    | st.builds(Sphere, _sizes)
)
_coordinates = st.floats(-2, 2)
vectors = st.tuples(_coordinates, _coordinates, _coordinates)
_components = _coordinates | st.sampled_from((0.0, 1.0, -1.0, 1e-7))
directions = (
    st.tuples(_components, _components, _components)
    .map(unit)
    .filter(bool)
    .map(lambda found: found or (1, 0, 0))
)
poses = st.builds(lambda rpy, xyz: Transform(rotation_from_rpy(rpy), xyz), vectors, vectors)

LYING = Transform(rotation_from_rpy((pi / 2, 0.0, 0.0)), (1.0, 2.0, 3.0))
MESH = Mesh("wheel.stl")


def surface(shape: Shape) -> list[Vector]:
    """Return points on the surface of a shape, including its corners and edges."""
    steps = [-1.0, -0.5, 0.0, 0.5, 1.0]
    around = [(cos(turn * pi / 180), sin(turn * pi / 180)) for turn in range(360)]
    if isinstance(shape, Box):
        a, b, c = (size / 2 for size in shape.size)
        return [(a * x, b * y, c * z) for x in steps for y in steps for z in steps]
    if isinstance(shape, Cylinder):
        r, h = shape.radius, shape.length / 2
        return [
            (r * part * x, r * part * y, h * z)
            for x, y in around
            for z in (-1.0, 0.0, 1.0)
            for part in (0.0, 1.0)
        ]
    rings = [turn * pi / 36 for turn in range(37)]
    r = shape.radius
    ends = (shape.length / 2, -shape.length / 2) if isinstance(shape, Capsule) else (0.0,)
    return [
        (r * sin(ring) * x, r * sin(ring) * y, r * cos(ring) + end)
        for x, y in around[::10]
        for ring in rings
        for end in ends
    ]


def inside(shape: Shape, point: Vector) -> bool:
    """Return whether a shape contains a point, up to rounding."""
    x, y, z = point
    if isinstance(shape, Box):
        return all(
            abs(at) <= abs(size) / 2 + 1e-12 for at, size in zip(point, shape.size, strict=True)
        )
    if isinstance(shape, Cylinder):
        return hypot(x, y) <= abs(shape.radius) + 1e-12 and abs(z) <= abs(shape.length) / 2 + 1e-12
    if isinstance(shape, Capsule):
        z = max(abs(z) - abs(shape.length) / 2, 0.0)
    return hypot(x, y, z) <= abs(shape.radius) + 1e-12


@given(shape=shapes, direction=directions)
def test_no_surface_point_is_beyond_the_support_point(shape: Shape, direction: Vector) -> None:
    """The support point belongs to the shape, and no surface point is farther along the direction."""
    found = support(shape, direction)
    assert inside(shape, found)
    assert dot(found, direction) >= max(dot(point, direction) for point in surface(shape)) - 1e-7
    assert dot(found, direction) == pytest.approx(half_width(shape, direction), abs=1e-7)


@given(
    shape=shapes, direction=directions, factor=st.sampled_from((2.0**-900, 0.125, 4.0, 2.0**900))
)
def test_the_length_of_a_direction_does_not_matter(
    shape: Shape, direction: Vector, factor: float
) -> None:
    """Support points are the same for a direction of any length."""
    x, y, z = direction
    longer = support(shape, (factor * x, factor * y, factor * z))
    assert longer == pytest.approx(support(shape, direction), abs=1e-8)


@pytest.mark.parametrize(
    ("shape", "direction", "middle"),
    [
        (Box((2.0, 4.0, 6.0)), (0.0, 0.0, -1.0), (0.0, 0.0, -3.0)),
        (Box((2.0, 4.0, 6.0)), (0.0, 1.0, -1.0), (0.0, 2.0, -3.0)),
        (Box((2.0, 4.0, 6.0)), (1.0, 1.0, 1.0), (1.0, 2.0, 3.0)),
        (Box((2.0, 4.0, 6.0)), (1e-10, 1.0, -1e-10), (0.0, 2.0, 0.0)),
        (Box((2.0, 4.0, 6.0)), (1e-6, 1.0, -1e-6), (1.0, 2.0, -3.0)),
        (Box((-2.0, 0.0, 6.0)), (1.0, 1.0, 1.0), (1.0, 0.0, 3.0)),
        (Cylinder(1.0, 4.0), (0.0, 0.0, 5.0), (0.0, 0.0, 2.0)),
        (Cylinder(1.0, 4.0), (1e-10, 0.0, 1.0), (0.0, 0.0, 2.0)),
        (Cylinder(1.0, 4.0), (0.0, -1.0, 1e-10), (0.0, -1.0, 0.0)),
        (Cylinder(-1.0, -4.0), (3.0, 4.0, 1.0), (0.6, 0.8, 2.0)),
        (Sphere(-5.0), (0.0, 3.0, 4.0), (0.0, 3.0, 4.0)),
        (Box((2.0, 4.0, 6.0)), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        (Cylinder(1.0, 4.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        (Sphere(1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    ],
)
def test_several_support_points_give_their_centre(
    shape: Shape, direction: Vector, middle: Vector
) -> None:
    """If a face, an edge or a line is farthest as a whole, its centre is returned."""
    assert support(shape, direction) == pytest.approx(middle, abs=1e-12)


def test_the_lowest_point_of_a_lying_cylinder_is_the_middle_of_its_contact_line() -> None:
    """A wheel touches the ground below its centre."""
    assert PlacedShape(Cylinder(0.1, 0.05), LYING).farthest((0.0, 0.0, -1.0)) == pytest.approx(
        (1.0, 2.0, 2.9)
    )


@given(shape=shapes, pose=poses, direction=directions, shift=vectors)
def test_extents_move_with_the_shape(
    shape: Shape, pose: Transform, direction: Vector, shift: Vector
) -> None:
    """Moving a shape moves both ends of its extent by its motion along the direction."""
    (a, b, c), (x, y, z) = shift, pose.translation
    moved = Transform(pose.rotation, (x + a, y + b, z + c))
    low, high = PlacedShape(shape, pose).extent(direction)
    along = dot(shift, direction)
    assert PlacedShape(shape, moved).extent(direction) == pytest.approx(
        (low + along, high + along), abs=1e-12
    )


@given(shape=shapes, pose=poses, direction=directions)
def test_extents_agree_with_support_points(
    shape: Shape, pose: Transform, direction: Vector
) -> None:
    """The high end is at the support point, and the low end is the high end of the opposite direction."""
    low, high = PlacedShape(shape, pose).extent(direction)
    x, y, z = direction
    assert (-high, -low) == pytest.approx(PlacedShape(shape, pose).extent((-x, -y, -z)), abs=1e-12)
    assert dot(PlacedShape(shape, pose).farthest(direction), direction) == pytest.approx(
        high, abs=1e-7
    )
    centred_low, centred_high = PlacedShape(shape, IDENTITY).extent(direction)
    assert centred_high == pytest.approx(-centred_low)


def test_a_cylinder_tilted_by_a_nanoradian() -> None:
    """It reaches farther by its radius times the angle: nothing cancels near its axis."""
    assert half_width(Cylinder(1.0, 0.0), (1e-9, 0.0, 1.0)) == pytest.approx(1e-9, rel=1e-12)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        (Box((2.0, 3.0, 4.0)), 24.0),
        (Box((2.0, -3.0, 4.0)), 24.0),
        (Box((2.0, 0.0, 4.0)), 0.0),
        (Cylinder(2.0, 3.0), 12 * pi),
        (Cylinder(-2.0, -3.0), 12 * pi),
        (Capsule(-3.0, -2.0), 54 * pi),
        (Sphere(3.0), 36 * pi),
        (Sphere(-3.0), 36 * pi),
    ],
)
def test_volumes(shape: Shape, expected: float) -> None:
    """Volumes equal the textbook formulas; a negative size counts like a positive one."""
    assert shape.volume == pytest.approx(expected)


@pytest.mark.parametrize(
    ("geometry", "expected"),
    [
        (Box((1.0, 1.0, 1.0)), False),
        (Box((1.0, 1.0, 0.0)), False),
        (Box((1.0, 0.0, 0.0)), True),
        (Box((0.0, -0.0, 0.0)), True),
        (Cylinder(1.0, 0.0), False),
        (Cylinder(0.0, 1.0), True),
        (Sphere(0.0), True),
        (Sphere(-1.0), False),
        (MESH, False),
        (Mesh("wheel.stl", (0.0, 0.0, 1.0)), False),
        (Mesh("wheel.stl", (0.0, 0.0, 0.0)), True),
    ],
)
def test_shapes_without_area_are_empty(geometry: Geometry, expected: bool) -> None:
    """Plates and discs are visible; lines and points are not."""
    assert geometry.is_empty is expected


@pytest.mark.parametrize(
    "ask",
    [
        lambda: support(MESH, (1.0, 0.0, 0.0)),
        lambda: half_width(MESH, (1.0, 0.0, 0.0)),
        lambda: PlacedShape(MESH, IDENTITY).extent((1.0, 0.0, 0.0)),
        lambda: PlacedShape(MESH, IDENTITY).farthest((1.0, 0.0, 0.0)),
    ],
)
def test_the_size_of_a_mesh_is_unknown(ask: Callable[[], Any]) -> None:
    """Every function of the size of a mesh raises an error that names the mesh."""
    with pytest.raises(
        UnknownShape, match=r"'wheel\.stl' is unknown: mesh files are not opened"
    ) as caught:
        ask()
    assert caught.value.geometry is MESH


@given(shapes, poses, shapes, poses)
def test_no_point_of_a_shape_is_outside_of_one_around_it(
    outer: Shape, T_w_outer: Transform, inner: Shape, T_w_inner: Transform
) -> None:
    """What is around a shape reaches as far as it in every direction."""
    around, inside = PlacedShape(outer, T_w_outer), PlacedShape(inner, T_w_inner)
    if around.is_around(inside):
        for direction in (unit(point) for point in surface(inner)):
            if direction is not None:
                low, high = inside.extent(direction)
                most_low, most_high = around.extent(direction)
                assert most_low - 1e-6 <= low and high <= most_high + 1e-6


@pytest.mark.parametrize(
    ("outer", "is_around"),
    [
        (Box((0.2, 0.2, 0.2)), True),
        (Box((0.2, 0.2, 0.09)), False),
        (Cylinder(0.08, 0.1), True),
        (Cylinder(0.07, 0.1), False),
        (Cylinder(0.08, 0.09), False),
        (Capsule(0.08, 0.1), True),
        (Capsule(0.08, 0.01), False),
        (Sphere(0.09), True),
        (Sphere(0.08), False),
        (MESH, False),
    ],
)
def test_what_is_around_a_box(outer: Geometry, *, is_around: bool) -> None:
    """A cube with edges of 0.1 m reaches 0.0707 m from its axis, and 0.0866 m from its middle."""
    cube = Box((0.1, 0.1, 0.1))
    assert PlacedShape(outer, LYING).is_around(PlacedShape(cube, LYING)) == is_around
    assert not PlacedShape(outer, IDENTITY).is_around(PlacedShape(cube, LYING))
    assert not PlacedShape(outer, LYING).is_around(PlacedShape(MESH, LYING))
