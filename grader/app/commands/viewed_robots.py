"""The robots that `grader view` shows.

This is one that is graded against a rubric, or all that an inspection finds.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from grader.app.commands.inspect_urdf import InspectRequest, inspect_opened, open_and_inspect
from grader.app.grading import GradeRequest, grade_request
from grader.base.errors import GraderError, InputError
from grader.base.problems import Problem
from grader.base.source import SourceOf
from grader.base.text import printable_path
from grader.files.tree import Tree, overlaid
from grader.report.formats import Format, InspectFormat
from grader.report.inspection import InspectedRobot, Inspection
from grader.report.pages.graph_page import graph_html
from grader.report.pages.inspection_page import inspection_html, log_cards, problem_card
from grader.report.pages.student import render_html
from grader.report.pages.viewing import (
    ArgumentField,
    GraphViewing,
    LogCard,
    ProblemCard,
    Viewing,
)
from grader.report.shown_graph import ShownGraph
from grader.ros.api import Read, Unreadable
from grader.workspace.api import read_workspace

if TYPE_CHECKING:
    from grader.lab.grading.report import Report
    from grader.report.drawing.playback import Playback
    from grader.ros.api import MeshLoader, Reading
    from grader.workspace.api import OpenedWorkspace

_MAX_SHOWN = 5  # problems that break a robot
_DESCRIBED = "robot_description.urdf"  # the recorded one
_Notes = dict[str, None]  # each once


class ViewRequest(NamedTuple):
    """The options of `grader view`."""

    path: str  # of a URDF or a workspace
    rubric: str  # an id or a file; empty for the problems of an inspection
    arg: Sequence[str]  # NAME=VALUE, of xacro
    max_size: int  # of a URDF, in bytes
    log: bytes | None = None  # the output of a terminal, at first


@dataclass(frozen=True, slots=True)
class ViewedRobot:
    """A robot as the files are now.

    `is_loaded` says whether ROS 2 loads it. `render` returns its page, and `broken` has what is
    wrong with it otherwise.
    """

    path: str
    is_loaded: bool
    broken: Sequence[ProblemCard]
    arguments: Sequence[ArgumentField]
    meshes: "MeshLoader | None"
    render: Callable[[Viewing], str]


class _ViewedGraphs(NamedTuple):
    """The graphs of what was read: `render` returns the page of that of a launch file."""

    launches: Sequence[str]  # the paths of the launch files; none without a graph
    render: Callable[[str, GraphViewing], str]


class ViewedFiles(NamedTuple):
    """What was read at a path."""

    robots: Sequence[ViewedRobot]
    notes: Sequence[str]  # on how it was read
    besides: Sequence[Path]  # the files that were read besides a single one
    graphs: _ViewedGraphs | None = None
    log: Sequence[LogCard] | None = None  # what is said of a log; None without one
    playback: "Playback | None" = None  # the recording that moves them


def read_robots(
    request: ViewRequest, tried: Mapping[str, str], log: bytes | None = None
) -> ViewedFiles:
    """Return the robots at a path, with the arguments of xacro that are tried, and of a log.

    Raises GraderError, also if there is no robot.
    """
    if request.path in ("", "-"):
        raise GraderError("view takes a file or folder: standard input is read only once")
    notes: _Notes = {}
    arg = [*request.arg, *(f"{name}={value}" for name, value in tried.items())]
    read = _graded if request.rubric else _inspected
    return read(request, arg, log, notes)


def _inspected(
    request: ViewRequest, arg: Sequence[str], log: bytes | None, notes: _Notes
) -> ViewedFiles:
    """Return the robots that an inspection finds."""
    inspected = _inspection(request, arg, log)
    inspection, opened = open_and_inspect(inspected, notes.setdefault)
    playback = _find_playback(opened.whole_tree, log)
    descriptions = playback.recording.descriptions if playback else ()
    if not inspection.robots and descriptions:
        tree = overlaid(opened.whole_tree, {_DESCRIBED: descriptions[0].encode()})
        opened = read_workspace(tree, opened.id, request.max_size, {})
        selection = inspected.selection(Path(request.path))
        inspection = inspect_opened(opened, inspected, selection, notes.setdefault)
    if not inspection.robots:
        raise InputError(next(iter(notes), _no_robot(request.path)))
    robots = [_inspected_robot(robot, inspection) for robot in inspection.robots]
    graphs = None
    if not opened.is_single:
        render = partial(_graph_page, opened, inspection)
        graphs = _ViewedGraphs(opened.launch_files(), render)
    cards = _of_log(inspection)
    return ViewedFiles(robots, list(notes), inspection.besides, graphs, cards, playback)


def _find_playback(tree: Tree, log: bytes | None) -> "Playback | None":
    """Return what plays the longest recording among some files; None without one."""
    # Late: `render_html` of a report needs none.
    from grader.report.drawing.playback import Playback
    from grader.ros.api import read_longest_recording

    recording = read_longest_recording(tree)
    return Playback(recording, log) if recording else None


def _of_log(inspection: Inspection) -> Sequence[LogCard] | None:
    if inspection.log is None:
        return None
    return log_cards(inspection.log, inspection.source)


def _inspection(request: ViewRequest, arg: Sequence[str], log: bytes | None) -> InspectRequest:
    return InspectRequest(
        path=request.path,
        robot="",
        joint=None,
        relative_to=None,
        distro=None,
        output_format=InspectFormat.HTML,
        save=None,
        max_size=request.max_size,
        arg=arg,
        watch=True,
        select=None,
        ignore=None,
        log=log,
    )


def _graph_page(
    opened: "OpenedWorkspace", inspection: Inspection, launch: str, viewing: GraphViewing
) -> str:
    """Return the page of the graph of a launch file."""
    launches = tuple(opened.launch_files())
    return graph_html(ShownGraph(opened.launch_graph(launch), inspection, launches), viewing)


def _inspected_robot(robot: InspectedRobot, inspection: Inspection) -> ViewedRobot:
    shown = replace(inspection, robots=(robot,))
    return ViewedRobot(
        robot.path,
        robot.configuration is not None and robot.verdict != "rejected",
        _broken(robot.problems, shown.source),
        _arguments(robot.reading),
        robot.meshes,
        partial(inspection_html, shown),
    )


def _graded(
    request: ViewRequest, arg: Sequence[str], log: bytes | None, notes: _Notes
) -> ViewedFiles:
    """Return the robot that is graded."""
    run = grade_request(
        GradeRequest(
            path=request.path,
            rubric=request.rubric,
            expect_rubric=None,
            part=None,
            output_format=Format.HTML,
            save=None,
            fail_under=None,
            max_size=request.max_size,
            arg=arg,
            answers=None,
            verbose=False,
            hints=None,
            fix=None,
            watch=True,
        ),
        notes.setdefault,
    )
    robots = [_graded_robot(run.report, request.path)]
    graphs = None
    cards = None
    has_launch = any(package.launch_files for package in run.report.submission.packages)
    if has_launch or log is not None:
        inspection, opened = open_and_inspect(_inspection(request, (), log), lambda _: None)
        cards = _of_log(inspection)
        if has_launch:
            graphs = _ViewedGraphs(opened.launch_files(), partial(_graph_page, opened, inspection))
    playback = _find_playback(run.report.submission.tree, log)
    return ViewedFiles(robots, list(notes), run.besides, graphs, cards, playback)


def _graded_robot(report: "Report", path: str) -> ViewedRobot:
    submission = report.submission
    if isinstance(submission.urdf, Unreadable):
        raise InputError(submission.urdf.reason)
    if not isinstance(submission.urdf, Read):
        raise InputError(_no_robot(path))
    return ViewedRobot(
        submission.urdf.path,
        submission.robot is not None and submission.verdict != "rejected",
        _broken(report.problems, submission.source),
        _arguments(submission.urdf.reading),
        submission.meshes,
        partial(render_html, report),
    )


def _no_robot(path: str) -> str:
    return f"{printable_path(path)} has no robot to show: no file in it has a <robot>"


def _broken(problems: Sequence[Problem], source_of: SourceOf) -> list[ProblemCard]:
    """Return what is wrong with a robot that ROS 2 does not load, the errors first."""
    errors = [problem for problem in problems if problem.severity == "error"]
    return [problem_card(problem, source_of) for problem in (errors or problems)[:_MAX_SHOWN]]


def _arguments(reading: "Reading") -> list[ArgumentField]:
    """Return the arguments of xacro that a robot has, without those that `--arg` cannot name."""
    declared = getattr(reading.source, "declared_arguments", ())
    fields = [
        ArgumentField(argument.name, argument.default, argument.value) for argument in declared
    ]
    return [field for field in fields if "=" not in field.name and not field.name.endswith(":")]
