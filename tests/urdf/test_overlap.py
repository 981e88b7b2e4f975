"""The depth to which shapes overlap: closed forms, laws, sampled directions and an oracle."""

import random
import subprocess
import sys
from math import hypot, pi, sqrt
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from grader.base.transforms import IDENTITY, Transform, Vector, dot, minus, rotation_from_rpy
from grader.ros.urdf.model import Box, Capsule, Cylinder, Mesh, Sphere
from grader.ros.urdf.overlap import least_overlap, penetration
from grader.ros.urdf.shapes import PlacedShape, Shape, UnknownShape
from tests.examples import examples

pytestmark = pytest.mark.slow

slow = settings(deadline=None)  # the first depth of two tilted cylinders imports numpy

NEAR = 1e-4  # metres; the documented accuracy
FINE = 1e-6  # metres; the accuracy without tilted round shapes

CHASSIS = Box((0.6, 0.4, 0.2))
WHEEL = Cylinder(0.1, 0.05)


def at(x: float, y: float, z: float, rpy: Vector = (0.0, 0.0, 0.0)) -> Transform:
    """Return a pose from a position in metres and fixed-axis angles in radians."""
    return Transform(rotation_from_rpy(rpy), (x, y, z))


def moved(pose: Transform, way: float, direction: Vector) -> Transform:
    """Return a pose moved along a direction, metres."""
    x, y, z = (
        start + way * along for start, along in zip(pose.translation, direction, strict=True)
    )
    return Transform(pose.rotation, (x, y, z))


SIDEWAYS = (pi / 2, 0.0, 0.0)
HANDMADE = (1.5708, 0.0, 0.0)  # a quarter turn with the usual rounding

_sizes = st.floats(-3, 1).map(lambda power: 10.0**power) | st.sampled_from(
    (0.0, -0.2, 0.001, 0.5, 1.0)
)
boxes = st.builds(Box, st.tuples(_sizes, _sizes, _sizes))
cylinders = st.builds(Cylinder, _sizes, _sizes)
spheres = st.builds(Sphere, _sizes)
shapes = boxes | cylinders | spheres | st.builds(Capsule, _sizes, _sizes)
_places = st.floats(-1.5, 1.5) | st.sampled_from((0.0, 0.25, 1e-3, 30.0))
_angles = st.floats(-4, 4) | st.sampled_from((0.0, pi / 2, 1.5708, -pi / 2, pi, 1e-5, 1e-8))
poses = st.builds(at, _places, _places, _places, st.tuples(_angles, _angles, _angles))


def spread(count: int) -> list[Vector]:
    """Return unit directions, evenly distributed by the golden angle."""
    turn = pi * (3.0 - sqrt(5.0))
    heights = [1.0 - (2.0 * step + 1.0) / count for step in range(count)]
    flat = [rotation_from_rpy((0.0, 0.0, turn * step)) for step in range(count)]
    return [
        (sqrt(1 - z * z) * r[0], sqrt(1 - z * z) * r[3], z)
        for r, z in zip(flat, heights, strict=True)
    ]


DIRECTIONS = spread(400)


def distance_along(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, direction: Vector
) -> float:
    """Return how far b starts beyond the end of a along a direction; negative if they overlap."""
    return PlacedShape(b, T_w_b).extent(direction)[0] - PlacedShape(a, T_w_a).extent(direction)[1]


@pytest.mark.parametrize(
    ("a", "T_w_a", "b", "T_w_b", "expected"),
    [
        # two spheres: the distance of their centres less their radii
        (Sphere(0.1), at(0, 0, 0), Sphere(0.2), at(3, 4, 0), 4.7),
        (Sphere(0.1), at(0, 0, 0), Sphere(0.2), at(0, 0, 0.3), 0.0),
        (Sphere(0.1), at(0, 0, 0), Sphere(0.2), at(0.1, 0, 0), -0.2),
        (Sphere(0.1), at(1, 1, 1), Sphere(0.2), at(1, 1, 1), -0.3),
        (Sphere(0.0), at(1, 1, 1), Sphere(0.0), at(1, 1, 1), 0.0),
        # two boxes side by side: face, edge, corner, one inside the other
        (Box((1, 1, 1)), at(0, 0, 0), Box((2, 2, 2)), at(2, 0.3, 0.4), 0.5),
        (Box((1, 1, 1)), at(0, 0, 0), Box((2, 2, 2)), at(1.8, 1.9, 0.4), 0.5),
        (Box((1, 1, 1)), at(0, 0, 0), Box((2, 2, 2)), at(1.7, 1.8, 2.7), hypot(0.2, 0.3, 1.2)),
        (Box((1, 1, 1)), at(0, 0, 0), Box((2, 2, 2)), at(1.5, 0, 0), 0.0),
        (Box((1, 1, 1)), at(0, 0, 0), Box((2, 2, 2)), at(1.4, 1.3, 1.2), -0.1),
        (Box((1, 1, 1)), at(0, 0, 0), Box((3, 3, 3)), at(0.1, 0.2, 0.3), -1.7),
        (
            Box((1, 1, 1)),
            at(0, 0, 0),
            Box((1, 1, 1)),
            at(1.2, 0, 0, (0, 0, pi / 4)),
            0.7 - sqrt(0.5),
        ),
        # edge across edge: normal along x, halfway between two leaning boxes
        (
            Box((1, 1, 1)),
            at(0, 0, 0, (0, 0, pi / 4)),
            Box((1, 1, 1)),
            at(1.5, 0, 0, (0, pi / 4, 0)),
            1.5 - sqrt(2),
        ),
        (
            Box((1, 1, 1)),
            at(0, 0, 0, (0, 0, pi / 4)),
            Box((1, 1, 1)),
            at(1.4, 0, 0, (0, pi / 4, 0)),
            1.4 - sqrt(2),
        ),
        # a sphere by a box: beside a face, an edge, a corner; and inside
        (Box((2, 2, 2)), at(0, 0, 0), Sphere(0.5), at(2, 0.3, 0.2), 0.5),
        (Box((2, 2, 2)), at(0, 0, 0), Sphere(0.5), at(1.3, 1.4, 0), 0.0),
        (Box((2, 2, 2)), at(0, 0, 0), Sphere(0.1), at(2, 3, 3), 2.9),
        (Box((2, 2, 2)), at(0, 0, 0), Sphere(0.1), at(1.01, 1.02, 1.02), -0.07),
        (Box((2, 2, 2)), at(0, 0, 0), Sphere(0.1), at(0.7, 0.2, -0.1), -0.4),
        (Box((2, 2, 2)), at(0, 0, 0), Sphere(0.1), at(0, 0, 0), -1.1),
        # a sphere by a cylinder: beside, above, at the edge; inside, off and on the axis
        (Cylinder(1, 2), at(0, 0, 0), Sphere(0.1), at(3, 4, 0.5), 3.9),
        (Cylinder(1, 2), at(0, 0, 0), Sphere(0.1), at(0.3, 0.4, -2), 0.9),
        (Cylinder(1, 2), at(0, 0, 0), Sphere(0.1), at(0, 1.3, 1.4), 0.4),
        (Cylinder(1, 2), at(0, 0, 0), Sphere(0.1), at(0.6, 0, 0), -0.5),
        (Cylinder(1, 6), at(0, 0, 0), Sphere(0.1), at(0, 0, 0), -1.1),
        (Cylinder(1, 2), at(0, 0, 0), Sphere(0.1), at(0, 0, 0.9), -0.2),
        # a wheel by the side of a chassis
        (CHASSIS, at(0, 0, 0), WHEEL, at(0.2, 0.325, 0, SIDEWAYS), 0.1),
        (CHASSIS, at(0, 0, 0), WHEEL, at(0.2, 0.225, -0.05, SIDEWAYS), 0.0),
        (CHASSIS, at(0, 0, 0), WHEEL, at(0.2, 0.2025, -0.05, SIDEWAYS), -0.0225),
        (CHASSIS, at(0, 0, 0), WHEEL, at(0.2, 0.2025, -0.05, HANDMADE), -0.0225),
        (CHASSIS, at(0, 0, 0), WHEEL, at(0.2, 0, 0, SIDEWAYS), -0.2),
        (CHASSIS, at(0, 0, 0), WHEEL, at(0, 0, 0, SIDEWAYS), -0.2),
        # a pillar by the upright edge of a box, outside and with its axis beyond the edge
        (Box((2, 2, 2)), at(0, 0, 0), Cylinder(0.5, 1), at(1.6, 1.8, 0), 0.5),
        (Box((2, 2, 2)), at(0, 0, 0), Cylinder(0.5, 1), at(1.12, 1.16, 0), -0.3),
        # two wheels: side by side, on one axle, one in the other, crossed
        (WHEEL, at(0, 0, 0, SIDEWAYS), WHEEL, at(0.3, 0, 0, SIDEWAYS), 0.1),
        (WHEEL, at(0, 0, 0, SIDEWAYS), WHEEL, at(0.18, 0, 0, SIDEWAYS), -0.02),
        (WHEEL, at(0, 0, 0, SIDEWAYS), WHEEL, at(0, 0.35, 0, SIDEWAYS), 0.3),
        (WHEEL, at(0, 0, 0, SIDEWAYS), Cylinder(0.01, 0.4), at(0, 0.1, 0, HANDMADE), -0.11),
        (WHEEL, at(0, 0, 0, SIDEWAYS), Cylinder(0.01, 0.02), at(0, 0, 0, SIDEWAYS), -0.035),
        (Cylinder(0.1, 2), at(0, 0, 0), Cylinder(0.2, 2), at(0, 0.5, 0, (0, pi / 2, 0)), 0.2),
        (Cylinder(0.1, 2), at(0, 0, 0), Cylinder(0.2, 2), at(0, 0.25, 0, (0, pi / 3, 0)), -0.05),
        # plates, discs, rods and points
        (Box((1, 1, 0)), at(0, 0, 0), Box((1, 1, 0)), at(0.2, 0.3, 0.25), 0.25),
        (Box((1, 1, 0)), at(0, 0, 0), Box((1, 1, 0)), at(0.2, 0.3, 0), 0.0),
        (Box((1, 1, 0)), at(0, 0, 0), Box((1, 1, 0)), at(0, 0, 0, (pi / 2, 0, 0)), -0.5),
        (Box((1, 1, 0.001)), at(0, 0, 0), Sphere(0.1), at(0, 0, 0), -0.1005),
        (Cylinder(1, 0), at(0, 0, 0), Cylinder(1, 0), at(3, 0, 0), 1.0),
        (Cylinder(1, 0), at(0, 0, 0), Cylinder(0, 1), at(0, 0, 0.4), -0.1),
        (Cylinder(0, 2), at(0, 0, 0), Cylinder(0, 2), at(0, 1, 0, (0, pi / 2, 0)), 1.0),
        (Cylinder(0, 0), at(0, 0, 0), Box((0, 0, 0)), at(0, 0, 0), 0.0),
        (Cylinder(0, 0), at(0, 0, 0), Box((0, 0, 0)), at(0, 2, 0), 2.0),
        # a negative size counts like a positive one
        (Box((-2, 2, -2)), at(0, 0, 0), Cylinder(-1, -2), at(2.5, 0, 0), 0.5),
        # a capsule by a box: beside a face, along an edge, at a corner, through it
        (Box((2, 2, 2)), at(0, 0, 0), Capsule(0.5, 1), at(2, 0, 0), 0.5),
        (Box((2, 2, 2)), at(0, 0, 0), Capsule(0.5, 1), at(1.3, 1.4, 0), 0.0),
        (Box((2, 2, 2)), at(0, 0, 0), Capsule(0.1, 2), at(1.01, 1.02, 2.02), -0.07),
        (Box((2, 2, 2)), at(0, 0, 0), Capsule(0.1, 4), at(0.8, 0, 0), -0.3),
        # capsules by each other: side by side, end to end, crossed; by a sphere and a cylinder
        (Capsule(0.1, 2), at(0, 0, 0), Capsule(0.2, 2), at(0.25, 0, 0.5), -0.05),
        (Capsule(0.1, 2), at(0, 0, 0), Capsule(0.2, 2), at(0, 0, 2.2), -0.1),
        (Capsule(0.1, 2), at(0, 0, 0), Capsule(0.2, 2), at(0, 0.5, 0, (0, pi / 2, 0)), 0.2),
        (Capsule(0.1, 2), at(0, 0, 0), Sphere(0.2), at(0.12, 0.16, 0.9), -0.1),
        (Capsule(0.1, 2), at(0, 0, 0), Cylinder(1, 2), at(0, 0, 2.05), -0.05),
        # far apart, and large
        (Sphere(0.1), at(-1000, 0, 0), Cylinder(0.1, 1), at(1000, 0, 0), 1999.8),
        (Box((1e9, 1e9, 1e9)), at(0, 0, 0), Box((1e9, 1e9, 1e9)), at(0, 0, 2e9), 1e9),
    ],
)
def test_closed_forms(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, expected: float
) -> None:
    """A depth with a closed form is found, in both orders of the shapes; what is `expected` metres apart has none."""
    assert penetration(a, T_w_a, b, T_w_b) == pytest.approx(max(0.0, -expected), abs=FINE)
    assert penetration(b, T_w_b, a, T_w_a) == pytest.approx(max(0.0, -expected), abs=FINE)


@examples(30)
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses)
def test_no_direction_has_a_smaller_overlap(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform
) -> None:
    """Along each of 400 directions the shapes overlap at least as much."""
    least = -max(distance_along(a, T_w_a, b, T_w_b, direction) for direction in DIRECTIONS)
    assert penetration(a, T_w_a, b, T_w_b) <= max(0.0, least) + NEAR


@slow
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses)
def test_both_orders_agree(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> None:
    """The depth of b in a is that of a in b."""
    assert penetration(b, T_w_b, a, T_w_a) == pytest.approx(
        penetration(a, T_w_a, b, T_w_b), abs=NEAR
    )


@slow
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses, T_v_w=poses)
def test_a_common_motion_changes_nothing(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, T_v_w: Transform
) -> None:
    """In another frame the depth is the same."""
    other = penetration(a, T_v_w @ T_w_a, b, T_v_w @ T_w_b)
    assert other == pytest.approx(penetration(a, T_w_a, b, T_w_b), abs=NEAR)


def away(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> Vector:
    """Return the direction of least overlap in the world, from a to b."""
    x, y, z = T_w_a.rotate(least_overlap(a, b, T_w_a.inverse() @ T_w_b))
    return (
        (x, y, z)
        if dot((x, y, z), minus(T_w_b.translation, T_w_a.translation)) >= 0.0
        else (-x, -y, -z)
    )


@slow
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses)
def test_the_depth_is_the_smallest_separating_motion(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform
) -> None:
    """Moved by the depth the shapes touch; moved by less they still overlap."""
    depth, direction = penetration(a, T_w_a, b, T_w_b), away(a, T_w_a, b, T_w_b)
    assert penetration(a, T_w_a, b, moved(T_w_b, depth, direction), NEAR) == 0.0
    if depth > 0.001:
        for less in (0.0005, 0.5 * depth):
            assert (
                0.0 < penetration(a, T_w_a, b, moved(T_w_b, depth - less, direction)) <= less + NEAR
            )


@slow
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses, allowed=st.sampled_from((0.0, 1e-3, 0.1)))
def test_a_depth_counts_only_beyond_the_allowed_one(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, allowed: float
) -> None:
    """It is 0 up to the allowed depth, and the depth beyond it."""
    depth, whole = penetration(a, T_w_a, b, T_w_b, allowed), penetration(a, T_w_a, b, T_w_b)
    assert depth == 0.0 or depth > allowed
    assert depth == (pytest.approx(whole) if depth else 0.0)
    if whole > allowed + NEAR:
        assert depth > 0.0


@pytest.mark.parametrize(
    ("pose", "allowed", "expected"),
    [
        (at(0.2, 0.225, -0.05, SIDEWAYS), 0.0, 0.0),
        (at(0.2, 0.225, -0.05, HANDMADE), 1e-6, 0.0),
        (at(0.2, 0.2025, -0.05, SIDEWAYS), 0.0, 0.0225),
        (at(0.2, 0.2025, -0.05, SIDEWAYS), 0.0225, 0.0),
        (at(0.2, 0.2025, -0.05, SIDEWAYS), 0.0224, 0.0225),
        (at(3.0, 0.0, 0.0, SIDEWAYS), 0.0, 0.0),
        (at(0.38, 0.27, 0.16, (0.5, 0.6, 0.7)), 0.0, 0.0),
    ],
)
def test_a_wheel_by_a_chassis(pose: Transform, allowed: float, expected: float) -> None:
    """Touching is no overlap, and a depth counts only beyond the allowed one."""
    assert penetration(CHASSIS, IDENTITY, WHEEL, pose, allowed) == pytest.approx(expected, abs=1e-9)


def test_wheels_and_chassis_do_not_load_numpy() -> None:
    """Parts that are separate, touch, or intersect squarely are compared without numpy."""
    program = """
import sys
from grader.ros.urdf.model import Box, Cylinder
from grader.ros.urdf.overlap import penetration
from grader.base.transforms import IDENTITY, Transform, rotation_from_rpy
sideways = rotation_from_rpy((1.5708, 0.0, 0.0))
for y in (0.5, 0.225, 0.2025, 0.0):
    penetration(Box((0.6, 0.4, 0.2)), IDENTITY, Cylinder(0.1, 0.05), Transform(sideways, (0.2, y, 0.0)))
assert "numpy" not in sys.modules
"""
    subprocess.run([sys.executable, "-c", program], check=True)


def test_a_mesh_is_refused() -> None:
    """A mesh has an unknown size."""
    mesh: Any = Mesh("wheel.stl")
    for pair in ((CHASSIS, mesh), (mesh, CHASSIS)):
        with pytest.raises(UnknownShape):
            penetration(pair[0], IDENTITY, pair[1], IDENTITY)


_extreme = st.floats(allow_nan=False, allow_infinity=False)
_extreme_shapes = (
    st.builds(Box, st.tuples(_extreme, _extreme, _extreme))
    | st.builds(Cylinder, _extreme, _extreme)
    | st.builds(Capsule, _extreme, _extreme)
    | st.builds(Sphere, _extreme)
)


@slow
@given(a=_extreme_shapes, b=_extreme_shapes, x=_extreme, y=_extreme, z=_extreme, pose=poses)
@example(
    a=Sphere(1.7e308),
    b=Cylinder(1.7e308, 1.7e308),
    x=-1.7e308,
    y=1.7e308,
    z=1.7e308,
    pose=at(0, 0, 0),
)
def test_any_finite_input_has_a_result(
    a: Shape, b: Shape, x: float, y: float, z: float, pose: Transform
) -> None:
    """Sizes and positions anywhere in the range of floats give a number."""
    assert penetration(a, pose, b, Transform(pose.rotation, (x, y, z))) >= 0.0


_KINDS = (Box, Cylinder, Capsule, Sphere)


class Oracle:
    """Signed distances by coal (github.com/coal-library/coal), another implementation of the same question."""

    def __init__(self, coal: Any) -> None:
        self._coal = coal
        self._request = coal.DistanceRequest()
        self._request.gjk_tolerance = self._request.epa_tolerance = 1e-8
        self._request.gjk_max_iterations = self._request.epa_max_iterations = 1000

    def _shape(self, shape: Shape) -> Any:
        if isinstance(shape, Box):
            return self._coal.Box(*shape.size)
        if isinstance(shape, Cylinder):
            return self._coal.Cylinder(shape.radius, shape.length)
        if isinstance(shape, Capsule):
            return self._coal.Capsule(shape.radius, shape.length)
        return self._coal.Sphere(shape.radius)

    def distance(self, a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> float:
        """Return the signed distance, metres."""
        import numpy as np

        posed = []
        for shape, pose in ((a, T_w_a), (b, T_w_b)):
            matrix = np.asarray(pose)
            posed += [self._shape(shape), self._coal.Transform3s(matrix[:3, :3], matrix[:3, 3])]
        return float(self._coal.distance(*posed, self._request, self._coal.DistanceResult()))


@pytest.fixture(scope="module")
def oracle() -> Oracle:
    """Return the oracle, if it is installed."""
    return Oracle(pytest.importorskip("coal", reason="the oracle extra is not installed"))


def random_shape(rng: random.Random, kind: type[Shape]) -> Shape:
    """Return a random shape, from 3 mm to 3 m."""
    one, two, three = (10 ** rng.uniform(-2.5, 0.5) for _ in range(3))
    if kind is Box:
        return Box((one, two, three))
    return kind(one, two) if kind in (Cylinder, Capsule) else Sphere(one)


def random_pose(rng: random.Random, size: float) -> Transform:
    """Return a random pose with its origin about `size` from the world's, one in three along the axes."""
    rpy = [
        rng.choice((0.0, pi / 2, 1.5708)) if rng.random() < 0.3 else rng.uniform(-4, 4)
        for _ in range(3)
    ]
    x, y, z = (
        rng.choice((0.0, size)) if rng.random() < 0.3 else rng.gauss(0.0, size / 2)
        for _ in range(3)
    )
    return at(x, y, z, (rpy[0], rpy[1], rpy[2]))


@pytest.mark.parametrize("second", _KINDS)
@pytest.mark.parametrize("first", _KINDS)
def test_coal_agrees(oracle: Oracle, first: type[Shape], second: type[Shape]) -> None:
    """No depth differs from coal's, except depths of coal that coal itself refutes.

    Its expanding polytope may stop early and return a depth that is too large: if b is moved by our smaller depth,
    coal finds no overlap.
    """
    rng = random.Random(f"{first.__name__} {second.__name__}")
    for _ in range(1500):
        a, b = random_shape(rng, first), random_shape(rng, second)
        size = hypot(
            *(
                high - low
                for shape in (a, b)
                for low, high in [PlacedShape(shape, IDENTITY).extent(DIRECTIONS[0])]
            )
        )
        pair = (a, random_pose(rng, 0.1), b, random_pose(rng, size))
        own, theirs = penetration(*pair), -oracle.distance(*pair)
        if own != pytest.approx(max(0.0, theirs), abs=NEAR):
            assert 0.0 < own < theirs, pair
            parted = moved(pair[3], NEAR + own, away(*pair))
            assert oracle.distance(a, pair[1], b, parted) >= 0.0, pair
