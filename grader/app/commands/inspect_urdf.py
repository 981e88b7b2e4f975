"""Read a URDF as ROS 2 does, with its joints at given positions, and the names in the packages
around it.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import isfinite, nan

from grader.base.errors import GraderError, InputError, MissingElement, NotDecided
from grader.base.problems import Problem, in_order
from grader.base.text import printable_path
from grader.lab.checks.meshes import mesh_problems
from grader.lab.submission.opening import open_submission
from grader.lab.submission.submission import Lab, Opening, Submission
from grader.report.inspection import Inspection, main_root
from grader.report.invocation import read_arguments
from grader.report.repository import base_of, folder_of
from grader.report.writing import Warn
from grader.ros.package.robot_file import Absent, Read, Unreadable
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import Reading
from grader.ros.urdf.urdf_problems import NO_LINKS, ROBOT_WITHOUT_NAME

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
    submission = open_submission(
        path, Lab("robot.urdf"), Opening(max_size, given), with_neighbours=True
    )
    submission = _without_part(submission)
    base = base_of(path, folder_of(path, submission.path) if submission.is_single else None)
    match urdf := submission.urdf:
        case Unreadable(reason=reason):
            raise InputError(reason)
        case Absent() if submission.packages and (joints or relative_to is not None):
            raise GraderError(
                f"{printable_path(path)} has no URDF: there are no joints and no frames"
            )
        case Absent() if submission.packages:
            names = _name_problems(submission)
            return Inspection(
                submission.id, None, names=names, source_of=submission.source, base=base
            )
        case Absent():
            raise InputError(
                f"{printable_path(path)} has neither a URDF nor a package: no file in it "
                "has a <robot>"
            )
    if submission.other_candidates:
        others = ", ".join(file.path for file in submission.other_candidates)
        warn(f"inspecting {urdf.path}; other candidates: {others}")
    if urdf.is_expanded and urdf.as_it_stands is None:
        extent = "" if urdf.loaded.is_certain else "the part that can be determined of "
        warn(f"{urdf.path} is xacro: this is {extent}what xacro expands it to")
    for note in submission.notes if submission.is_single else ():
        warn(note)
    robot = _configuration(urdf.loaded, joints)
    if robot is not None and relative_to is None:
        relative_to = main_root(robot)
    elif robot is not None and relative_to is not None and not robot.robot.has_link(relative_to):
        known = ", ".join(repr(link.name) for link in robot.robot.links[:_MAX_NAMED])
        raise GraderError(f"--relative-to: there is no link {relative_to!r}; the file has: {known}")
    problems = in_order((*urdf.loaded.problems, *mesh_problems(submission, urdf)))
    reading = urdf.loaded._replace(problems=problems)
    return Inspection(
        urdf.path, reading, robot, relative_to, _name_problems(submission), submission.source, base
    )


def _without_part(submission: Submission) -> Submission:
    """Return packages as such without a robot, where the best candidate is xacro without links that
    nothing loads.
    """
    urdf = submission.urdf
    if (
        submission.is_single
        or not submission.packages
        or not isinstance(urdf, Read)
        or not urdf.is_expanded
    ):
        return submission
    errors = {problem.kind for problem in urdf.problems if problem.severity == "error"}
    name = urdf.path.rpartition("/")[2]
    is_part = NO_LINKS in errors and errors <= {NO_LINKS, ROBOT_WITHOUT_NAME}
    is_loaded = any(package.robot_references(name) for package in submission.packages)
    if is_part and not is_loaded:
        return replace(submission, urdf=Absent())
    return submission


def _name_problems(submission: Submission) -> tuple[Problem, ...]:
    """Return the names in packages that do not agree; none of a URDF on its own."""
    if not submission.packages:
        return ()
    from grader.ros.workspace.name_problems import (
        name_problems,  # late: most inspections are of a URDF
    )
    from grader.ros.workspace.reading import read_agreement

    return name_problems(read_agreement(submission.workspace))


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
