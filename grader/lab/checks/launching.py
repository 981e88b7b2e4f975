"""Launch files as checks need them: read, without faults, and launched together."""

import re
from typing import TYPE_CHECKING, Literal

from grader.base.errors import MissingElement, NotDecided
from grader.base.names import closest
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import quoted
from grader.lab.checks.outcome import Outcome, failed
from grader.lab.checks.started_nodes import Fault, fault_of_syntax, stopping_mistakes
from grader.lab.submission.submission import Submission
from grader.ros.package.package import Package

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from grader.ros.api import EndpointKind
    from grader.ros.launch.launch_model import Launch, StartedNode
    from grader.workspace.api import JoinedGraph, PlacedEnd
    from grader.workspace.model.workspace import Workspace

# A quality of service of nodes that are not submitted.
Quality = Literal["default", "sensor_data", "transient_local"]
# The causes of failures of what is launched.
STOPS = {"stops": "ros2 launch stops at an error in the launch file, or at a file that it reads"}
RUNS = {**STOPS, "runs": "a node cannot run"}
OPENS = {**RUNS, "topic": "no node opens a topic, service or action"}


class Launched(Named):
    """What runs after the launch files that a criterion asks for are launched together.

    `failure` is why a part of it certainly does not run: what is missing may be missing for this
    reason. With `has_commands`, other processes run than nodes: they may load controllers.
    """

    graph: "JoinedGraph"
    failure: Outcome | None
    has_commands: bool


def launch_together(package: Package, submission: Submission, name: str | None) -> Launched:
    """Return what runs after a launch file, or each of the submission, is launched.

    Raises MissingElement where none of them starts anything.
    """
    from grader.workspace.api import join_launches  # late: few rubrics ask for it

    workspace = submission.workspace
    stopped: list[MissingElement] = []
    if name is not None:
        path = package.path(path_of_launch(package, name))
        launch = evaluate_launch(package, name)
        if launch.faults:
            raise fault_that_stops(path, launch)
        launches = [launch]
    else:
        launches, stopped = _launches_that_start(workspace)
    if not launches:
        raise next(iter(stopped), package.missing("launch"))
    failures = []
    for error in stopped:
        message = f"a launch file does not start: {error}"
        at = error.location if isinstance(error.location, Location) else None
        failures.append(failed(message, at, mistake=error.mistake, cause="stops"))
    unrun = {}
    for launch in launches:
        unrun.update(_failing_programs(package, workspace, launch))
    graph = join_launches(workspace, [launch.source.path for launch in launches], unrun)
    has_commands = any(launch.command_texts for launch in launches)
    return Launched(graph, next(iter([*failures, *unrun.values()]), None), has_commands)


def _launches_that_start(workspace: "Workspace") -> "tuple[list[Launch], list[MissingElement]]":
    """Return the launch files that start, and why the others do not."""
    launches = []
    stopped = []
    for launch in workspace.launches.outermost:
        path = launch.source.path
        try:
            check_syntax(path, launch)
            if launch.faults:
                raise fault_that_stops(path, launch)
            launches.append(launch)
        except MissingElement as error:
            stopped.append(error)
    return launches, stopped


def _failing_programs(
    package: Package, workspace: "Workspace", launch: "Launch"
) -> dict[str, Outcome]:
    """Return the names of the programs that certainly cannot run, each with the reason."""
    failures = {}
    stopping = stopping_mistakes(workspace)
    for node in launch.nodes:
        fault = None
        if node.when is not False:
            fault = _why_not_run(workspace, package, node, stopping)
        if fault:
            failures[node.name] = failed(fault.message, fault.at, cause="runs")
    return failures


def _why_not_run(
    workspace: "Workspace",
    package: Package,
    node: "StartedNode",
    stopping: "Mapping[str, Fault]",
) -> Fault | None:
    """Return why a node certainly cannot run; None if it may."""
    from grader.ros.package.entry_points import certain_fault

    owner = workspace.find_package(node)
    if not owner:
        return None
    syntax = fault_of_syntax(workspace, node, owner.name)
    if syntax:
        return syntax
    facts = workspace.code.own_node(node)
    if facts and not facts.doubts and facts.location.path in stopping:
        return stopping[facts.location.path]
    entry = certain_fault(package, [node])
    if not entry:
        return None
    return Fault(f"a node cannot run: {entry.message}", entry.location)


def path_of_launch(package: Package, name: str) -> str:
    """Return the path of a launch file. Raises MissingElement."""
    path = package.launch_file(name)
    if path is None:
        raise package.missing("launch", name)
    return path


def evaluate_launch(package: Package, name: str) -> "Launch":
    """Return a launch file, evaluated.

    Raises MissingElement, and NotDecided for one that is not read.
    """
    path = path_of_launch(package, name)
    launch = package.launch(path)
    if launch.unread:
        raise NotDecided(launch.unread, "the launch file cannot be read")
    check_syntax(path, launch)
    return launch.with_components()


def check_syntax(path: str, launch: "Launch") -> None:
    """Raise MissingElement for a launch file that is not written as its language demands."""
    if launch.syntax:
        raise MissingElement(
            "launch file",
            path,
            message=launch.syntax.message,
            location=launch.syntax.location,
            cause="stops",
        )


def fault_that_stops(path: str, launch: "Launch") -> MissingElement:
    """Return the fault of a launch file that starts nothing because of it."""
    first = launch.faults[0]
    return MissingElement(
        "launch file",
        path,
        message=_join_faults(launch),
        location=first.location,
        problem=first.message,
        cause="stops",
    )


def _join_faults(launch: "Launch") -> str:
    messages = list(dict.fromkeys(fault.message for fault in launch.faults))
    if len(messages) > 1:
        return f"{messages[0]} (and {len(messages) - 1} more)"
    return messages[0]


def check_open(
    launched: Launched, what: str, ends: "Sequence[PlacedEnd]", kinds: "Sequence[EndpointKind]"
) -> None:
    """Raise NotDecided if an end may be there that is not certain."""
    doubts = [placed.doubt for placed in ends if placed.doubt]
    if not ends:
        doubts += launched.graph.why_more_ends(kinds)
    if doubts:
        message = f"cannot determine statically whether {what}: {doubts[0]}"
        raise NotDecided(message, "cannot determine statically what the nodes open")


def fail_absent(
    launched: Launched, kinds: "Sequence[EndpointKind]", verb: str, name: str
) -> Outcome:
    """Return that no node opens an end of these kinds, with a name that is like it."""
    others = {}
    for node in launched.graph.graph.nodes:
        others.update({end.name: end for end in node.ends if end.kind in kinds})
    message = f"no node {verb} {name}"
    meant = closest(name, list(others))
    if meant is None:
        return failed(message, cause="topic")
    return failed(
        message, others[meant].location, detail=f"; there is {quoted(meant)}", cause="topic"
    )


def full_name(name: str) -> str:
    """Return the full name of a topic, service or action that a rubric names."""
    return f"/{name.removeprefix('/')}"


def type_name(name: str) -> str:
    """Return a type as a/msg/B, however a rubric writes it."""
    return re.sub("[.:/]+", "/", name)
