"""Checks of a launch file: its name, the nodes that it starts, and whether a build installs the
files that it names.
"""

import posixpath
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple

from grader.base.errors import InputError, MissingElement, NotDecided, RubricError
from grader.base.names import closest, is_misspelling
from grader.base.source import Location
from grader.base.text import enumerated
from grader.files.reading import URDF_LIMIT
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, judged, passed
from grader.lab.checks.started_nodes import Fault, Wanted, find_faults
from grader.lab.submission.submission import Submission
from grader.ros.build.places import (
    BY_MOVEIT,
    BY_UTF8,
    HOME,
    PREFIX,
    ROS,
    WORKING_FOLDER,
    is_launch_named,
    is_of_one_machine,
    one_machine_only,
)
from grader.ros.package.installed_files import Lookup, look_up, share_parts
from grader.ros.package.package import CMAKE, SETUP, Package
from grader.ros.python.values import OBJECT

if TYPE_CHECKING:
    from grader.lab.checks.installed_robot import InstalledRobot
    from grader.ros.launch.launch_model import Launch, NamedFile, Purpose
    from grader.ros.package.entry_points import EntryFault


# What the edits for hints may change.
ABOUT = {
    "launch_found": About(("launch",)),
    "node_runs": About(("launch",)),
    "launch_finds_files": About(("launch",)),
}
_WORDS = {
    "urdf": "URDF",
    "rviz": "RViz file",
    "include": "launch file",
    "launch": "launch file",
    "read": "file",
}
_ENDINGS = {
    "urdf": (".urdf", ".xacro"),
    "rviz": (".rviz",),
    "include": (".py", ".xml", ".launch", ".yaml", ".yml"),
    "read": ("",),
}


_UNKNOWN_FILES = "cannot determine statically which files it names"
_ON_ONE_MACHINE = "the launch file looks for files at paths that exist on one machine only"
_NOT_INSTALLED = "the launch file looks for files where a build does not install them"


class _FilePlace(NamedTuple):
    """Where a launch file looks for a file: found there, or why it is not. `missing`: a build does
    not install it.

    `mistake` is the text without what differs between students.
    """

    file: "NamedFile"
    state: Literal["found", "wrong", "unknown", "missing"]
    text: str = ""
    mistake: str = ""


def launch_found(package: Package, *, name: str) -> Outcome:
    """The package has a launch file of this name, written in Python, XML or YAML.

    Args:
        name: The file's name, such as view.launch.py.
    """
    path = _path_of(package, name)
    if is_launch_named(path, name):
        return passed(f"the launch file is {path}")
    detail = f"; the package has {path}{package.built('launch', name)}"
    return failed(
        f"there is no launch file {name!r}", Location(package.path(path), 1, 1), detail=detail
    )


def node_runs(
    package: Package,
    submission: Submission,
    *,
    launch: str,
    nodes: list[str] | None = None,
    not_: list[str] | None = None,
    remap: Mapping[str, str] | None = None,
    arguments: list[str] | None = None,
    includes: list[str] | None = None,
    publishes: list[str] | Mapping[str, str] | None = None,
    subscribes: list[str] | Mapping[str, str] | None = None,
    built: bool = True,
) -> Outcome:
    """The launch file starts these nodes, with the defaults of its arguments or those of the
    criterion's `args`.

    Launch files that it includes count, if they are part of the submission or of a well-known
    package. Anything at which ros2 launch stops fails: an error in the file, a wrong argument of an
    action, a file that is read but not installed. So does an entry point in setup.py of one of
    these nodes whose module or function does not exist.

    Args:
        launch: The file's name, such as view.launch.py.
        nodes: The nodes, each as "package/executable", or as one name if both are the same; "a or
            b" leaves a choice. A script may end in .py or not.
        not: Nodes that it does not start.
        remap: Names in the program of each of `nodes`, and what they are remapped to, by a rule or
            a namespace.
        arguments: Arguments of each of `nodes`: an option is followed by its value, and a path may
            be the end of one.
        includes: Launch files that it or another file of the submission includes, by the ends of
            their paths.
        publishes: Topics that nodes of the submission in Python publish, after remapping; a table
            gives their types.
        subscribes: Topics that they subscribe to.
        built: Whether it must find the files that it reads; if not, only what else stops it counts.
    """
    found = _launch_of(package, launch)
    if found.faults:
        raise _fault_that_stops(package, launch, found)
    if shadow := package.shadows_ros:
        message = (
            f"the folder {shadow} is installed as a Python package, in place of that of ROS 2: "
            "rename it"
        )
        return failed(message, Location(package.path(CMAKE if package.is_cmake else SETUP), 1, 1))
    if (remap or arguments) and not nodes:
        raise RubricError(("node_runs looks for remap and arguments in nodes: name one",))
    places = _find_places(package, found, "read", "urdf", "include", built=built)
    choices = [_names_in(found, node.split(" or ")) for node in nodes or ()]
    missing = _missing_nodes(found, choices)
    if missing and not _may_start(found, missing):
        return _fail_missing(found, missing, nodes or ())
    wanted = Wanted(_names_in(found, not_ or ()), remap, arguments, includes, publishes, subscribes)
    faults = find_faults(submission, found, choices, wanted) if any(wanted) else []
    if wrong := next((it for it in faults if it.is_certain), None):
        return failed(wrong.message, wrong.at, detail=wrong.detail)
    if fault := _faulty_program(package, found, choices):
        raise fault
    stopped = _stop_at_files(package, places, built=built)
    if stopped is not None:
        return stopped
    if built or not any(_is_in_misnamed(package, it) for it in places):
        _check_starts(found)
    _check_decided(found, missing, faults, places)
    started = sorted({node.name for node in found.nodes if node.when})
    return judged(
        True, f"the launch file starts {', '.join(started)}", tuple(started), tuple(nodes or ())
    )


def _names_in(launch: "Launch", names: Iterable[str]) -> list[str]:
    """Return names of nodes as a launch file has them: a build may install a script with .py, or
    without.
    """
    known = {node.name for node in launch.nodes}
    others = {
        name: name.removesuffix(".py") if name.endswith(".py") else f"{name}.py" for name in names
    }
    return [
        other if other in known and name not in known else name for name, other in others.items()
    ]


def _missing_nodes(launch: "Launch", choices: Sequence[Sequence[str]]) -> list[Sequence[str]]:
    """Return the nodes that are not certainly started."""
    started = {node.name for node in launch.nodes if node.when}
    return [choice for choice in choices if started.isdisjoint(choice)]


def _listed(missing: Sequence[Sequence[str]]) -> str:
    return ", ".join(" or ".join(choice) for choice in missing)


def _fail_missing(
    launch: "Launch", missing: Sequence[Sequence[str]], nodes: Sequence[str]
) -> Outcome:
    """Return the failure of a launch file that certainly does not start some nodes."""
    started = sorted({node.name for node in launch.nodes if node.when})
    reason, at = _why_missing(launch, {node for choice in missing for node in choice})
    what, detail = (
        f"the launch file does not start {_listed(missing)}",
        f"; it starts {', '.join(started) or 'nothing'}",
    )
    return judged(False, what, tuple(started), tuple(nodes), at=at, detail=f"{detail}{reason}")


def _stop_at_files(
    package: Package, places: Sequence[_FilePlace], *, built: bool
) -> Outcome | None:
    """Return the failure of a launch file that stops at a file that it reads; None if it does
    not.
    """
    if built and (wrong := [it for it in places if it.state == "wrong" and _stops_launch(it.file)]):
        return _fail_places(package, wrong)
    return next(filter(None, (_warning_that_stops(package, it) for it in places)), None)


def _check_decided(
    launch: "Launch",
    missing: Sequence[Sequence[str]],
    faults: Sequence[Fault],
    places: Sequence[_FilePlace],
) -> None:
    """Raise NotDecided if it is not known whether the launch file starts the nodes as they are
    wanted.
    """
    reason = f": {launch.unknown[0].message}" if launch.unknown else ""
    if missing:
        message = f"cannot determine statically whether {_listed(missing)} is started{reason}"
        raise NotDecided(message, "cannot determine statically which nodes the launch file starts")
    if faults:
        message = f"cannot determine statically whether {faults[0].message}{reason}"
        raise NotDecided(
            message, "cannot determine statically what the launch file gives its nodes"
        )
    unknown = next(
        (
            it.text
            for it in places
            if it.state == "unknown" and _stops_launch(it.file) and it.file.path
        ),
        "",
    )
    if unknown:
        cause = "cannot determine statically whether the files that it reads are installed"
        raise NotDecided(f"{unknown}, and the launch file reads it", cause)


def launch_finds_files(
    package: Package, *, name: str, built: bool = True, started: bool = True
) -> Outcome:
    """The launch file looks for the URDF and RViz files where a build of the package installs them.

    The same applies to other files that it reads, and to launch files that it includes. What it
    reads as text, with `open` or `cat`, must be UTF-8, unless it names the encoding.

    Args:
        name: The file's name, such as view.launch.py.
        built: Whether a build must install the files; if not, files of the package count as found.
        started: Whether ros2 launch starts the file; if not, only a file in a wrong place counts,
            as far as it is read.
    """
    if not started and package.launch(_path_of(package, name)).syntax is not None:
        return passed("the launch file cannot be read, so it looks for no file")
    launch = _launch_of(package, name)
    places = _find_places(package, launch, "urdf", "rviz", "include", "read", built=built)
    if built:
        places = [_place_of_parts(package, it) for it in places]
    wrong = [it for it in places if it.state == "wrong"]
    if wrong:
        return _fail_places(package, wrong)
    if not started:
        return passed("the launch file looks for no file in a wrong place")
    unknown = next((it for it in places if it.state == "unknown"), None)
    names_none = all(
        it.file.purpose in ("include", "read") and it.file.by != BY_MOVEIT for it in places
    )
    if launch.faults and (unknown or names_none):
        raise _fault_that_stops(package, name, launch)
    if names_none:
        raise _no_files(launch)
    if unknown is not None:
        raise NotDecided(unknown.text, _UNKNOWN_FILES)
    if not launch.faults:
        _check_starts(launch)
    return _pass_places(places)


def _check_starts(launch: "Launch") -> None:
    """Raise NotDecided if it is not known whether the launch file starts."""
    if launch.doubts:
        message, at = launch.doubts[0].message, launch.doubts[0].location
        what = "cannot determine statically whether ros2 launch starts the file"
        raise NotDecided(f"{what}: line {at.line}: {message}", what)


def _find_places(
    package: Package, launch: "Launch", *purposes: "Purpose", built: bool
) -> list[_FilePlace]:
    """Return where a launch file looks for files. Raises MissingElement for one that a build does
    not install.
    """
    places = [_place_of(package, file, built=built) for file in launch.named(*purposes)]
    present = {
        posixpath.basename(path) for it in package.packages.values() for path in it.tree.files
    }
    for it in places:
        is_needed = built or posixpath.basename(it.file.path or "") not in present
        if (
            it.state == "missing"
            and is_needed
            and not any(wrong.state == "wrong" for wrong in places)
        ):
            raise _missing_file(package, it)
    return places


def _stops_launch(file: "NamedFile") -> bool:
    """Return whether ros2 launch stops if it does not find a file."""
    return file.purpose in ("read", "include") or file.by != ""


def _faulty_program(
    package: Package, launch: "Launch", choices: Sequence[Sequence[str]]
) -> MissingElement | None:
    """Return the fault of a wanted node that certainly ends at once: setup.py names no function for
    its program.
    """
    for choice in choices:
        started = {
            node.name: node
            for node in launch.nodes
            if node.when is not False and node.name in choice
        }
        faults = [
            _fault_of_program(package.find(node.package), node.executable)
            for node in started.values()
        ]
        found = [fault for fault in faults if fault is not None]
        if found and len(found) == len(faults):
            fault, name = found[0], next(iter(started))
            message = f"the entry point of {name.rpartition('/')[2]!r} names no function"
            why, at = f": {fault.message}", fault.location
            return MissingElement(
                "entry point", name, message=message, detail=why, location=at, costs_once=True
            )
    return None


def _fault_of_program(owner: Package | None, name: str) -> "EntryFault | None":
    """Return why a program of a submitted package does not start."""
    if owner is None:
        return None
    from grader.ros.package.entry_points import (
        entry_fault,  # late: most launch files start programs of ROS 2 only
    )

    return entry_fault(owner, name)


def _may_start(launch: "Launch", missing: Sequence[Sequence[str]]) -> bool:
    """Return whether each of the missing nodes may be started by what is not known."""
    uncertain = {node.name for node in launch.nodes if node.when is None}
    return bool(launch.unknown) or not any(uncertain.isdisjoint(choice) for choice in missing)


def _why_missing(launch: "Launch", missing: set[str]) -> "tuple[str, Location | None]":
    """Return why a launch file does not start nodes that should be started, in a sentence, and
    where to look.
    """
    for node in launch.forgotten:
        if node.name in missing:
            reason = (
                f". It creates the node {node.executable}, but the LaunchDescription does not "
                "contain it"
            )
            return reason, node.location
    for node in launch.nodes:
        if node.when is False and node.name in missing:
            return (
                f". A condition keeps {node.executable} from starting, unless an argument is given",
                node.location,
            )
    similar = (
        node for node in launch.nodes if node.when and {node.package, node.executable} & missing
    )
    return "", next((node.location for node in similar), None)


def _is_local(place: _FilePlace) -> bool:
    return place.file.path is not None and is_of_one_machine(place.file.path)


def _is_in_misnamed(package: Package, place: _FilePlace) -> bool:
    """Return whether a file is looked for below a wrong name of the package, which is not on the
    machine.
    """
    owner, _ = share_parts(place.file.path or "")
    return place.state == "wrong" and bool(owner) and package.find(owner) is None


def _pass_places(places: Sequence[_FilePlace]) -> Outcome:
    if any(it.state == "missing" for it in places):
        return passed("the launch file looks for files of the package")
    found = dict.fromkeys(it.text for it in places if it.text)
    return passed(f"a build installs {enumerated(found)}, where the launch file looks")


def _fail_places(package: Package, wrong: Sequence[_FilePlace]) -> Outcome:
    message = "; ".join(dict.fromkeys(it.text for it in wrong))
    is_local = any(map(_is_local, wrong))
    if is_local:
        message += (
            f"; use get_package_share_directory({package.name!r}), which returns the installed "
            "folder"
        )
    first, mistake = (
        wrong[0].file,
        wrong[0].mistake or (_ON_ONE_MACHINE if is_local else _NOT_INSTALLED),
    )
    problem = one_machine_only(first.path) if first.path else ""
    return failed(message, first.location, problem=problem, mistake=mistake)


def _no_files(launch: "Launch") -> NotDecided | MissingElement:
    """Return why a launch file names neither a URDF nor an RViz file."""
    unknown = launch.doubts or launch.unknown
    if unknown:
        return NotDecided(f"{_UNKNOWN_FILES}: {unknown[0].message}", _UNKNOWN_FILES)
    return MissingElement(
        "named file", "", message="the launch file names neither a URDF nor an RViz file"
    )


def _missing_file(package: Package, place: _FilePlace) -> MissingElement:
    """Return what the package is missing for a named file, by the kinds and names that the checks
    of packages use.
    """
    setup, purpose, name = package.installation, place.file.purpose, package.folder
    if setup is not None and setup.misspelt is not None:
        return package.without_data_files(setup.misspelt.message)
    kind, looked_for = f"installed {purpose}", posixpath.basename(place.file.path or "")
    if setup is None or setup.fault is not None:
        kind = "setup.py"
    elif not setup.is_called:
        kind = "call of setup"
    elif not any(
        path.lower().endswith(_ENDINGS[purpose]) or posixpath.basename(path) == looked_for
        for path in package.tree.files
    ):
        kind, name = f"{_WORDS[purpose]} in the package", ""
    return MissingElement(kind, name, message=place.text, location=place.file.location)


def _place_of(package: Package, file: "NamedFile", *, built: bool) -> _FilePlace:
    """Return whether a launch file finds a file that it names."""
    if file.path is None or file.reason:
        return _FilePlace(file, "wrong" if file.is_certain else "unknown", file.reason)
    if OBJECT in file.path:
        name = file.path.rpartition(OBJECT)[0].rpartition("<")[2]
        reason = (
            f"{name}(...) is made part of a text, which is not its value then: use "
            "PathJoinSubstitution([...])"
        )
        return _FilePlace(file, "wrong", reason)
    what, path = _WORDS[file.purpose], posixpath.normpath(file.path)
    owner, rest = share_parts(path)
    if owner:
        other = package.find(owner)
        if other is None:
            return _place_in_unknown(package, owner, rest, file)
        place = _place_in_package(other, f"share/{owner}/{rest}", file)
        is_there = posixpath.basename(rest) in map(posixpath.basename, other.tree.files)
        return (
            place._replace(state="missing")
            if place.state == "unknown" and is_there and not built
            else place
        )
    fault = _fault_of_path(package, path)
    if fault:
        return _FilePlace(file, "wrong", f"the launch file looks for the {what} at {fault}")
    return _FilePlace(
        file, "unknown", f"the {what} {path.removeprefix(PREFIX)} is not part of the package"
    )


def _place_of_parts(package: Package, place: _FilePlace) -> _FilePlace:
    """Return the place of a robot's file, or where something that it needs is not installed."""
    if place.state != "found" or place.file.purpose not in ("urdf", "read") or not place.text:
        return place
    missing = _installed_robot(package, place).missing
    if not missing:
        return place
    mistake = "the robot needs a file that a build does not install"
    detail = (
        f"{posixpath.basename(place.text)} needs {enumerated(missing)}, which a build does not "
        "install there"
    )
    return _FilePlace(place.file, "wrong", detail, mistake)


def _warning_that_stops(package: Package, place: _FilePlace) -> Outcome | None:
    """Return the failure if Command stops because xacro writes a warning; None if it does not."""
    if place.state != "found" or not place.file.stops_at_stderr:
        return None
    mistake = "Command stops ros2 launch, because xacro writes a warning"
    if place.file.is_deprecated:
        return failed(mistake, place.file.location, detail=" about --inorder: remove it")
    warning = _installed_robot(package, place).warning
    if warning is None:
        return None
    source = package.installed.get(place.text, posixpath.basename(place.text))
    detail = f": line {warning.location.line} of {source}: {warning.message}"
    return failed(mistake, place.file.location, detail=detail, mistake=mistake)


def _installed_robot(package: Package, place: _FilePlace) -> "InstalledRobot":
    from grader.lab.checks.installed_robot import (
        read_installed,  # late: most launch files open a URDF without xacro
    )

    return read_installed(
        package, place.text, dict(place.file.arguments) if place.file.by == "xacro" else None
    )


def _fault_of_path(package: Package, path: str) -> str:
    """Return a path that is not below a share folder, with why no file is there; empty where that
    is not known.
    """
    if is_of_one_machine(path):
        return f"{path.replace(HOME, '~')}, which exists on one machine only"
    if path.startswith(WORKING_FOLDER) or not path.startswith("/"):
        shown = path.removeprefix(WORKING_FOLDER + "/")
        if shown.startswith("~"):
            return f"{shown}, but nothing replaces ~ by the home folder"
        return f"{shown}, relative to the folder that ros2 launch is started from"
    if not path.startswith((PREFIX, ROS)) and posixpath.basename(path) in map(
        posixpath.basename, package.tree.files
    ):
        return f"{path}: joining a path that begins with / drops the folders before it"
    return ""


def _place_in_unknown(package: Package, owner: str, rest: str, file: "NamedFile") -> _FilePlace:
    """Return what is known of a path in the share folder of a package that is not part of the
    submission.

    Raises MissingElement if it should be.
    """
    if owner in package.lab_packages:
        raise MissingElement("package", owner, message=f"no package is named {owner!r}")
    what = _WORDS[file.purpose]
    fault = "" if package.depends_on(owner) else _fault_of_owner(package, owner, rest, what)
    if fault:
        return _FilePlace(file, "wrong", fault)
    if file.purpose == "include":
        return _FilePlace(file, "found")
    return _FilePlace(
        file, "unknown", f"the {what} is in {owner!r}, which is not part of the submission"
    )


def _fault_of_owner(package: Package, owner: str, rest: str, what: str) -> str:
    """Return how the name of a package that is not part of the submission is wrong; empty where
    that is not known.
    """
    # A path may lack a slash after the package's name: get_package_share_directory(...) +
    # 'my_robot.urdf'.
    more = owner.removeprefix(package.name)
    if rest:
        is_known = more in package.tree.folders
    else:
        is_known = more in map(posixpath.basename, package.tree.files)
    if owner.startswith(package.name) and is_known:
        path = posixpath.join("share", owner, rest).rstrip("/")
        return (
            f"the launch file looks for the {what} at {path}: a slash is missing after "
            f"{package.name!r}"
        )
    if is_misspelling(owner, package.name):
        return (
            f"the launch file looks in a package {owner!r}, but the graded package is named "
            f"{package.name!r}"
        )
    return ""


def _place_in_package(owner: Package, target: str, file: "NamedFile") -> _FilePlace:
    """Return whether a build of a package installs a file at the path where it is looked for."""
    found, setup, what = look_up(owner, target), owner.installation, _WORDS[file.purpose]
    match found.state:
        case "unknown":
            return _FilePlace(
                file, "unknown", f"cannot determine statically whether a build installs {target}"
            )
        case "no build":
            return _FilePlace(file, "missing", f"a build installs no {what}: {found.text}")
        case "installed" if setup is not None and setup.misspelt is not None:
            return _FilePlace(
                file, "missing", f"a build does not install the {what}: {setup.misspelt.message}"
            )
        case "installed":
            return _place_not_utf8(owner, found.path, file) or _FilePlace(file, "found", target)
    return _place_not_there(owner, target, found, file)


def _place_not_utf8(owner: Package, path: str, file: "NamedFile") -> _FilePlace | None:
    """Return where reading a file stops the launch file, because its text is not UTF-8; None where
    it does not.
    """
    try:
        if file.by in BY_UTF8:
            owner.tree.files[path].read(URDF_LIMIT).decode()
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        mistake = (
            f"reading the {_WORDS[file.purpose]} stops the launch file with a "
            "UnicodeDecodeError: it is not UTF-8"
        )
        detail = f" (line {line} of {posixpath.basename(path)}); save it as UTF-8"
        return _FilePlace(file, "wrong", mistake + detail, mistake)
    except InputError:
        pass  # other criteria report it
    return None


def _place_not_there(owner: Package, target: str, found: Lookup, file: "NamedFile") -> _FilePlace:
    """Return where else a build installs a file, or what the package has instead of it."""
    message = f"the launch file looks for the {_WORDS[file.purpose]} at {target}, but {found.text}"
    if found.state == "elsewhere":
        # Outside of the package's folder, at the path where the launch file looks in it: that is
        # the fault of setup.py.
        is_at_path = f"/{found.path}".endswith(f"/{target.removeprefix(owner.share)}")
        is_of_setup = is_at_path and not found.path.startswith(owner.share)
        return _FilePlace(file, "missing" if is_of_setup else "wrong", message)
    if found.state == "not installed":
        return _FilePlace(file, "missing", message)
    names = {*map(posixpath.basename, owner.tree.files)}
    names.discard(posixpath.basename(file.location.path))
    alike = sorted(name for name in names if name.lower().endswith(_ENDINGS[file.purpose]))
    is_include = file.purpose == "include"
    if not alike and not is_include:
        return _FilePlace(file, "missing", message)
    similar = closest(posixpath.basename(target), alike)
    if similar is None and len(alike) == 1 and not is_include:
        similar = alike[0]
    if similar is not None:
        message += f"; there is {similar!r}"
    return _FilePlace(file, "wrong", message)


def _path_of(package: Package, name: str) -> str:
    """Return the path of a launch file. Raises MissingElement."""
    path = package.launch_file(name)
    if path is None:
        raise package.missing("launch")
    return path


def _launch_of(package: Package, name: str) -> "Launch":
    """Return a launch file, evaluated. Raises MissingElement, and NotDecided for one that is not
    read.
    """
    path = _path_of(package, name)
    launch = package.launch(path)
    if launch.unread:
        raise NotDecided(launch.unread, "the launch file cannot be read")
    if launch.syntax is not None:
        raise MissingElement(
            "launch file", path, message=launch.syntax.message, location=launch.syntax.location
        )
    return launch


def _fault_that_stops(package: Package, name: str, launch: "Launch") -> MissingElement:
    """Return the fault of a launch file that starts nothing because of it."""
    path, first = _path_of(package, name), launch.faults[0]
    return MissingElement(
        "launch file",
        path,
        message=_join_faults(launch),
        location=first.location,
        problem=first.message,
    )


def _join_faults(launch: "Launch") -> str:
    messages = list(dict.fromkeys(fault.message for fault in launch.faults))
    if len(messages) > 1:
        return f"{messages[0]} (and {len(messages) - 1} more)"
    return messages[0]
