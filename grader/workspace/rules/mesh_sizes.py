"""Meshes in millimetres that robots show in metres, or the reverse.

Their sizes are compared with the other shapes of their links. `grader inspect` warns of them; no
criterion reads a mesh.
"""

from collections.abc import Iterable, Iterator
from contextlib import suppress
from math import hypot, inf

from grader.base.errors import InputError, NotDecided
from grader.base.problems import Problem
from grader.base.records import Named
from grader.base.source import LazyLocation, Location
from grader.base.transforms import Vector
from grader.files.tree import File
from grader.ros.mesh.mesh_sample import SAMPLED, sample_size
from grader.ros.package.mesh_files import mesh_file
from grader.ros.package.robot_file import Read
from grader.ros.urdf.model import Box, Capsule, Cylinder, Geometry, Link, Mesh, Robot, Sphere
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    Rule,
)

# What is about a factor of 1000, and for which ones in a sample a whole mesh is read.
_LEAST = 500.0
_MOST = 2000.0
_SUSPECT = 100.0
_LARGE, _SMALL = 5.0, 0.005  # metres, which no mesh in the right unit has that is off by as much
_HUGE = 100.0  # metres, of a mesh beside which its link has nothing
_MAX_READ = 4 * 1024 * 1024  # bytes of a mesh that is read whole
_BYTES_A_PART = 64


class _Reference(Named):
    """A length in metres with which a mesh is compared, and what has it."""

    length: float
    what: str


def mesh_size_problems(workspace: Workspace) -> list[Problem]:
    """Return a warning for each mesh about 1000 times as large, or as small, as it should be.

    Meshes are read until the budget of the workspace is spent.
    """
    meshes = _Meshes(workspace)
    problems = dict[tuple[str, Location], Problem]()
    with suppress(NotDecided, InputError):
        for urdf in workspace.urdfs:
            loaded = urdf.loaded
            if not loaded.robot or loaded.undetermined or loaded.verdict == "rejected":
                continue
            for problem in _find_problems(meshes, urdf, loaded.robot):
                problems.setdefault((problem.message, problem.location), problem)
    return list(problems.values())


def _find_problems(meshes: "_Meshes", urdf: Read, robot: Robot) -> Iterator[Problem]:
    """Yield the meshes about 1000 times as large or small as what is beside them.

    The lengths are compared. A sample of each mesh is read first, and whole only one that may be.
    """
    reach = _longest_origin(robot)
    for link in robot.links:
        for mesh in _list_meshes(link):
            about = meshes.length(urdf, mesh, is_exact=False)
            if about is None or not mesh.location:
                continue
            reference = _find_reference(meshes, urdf, link, about, reach)
            if not reference or not _is_off(about, reference.length, _SUSPECT, inf):
                continue
            length = meshes.length(urdf, mesh, is_exact=True)
            if length is not None and _is_off(length, reference.length, _LEAST, _MOST):
                yield _other_unit(urdf, link, mesh, mesh.location, length, reference)


def _longest_origin(robot: Robot) -> float:
    """Return how far the origin of a joint is from its parent at most, in metres."""
    origins = [joint.origin for joint in robot.joints if joint.origin]
    return max((hypot(*origin.xyz) for origin in origins), default=0.0)


def _find_reference(
    meshes: "_Meshes", urdf: Read, link: Link, about: float, reach: float
) -> _Reference | None:
    """Return what a mesh of a link is compared with.

    For a huge mesh without anything beside it, this is `reach`, the longest origin of a joint.
    """
    reference = _of_primitives(link) or meshes.reference(urdf, _list_meshes(link))
    if not reference and about > _HUGE and reach > 0.0:
        return _Reference(reach, "the longest <origin> of a joint")
    return reference


def _list_meshes(link: Link) -> list[Mesh]:
    """Return the meshes of a link, each once."""
    shapes = [visual.geometry for visual in link.visuals]
    shapes += [collision.geometry for collision in link.collisions]
    return list(dict.fromkeys(shape for shape in shapes if isinstance(shape, Mesh)))


_MESH_UNIT = Rule(
    "mesh-unit",
    "values",
    OTHER_VALUE,
    "Meshes are in metres.",
    why=(
        "RViz and Gazebo show the mesh about 1000 times too large or too small. It covers the "
        "scene or is invisible, and collisions with it are wrong."
    ),
    wrong="""
<visual><geometry><mesh filename="package://rover/meshes/box.obj"/></geometry></visual>
""",
    right="""
<visual><geometry>
  <mesh filename="package://rover/meshes/box.obj" scale="0.001 0.001 0.001"/>
</geometry></visual>
""",
    frame="mesh/rover.urdf",
    beside={
        "box.obj": """
v 0 0 0
v 300 0 0
v 0 200 0
v 0 0 100
f 1 2 3
f 1 2 4
f 1 3 4
f 2 3 4
""",
    },
)


def _other_unit(
    urdf: Read,
    link: Link,
    mesh: Mesh,
    location: LazyLocation,
    length: float,
    reference: _Reference,
) -> Problem:
    """Return that a mesh is not in the unit of what is beside it."""
    at = LazyLocation(location.source, location.tag, "scale")
    message = mesh_file(mesh.filename, is_expanded=urdf.is_expanded).problem_text(
        link.name,
        f"is {length:.3g} m long, but {reference.what} is {reference.length:.3g} m: is it in "
        "millimetres or in metres? See its scale",
    )
    return _MESH_UNIT.problem(message, at.resolve(), is_certain=False)


def _is_off(length: float, right: float, least: float, most: float) -> bool:
    """Return whether a length is larger or smaller than the right one by a factor between two."""
    if length > _LARGE:
        return least <= length / right <= most
    return 0.0 < length < _SMALL and least <= right / length <= most


def _of_primitives(link: Link) -> _Reference | None:
    """Return the length of the shapes of a link's collision that are no meshes."""
    length = max(
        (_measure_length(collision.geometry) for collision in link.collisions), default=0.0
    )
    return _Reference(length, "its collision") if length else None


def _measure_length(shape: Geometry) -> float:
    """Return the largest dimension of a shape; 0 of a mesh."""
    match shape:
        case Box():
            return max(map(abs, shape.size))
        case Cylinder():
            return max(abs(2.0 * shape.radius), abs(shape.length))
        case Capsule():
            return abs(2.0 * shape.radius) + abs(shape.length)
        case Sphere():
            return abs(2.0 * shape.radius)
    return 0.0


class _Meshes:
    """The sizes of the mesh files of a workspace: each is read once."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._sizes: dict[tuple[str, str, bool], Vector | None] = {}

    def reference(self, urdf: Read, meshes: Iterable[Mesh]) -> _Reference | None:
        """Return the length of the longest mesh of a link that may be in the right unit."""
        lengths = []
        for mesh in meshes:
            length = self.length(urdf, mesh, is_exact=False) or 0.0
            if _SMALL <= length <= _LARGE:
                lengths.append(length)
        return _Reference(max(lengths), "its other mesh") if lengths else None

    def length(self, urdf: Read, mesh: Mesh, *, is_exact: bool) -> float | None:
        """Return how long a mesh is, in metres, or about how long; None where this is not known."""
        name = mesh_file(mesh.filename, is_expanded=urdf.is_expanded)
        key = (name.package, name.path, is_exact)
        if key not in self._sizes:
            file = name.file_in(self._workspace.packages)
            self._sizes[key] = None
            if file:
                self._sizes[key] = self._measure(file) if is_exact else self._sample(file)
        size = self._sizes[key]
        if size is None:
            return None
        x, y, z = mesh.scale
        return max(abs(size[0] * x), abs(size[1] * y), abs(size[2] * z))

    def _sample(self, file: File) -> Vector | None:
        if not file.path.lower().endswith((".stl", ".obj")):
            return None
        return sample_size(self._read(file, SAMPLED), file.size)

    def _measure(self, file: File) -> Vector | None:
        if file.size > _MAX_READ:
            return None
        from grader.ros.mesh.triangles import read_triangles  # late: it loads numpy

        triangles = read_triangles(self._read(file, _MAX_READ), file.path)
        if isinstance(triangles, str):
            return None
        (a, b, c), (x, y, z) = triangles.bounds
        return (x - a, y - b, z - c)

    def _read(self, file: File, limit: int) -> bytes:
        self._workspace.charge(1 + min(file.size, limit) // _BYTES_A_PART)
        return file.read(limit, first=True)
