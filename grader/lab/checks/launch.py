"""Checks of a launch file.

They are about its name, the nodes that it starts, and whether a build installs the files that it
names.
"""

import posixpath
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from grader.base.errors import MissingElement, NotDecided, RubricError
from grader.base.grouping import Strings, StringsByName
from grader.base.source import Location
from grader.base.text import enumerated
from grader.lab.checks.check import About
from grader.lab.checks.installed_files import INSTALLING, files_of_kind, require_installed
from grader.lab.checks.launching import (
    STOPS,
    Quality,
    evaluate_launch,
    fault_that_stops,
    path_of_launch,
)
from grader.lab.checks.outcome import Outcome, failed, judged, passed
from grader.lab.checks.started_nodes import Fault, Wanted, find_faults
from grader.lab.submission.submission import Submission
from grader.ros.installation.places import is_launch_named
from grader.ros.package.file_places import FilePlace, find_places
from grader.ros.package.package import CMAKE, SETUP, Package

if TYPE_CHECKING:
    from grader.ros.launch.launch_model import Launch


# What the edits for hints may change.
_LOOKING = {
    **STOPS,
    "local": "a path exists on one machine only, or is relative to the working folder",
    "name": "a file or package of another name is looked for",
    "needs": "a build does not install a file that the robot needs, such as a mesh",
    "encoding": "a file that is read as text is not UTF-8",
    "given": "a node or an action is not given a file as it needs it",
}
ABOUT = {
    "launch_found": About(("launch",)),
    "node_runs": About(
        ("launch",),
        causes={
            **STOPS,
            "given": "a node has other remappings or arguments, or another file is included",
            "topic": "no node opens a topic, service or action",
            "type": "a topic has another type",
            "quality": "the quality of service of a topic differs",
            "program": "an entry point in setup.py names no function",
        },
    ),
    "launch_finds_files": About(("launch",), causes=_LOOKING),
    "launch_complete": About(("launch", SETUP, "file"), causes={**INSTALLING, **_LOOKING}),
}
_UNKNOWN_FILES = "cannot determine statically which files it names"
_Choices = Sequence[Sequence[str]]  # of nodes, each by its possible names
_Ends = list[str] | StringsByName | None  # names, or their types by name
_Places = Sequence[FilePlace]


def launch_found(package: Package, *, name: str) -> Outcome:
    """The package has a launch file of this name, written in Python, XML or YAML.

    Args:
        name: The file's name, such as view.launch.py.
    """
    path = path_of_launch(package, name)
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
    remap: StringsByName | None = None,
    arguments: list[str] | None = None,
    includes: list[str] | None = None,
    publishes: _Ends = None,
    subscribes: _Ends = None,
    serves: _Ends = None,
    calls: _Ends = None,
    spawns: list[str] | None = None,
    active: list[str] | None = None,
    qos: Mapping[str, Quality] | None = None,
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
        publishes: Topics that nodes of the submission, or bridges of Gazebo, publish, after
            remapping; a table gives their types.
        subscribes: Topics that they subscribe to.
        serves: Services and actions that they serve.
        calls: Services and actions that they call.
        spawns: Controllers that spawners start, by whichever of them.
        active: Nodes with a lifecycle that become active: by a lifecycle manager, an event of a
            launch file, or their code.
        qos: The quality of service of nodes that are not submitted, by the topics at whose other
            end they are: default, sensor_data or transient_local.
        built: Whether it must find the files that it reads; if not, only what else stops it counts.
    """
    evaluated = evaluate_launch(package, launch)
    if evaluated.faults:
        raise fault_that_stops(path_of_launch(package, launch), evaluated)
    if package.shadows_ros:
        return _fail_shadowing(package)
    if (remap or arguments) and not nodes:
        raise RubricError(("node_runs looks for remap and arguments in nodes: name one",))
    places = find_places(package, evaluated, "read", "urdf", "include", built=built)
    wanted_nodes = tuple(nodes or ())
    choices = [_names_in(evaluated, node.split(" or ")) for node in wanted_nodes]
    if evaluated.components:
        choices = [_add_components(submission, evaluated, names) for names in choices]
    missing = _missing_nodes(evaluated, choices)
    if missing and not _may_start(evaluated, missing):
        return _fail_missing(evaluated, missing, wanted_nodes)
    wanted = Wanted(
        absent=_names_in(evaluated, not_ or ()),
        remap=remap,
        arguments=arguments,
        includes=includes,
        publishes=publishes,
        subscribes=subscribes,
        serves=serves,
        calls=calls,
        spawns=spawns,
        active=active,
        qos=qos,
    )
    faults = find_faults(submission, evaluated, choices, wanted) if any(wanted) else []
    failure = _fail_certainly(package, evaluated, choices, faults)
    failure = failure or _stop_at_files(package, evaluated, places, built=built)
    if failure:
        return failure
    if built or not any(place.is_in_misnamed(package) for place in places):
        _check_starts(evaluated)
    _check_decided(evaluated, missing, faults, places)
    return _pass_started(evaluated, wanted_nodes)


def _fail_certainly(
    package: Package,
    launch: "Launch",
    choices: _Choices,
    faults: Sequence[Fault],
) -> Outcome | None:
    """Return the failure of the first certain fault; raise that of a program that ends at once."""
    for fault in faults:
        if fault.is_certain:
            return failed(fault.message, fault.at, detail=fault.detail, cause=fault.cause)
    ending = _faulty_program(package, launch, choices)
    if ending:
        raise ending
    return None


def _list_started(launch: "Launch") -> list[str]:
    return sorted({node.name for node in launch.nodes if node.when})


def _pass_started(launch: "Launch", wanted_nodes: Strings) -> Outcome:
    """Return the outcome of a launch file that starts what it should."""
    started = _list_started(launch)
    message = f"the launch file starts {', '.join(started)}"
    return judged(True, message, tuple(started), wanted_nodes)


def _names_in(launch: "Launch", names: Iterable[str]) -> list[str]:
    """Return names of nodes as a launch file has them.

    A build may install a script with .py, or without.
    """
    known = {node.name for node in launch.nodes}
    others = {
        name: name.removesuffix(".py") if name.endswith(".py") else f"{name}.py" for name in names
    }
    return [
        other if other in known and name not in known else name for name, other in others.items()
    ]


def _add_components(submission: Submission, launch: "Launch", names: Sequence[str]) -> list[str]:
    """Return names of nodes with those of the components that are the nodes of these programs."""
    code = submission.workspace.code
    all_names = list(names)
    for node in launch.nodes:
        if node.program_name in names:
            all_names.append(node.name)
    for name in names:
        package, _, executable = name.rpartition("/")
        package = package or executable  # one name if both are the same
        own_code = code.by_package.get(package)
        for program in own_code.programs if own_code else ():
            if program.name == executable and program.nodes:
                for node in launch.nodes:
                    if node.package == package and tuple(code.find_nodes(node)) == program.nodes:
                        all_names.append(node.name)
    return list(dict.fromkeys(all_names))


def _missing_nodes(launch: "Launch", choices: _Choices) -> list[Sequence[str]]:
    """Return the nodes that are not certainly started."""
    started = set(_list_started(launch))
    return [choice for choice in choices if started.isdisjoint(choice)]


def _listed(missing: _Choices) -> str:
    return ", ".join(map(" or ".join, missing))


def _fail_missing(launch: "Launch", missing: _Choices, nodes: Sequence[str]) -> Outcome:
    """Return the failure of a launch file that certainly does not start some nodes."""
    started = _list_started(launch)
    reason, at = _why_missing(launch, {node for choice in missing for node in choice})
    what = f"the launch file does not start {_listed(missing)}"
    detail = f"; it starts {', '.join(started) or 'nothing'}"
    return judged(False, what, tuple(started), tuple(nodes), at=at, detail=f"{detail}{reason}")


def _stop_at_files(
    package: Package, launch: "Launch", places: _Places, *, built: bool
) -> Outcome | None:
    """Return the failure of a launch file that stops at a file that it reads.

    It is None if it does not.
    """
    if built and (
        wrong := [place for place in places if place.state == "wrong" and place.stops_launch]
    ):
        return _fail_places(package, launch, wrong)._replace(cause="stops")
    return next(filter(None, (_warning_that_stops(package, place) for place in places)), None)


def _check_decided(
    launch: "Launch",
    missing: _Choices,
    faults: Sequence[Fault],
    places: _Places,
) -> None:
    """Raise NotDecided if the started nodes are not known.

    It has to be known whether the launch file starts them as they are wanted.
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
            place.text
            for place in places
            if place.state == "unknown" and place.stops_launch and place.file.path
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
    return _look_for_files(package, name, built=built, started=started, needs_robot=True)


def _fail_shadowing(package: Package) -> Outcome:
    message = (
        f"the folder {package.shadows_ros} is installed as a Python package, in place of that of "
        "ROS 2: rename it"
    )
    return failed(message, Location(package.path(CMAKE if package.is_cmake else SETUP), 1, 1))


def _look_for_files(
    package: Package, name: str, *, built: bool, started: bool, needs_robot: bool
) -> Outcome:
    """Return whether a launch file looks for files where they are.

    Where it `needs_robot`, one that names neither a URDF nor an RViz file fails.
    """
    if not started and package.launch(path_of_launch(package, name)).syntax:
        return passed("the launch file cannot be read, so it looks for no file")
    launch = evaluate_launch(package, name)
    places = find_places(package, launch, "urdf", "rviz", "include", "read", built=built)
    if not (needs_robot or package.rviz_files):  # then RViz may start without a file
        places = [place for place in places if place.file.purpose != "rviz"]
    if built:
        places = [place.with_parts(package) for place in places]
    wrong = _in_state(places, "wrong")
    if wrong:
        return _fail_places(package, launch, wrong)
    if not started:
        return passed("the launch file looks for no file in a wrong place")
    return _judge_files(package, launch, name, places, needs_robot=needs_robot)


def _in_state(places: _Places, state: str) -> list[FilePlace]:
    return [place for place in places if place.state == state]


def _judge_files(
    package: Package,
    launch: "Launch",
    name: str,
    places: _Places,
    *,
    needs_robot: bool,
) -> Outcome:
    """Return whether a launch file that starts finds its files; none is in a wrong place."""
    unknown = next(iter(_in_state(places, "unknown")), None)
    names_none = not any(place.is_of_robot for place in places)
    if launch.faults and (unknown or names_none):
        raise fault_that_stops(path_of_launch(package, name), launch)
    if names_none and needs_robot:
        raise _no_files(launch)
    if unknown:
        raise NotDecided(unknown.text, _UNKNOWN_FILES)
    if not launch.faults:
        _check_starts(launch)
    return _pass_places(places)


def launch_complete(package: Package, *, name: str, started: bool = True) -> Outcome:
    """The package has a launch file, a build installs it, and the files that it names are where
    it looks.

    The name of the launch file does not matter, nor does an error that stops the build. A launch
    file that names no file passes.

    Args:
        name: The file's name, which decides if the package has several launch files.
        started: Whether ros2 launch starts the file; if not, only a file in a wrong place counts,
            as far as it is read.
    """
    files = files_of_kind(package, "launch", name)
    if not files:
        raise package.missing("launch")
    installed = require_installed(package, files, "launch", despite_errors=True)
    if installed.status != "passed":
        return installed
    return _look_for_files(package, name, built=True, started=started, needs_robot=False)


def _check_starts(launch: "Launch") -> None:
    """Raise NotDecided if it is not known whether the launch file starts."""
    if launch.doubts:
        message = launch.doubts[0].message
        at = launch.doubts[0].location
        what = "cannot determine statically whether ros2 launch starts the file"
        raise NotDecided(f"{what}: line {at.line}: {message}", what)


def _faulty_program(package: Package, launch: "Launch", choices: _Choices) -> MissingElement | None:
    """Return the fault of a wanted node that certainly ends at once.

    setup.py names no function for its program.
    """
    from grader.ros.package.entry_points import certain_fault  # late: most start nodes of ROS 2

    for choice in choices:
        started = {
            node.name: node
            for node in launch.nodes
            if node.when is not False and node.name in choice
        }
        fault = certain_fault(package, started.values())
        if fault:
            name = next(iter(started))
            message = f"the entry point of {name.rpartition('/')[2]!r} names no function"
            why = f": {fault.message}"
            at = fault.location
            return MissingElement(
                "entry point",
                name,
                message=message,
                detail=why,
                location=at,
                costs_once=True,
                cause="program",
            )
    return None


def _may_start(launch: "Launch", missing: _Choices) -> bool:
    """Return whether each of the missing nodes may be started by what is not known."""
    uncertain = {node.name for node in launch.nodes if node.when is None}
    return bool(launch.unknown) or not any(map(uncertain.isdisjoint, missing))


def _why_missing(launch: "Launch", missing: set[str]) -> "tuple[str, Location | None]":
    """Return why a launch file does not start nodes that should be started.

    The reason is a sentence; where to look comes with it.
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


def _pass_places(places: _Places) -> Outcome:
    if any(place.state == "missing" for place in places):
        return passed("the launch file looks for files of the package")
    texts = dict.fromkeys(place.text for place in places if place.text)
    if not texts:
        return passed("the launch file names no file")
    return passed(f"a build installs {enumerated(texts)}, where the launch file looks")


def _fail_places(package: Package, launch: "Launch", wrong: _Places) -> Outcome:
    message = "; ".join(dict.fromkeys(place.text for place in wrong))
    is_local = any(place.is_local for place in wrong)
    if is_local:
        message += (
            f"; use get_package_share_directory({package.name!r}), which returns the installed "
            "folder"
        )
    mistake = wrong[0].mistake or (
        "the launch file looks for files at paths that exist on one machine only"
        if is_local
        else "the launch file looks for files where a build does not install them"
    )
    at = wrong[0].location_in(launch.source)
    return failed(message, at, problem=wrong[0].problem, mistake=mistake, cause=wrong[0].cause)


def _no_files(launch: "Launch") -> NotDecided | MissingElement:
    """Return why a launch file names neither a URDF nor an RViz file."""
    unknown = launch.doubts or launch.unknown
    if unknown:
        return NotDecided(f"{_UNKNOWN_FILES}: {unknown[0].message}", _UNKNOWN_FILES)
    return MissingElement(
        "named file", "", message="the launch file names neither a URDF nor an RViz file"
    )


def _warning_that_stops(package: Package, place: FilePlace) -> Outcome | None:
    """Return the failure if Command stops because xacro writes a warning; None if it does not."""
    if place.state != "found" or not place.file.stops_at_stderr:
        return None
    mistake = "Command stops ros2 launch, because xacro writes a warning"
    if place.file.is_deprecated:
        detail = " about --inorder: remove it"
        return failed(mistake, place.file.location, detail=detail, cause="stops")
    warning = place.installed_robot(package).warning
    if not warning:
        return None
    source = package.installed.get(place.text, posixpath.basename(place.text))
    detail = f": line {warning.location.line} of {source}: {warning.message}"
    return failed(mistake, place.file.location, detail=detail, mistake=mistake, cause="stops")
