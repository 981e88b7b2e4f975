"""grader inspect: what ROS 2 makes of a URDF."""

from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from grader.cli.options import MaxSizeOption
from grader.cli.output import complain, emit, show
from grader.errors import GraderError, InputError, MissingElement
from grader.files.reading import URDF_LIMIT
from grader.text import printable_path

if TYPE_CHECKING:
    from grader.robot.kinematics import Configuration
    from grader.robot.motion import Position
    from grader.robot.reader import Reading

_ANY_URDF = "robot.urdf"


class InspectFormat(StrEnum):
    """The formats of an inspection."""

    TERMINAL = "terminal"
    JSON = "json"


def inspect(
    path: Annotated[
        str, typer.Argument(metavar="PATH", help="A .urdf file, a folder or archive with one in it, or -.")
    ],
    joint: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help="Put a joint at this position, in radians or metres; repeatable."),
    ] = None,
    relative_to: Annotated[
        str | None, typer.Option(metavar="LINK", help="The frame that poses are given in; the root unless told.")
    ] = None,
    output_format: Annotated[
        InspectFormat, typer.Option("--format", help="The format on standard output.")
    ] = InspectFormat.TERMINAL,
    max_size: MaxSizeOption = URDF_LIMIT,
) -> int:
    """Show a URDF as ROS 2 reads it: problems, tree, joints, poses.

    Exits 1 if ROS 2 rejects the file. A planar joint takes x,y,angle and a floating one x,y,z,roll,pitch,yaw.

    Examples:

      grader inspect my_robot.urdf

      grader inspect my_robot.urdf --relative-to base_link

      grader inspect my_robot.urdf --joint base_left_wheel_joint=1.57
    """
    from grader.report.inspection import Inspection, inspection_json, inspection_terminal, main_root
    from grader.submission.submission import open_submission
    from grader.submission.urdf import Absent, Read, Unreadable

    submission = open_submission(path, wanted=_ANY_URDF, limit=max_size)
    match urdf := submission.urdf:
        case Unreadable(reason=reason):
            raise InputError(reason)
        case Absent():
            raise InputError(f"{printable_path(path)} holds no URDF: no file has a <robot> in it")
    if submission.other_candidates:
        complain(f"inspected {urdf.path}; passed over {', '.join(each.path for each in submission.other_candidates)}")
    if isinstance(urdf, Read) and urdf.is_expanded:
        complain(f"{urdf.path} is xacro: its properties and numbers were worked out first")
    robot = _configure(urdf.reading, joint or [])
    frame = relative_to
    if robot is not None and frame is None:
        frame = main_root(robot)
    elif robot is not None and frame is not None and not robot.robot.has_link(frame):
        known = ", ".join(repr(link.name) for link in robot.robot.links[:20])
        raise GraderError(f"--relative-to: there is no link {frame!r}; the file has: {known}")
    inspection = Inspection(urdf.path, urdf.reading, robot, frame)
    if output_format is InspectFormat.JSON:
        emit(inspection_json(inspection))
    else:
        show(partial(inspection_terminal, inspection))
    return 1 if urdf.reading.verdict == "rejected" else 0


def _configure(urdf: "Reading", given: list[str]) -> "Configuration | None":
    from grader.robot.kinematics import Configuration

    positions = dict(_position(each) for each in given)
    if urdf.robot is None:
        return None
    try:
        return Configuration(urdf.robot, positions)
    except (MissingElement, ValueError) as error:
        raise GraderError(f"--joint: {error}") from None


def _position(text: str) -> "tuple[str, Position]":
    from math import isfinite

    name, equals, value = text.rpartition("=")
    try:
        values = tuple(float(each) for each in value.split(","))
    except ValueError:
        values = (float("nan"),)
    if not equals or not all(map(isfinite, values)):
        raise GraderError(f"--joint takes NAME=VALUE with a number in radians or metres, not {text!r}")
    return name, values if len(values) > 1 else values[0]
