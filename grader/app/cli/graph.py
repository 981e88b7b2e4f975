"""grader graph: nodes, topics, services, actions and transforms of a launch, before it runs."""

from typing import Annotated

from typer import Argument, Option

from grader.app.cli.options import DistroOption, MaxSizeOption, SaveOption
from grader.app.cli.streams import TERMINAL
from grader.files.reading import URDF_LIMIT
from grader.report.formats import GraphFormat


def graph(
    path: Annotated[
        str,
        Argument(
            metavar="[PATH]",
            help="A package, workspace or archive.",
            show_default="the current folder",
        ),
    ] = ".",
    launch: Annotated[
        str,
        Option(
            metavar="FILE",
            help="The launch file, or the end of its path; default: the one that includes most "
            "files.",
            show_default=False,
        ),
    ] = "",
    arg: Annotated[
        list[str] | None,
        Option(metavar="NAME=VALUE", help="Value of a launch argument; repeatable."),
    ] = None,
    distro: DistroOption = None,
    node: Annotated[
        str,
        Option(metavar="NAME", help="Show this node and what it connects to.", show_default=False),
    ] = "",
    connected: Annotated[
        bool, Option("--connected", help="Show only what connects to something else.")
    ] = False,
    verbose: Annotated[
        bool,
        Option("--verbose", help="Also show parameters, and services that nothing asks for."),
    ] = False,
    recorded: Annotated[
        str,
        Option(
            metavar="PATH",
            help="Compare topics with this recording of `ros2 bag record`.",
            show_default=False,
        ),
    ] = "",
    output_format: Annotated[
        GraphFormat, Option("--format", help="Output format.")
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

      grader graph my_workspace --recorded drive
    """
    from grader.app.commands.show_graph import GraphRequest, graph_and_save

    request = GraphRequest(
        path=path,
        launch=launch,
        arg=arg,
        distro=distro,
        node=node,
        connected=connected,
        verbose=verbose,
        output_format=output_format,
        save=save,
        max_size=max_size,
        recorded=recorded,
    )
    return graph_and_save(request, TERMINAL)
