"""Read the robots at a path as ROS 2 does, with joints at given positions, and what is wrong in the
packages around them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import isfinite, nan

from grader.base.errors import GraderError, InputError, MissingElement, NotDecided
from grader.base.problems import Problem, in_order
from grader.base.text import MAX_NAMED, enumerated, printable_path
from grader.lab.submission.opening import open_workspace
from grader.report.inspection import InspectedRobot, Inspection, main_root
from grader.report.invocation import read_arguments
from grader.report.repository import base_of, folder_of
from grader.report.writing import Warn
from grader.ros.known.releases import Release
from grader.ros.package.mesh_files import mesh_problems
from grader.ros.package.robot_file import Absent, Read, Unreadable
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import Reading
from grader.ros.workspace.opened import OpenedWorkspace

_MAX_NAMED = 20


def inspect(
    path: str,
    joints: Sequence[str],
    relative_to: str | None,
    max_size: int,
    arguments: Sequence[str],
    warn: Warn,
    robot: str = "",
    distro: Release | None = None,
) -> Inspection:
    """Return the inspection of the robots and the packages at a path; of one robot, if it is named;
    for a release, or for those that the packages are for. Raises GraderError.
    """
    given = read_arguments(arguments)
    opened = open_workspace(path, max_size, given)
    if opened.is_single:
        return _inspect_file(opened, path, joints, relative_to, warn)
    read = [it for it in opened.robots if isinstance(it, Read)]
    unread = [it for it in opened.robots if isinstance(it, Unreadable)]
    if not opened.robots and not (opened.packages or opened.ros1_packages):
        raise InputError(
            f"{printable_path(path)} has neither a URDF nor a package: no file in it has a <robot>"
        )
    for reason in [it.reason for it in unread]:
        warn(reason)
    base = base_of(path, None)
    if robot:
        chosen = _named(robot, read)
        shown = _inspected(opened, chosen, joints, relative_to)
        return Inspection(chosen.path, (shown,), source_of=opened.source, base=base)
    if (joints or relative_to is not None) and len(read) != 1:
        raise GraderError(_which_one(path, read))
    robots = tuple(_inspected(opened, it, joints, relative_to) for it in read)
    # Late: most inspections are of a URDF.
    from grader.ros.workspace.extent import extent_of
    from grader.ros.workspace.stated_releases import stated_releases

    stated = stated_releases(opened.whole_tree, distro)
    opened = replace(opened, releases=stated.releases)
    extent = extent_of(opened.workspace, len(unread), stated)
    found = tuple(_package_problems(opened))
    return Inspection(opened.id, robots, found, extent, opened.source, base)


def _inspect_file(
    opened: OpenedWorkspace, path: str, joints: Sequence[str], relative_to: str | None, warn: Warn
) -> Inspection:
    """Return the inspection of a URDF on its own. Raises InputError if it cannot be read."""
    urdf = opened.urdf
    if isinstance(urdf, Unreadable):
        raise InputError(urdf.reason)
    assert not isinstance(urdf, Absent)
    for note in (*_notes(urdf), *opened.notes):
        warn(note)
    robot = _inspected(opened, urdf, joints, relative_to)
    base = base_of(path, folder_of(path, opened.path))
    return Inspection(urdf.path, (robot,), source_of=opened.source, base=base)


def _notes(urdf: Read) -> Iterator[str]:
    """Yield that a robot was expanded."""
    if urdf.is_expanded and urdf.as_it_stands is None:
        extent = "" if urdf.loaded.is_certain else "the part that can be determined of "
        yield f"{urdf.path} is xacro: this is {extent}what xacro expands it to"


def _named(name: str, robots: Sequence[Read]) -> Read:
    """Return the robot with a name, or whose path ends so. Raises GraderError if it is not one."""
    found = [it for it in robots if f"/{it.path}".endswith(f"/{name.strip('/')}")]
    if not found:
        models = [(it, it.loaded.robot) for it in robots]
        found = [it for it, model in models if model is not None and model.name == name]
    if len(found) == 1:
        return found[0]
    paths = enumerated([it.path for it in found or robots], MAX_NAMED)
    if found:
        raise GraderError(f"--robot: {name!r} means several: {paths}")
    raise GraderError(f"--robot: there is no robot {name!r}; there are: {paths or 'none'}")


def _which_one(path: str, robots: Sequence[Read]) -> str:
    """Return that joints and frames are those of one robot."""
    if not robots:
        return f"{printable_path(path)} has no URDF: there are no joints and no frames"
    paths = enumerated([it.path for it in robots], MAX_NAMED)
    return f"name the robot whose joints and frames are meant with --robot: {paths}"


def _inspected(
    opened: OpenedWorkspace, urdf: Read, joints: Sequence[str], relative_to: str | None
) -> InspectedRobot:
    """Return a robot with its joints at given positions. Raises GraderError for other joints and
    frames.
    """
    robot = _configuration(urdf.loaded, joints)
    if robot is not None and relative_to is None:
        relative_to = main_root(robot)
    elif robot is not None and relative_to is not None and not robot.robot.has_link(relative_to):
        known = ", ".join(repr(link.name) for link in robot.robot.links[:_MAX_NAMED])
        raise GraderError(f"--relative-to: there is no link {relative_to!r}; the file has: {known}")
    packages = (*opened.packages, *opened.ros1_packages)
    meshes = mesh_problems(urdf, packages, opened.whole_tree)
    problems = in_order((*urdf.loaded.problems, *meshes))
    reading = urdf.loaded._replace(problems=problems)
    return InspectedRobot(urdf.path, reading, robot, relative_to)


def _package_problems(opened: OpenedWorkspace) -> Iterator[Problem]:
    """Yield what is wrong in packages: their files, then the names that do not agree."""
    # Late: most inspections are of a URDF.
    from grader.ros.workspace.file_problems import listed_problems, ros1_problem
    from grader.ros.workspace.release_problems import compared_names

    for package in opened.ros1_packages:
        yield ros1_problem(package)
    yield from listed_problems(opened.workspace)
    yield from compared_names(opened.workspace)


def _configuration(urdf: Reading, joints: Sequence[str]) -> Configuration | None:
    positions = dict(map(_read_position, joints))
    if urdf.robot is None:
        return None
    try:
        return Configuration(urdf.robot, positions)
    except (MissingElement, NotDecided, ValueError) as error:
        raise GraderError(f"--joint: {error}") from None


def _read_position(text: str) -> tuple[str, float]:
    """Return the joint and its position in radians or metres that `--joint` gives. Raises
    GraderError.
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
