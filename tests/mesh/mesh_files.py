"""Mesh files in each format with given triangles, written without the code of the readers."""

import struct
from collections.abc import Callable, Iterable, Sequence

Point = tuple[float, float, float]
Triangle = tuple[Point, Point, Point]

CUBE_POINTS = [(x, y, z) for x in (0.0, 1.0) for y in (0.0, 2.0) for z in (0.0, 3.0)]
_FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
CUBE: list[Triangle] = [
    (CUBE_POINTS[a], CUBE_POINTS[b], CUBE_POINTS[c])
    for first, second, third, fourth in _FACES
    for a, b, c in ((first, second, third), (first, third, fourth))
]


def binary_stl(triangles: Sequence[Triangle], *, head: bytes = b"", count: int = -1) -> bytes:
    """Return a binary STL file; `count` is the number of triangles in its head."""
    announced = count if count >= 0 else len(triangles)
    rows = [struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles]
    return head.ljust(80, b"\0") + struct.pack("<I", announced) + b"".join(rows)


def text_stl(triangles: Iterable[Triangle]) -> bytes:
    """Return a text STL file."""
    lines = ["solid a"]
    for triangle in triangles:
        lines += ["  facet normal 0 0 0", "    outer loop"]
        lines += [f"      vertex {x!r} {y!r} {z!r}" for x, y, z in triangle]
        lines += ["    endloop", "  endfacet"]
    return "\n".join([*lines, "endsolid a", ""]).encode()


def obj(triangles: Sequence[Triangle]) -> bytes:
    """Return an OBJ file, half of whose faces count their points from the end."""
    lines = ["# a mesh", "o a"]
    for number, triangle in enumerate(triangles):
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in triangle]
        lines.append("f -3 -2// -1/1/1" if number % 2 else f"f {' '.join(_numbers(number))}")
    return "\n".join(lines).encode()


def _numbers(triangle: int) -> list[str]:
    return [str(3 * triangle + corner) for corner in (1, 2, 3)]


def collada(triangles: Sequence[Triangle], **parts: str) -> bytes:
    """Return a COLLADA file with one geometry; `parts` are those of `collada_with`."""
    points = [point for triangle in triangles for point in triangle]
    corners = " ".join(f"{number} 0" for number in range(len(points)))
    surface = f"<triangles count='{len(triangles)}'>{INPUTS}<p>{corners}</p></triangles>"
    return collada_with(surface, points, **parts)


INPUTS = "<input semantic='VERTEX' source='#v' offset='0'/><input semantic='NORMAL' source='#n' offset='1'/>"
_ACCESSOR = "<technique_common><accessor source='#a' count='9' stride='3'/></technique_common>"


def collada_with(
    surface: str,
    points: Sequence[Point],
    *,
    asset: str = "<unit meter='1'/><up_axis>Z_UP</up_axis>",
    node: str = "<instance_geometry url='#g'/>",
    nodes: str = "",
    start: str = "",
    accessor: str = _ACCESSOR,
) -> bytes:
    """Return a COLLADA file with one geometry `#g` that has the elements of `surface`."""
    values = " ".join(f"{value!r}" for point in points for value in point)
    return f"""<?xml version="1.0"?>{start}
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>{asset}</asset>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="9">{values}</float_array>{accessor}</source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>{surface}</mesh></geometry></library_geometries>
<library_nodes>{nodes}</library_nodes>
<library_visual_scenes><visual_scene id="scene"><node id="n">{node}</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene></COLLADA>""".encode()


WRITERS: dict[str, Callable[[Sequence[Triangle]], bytes]] = {
    "binary.stl": binary_stl,
    "text.STL": text_stl,
    "mesh.obj": obj,
    "mesh.dae": collada,
}
