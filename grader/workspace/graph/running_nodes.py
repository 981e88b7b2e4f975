"""The nodes that run after a launch: what `ros2 node list` would show."""

from collections.abc import Iterator
from typing import Literal, NamedTuple

from grader.base.source import Location
from grader.ros.launch.launch_model import StartedNode
from grader.workspace.graph.started_controllers import (
    defined_controllers,
    spawned_controllers,
)
from grader.workspace.model.launches import CONTROL_NODE, SPAWNERS
from grader.workspace.model.workspace import Workspace

_NodeKind = Literal["program", "controller", "component"]


class RunningNode(NamedTuple):
    """A node that runs, or may run, after a launch file is launched.

    A controller runs in the process of its manager. A component runs in that of a container, which
    may be one of another launch file.
    """

    name: str | None  # with its namespace: /left/driver; None where it is not known
    kind: _NodeKind
    launch: int  # the number of the launch file
    when: bool | None  # as that of a started node
    location: Location  # where it is started, loaded or defined
    process: StartedNode | None  # None for a component and a container
    does_end: bool = False  # whether it ends when it has done its work, as a spawner


def nodes_in(workspace: Workspace, launch: int) -> Iterator[RunningNode]:
    """Yield the nodes of a launch file, unless a condition prevents them. Raises NotDecided."""
    _, file = workspace.launches.roots[launch]
    workspace.charge(1 + len(file.nodes) + len(file.components))
    for node in file.nodes:
        if node.when is False:
            continue
        name = _full_name(node, workspace.code.find_name(node))
        does_end = node.executable in SPAWNERS
        yield RunningNode(name, "program", launch, node.when, node.location, node, does_end)
        if node.executable == CONTROL_NODE:
            yield from _list_controllers(workspace, launch, node)
    places = {node.location for node in file.nodes}
    for container in file.containers:
        if container.when is not False and container.location not in places:
            name, at = container.name, container.location
            yield RunningNode(name, "program", launch, container.when, at, None)
    for component in file.components:
        if component.when is not False:
            yield RunningNode(None, "component", launch, component.when, component.location, None)


def _list_controllers(
    workspace: Workspace, launch: int, manager: StartedNode
) -> Iterator[RunningNode]:
    """Yield the controllers that a launch file spawns, in the process of their manager."""
    spawned = spawned_controllers(workspace, launch)
    for controller in defined_controllers(workspace):
        if controller.name in spawned:
            name, at = _full_name(manager, controller.name), controller.location
            yield RunningNode(name, "controller", launch, manager.when, at, manager)


def _full_name(node: StartedNode, name: str | None) -> str | None:
    """Return the name of a node with the namespace of its process; None where one is not known."""
    if not name or node.namespace is None:
        return None
    return node.full_name(name)
