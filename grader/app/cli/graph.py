"""grader graph: nodes, topics, services, actions and transforms of a launch, before it runs."""

from typing import Annotated

import typer

from grader.app.cli.options import MaxSizeOption, SaveOption
from grader.app.cli.streams import TERMINAL
from grader.files.reading import URDF_LIMIT
from grader.report.formats import GraphFormat
from grader.report.invocation import ExitCode
from grader.ros.api import Release

_PATH = "A package, workspace or archive."
_LAUNCH = "The launch file, or the end of its path; default: the one that includes most files."
_ARG = "Value of a launch argument; repeatable."
_DISTRO = "The release of ROS 2, such as humble; default: what the files state."
_NODE = "Show this node and what it connects to."


def graph(
    path: Annotated[
        str, typer.Argument(metavar="[PATH]", help=_PATH, show_default="the current folder")
    ] = ".",
    launch: Annotated[str, typer.Option(metavar="FILE", help=_LAUNCH, show_default=False)] = "",
    arg: Annotated[list[str] | None, typer.Option(metavar="NAME=VALUE", help=_ARG)] = None,
    distro: Annotated[Release | None, typer.Option(metavar="NAME", help=_DISTRO)] = None,
    node: Annotated[str, typer.Option(metavar="NAME", help=_NODE, show_default=False)] = "",
    output_format: Annotated[
        GraphFormat, typer.Option("--format", help="Output format.")
    ] = GraphFormat.TEXT,
    save: SaveOption = None,
    max_size: MaxSizeOption = URDF_LIMIT,
) -> int:
    """Show the graph of a launch file, before anything runs.

    It has the nodes that are started, their topics, services and actions with types and what is at
    the other end, and the transforms: what `ros2 node list`, `ros2 topic info` and `view_frames`
    show of a running system. Nothing is run. Findings of inspect stand at the ends that they
    concern. What depends on a run, such as a condition, is dashed. It does not show /rosout,
    /parameter_events, /tf and the services of parameters. Exits as inspect.

    Examples:

      grader graph

      grader graph my_workspace --launch bringup.launch.py

      grader graph my_workspace --arg use_sim_time:=true

      grader graph my_workspace --node /slam_toolbox

      grader graph my_workspace --format mermaid > graph.mmd
    """
    from grader.app.commands.show_graph import GraphRequest, graph_and_save

    request = GraphRequest(
        path=path,
        launch=launch,
        arg=arg,
        distro=distro,
        node=node,
        output_format=output_format,
        save=save,
        max_size=max_size,
    )
    return ExitCode.PASSED if graph_and_save(request, TERMINAL) else ExitCode.FAILED
