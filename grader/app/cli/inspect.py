"""grader inspect: a URDF as ROS 2 reads it, and the names in packages."""

from typing import Annotated

import typer

from grader.app.cli.options import ArgOption, MaxSizeOption
from grader.app.cli.streams import screen, warn
from grader.files.reading import URDF_LIMIT
from grader.report.formats import InspectFormat, render_inspection
from grader.report.invocation import ExitCode
from grader.report.writing import write_stdout

_PATH = "A .urdf file, a package, workspace or archive, or - for standard input."
_JOINT = "Position of a joint, in radians or metres; repeatable."
_RELATIVE = "The frame of the poses; default: the root."


def inspect(
    path: Annotated[str, typer.Argument(metavar="PATH", help=_PATH)],
    joint: Annotated[list[str] | None, typer.Option(metavar="NAME=VALUE", help=_JOINT)] = None,
    relative_to: Annotated[str | None, typer.Option(metavar="LINK", help=_RELATIVE)] = None,
    output_format: Annotated[
        InspectFormat, typer.Option("--format", help="Output format.")
    ] = InspectFormat.TERMINAL,
    max_size: MaxSizeOption = URDF_LIMIT,
    arg: ArgOption = None,
) -> int:
    """Show a URDF as ROS 2 reads it: problems, tree, joints, poses.

    A xacro file is expanded as xacro does, without running it. Of packages it also lists the names
    that files use and nothing defines: files, frames, controllers, parameters, arguments, programs,
    topics, dependencies. Exits 1 if ROS 2 or xacro rejects the file, if this cannot be determined
    statically, or if a name is certainly wrong.

    Examples:

      grader inspect my_robot.urdf

      grader inspect my_robot.urdf --relative-to base_link

      grader inspect my_robot.urdf --joint base_left_wheel_joint=1.57

      grader inspect my_workspace

      grader inspect my_robot.urdf --format svg > my_robot.svg

      grader inspect my_robot.urdf --format html > my_robot.html
    """
    from grader.app.commands.inspect_urdf import inspect as read

    inspection = read(path, joint or [], relative_to, max_size, arg or [], warn)
    write_stdout(render_inspection(inspection, output_format, screen()))
    return ExitCode.PASSED if inspection.is_passed else ExitCode.FAILED
