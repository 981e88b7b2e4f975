"""The files of a workspace and its packages, and the work that may be spent on reading them."""

from collections import Counter
from collections.abc import Callable
from functools import cached_property
from typing import TypeVar, TypeVarTuple

from grader.base.errors import NotDecided
from grader.base.grouping import Strings
from grader.base.records import Record
from grader.base.reuse import Memory
from grader.files.tree import Tree, parents
from grader.ros.launch.launch_model import StartedNode
from grader.ros.package.finding import is_backup
from grader.ros.package.package import Package
from grader.ros.python.budget import Budget, OutOfBudget

_Read = TypeVarTuple("_Read")
_T = TypeVar("_T")
_CAUSE = "not all names are compared"
TOO_MUCH = "comparing them takes more work than one submission may use"
# Of a package, which may be empty.
_USUAL_FOLDERS = (
    *("action", "config", "include", "launch", "maps", "meshes", "models", "msg", "params"),
    *("resource", "rviz", "scripts", "src", "srv", "test", "urdf", "worlds"),
)


class WorkspaceFolder(Record):
    """The files of a workspace and its packages, and the work that may be spent on reading them.

    `Workspace` makes it, and every other part of the model reads files through it.
    """

    found_packages: tuple[Package, ...]  # the one that matches best first
    tree: Tree  # all files, also those outside of packages
    memory: Memory | None  # what was read of an earlier state of the files
    # Whether misspelt programs, entry points, parameter files and keys count as what is meant. A
    # criterion judges what is written.
    reads_meant: bool = False

    @cached_property
    def _work(self) -> Budget:
        for package in self.found_packages:
            return package.work
        return Budget()

    @property
    def is_spent(self) -> bool:
        """Whether a workspace may ask for no more names to be compared."""
        return self._work.is_spent

    def charge(self, parts: int) -> None:
        """Charge the work of comparing names to the budget of the workspace. Raises NotDecided."""
        try:
            self._work.charge(parts)
        except OutOfBudget:
            raise NotDecided(f"not all names are compared: {TOO_MUCH}", _CAUSE) from None

    @cached_property
    def packages(self) -> tuple[Package, ...]:
        """The packages that a build of the workspace has: the best of each name.

        Those that colcon ignores are not among them.
        """
        packages = []
        for package in self.found_packages:
            best = package.packages.get(package.name)
            if not package.ignored_by and best and best.folder == package.folder:
                packages.append(package)
        return tuple(packages)

    def means_one(self, package: Package, name: str) -> bool:
        """Return whether a name in a file of a package certainly means one package.

        This is its own package, or the only one.
        """
        return name in package.names or self.counts[name] < 2

    def recall(self, read: Callable[[*_Read], _T], *of: *_Read) -> _T:
        """Return what a function makes of texts and nothing else, or made of them before."""
        if not self.memory:
            return read(*of)
        return self.memory.recall((read, *of), None, self._work, lambda _: read(*of))

    def find_package(self, node: StartedNode) -> Package | None:
        """Return the package of the workspace whose program a node is."""
        if self.packages:
            return self.packages[0].find(node.package)
        return None

    def begins_with(self, path: str, start: bytes) -> bool:
        """Return whether a file of the workspace begins with some bytes."""
        file = self.tree.files.get(path)
        return file is not None and file.read(len(start), first=True) == start

    @cached_property
    def absent_submodules(self) -> Strings:
        """The empty folders that git may fetch: those of submodules, as their names say."""
        filled = {folder for path in self.tree.files for folder in parents(path)}
        empty = []
        for folder in self.tree.folders:
            above, _, name = folder.rpartition("/")
            is_usual = name in _USUAL_FOLDERS or above.endswith("include")
            if folder not in filled and not is_usual:
                empty.append(folder)
        return tuple(empty)

    @cached_property
    def counts(self) -> Counter[str]:
        """How many packages have a name, without those that are ignored and backups."""
        used = [
            package
            for package in self.found_packages
            if not package.ignored_by and not is_backup(package.folder)
        ]
        return Counter(package.name for package in used)
