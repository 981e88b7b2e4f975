"""The file that a <mesh> names: the end of its path, and whether a build of the submission puts it there."""

import posixpath
import re
from typing import NamedTuple

from grader.errors import NotDecided
from grader.names import closest
from grader.package.package import Package
from grader.submission.submission import Submission
from grader.text import quoted

_SCHEME = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+):(//)?(.*)", re.DOTALL)  # one letter is a disk of Windows
_ABSOLUTE = re.compile(r"[/~\\]|[A-Za-z]:")
_ONE_MACHINE = "exists on one machine only; use package://"
_BACKSLASH = "has a \\ in its path; separate folders by /"


class MeshFile(NamedTuple):
    """The file name of a <mesh>: the package that it names and the path in it, and why ROS 2 does not find such a name.

    `doubt` says why it cannot be determined whether it does. `written` is the name as the student wrote it.
    """

    written: str
    path: str
    package: str = ""
    fault: str = ""
    doubt: str = ""

    @property
    def steps(self) -> tuple[str, ...]:
        """The package, the folders and the name."""
        whole = posixpath.normpath(f"{self.package}/{self.path}".replace("\\", "/"))
        return tuple(step for step in whole.split("/") if step)

    def ends_in(self, other: "MeshFile", *, any_case: bool = False) -> bool:
        """Return whether the path ends in all the steps of another one."""
        steps, end = self.steps, other.steps
        if any_case:
            steps, end = (tuple(map(str.casefold, path)) for path in (steps, end))
        return steps[-len(end) :] == end != ()


def mesh_file(filename: str, *, is_expanded: bool = False) -> MeshFile:
    """Return what the file name of a <mesh> means; `is_expanded` says whether xacro has been expanded in it."""
    found = _SCHEME.fullmatch(filename)
    scheme, slashes, rest = found.groups() if found is not None else ("", "", filename)
    fault = _BACKSLASH if "\\" in filename else ""
    shared = _path_from_xacro(rest) if is_expanded and scheme in ("", "file") else None
    if shared is not None:
        written = f"{scheme}{'://' if scheme else ''}$(find {shared[0]})/{shared[1]}"
        return MeshFile(written, shared[1], shared[0], fault if scheme else "needs file:// before $(find ...)")
    if scheme == "package" and slashes:
        package, _, path = rest.partition("/")
        return MeshFile(filename, path, package, fault)
    doubt = ""
    if not scheme:
        is_absolute = _ABSOLUTE.match(filename) is not None
        fault = f"is at an absolute path, which {_ONE_MACHINE}" if is_absolute else fault
    elif scheme == "file":
        fault = f"is at a file:// path, which {_ONE_MACHINE}"
    elif scheme.lower() in ("package", "file") or not slashes:
        fault = f"begins with {scheme}:{slashes or ''}; use package://"
    else:
        fault, doubt = "", f"it is at a {scheme}:// path, which not every program finds"
    return MeshFile(filename, rest, "", fault, doubt)


def why_not_found(mesh: MeshFile, submission: Submission) -> str:
    """Return why ROS 2 does not find a package's file after a build; empty if it does, or no package was submitted.

    Raises NotDecided where that cannot be determined statically.
    """
    if not submission.packages:
        return ""
    if not mesh.package:
        if not mesh.doubt:
            raise NotDecided("RViz finds no relative path; other programs may", "a mesh is at a relative path")
        return ""
    package = submission.packages[0].find(mesh.package)
    path = posixpath.normpath(mesh.path)
    if package is None:
        return _without_package(mesh.package, path, submission)
    if path.startswith("../") or path in ("..", "."):
        return "is outside of its package"
    name = posixpath.basename(path)
    held = [file for file in package.tree.files if posixpath.basename(file) == name]
    if not held:
        if submission.tree.unopened:
            raise NotDecided(f"{name} may be in an archive that could not be opened", "an archive could not be opened")
        similar = closest(name, map(posixpath.basename, package.tree.files))
        return f"is not in the package {package.name!r}{f'; there is {quoted(similar)}' if similar else ''}"
    return _why_not_installed(package, f"share/{mesh.package}/{path}", held)


def _path_from_xacro(path: str) -> tuple[str, str] | None:
    """Return the package and the path in it where $(find ...) has given a path."""
    from grader.xacro.texts import INSTALLED  # late: most URDFs are no xacro

    found = re.fullmatch(rf"/*{INSTALLED}/([^/]+)/share/\1/+(.*)", path, re.DOTALL)
    return (found[1], found[2]) if found is not None else None


def _without_package(name: str, path: str, submission: Submission) -> str:
    """Return that no submitted package has a name; raise NotDecided if one may be in an archive that is closed."""
    if submission.tree.unopened:
        reason = "an archive could not be opened"
        raise NotDecided(f"the package {quoted(name)} may be in an archive that could not be opened", reason)
    holding = [package.name for package in submission.packages if path in package.tree.files]
    meant = closest(name, [package.name for package in submission.packages]) or next(iter(holding), None)
    hint = f"; the submission has {quoted(meant)}" if meant is not None else ", which is not part of the submission"
    return f"names the package {quoted(name)}{hint}"


def _why_not_installed(package: Package, target: str, held: list[str]) -> str:
    """Return why a build does not install a file of a package at a path; empty if it does."""
    setup = package.setup
    if package.is_cmake:
        from grader.package.cmake import installs  # late: most packages have a setup.py

        if installs(package.tree, package.name, target.removeprefix(f"share/{package.name}/")):
            return ""
        doubt = "cannot determine statically what CMakeLists.txt installs"
        raise NotDecided(doubt, doubt)
    if setup is None:
        return "is not installed: its package has no setup.py"
    if setup.fault is not None:
        if setup.fault.sure:
            return "is not installed: Python cannot read setup.py"
        installed, doubt = {}, f"setup.py cannot be read ({setup.fault.message})"
    else:
        installed = setup.installed()
        doubt = "cannot determine statically what setup.py installs" if setup.unknown else ""
    if target in installed:
        return ""
    if doubt:
        raise NotDecided(doubt, doubt)
    elsewhere = next((path for path, source in installed.items() if source in held), None)
    if elsewhere is not None:
        return f"is looked for at {target}, but a build installs it as {elsewhere}"
    return f"is not installed: add {held[0]} to data_files in setup.py, for {posixpath.dirname(target)}"
