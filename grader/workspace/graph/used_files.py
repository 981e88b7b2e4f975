"""The files of a workspace by what they are used for, whatever their names are."""

from collections.abc import Callable, Mapping

from grader.base.errors import MissingElement, NotDecided
from grader.base.text import MAX_NAMED, enumerated
from grader.ros.package.package import Package
from grader.workspace.graph.bridge_rows import BRIDGE, rows_of_bridge
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.graph.started_worlds import started_worlds
from grader.workspace.model.workspace import Workspace


def used_file(workspace: Workspace, use: str) -> tuple[Package, str]:
    """Return the file that is used for something, as a package and a path in it.

    Raises MissingElement without one, NotDecided of several.
    """
    reader, missing = _USES[use]
    paths = [*dict.fromkeys(reader(workspace))]
    if not paths:
        raise MissingElement("file", use, message=missing)
    if len(paths) > 1:
        cause = "several files have this use"
        raise NotDecided(f"{cause}: {enumerated(paths, MAX_NAMED)}", cause)
    package = next(package for package in workspace.packages if package.holds(paths[0]))
    return package, paths[0].removeprefix(package.path(""))


def _world_paths(workspace: Workspace) -> list[str]:
    return [file.source.path for file in started_worlds(workspace).files]


def _controller_paths(workspace: Workspace) -> list[str]:
    return [controller.location.path for controller in defined_controllers(workspace)]


def _bridge_paths(workspace: Workspace) -> list[str]:
    paths = []
    for _, node in workspace.launches.nodes:
        if node.package == BRIDGE:
            for row in rows_of_bridge(workspace, node):
                if row.location != node.location:  # an argument
                    paths.append(row.location.path)
    return paths


_USES: Mapping[str, tuple[Callable[[Workspace], list[str]], str]] = {
    "@world": (_world_paths, "no launch file names a world of the packages"),
    "@controllers": (
        _controller_paths,
        "no parameter file of the packages defines controllers",
    ),
    "@bridge": (_bridge_paths, "no bridge is given a file of the packages"),
}
