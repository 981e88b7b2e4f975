"""Read a URDF as ROS 2 does, with its joints at given positions, and the names in the packages
around it.
"""

from collections.abc import Sequence
from math import isfinite, nan

from grader.base.errors import GraderError, InputError, MissingElement, NotDecided
from grader.base.problems import Problem, in_order
from grader.base.text import printable_path
from grader.lab.submission.opening import open_workspace
from grader.report.inspection import Inspection, main_root
from grader.report.invocation import read_arguments
from grader.report.repository import base_of, folder_of
from grader.report.writing import Warn
from grader.ros.package.mesh_files import mesh_problems
from grader.ros.package.robot_file import Absent, Unreadable
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
) -> Inspection:
    """Return the inspection of the URDF and the packages at a path. Raises GraderError."""
    given = read_arguments(arguments)
    opened = open_workspace(path, max_size, given).without_part()
    base = base_of(path, folder_of(path, opened.path) if opened.is_single else None)
    match urdf := opened.urdf:
        case Unreadable(reason=reason):
            raise InputError(reason)
        case Absent() if opened.packages and (joints or relative_to is not None):
            raise GraderError(
                f"{printable_path(path)} has no URDF: there are no joints and no frames"
            )
        case Absent() if opened.packages:
            names = _name_problems(opened)
            return Inspection(opened.id, None, names=names, source_of=opened.source, base=base)
        case Absent():
            raise InputError(
                f"{printable_path(path)} has neither a URDF nor a package: no file in it "
                "has a <robot>"
            )
    if opened.other_candidates:
        others = ", ".join(file.path for file in opened.other_candidates)
        warn(f"inspecting {urdf.path}; other candidates: {others}")
    if urdf.is_expanded and urdf.as_it_stands is None:
        extent = "" if urdf.loaded.is_certain else "the part that can be determined of "
        warn(f"{urdf.path} is xacro: this is {extent}what xacro expands it to")
    for note in opened.notes if opened.is_single else ():
        warn(note)
    robot = _configuration(urdf.loaded, joints)
    if robot is not None and relative_to is None:
        relative_to = main_root(robot)
    elif robot is not None and relative_to is not None and not robot.robot.has_link(relative_to):
        known = ", ".join(repr(link.name) for link in robot.robot.links[:_MAX_NAMED])
        raise GraderError(f"--relative-to: there is no link {relative_to!r}; the file has: {known}")
    meshes = mesh_problems(urdf, opened.packages, opened.whole_tree)
    problems = in_order((*urdf.loaded.problems, *meshes))
    reading = urdf.loaded._replace(problems=problems)
    return Inspection(
        urdf.path, reading, robot, relative_to, _name_problems(opened), opened.source, base
    )


def _name_problems(opened: OpenedWorkspace) -> tuple[Problem, ...]:
    """Return the names in packages that do not agree; none of a URDF on its own."""
    if not opened.packages:
        return ()
    from grader.ros.workspace.name_problems import (
        name_problems,  # late: most inspections are of a URDF
    )
    from grader.ros.workspace.reading import read_agreement

    return name_problems(read_agreement(opened.workspace))


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
