"""Opened files: their packages, and their robot."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from grader.base.source import Source
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree, make_tree
from grader.ros.package.package import MANIFEST, Package
from grader.ros.package.robot_file import Absent, OtherCandidate, Read, Urdf
from grader.ros.urdf.urdf_problems import NO_LINKS, ROBOT_WITHOUT_NAME

if TYPE_CHECKING:
    from grader.ros.workspace.workspace import Workspace

_NO_FILES = make_tree("", (), ())


@dataclass(frozen=True, eq=False, repr=False)
class OpenedWorkspace:
    """The packages and the robot of opened files: a URDF on its own, a folder or an archive."""

    id: str  # the name of the file or folder; of a submission, the student
    urdf: Urdf
    other_candidates: tuple[OtherCandidate, ...] = ()  # other robots and packages
    packages: tuple[Package, ...] = ()  # the one that matches best first
    whole_tree: Tree = _NO_FILES  # every file, also outside of packages
    notes: tuple[str, ...] = ()  # on how it was read
    is_single: bool = True  # whether it is a URDF on its own, not a folder or archive

    @cached_property
    def workspace(self) -> "Workspace":
        """Its packages and its robot, whose names are compared."""
        from grader.ros.workspace.workspace import Workspace  # late: few rubrics ask for names

        has_other_robots = any(
            not it.is_part for it in self.unused_candidates if not it.path.endswith(MANIFEST)
        )
        urdfs = (self.urdf,) if isinstance(self.urdf, Read) else ()
        return Workspace(self.packages, urdfs, self.whole_tree, has_other_robots)

    @property
    def path(self) -> str | None:
        """The path of the URDF, relative to the opened folder; None without one."""
        if isinstance(self.urdf, Absent):
            return None
        return self.urdf.path or None

    @property
    def unused_candidates(self) -> tuple[OtherCandidate, ...]:
        """The other candidates that the URDF is not expanded from."""
        return tuple(it for it in self.other_candidates if it.path not in self.included)

    @property
    def included(self) -> Collection[str]:
        """The files that the URDF is expanded from, itself among them."""
        source = self.urdf.reading.source if isinstance(self.urdf, Read) else None
        return getattr(source, "documents", ())

    def without_part(self) -> "OpenedWorkspace":
        """Return packages as such without a robot, where the best candidate is xacro without links
        that nothing loads.
        """
        urdf = self.urdf
        if self.is_single or not self.packages:
            return self
        if not isinstance(urdf, Read) or not urdf.is_expanded:
            return self
        errors = {problem.kind for problem in urdf.problems if problem.severity == "error"}
        name = urdf.path.rpartition("/")[2]
        is_part = NO_LINKS in errors and errors <= {NO_LINKS, ROBOT_WITHOUT_NAME}
        is_loaded = any(package.robot_references(name) for package in self.packages)
        if is_part and not is_loaded:
            return replace(self, urdf=Absent())
        return self

    def source(self, path: str) -> Source | None:
        """Return the text of one of its files, for quoting; None if it cannot be read."""
        if isinstance(self.urdf, Read) and path == self.urdf.path:
            return self.urdf.source
        data = self.whole_tree.read(path, URDF_LIMIT)
        if data is not None:
            return Source(path, data.decode("utf-8", "replace"))
        return None
