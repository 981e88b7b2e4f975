"""OBJ files: the faces, as triangles. Groups, materials, normals, lines and curves are ignored."""

from array import array
from collections.abc import Sequence
from typing import Any

import numpy as np

from grader.ros.mesh.mesh_fault import (
    broken,
    check_triangle_count,
    fan_corners,
    look_up_corners,
    read_point,
)

_MAX_INDEX = 2**31


def read_obj(data: bytes) -> Any:
    """Return the corners of triangles, shape (n, 3, 3). Raises MeshFault."""
    coordinates = array("d")
    corners = array("q")
    counts = array("q")
    triangles = 0
    for number, line in enumerate(_joined_lines(data), 1):
        words = line.split()
        keyword = words[0] if words else b""
        if keyword == b"v":
            coordinates.extend(read_point(words[1:4], number))
        elif keyword == b"f":
            corners.extend(_read_face(words[1:], len(coordinates) // 3, number))
            counts.append(len(words) - 1)
            triangles += max(0, len(words) - 3)
            check_triangle_count(triangles)
    points = np.array(coordinates).reshape(-1, 3)
    indices = np.array(corners)[fan_corners(np.array(counts, np.int64))]
    return look_up_corners(points, indices)


def _joined_lines(data: bytes) -> list[bytes]:
    """Return the lines; a line that ends in a backslash goes on in the next one."""
    if b"\\" in data:
        data = data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ")
    return data.splitlines()


def _read_face(words: Sequence[bytes], count: int, line: int) -> list[int]:
    """Return the points of a face, from 0.

    A negative number counts back from the last of the `count` points above.
    """
    corners = []
    for word in words:
        try:
            index = int(word.partition(b"/")[0])
        except ValueError:
            raise broken(line, "has a corner that is not a number") from None
        if not 0 < abs(index) < _MAX_INDEX:
            raise broken(line, "has a corner that is not among the points")
        corners.append(index - 1 if index > 0 else count + index)
    return corners
