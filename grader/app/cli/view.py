"""grader view: the robot in 3-D in the browser, beside the editor."""

from typing import Annotated

from typer import Argument

from grader.app.cli.options import (
    ArgOption,
    LogOption,
    MaxSizeOption,
    NoBrowserOption,
    PortOption,
    rubric_option,
)
from grader.app.cli.streams import TERMINAL, pass_on
from grader.files.reading import URDF_LIMIT

_RUBRIC = "Show the mistakes under this rubric, an id or a .toml file; default: the problems."


def view(
    path: Annotated[
        str,
        Argument(
            metavar="[PATH]",
            help="A .urdf or .xacro file, package, workspace, repository, .zip or .tar.gz.",
            show_default="the current folder",
        ),
    ] = ".",
    rubric: Annotated[str, rubric_option(_RUBRIC)] = "",
    arg: ArgOption = None,
    log: LogOption = None,
    max_size: MaxSizeOption = URDF_LIMIT,
    port: PortOption = 0,
    no_browser: NoBrowserOption = False,
) -> str:
    """Show a robot in 3-D in the browser, again after every change.

    The command prints the address of the page, which works on this machine only, and opens it.
    Turn the robot, and move its joints; save a file, and the page follows, with the camera and the
    joints as they were. Of a file that is broken, the page shows the problem with its line, above
    the last robot that ROS 2 loads. Arguments of xacro can be tried on the page; no file changes.
    With --rubric the page is the report of grade, with the mistakes in red and the reference;
    otherwise it lists the problems of inspect. A recording of `ros2 bag record` moves the robot,
    with the messages of --log on its time line. Ctrl-C ends it.

    Examples:

      grader view

      grader view src/my_robot --rubric lab6

      grader view my_robot.urdf.xacro --arg wheels=4

      grader view src/my_robot/drive --log run.log
    """
    from grader.app.commands.view_server import view_in_browser
    from grader.app.commands.viewed_robots import ViewRequest

    log_data = None
    if log is not None:
        from grader.app.log_input import read_named_log  # late: few views have a log

        log_data = read_named_log(log, path, pass_on)
    request = ViewRequest(path, rubric, arg or (), max_size, log_data)
    return view_in_browser(request, port, TERMINAL, opens=not no_browser)
