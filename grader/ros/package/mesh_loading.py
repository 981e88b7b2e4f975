"""The meshes of a robot as triangles, for pictures.

Each file is where a build of its package puts it.
"""

import posixpath
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

from grader.base.errors import InputError, NotDecided
from grader.base.text import quoted, size_text
from grader.files.reading import hash_bytes
from grader.files.tree import File, Tree
from grader.ros.package.installed_files import look_up
from grader.ros.package.mesh_content import LFS_POINTER
from grader.ros.package.mesh_files import RELATIVE, MeshFile, list_meshes, mesh_file
from grader.ros.package.package import Package, Packages
from grader.ros.package.robot_file import Read
from grader.ros.urdf.model import Mesh

if TYPE_CHECKING:
    from grader.ros.mesh.triangles import Triangles

# Returns the packages with some names, and the files that they are among.
Around = Callable[[Collection[str]], tuple[Packages, Tree]]

# Of the meshes of a robot together.
_MAX_SIZE = 64 * 1024 * 1024  # bytes
_MAX_TRIANGLES = 1_500_000


class MeshLoader:
    """Loads the meshes of a robot, within limits for all of them together.

    The files are looked for when the first mesh is loaded, and each is read once. `kept` has what
    was read of files before, by hash and ending: a command that shows a robot again and again gives
    it to each of its loaders.
    """

    def __init__(self, robot: Read, read_around: Around) -> None:
        self.kept: dict[tuple[str, str], Triangles | str] = {}
        self._robot = robot
        self._read_around = read_around
        self._around: tuple[Packages, Tree] | None = None
        self._loaded: dict[str, Triangles | str] = {}  # by the names of the files
        self._free_size = _MAX_SIZE
        self._free_triangles = _MAX_TRIANGLES

    def load(self, mesh: Mesh) -> "Triangles | str":
        """Return the triangles of a mesh, before it is scaled, or why it cannot be shown.

        The reason is the end of a sentence that begins with its name.
        """
        if mesh.filename not in self._loaded:
            named = mesh_file(mesh.filename, is_expanded=self._robot.is_expanded)
            file = self._find(named)
            if not isinstance(file, str):
                self._loaded[mesh.filename] = self._read(file, named.path)
            else:
                self._loaded[mesh.filename] = file
        return self._loaded[mesh.filename]

    def _find(self, named: MeshFile) -> File | str:
        """Return the file that is meant; else why there is none."""
        if named.doubt:
            return "is not at a package:// path, and is not opened"
        if named.fault or not named.package:
            return named.fault or RELATIVE
        if self._around is None:
            self._around = self._read_around(self._name_packages())
        packages, tree = self._around
        path = posixpath.normpath(named.path)
        package = packages[0].find(named.package) if packages else None
        if package:
            return _find_in_package(named, package, path, tree)
        # RViz needs a package.xml; a folder with the package's name surely has the mesh.
        end = f"/{named.package}/{path}"
        paths = [
            path_in_tree
            for path_in_tree in tree.files
            if f"/{tree.name}/{path_in_tree}".endswith(end)
        ]
        if paths:
            return tree.files[min(paths, key=len)]
        return f"is looked for at share{end}, but no package {quoted(named.package)} is here"

    def _name_packages(self) -> set[str]:
        """Return the names of the packages that the robot's meshes are in."""
        robot = self._robot.loaded.robot
        meshes = list_meshes(robot) if robot else {}
        files = [mesh_file(filename, is_expanded=self._robot.is_expanded) for filename in meshes]
        return {file.package for file in files if file.package}

    def _read(self, file: File, path: str) -> "Triangles | str":
        """Return the triangles in a file; else why they are not shown."""
        from grader.ros.mesh.triangles import MAX_MESH_SIZE, read_triangles  # late: it loads numpy

        if file.size > self._free_size:
            return f"does not fit: {size_text(_MAX_SIZE)} are read of all meshes of a robot"
        self._free_size -= file.size
        try:
            data = file.read(MAX_MESH_SIZE + 1, first=True)
        except InputError as error:
            return f"cannot be read: {error}"
        if data.startswith(LFS_POINTER):
            return "is not here: this download holds only the pointer of Git LFS"
        content = (hash_bytes(data), posixpath.splitext(path)[1])
        if content not in self.kept:
            self.kept[content] = read_triangles(data, path)
        triangles = self.kept[content]
        if isinstance(triangles, str):
            return triangles
        if triangles.count > self._free_triangles:
            return f"does not fit: {_MAX_TRIANGLES:,} triangles are read of all meshes of a robot"
        self._free_triangles -= triangles.count
        return triangles


def _find_in_package(named: MeshFile, package: Package, path: str, tree: Tree) -> File | str:
    """Return the file of a package that a build installs where a mesh is looked for.

    It may also be one that a build may install there. If there is none, return why.
    """
    target = f"share/{named.package}/{path}"
    place = look_up(package, target)
    file = package.tree.files.get(place.path if place.state == "installed" else path)
    try:
        fault = named.why_not_found((package,), tree)
    except NotDecided as reason:
        if file:
            return file
        fault = f"is not here: {reason}"
    if not file or fault:
        if place.state in ("absent", "no build"):
            fault += f"; it is looked for at {target}"
        return fault
    return file
