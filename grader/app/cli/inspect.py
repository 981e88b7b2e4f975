"""grader inspect: robots as ROS 2 reads them, and what is wrong in packages."""

from typing import Annotated

from typer import Argument, Option

from grader.app.cli.options import ArgOption, DistroOption, LogOption, MaxSizeOption, SaveOption
from grader.app.cli.streams import TERMINAL, pass_on
from grader.files.reading import URDF_LIMIT
from grader.report.formats import InspectFormat


def inspect(
    path: Annotated[
        str,
        Argument(
            metavar="[PATH]",
            help="A .urdf file, a package, workspace or archive, or - for standard input.",
            show_default="the current folder",
        ),
    ] = ".",
    robot: Annotated[
        str,
        Option(
            metavar="NAME",
            help="Show this robot of several whole: its name, or the end of its path.",
            show_default=False,
        ),
    ] = "",
    joint: Annotated[
        list[str] | None,
        Option(metavar="NAME=VALUE", help="Position of a joint, in radians or metres; repeatable."),
    ] = None,
    relative_to: Annotated[
        str | None, Option(metavar="LINK", help="The frame of the poses; default: the root.")
    ] = None,
    distro: DistroOption = None,
    output_format: Annotated[
        InspectFormat, Option("--format", help="Output format.")
    ] = InspectFormat.TERMINAL,
    save: SaveOption = None,
    max_size: MaxSizeOption = URDF_LIMIT,
    arg: ArgOption = None,
    watch: Annotated[
        bool,
        Option(
            "--watch",
            help="Inspect again after every change, until Ctrl-C; grader view shows the robot.",
        ),
    ] = False,
    select: Annotated[
        list[str] | None,
        Option(
            metavar="CODE",
            help="Show only problems whose code begins so, such as REF or REF004, or of a "
            "rule; repeatable.",
        ),
    ] = None,
    ignore: Annotated[
        list[str] | None,
        Option(
            metavar="CODE",
            help="Do not show problems whose code begins so, or of a rule; repeatable.",
        ),
    ] = None,
    baseline: Annotated[
        str | None,
        Option(
            metavar="FILE",
            help="Do not show the findings of this file, which --write-baseline wrote.",
        ),
    ] = None,
    write_baseline: Annotated[
        str | None,
        Option(
            metavar="FILE", help="Write the findings, to be shown no more with --baseline; exits 0."
        ),
    ] = None,
    log: LogOption = None,
    verbose: Annotated[
        bool,
        Option(
            "--verbose",
            help="Spell out all problems, and show the tree and the poses of each robot "
            "(terminal).",
        ),
    ] = False,
) -> int:
    """Show robots as ROS 2 reads them, and what is wrong in packages.

    A xacro file is expanded as xacro does, without running it. Of packages it lists what stops a
    build or a launch file, and what does not agree: files, frames, controllers, parameters,
    arguments, programs, topics, services, interfaces and dependencies that are used and not
    defined, or have other types; values that contradict the robot; transforms that are no tree;
    code of nodes that stops or waits; nodes, messages and words that do not fit each other; what
    MoveIt, one machine or another release of ROS 2 has. Errors come first, and each is in the first
    40 rows. Exits 1 if ROS 2 or xacro rejects a robot, if this cannot be determined statically, or
    if something else is certainly wrong.

    With --log, what the files explain of an output in a terminal comes first.

    Examples:

      grader inspect

      grader inspect my_robot.urdf

      grader inspect my_robot.urdf --relative-to base_link

      grader inspect my_robot.urdf --joint base_left_wheel_joint=1.57

      grader inspect my_workspace

      grader inspect my_workspace --robot my_robot

      grader inspect my_workspace --log build.log

      grader inspect my_robot.urdf --format svg > my_robot.svg

      grader inspect my_robot.urdf --format html > my_robot.html
    """
    from grader.app.commands.inspect_urdf import InspectRequest, inspect_and_save

    log_data = None
    if log is not None:
        from grader.app.log_input import read_named_log  # late: few inspections have a log

        log_data = read_named_log(log, path, pass_on)
    request = InspectRequest(
        path=path,
        robot=robot,
        joint=joint,
        relative_to=relative_to,
        distro=distro,
        output_format=output_format,
        save=save,
        max_size=max_size,
        arg=arg,
        watch=watch,
        select=select,
        ignore=ignore,
        verbose=verbose,
        baseline=baseline,
        write_baseline=write_baseline,
        log=log_data,
    )
    return inspect_and_save(request, TERMINAL)
