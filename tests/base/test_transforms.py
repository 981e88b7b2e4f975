"""Rotations and poses by their laws, near-identity and near-singular ones included."""

from math import cos, hypot, inf, isfinite, nan, pi, sin
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from grader.base.transforms import (
    IDENTITY,
    IDENTITY_ROTATION,
    Rotation,
    Transform,
    Vector,
    cross,
    dot,
    minus,
    rotation_about,
    rotation_from_quaternion,
    rotation_from_rpy,
    unit,
)

Matrix = np.ndarray[Any, np.dtype[np.floating[Any]]]

_tiny = st.floats(-1e-6, 1e-6) | st.sampled_from((1e-300, 5e-324, -1e-16, 0.0, -0.0))
_quarter = st.builds(lambda turns, off: turns * pi / 2 + off, st.integers(-4, 4), _tiny)
angles = st.floats(-7, 7) | _tiny | _quarter
rpys = st.tuples(angles, angles, angles)
lengths = st.floats(-10, 10) | _tiny
vectors = st.tuples(lengths, lengths, lengths)
transforms = st.builds(lambda rpy, xyz: Transform(rotation_from_rpy(rpy), xyz), rpys, vectors)
directions = vectors.map(unit).filter(lambda found: found is not None)


def square(rotation: Rotation) -> Matrix:
    """Return a rotation as a 3 x 3 array."""
    return np.array(rotation).reshape(3, 3)


def near(one: Transform, other: Transform, within: float = 1e-12) -> bool:
    """Return whether two poses are equal up to rounding."""
    return bool(np.allclose(np.array(one), np.array(other), rtol=0, atol=within))


def elementary(axis: int, angle: float) -> Matrix:
    """Return the rotation about one coordinate axis, from its definition."""
    turned = np.eye(3)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    turned[first, first] = turned[second, second] = cos(angle)
    turned[second, first], turned[first, second] = sin(angle), -sin(angle)
    return turned


@given(rpy=rpys)
@example(rpy=(0.0, 0.0, 0.0))
def test_rpy_is_about_fixed_axes(rpy: Vector) -> None:
    """Roll about x, then pitch about the fixed y, then yaw about the fixed z (REP 103)."""
    roll, pitch, yaw = rpy
    expected = elementary(2, yaw) @ elementary(1, pitch) @ elementary(0, roll)
    assert np.allclose(square(rotation_from_rpy(rpy)), expected, rtol=0, atol=1e-15)


@given(rpy=rpys)
def test_rpy_round_trip(rpy: Vector) -> None:
    """The angles of a rotation give that rotation again, also near a pitch of a quarter turn."""
    pose = Transform(rotation_from_rpy(rpy))
    assert near(Transform(rotation_from_rpy(pose.rpy)), pose, within=3e-9)
    assert abs(pose.rpy[1]) <= pi / 2


@given(roll=angles, yaw=angles, off=st.floats(-1e-5, 1e-5) | _tiny, up=st.booleans())
@example(roll=0.3, yaw=1.0, off=0.0, up=True)
@example(roll=0.3, yaw=1.0, off=1.1e-9, up=True)
@example(roll=0.3, yaw=1.0, off=0.9e-9, up=False)
def test_rpy_round_trip_near_gimbal_lock(roll: float, yaw: float, off: float, up: bool) -> None:
    """If roll and yaw turn about the same axis, the rotation is still the same."""
    pitch = pi / 2 + off if up else -pi / 2 + off
    pose = Transform(rotation_from_rpy((roll, pitch, yaw)))
    assert near(Transform(rotation_from_rpy(pose.rpy)), pose, within=3e-9)


@given(rpy=st.tuples(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1)))
def test_rpy_angles_are_unique_away_from_gimbal_lock(rpy: Vector) -> None:
    """Angles within half a turn, pitch within a quarter, are returned unchanged."""
    assert Transform(rotation_from_rpy(rpy)).rpy == pytest.approx(rpy, abs=1e-13)


@given(rpy=st.tuples(_tiny, _tiny, _tiny))
def test_tiny_angles_are_kept(rpy: Vector) -> None:
    """Angles far below the rounding of 1 are not lost."""
    assert Transform(rotation_from_rpy(rpy)).rpy == pytest.approx(rpy, rel=1e-5, abs=1e-11)


@given(pose=transforms)
def test_an_inverse_undoes(pose: Transform) -> None:
    """A pose and its inverse make the identity, on both sides; the inverse's inverse is the pose."""
    assert near(pose @ pose.inverse(), IDENTITY)
    assert near(pose.inverse() @ pose, IDENTITY)
    assert near(pose.inverse().inverse(), pose)


@given(one=transforms, two=transforms, three=transforms)
def test_composition_is_that_of_matrices(one: Transform, two: Transform, three: Transform) -> None:
    """The product equals that of 4 x 4 matrices, is associative, and its inverse is the reversed product of inverses."""
    assert np.allclose(np.array(one @ two), np.array(one) @ np.array(two), rtol=0, atol=1e-12)
    assert near((one @ two) @ three, one @ (two @ three))
    assert near((one @ two).inverse(), two.inverse() @ one.inverse())


@given(pose=transforms)
def test_the_identity_changes_nothing(pose: Transform) -> None:
    """Exactly nothing, on both sides."""
    assert IDENTITY @ pose == pose
    assert pose @ IDENTITY == pose


@given(one=transforms, two=transforms, point=vectors)
def test_a_product_applies_its_factors(one: Transform, two: Transform, point: Vector) -> None:
    """The right factor is applied first."""
    assert (one @ two).apply(point) == pytest.approx(one.apply(two.apply(point)), abs=1e-12)
    assert one.inverse().apply(one.apply(point)) == pytest.approx(point, abs=1e-12)


@given(pose=transforms, direction=vectors, point=vectors)
def test_directions_are_not_translated(pose: Transform, direction: Vector, point: Vector) -> None:
    """A direction is the difference of two points; its inverse gives it back; its length stays."""
    head = pose.apply((point[0] + direction[0], point[1] + direction[1], point[2] + direction[2]))
    assert pose.rotate(direction) == pytest.approx(minus(head, pose.apply(point)), abs=1e-12)
    assert pose.unrotate(pose.rotate(direction)) == pytest.approx(direction, abs=1e-12)
    assert hypot(*pose.rotate(direction)) == pytest.approx(hypot(*direction), abs=1e-12)


@given(axis=directions, angle=angles)
def test_a_turn_about_an_axis(axis: Vector, angle: float) -> None:
    """It is orthonormal, keeps its axis, turns orthogonal vectors by the angle, right-handed, and has an inverse."""
    rotation = rotation_about(axis, angle)
    turned = square(rotation)
    assert np.allclose(turned.T @ turned, np.eye(3), rtol=0, atol=1e-13)
    assert Transform(rotation).rotate(axis) == pytest.approx(axis, abs=1e-13)
    across = unit(cross(axis, (1.0, 0.0, 0.0))) or unit(cross(axis, (0.0, 1.0, 0.0)))
    assert across is not None
    image = Transform(rotation).rotate(across)
    assert dot(image, across) == pytest.approx(cos(angle), abs=1e-12)
    assert dot(image, cross(axis, across)) == pytest.approx(sin(angle), abs=1e-12)
    assert np.allclose(turned @ square(rotation_about(axis, -angle)), np.eye(3), rtol=0, atol=1e-13)


@given(angle=angles, axis=st.sampled_from(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))))
def test_turns_about_coordinate_axes_agree_with_rpy(angle: float, axis: Vector) -> None:
    """About x it is roll, about y pitch, about z yaw."""
    rpy = (axis[0] * angle, axis[1] * angle, axis[2] * angle)
    assert np.allclose(
        square(rotation_about(axis, angle)), square(rotation_from_rpy(rpy)), rtol=0, atol=1e-15
    )


@given(axis=directions, angle=st.floats(-1e-5, 1e-5) | _tiny)
def test_tiny_turns_are_first_order(axis: Vector, angle: float) -> None:
    """A tiny turn moves a point by angle times axis cross point, to second order."""
    point = (0.3, -0.7, 0.2)
    moved = minus(Transform(rotation_about(axis, angle)).rotate(point), point)
    expected = cross((axis[0] * angle, axis[1] * angle, axis[2] * angle), point)
    assert moved == pytest.approx(expected, abs=angle * angle + 1e-15)


_any_finite = st.floats(allow_nan=False, allow_infinity=False)


@given(vector=st.tuples(_any_finite, _any_finite, _any_finite))
@example(vector=(1.7e308, 1.7e308, 1.7e308))
@example(vector=(5e-324, 0.0, 0.0))
@example(vector=(5e-324, 5e-324, -5e-324))
def test_unit_vectors_of_any_size(vector: Vector) -> None:
    """Every finite vector but zero has a direction of length 1 with the vector's signs."""
    found = unit(vector)
    if vector == (0.0, 0.0, 0.0):
        assert found is None
        return
    assert found is not None
    assert hypot(*found) == pytest.approx(1.0, abs=1e-15)
    assert all(
        a * b >= 0
        for a, b in zip(found, (np.sign(coordinate) for coordinate in vector), strict=True)
    )


@pytest.mark.parametrize(
    "vector",
    [
        (0.0, 0.0, 0.0),
        (-0.0, 0.0, -0.0),
        (nan, 0.0, 1.0),
        (1.0, nan, 0.0),
        (inf, 0.0, 0.0),
        (nan, inf, 1.0),
    ],
)
def test_vectors_without_a_direction(vector: Vector) -> None:
    """Zero, infinite and undefined vectors have none."""
    assert unit(vector) is None


@given(vector=directions, scale=st.floats(1e-300, 1e300))
def test_the_direction_does_not_depend_on_the_length(vector: Vector, scale: float) -> None:
    """Scaling a vector leaves its direction."""
    scaled = (vector[0] * scale, vector[1] * scale, vector[2] * scale)
    assume(all(isfinite(coordinate) for coordinate in scaled))
    assert unit(scaled) == pytest.approx(unit(vector), abs=1e-14)


@given(a=vectors, b=vectors, c=vectors)
def test_products_of_vectors(a: Vector, b: Vector, c: Vector) -> None:
    """The vector product is orthogonal to both factors and equals numpy's; the triple product is cyclic."""
    assert cross(a, b) == pytest.approx(tuple(np.cross(a, b)), abs=1e-12)
    assert dot(cross(a, b), a) == pytest.approx(0.0, abs=1e-10)
    assert dot(a, cross(b, c)) == pytest.approx(dot(b, cross(c, a)), abs=1e-10)


@given(pose=transforms)
def test_matrices_are_homogeneous(pose: Transform) -> None:
    """Rotation, translation, and a last row of 0 0 0 1, as plain tuples and as an array."""
    array = np.array(pose)
    assert array.shape == (4, 4)
    assert array.tolist() == [list(row) for row in pose.matrix]
    assert tuple(array[:3, :3].ravel()) == pose.rotation
    assert tuple(array[:3, 3]) == pose.translation
    assert pose.matrix[3] == (0.0, 0.0, 0.0, 1.0)
    assert np.array(pose, dtype=np.float32).dtype == np.float32


def test_zero_angles_are_exactly_the_identity() -> None:
    """Zero angles give an exact identity, so that poses of robots without rotations are exact."""
    assert rotation_from_rpy((0.0, 0.0, 0.0)) == IDENTITY_ROTATION
    assert rotation_from_rpy((-0.0, 0.0, -0.0)) == IDENTITY_ROTATION


@given(rpy=rpys)
@example(rpy=(0.0, 0.0, 0.0))
@example(rpy=(pi, 0.0, 0.0))
@example(rpy=(0.0, pi, 0.0))
@example(rpy=(0.0, 0.0, -pi))
def test_quaternions_are_the_rotation(rpy: Vector) -> None:
    """The vector part and the scalar of a unit quaternion turn a point as the matrix does; w is not negative."""
    pose = Transform(rotation_from_rpy(rpy))
    x, y, z, w = pose.quaternion
    assert w >= 0.0
    assert hypot(x, y, z, w) == pytest.approx(1.0, abs=1e-12)
    point = (0.3, -0.7, 0.2)
    double = cross((2 * x, 2 * y, 2 * z), point)
    bent = cross((x, y, z), double)
    turned = tuple(point[axis] + w * double[axis] + bent[axis] for axis in range(3))
    assert pose.rotate(point) == pytest.approx(turned, abs=1e-12)


@given(rpy=rpys, scale=st.sampled_from((1.0, -1.0, 3.0, 1e-200, 1e150)))
@example(rpy=(pi, 0.0, 0.0), scale=1.0)
def test_a_quaternion_of_any_length_is_its_rotation(rpy: Vector, scale: float) -> None:
    """The rotation of a quaternion is the one that it was computed from, whatever its length and sign; zero turns nothing."""
    rotation = rotation_from_rpy(rpy)
    x, y, z, w = (scale * component for component in Transform(rotation).quaternion)
    assert rotation_from_quaternion((x, y, z, w)) == pytest.approx(rotation, abs=1e-12)
    assert rotation_from_quaternion((0.0, 0.0, 0.0, 0.0)) == IDENTITY_ROTATION


@given(pose=transforms, point=vectors)
def test_products_with_arrays_are_those_of_the_matrix(pose: Transform, point: Vector) -> None:
    """A point and a matrix of numpy on either side; any three numbers are a point."""
    column = np.array([*point, 1.0])
    assert (pose @ column)[:3] == pytest.approx(pose.apply(point), abs=1e-12)
    assert np.array_equal(pose @ np.eye(4), np.array(pose))
    assert np.array_equal(np.eye(4) @ pose, np.array(pose))
    assert pose.apply([*point]) == pose.apply(np.array(point)) == pose.apply(point)


@pytest.mark.parametrize(
    "mistake", ["pose @ 3", "pose @ [1, 2, 3]", "3 @ pose", "pose + pose", "len(pose)", "[*pose]"]
)
def test_a_pose_is_no_sequence(mistake: str) -> None:
    """What is no product of motions is a TypeError."""
    with pytest.raises(TypeError):
        eval(mistake, {"pose": IDENTITY})
