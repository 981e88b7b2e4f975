"""The edge overlap of shapes with rims that lean against each other.

Import this module late: loading numpy takes longer than grading, and hardly any robot needs it.
"""

from itertools import combinations, starmap
from math import atan2, ceil, pi, sqrt
from typing import Any

import numpy as np

from grader.base.transforms import Transform, Vector
from grader.ros.urdf.model import Box, Capsule, Cylinder
from grader.ros.urdf.shapes import straight_edges

_Array = np.ndarray[Any, np.dtype[np.float64]]
_Edged = Box | Cylinder | Capsule

# metres from a rim to the polygon that replaces it; two of these are less than 0.1 mm
_SAGITTA = 4e-5
# of the radius, so that a rim of more than 10 m has no more corners than one of 10 m
_MIN_RELATIVE_SAGITTA = 4e-6
_ROUNDING = 1e-9  # the sine of an angle that counts as zero
_STEPS = np.arange(-8, 9) / 8.0


def least_edge_overlap(a: _Edged, b: _Edged, T_a_b: Transform) -> Vector:
    """Return the unit normal of least overlap among those that edges and rims span.

    Two straight edges, an edge and a rim, or two rims span them.

    If the rims were polygons, these and the normals of flat faces would be all that the separating
    axis test needs; a rim differs from its polygon by no more than `_SAGITTA`. Two more rounds
    refine the best normal.
    """
    rotation = np.array(T_a_b.rotation).reshape(3, 3)
    straight = np.array([*straight_edges(a), *map(T_a_b.rotate, straight_edges(b))]).T
    rims = []  # the plane of each, and the directions of its edges
    for shape, frame in ((a, np.eye(3)), (b, rotation)):
        if isinstance(shape, Cylinder):
            rims.append((frame[:, :2], _all_around(shape.radius)))
    best = straight[:, 0]
    for _ in range(3):
        lines = [straight]
        for plane, turns in rims:
            lines.append(plane @ np.array((np.cos(turns), np.sin(turns))))
        products = list(starmap(_cross_products, combinations(lines, 2)))
        normals = np.concatenate(products, axis=1)
        lengths = np.sqrt((normals * normals).sum(axis=0))
        lengths[lengths <= _ROUNDING] = np.inf  # parallel lines span no normal
        normals /= lengths
        widths = _half_widths(a, normals) + _half_widths(b, rotation.T @ normals)
        overlaps = widths - abs(T_a_b.translation @ normals)
        overlaps[lengths == np.inf] = np.inf
        best = normals[:, overlaps.argmin()]
        for number, (plane, turns) in enumerate(rims):
            nearest = atan2(best @ plane[:, 0], -(best @ plane[:, 1]))
            rims[number] = plane, _angles_near(turns, nearest)
    x, y, z = best.tolist()
    return (x, y, z)


def _cross_products(p: _Array, q: _Array) -> _Array:
    """Return the cross products of directions of shape (3, n) and (3, m), as (3, n m).

    The function np.cross is far slower.
    """
    (a, b, c), (x, y, z) = p[:, :, None], q[:, None, :]
    return np.array((b * z - c * y, c * x - a * z, a * y - b * x)).reshape(3, -1)


def _all_around(radius: float) -> _Array:
    """Return the directions of a polygon's edges as angles over half a turn.

    The other half repeats them.
    """
    sagitta = max(_SAGITTA, _MIN_RELATIVE_SAGITTA * abs(radius))
    count = max(
        2, ceil(pi / 2.0 * sqrt(abs(radius) / sagitta / 2.0))
    )  # because 1 - cos(t) is at most t**2 / 2
    return np.linspace(0.0, pi, count, endpoint=False)


def _angles_near(turns: _Array, middle: float) -> _Array:
    closer: _Array = middle + (turns[1] - turns[0]) * _STEPS
    return closer


def _half_widths(shape: _Edged, directions: _Array) -> _Array:
    """Return `half_width` for directions of shape (3, n)."""
    x, y, z = directions
    if isinstance(shape, Box):
        a, b, c = shape.size
        widths: _Array = (abs(a * x) + abs(b * y) + abs(c * z)) / 2.0
    elif isinstance(shape, Capsule):
        widths = abs(shape.radius) + abs(shape.length / 2.0 * z)
    else:
        widths = abs(shape.radius) * (x * x + y * y) ** 0.5 + abs(shape.length / 2.0 * z)
    return widths
