"""Mass properties do not depend on the frame, add up, and have the principal moments that numpy computes."""

from math import isnan, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.transforms import IDENTITY, Transform, Vector, rotation_from_rpy
from grader.ros.urdf.mass_properties import (
    MassProperties,
    Tensor,
    largest_difference,
    principal_moments,
    shifted,
    solid_inertia,
    together,
    turned,
    uniform_solid,
)
from grader.ros.urdf.model import Box, Capsule, Cylinder, Sphere
from grader.ros.urdf.shapes import Shape

pytestmark = pytest.mark.slow

_edge = st.floats(0.01, 3.0)
_number = st.floats(-2.0, 2.0)
_vector = st.tuples(_number, _number, _number)
_tensor = st.tuples(*[_number] * 6)
shapes: st.SearchStrategy[Shape] = st.one_of(
    st.builds(Box, st.tuples(_edge, _edge, _edge)),
    st.builds(Cylinder, _edge, _edge),
    st.builds(Capsule, _edge, _edge),
    st.builds(Sphere, _edge),
)
poses = st.builds(lambda rpy, xyz: Transform(rotation_from_rpy(rpy), xyz), _vector, _vector)
placed = st.lists(st.tuples(shapes, poses), min_size=1, max_size=4)


def close(a: MassProperties, b: MassProperties) -> bool:
    """Return whether two bodies are equal but for rounding."""
    one, other = ((body.mass, *body.centre, *body.inertia) for body in (a, b))
    return np.allclose(one, other, rtol=0, atol=1e-9)


def matrix(inertia: Tensor) -> "np.ndarray[tuple[int, ...], np.dtype[np.float64]]":
    """Return an inertia as a matrix."""
    xx, xy, xz, yy, yz, zz = inertia
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


@pytest.mark.parametrize(
    ("shape", "moments"),
    [
        (Box((1.0, 2.0, 3.0)), (13.0, 10.0, 5.0)),
        (Box((-1.0, 2.0, -3.0)), (13.0, 10.0, 5.0)),
        (Cylinder(2.0, 1.0), (13.0, 13.0, 24.0)),
        (Sphere(5.0), (120.0, 120.0, 120.0)),
        (Capsule(5.0, 0.0), (120.0, 120.0, 120.0)),  # a sphere
    ],
)
def test_the_formulas_of_textbooks(shape: Shape, moments: Vector) -> None:
    """Of 12 kg: the moments about x, y and z; a negative size counts as a positive one."""
    xx, xy, xz, yy, yz, zz = solid_inertia(shape, 12.0)
    assert (xx, yy, zz) == pytest.approx(moments)
    assert (xy, xz, yz) == (0.0, 0.0, 0.0)


@given(placed, poses, st.floats(0.1, 10.0))
def test_the_frame_does_not_matter(
    parts: list[tuple[Shape, Transform]], T_a_b: Transform, mass: float
) -> None:
    """In another frame the centre is the same point and the inertia the same tensor."""
    here = uniform_solid(parts, mass)
    there = uniform_solid([(shape, T_a_b @ pose) for shape, pose in parts], mass)
    assert close(
        there, MassProperties(mass, T_a_b.apply(here.centre), turned(here.inertia, T_a_b.rotation))
    )
    assert np.allclose(
        principal_moments(there.inertia), principal_moments(here.inertia), rtol=0, atol=1e-9
    )


@given(placed, placed)
def test_bodies_add_up(
    first: list[tuple[Shape, Transform]], second: list[tuple[Shape, Transform]]
) -> None:
    """Bodies put together in two steps are those put together at once, and a body in halves is the body."""
    one, other = uniform_solid(first, 2.0), uniform_solid(second, 3.0)
    point = together([one, other, one])
    assert close(together([together([one, other]), one]), point)
    half = MassProperties(1.0, one.centre, principal_of_half(one.inertia))
    assert close(together([half, half]), one)


def principal_of_half(inertia: Tensor) -> Tensor:
    """Return half of an inertia."""
    xx, xy, xz, yy, yz, zz = (value / 2 for value in inertia)
    return (xx, xy, xz, yy, yz, zz)


def test_a_box_is_the_sum_of_its_halves() -> None:
    """Two boxes side by side are one box: the parallel axis theorem with the right sign."""
    halves = [(Box((0.5, 1.0, 2.0)), Transform(translation=(x, 0.3, 0.1))) for x in (-0.25, 0.25)]
    whole = [(Box((1.0, 1.0, 2.0)), Transform(translation=(0.0, 0.3, 0.1)))]
    assert close(uniform_solid(halves, 3.0), uniform_solid(whole, 3.0))


def test_the_parallel_axis_of_a_rod() -> None:
    """About its end a rod has a third of m l^2, about its centre a twelfth."""
    xx, *_ = shifted(solid_inertia(Box((0.0, 0.0, 2.0)), 3.0), 3.0, (0.0, 0.0, 1.0))
    assert xx == pytest.approx(3.0 * 2.0 * 2.0 / 3.0)


@given(_tensor)
def test_principal_moments_are_eigenvalues(inertia: Tensor) -> None:
    """The moments of any symmetric matrix are those of numpy, smallest first."""
    assert np.allclose(
        principal_moments(inertia), np.linalg.eigvalsh(matrix(inertia)), rtol=0, atol=1e-12
    )


@given(_tensor, _tensor)
def test_the_difference_is_a_norm(a: Tensor, b: Tensor) -> None:
    """The difference of two inertias is the largest moment, in size, of their difference."""
    assert largest_difference(a, b) == pytest.approx(
        np.linalg.norm(matrix(a) - matrix(b), 2), abs=1e-12
    )


@pytest.mark.parametrize(
    "inertia", [(1e308, 1e308, 0.0, 1e308, 0.0, 1e308), (float("inf"),) * 6, (float("nan"),) * 6]
)
def test_huge_numbers_have_no_moments(inertia: Tensor) -> None:
    """Where a sum overflows, the moments are NaN, which is within no tolerance."""
    assert all(map(isnan, principal_moments(inertia)))


def test_tiny_numbers_have_moments() -> None:
    """Numbers whose squares underflow have their moments, and 0 has 0."""
    assert principal_moments((1e-300, 0.0, 0.0, 2e-300, 0.0, 3e-300)) == pytest.approx(
        (1e-300, 2e-300, 3e-300)
    )
    assert principal_moments((0.0,) * 6) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("shape", [Box((1.0, 1.0, 0.0)), Sphere(1e200), Cylinder(1e-200, 1.0)])
def test_no_volume(shape: Shape) -> None:
    """A shape whose volume is 0, or too large, has no density."""
    with pytest.raises(ValueError, match="no volume"):
        uniform_solid([(shape, IDENTITY)], 1.0)


def test_the_volume_is_the_weight() -> None:
    """Of two shapes of one density the larger weighs more."""
    small, large = Cylinder(1.0, 1.0), Cylinder(1.0, 3.0)
    body = uniform_solid(
        [(small, IDENTITY), (large, Transform(translation=(4.0, 0.0, 0.0)))], 8.0 * pi
    )
    assert body.centre == pytest.approx((3.0, 0.0, 0.0))
