"""Rigid motions as plain floats.

At 4 x 4 a product of Python floats costs no more than a numpy call, and saves the import;
`numpy.asarray(transform)` gives the homogeneous matrix.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import reduce
from math import acos, atan2, cos, degrees, hypot, inf, nan, sin
from operator import add
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

Vector = tuple[float, float, float]
FULL_TURN = 6.2832  # radians
AXES: tuple[Vector, Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
X_AXIS, Y_AXIS, Z_AXIS = AXES
Quaternion = tuple[float, float, float, float]  # x, y, z, w
Rotation = tuple[
    float, float, float, float, float, float, float, float, float
]  # a 3 x 3 matrix, row by row

IDENTITY_ROTATION: Rotation = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Transform:
    """The pose T_a_b of a frame b in a frame a: it maps points given in b to a.

    `translation` is b's origin in a, in metres; `rotation` has b's axes as columns, row by row.
    With a numpy array on either side, `@` is the product with the 4 x 4 matrix.

    >>> T_base_lidar = Transform(translation=(0.15, 0.0, 0.225))
    >>> T_base_lidar.apply((1, 0, 0))
    (1.15, 0.0, 0.225)
    >>> (T_base_lidar @ T_base_lidar.inverse()).translation
    (0.0, 0.0, 0.0)
    """

    rotation: Rotation = IDENTITY_ROTATION
    translation: Vector = (0.0, 0.0, 0.0)

    def __matmul__(self, other: "Transform") -> "Transform":
        """Return T_a_c = T_a_b @ T_b_c."""
        if not isinstance(other, Transform):
            return NotImplemented
        j, k, l, m, n, o, p, q, r = other.rotation  # noqa: E741  rows, letter by letter
        columns = ((j, m, p), (k, n, q), (l, o, r))
        (a, d, g), (b, e, h), (c, f, i) = map(self.rotate, columns)
        return Transform((a, b, c, d, e, f, g, h, i), self.apply(other.translation))

    def apply(self, point: Iterable[float]) -> Vector:
        """Return a point given in b, as any three numbers, in frame a."""
        x, y, z = point if isinstance(point, tuple) else map(float, point)
        x, y, z = self.rotate((x, y, z))
        u, v, w = self.translation
        return (x + u, y + v, z + w)

    def rotate(self, direction: Vector) -> Vector:
        """Return a direction given in b in frame a: no translation."""
        a, b, c, d, e, f, g, h, i = self.rotation
        x, y, z = direction
        return (a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z)

    def unrotate(self, direction: Vector) -> Vector:
        """Return a direction given in a in frame b."""
        a, b, c, d, e, f, g, h, i = self.rotation
        x, y, z = direction
        return (a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + i * z)

    def inverse(self) -> "Transform":
        """Return T_b_a."""
        a, b, c, d, e, f, g, h, i = self.rotation
        x, y, z = self.unrotate(self.translation)
        return Transform((a, d, g, b, e, h, c, f, i), (-x, -y, -z))

    @property
    def matrix(self) -> tuple[Quaternion, ...]:
        """The 4 x 4 homogeneous matrix, row by row."""
        a, b, c, d, e, f, g, h, i = self.rotation
        x, y, z = self.translation
        return ((a, b, c, x), (d, e, f, y), (g, h, i, z), (0.0, 0.0, 0.0, 1.0))

    @property
    def rpy(self) -> Vector:
        """Roll, pitch and yaw in radians about fixed axes; roll is 0 if pitch is a quarter turn."""
        a, b, _, d, e, _, g, h, i = self.rotation
        flat = hypot(a, d)
        if flat < 1e-9:
            return (0.0, atan2(-g, flat), atan2(-b, e))
        return (atan2(h, i), atan2(-g, flat), atan2(d, a))

    @property
    def quaternion(self) -> Quaternion:
        """The rotation as a unit quaternion x, y, z, w, as in ROS 2's messages.

        The number w is not negative.
        """
        a, b, c, d, e, f, g, h, i = self.rotation
        # four times the product of each two components: the row of the largest one is most exact
        products = (
            (1.0 + a - e - i, b + d, c + g, h - f),
            (b + d, 1.0 - a + e - i, f + h, c - g),
            (c + g, f + h, 1.0 - a - e + i, d - b),
            (h - f, c - g, d - b, 1.0 + a + e + i),
        )
        x, y, z, w = products[max(range(4), key=lambda number: products[number][number])]
        norm = hypot(x, y, z, w) if w >= 0.0 else -hypot(x, y, z, w)
        return (x / norm, y / norm, z / norm, w / norm)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> "np.ndarray[Any, Any]":
        """Return the 4 x 4 homogeneous matrix for numpy, shape (4, 4)."""
        import numpy as np  # late: only callers that already use numpy come here

        return np.array(self.matrix, dtype=dtype)


IDENTITY = Transform()


def rotation_from_rpy(rpy: Vector) -> Rotation:
    """Return Rz(yaw) Ry(pitch) Rx(roll).

    This is roll about x, then pitch about y, then yaw about z, all fixed (REP 103).
    """
    if rpy == (0.0, 0.0, 0.0):
        return IDENTITY_ROTATION
    roll, pitch, yaw = rpy
    sr, cr, sp, cp, sy, cy = sin(roll), cos(roll), sin(pitch), cos(pitch), sin(yaw), cos(yaw)
    return (
        cy * cp,
        cy * sp * sr - sy * cr,
        cy * sp * cr + sy * sr,
        sy * cp,
        sy * sp * sr + cy * cr,
        sy * sp * cr - cy * sr,
        -sp,
        cp * sr,
        cp * cr,
    )


def rotation_from_quaternion(quaternion: Quaternion) -> Rotation:
    """Return the rotation of a quaternion x, y, z, w of any length; of one without, none."""
    x, y, z, w = quaternion
    axis = unit((x, y, z))
    if axis is None:
        return IDENTITY_ROTATION
    return rotation_about(axis, 2.0 * atan2(hypot(x, y, z), w))


def rotation_about(axis: Vector, angle: float) -> Rotation:
    """Return the rotation by `angle` radians about a unit axis, right-handed (Rodrigues)."""
    x, y, z = axis
    s = sin(angle)
    c = cos(angle)
    t = 1.0 - c
    return (
        t * x * x + c,
        t * x * y - s * z,
        t * x * z + s * y,
        t * x * y + s * z,
        t * y * y + c,
        t * y * z - s * x,
        t * x * z - s * y,
        t * y * z + s * x,
        t * z * z + c,
    )


def add_up(numbers: Iterable[float]) -> float:
    """Return the sum of numbers, added one by one.

    sum() corrects rounding errors from Python 3.12 on, so that its result depends on the version.
    """
    return reduce(add, numbers, 0.0)


def weighted_mean(weighted: Iterable[tuple[float, Vector]]) -> Vector:
    """Return the mean of points, each with its weight."""
    total = x = y = z = 0.0
    for weight, point in weighted:
        total += weight
        x += weight * point[0]
        y += weight * point[1]
        z += weight * point[2]
    return (x / total, y / total, z / total)


def turn_between(one: Rotation, other: Rotation) -> float:
    """Return the angle in degrees of the rotation from one to the other."""
    trace = add_up(
        a * b for a, b in zip(one, other, strict=True)
    )  # of that rotation: 1 + 2 cos(angle)
    return degrees(acos(max(-1.0, min(1.0, (trace - 1.0) / 2.0))))


def unit(vector: Vector) -> Vector | None:
    """Return the unit vector of a direction, or None for length zero.

    It is safe from overflow and underflow.
    """
    if vector in AXES:  # the most frequent case
        return vector
    largest = max(abs(vector[0]), abs(vector[1]), abs(vector[2]))
    if not 0.0 < largest < inf:
        return None
    x = vector[0] / largest
    y = vector[1] / largest
    z = vector[2] / largest
    norm = hypot(x, y, z)
    return (x / norm, y / norm, z / norm) if norm > 0.0 else None  # NaN is not above 0


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product, right-handed."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a: Vector, b: Vector) -> Vector:
    """Return the vector from b to a."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def degrees_between(a: Vector, b: Vector) -> float:
    """Return the angle between two directions in degrees, as exact near 0 as elsewhere.

    Returns NaN for a zero vector.
    """
    sine = hypot(*cross(a, b))
    cosine = dot(a, b)
    return degrees(atan2(sine, cosine)) if sine or cosine else nan
