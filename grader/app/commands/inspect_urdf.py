"""Read the robots at a path as ROS 2 does, with joints at given positions.

Also find what is wrong in the packages around them.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from math import isfinite, nan
from pathlib import Path
from typing import TYPE_CHECKING

from grader.app.baseline import baseline_text, read_baseline, without_known
from grader.app.ignoring import Selection, without_ignored
from grader.app.saving import check_file, check_saves, save_texts
from grader.app.settings import Settings, read_codes, read_settings
from grader.base.errors import GraderError, InputError, MissingElement, NotDecided
from grader.base.problems import Problem
from grader.base.processor_time import INSPECT_SECONDS
from grader.base.records import Named
from grader.base.text import MAX_NAMED, enumerated, printable_path
from grader.files.limits import METADATA, is_recording
from grader.files.tree import overlaid
from grader.report.formats import InspectFormat, render_inspection
from grader.report.inspection import InspectedRobot, Inspection, main_root
from grader.report.invocation import (
    ExitCode,
    Saves,
    inspection_exit_code,
    read_arguments,
    read_saves,
)
from grader.report.repository import find_base, find_folder
from grader.report.screen import Screen
from grader.report.writing import Terminal, Warn
from grader.ros.api import Absent, Configuration, Read, Reading, Release, StatedReleases, Unreadable
from grader.workspace.api import OpenedWorkspace, open_workspace

if TYPE_CHECKING:
    from grader.workspace.api import DescribedRecording

_MAX_NAMED = 20
# The rules of wheels that are on the wrong side, or turn backward, which drive a robot elsewhere.
_OF_COURSE = ("wheel-axis", "wheel-side")


class InspectRequest(Named):
    """The options of `grader inspect`."""

    path: str  # of a URDF or a workspace; - for a URDF on standard input
    robot: str  # the name of the only one to show, or the end of its path
    joint: Sequence[str] | None  # NAME=VALUE
    relative_to: str | None  # the frame of the poses
    distro: Release | None  # of ROS 2; without it, what the settings or files state
    output_format: InspectFormat  # of standard output
    save: Sequence[str] | None  # FORMAT=FILE, of the reports to write
    max_size: int  # of a URDF, in bytes
    arg: Sequence[str] | None  # NAME=VALUE, of xacro
    watch: bool  # whether to inspect again after every change
    select: Sequence[str] | None  # the codes of the only problems to show, or their beginnings
    ignore: Sequence[str] | None  # those of problems not to show
    verbose: bool = False  # whether the terminal shows everything
    baseline: str | None = None  # the file of findings that are not shown
    write_baseline: str | None = None  # the file to write the findings to
    log: bytes | None = None  # the end of a log that is explained

    @property
    def saves(self) -> Saves[InspectFormat]:
        """The files to write, with their formats. Raises GraderError."""
        return read_saves(self.save or (), InspectFormat)

    def stated(self, settings: Settings) -> StatedReleases | None:
        """Return the release that the option, or else a setting, gives, and its place."""
        if self.distro is not None:
            return StatedReleases((self.distro,), ("--distro",))
        return settings.stated

    def selection(self, folder: Path) -> Selection:
        """Return which problems are shown, of files whose paths begin in a folder.

        Raises GraderError.
        """
        select = read_codes("--select", self.select or ())
        ignore = read_codes("--ignore", self.ignore or ())
        return Selection(select, ignore, read_settings(self.path), folder)


def inspect_and_save(request: InspectRequest, terminal: Terminal) -> ExitCode:
    """Show an inspection, and save the reports that `--save` names.

    With `--watch`, do so after every change. Return the exit code. Raises GraderError.
    """
    saves = request.saves
    check_saves(saves, (), request.path)
    if request.write_baseline is not None:
        check_file("--write-baseline", Path(request.write_baseline), request.path)
    known = read_baseline(request.baseline) if request.baseline is not None else None
    if not request.watch:
        inspection = inspect_path(request, terminal.warn)
        return _show_and_save(inspection, request, known, terminal.screen(), terminal.print)
    # Late: few inspections are watched.
    from grader.app.commands.repeating import refuse_watching, repeat_on_change, show_round

    refuse_watching(request.path, request.output_format)
    is_first = True

    def work() -> tuple[Inspection, Sequence[Path]]:
        inspection = inspect_path(request, terminal.warn)
        return inspection, inspection.besides

    def show(inspection: Inspection) -> None:
        nonlocal is_first
        look = partial(show_round, terminal=terminal, is_first=is_first, is_whole=request.verbose)
        is_first = False
        _show_and_save(inspection, request, known, terminal.screen(), look)

    own_paths = [file for _, file in saves]
    repeat_on_change([Path(request.path)], own_paths, terminal, INSPECT_SECONDS, work, show)
    return ExitCode.PASSED


def _show_and_save(
    inspection: Inspection,
    request: InspectRequest,
    known: frozenset[str] | None,
    screen: Screen,
    show: Callable[[str], None],
) -> ExitCode:
    """Show and save an inspection without what is known of a baseline.

    Return the exit code, for which what is written to a baseline counts as known.
    """
    verbose = request.verbose
    texts = {}
    if request.write_baseline is not None:
        texts[Path(request.write_baseline)] = baseline_text(inspection)
    if known is not None:
        inspection = without_known(inspection, known)
    for kind, file in request.saves:
        texts[file] = render_inspection(inspection, kind, verbose=verbose)
    show(render_inspection(inspection, request.output_format, screen, verbose=verbose))
    code = inspection_exit_code(inspection, is_known=request.write_baseline is not None)
    if code != ExitCode.NOT_GRADED:
        save_texts(texts, request.path, inspection.besides)
    return code


def inspect_path(request: InspectRequest, warn: Warn) -> Inspection:
    """Return the inspection of the robots and the packages at a path; of one robot, if it is named.

    Raises GraderError.
    """
    return open_and_inspect(request, warn)[0]


def open_and_inspect(request: InspectRequest, warn: Warn) -> tuple[Inspection, OpenedWorkspace]:
    """Return the inspection of what is at a path, and what is opened there. Raises GraderError."""
    selection = request.selection(Path(os.path.realpath(request.path)))
    stated = request.stated(selection.settings)
    arguments = read_arguments(request.arg or ())
    opened = open_workspace(request.path, request.max_size, arguments, stated)
    if opened.is_single:
        return _inspect_file(opened, request, selection, warn), opened
    return inspect_opened(opened, request, selection, warn), opened


def inspect_opened(
    opened: OpenedWorkspace, request: InspectRequest, selection: Selection, warn: Warn
) -> Inspection:
    """Return the inspection of a folder or archive that is opened. Raises GraderError."""
    path = request.path
    joints = request.joint or ()
    relative_to = request.relative_to
    read = [robot for robot in opened.robots if isinstance(robot, Read)]
    unread = [robot for robot in opened.robots if isinstance(robot, Unreadable)]
    recordings = _describe_recordings(opened)
    if not opened.robots and not (opened.packages or opened.ros1_packages or recordings):
        raise InputError(
            f"{printable_path(path)} has neither a URDF nor a package: no file in it has a <robot>"
        )
    for robot in unread:
        warn(robot.reason)
    base = find_base(path, None)
    if request.robot:
        chosen = _named(request.robot, read)
        shown = _inspected(opened, chosen, joints, relative_to)
        inspection = Inspection(chosen.path, (shown,), source_of=opened.source, base=base)
        inspection = _with_log(inspection, opened, request.log)
        return without_ignored(inspection, opened.whole_tree, _list_texts(chosen), selection)
    if (joints or relative_to is not None) and len(read) != 1:
        raise GraderError(_which_one(path, read))
    problems = opened.package_problems()
    is_workspace = bool(opened.robots or opened.packages or opened.ros1_packages)
    extent = opened.extent() if is_workspace else None
    robots = [_inspected(opened, urdf, joints, relative_to, problems) for urdf in read]
    problems += opened.mesh_size_problems()  # last: it takes what is left of the budget
    inspection = Inspection(
        opened.id,
        tuple(robots),
        tuple(problems),
        extent,
        opened.source,
        base,
        recordings=recordings,
        is_posed=bool(joints) or relative_to is not None,
        unread=tuple(unread),
    )
    inspection = _with_log(inspection, opened, request.log)
    return without_ignored(inspection, opened.whole_tree, list(opened.whole_tree.files), selection)


def _inspect_file(
    opened: OpenedWorkspace, request: InspectRequest, selection: Selection, warn: Warn
) -> Inspection:
    """Return the inspection of a URDF on its own. Raises InputError if it cannot be read."""
    urdf = opened.urdf
    if isinstance(urdf, Unreadable):
        raise InputError(urdf.reason)
    assert not isinstance(urdf, Absent)
    for note in (*_notes(urdf), *opened.notes):
        warn(note)
    robot = _inspected(opened, urdf, request.joint or (), request.relative_to)
    folder = find_folder(request.path, opened.path)
    base = find_base(request.path, folder)
    besides = [folder / path for path in opened.besides]
    inspection = Inspection(
        urdf.path, (robot,), source_of=opened.source, base=base, besides=tuple(besides)
    )
    inspection = _with_log(inspection, opened, request.log)
    tree = overlaid(opened.whole_tree, {urdf.path: urdf.data})
    return without_ignored(inspection, tree, _list_texts(urdf), selection._replace(folder=folder))


def _describe_recordings(opened: OpenedWorkspace) -> "tuple[DescribedRecording, ...]":
    """Return what the recordings show. Raises InputError if nothing else is there to be read."""
    if not any(is_recording(path) or path.endswith(METADATA) for path in opened.whole_tree.files):
        return ()
    from grader.workspace.api import describe_recordings  # late: few workspaces have one

    recordings = tuple(describe_recordings(opened))
    is_read = any(recording.facts for recording in recordings)
    if recordings and not (is_read or opened.robots or opened.packages):
        raise InputError(recordings[0].faults[0])
    return recordings


def _with_log(inspection: Inspection, opened: OpenedWorkspace, log: bytes | None) -> Inspection:
    """Return an inspection with what the files say of a log, also by findings that are ignored."""
    if log is None:
        return inspection
    from grader.workspace.api import explain_log  # late: few inspections have a log

    return replace(inspection, log=explain_log(opened, inspection.problems, log))


def _list_texts(urdf: Read) -> list[str]:
    """Return the files that a robot is read from."""
    return list(dict.fromkeys((urdf.path, *getattr(urdf.reading.source, "documents", ()))))


def _notes(urdf: Read) -> Iterator[str]:
    """Yield that a robot was expanded."""
    if urdf.is_expanded and not urdf.as_it_stands:
        extent = "" if urdf.loaded.is_certain else "the part that can be determined of "
        yield f"{urdf.path} is xacro: this is {extent}what xacro expands it to"


def _named(name: str, robots: Sequence[Read]) -> Read:
    """Return the robot with a name, or whose path ends so. Raises GraderError if it is not one."""
    matches = [robot for robot in robots if f"/{robot.path}".endswith(f"/{name.strip('/')}")]
    if not matches:
        models = [(robot, robot.loaded.robot) for robot in robots]
        matches = [robot for robot, model in models if model and model.name == name]
    if len(matches) == 1:
        return matches[0]
    paths = enumerated([robot.path for robot in matches or robots], MAX_NAMED)
    if matches:
        raise GraderError(f"--robot: {name!r} means several: {paths}")
    raise GraderError(f"--robot: there is no robot {name!r}; there are: {paths or 'none'}")


def _which_one(path: str, robots: Sequence[Read]) -> str:
    """Return that joints and frames are those of one robot."""
    if not robots:
        return f"{printable_path(path)} has no URDF: there are no joints and no frames"
    paths = enumerated([robot.path for robot in robots], MAX_NAMED)
    return f"name the robot whose joints and frames are meant with --robot: {paths}"


def _inspected(
    opened: OpenedWorkspace,
    urdf: Read,
    joints: Sequence[str],
    relative_to: str | None,
    of_packages: Sequence[Problem] = (),
) -> InspectedRobot:
    """Return a robot with its joints at given positions.

    Its problems do not repeat those of the packages. Raises GraderError for other joints and
    frames.
    """
    robot = _configuration(urdf.loaded, joints)
    if robot and relative_to is None:
        relative_to = main_root(robot)
    elif robot and relative_to is not None and not robot.robot.has_link(relative_to):
        known = ", ".join(repr(link.name) for link in robot.robot.links[:_MAX_NAMED])
        raise GraderError(f"--relative-to: there is no link {relative_to!r}; the file has: {known}")
    reading = urdf.loaded._replace(problems=opened.problems_once(urdf, of_packages))
    meshes = opened.load_meshes(urdf)
    inspected = InspectedRobot(urdf.path, reading, robot, relative_to, meshes=meshes)
    driven = opened.driven_joints(urdf)
    if not robot or not driven or not all(map(robot.robot.has_joint, driven)):
        return inspected
    from grader.ros.api import describe_driving  # late: few robots name their wheels

    wheels = tuple(robot.robot.joint(joint).child for joint in driven)
    driving = describe_driving(robot, wheels)
    is_course_said = any(problem.rule in _OF_COURSE for problem in of_packages)
    problem = opened.standing_problem(urdf, driving, with_course=not is_course_said)
    if not problem:
        return replace(inspected, driving=driving.text, wheels=wheels)
    reading = reading._replace(problems=(*reading.problems, problem))
    return replace(inspected, reading=reading, wheels=wheels)


def _configuration(urdf: Reading, joints: Sequence[str]) -> Configuration | None:
    positions = dict(map(_read_position, joints))
    if not urdf.robot:
        return None
    try:
        return Configuration(urdf.robot, positions)
    except (MissingElement, NotDecided, ValueError) as error:
        raise GraderError(f"--joint: {error}") from None


def _read_position(text: str) -> tuple[str, float]:
    """Return the joint and its position in radians or metres that `--joint` gives.

    Raises GraderError.
    """
    name, equals, value = text.rpartition("=")
    try:
        position = float(value)
    except ValueError:
        position = nan
    if not equals or not isfinite(position):
        raise GraderError(
            f"--joint takes NAME=VALUE with a number in radians or metres, not {text!r}"
        )
    return name, position
