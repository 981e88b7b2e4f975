"""The triangles of meshes as data for the script of a page that `grader view` serves."""

from collections.abc import Mapping
from hashlib import sha256
from typing import TYPE_CHECKING, Any, NamedTuple

from grader.base.text import quoted_end
from grader.report.drawing.picture import Scene
from grader.ros.api import Mesh

if TYPE_CHECKING:
    from grader.ros.api import MeshLoader

_MAX_TRIANGLES = 50_000  # of one mesh
_MAX_OF_ROBOT = 300_000
_MAX_KEPT = 192 * 1024 * 1024  # bytes of what was read and of what is served
_TRIANGLE = 36  # bytes of one that was read
_DIGITS = 24  # of an address


class _PackedMesh(NamedTuple):
    """A mesh as it is served, and how many of its triangles are in it."""

    address: str
    triangles: int


class MeshStore:
    """What is served of the meshes of robots that are shown again and again."""

    def __init__(self) -> None:
        self._read: dict[tuple[str, str], Any] = {}  # the triangles of files
        self._packed: dict[tuple[object, ...], _PackedMesh] = {}
        self._data: dict[str, bytes] = {}

    def data(self, address: str) -> bytes | None:
        """Return the triangles of a mesh, as `Triangles.packed` has them.

        It is None if no mesh has the address.
        """
        return self._data.get(address)

    def lend(self, meshes: "MeshLoader") -> None:
        """Let a loader know what was read of mesh files before, unless that is too much."""
        size = sum(map(len, self._data.values()))
        for triangles in self._read.values():
            if not isinstance(triangles, str):
                size += _TRIANGLE * triangles.count
        if size > _MAX_KEPT:
            for store in (self._read, self._packed, self._data):
                store.clear()
        meshes.kept = self._read

    def pack(self, scene: Scene, meshes: "MeshLoader") -> tuple[Mapping[Mesh, str], list[str]]:
        """Return the addresses of the meshes of a scene, and sentences on simplified ones.

        These are shown with fewer triangles. A mesh without an address is shown as its box.
        """
        addresses = {}
        sentences: dict[str, None] = {}
        room = _MAX_OF_ROBOT
        for body in scene.bodies:
            mesh = body.mesh
            triangles = meshes.load(mesh) if mesh else ""
            if not mesh or isinstance(triangles, str) or mesh in addresses:
                continue
            mirrored = tuple(factor < 0 for factor in mesh.scale)
            most = min(room, _MAX_TRIANGLES, triangles.count)
            name = (triangles, mirrored, most)
            if name not in self._packed:
                reduced = triangles.reduced(most)
                data = reduced.packed(triangles.bounds, mirrored)
                self._packed[name] = _PackedMesh(sha256(data).hexdigest()[:_DIGITS], reduced.count)
                self._data[self._packed[name].address] = data
            packed = self._packed[name]
            room -= packed.triangles
            if packed.triangles:
                addresses[mesh] = packed.address
            if packed.triangles < triangles.count:
                count = f"{packed.triangles:,} of {triangles.count:,} triangles"
                file = quoted_end(mesh.filename)
                sentences[f"Shown with fewer triangles: {file}, {count}"] = None
        return addresses, list(sentences)
