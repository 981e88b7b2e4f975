"""Show the computation graph of a launch file, with the findings of an inspection at its ends."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from grader.app.commands.inspect_urdf import InspectRequest, inspect_opened
from grader.app.saving import check_saves, save_texts
from grader.base.errors import GraderError, InputError
from grader.base.names import did_you_mean
from grader.base.text import enumerated, printable, printable_path
from grader.report.formats import GraphFormat, InspectFormat, render_graph
from grader.report.invocation import (
    ExitCode,
    inspection_exit_code,
    read_arguments,
    read_saves,
)
from grader.report.shown_graph import ShownGraph
from grader.report.writing import Terminal, Warn
from grader.ros.api import Release
from grader.workspace.api import (
    LaunchGraph,
    connected_part,
    open_workspace,
)

if TYPE_CHECKING:
    from grader.workspace.api import HeardTopic

_MAX_NAMED = 10


class GraphRequest(NamedTuple):
    """The options of `grader graph`."""

    path: str  # of a folder or an archive
    launch: str  # the launch file, or the end of its path; empty for the first
    arg: Sequence[str] | None  # NAME=VALUE, of launch
    distro: Release | None  # of ROS 2; without it, what the settings or files state
    node: str  # the name of the only node to show
    connected: bool  # whether only connected ends are shown
    verbose: bool
    output_format: GraphFormat  # of standard output
    save: Sequence[str] | None  # FORMAT=FILE, of the files to write
    max_size: int  # of a URDF, in bytes
    recorded: str = ""  # the path of a recording

    @property
    def inspection(self) -> InspectRequest:
        """The request of the inspection whose findings are shown."""
        return InspectRequest(
            path=self.path,
            robot="",
            joint=None,
            relative_to=None,
            distro=self.distro,
            output_format=InspectFormat.JSON,
            save=None,
            max_size=self.max_size,
            arg=None,
            watch=False,
            select=None,
            ignore=None,
        )


def graph_and_save(request: GraphRequest, terminal: Terminal) -> ExitCode:
    """Show a graph, and save the files that `--save` names.

    Return the exit code of an inspection. Raises GraderError.
    """
    saves = read_saves(request.save or (), GraphFormat)
    check_saves(saves, (), request.path)
    shown = _read_graph(request, terminal.warn)
    texts = {file: render_graph(shown, kind) for kind, file in saves}
    terminal.print(render_graph(shown, request.output_format, terminal.screen()))
    code = inspection_exit_code(shown.inspection)
    if code != ExitCode.NOT_GRADED:
        save_texts(texts, request.path, ())
    return code


def _read_graph(request: GraphRequest, warn: Warn) -> ShownGraph:
    """Return the graph of the launch file that is asked for. Raises GraderError."""
    inspection = request.inspection
    selection = inspection.selection(Path(os.path.realpath(request.path)))
    stated = inspection.stated(selection.settings)
    opened = open_workspace(request.path, request.max_size, {}, stated)
    shown_path = printable_path(request.path)
    if opened.is_single:
        raise InputError(f"{shown_path} is no folder: give the package or workspace of a launch")
    arguments = read_arguments(request.arg or ())
    if arguments:
        opened = opened.under(arguments)
    inspected = inspect_opened(opened, inspection, selection, warn)
    launches = opened.launch_files()
    if not launches:
        raise InputError(f"{shown_path} has no launch file: there is nothing to show")
    graph = opened.launch_graph(_launch_named(request.launch, launches))
    _check_arguments(arguments, graph)
    node = _node_named(request.node, graph) if request.node else ""
    heard = _read_heard(request, graph) if request.recorded else ()
    if request.connected:
        graph = connected_part(graph)
    return ShownGraph(graph, inspected, tuple(launches), node, heard, request.verbose)


def _read_heard(request: GraphRequest, graph: LaunchGraph) -> "Sequence[HeardTopic]":
    """Return the topics of a recording beside those of a graph. Raises InputError without one."""
    # Late: few graphs have one.
    from grader.ros.api import read_longest_recording
    from grader.workspace.api import compare_recording

    tree = open_workspace(request.recorded, request.max_size, {}).whole_tree
    recording = read_longest_recording(tree)
    if not recording:
        shown_path = printable_path(request.recorded)
        raise InputError(f"--recorded: {shown_path} has no recording with messages")
    return compare_recording(graph, recording)


def _launch_named(name: str, launches: Sequence[str]) -> str:
    """Return the launch file with a path, or whose path ends so; the first one without a name.

    Raises GraderError.
    """
    if not name:
        return launches[0]
    if name in launches:
        return name
    end = f"/{name.removeprefix('./').strip('/')}"
    matches = [path for path in launches if f"/{path}".endswith(end)]
    if len(matches) == 1:
        return matches[0]
    listed = enumerated(map(printable, matches or launches), _MAX_NAMED)
    if matches:
        raise GraderError(f"--launch: {name!r} means several: {listed}")
    raise GraderError(f"--launch: there is no launch file {name!r}; there are: {listed}")


def _check_arguments(arguments: Sequence[str] | dict[str, str], graph: LaunchGraph) -> None:
    """Raise GraderError for an argument that the launch file does not declare."""
    declared = [name for name, _ in graph.arguments]
    for name in arguments:
        if declared and name not in declared:
            raise GraderError(
                f"--arg: {printable(graph.path)} declares no argument {name!r}"
                f"{did_you_mean(name, declared)}"
            )


def _node_named(name: str, graph: LaunchGraph) -> str:
    """Return the label of the node with a name, in any namespace. Raises GraderError."""
    labels = [node.label for node in graph.nodes]
    matches = {name, f"/{name}"}.intersection(labels)
    if not matches:
        matches = {label for label in labels if label.endswith(f"/{name}")}
    if len(matches) == 1:
        return matches.pop()
    listed = enumerated(map(printable, dict.fromkeys(labels)), _MAX_NAMED)
    raise GraderError(f"--node: there is no node {name!r}; there are: {listed or 'none'}")
