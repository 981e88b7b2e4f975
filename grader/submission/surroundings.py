"""What is around a URDF in a submission: packages whose launch files load it, and files that its xacro includes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from grader.errors import InputError, NotDecided
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree, make_tree, parents
from grader.package.package import Package
from grader.python.budget import Budget
from grader.python.values import Undetermined

if TYPE_CHECKING:
    from grader.package.launch.model import NamedFile
    from grader.xacro.files import Workspace

_MAX_FOLDERS = 40  # whose launch files are read
_NO_FILES = make_tree("", (), ())


class Surroundings(NamedTuple):
    """The files and packages of a submission; `arguments` are those that the user gives xacro.

    `ask` is called with the name of each other file that xacro reads. With `is_single` they are those around a single
    file.
    """

    budget: Budget
    tree: Tree = _NO_FILES
    graded: Package | None = None
    packages: tuple[Package, ...] = ()
    arguments: Mapping[str, str] = {}
    is_single: bool = False
    ask: Callable[[str], object] = lambda _: None

    def robot_references(self, path: str) -> list[NamedFile]:
        """Return where the launch files of the graded package read a URDF; without one, those in a folder around it."""
        paths = [path] if self.graded is None and not self.is_single else []
        around = [self.graded] if self.graded is not None else launch_folders(self.tree, self.packages, paths)
        return [found for package in around for found in package.robot_references(path.rpartition("/")[2])]

    def workspace(self) -> Workspace:
        """Return the files as xacro sees them."""
        from grader.xacro.files import Workspace  # late: most URDFs are no xacro

        folders = {package.name: package.folder for package in reversed(self.packages)}
        is_part = not folders and bool(self.tree.files)
        return Workspace(
            self._read,
            folders.get,
            self.budget,
            tuple(self.tree.files),
            self._installed_file,
            is_part,
            self.ask,
        )

    def _read(self, path: str) -> bytes:
        file = self.tree.files.get(path)
        ignored = next((other for other in self.tree.ignored if other.path == path), None)
        if file is None and ignored is not None:
            raise NotDecided(str(ignored))
        if file is None and not self.tree.files:
            raise NotDecided(f"the included file {path} is not read with a single file: give the folder with both")
        if file is None and self.is_single and not self.packages:
            raise NotDecided(f"there is no file {path} in the folder of this single file: give the folder with both")
        if file is None:
            raise InputError(f"there is no file {path} in the submission")
        try:
            return file.read(URDF_LIMIT)
        except InputError as error:
            raise NotDecided(str(error)) from None

    def _installed_file(self, name: str, inside: str) -> str | None:
        """Return the file at a path in a package once it is built; without any package, the most similar path."""
        for package in self.packages:
            if package.name == name:
                similar = any(f"/{path}".endswith(f"/{inside}") for path in package.tree.files)
                if package.is_cmake and similar and inside not in package.tree.files:
                    raise Undetermined(f"whether CMakeLists.txt installs {inside} is not evaluated")
                source = package.installed.get(f"share/{name}/{inside}")
                return package.path(source) if source is not None else None
        if self.packages:
            return None
        steps = inside.split("/")
        for count in range(len(steps), 0, -1):
            end = "/" + "/".join(steps[-count:])
            found = [path for path in self.tree.files if f"/{path}".endswith(end)]
            if len(found) == 1:
                return found[0]
        return None


def launch_folders(tree: Tree, packages: Sequence[Package], paths: Iterable[str]) -> list[Package]:
    """Return the nearest folders around these files that have launch files outside of packages, as packages."""
    packaged = tuple(package.path("") for package in packages)
    loose = tree.only(lambda path: not path.startswith(packaged)) if packaged else tree
    files = Package("", loose, None, {}).launch_files
    folders = {folder for path in files for folder in (*parents(path), "")}
    around = {folder for path in paths for folder in [it for it in (*parents(path), "") if it in folders][:1]}
    return [Package(folder, loose.below(folder), None, {}) for folder in sorted(around)[:_MAX_FOLDERS]]
