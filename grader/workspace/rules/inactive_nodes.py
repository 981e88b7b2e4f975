"""Nodes with a lifecycle that launch files start, and that nothing configures and activates."""

from grader.base.names import last_part
from grader.ros.launch.launch_model import StartedNode
from grader.ros.package.package import Package
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.lifecycle import (
    LIFECYCLE_MANAGERS,
    are_nodes_activated,
    find_stuck_nodes,
    has_lifecycle,
)
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Facts, warning
from grader.workspace.rules.rule_table import NO_COMPANION, Rule

_STARTS_ITSELF = "autostart_node"  # a parameter of the nodes of Nav2

_NODE_ACTIVATED = Rule(
    "node-activated",
    "wiring",
    NO_COMPANION,
    "Something configures and activates each lifecycle node that a launch file starts.",
    why=(
        "The node stays unconfigured: ros2 node list shows it, but it reads and publishes nothing. "
        "No error is printed."
    ),
    wrong="""
Node(package='nav2_map_server', executable='map_server', name='map_server'),
Node(package='nav2_lifecycle_manager', executable='lifecycle_manager', name='lifecycle_manager',
     parameters=[{'autostart': True, 'node_names': ['amcl']}]),
""",
    right="""
Node(package='nav2_map_server', executable='map_server', name='map_server'),
Node(package='nav2_lifecycle_manager', executable='lifecycle_manager', name='lifecycle_manager',
     parameters=[{'autostart': True, 'node_names': ['map_server']}]),
""",
)


def inactive_node_facts(workspace: Workspace) -> Facts:
    """Yield the lifecycle nodes that certainly are started, and that no manager names.

    An event of a launch file, code or a command may activate any, and so may what is not read. A
    person may activate an own node, if there is no manager.
    """
    for launch in workspace.launches.outermost:
        for stuck in find_stuck_nodes(workspace, launch):
            message = (
                f"no event activates this lifecycle node, which stays {stuck.state}: what "
                "activates it waits for a state that it never reaches"
            )
            yield warning(_NODE_ACTIVATED, message, stuck.waiting, stuck.node)
    nodes = [pair for pair in workspace.launches.placed_nodes if has_lifecycle(workspace, pair[1])]
    if not nodes or are_nodes_activated(workspace) is not False:
        return
    managed = _managed_names(workspace)
    if managed is None or _may_start_others(workspace):
        return
    for package, node in nodes:
        name = workspace.code.find_name(node)
        is_of_person = not managed and workspace.find_package(node) is not None
        if name in managed or is_of_person or _may_be_open(workspace, package, node):
            continue
        if node.when and name is not None:
            message = (
                f"nothing configures and activates the lifecycle node {name}: name it in "
                "node_names of a lifecycle manager"
            )
            yield warning(_NODE_ACTIVATED, message, node.location)


def _managed_names(workspace: Workspace) -> set[str] | None:
    """Return the names of the nodes that managers lead; None where not all are known."""
    managed: set[str] = set()
    for package, node in workspace.launches.placed_nodes:
        if node.executable in LIFECYCLE_MANAGERS:
            given = workspace.parameters.given_to(package, node)
            names = given.values.get("node_names")
            if given.unknown or not names or not isinstance(names.value, list):
                return None
            managed.update(last_part(str(name)) for name in names.value)
    return managed


def _may_start_others(workspace: Workspace) -> bool:
    """Return whether a launch starts what is not read, or a command of ROS 2."""
    for graph in make_graph(workspace).launched:
        if graph.unread or any(process.program.startswith("ros2 ") for process in graph.processes):
            return True
    return False


def _may_be_open(workspace: Workspace, package: Package, node: StartedNode) -> bool:
    """Return whether a node may start itself: by a parameter, or by one that is not known."""
    given = workspace.parameters.given_to(package, node)
    return bool(given.unknown) or _STARTS_ITSELF in given.values
