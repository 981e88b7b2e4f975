"""What is around a URDF in a submission: packages whose launch files load it, and files that its xacro includes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from grader.errors import InputError, NotDecided
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree, make_tree, parents
from grader.package.package import Package
from grader.python.budget import Budget
from grader.python.values import Undetermined

if TYPE_CHECKING:
    from grader.package.launch.model import NamedFile

_MAX_FOLDERS = 40  # whose launch files are read
_NO_FILES = make_tree("", (), ())


class Surroundings(NamedTuple):
    """The files and packages around a URDF, as launch files and xacro find them: the Workspace of xacro."""

    budget: Budget  # of what is expanded and evaluated
    tree: Tree = _NO_FILES
    graded: Package | None = None
    packages: tuple[Package, ...] = ()
    arguments: Mapping[str, str] = {}  # that the user gives xacro
    is_single: bool = False  # whether the files are those around a single file
    ask: Callable[[str], object] = lambda _: None  # is called with the name of each other file that xacro reads

    def robot_references(self, path: str) -> list[NamedFile]:
        """Return where the launch files of the graded package read a URDF; without one, those in a folder around it."""
        paths = [path] if self.graded is None and not self.is_single else []
        around = [self.graded] if self.graded is not None else launch_folders(self.tree, self.packages, paths)
        return [found for package in around for found in package.robot_references(path.rpartition("/")[2])]

    @property
    def paths(self) -> Collection[str]:
        """The paths of the files."""
        return self.tree.files

    @property
    def is_part(self) -> bool:
        """Whether the files may be a part of any package, because there is none among them."""
        return bool(self.tree.files) and not self.packages

    def package(self, name: str) -> str | None:
        """Return the folder of a package."""
        return next((package.folder for package in self.packages if package.name == name), None)

    def read(self, path: str) -> bytes:
        """Return the bytes of a file. Raises InputError, NotDecided."""
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

    def installed(self, package: str, inside: str) -> str | None:
        """Return the file at a path in a package once it is built; without any package, the most similar path."""
        for own in self.packages:
            if own.name == package:
                similar = any(f"/{path}".endswith(f"/{inside}") for path in own.tree.files)
                if own.is_cmake and similar and inside not in own.tree.files:
                    raise Undetermined(f"whether CMakeLists.txt installs {inside} is not evaluated")
                source = own.installed.get(f"share/{package}/{inside}")
                return own.path(source) if source is not None else None
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
