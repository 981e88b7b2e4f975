"""The files of a workspace by what they are used for, whatever their names are."""

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
    if use in _USES:
        reader, missing = _USES[use]
        paths = reader(workspace)
    else:
        node = use.removeprefix("@parameters/")
        paths = _paths_given(workspace, node)
        missing = f"no launch file gives parameter files to {node}"
    paths = list(dict.fromkeys(paths))
    if not paths:
        raise MissingElement("file", use, message=missing)
    if len(paths) > 1:
        cause = "several files have this use"
        raise NotDecided(f"{cause}: {enumerated(paths, MAX_NAMED)}", cause)
    package = next(package for package in workspace.packages if package.holds(paths[0]))
    return package, paths[0].removeprefix(package.path(""))


def _paths_given(workspace: Workspace, name: str) -> list[str]:
    """Return the parameter files that nodes of a name are given."""
    find_name = workspace.code.find_name
    files = workspace.parameters.files
    return [path for path, nodes in files.items() if name in map(find_name, nodes)]


def _world_paths(workspace: Workspace) -> list[str]:
    return [file.source.path for file in started_worlds(workspace).files]


def _controller_paths(workspace: Workspace) -> list[str]:
    return [controller.location.path for controller in defined_controllers(workspace)]


def _bridge_paths(workspace: Workspace) -> list[str]:
    paths = []
    for node in workspace.launches.nodes:
        if node.package == BRIDGE:
            for row in rows_of_bridge(workspace, node):
                if row.location != node.location:  # an argument
                    paths.append(row.location.path)
    return paths


_USES = {
    "@world": (_world_paths, "no launch file names a world of the packages"),
    "@controllers": (
        _controller_paths,
        "no parameter file of the packages defines controllers",
    ),
    "@bridge": (_bridge_paths, "no bridge is given a file of the packages"),
}
