"""Checks of a launch file: its name, the nodes that it starts, and whether a build installs the files that it names."""

import posixpath
from collections.abc import Sequence
from typing import TYPE_CHECKING

from grader.checks.check import About
from grader.checks.launch_places import ENDINGS, WORDS, FilePlace, fault_that_stops, launch_of, path_of, place_of
from grader.checks.outcome import Outcome, failed, judged, passed
from grader.errors import MissingElement, NotDecided
from grader.package.launch.places import is_launch_named, is_of_one_machine, one_machine_only
from grader.package.package import Package
from grader.source import Location
from grader.text import enumerated

if TYPE_CHECKING:
    from grader.package.launch.model import Launch, NamedFile, Purpose

# What the edits for hints may change.
ABOUT = {
    "launch_found": About(("launch",)),
    "launch_starts": About(("launch",)),
    "launch_finds_files": About(("launch",)),
}

_UNKNOWN_FILES = "cannot determine statically which files it names"
_ON_ONE_MACHINE = "the launch file looks for files at paths that exist on one machine only"
_NOT_INSTALLED = "the launch file looks for files where a build does not install them"


def launch_found(package: Package, *, name: str) -> Outcome:
    """The package has a launch file of this name, written in Python, XML or YAML.

    Args:
        name: The file's name, such as view.launch.py.
    """
    path = path_of(package, name)
    if is_launch_named(path, name):
        return passed(f"the launch file is {path}")
    detail = f"; the package has {path}{package.built('launch', name)}"
    return failed(f"there is no launch file {name!r}", detail=detail)


def launch_starts(package: Package, *, name: str, nodes: list[str], built: bool = True) -> Outcome:
    """The launch file starts these nodes, with the defaults of its arguments.

    Launch files that it includes count, if they are part of the submission or of a well-known package. What ros2 launch
    stops at fails: an error in the file, a wrong argument of an action, a file that it reads and that is not installed.

    Args:
        name: The file's name, such as view.launch.py.
        nodes: The nodes, each as "package/executable", or as one name if both are the same; "a or b" leaves a choice.
        built: Whether a build must install the files that it reads; if not, files of the package count as found.
    """
    launch = launch_of(package, name)
    if launch.faults:
        raise fault_that_stops(package, name, launch)
    places = _places(package, launch, "read", "urdf", "include", built=built)
    if wrong := [it for it in places if it.state == "wrong" and _stops(it.file)]:
        return _wrong(package, wrong)
    started = {node.name for node in launch.nodes if node.when}
    missing = [choice for choice in (node.split(" or ") for node in nodes) if started.isdisjoint(choice)]
    listed = ", ".join(" or ".join(choice) for choice in missing)
    if missing and not _may_start(launch, missing):
        message = f"starts {', '.join(sorted(started)) or 'nothing'}"
        reason, at = _why_missing(launch, {node for choice in missing for node in choice})
        what, detail = f"the launch file does not start {listed}", f"; it {message}{reason}"
        return judged(False, what, tuple(sorted(started)), tuple(nodes), at=at, detail=detail)
    _check_starts(launch)
    if missing:
        reason = f": {launch.unknown[0].message}" if launch.unknown else ""
        message = f"cannot determine statically whether {listed} is started{reason}"
        raise NotDecided(message, "cannot determine statically which nodes the launch file starts")
    unknown = next((it.text for it in places if it.state == "unknown" and _stops(it.file) and it.file.path), "")
    if unknown:
        cause = "cannot determine statically whether the files that it reads are installed"
        raise NotDecided(f"{unknown}, and the launch file reads it", cause)
    return judged(True, f"the launch file starts {', '.join(sorted(started))}", tuple(sorted(started)), tuple(nodes))


def _check_starts(launch: "Launch") -> None:
    """Raise NotDecided if it is not known whether the launch file starts."""
    if launch.doubts:
        message, at = launch.doubts[0].message, launch.doubts[0].location
        what = "cannot determine statically whether ros2 launch starts the file"
        raise NotDecided(f"{what}: line {at.line}: {message}", what)


def _places(package: Package, launch: "Launch", *purposes: "Purpose", built: bool) -> list[FilePlace]:
    """Return where a launch file looks for files. Raises MissingElement for one that a build does not install."""
    places = [place_of(package, file) for file in launch.named(*purposes)]
    present = set(map(posixpath.basename, package.tree.files))
    for it in places:
        is_needed = built or posixpath.basename(it.file.path or "") not in present
        if it.state == "missing" and is_needed and not any(wrong.state == "wrong" for wrong in places):
            raise _missing(package, it)
    return places


def _stops(file: "NamedFile") -> bool:
    """Return whether ros2 launch stops if it does not find a file."""
    return file.purpose in ("read", "include") or file.by != ""


def _may_start(launch: "Launch", missing: Sequence[Sequence[str]]) -> bool:
    """Return whether each of the missing nodes may be started by what is not known."""
    uncertain = {node.name for node in launch.nodes if node.when is None}
    return bool(launch.unknown) or not any(uncertain.isdisjoint(choice) for choice in missing)


def _why_missing(launch: "Launch", missing: set[str]) -> "tuple[str, Location | None]":
    """Return why a launch file does not start nodes that should be started, in a sentence, and where to look."""
    for node in launch.forgotten:
        if node.name in missing:
            reason = f". It creates the node {node.executable}, but the LaunchDescription does not contain it"
            return reason, node.location
    for node in launch.nodes:
        if node.when is False and node.name in missing:
            return f". A condition keeps {node.executable} from starting, unless an argument is given", node.location
    similar = (node for node in launch.nodes if node.when and {node.package, node.executable} & missing)
    return "", next((node.location for node in similar), None)


def launch_finds_files(package: Package, *, name: str, built: bool = True, started: bool = True) -> Outcome:
    """The launch file looks for the URDF and RViz files where a build of the package installs them.

    What it reads as text, with `open` or `cat`, must be UTF-8, unless it names the encoding.

    Args:
        name: The file's name, such as view.launch.py.
        built: Whether a build must install the files; if not, files of the package count as found.
        started: Whether ros2 launch starts the file; if not, what stops it, and what is unknown then, does not count.
    """
    launch = launch_of(package, name)
    places = _places(package, launch, "urdf", "rviz", "include", built=built)
    if not started:
        places = _others(places)
    wrong = [it for it in places if it.state == "wrong"]
    if wrong:
        return _wrong(package, wrong)
    if not started:
        return passed("the launch file looks for no file in a wrong place")
    unknown = next((it for it in places if it.state == "unknown"), None)
    if launch.faults and (unknown or all(it.file.purpose == "include" for it in places)):
        raise fault_that_stops(package, name, launch)
    if all(it.file.purpose == "include" for it in places):
        raise _no_files(launch)
    if unknown is not None:
        raise NotDecided(unknown.text, _UNKNOWN_FILES)
    if not launch.faults:
        _check_starts(launch)
    return _found(places)


def _others(places: Sequence[FilePlace]) -> list[FilePlace]:
    """Return files that a launch does not stop at, but for unknown ones and those with the mistake that stops it."""
    stopping = {_is_local(it) for it in places if it.state == "wrong" and _stops(it.file)}
    others = (it for it in places if not _stops(it.file) and it.state != "unknown")
    return [it for it in others if it.state != "wrong" or _is_local(it) not in stopping]


def _is_local(place: FilePlace) -> bool:
    return place.file.path is not None and is_of_one_machine(place.file.path)


def _found(places: Sequence[FilePlace]) -> Outcome:
    if any(it.state == "missing" for it in places):
        return passed("the launch file looks for files of the package")
    found = dict.fromkeys(it.text for it in places if it.text)
    return passed(f"a build installs {enumerated(found)}, where the launch file looks")


def _wrong(package: Package, wrong: Sequence[FilePlace]) -> Outcome:
    message = "; ".join(dict.fromkeys(it.text for it in wrong))
    is_local = any(map(_is_local, wrong))
    if is_local:
        message += f"; use get_package_share_directory({package.name!r}), which returns the installed folder"
    first, mistake = wrong[0].file, wrong[0].mistake or (_ON_ONE_MACHINE if is_local else _NOT_INSTALLED)
    problem = one_machine_only(first.path) if first.path else ""
    return failed(message, first.location, problem=problem, mistake=mistake)


def _no_files(launch: "Launch") -> NotDecided | MissingElement:
    """Return why a launch file names neither a URDF nor an RViz file."""
    unknown = launch.doubts or launch.unknown
    if unknown:
        return NotDecided(f"{_UNKNOWN_FILES}: {unknown[0].message}", _UNKNOWN_FILES)
    return MissingElement("named file", "", message="the launch file names neither a URDF nor an RViz file")


def _missing(package: Package, place: FilePlace) -> MissingElement:
    """Return what the package is missing for a named file, by the kinds and names that the checks of packages use."""
    setup, purpose, name = package.setup, place.file.purpose, package.folder
    kind = f"installed {purpose}"
    if setup is None or setup.fault is not None:
        kind = "setup.py"
    elif not setup.is_called:
        kind = "call of setup"
    elif not any(path.lower().endswith(ENDINGS[purpose]) for path in package.tree.files):
        kind, name = f"{WORDS[purpose]} in the package", ""
    return MissingElement(kind, name, message=place.text, location=place.file.location)
