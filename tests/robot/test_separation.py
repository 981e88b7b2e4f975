"""Distances and depths between shapes: closed forms, laws, sampled directions and an oracle."""

import random
import subprocess
import sys
from math import hypot, inf, pi, sqrt
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from grader.robot.model import Box, Cylinder, Mesh, Sphere
from grader.robot.separation import penetration, separation
from grader.robot.shapes import Shape, UnknownShape, extent
from grader.robot.transforms import IDENTITY, Transform, Vector, rotation_from_rpy, unit
from tests.examples import examples

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
    x, y, z = (start + way * along for start, along in zip(pose.translation, direction, strict=True))
    return Transform(pose.rotation, (x, y, z))


SIDEWAYS = (pi / 2, 0.0, 0.0)
HANDMADE = (1.5708, 0.0, 0.0)  # a quarter turn with the usual rounding

_sizes = st.floats(-3, 1).map(lambda power: 10.0**power) | st.sampled_from((0.0, -0.2, 0.001, 0.5, 1.0))
boxes = st.builds(Box, st.tuples(_sizes, _sizes, _sizes))
cylinders = st.builds(Cylinder, _sizes, _sizes)
spheres = st.builds(Sphere, _sizes)
shapes = boxes | cylinders | spheres
_places = st.floats(-1.5, 1.5) | st.sampled_from((0.0, 0.25, 1e-3, 30.0))
_angles = st.floats(-4, 4) | st.sampled_from((0.0, pi / 2, 1.5708, -pi / 2, pi, 1e-5, 1e-8))
poses = st.builds(at, _places, _places, _places, st.tuples(_angles, _angles, _angles))


def spread(count: int) -> list[Vector]:
    """Return unit directions, evenly distributed by the golden angle."""
    turn = pi * (3.0 - sqrt(5.0))
    heights = [1.0 - (2.0 * step + 1.0) / count for step in range(count)]
    flat = [rotation_from_rpy((0.0, 0.0, turn * step)) for step in range(count)]
    return [(sqrt(1 - z * z) * r[0], sqrt(1 - z * z) * r[3], z) for r, z in zip(flat, heights, strict=True)]


DIRECTIONS = spread(400)


def distance_along(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, direction: Vector) -> float:
    """Return how far b starts beyond the end of a along a direction; negative if they overlap."""
    return extent(b, T_w_b, direction)[0] - extent(a, T_w_a, direction)[1]


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
        (Box((1, 1, 1)), at(0, 0, 0), Box((1, 1, 1)), at(1.2, 0, 0, (0, 0, pi / 4)), 0.7 - sqrt(0.5)),
        # edge across edge: normal along x, halfway between two leaning boxes
        (Box((1, 1, 1)), at(0, 0, 0, (0, 0, pi / 4)), Box((1, 1, 1)), at(1.5, 0, 0, (0, pi / 4, 0)), 1.5 - sqrt(2)),
        (Box((1, 1, 1)), at(0, 0, 0, (0, 0, pi / 4)), Box((1, 1, 1)), at(1.4, 0, 0, (0, pi / 4, 0)), 1.4 - sqrt(2)),
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
        # far apart, and large
        (Sphere(0.1), at(-1000, 0, 0), Cylinder(0.1, 1), at(1000, 0, 0), 1999.8),
        (Box((1e9, 1e9, 1e9)), at(0, 0, 0), Box((1e9, 1e9, 1e9)), at(0, 0, 2e9), 1e9),
    ],
)
def test_closed_forms(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, expected: float) -> None:
    """A distance with a closed form is found, in both orders of the shapes."""
    assert separation(a, T_w_a, b, T_w_b).distance == pytest.approx(expected, abs=FINE)
    assert separation(b, T_w_b, a, T_w_a).distance == pytest.approx(expected, abs=FINE)


def test_the_direction_points_from_the_first_shape_to_the_second() -> None:
    """The direction is in world coordinates, for a distance and for a depth."""
    turned = (0.0, 0.0, pi / 2)
    apart = separation(CHASSIS, at(5, 5, 5, turned), Sphere(0.1), at(5, 6, 5))
    cutting = separation(CHASSIS, at(5, 5, 5, turned), Sphere(0.1), at(5, 5, 5.06))
    assert (apart.distance, *apart.direction) == pytest.approx((0.6, 0.0, 1.0, 0.0))
    assert (cutting.distance, *cutting.direction) == pytest.approx((-0.14, 0.0, 0.0, 1.0))


@slow
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses)
def test_the_distance_is_that_along_the_direction(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> None:
    """The extents of the shapes along the unit direction are that far apart."""
    found = separation(a, T_w_a, b, T_w_b)
    assert hypot(*found.direction) == pytest.approx(1.0)
    assert distance_along(a, T_w_a, b, T_w_b, found.direction) == pytest.approx(found.distance, abs=1e-9)


@examples(30)
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses)
def test_no_other_direction_has_a_larger_distance(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> None:
    """Along none of 400 directions, nor along those close to the answer, are the shapes farther apart."""
    found = separation(a, T_w_a, b, T_w_b)
    near = [[0.05 * along + found.direction[i] for i, along in enumerate(way)] for way in DIRECTIONS[::8]]
    nearby = [unit((x, y, z)) or found.direction for x, y, z in near]
    widest = max(distance_along(a, T_w_a, b, T_w_b, direction) for direction in [*DIRECTIONS, *nearby])
    assert widest <= found.distance + NEAR


@slow
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses)
def test_both_orders_agree(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> None:
    """The distance from b to a is the distance from a to b."""
    other, back = separation(a, T_w_a, b, T_w_b), separation(b, T_w_b, a, T_w_a)
    assert other.distance == pytest.approx(back.distance, abs=NEAR)


@slow
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses, T_v_w=poses)
def test_a_common_motion_changes_nothing(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, T_v_w: Transform
) -> None:
    """In another frame the distance is the same."""
    current, other = separation(a, T_w_a, b, T_w_b), separation(a, T_v_w @ T_w_a, b, T_v_w @ T_w_b)
    assert other.distance == pytest.approx(current.distance, abs=NEAR)


@slow
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses)
def test_the_depth_is_the_smallest_separating_motion(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> None:
    """Moved along the direction by minus the distance the shapes touch; a little less and they still overlap."""
    found = separation(a, T_w_a, b, T_w_b)
    touching = separation(a, T_w_a, b, moved(T_w_b, -found.distance, found.direction))
    assert touching.distance == pytest.approx(0.0, abs=NEAR)
    if found.distance < -0.001:
        for less in (0.0005, 0.5 * abs(found.distance)):
            cutting = separation(a, T_w_a, b, moved(T_w_b, -found.distance - less, found.direction))
            assert -less - NEAR <= cutting.distance < 0.0


@slow
@given(a=shapes, T_w_a=poses, b=shapes, T_w_b=poses, allowed=st.sampled_from((0.0, 1e-3, 0.1)))
def test_penetration_is_the_depth_beyond_the_allowed_one(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, allowed: float
) -> None:
    """It is 0 up to the allowed depth, and the depth of the separation beyond it."""
    depth, found = penetration(a, T_w_a, b, T_w_b, allowed), separation(a, T_w_a, b, T_w_b)
    assert depth == 0.0 or depth > allowed
    assert depth == (pytest.approx(-found.distance) if depth else 0.0)
    if found.distance < -allowed - NEAR:
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
from grader.robot.model import Box, Cylinder
from grader.robot.separation import penetration
from grader.robot.transforms import IDENTITY, Transform, rotation_from_rpy
sideways = rotation_from_rpy((1.5708, 0.0, 0.0))
for y in (0.5, 0.225, 0.2025, 0.0):
    penetration(Box((0.6, 0.4, 0.2)), IDENTITY, Cylinder(0.1, 0.05), Transform(sideways, (0.2, y, 0.0)))
assert "numpy" not in sys.modules
"""
    subprocess.run([sys.executable, "-c", program], check=True)


def test_a_mesh_has_no_separation() -> None:
    """A mesh has an unknown size, so both functions refuse it."""
    mesh: Any = Mesh("wheel.stl")
    for ask in (separation, penetration):
        with pytest.raises(UnknownShape):
            ask(CHASSIS, IDENTITY, mesh, IDENTITY)
        with pytest.raises(UnknownShape):
            ask(mesh, IDENTITY, CHASSIS, IDENTITY)


_extreme = st.floats(allow_nan=False, allow_infinity=False)
_extreme_shapes = (
    st.builds(Box, st.tuples(_extreme, _extreme, _extreme))
    | st.builds(Cylinder, _extreme, _extreme)
    | st.builds(Sphere, _extreme)
)


@slow
@given(a=_extreme_shapes, b=_extreme_shapes, x=_extreme, y=_extreme, z=_extreme, pose=poses)
@example(a=Sphere(1.7e308), b=Cylinder(1.7e308, 1.7e308), x=-1.7e308, y=1.7e308, z=1.7e308, pose=at(0, 0, 0))
def test_any_finite_input_has_a_result(a: Shape, b: Shape, x: float, y: float, z: float, pose: Transform) -> None:
    """Sizes and positions anywhere in the range of floats give a number and a unit direction."""
    found = separation(a, pose, b, Transform(pose.rotation, (x, y, z)))
    assert -inf <= found.distance <= inf
    assert hypot(*found.direction) == pytest.approx(1.0)
    assert penetration(a, pose, b, Transform(pose.rotation, (x, y, z))) >= 0.0


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
    return Cylinder(one, two) if kind is Cylinder else Sphere(one)


def random_pose(rng: random.Random, size: float) -> Transform:
    """Return a random pose with its origin about `size` from the world's, one in three along the axes."""
    rpy = [rng.choice((0.0, pi / 2, 1.5708)) if rng.random() < 0.3 else rng.uniform(-4, 4) for _ in range(3)]
    x, y, z = (rng.choice((0.0, size)) if rng.random() < 0.3 else rng.gauss(0.0, size / 2) for _ in range(3))
    return at(x, y, z, (rpy[0], rpy[1], rpy[2]))


@pytest.mark.parametrize("second", [Box, Cylinder, Sphere])
@pytest.mark.parametrize("first", [Box, Cylinder, Sphere])
def test_coal_agrees(oracle: Oracle, first: type[Shape], second: type[Shape]) -> None:
    """No distance differs from coal's, except depths of coal that coal itself refutes.

    Its expanding polytope may stop early and return a depth that is too large: if b is moved by our smaller depth,
    coal finds no overlap.
    """
    rng = random.Random(f"{first.__name__} {second.__name__}")
    for _ in range(1500):
        a, b = random_shape(rng, first), random_shape(rng, second)
        size = hypot(*(high - low for shape in (a, b) for low, high in [extent(shape, IDENTITY, DIRECTIONS[0])]))
        pair = (a, random_pose(rng, 0.1), b, random_pose(rng, size))
        own, theirs = separation(*pair), oracle.distance(*pair)
        if own.distance != pytest.approx(theirs, abs=NEAR):
            assert theirs < own.distance < 0.0, pair
            parted = moved(pair[3], NEAR - own.distance, own.direction)
            assert oracle.distance(a, pair[1], b, parted) >= 0.0, pair


def test_a_search_that_ends_early_bounds_the_distance(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rounding errors may keep it from an end: the direction that was found by then separates the shapes, too."""
    poses = at(0.0, 0.0, 0.0, (0.3, 0.2, 0.1)), at(0.9, 0.8, 0.7, (1.0, 0.5, 0.2))
    exact = separation(CHASSIS, poses[0], WHEEL, poses[1]).distance
    monkeypatch.setattr("grader.robot.separation._MAX_STEPS", 1)
    assert 0.0 < separation(CHASSIS, poses[0], WHEEL, poses[1]).distance < exact
