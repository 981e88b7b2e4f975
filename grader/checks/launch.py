"""Checks of a launch file: its name, the nodes that it starts, and whether a build installs the files that it names."""

import posixpath
from typing import TYPE_CHECKING, Literal

from grader.checks.about import About
from grader.checks.outcome import Outcome, Status, failed, judged, passed, pending
from grader.errors import MissingElement, NotDecided
from grader.names import closest
from grader.package.launch.places import (
    HOME,
    PREFIX,
    SHARE,
    WORKING_FOLDER,
    is_launch_named,
    is_of_one_machine,
    one_machine_only,
)
from grader.package.package import Package
from grader.source import Location
from grader.text import enumerated

if TYPE_CHECKING:
    from grader.package.launch.model import Launch, Reference, StartedNode

# What the edits for hints may change.
ABOUT = {
    "launch_found": About(("launch",), measure="grader.checks.measures.package:launch_files"),
    "launch_starts": About(("launch",), measure="grader.checks.measures.package:started_nodes"),
    "launch_finds_files": About(("launch",), measure="grader.checks.measures.package:opened_files"),
}

_WORDS = {"urdf": "URDF", "rviz": "RViz file", "include": "launch file", "launch": "launch file"}
_ENDINGS = {"urdf": (".urdf", ".xacro"), "rviz": (".rviz",), "include": (".py", ".xml", ".yaml", ".yml")}
_UNKNOWN_FILES = "cannot determine statically which files it names"
_ON_ONE_MACHINE = "the launch file looks for files at paths that exist on one machine only"
_NOT_INSTALLED = "the launch file looks for files where a build does not install them"

Verdict = tuple[Status | Literal["missing"], str]


def launch_found(package: Package, *, name: str) -> Outcome:
    """The package has a launch file of this name, written in Python, XML or YAML.

    Args:
        name: The file's name, such as view.launch.py.
    """
    path = _path(package, name)
    if is_launch_named(path, name):
        return passed(f"the launch file is {path}")
    detail = f"; the package has {path}"
    if not path.endswith(_ENDINGS["include"]):
        detail += ", which ros2 launch cannot start without an ending such as .launch.py"
    return failed(f"there is no launch file {name!r}", detail=detail + package.built("launch", name))


def launch_starts(package: Package, *, name: str, nodes: list[str]) -> Outcome:
    """The launch file starts these nodes, with the defaults of its arguments.

    Launch files that it includes count, if they are part of the submission or of urdf_launch.

    Args:
        name: The file's name, such as view.launch.py.
        nodes: The nodes, each as "package/executable", or as one name if both are the same; "a or b" leaves a choice.
    """
    launch = _launch(package, name)
    if launch.faults and not launch.nodes:
        raise _stopped(package, name, launch)
    if launch.faults:
        return failed(_faults(launch), launch.faults[0].location, problem=launch.faults[0].message)
    started = {_name_of(node) for node in launch.nodes if node.when}
    uncertain = {_name_of(node) for node in launch.nodes if node.when is None}
    missing = [choice for choice in (node.split(" or ") for node in nodes) if started.isdisjoint(choice)]
    listed = ", ".join(" or ".join(choice) for choice in missing)
    if missing and (launch.unknown or not any(uncertain.isdisjoint(choice) for choice in missing)):
        reason = f": {launch.unknown[0].message}" if launch.unknown else ""
        message = f"cannot determine statically whether {listed} is started{reason}; needs manual grading"
        return pending(message, "cannot determine statically which nodes the launch file starts")
    running = tuple(sorted(started))
    message = f"starts {', '.join(running) or 'nothing'}"
    if not missing:
        return judged(True, f"the launch file {message}", running, tuple(nodes))
    reason, at = _why_missing(launch, {node for choice in missing for node in choice})
    what, detail = f"the launch file does not start {listed}", f"; it {message}{reason}"
    return judged(False, what, running, tuple(nodes), at=at, detail=detail)


def _why_missing(launch: "Launch", missing: set[str]) -> "tuple[str, Location | None]":
    """Return why a launch file does not start nodes that should be started, in a sentence, and where to look."""
    for node in launch.forgotten:
        if _name_of(node) in missing:
            reason = f". It creates the node {node.executable}, but the LaunchDescription does not contain it"
            return reason, node.location
    for node in launch.nodes:
        if node.when is False and _name_of(node) in missing:
            return f". A condition keeps {node.executable} from starting, unless an argument is given", node.location
    similar = (node for node in launch.nodes if node.when and {node.package, node.executable} & missing)
    return "", next((node.location for node in similar), None)


def launch_finds_files(package: Package, *, name: str, built: bool = True) -> Outcome:
    """The launch file looks for the URDF and RViz files where a build of the package installs them.

    Args:
        name: The file's name, such as view.launch.py.
        built: Whether a build must install the files; if not, files of the package count as found.
    """
    launch = _launch(package, name)
    verdicts = [(_verdict(package, file), file) for file in launch.named("urdf", "rviz", "include")]
    wrong = [(text, file) for (status, text), file in verdicts if status == "failed"]
    if wrong:
        message = "; ".join(dict.fromkeys(text for text, _ in wrong))
        is_local = any(file.path is not None and is_of_one_machine(file.path) for _, file in wrong)
        if is_local:
            message += f"; use get_package_share_directory({package.name!r}), which returns the installed folder"
        first, mistake = wrong[0][1], _ON_ONE_MACHINE if is_local else _NOT_INSTALLED
        problem = one_machine_only(first.path) if first.path else ""
        return failed(message, first.location, problem=problem, mistake=mistake)
    present = set(map(posixpath.basename, package.tree.files))
    for (status, text), file in verdicts:
        if status == "missing" and (built or posixpath.basename(file.path or "") not in present):
            raise _missing(package, file, text)
    if all(file.purpose == "include" for _, file in verdicts):
        if launch.faults:
            raise _stopped(package, name, launch)
        if launch.unknown:
            reason = launch.unknown[0].message
            return pending(f"{_UNKNOWN_FILES}: {reason}; needs manual grading", _UNKNOWN_FILES)
        raise MissingElement("named file", "", message="the launch file names neither a URDF nor an RViz file")
    for (status, text), _ in verdicts:
        if status == "pending":
            return pending(f"{text}; needs manual grading", _UNKNOWN_FILES)
    if any(status == "missing" for (status, _), _ in verdicts):
        return passed("the launch file looks for files of the package")
    found = dict.fromkeys(text for (_, text), _ in verdicts if text)
    return passed(f"a build installs {enumerated(found)}, where the launch file looks for them")


def _path(package: Package, name: str) -> str:
    path = package.launch_file(name)
    if path is None:
        raise package.missing("launch")
    return path


def _launch(package: Package, name: str) -> "Launch":
    path = _path(package, name)
    launch = package.launch(path)
    if launch.unread:
        raise NotDecided(launch.unread, "the launch file cannot be read")
    if launch.syntax is not None:
        raise MissingElement("launch file", path, message=launch.syntax.message, location=launch.syntax.location)
    return launch


def _stopped(package: Package, name: str, launch: "Launch") -> MissingElement:
    """Return the fault of a launch file that starts nothing because of it."""
    path, first = _path(package, name), launch.faults[0]
    return MissingElement("launch file", path, message=_faults(launch), location=first.location, problem=first.message)


def _faults(launch: "Launch") -> str:
    messages = list(dict.fromkeys(fault.message for fault in launch.faults))
    return f"{messages[0]} (and {len(messages) - 1} more)" if len(messages) > 1 else messages[0]


def _name_of(node: "StartedNode") -> str:
    return node.executable if node.package == node.executable else f"{node.package}/{node.executable}"


def _missing(package: Package, named: "Reference", text: str) -> MissingElement:
    """Return what the package is missing for a named file, by the kinds and names that the checks of packages use."""
    setup, kind, name = package.setup, f"installed {named.purpose}", package.folder
    if setup is None or setup.fault is not None:
        kind = "setup.py"
    elif not setup.is_called:
        kind = "call of setup"
    elif not any(path.lower().endswith(_ENDINGS[named.purpose]) for path in package.tree.files):
        kind, name = f"{_WORDS[named.purpose]} in the package", ""
    return MissingElement(kind, name, message=text, location=named.location)


def _verdict(package: Package, named: "Reference") -> Verdict:
    """Return whether a launch file finds a file that it names, and why not; "missing": a build does not install it."""
    if named.path is None or named.reason:
        return ("failed" if named.sure else "pending", named.reason)
    what, path = _WORDS[named.purpose], posixpath.normpath(named.path)
    looks = f"the launch file looks for the {what} at"
    if path.startswith(f"{SHARE}/"):
        owner, _, rest = path.removeprefix(f"{SHARE}/").partition("/")
        return _below_share(package, owner, rest, named)
    if is_of_one_machine(path):
        return "failed", f"{looks} {path.replace(HOME, '~')}, which exists on one machine only"
    if path.startswith(WORKING_FOLDER) or not path.startswith("/"):
        shown = path.removeprefix(WORKING_FOLDER + "/")
        if shown.startswith("~"):
            return "failed", f"{looks} {shown}, but nothing replaces ~ by the home folder"
        return "failed", f"{looks} {shown}, relative to the folder that ros2 launch is started from"
    if not path.startswith(PREFIX) and posixpath.basename(path) in map(posixpath.basename, package.tree.files):
        return "failed", f"{looks} {path}: joining a path that begins with / drops the folders before it"
    return "pending", f"the {what} {path.removeprefix(PREFIX)} is not part of the package"


def _below_share(package: Package, owner: str, rest: str, named: "Reference") -> Verdict:
    what = _WORDS[named.purpose]
    other = package.find(owner)
    if other is None:
        # A path may lack a slash after the package's name: get_package_share_directory(...) + 'my_robot.urdf'.
        more = owner.removeprefix(package.name)
        is_known = more in package.tree.folders if rest else more in map(posixpath.basename, package.tree.files)
        if owner.startswith(package.name) and is_known:
            path = posixpath.join("share", owner, rest).rstrip("/")
            return (
                "failed",
                f"the launch file looks for the {what} at {path}: a slash is missing after {package.name!r}",
            )
        if closest(owner, [package.name]):
            return (
                "failed",
                f"the launch file looks in a package {owner!r}, but the graded package is named {package.name!r}",
            )
        if named.purpose == "include":
            return "passed", ""
        return "pending", f"the {what} is in {owner!r}, which is not part of the submission"
    setup = other.setup
    if other.is_cmake or (setup is not None and setup.fault is not None and not setup.fault.sure):
        return "pending", f"cannot determine statically whether a build installs the {what}"
    if setup is None or setup.fault is not None:
        return "missing", f"a build installs no {what}: there is no setup.py that Python can read"
    installed = setup.installed()
    target = f"share/{owner}/{rest}"
    if target in installed:
        return "passed", target
    if setup.unknown:
        return "pending", f"cannot determine statically whether a build installs {target}"
    name = posixpath.basename(rest)
    put = next((path for path in installed if posixpath.basename(path) == name), None)
    if put is not None:
        return "failed", f"the launch file looks for the {what} at {target}, but a build installs it as {put}"
    if any(posixpath.basename(path) == name for path in other.tree.files):
        return "missing", f"the launch file looks for the {what} at {target}, but a build does not install {name}"
    endings, own = _ENDINGS[named.purpose], posixpath.basename(named.location.path)
    alike = sorted({posixpath.basename(path) for path in other.tree.files if path.lower().endswith(endings)} - {own})
    message = f"the launch file looks for the {what} at {target}, but the package has no file {name!r}"
    if not alike and named.purpose != "include":
        return "missing", message
    similar = closest(name, alike) or (alike[0] if len(alike) == 1 and named.purpose != "include" else None)
    return "failed", f"{message}; there is {similar!r}" if similar else message
