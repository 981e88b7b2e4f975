"""How far one placed shape differs from another as a solid: symmetries, such as the turn of a sphere, do not count."""

from collections.abc import Iterator
from itertools import permutations, product
from math import acos, asin, degrees, hypot, inf, nan
from typing import NamedTuple

from grader.robot.model import Box, Cylinder, Sphere
from grader.robot.shapes import Shape
from grader.robot.transforms import AXES, Rotation, Transform, Vector, dot, minus

_CORNERS = tuple(product((1.0,), (1.0, -1.0), (1.0, -1.0)))  # the signs of four; the others are opposite to these


class Mismatch(NamedTuple):
    """The differences of two shapes in metres: how far the centres are apart, the largest difference of a size, and how
    far the turn of one against the other moves a point of the surface. `angle` is that turn in degrees.
    """

    apart: float
    size: float
    turn: float
    angle: float

    @property
    def largest(self) -> float:
        """The largest of the differences in metres; NaN where they overflow."""
        three = (self.apart, self.size, self.turn)
        return max(three) if sum(three) < inf else nan


def mismatch(
    a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform, tolerance: float, *, turned: bool = True
) -> Mismatch | None:
    """Return how two shapes differ, with as few differences beyond a tolerance as their symmetries allow.

    None for shapes of different kinds. Without `turned`, their orientations do not count.
    """
    apart = hypot(*minus(T_w_a.translation, T_w_b.translation))
    found = [Mismatch(apart, *(way if turned else (way[0], 0.0, 0.0))) for way in _ways(a, T_w_a, b, T_w_b)]
    return min(found, key=lambda way: (not way.size <= tolerance) + (not way.turn <= tolerance), default=None)


def turn_between(one: Rotation, other: Rotation) -> float:
    """Return the angle in degrees of the rotation from one to the other."""
    trace = sum(a * b for a, b in zip(one, other, strict=True))  # of that rotation: 1 + 2 cos(angle)
    return degrees(acos(max(-1.0, min(1.0, (trace - 1.0) / 2.0))))


def _ways(a: Shape, T_w_a: Transform, b: Shape, T_w_b: Transform) -> Iterator[tuple[float, float, float]]:
    """Yield the size, turn and angle of the difference for each way to lay a shape over another, aligned axes first."""
    match a, b:
        case Sphere(), Sphere():
            yield _off(a.radius, b.radius), 0.0, 0.0
        case Cylinder(), Cylinder():
            size = max(_off(a.radius, b.radius), _off(a.length, b.length))
            lean = _between(T_w_a.rotate(AXES[2]), T_w_b.rotate(AXES[2]))
            yield size, hypot(*lean) * hypot(a.radius, a.length / 2.0), _angle(lean)
        case Box(), Box():
            ours, theirs = ([T.rotate(axis) for axis in AXES] for T in (T_w_a, T_w_b))
            for order in permutations(range(3)):
                size = max(_off(edge, b.size[other]) for edge, other in zip(a.size, order, strict=True))
                leans = [_between(axis, theirs[other]) for axis, other in zip(ours, order, strict=True)]
                yield size, _corner(a.size, leans), max(map(_angle, leans))


def _off(one: float, other: float) -> float:
    return abs(one - other)  # a negative size is a mistake, which simulators refuse


def _between(one: Vector, other: Vector) -> Vector:
    """Return the vector from a unit vector to another or to its opposite, whichever is nearer."""
    side = 1.0 if dot(one, other) >= 0.0 else -1.0
    return (side * other[0] - one[0], side * other[1] - one[1], side * other[2] - one[2])


def _angle(chord: Vector) -> float:
    """Return the angle in degrees between the unit vectors that a vector connects."""
    return degrees(2.0 * asin(min(1.0, hypot(*chord) / 2.0)))


def _corner(size: Vector, leans: list[Vector]) -> float:
    """Return how far the farthest corner of a box moves if the directions of its edges change by these vectors."""
    return max(
        hypot(
            *(sum(s * edge / 2.0 * lean[k] for s, edge, lean in zip(signs, size, leans, strict=True)) for k in range(3))
        )
        for signs in _CORNERS
    )
