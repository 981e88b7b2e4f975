"""The triangles of a mesh file, their bounding box, and fewer of them for a page."""

import posixpath
from collections.abc import Sequence
from dataclasses import dataclass
from math import isqrt
from typing import Any

import numpy as np

from grader.base.text import size_text
from grader.base.transforms import Vector
from grader.ros.mesh.collada import read_collada
from grader.ros.mesh.mesh_fault import MeshFault
from grader.ros.mesh.obj import read_obj
from grader.ros.mesh.stl import read_stl

# libxml2 reads no longer text of one element; an array of coordinates is most of a file.
_MAX_TEXT = 9 * 1024 * 1024  # bytes
MAX_MESH_SIZE = 20 * 1024 * 1024  # bytes of a file of any format
_STEPS = 65_535  # of a coordinate that is packed
_READERS = {
    ".stl": (read_stl, MAX_MESH_SIZE),
    ".obj": (read_obj, _MAX_TEXT),
    ".dae": (read_collada, _MAX_TEXT),
}


@dataclass(frozen=True, eq=False, slots=True)
class Triangles:
    """The triangles of a mesh: their corners in metres in its frame, before <mesh scale>.

    `corners` is an array of finite 32-bit floats, shape (n, 3, 3): triangles, corners, x y z.
    """

    corners: Any

    @property
    def count(self) -> int:
        """How many triangles there are."""
        return len(self.corners)

    @property
    def bounds(self) -> tuple[Vector, Vector]:
        """The least and the largest coordinates, in metres."""
        x, y, z = self.corners.min(axis=(0, 1)).tolist()
        low = (x, y, z)
        x, y, z = self.corners.max(axis=(0, 1)).tolist()
        return low, (x, y, z)

    def reduced(self, most: int) -> "Triangles":
        """Return at most `most` triangles of about the same surface.

        Corners in one cell of a grid become one, their mean (Rossignac and Borrel, 1993); the grid
        gets coarser until few enough triangles are left, perhaps none.
        """
        if self.count <= most:
            return self
        cells = max(1, isqrt(most))
        reduced = _clustered(self.corners, cells)
        while len(reduced) > most and cells > 1:
            step = max(0.5, min(0.9, (most / len(reduced)) ** 0.5))
            cells = max(1, int(cells * step))
            reduced = _clustered(self.corners, cells)
        return Triangles(reduced)

    def packed(self, bounds: tuple[Vector, Vector], mirrored: Sequence[bool]) -> bytes:
        """Return the triangles within bounds, for a page.

        The result has x, y and z of each corner as unsigned 16-bit numbers, little-endian, from 0
        at the least coordinate to 65535 at the largest; `mirrored` says for each axis whether it is
        the other way round.
        """
        low, high = map(np.array, bounds)
        size = np.where(high > low, high - low, 1.0)
        steps = np.rint((self.corners - low) / size * _STEPS).clip(0, _STEPS)
        is_mirrored = np.array(mirrored)
        steps[..., is_mirrored] = _STEPS - steps[..., is_mirrored]
        if sum(mirrored) % 2:
            steps = steps[:, ::-1]  # counter-clockwise from outside again
        data: bytes = steps.astype("<u2").tobytes()
        return data


def read_triangles(data: bytes, path: str) -> Triangles | str:
    """Return the triangles of a mesh file, or why it cannot be shown.

    The ending of its path says its format. The reason is the end of a sentence: `has no triangles`.
    """
    ending = posixpath.splitext(path)[1].lower()
    if ending not in _READERS:
        return "is not read: only STL, OBJ and COLLADA files are"
    reader, limit = _READERS[ending]
    if len(data) > limit:
        return f"is larger than {size_text(limit)}, the limit for {ending} files"
    try:
        corners = reader(data)
    except MeshFault as fault:
        return str(fault)
    if not len(corners):
        return "has no triangles"
    with np.errstate(over="ignore"):
        rounded = corners.astype(np.float32)
    if not np.isfinite(rounded).all():
        return "is broken: a coordinate is not a finite number"
    return Triangles(rounded)


def _clustered(corners: Any, cells: int) -> Any:
    """Return triangles whose corners are the means of those in one cell of a grid.

    The grid has `cells` cells along the longest side. Triangles that get flat are omitted, and each
    is there once.
    """
    points = corners.reshape(-1, 3).astype(np.float64)
    _, cell_of = np.unique(_number_cells(points, cells), return_inverse=True)
    counts = np.bincount(cell_of)
    sums = [np.bincount(cell_of, points[:, axis]) for axis in range(3)]
    means = np.stack(sums, axis=1) / counts[:, None]
    triangles = _different_triangles(cell_of.reshape(-1, 3), len(counts))
    return means[triangles].astype(np.float32)


def _number_cells(points: Any, cells: int) -> Any:
    """Return the number of the cell that each point is in."""
    low = points.min(axis=0)
    size = (points.max(axis=0) - low).max() or 1.0
    places = (points - low) / size * cells
    x, y, z = np.minimum(places, cells - 1).astype(np.int64).T
    return (x * cells + y) * cells + z


def _different_triangles(triangles: Any, count: int) -> Any:
    """Return the triangles that are not flat, each once, as the numbers of their corners.

    `count` is how many corners there are.
    """
    a, b, c = np.sort(triangles, axis=1).T
    is_flat = (a == b) | (b == c)
    numbers = (a * count + b) * count + c
    numbers[is_flat] = -1
    _, first = np.unique(numbers, return_index=True)
    kept = np.sort(first)
    return triangles[kept[~is_flat[kept]]]
