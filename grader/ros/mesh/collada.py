"""COLLADA files: the geometries that nodes of the scene show, as triangles in metres.

The axis that a file calls up changes nothing, as in RViz, which sets
AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION (rviz_rendering/mesh_loader_helpers/assimp_loader.cpp
in ros2/rviz). The unit scales the mesh. Colours, textures, skins' bones and morphs are ignored.
"""

from collections.abc import Iterator
from math import isfinite
from typing import Any

import numpy as np

from grader.ros.mesh.mesh_fault import (
    MeshFault,
    broken,
    check_triangle_count,
    fan_corners,
    look_up_corners,
)
from grader.ros.xml.parsing import Element, Elements, XMLSyntaxError, parse_xml

_MAX_NODES = 10_000  # that are visited: a node can be shown many times, also by itself
# The kinds of primitives that are surfaces.
_SURFACES = frozenset({"triangles", "polylist", "polygons", "tristrips", "trifans"})


def read_collada(data: bytes) -> Any:
    """Return the corners of triangles, shape (n, 3, 3). Raises MeshFault."""
    try:
        root = parse_xml(data)
    except (XMLSyntaxError, ValueError) as error:
        line, _ = getattr(error, "position", (1, 1))
        raise broken(line, "is not XML") from None
    if _kind(root) != "COLLADA":
        raise MeshFault("is broken: its root is not <COLLADA>")
    with np.errstate(all="ignore"):  # numbers that overflow are found in the result
        parts = list(_Scene(root).placed_geometries())
        if not parts:
            raise MeshFault("has no triangles")
        return np.concatenate(parts) * _metres(root)


def _metres(root: Element) -> float:
    """Return the length of the file's unit."""
    unit = root.find("{*}asset/{*}unit")
    text = unit.get("meter", "1") if unit is not None else "1"
    try:
        metres = float(text)
    except ValueError:
        metres = 0.0
    if not isfinite(metres) or metres <= 0.0:
        raise MeshFault("is broken: its unit is not a length")
    return metres


class _Scene:
    """The elements of a file by their ids, and the geometries that were read."""

    def __init__(self, root: Element) -> None:
        self._root = root
        self._elements: Elements = {}
        for element in root.iter("*"):
            self._elements.setdefault(element.get("id", ""), element)
        self._geometries: dict[Element, Any] = {}

    def placed_geometries(self) -> Iterator[Any]:
        """Yield the corners of the triangles of each geometry that a node shows, in the scene."""
        pending = [(self._shown_scene(), np.eye(4))]
        visited = triangles = 0
        while pending:
            node, T_scene_parent = pending.pop()
            visited += 1
            if visited > _MAX_NODES:
                raise MeshFault(f"has more than {_MAX_NODES:,} nodes, the limit")
            T_scene_node = T_scene_parent @ _transform(node)
            for child in node.iterchildren("*"):
                kind = _kind(child)
                if kind == "node":
                    pending.append((child, T_scene_node))
                elif kind == "instance_node":
                    pending.append((self._named(child.get("url")), T_scene_node))
                elif kind in ("instance_geometry", "instance_controller"):
                    corners = self._geometry(self._named(child.get("url")))
                    triangles += len(corners)
                    check_triangle_count(triangles)
                    yield corners @ T_scene_node[:3, :3].T + T_scene_node[:3, 3]

    def _shown_scene(self) -> Element:
        shown = self._root.find("{*}scene/{*}instance_visual_scene")
        if shown is not None:
            return self._named(shown.get("url"))
        first = self._root.find("{*}library_visual_scenes/{*}visual_scene")
        if first is None:
            raise MeshFault("is broken: it has no scene")
        return first

    def _named(self, reference: str | None) -> Element:
        """Return the element that a reference `#id` names. Raises MeshFault."""
        name = (reference or "").removeprefix("#")
        element = self._elements.get(name) if name else None
        if element is None:
            raise MeshFault("is broken: it names an element that is not in it")
        return element

    def _geometry(self, element: Element) -> Any:
        """Return the corners of the triangles of a geometry, or of the one that a skin is on."""
        skin = element.find("{*}skin")
        if skin is not None:
            element = self._named(skin.get("source"))
        if element not in self._geometries:
            parts = [np.empty((0, 3, 3))]
            for surface in element.iterfind("{*}mesh/*"):
                if _kind(surface) in _SURFACES:
                    parts.append(self._surface(surface))
            self._geometries[element] = np.concatenate(parts)
        return self._geometries[element]

    def _surface(self, surface: Element) -> Any:
        """Return the corners of the triangles of a primitive.

        These are those of the first input that names points.
        """
        inputs = surface.findall("{*}input")
        vertices = [source for source in inputs if source.get("semantic") == "VERTEX"]
        if not vertices:
            return np.empty((0, 3, 3))
        offsets = [_whole(source.get("offset", "0")) for source in inputs]
        stride = max(offsets) + 1
        offset = _whole(vertices[0].get("offset", "0"))
        rows = []
        for element in surface.iterfind("{*}p"):
            numbers = _numbers(element, int)
            if len(numbers) % stride:
                raise MeshFault("is broken: the corners of its triangles are not complete")
            rows.append(numbers[offset::stride])
        if not rows:
            return np.empty((0, 3, 3))
        corners = np.concatenate(rows)
        indices = corners[_triangles(surface, [len(row) for row in rows])]
        check_triangle_count(len(indices))
        return look_up_corners(self._points(vertices[0]), indices)

    def _points(self, vertices: Element) -> Any:
        """Return the positions that an input of vertices names, shape (n, 3)."""
        positions = self._named(vertices.get("source")).find("{*}input[@semantic='POSITION']")
        if positions is None:
            raise MeshFault("is broken: its vertices have no positions")
        source = self._named(positions.get("source"))
        values = _numbers(source.find("{*}float_array"), float)
        accessor = source.find("{*}technique_common/{*}accessor")
        stride = 3
        start = 0
        if accessor is not None:
            stride = _whole(accessor.get("stride", "3"))
            start = _whole(accessor.get("offset", "0"))
        if stride < 3 or stride > max(3, len(values)):
            raise MeshFault("is broken: its positions do not have three coordinates")
        values = values[start:]
        count = len(values) // stride
        return values[: count * stride].reshape(count, stride)[:, :3]


def _triangles(surface: Element, lengths: list[int]) -> Any:
    """Return the positions of the corners of triangles, shape (n, 3), in those of a primitive.

    The primitive's lists of corners have these lengths.
    """
    kind = _kind(surface)
    total = sum(lengths)
    if kind == "triangles":
        if total % 3:
            raise MeshFault("is broken: the corners of its triangles are not complete")
        check_triangle_count(total // 3)
        return np.arange(total).reshape(-1, 3)
    if kind == "tristrips":
        check_triangle_count(total - 2 * len(lengths))
        starts = np.cumsum(lengths) - lengths
        strips = [np.arange(start, start + n - 2) for start, n in zip(starts, lengths, strict=True)]
        first = np.concatenate(strips)
        return np.stack([first, first + 1, first + 2], axis=1)
    counts = np.array(lengths, np.int64)
    if kind == "polylist":
        counts = _numbers(surface.find("{*}vcount"), int)
    if (counts < 0).any() or (counts > total).any() or counts.sum() != total:
        raise MeshFault("is broken: the corners of its polygons are not complete")
    return fan_corners(counts)


def _transform(node: Element) -> Any:
    """Return T_parent_node of a node: the product of its transformations, in their order."""
    T_parent_node = np.eye(4)
    for child in node.iterchildren("*"):
        kind = _kind(child)
        if kind == "matrix":
            step = _sized_numbers(child, 16).reshape(4, 4)
        elif kind == "translate":
            step = np.eye(4)
            step[:3, 3] = _sized_numbers(child, 3)
        elif kind == "scale":
            step = np.diag([*_sized_numbers(child, 3), 1.0])
        elif kind == "rotate":
            step = _rotation(_sized_numbers(child, 4))
        elif kind in ("lookat", "skew"):
            raise MeshFault(f"is placed by a <{kind}>, which is not read")
        else:
            continue
        T_parent_node = T_parent_node @ step
    return T_parent_node


def _rotation(values: Any) -> Any:
    """Return the rotation about an axis, x y z, by an angle in degrees (Rodrigues' formula)."""
    axis = values[:3]
    angle = np.radians(values[3])
    length = np.linalg.norm(axis)
    x, y, z = axis / length if length > 0.0 else axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation = np.eye(4)
    rotation[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return rotation


def _kind(element: Element) -> str:
    """Return the name of an element without its namespace, which differs between versions."""
    return str(element.tag).rpartition("}")[2]


def _whole(text: str) -> int:
    """Return a number of an attribute that counts something. Raises MeshFault."""
    if text.isdecimal() and len(text) < 10:
        return int(text)
    raise MeshFault("is broken: an attribute is not a whole number")


def _sized_numbers(element: Element, count: int) -> Any:
    numbers = _numbers(element, float)
    if len(numbers) != count:
        raise MeshFault(f"is broken: a <{_kind(element)}> does not have {count} numbers")
    return numbers


def _numbers(element: Element | None, kind: type) -> Any:
    """Return the numbers in an element; none without it. Raises MeshFault."""
    words = (element.text or "").split() if element is not None else []
    try:
        return np.array(words, dtype=np.int64 if kind is int else np.float64)
    except (ValueError, OverflowError):
        raise MeshFault("is broken: it has a number that cannot be read") from None
