"""What a build of a package installs of its files, and why it does not.

The checks of packages and of launch files use it.
"""

from collections.abc import Sequence
from posixpath import basename, dirname
from typing import Literal

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import Strings
from grader.base.names import MAX_GUESSES, closest
from grader.base.text import first_lines
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.ros.package.package import MANIFEST, Package

FileKind = Literal["urdf", "launch", "rviz"]
# The causes of failures of what a build should install.
INSTALLING = {
    "fails": "a build fails",
    "pattern": "a pattern matches no file",
    "elsewhere": "a build installs the file elsewhere",
}
_ENDINGS: dict[FileKind, Strings] = {"urdf": (".urdf", ".xacro"), "rviz": (".rviz",)}


def build_error(package: Package, *, where_there: bool = False) -> Outcome | None:
    """Return why a build of the package fails; None if it succeeds. Raises NotDecided."""
    setup = package.needed_installation()
    if package.ignored_by:
        message = f"colcon does not build the package, because there is a file {package.ignored_by}"
        return failed(message, problem=message)
    errors = [(fault.message, "", fault.at) for fault in setup.faults]
    there = package.tree.files.keys() | package.tree.folders
    for stop in setup.stops:
        if stop.path == MANIFEST and not package.manifest:
            continue
        if not where_there or not stop.path or stop.path.rstrip("/") in there:
            errors.append((stop.message, stop.hint, stop.at))
    if errors:
        messages = list(dict.fromkeys(message for message, _, _ in errors))
        _, hint, at = errors[0]
        message = "; ".join(first_lines(messages, 3))
        problem = messages[0] + hint
        cause = "files"
        if setup.faults:
            cause = "name" if setup.faults[0].name else ""
        return failed(
            message,
            setup.location(at),
            detail=hint if len(messages) == 1 else "",
            problem=problem,
            cause=cause,
        )
    if not setup.is_called:
        message = "setup.py does not call setup()"
        return failed(message, setup.location(setup.called_at), problem=message)
    if setup.doubt:
        reason = f"{setup.doubt.reason} (line {setup.doubt.at.line} of {setup.file})"
        cause = f"cannot determine statically whether {setup.file} builds"
        raise NotDecided(f"{cause}: {reason}", cause)
    return None


def files_of_kind(package: Package, kind: FileKind, name: str) -> Sequence[str]:
    """Return the file of a package that has this name.

    Without one, return all of the kind that are no part of another one.
    """
    if kind == "launch":
        chosen = package.launch_file(name)
        return [chosen] if chosen is not None else []
    endings = _ENDINGS[kind]
    paths = [path for path in package.tree.files if path.lower().endswith(endings)]
    named = [path for path in paths if basename(path) == name]
    if named or kind != "urdf":
        return named or paths
    from grader.ros.package.robots import (  # late: the URDF usually has the lab's name
        find_robots,
        list_parts,
    )

    parts = list_parts(find_robots(package.tree))
    return [path for path in paths if path not in parts] or paths


def require_installed(
    package: Package, files: Sequence[str], kind: FileKind | None, *, despite_errors: bool
) -> Outcome:
    """Return whether a build installs one of these files below share/<package>.

    Raises MissingElement if it does not, NotDecided where that is not known.
    """
    setup = package.needed_installation()
    error = build_error(package)
    if error and not despite_errors:
        return error._replace(message=f"a build fails: {error.message}", cause="fails")
    if error and _stops_at(package, files, kind):
        return passed(f"{setup.file} has an entry for {files[0]}")
    copies = [copy for copy in setup.copies if copy.source in files]
    inside = [copy for copy in copies if copy.target.startswith(package.share)]
    name = basename(files[0])
    targets = sorted({copy.target for copy in inside if basename(copy.target) == name})
    if kind == "launch" and len(targets) > 1:
        shown = " and as ".join(targets)
        message = f"a build installs {files[0]} as {shown}; ros2 launch needs exactly one"
        mistake = "a build installs the launch file twice"
        return failed(message, setup.location(inside[-1].at), mistake=mistake)
    if inside and setup.misspelt:
        raise package.without_data_files(setup.misspelt.message)
    if inside:
        return passed(f"a build installs {inside[0].source} as {inside[0].target}")
    if despite_errors and setup.is_unknown_after_error:
        return passed(f"what {setup.file} installs is not known because of an error in it")
    if copies and not setup.unknown:
        message = f"a build installs {copies[0].source} as {copies[0].target}"
        message += f"; ROS 2 looks for the package's files below {package.share}"
        mistake = f"a build installs the file outside of {package.share}"
        return failed(message, setup.location(copies[0].at), mistake=mistake, cause="elsewhere")
    raise _why_no_copy(package, files, kind)


def _why_no_copy(
    package: Package, files: Sequence[str], kind: FileKind | None
) -> MissingElement | NotDecided:
    """Return why no copy of these files is known: NotDecided where not all copies are known."""
    setup = package.needed_installation()
    if not setup.unknown:
        return _why_not_installed(package, files, kind)
    reason = f"{setup.unknown[0].reason} (line {setup.unknown[0].at.line} of {setup.file})"
    message = f"cannot determine statically whether a build installs {files[0]}: {reason}"
    return NotDecided(message, f"cannot determine statically what {setup.file} installs")


def _stops_at(package: Package, files: Sequence[str], kind: FileKind | None) -> bool:
    """Return whether a build stops at the entry for these files, so that it is there."""
    setup = package.needed_installation()
    folders = {dirname(path) for path in files}
    paths = [stop.path for stop in setup.stops if stop.path]
    if setup.is_cmake and any(
        closest(path, folders) for path in paths[:MAX_GUESSES]
    ):  # install(DIRECTORY lunch ...)
        return True
    kinds = _kinds_by_folder(package)
    for path in paths:
        folder = dirname(path)
        is_listed = folder in folders or path.rstrip("/") in folders
        if is_listed or (_kind_by_ending(path) or kinds.get(folder)) == kind:
            return True
    return False


def _why_not_installed(
    package: Package, files: Sequence[str], kind: FileKind | None
) -> MissingElement:
    """Return why a build does not install files: no entry, or a pattern without a match."""
    setup = package.needed_installation()
    what = f"installed {kind or files[0]}"
    message = f"a build does not install {files[0]}"
    empty = setup.empty_for(files, kind)
    if not empty:
        message += f": {'no' if setup.is_cmake else 'no entry of'} {setup.entries} names it"
        return MissingElement(
            what,
            package.folder,
            message=message,
            location=setup.location(setup.files_at),
            cause="",
        )
    problem = f"the pattern {empty.pattern!r} in {setup.file} matches no file"
    # Late: a URDF on its own needs none of what reads a package.
    from grader.ros.package.found_problems import why_no_match

    detail = why_no_match(package, empty.pattern)
    at = setup.location(empty.at)
    message += f": {problem}"
    return MissingElement(
        what,
        package.folder,
        message=message,
        detail=detail,
        location=at,
        problem=problem + detail,
        cause="pattern",
    )


def _kind_by_ending(path: str) -> FileKind | None:
    """Return the kind of file that an entry is about, by its ending."""
    if ".launch." in path or path.endswith("_launch.py"):
        return "launch"
    for kind, endings in _ENDINGS.items():
        if path.lower().endswith(endings):
            return kind
    return None


def _kinds_by_folder(package: Package) -> dict[str, FileKind]:
    """Return the kind of the files of each folder that has files of one kind."""
    kinds: dict[str, set[FileKind | None]] = {}
    endings = _ENDINGS["urdf"] + _ENDINGS["rviz"]
    for path in package.tree.files:
        folder = dirname(path)
        if folder and (path.endswith(endings) or ".launch." in path):
            kinds.setdefault(folder, set()).add(_kind_by_ending(path))
    of_one_kind = [
        (folder, kinds_in_folder.pop())
        for folder, kinds_in_folder in kinds.items()
        if len(kinds_in_folder) == 1
    ]
    return {folder: kind for folder, kind in of_one_kind if kind is not None}
