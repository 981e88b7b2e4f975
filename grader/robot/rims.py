"""The least overlap of shapes whose rims lean against each other.

Loading numpy takes longer than a grading run, and hardly any robot needs this: import this module late.
"""

from itertools import combinations
from math import atan2, ceil, pi, sqrt
from typing import Any

import numpy as np

from grader.robot.model import Box, Cylinder
from grader.robot.shapes import straight_edges
from grader.robot.transforms import Transform, Vector

Array = np.ndarray[Any, np.dtype[np.float64]]

SAGITTA = 4e-5  # metres from a rim to the polygon that stands for it; two of these are less than 0.1 mm
_BEND = 4e-6  # the same relative to the radius, so that a rim of more than 10 m has no more corners than one of 10 m
_ROUNDING = 1e-9  # the sine of an angle that is none


def least_overlap_at_rims(a: Box | Cylinder, b: Box | Cylinder, T_a_b: Transform) -> Vector:
    """The unit normal of least overlap among those that two straight edges, an edge and a rim, or two rims span.

    Were the rims polygons, these and the normals of flat faces would be all that the separating axis test needs; a rim
    stands out from its polygon by no more than `SAGITTA`. Two more rounds look closer about the best normal.
    """
    rotation = np.array(T_a_b.rotation).reshape(3, 3)
    straight = np.array([*straight_edges(a), *map(T_a_b.rotate, straight_edges(b))])
    sides = ((a, np.eye(3)), (b, rotation))
    rims = [(frame, _all_around(shape.radius)) for shape, frame in sides if isinstance(shape, Cylinder)]
    best = straight[0]
    for _ in range(3):
        lines = [np.outer(np.cos(turns), f[:, 0]) + np.outer(np.sin(turns), f[:, 1]) for f, turns in rims]
        spans = [np.cross(p[:, None], q).reshape(-1, 3) for p, q in combinations([straight, *lines], 2)]
        normals = np.concatenate(spans)
        lengths = np.linalg.norm(normals, axis=1)
        normals = normals[lengths > _ROUNDING] / lengths[lengths > _ROUNDING, None]
        overlaps = _half_widths(a, normals) + _half_widths(b, normals @ rotation) - abs(normals @ T_a_b.translation)
        best = normals[overlaps.argmin()]
        rims = [(f, _closer(turns, atan2(best @ f[:, 0], -(best @ f[:, 1])))) for f, turns in rims]
    x, y, z = best.tolist()
    return (x, y, z)


def _all_around(radius: float) -> list[float]:
    """The directions of a polygon's edges as angles over half a turn; across the polygon they come again."""
    sagitta = max(SAGITTA, _BEND * abs(radius))
    count = max(2, ceil(pi / 2.0 * sqrt(abs(radius) / sagitta / 2.0)))  # for 1 - cos(t) is no more than t**2 / 2
    return [step * pi / count for step in range(count)]


def _closer(turns: list[float], middle: float) -> list[float]:
    return [middle + (turns[1] - turns[0]) * (step / 8.0 - 1.0) for step in range(17)]


def _half_widths(shape: Box | Cylinder, directions: Array) -> Array:
    """`half_width` for directions of shape (n, 3)."""
    x, y, z = directions.T
    if isinstance(shape, Box):
        a, b, c = shape.size
        widths: Array = (abs(a * x) + abs(b * y) + abs(c * z)) / 2.0
    else:
        widths = abs(shape.radius) * (x * x + y * y) ** 0.5 + abs(shape.length / 2.0 * z)
    return widths
