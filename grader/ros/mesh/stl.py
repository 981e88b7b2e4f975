"""STL files, binary and text: the triangles, without their normals and colours."""

import struct
from array import array
from typing import Any

import numpy as np

from grader.ros.mesh.mesh_fault import MeshFault, broken, check_triangle_count, read_point

_HEAD = 84  # bytes before the triangles of a binary file; the last four say how many there are
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attributes", "<u2")])
_START = 1024  # bytes in which the first word of a text is looked for


def read_stl(data: bytes) -> Any:
    """Return the corners of triangles, shape (n, 3, 3). Raises MeshFault.

    A file is binary if it has as many bytes as its head says, also one that begins with `solid`:
    as Assimp tells the two kinds apart.
    """
    has_head = len(data) >= _HEAD
    count = struct.unpack_from("<I", data, _HEAD - 4)[0] if has_head else 0
    if len(data) == _HEAD + count * _TRIANGLE.itemsize:
        check_triangle_count(count)
        return np.frombuffer(data, _TRIANGLE, count, _HEAD)["corners"]
    if data[:_START].lstrip().lower().startswith(b"solid"):
        return _read_text(data)
    if has_head:
        raise MeshFault(f"is broken: its size is not that of the {count:,} triangles it announces")
    raise MeshFault("is broken: it is shorter than the head of a binary STL file")


def _read_text(data: bytes) -> Any:
    """Return the corners that follow the word `vertex`; three of them end with `endloop`."""
    values = array("d")
    for number, line in enumerate(data.splitlines(), 1):
        words = line.split(maxsplit=4)
        keyword = words[0].lower() if words else b""
        if keyword == b"vertex":
            values.extend(read_point(words[1:], number))
        elif keyword == b"endloop":
            if len(values) % 9:
                raise broken(number, "ends a facet that does not have three corners")
            check_triangle_count(len(values) // 9)
    if len(values) % 9:
        raise MeshFault("is broken: its last facet does not have three corners")
    return np.array(values).reshape(-1, 3, 3)
