"""What the name of a mesh means to ROS 2, and whether a build puts the file there.

No mesh is loaded.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import islice
from posixpath import basename, dirname, normpath

from grader.base.errors import NotDecided
from grader.base.grouping import Strings
from grader.base.names import closest
from grader.base.patterns import on_use
from grader.base.problems import Problem
from grader.base.records import Named
from grader.base.source import LazyLocation
from grader.base.text import quoted, quoted_end
from grader.files.tree import File, Tree
from grader.ros.installation.package_problems import MESH_PATH
from grader.ros.installation.places import is_of_one_machine
from grader.ros.package.installed_files import Lookup, look_up, similar_file
from grader.ros.package.mesh_content import content_fault
from grader.ros.package.package import Package
from grader.ros.package.robot_file import Read
from grader.ros.urdf.model import Mesh, Robot

_SCHEME = on_use(
    r"([A-Za-z][A-Za-z0-9+.-]+):(//)?(.*)", re.DOTALL
)  # one letter is a disk of Windows
_ABSOLUTE = on_use(r"[/~\\]|[A-Za-z]:")
_ONE_MACHINE = "exists on one machine only; use package://"
RELATIVE = "is at a relative path, which RViz does not find; use package://"
_BACKSLASH = "has a \\ in its path; separate folders by /"

_MAX_WARNED = 20  # meshes of one file


class MeshFile(Named):
    """The file name of a <mesh>, or why ROS 2 does not find such a name.

    It has the package that the name gives and the path in it.

    `doubt` says why it cannot be determined whether it does. `written` is the name as the student
    wrote it.
    """

    written: str
    path: str
    package: str = ""
    fault: str = ""
    doubt: str = ""

    @property
    def steps(self) -> Strings:
        """The package, the folders and the name."""
        whole = normpath(f"{self.package}/{self.path}".replace("\\", "/"))
        return tuple(step for step in whole.split("/") if step)

    def ends_in(self, other: "MeshFile", *, any_case: bool = False) -> bool:
        """Return whether the path ends in all the steps of another one."""
        steps = self.steps
        end = other.steps
        if any_case:
            steps, end = (tuple(map(str.casefold, path)) for path in (steps, end))
        return steps[-len(end) :] == end != ()

    def problem_text(self, link: str, fault: str) -> str:
        """Return the message about what is wrong with the mesh of a link."""
        return f"the mesh {quoted_end(self.written)} of {quoted(link)} {fault}"

    def why_not_found(self, packages: Sequence[Package], tree: Tree) -> str:
        """Return why ROS 2 does not find a package's file after a build.

        It is empty if it does, or if there is no package.

        Raises NotDecided where that cannot be determined statically.
        """
        if not packages:
            return ""
        if not self.package:
            if not self.doubt:
                raise NotDecided(
                    "RViz finds no relative path; other programs may",
                    "a mesh is at a relative path",
                )
            return ""
        package = packages[0].find(self.package)
        path = normpath(self.path)
        if not package:
            return _without_package(self.package, path, packages, tree)
        if path.startswith("../") or path in ("..", "."):
            return "is outside of its package"
        return _fault_in_package(package, f"share/{self.package}/{path}", tree)

    def content_fault(self, packages: Sequence[Package]) -> str:
        """Return what is wrong with the content of its file in the workspace.

        It is empty if nothing is, or there is no such file. Raises NotDecided.
        """
        file = self.file_in(packages)
        return content_fault(file, self.path) if file else ""

    def file_in(self, packages: Sequence[Package]) -> File | None:
        """Return its file in a package of the workspace; None if there is none."""
        package = packages[0].find(self.package) if packages else None
        if not package:
            return None
        path = normpath(self.path)
        lookup = look_up(package, f"share/{self.package}/{path}")
        return package.tree.files.get(lookup.path if lookup.state == "installed" else path)


def mesh_file(filename: str, *, is_expanded: bool = False) -> MeshFile:
    """Return what the file name of a <mesh> means.

    `is_expanded` says whether xacro has been expanded in it.
    """
    match = _SCHEME.fullmatch(filename)
    scheme, slashes, rest = match.groups() if match else ("", "", filename)
    fault = _BACKSLASH if "\\" in filename else ""
    shared = _file_from_xacro(scheme, rest, fault) if is_expanded else None
    if shared:
        return shared
    if scheme == "package" and slashes:
        package, _, path = rest.partition("/")
        return MeshFile(filename, path, package, fault)
    if not scheme and not _ABSOLUTE.match(filename):
        return MeshFile(filename, rest, "", fault)
    fault, doubt = _fault_of_scheme(scheme, slashes or "")
    return MeshFile(filename, rest, "", fault, doubt)


def _file_from_xacro(scheme: str, rest: str, fault: str) -> MeshFile | None:
    """Return the file for which xacro wrote a path; None for another path."""
    shared = _path_from_xacro(rest) if scheme in ("", "file") else None
    if shared is None:
        return None
    package, path = shared
    written = f"$(find {package})/{path}"
    if scheme:
        return MeshFile(f"{scheme}://{written}", path, package, fault)
    return MeshFile(written, path, package, "needs file:// before $(find ...)")


def _fault_of_scheme(scheme: str, slashes: str) -> tuple[str, str]:
    """Return what is wrong with a file name that names no package, and what may be wrong.

    Without a scheme it is an absolute path.
    """
    if not scheme:
        return f"is at an absolute path, which {_ONE_MACHINE}", ""
    if scheme == "file":
        return f"is at a file:// path, which {_ONE_MACHINE}", ""
    if scheme.lower() in ("package", "file") or not slashes:
        return f"begins with {scheme}:{slashes}; use package://", ""
    return "", f"it is at a {scheme}:// path, which not every program finds"


def mesh_problems(urdf: Read, packages: Sequence[Package], tree: Tree) -> Iterator[Problem]:
    """Yield a warning for each mesh that RViz certainly does not find.

    It is not found on another machine, or after a build.

    A file of a package outside the workspace may be installed, and so may a file:// path outside
    of home folders.
    """
    robot = urdf.loaded.robot
    meshes = list_meshes(robot) if robot else {}
    for name, (link, mesh) in islice(meshes.items(), _MAX_WARNED):
        file = mesh_file(name, is_expanded=urdf.is_expanded)
        fault = _sure_fault(file, packages, tree)
        if fault and mesh.location and "$" not in name:
            at = LazyLocation(mesh.location.source, mesh.location.tag, "filename")
            yield Problem(MESH_PATH, file.problem_text(link, fault), at.resolve())


def list_meshes(robot: Robot) -> dict[str, tuple[str, Mesh]]:
    """Return the meshes of a robot by the names of their files, each with a link that has it."""
    shapes = [(link.name, visual.geometry) for link in robot.links for visual in link.visuals]
    shapes += [
        (link.name, collision.geometry) for link in robot.links for collision in link.collisions
    ]
    return {mesh.filename: (link, mesh) for link, mesh in shapes if isinstance(mesh, Mesh)}


def _sure_fault(file: MeshFile, packages: Sequence[Package], tree: Tree) -> str:
    """Return why RViz does not find a mesh, if that is certain."""
    if file.written.startswith("file://") and not file.package and not is_of_one_machine(file.path):
        return ""
    if not (file.package or file.fault or file.doubt):
        return RELATIVE
    if file.fault or not any(package.name == file.package for package in packages):
        return file.fault
    try:
        return file.why_not_found(packages, tree)
    except NotDecided:
        return ""


def _fault_in_package(package: Package, target: str, tree: Tree) -> str:
    """Return what is wrong with the file that a build installs at a path.

    If it installs none there, return why.
    """
    lookup = look_up(package, target)
    name = basename(target)
    file = package.tree.files.get(lookup.path) if lookup.state == "installed" else None
    if file:
        return content_fault(file, target)
    if lookup.state == "unknown" or any(basename(path) == name for path in package.tree.files):
        return _why_not_installed(package, target, lookup)
    if tree.unopened:
        raise NotDecided(
            f"{name} may be in an archive that could not be opened",
            "an archive could not be opened",
        )
    similar = similar_file(package, name)
    return (
        "is not in the package "
        f"{package.name!r}{f'; there is {quoted(similar)}' if similar else ''}"
    )


def _path_from_xacro(path: str) -> tuple[str, str] | None:
    """Return the package and the path in it where $(find ...) has given a path."""
    from grader.ros.xacro.texts import INSTALLED  # late: most URDFs are no xacro

    match = re.fullmatch(rf"/*{INSTALLED}/([^/]+)/share/\1/+(.*)", path, re.DOTALL)
    if match:
        return (match[1], match[2])
    return None


def _without_package(name: str, path: str, packages: Sequence[Package], tree: Tree) -> str:
    """Return that no package of the workspace has a name.

    Raises NotDecided if one may be in an archive that is closed.
    """
    if tree.unopened:
        reason = "an archive could not be opened"
        raise NotDecided(
            f"the package {quoted(name)} may be in an archive that could not be opened", reason
        )
    holding = [package.name for package in packages if path in package.tree.files]
    meant = closest(name, [package.name for package in packages]) or next(iter(holding), None)
    if meant is not None:
        hint = f"; the submission has {quoted(meant)}"
    else:
        hint = ", which is not part of the submission"
    return f"names the package {quoted(name)}{hint}"


def _why_not_installed(package: Package, target: str, lookup: Lookup) -> str:
    """Return why a build does not install a file of a package at a path, by what it has instead."""
    setup = package.installation
    if lookup.state == "unknown":
        raise NotDecided(lookup.text, lookup.text)
    if lookup.state == "elsewhere":
        return f"is looked for at {target}, but {lookup.text}"
    if not setup or lookup.state == "no build":
        return f"is not installed: {lookup.text}"
    return f"is not installed: add {lookup.path} to {setup.entries}, for {dirname(target)}"
