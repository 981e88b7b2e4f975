"""What xacro and RViz find of a robot once its packages are built.

This is the files that it includes, and its meshes.

The file is read again from what builds install, so that the ordinary readers say what is not there.
"""

import posixpath
from collections.abc import Collection
from itertools import chain

from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.problems import Problem
from grader.base.records import Named
from grader.files.reading import URDF_LIMIT
from grader.ros.package.mesh_files import mesh_file
from grader.ros.package.package import Package
from grader.ros.python.budget import Budget
from grader.ros.urdf.model import Mesh, Robot
from grader.ros.urdf.reader import read_robot, read_urdf


class InstalledRobot(Named):
    """A robot as it is installed.

    `missing` are files of the workspace that it needs and a build does not install; `warning` is
    the first text that xacro writes to standard error.
    """

    missing: Strings = ()
    warning: Problem | None = None


class _InstalledFiles:
    """The files that builds of the packages install, as the workspace of xacro."""

    is_part = False
    called = "submission"  # which launch files are graded of

    def __init__(self, package: Package) -> None:
        self.owners = [
            package,
            *(other for other in package.packages.values() if other is not package),
        ]
        self.budget = (
            Budget()
        )  # its own: what is read again says nothing about how long reading the package takes
        self.files = {
            path: (owner, source)
            for owner in self.owners
            for path, source in owner.installed.items()
        }
        self.missing: dict[str, None] = {}

    @property
    def paths(self) -> Collection[str]:
        """The paths below the prefix."""
        return self.files

    @property
    def is_known(self) -> bool:
        """Whether it is known what builds install."""
        setups = [owner.installation for owner in self.owners]
        return all(setup is not None and not setup.unknown for setup in setups)

    def read(self, path: str) -> bytes:
        """Return the bytes of a file. Raises InputError."""
        if path not in self.files:
            self.note_missing(path)
            raise InputError(f"there is no file {path}")
        owner, source = self.files[path]
        return owner.tree.files[source].read(URDF_LIMIT)

    def note_missing(self, path: str) -> None:
        """Note a file that the workspace has, but does not install."""
        name = posixpath.basename(path)
        if any(
            posixpath.basename(inner) == name for owner in self.owners for inner in owner.tree.files
        ):
            self.missing[path] = None

    def package(self, name: str) -> str | None:
        """Return the share folder of a package."""
        if any(name in owner.names for owner in self.owners):
            return f"share/{name}"
        return None

    def installed(self, package: str, inside: str) -> str | None:
        """Return the path below the prefix of a file in a package."""
        path = f"share/{package}/{inside}"
        return path if path in self.files else None

    def ask(self, name: str) -> None:
        """Note nothing."""


def read_installed(
    package: Package, path: str, arguments: dict[str, str | None] | None
) -> InstalledRobot:
    """Return the robot in an installed file, given its path below the prefix.

    `arguments` are those of xacro; None for a file that is read without it.
    """
    files = _InstalledFiles(package)
    if not files.is_known:
        return InstalledRobot()
    try:
        data = files.read(path)
    except InputError:
        return InstalledRobot()
    if arguments is None:
        _note_meshes(read_urdf(data, path).robot, files, is_expanded=False)
        return InstalledRobot(tuple(files.missing))
    from grader.ros.xacro.expansion import expand  # late: many robots are no xacro
    from grader.ros.xacro.xacro_problems import WRITTEN_TO_STDERR

    expansion = expand(data, path, files, arguments)
    _note_meshes(read_robot(expansion.document).robot, files, is_expanded=True)
    warnings = (problem for problem in expansion.warnings if problem.kind in WRITTEN_TO_STDERR)
    return InstalledRobot(tuple(files.missing), next(warnings, None))


def _note_meshes(robot: Robot | None, files: _InstalledFiles, *, is_expanded: bool) -> None:
    """Note the meshes that a robot shows and that are not installed."""
    for visual in chain.from_iterable(link.visuals for link in robot.links) if robot else ():
        if isinstance(visual.geometry, Mesh):
            file = mesh_file(visual.geometry.filename, is_expanded=is_expanded)
            path = posixpath.normpath(f"share/{file.package}/{file.path}")
            if (
                files.package(file.package) is not None
                and not file.fault
                and path not in files.files
            ):
                files.note_missing(path)
