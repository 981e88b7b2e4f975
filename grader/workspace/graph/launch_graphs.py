"""The graphs of the launch files of a workspace."""

from dataclasses import replace

from grader.workspace.graph.launch_graph import LaunchGraph
from grader.workspace.graph.started_graph import included_files, started_graph
from grader.workspace.model.workspace import Workspace


def launch_files(workspace: Workspace) -> list[str]:
    """Return the paths of the launch files: first those that no other one includes.

    Of these, the one that includes most files is the first, then the one that starts most nodes.
    """
    roots = sorted(
        (launch for launch in workspace.launches.outermost),
        key=lambda launch: (-included_files(launch), -len(launch.nodes), launch.source.path),
    )
    paths = [launch.source.path for launch in roots]
    others = sorted(launch.source.path for launch in workspace.launches.every)
    return list(dict.fromkeys(paths + others))


def launch_graph(workspace: Workspace, path: str) -> LaunchGraph:
    """Return what runs after a launch file of the workspace is launched on its own."""
    return started_graph(*launched_alone(workspace, path))


def launched_alone(workspace: Workspace, path: str) -> tuple[Workspace, int]:
    """Return a workspace in which a launch file is among the roots, and its number there."""
    roots = [launch.source.path for launch in workspace.launches.outermost]
    if path in roots:
        return workspace, roots.index(path)
    return replace(workspace, launched=path), 0
