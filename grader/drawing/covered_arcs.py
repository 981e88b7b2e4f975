"""The pieces of an arc that a shape covers: rays from them to the viewer enter the shape.

Crossings of an arc with flat faces and straight outlines are computed exactly; crossings with round surfaces are found by samples
and bisection.
"""

from collections.abc import Iterator
from itertools import pairwise
from math import acos, atan2, hypot, tau

from grader.drawing.cover import Cover
from grader.drawing.curves import Arc, Piece
from grader.robot.transforms import Vector, dot

_SAMPLES = 24  # of a circle
_HALVINGS = 16


def covered_arc(cover: Cover, arc: Arc) -> Iterator[Piece]:
    """Yield the pieces of an arc that a shape covers, in ascending order."""
    local = arc._replace(
        centre=cover.T_shape_view.apply(arc.centre),
        major=cover.T_shape_view.rotate(arc.major),
        minor=cover.T_shape_view.rotate(arc.minor),
    )
    samples = max(2, round(_SAMPLES * abs(arc.end - arc.start) / tau)) if cover.round_axes else 1
    cuts = {number / samples for number in range(samples + 1)}
    for normal, distance in cover.planes():
        cuts.update(_crossings(local, normal, distance))
    middles = [(one + other) / 2.0 for one, other in pairwise(sorted(cuts))]
    start, last, was_covered = 0.0, 0.0, cover.covers(local.at(0.0))
    for share in (*middles, 1.0):
        is_covered = cover.covers(local.at(share))
        if is_covered != was_covered:
            change = _change(cover, local, last, share, was_covered=was_covered)
            if was_covered:
                yield start, change
            start = change
        last, was_covered = share, is_covered
    if was_covered:
        yield start, 1.0


def _crossings(arc: Arc, normal: Vector, distance: float) -> Iterator[float]:
    """Yield the shares at which an arc crosses the planes n.q = -+distance."""
    middle, c, s = dot(normal, arc.centre), dot(normal, arc.major), dot(normal, arc.minor)
    size, phase = hypot(c, s), atan2(s, c)
    for level in (-distance, distance):
        if abs(level - middle) < size:
            turn = acos((level - middle) / size)
            for angle in (phase - turn, phase + turn):
                share = ((angle - arc.start) % tau) / (arc.end - arc.start)
                if 0.0 < share < 1.0:
                    yield share


def _change(cover: Cover, local: Arc, low: float, high: float, *, was_covered: bool) -> float:
    """Return the share between two at which an arc, in the shape's frame, starts or stops being covered."""
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        low, high = (middle, high) if cover.covers(local.at(middle)) == was_covered else (low, middle)
    return (low + high) / 2.0
