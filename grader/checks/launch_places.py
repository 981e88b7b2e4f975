"""The launch file that checks look at, where it looks for its files, and whether a build installs them there."""

import posixpath
from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal, NamedTuple

from grader.errors import InputError, MissingElement, NotDecided
from grader.files.reading import URDF_LIMIT
from grader.names import closest
from grader.package.launch.places import BY_UTF8, HOME, PREFIX, ROS, SHARE, WORKING_FOLDER, is_of_one_machine
from grader.package.package import Package

if TYPE_CHECKING:
    from grader.package.launch.model import Launch, NamedFile

WORDS = {"urdf": "URDF", "rviz": "RViz file", "include": "launch file", "launch": "launch file", "read": "file"}
ENDINGS = {
    "urdf": (".urdf", ".xacro"), "rviz": (".rviz",), "include": (".py", ".xml", ".launch", ".yaml", ".yml"),
    "read": ("",)
}  # fmt: skip


class FilePlace(NamedTuple):
    """Where a launch file looks for a file: found there, or why it is not. `missing`: a build does not install it.

    `mistake` is the text without what differs between students.
    """

    file: "NamedFile"
    state: Literal["found", "wrong", "unknown", "missing"]
    text: str = ""
    mistake: str = ""


def place_of(package: Package, file: "NamedFile") -> FilePlace:
    """Return whether a launch file finds a file that it names."""
    if file.path is None or file.reason:
        return FilePlace(file, "wrong" if file.sure else "unknown", file.reason)
    what, path = WORDS[file.purpose], posixpath.normpath(file.path)
    if path.startswith(f"{SHARE}/"):
        owner, _, rest = path.removeprefix(f"{SHARE}/").partition("/")
        other = package.find(owner)
        if other is None:
            return _in_unknown_package(package, owner, rest, file)
        return _in_package(other, f"share/{owner}/{rest}", file)
    fault = _fault_of_path(package, path)
    if fault:
        return FilePlace(file, "wrong", f"the launch file looks for the {what} at {fault}")
    return FilePlace(file, "unknown", f"the {what} {path.removeprefix(PREFIX)} is not part of the package")


def _fault_of_path(package: Package, path: str) -> str:
    """Return a path that is not below a share folder, with why no file is there; empty where that is not known."""
    if is_of_one_machine(path):
        return f"{path.replace(HOME, '~')}, which exists on one machine only"
    if path.startswith(WORKING_FOLDER) or not path.startswith("/"):
        shown = path.removeprefix(WORKING_FOLDER + "/")
        if shown.startswith("~"):
            return f"{shown}, but nothing replaces ~ by the home folder"
        return f"{shown}, relative to the folder that ros2 launch is started from"
    if not path.startswith((PREFIX, ROS)) and posixpath.basename(path) in map(posixpath.basename, package.tree.files):
        return f"{path}: joining a path that begins with / drops the folders before it"
    return ""


def _in_unknown_package(package: Package, owner: str, rest: str, file: "NamedFile") -> FilePlace:
    """Return what is known of a path in the share folder of a package that is not part of the submission."""
    what = WORDS[file.purpose]
    fault = "" if package.depends_on(owner) else _fault_of_owner(package, owner, rest, what)
    if fault:
        return FilePlace(file, "wrong", fault)
    if file.purpose == "include":
        return FilePlace(file, "found")
    return FilePlace(file, "unknown", f"the {what} is in {owner!r}, which is not part of the submission")


def _fault_of_owner(package: Package, owner: str, rest: str, what: str) -> str:
    """Return how the name of a package that is not part of the submission is wrong; empty where that is not known."""
    # A path may lack a slash after the package's name: get_package_share_directory(...) + 'my_robot.urdf'.
    more = owner.removeprefix(package.name)
    is_known = more in package.tree.folders if rest else more in map(posixpath.basename, package.tree.files)
    if owner.startswith(package.name) and is_known:
        path = posixpath.join("share", owner, rest).rstrip("/")
        return f"the launch file looks for the {what} at {path}: a slash is missing after {package.name!r}"
    if closest(owner, [package.name]):
        return f"the launch file looks in a package {owner!r}, but the graded package is named {package.name!r}"
    return ""


def _in_package(owner: Package, target: str, file: "NamedFile") -> FilePlace:
    """Return whether a build of a package installs a file at the path where it is looked for."""
    setup, what = owner.setup, WORDS[file.purpose]
    if owner.is_cmake or (setup is not None and setup.fault is not None and not setup.fault.sure):
        return FilePlace(file, "unknown", f"cannot determine statically whether a build installs the {what}")
    if setup is None or setup.fault is not None:
        return FilePlace(file, "missing", f"a build installs no {what}: there is no setup.py that Python can read")
    installed = setup.installed()
    if target in installed:
        return _undecodable(owner, installed[target], file) or FilePlace(file, "found", target)
    if setup.unknown:
        return FilePlace(file, "unknown", f"cannot determine statically whether a build installs {target}")
    return _not_there(owner, installed, target, file)


def _undecodable(owner: Package, path: str, file: "NamedFile") -> FilePlace | None:
    """Return where reading a file stops the launch file, because its text is not UTF-8; None where it does not."""
    try:
        if file.by in BY_UTF8:
            owner.tree.files[path].read(URDF_LIMIT).decode()
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        mistake = f"reading the {WORDS[file.purpose]} stops the launch file with a UnicodeDecodeError: it is not UTF-8"
        detail = f" (line {line} of {posixpath.basename(path)}); save it as UTF-8"
        return FilePlace(file, "wrong", mistake + detail, mistake)
    except InputError:
        pass  # other criteria report it
    return None


def _not_there(owner: Package, installed: Iterable[str], target: str, file: "NamedFile") -> FilePlace:
    """Return where else a build installs a file, or what the package has instead of it."""
    name, looks = posixpath.basename(target), f"the launch file looks for the {WORDS[file.purpose]} at {target}"
    others = [path for path in installed if posixpath.basename(path) == name]
    if others:
        return FilePlace(file, "wrong", f"{looks}, but a build installs it as {others[0]}")
    names = set(map(posixpath.basename, owner.tree.files))
    if name in names:
        return FilePlace(file, "missing", f"{looks}, but a build does not install {name}")
    own, is_include = posixpath.basename(file.location.path), file.purpose == "include"
    alike = sorted(it for it in names - {own} if it.lower().endswith(ENDINGS[file.purpose]))
    message = f"{looks}, but the package has no file {name!r}"
    if not alike and not is_include:
        return FilePlace(file, "missing", message)
    similar = closest(name, alike) or (alike[0] if len(alike) == 1 and not is_include else None)
    return FilePlace(file, "wrong", f"{message}; there is {similar!r}" if similar else message)


def path_of(package: Package, name: str) -> str:
    """Return the path of a launch file. Raises MissingElement."""
    path = package.launch_file(name)
    if path is None:
        raise package.missing("launch")
    return path


def launch_of(package: Package, name: str) -> "Launch":
    """Return a launch file, evaluated. Raises MissingElement, and NotDecided for one that is not read."""
    path = path_of(package, name)
    launch = package.launch(path)
    if launch.unread:
        raise NotDecided(launch.unread, "the launch file cannot be read")
    if launch.syntax is not None:
        raise MissingElement("launch file", path, message=launch.syntax.message, location=launch.syntax.location)
    return launch


def fault_that_stops(package: Package, name: str, launch: "Launch") -> MissingElement:
    """Return the fault of a launch file that starts nothing because of it."""
    path, first = path_of(package, name), launch.faults[0]
    return MissingElement("launch file", path, message=_faults(launch), location=first.location, problem=first.message)


def _faults(launch: "Launch") -> str:
    messages = list(dict.fromkeys(fault.message for fault in launch.faults))
    return f"{messages[0]} (and {len(messages) - 1} more)" if len(messages) > 1 else messages[0]
