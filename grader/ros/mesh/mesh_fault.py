"""Why a mesh file cannot be shown, and the limits within which all formats are read."""

from collections.abc import Sequence
from typing import Any

import numpy as np

_MAX_TRIANGLES = 400_000  # of one mesh


class MeshFault(ValueError):
    """A mesh file that cannot be shown. The message is the end of a sentence: `is broken`."""


def broken(line: int, reason: str) -> MeshFault:
    """Return the fault of a text that is broken in a line."""
    return MeshFault(f"is broken: line {line} {reason}")


def check_triangle_count(count: int) -> None:
    """Raise MeshFault for more triangles than are read of one mesh."""
    if count > _MAX_TRIANGLES:
        raise MeshFault(f"has more than {_MAX_TRIANGLES:,} triangles, the limit")


def read_point(words: Sequence[bytes], line: int) -> list[float]:
    """Return the three coordinates that words of a line begin with. Raises MeshFault."""
    try:
        point = [float(word) for word in words[:3]]
    except ValueError:
        raise broken(line, "has a coordinate that is not a number") from None
    if len(point) < 3:
        raise broken(line, "has fewer than three coordinates")
    return point


def fan_corners(counts: Any) -> Any:
    """Return the positions of the corners of triangles, shape (n, 3), in the corners of polygons.

    Each triangle has the first corner of its polygon, as Assimp makes those of convex polygons.
    `counts` has how many corners each polygon has: polygons of one or two corners give none.
    Raises MeshFault for too many triangles.
    """
    starts = np.cumsum(counts) - counts
    triangles = np.maximum(counts - 2, 0)
    check_triangle_count(int(triangles.sum()))
    first = np.repeat(starts, triangles)
    number = np.arange(len(first)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return np.stack([first, first + number + 1, first + number + 2], axis=1)


def look_up_corners(points: Any, indices: Any) -> Any:
    """Return the points that the corners of triangles are, shape (n, 3, 3). Raises MeshFault."""
    if indices.size and not (indices.min() >= 0 and indices.max() < len(points)):
        raise MeshFault("is broken: a triangle has a corner that is not among the points")
    return points[indices]
