"""Checks of a package and of what its setup.py would install. Nothing is built and nothing is run."""

import posixpath
from collections.abc import Sequence
from fnmatch import fnmatch
from typing import TYPE_CHECKING, Literal

from grader.checks.outcome import Outcome, judged_as, listing, passed
from grader.errors import MissingElement, NotDecided
from grader.names import closest
from grader.package.package import MANIFEST, Package
from grader.submission.submission import Submission

if TYPE_CHECKING:
    from grader.package.data_files import InstalledFile
    from grader.package.file_functions import EmptyGlob
    from grader.package.manifest import Manifest
    from grader.package.setup_py import Setup

Kind = Literal["urdf", "launch", "rviz"]

_WORDS = {"urdf": "URDF", "launch": "launch file", "rviz": "RViz file"}
_ENDINGS = {"urdf": (".urdf", ".xacro"), "rviz": (".rviz",)}


def package_found(submission: Submission, *, name: str) -> Outcome:
    """A ROS 2 package of this name was handed in."""
    package = submission.needed_package()
    manifest = _readable_manifest(package)
    if manifest.name is None:
        problem = manifest.problems[0]
        return judged_as("failed", problem.message, at=problem.location)
    message = f"the package is named {manifest.name!r}"
    if manifest.name == name:
        return Outcome("passed", message, manifest.name, name)
    return Outcome("failed", f"{message}, expected {name!r}", manifest.name, name, location=manifest.name_location)


def package_type(package: Package, *, build_type: str) -> Outcome:
    """The package is of a build type, such as ament_python."""
    manifest = _readable_manifest(package)
    actual = manifest.build_type
    if actual == build_type:
        return Outcome("passed", f"the build type is {actual!r}", actual, build_type)
    message = f"the build type is {actual!r}"
    if actual == "catkin":
        message += " of ROS 1, for which a package.xml without build_type stands, too"
    elif not actual:
        message = "<build_type> of package.xml is empty"
    message += f"; expected {build_type!r}"
    return Outcome("failed", message, actual, build_type, location=manifest.type_location)


def build_installs(package: Package, *, kind: Kind, name: str) -> Outcome:
    """A build of the package installs its URDF, launch file or RViz file, below share/<package>.

    `kind` says which; `name` is the file that is meant if there are several. What setup.py lists is told by following it; what
    cannot be told is left to a person.
    """
    files = files_of(package, kind, name)
    if not files:
        raise MissingElement(f"{_WORDS[kind]} in the package", "", message=package.missing_message(kind))
    return _installed(package, files, kind)


def installs_files(package: Package, *, files: list[str]) -> Outcome:
    """A build of the package installs at least one file that matches these patterns, below share/<package>."""
    found = [path for path in package.tree.files if any(fnmatch(path, pattern) for pattern in files)]
    if not found:
        raise MissingElement("file", files[0], message=f"the package holds no file that matches {listing(files)}")
    return _installed(package, found, None)


def setup_imports(package: Package) -> Outcome:
    """Every name that setup.py uses is defined, and what it imports is there."""
    setup = readable_setup(package)
    if isinstance(setup, Outcome):
        return setup
    if not setup.faults:
        return passed("every name that setup.py uses is defined")
    messages = list(dict.fromkeys(fault.message for fault in setup.faults))
    more = f" (and {len(messages) - 3} more)" if len(messages) > 3 else ""
    return judged_as("failed", f"{'; '.join(messages[:3])}{more}", at=setup.location(setup.faults[0].at))


def files_of(package: Package, kind: Kind, name: str) -> Sequence[str]:
    """The files of a package that are meant: that of this name, else all of the kind."""
    if kind == "launch":
        chosen = package.launch_file(name)
        return [chosen] if chosen is not None else []
    endings = _ENDINGS[kind]
    every = [path for path in package.tree.files if path.lower().endswith(endings)]
    exact = [path for path in every if posixpath.basename(path) == name]
    return exact or every


def readable_setup(package: Package) -> "Setup | Outcome":
    """The package's setup.py, or the outcome where a person has to look.

    Raises MissingElement where there is none, or where Python cannot read it.
    """
    setup = package.setup
    if package.is_cmake:
        return Outcome("pending", "what CMakeLists.txt installs is not followed: a person has to look")
    if setup is None:
        message = "the package has no setup.py, so a build of an ament_python package installs nothing"
        raise MissingElement("setup.py", package.folder, message=message)
    if setup.fault is not None and setup.fault.sure:
        message = f"Python cannot read setup.py: {setup.fault.message}"
        raise MissingElement("setup.py", package.folder, message=message, location=setup.fault.location)
    if setup.fault is not None:
        return Outcome("pending", f"setup.py could not be read ({setup.fault.message}): a person has to look")
    return setup


def _readable_manifest(package: Package) -> "Manifest":
    manifest = package.manifest
    if manifest is not None and manifest.unread:
        raise NotDecided(manifest.unread)
    if manifest is None or not _is_readable(manifest):
        raise _no_manifest(package)
    return manifest


def _is_readable(manifest: "Manifest") -> bool:
    from grader.package.catalogue import BAD_MANIFEST

    return all(problem.kind is not BAD_MANIFEST for problem in manifest.problems)


def _no_manifest(package: Package) -> MissingElement:
    where = f"the folder {package.folder!r}" if package.folder else "what was handed in"
    problem = package.manifest.problems[0] if package.manifest is not None else None
    message = (
        problem.message
        if problem is not None
        else f"{where} has a setup.py, but no package.xml: to ROS 2 it is no package"
    )
    return MissingElement(MANIFEST, package.folder, message=message, location=problem.location if problem else None)


def _installed(package: Package, files: Sequence[str], kind: Kind | None) -> Outcome:
    setup = readable_setup(package)
    if isinstance(setup, Outcome):
        return setup
    for stop in setup.stops:
        if stop.path == MANIFEST and package.manifest is None:
            continue  # that it is missing is told, and counted, as what it is
        owner = _owner(stop.path, package) or "urdf"  # one mistake costs one criterion: of what is neither, the first
        if owner == kind or posixpath.dirname(stop.path) in {posixpath.dirname(path) for path in files}:
            return judged_as("failed", f"the build stops here: {stop.message}", at=setup.location(stop.at))
    copies = [copy for copy in setup.copies if copy.source in files]
    shares = tuple(f"share/{name}/" for name in package.names)
    inside = [copy for copy in copies if copy.target.startswith(shares)]
    twice = sorted({copy.target for copy in inside if posixpath.basename(copy.target) == posixpath.basename(files[0])})
    if kind == "launch" and len(twice) > 1:
        message = f"a build installs {files[0]} as {' and as '.join(twice)}: ros2 launch finds both and starts neither"
        return judged_as("failed", message, at=setup.location(inside[-1].at))
    if inside:
        return passed(f"a build installs {inside[0].source} as {inside[0].target}")
    if setup.unknown:
        unknown = setup.unknown[0]
        line = f" (line {unknown.at.line} of setup.py)"
        return Outcome("pending", f"whether {files[0]} is installed is told only by a build: {unknown.reason}{line}")
    if copies:
        return _elsewhere(copies[0], shares[0], setup)
    raise _not_installed(package, setup, files, kind)


def _elsewhere(copy: "InstalledFile", share: str, setup: "Setup") -> Outcome:
    message = f"a build installs {copy.source} as {copy.target}, but ROS 2 looks for a package's files below {share}"
    return judged_as("failed", message, at=setup.location(copy.at))


def _not_installed(package: Package, setup: "Setup", files: Sequence[str], kind: Kind | None) -> MissingElement:
    message = f"a build does not install {files[0]}"
    empty = _meant(setup.empty, files, kind)
    at = None
    if not setup.is_called:
        message = "a build installs nothing: setup.py does not call setup()"
        return MissingElement("call of setup", package.folder, message=message)
    if empty is not None:
        message += f": the pattern {empty.pattern!r} in setup.py matches no file{package.pattern_hint(empty.pattern)}"
        at = setup.location(empty.at)
    else:
        message += ": no entry of data_files in setup.py names it"
    return MissingElement(f"installed {kind or files[0]}", package.folder, message=message, location=at)


def _meant(empty: "Sequence[EmptyGlob]", files: Sequence[str], kind: Kind | None) -> "EmptyGlob | None":
    """The pattern without a match that was meant to find one of these files: by its folder, its ending or its kind."""
    folders = {posixpath.dirname(path) for path in files}
    endings = tuple({posixpath.splitext(path)[1] for path in files} - {""})
    for glob in empty:
        folder = posixpath.dirname(glob.pattern)
        if folder in folders or (folder and closest(folder, folders)) or (endings and glob.pattern.endswith(endings)):
            return glob
    return next((glob for glob in empty if kind is not None and kind in glob.pattern.lower()), None)


def _owner(path: str, package: Package) -> Kind | None:
    """The kind of file that an entry is about: by its ending, or by what else stands in its folder."""
    if ".launch." in path or path.endswith("_launch.py"):
        return "launch"
    for kind, endings in _ENDINGS.items():
        if path.lower().endswith(endings):
            return "rviz" if kind == "rviz" else "urdf"
    folder = posixpath.dirname(path)
    beside = [each for each in package.tree.files if posixpath.dirname(each) == folder] if folder else []
    kinds = {
        _owner(each, package) for each in beside if each.endswith((*_ENDINGS["urdf"], ".rviz")) or ".launch." in each
    }
    return next(iter(kinds)) if len(kinds) == 1 else None
