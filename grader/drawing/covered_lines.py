"""The piece of a straight edge that a shape covers: rays from it to the viewer enter the shape.

The point at the share s of a line, moved by t to the viewer, is between two flat faces for t between two linear functions of s, and in
a round body for `middle(s) -+ root(s)`. Some t of at least 0 must be in all of them. Comparing each lower bound with each upper one
eliminates t (Fourier and Motzkin) and leaves conditions in s that are linear or quadratic: they are solved exactly. Shapes are
convex, so they cover one piece of a line.
"""

from collections.abc import Iterator
from itertools import pairwise
from math import sqrt

from grader.drawing.cover import PARALLEL, Cover
from grader.drawing.curves import Line, Piece
from grader.robot.transforms import Vector, minus

_Linear = tuple[float, float]  # a + b s
_EVERYWHERE: Piece = (0.0, 1.0)
_NOWHERE: Piece = (1.0, 0.0)


def covered_line(cover: Cover, line: Line) -> list[Piece]:
    """Return the piece of a line that a shape covers, if there is one."""
    start, end = _piece(cover, line)
    return [(start, end)] if end > start else []


def _piece(cover: Cover, line: Line) -> Piece:
    """Return the piece of a line that is covered; it is empty if its end is not greater than its start."""
    q, v = cover.T_shape_view.apply(line.start), cover.to_viewer
    d = minus(cover.T_shape_view.apply(line.end), q)
    lows: list[_Linear] = [(0.0, 0.0)]
    highs: list[_Linear] = []
    piece = _EVERYWHERE
    for axis, half in cover.halves:
        if abs(v[axis]) > PARALLEL:
            depth = half / abs(v[axis])
            middle, slope = -q[axis] / v[axis], -d[axis] / v[axis]
            lows.append((middle - depth, slope))
            highs.append((middle + depth, slope))
        else:
            piece = _both(piece, _where((half - q[axis], -d[axis])), _where((half + q[axis], d[axis])))
    for high in highs:
        piece = _both(piece, *(_where((high[0] - low[0], high[1] - low[1])) for low in lows))
    return _both(piece, *_round_pieces(cover, q, d, lows, highs)) if cover.round_axes else piece


def _round_pieces(cover: Cover, q: Vector, d: Vector, lows: list[_Linear], highs: list[_Linear]) -> Iterator[Piece]:
    """Yield the piece that the round body covers, and the pieces that it and each slab cover at the same time."""
    v = cover.to_viewer
    a = cover.slope
    c = (cover.products(q, q) - cover.radius * cover.radius, 2.0 * cover.products(q, d), cover.products(d, d))
    if a <= PARALLEL:
        yield _where_root((-c[0], -c[1], -c[2]), (0.0, 0.0))
        return
    middle = (-cover.products(q, v) / a, -cover.products(d, v) / a)
    e, f = middle
    under_root = (e * e - c[0] / a, 2.0 * e * f - c[1] / a, f * f - c[2] / a)
    for low in lows:
        yield _where_root(under_root, (low[0] - e, low[1] - f))
    for high in highs:
        yield _where_root(under_root, (e - high[0], f - high[1]))


def _both(*pieces: Piece) -> Piece:
    return max(start for start, _ in pieces), min(end for _, end in pieces)


def _where(linear: _Linear) -> Piece:
    """Return the interval between 0 and 1 in which a linear function is not negative."""
    value, slope = linear
    if slope == 0.0:
        return _EVERYWHERE if value >= 0.0 else _NOWHERE
    root = -value / slope
    return (root, 1.0) if slope > 0.0 else (0.0, root)


def _where_root(under_root: tuple[float, float, float], linear: _Linear) -> Piece:
    """Return the interval between 0 and 1 in which the root of a concave quadratic function is at least a linear one."""
    a, b, c = under_root
    e, f = linear
    ends = {0.0, 1.0, *_roots(a, b, c), *_roots(a - e * e, b - 2.0 * e * f, c - f * f)}
    shares = sorted(share for share in ends if 0.0 <= share <= 1.0)
    fitting = []
    for start, end in pairwise(shares):
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
