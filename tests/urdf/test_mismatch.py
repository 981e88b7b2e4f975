"""The difference of two shapes: the same in every frame, none for a symmetry, and as large as a shift, a size or a turn."""

from math import pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.transforms import (
    IDENTITY,
    Transform,
    Vector,
    rotation_about,
    rotation_from_rpy,
    turn_between,
)
from grader.ros.urdf.model import Box, Cylinder, Sphere
from grader.ros.urdf.shapes import PlacedShape, Shape

pytestmark = pytest.mark.slow

TOLERANCE = 0.002
BRICK, ROD, BALL = Box((0.6, 0.4, 0.2)), Cylinder(0.1, 0.5), Sphere(0.1)
HALF_TURN = rotation_from_rpy((pi, 0.0, 0.0))
_number = st.floats(-2.0, 2.0)
_vector = st.tuples(_number, _number, _number)
poses = st.builds(lambda rpy, xyz: Transform(rotation_from_rpy(rpy), xyz), _vector, _vector)
shapes = st.sampled_from((BRICK, ROD, BALL))


@given(shapes, poses, poses, poses)
def test_the_frame_does_not_matter(
    shape: Shape, one: Transform, other: Transform, frame: Transform
) -> None:
    """Seen from another frame, two shapes differ as much."""
    here, there = (
        PlacedShape(shape, one).mismatch(PlacedShape(shape, other), TOLERANCE),
        PlacedShape(shape, frame @ one).mismatch(PlacedShape(shape, frame @ other), TOLERANCE),
    )
    assert here is not None
    assert there is not None
    assert (here.apart, here.size, here.turn) == pytest.approx(
        (there.apart, there.size, there.turn), abs=1e-9
    )


@given(shapes, poses)
def test_a_half_turn_is_a_symmetry(shape: Shape, pose: Transform) -> None:
    """Every shape is the same after half a turn about x."""
    found = PlacedShape(shape, pose).mismatch(
        PlacedShape(shape, pose @ Transform(HALF_TURN)), TOLERANCE
    )
    assert found is not None
    assert found.largest == pytest.approx(0.0, abs=1e-9)


@given(shapes, poses, _vector)
def test_a_shift_is_the_distance_of_the_centres(
    shape: Shape, pose: Transform, shift: Vector
) -> None:
    """A shift counts in full, whatever its direction."""
    found = PlacedShape(shape, pose).mismatch(
        PlacedShape(shape, Transform(translation=shift) @ pose), TOLERANCE
    )
    assert found is not None
    assert found.largest == pytest.approx(sum(value * value for value in shift) ** 0.5, abs=1e-9)


@given(st.floats(0.0, pi / 4))
def test_a_turn_moves_the_farthest_point(angle: float) -> None:
    """A cylinder that leans moves the points on its rims, a box that turns about its edge moves its corners."""
    leaning = Transform(rotation_about((1.0, 0.0, 0.0), angle))
    for shape, radius in ((ROD, (0.1**2 + 0.25**2) ** 0.5), (BRICK, (0.2**2 + 0.1**2) ** 0.5)):
        found = PlacedShape(shape, IDENTITY).mismatch(PlacedShape(shape, leaning), TOLERANCE)
        assert found is not None
        assert found.turn == pytest.approx(2.0 * radius * sin(angle / 2.0), abs=1e-9)


@pytest.mark.parametrize(("one", "other"), [(BRICK, ROD), (ROD, BALL), (BALL, BRICK)])
def test_kinds_are_not_compared(one: Shape, other: Shape) -> None:
    """A box is no cylinder, whatever their sizes."""
    assert PlacedShape(one, IDENTITY).mismatch(PlacedShape(other, IDENTITY), TOLERANCE) is None


@given(_vector, st.floats(0.0, 180.0))
def test_the_angle_between_rotations(rpy: Vector, angle: float) -> None:
    """It is the angle of the rotation from one to the other."""
    one = Transform(rotation_from_rpy(rpy))
    other = one @ Transform(rotation_about((0.6, 0.0, 0.8), angle * pi / 180.0))
    assert turn_between(one.rotation, other.rotation) == pytest.approx(angle, abs=1e-5)
