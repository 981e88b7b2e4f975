"""Which pieces of an edge a shape covers: those from which a ray to the viewer enters the shape.

A shape is an intersection of slabs `|x| <= half` and of at most one round body. The point at the share s of a line, moved by t to the
viewer, is in a slab for t between two linear functions of s, and in the round body for `middle(s) -+ root(s)`. Some t of at least 0
must be in all of them. Comparing each lower bound with each upper one eliminates t (Fourier and Motzkin) and leaves conditions in s
that are linear or quadratic: they are solved exactly. A convex shape covers one piece of a line. Arcs are sampled, and
the ends of their covered pieces are found by bisection.
"""

import itertools
from collections.abc import Callable, Iterator
from math import inf, sqrt, tau
from typing import NamedTuple

from grader.drawing.curves import Arc, Curve, Line
from grader.drawing.views import VIEWER
from grader.robot.model import Box, Cylinder
from grader.robot.shapes import Shape
from grader.robot.transforms import Transform, Vector, minus

Piece = tuple[float, float]  # shares of the length of a line, or of the angle of an arc
_Linear = tuple[float, float]  # a + b s

_SHRUNK = 1e-4  # metres: an edge that is less deep below a surface lies on it, as that of a wheel beside its base
_SHARE = 0.01  # of the size of a shape that is smaller
_PARALLEL = 1e-9
_SAMPLES = 36  # of a circle
_HALVINGS = 16
_EVERYWHERE: Piece = (0.0, 1.0)
_NOWHERE: Piece = (1.0, 0.0)


class Cover(NamedTuple):
    """A shape that covers edges: its frame, the direction to the viewer in it, and its half sizes by axis between flat faces.

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
        """Return a shape with T_view_shape, shrunk a little, so that it does not cover edges on its surface."""
        inverse = pose.inverse()
        to_viewer = inverse.rotate(VIEWER)
        if isinstance(shape, Box):
            x, y, z = map(_shrunk, shape.size)
            return cls(inverse, to_viewer, ((0, x), (1, y), (2, z)))
        radius, slope = _shrunk(2.0 * shape.radius), to_viewer[0] * to_viewer[0] + to_viewer[1] * to_viewer[1]
        if isinstance(shape, Cylinder):
            return cls(inverse, to_viewer, ((2, _shrunk(shape.length)),), 2, radius, slope)
        return cls(inverse, to_viewer, (), 3, radius, 1.0)

    def pieces(self, curve: Curve) -> list[Piece]:
        """Return the covered pieces of a curve in ascending order."""
        if not isinstance(curve, Line):
            return [*_sampled(self._covers_share(curve), max(4, round(_SAMPLES * abs(curve.end - curve.start) / tau)))]
        start, end = self._piece(curve)
        return [(start, end)] if end > start else []

    def covers(self, point: Vector) -> bool:
        """Return whether a ray from a point to the viewer enters the shape."""
        low, high = self._ray(self.T_shape_view.apply(point))
        return high >= low and high >= 0.0

    def _covers_share(self, arc: Arc) -> Callable[[float], bool]:
        """Return the function of a share of an arc that says whether the shape covers it, with the arc in the shape's frame."""
        local = Arc(
            self.T_shape_view.apply(arc.centre),
            self.T_shape_view.rotate(arc.major),
            self.T_shape_view.rotate(arc.minor),
            arc.start,
            arc.end,
        )

        def covers(share: float) -> bool:
            low, high = self._ray(local.at(share))
            return high >= low and high >= 0.0

        return covers

    def depth(self, x: float, y: float) -> float | None:
        """Return the z of the surface that the viewer sees at a place in the view; None beside the shape."""
        low, high = self._ray(self.T_shape_view.apply((x, y, 0.0)))
        return high if high >= low else None

    def _ray(self, q: Vector) -> Piece:
        """Return how far from a point to the viewer the shape begins and ends; the end is first where there is nothing."""
        v = self.to_viewer
        low, high = -inf, inf
        for axis, half in self.halves:
            speed, at = v[axis], q[axis]
            if abs(speed) > _PARALLEL:
                middle, depth = -at / speed, half / abs(speed)
                low = max(low, middle - depth)
                high = min(high, middle + depth)
            elif abs(at) > half:
                return (inf, -inf)
        if self.round_axes and low <= high:
            a, b = self.slope, self._products(q, v)
            c = self._products(q, q) - self.radius * self.radius
            root = b * b - a * c
            if root < 0.0 or (a <= _PARALLEL and c > 0.0):
                return (inf, -inf)
            if a > _PARALLEL:
                root = sqrt(root)
                low, high = max(low, (-b - root) / a), min(high, (-b + root) / a)
        return (low, high)

    def _piece(self, line: Line) -> Piece:
        """Return the piece of a line that is covered; empty if its end is not above its start."""
        q, v = self.T_shape_view.apply(line.start), self.to_viewer
        d = minus(self.T_shape_view.apply(line.end), q)
        lows: list[_Linear] = [(0.0, 0.0)]
        highs: list[_Linear] = []
        piece = _EVERYWHERE
        for axis, half in self.halves:
            if abs(v[axis]) > _PARALLEL:
                depth = half / abs(v[axis])
                middle, slope = -q[axis] / v[axis], -d[axis] / v[axis]
                lows.append((middle - depth, slope))
                highs.append((middle + depth, slope))
            else:
                piece = _both(piece, _where((half - q[axis], -d[axis])), _where((half + q[axis], d[axis])))
        for high in highs:
            piece = _both(piece, *(_where((high[0] - low[0], high[1] - low[1])) for low in lows))
        return _both(piece, *self._round_pieces(q, d, lows, highs)) if self.round_axes else piece

    def _round_pieces(self, q: Vector, d: Vector, lows: list[_Linear], highs: list[_Linear]) -> Iterator[Piece]:
        """Yield where a line is covered by the round body, and where by that and each slab at once."""
        v = self.to_viewer
        a = self.slope
        c = (self._products(q, q) - self.radius * self.radius, 2.0 * self._products(q, d), self._products(d, d))
        if a <= _PARALLEL:
            yield _where_root((-c[0], -c[1], -c[2]), (0.0, 0.0))
            return
        middle = (-self._products(q, v) / a, -self._products(d, v) / a)
        e, f = middle
        under_root = (e * e - c[0] / a, 2.0 * e * f - c[1] / a, f * f - c[2] / a)
        for low in lows:
            yield _where_root(under_root, (low[0] - e, low[1] - f))
        for high in highs:
            yield _where_root(under_root, (e - high[0], f - high[1]))

    def _products(self, p: Vector, q: Vector) -> float:
        """Return the scalar product across the round axes."""
        flat = p[0] * q[0] + p[1] * q[1]
        return flat if self.round_axes == 2 else flat + p[2] * q[2]


def _shrunk(size: float) -> float:
    half = size / 2.0
    return half - min(_SHRUNK, _SHARE * half)


def _both(*pieces: Piece) -> Piece:
    return max(start for start, _ in pieces), min(end for _, end in pieces)


def _where(linear: _Linear) -> Piece:
    """Return where a linear function is not negative, between 0 and 1."""
    value, slope = linear
    if slope == 0.0:
        return _EVERYWHERE if value >= 0.0 else _NOWHERE
    root = -value / slope
    return (root, 1.0) if slope > 0.0 else (0.0, root)


def _where_root(under_root: tuple[float, float, float], linear: _Linear) -> Piece:
    """Return where the root of a concave quadratic function is at least a linear one, between 0 and 1: one piece."""
    a, b, c = under_root
    e, f = linear
    ends = {0.0, 1.0, *_roots(a, b, c), *_roots(a - e * e, b - 2.0 * e * f, c - f * f)}
    shares = sorted(share for share in ends if 0.0 <= share <= 1.0)
    fitting = []
    for start, end in itertools.pairwise(shares):
        middle = (start + end) / 2.0
        value = a + middle * (b + middle * c)
        if value >= 0.0 and sqrt(value) >= e + f * middle:
            fitting += [start, end]
    return (fitting[0], fitting[-1]) if fitting else _NOWHERE


def _roots(a: float, b: float, c: float) -> tuple[float, ...]:
    """Return the roots of a + b s + c s^2, without cancellation."""
    inner = b * b - 4.0 * a * c
    if inner < 0.0:
        return ()
    q = -(b + (sqrt(inner) if b >= 0.0 else -sqrt(inner))) / 2.0
    return (*((q / c,) if c else ()), *((a / q,) if q else ()))


def _sampled(covers: Callable[[float], bool], samples: int) -> Iterator[Piece]:
    """Yield the pieces in which a function of a share is true."""
    start, before = 0.0, covers(0.0)
    for number in range(1, samples + 1):
        now = covers(number / samples)
        if now != before:
            end = _change(covers, (number - 1) / samples, number / samples, before)
            if before:
                yield start, end
            start, before = end, now
    if before:
        yield start, 1.0


def _change(covers: Callable[[float], bool], low: float, high: float, before: bool) -> float:
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        low, high = (middle, high) if covers(middle) == before else (low, middle)
    return (low + high) / 2.0
