"""Compare numbers, rotations and shapes up to what cannot be seen."""

from collections.abc import Callable, Sequence
from itertools import permutations
from typing import Any, NamedTuple

from grader.robot.model import Box, Cylinder, Geometry, Mesh, Sphere
from grader.robot.transforms import Transform, Vector, dot

_NUMBER, _TINY = 1e-6, 1e-12  # relative, absolute
_LENGTH = 1e-6  # metres
_TURN = 4e-3  # of a rotation matrix: half a turn that is written 3.14 is the same in both directions


class Turn(NamedTuple):
    """A rotation, row by row, or a direction: compared more coarsely than lengths."""

    values: tuple[float, ...]


class Shown(NamedTuple):
    """A shape in the frame of its link, with its colour."""

    geometry: Geometry
    pose: Transform
    colour: tuple[object, ...] = ()


def is_same(one: object, other: object) -> bool:
    """Return whether two values of plain tuples are equal, numbers up to rounding."""
    match one, other:
        case Turn(), Turn():
            return _near(one.values, other.values, _TURN)
        case tuple(), tuple():
            return len(one) == len(other) and all(map(is_same, one, other))
        case float() | int(), float() | int():
            return abs(one - other) <= max(_TINY, _NUMBER * max(abs(one), abs(other)))
        case _:
            return one == other


def _near(one: Sequence[float], other: Sequence[float], tolerance: float) -> bool:
    return len(one) == len(other) and all(abs(a - b) <= tolerance for a, b in zip(one, other, strict=True))


def is_same_set(one: Sequence[Any], other: Sequence[Any], same: Callable[[Any, Any], bool]) -> bool:
    """Return whether everything in each of two lists is in the other one, as often as one likes: what is drawn twice looks the same."""
    return all(any(same(a, b) for b in other) for a in one) and all(any(same(a, b) for a in one) for b in other)


def is_same_shape(one: Shown, other: Shown) -> bool:
    """Return whether two shapes look the same: a box lies on any of its sides, a cylinder is turned about its axis."""
    if not is_same(one.colour, other.colour) or not _near(one.pose.translation, other.pose.translation, _LENGTH):
        return False
    match one.geometry, other.geometry:
        case Sphere(radius=a), Sphere(radius=b):
            return is_same(a, b)
        case Cylinder(), Cylinder():
            sizes = [(shape.geometry.radius, shape.geometry.length) for shape in (one, other)]  # type: ignore[union-attr]
            return is_same(*sizes) and _is_along(_column(one, 2), _column(other, 2))
        case Box(size=a), Box(size=b):
            return any(
                is_same(a, tuple(b[i] for i in order))
                and all(_is_along(_column(one, i), _column(other, j)) for i, j in enumerate(order))
                for order in permutations(range(3))
            )
        case Mesh(filename=a, scale=m), Mesh(filename=b, scale=n):
            return a == b and is_same(m, n) and _near(one.pose.rotation, other.pose.rotation, _TURN)
    return False


def _column(shown: Shown, index: int) -> Vector:
    rotation = shown.pose.rotation
    return rotation[index], rotation[3 + index], rotation[6 + index]


def _is_along(one: Vector, other: Vector) -> bool:
    """Return whether two unit vectors are on one line."""
    sign = 1.0 if dot(one, other) > 0 else -1.0
    return _near(one, tuple(sign * value for value in other), _TURN)
