"""A shape that hides what is behind it: the interval in which a ray to the viewer is inside.

A shape is an intersection of slabs `|x| <= half` and of at most one round body, so a ray is inside between two bounds.
"""

from itertools import combinations
from math import inf, sqrt
from typing import NamedTuple

from grader.drawing.views import AXES, VIEWER
from grader.robot.model import Box, Cylinder
from grader.robot.shapes import Shape
from grader.robot.transforms import Transform, Vector, cross, unit

PARALLEL = 1e-9
_SHRUNK = 1e-4  # metres: an edge less deep below a surface counts as on it, for example that of a wheel beside its base
_SHARE = 0.01  # of the size of a shape that is smaller
_NOTHING = (inf, -inf)


class Cover(NamedTuple):
    """A shape in its own frame: the direction to the viewer, and its half sizes by axis between flat faces.

    It is round, with a radius, across the first `round_axes` axes: two for a cylinder, three for a sphere. `slope` is the square of
    the part of the direction across them.
    """

    T_shape_view: Transform
    to_viewer: Vector
    halves: tuple[tuple[int, float], ...]
    round_axes: int = 0
    radius: float = 0.0
    slope: float = 0.0

    @classmethod
    def of(cls, shape: Shape, pose: Transform) -> "Cover":
        """Return the cover of a shape with T_view_shape, slightly shrunk, so that it does not cover edges on its surface."""
        inverse = pose.inverse()
        to_viewer = inverse.rotate(VIEWER)
        if isinstance(shape, Box):
            x, y, z = map(_shrunk, shape.size)
            return cls(inverse, to_viewer, ((0, x), (1, y), (2, z)))
        radius, slope = _shrunk(2.0 * shape.radius), to_viewer[0] * to_viewer[0] + to_viewer[1] * to_viewer[1]
        if isinstance(shape, Cylinder):
            return cls(inverse, to_viewer, ((2, _shrunk(shape.length)),), 2, radius, slope)
        return cls(inverse, to_viewer, (), 3, radius, 1.0)

    def covers(self, q: Vector) -> bool:
        """Return whether a ray to the viewer from a point of the shape's frame enters the shape."""
        low, high = self._ray(q)
        return high >= low and high >= 0.0

    def depth(self, x: float, y: float) -> float | None:
        """Return the z of the surface that the viewer sees at a point of the view; None beside the shape."""
        low, high = self._ray(self.T_shape_view.apply((x, y, 0.0)))
        return high if high >= low else None

    def planes(self) -> list[tuple[Vector, float]]:
        """Return normals n in the shape's frame with distances: something flat is covered only between the planes n.q = -+distance.

        They are the flat faces, and the planes through the outline that are parallel to the direction to the viewer.
        """
        v = self.to_viewer
        found = [(AXES[axis], half) for axis, half in self.halves]
        for (i, half), (j, other) in combinations(self.halves, 2):
            if abs(v[i]) > PARALLEL and abs(v[j]) > PARALLEL:
                a, b = AXES[i], AXES[j]
                normal = a[0] / v[i] - b[0] / v[j], a[1] / v[i] - b[1] / v[j], a[2] / v[i] - b[2] / v[j]
                found.append((normal, half / abs(v[i]) + other / abs(v[j])))
        if self.round_axes:
            across = unit(cross(v, AXES[2])) or AXES[0]
            found += [(across, self.radius), (cross(v, across), self.radius)]
        return found

    def _ray(self, q: Vector) -> tuple[float, float]:
        """Return the distances from a point toward the viewer at which the shape begins and ends; the end is less if the ray misses."""
        v = self.to_viewer
        low, high = -inf, inf
        for axis, half in self.halves:
            speed, at = v[axis], q[axis]
            if abs(speed) > PARALLEL:
                middle, depth = -at / speed, half / abs(speed)
                low = max(low, middle - depth)
                high = min(high, middle + depth)
            elif abs(at) > half:
                return _NOTHING
        if self.round_axes and low <= high:
            a, b = self.slope, self.products(q, v)
            c = self.products(q, q) - self.radius * self.radius
            root = b * b - a * c
            if root < 0.0 or (a <= PARALLEL and c > 0.0):
                return _NOTHING
            if a > PARALLEL:
                root = sqrt(root)
                low, high = max(low, (-b - root) / a), min(high, (-b + root) / a)
        return (low, high)

    def products(self, p: Vector, q: Vector) -> float:
        """Return the scalar product across the round axes."""
        flat = p[0] * q[0] + p[1] * q[1]
        return flat if self.round_axes == 2 else flat + p[2] * q[2]


def _shrunk(size: float) -> float:
    half = size / 2.0
    return half - min(_SHRUNK, _SHARE * half)
