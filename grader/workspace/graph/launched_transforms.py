"""The transforms that are published after a launch file is launched, also by own code.

A node of own code is read with what it gives to a broadcaster, so that each frame has its parent.
"""

from collections.abc import Collection, Iterator

from grader.ros.known.end_rows import opened_ends
from grader.ros.known.package_rows import find_transforms, package_row
from grader.ros.launch.launch_model import StartedNode
from grader.ros.package.static_transforms import STATIC_PUBLISHER
from grader.workspace.graph.bridge_rows import BRIDGE
from grader.workspace.graph.code_ends import transforms_sent
from grader.workspace.graph.gazebo_topics import name_system, roots
from grader.workspace.graph.launch_graph import (
    GraphNode,
    GraphTransform,
    LaunchGraph,
    Unread,
)
from grader.workspace.graph.started_controllers import spawned_by
from grader.workspace.graph.transform_edges import (
    edges_in,
    frames_of_system,
    publishes_as_named,
    topics_of_transforms,
)
from grader.workspace.model.text_files import CODE_ENDINGS
from grader.workspace.model.workspace import Workspace

_SENDING = ("sendTransform", "TFMessage")
_SIMULATORS = ("gazebo_ros", "gazebo_plugins")  # whose plug-ins publish what their elements say
_MANAGING = ("ros2_control_node", "spawner")  # whose controllers are nodes of their own
_PUBLISHING = ("tf2_ros", "robot_state_publisher")  # also as components


def transforms_in(
    workspace: Workspace, number: int, without: Collection[str] = ()
) -> Iterator[GraphTransform]:
    """Yield the transforms of a launch file; a frame that is not known is empty.

    `number` is that of the launch file among the roots; `without` has the names of programs that
    cannot run. Raises NotDecided.
    """
    launch = workspace.launches.outermost[number]
    not_started = {node.location for node in launch.nodes if node.when is False}
    for edge in edges_in(workspace, number):
        if edge.source != "code" and edge.location not in not_started:
            yield edge
    for node in launch.nodes:
        if node.when is False or node.name in without:
            continue
        yield from _bridged_by_default(workspace, node)
        for facts in workspace.code.find_nodes(node):
            for parent, child, sent in transforms_sent(workspace, node, facts):
                is_certain = publishes_as_named(node) and not sent.is_conditional
                is_certain = is_certain and bool(parent and child)
                yield GraphTransform(
                    parent,
                    child,
                    "code",
                    is_certain,
                    node.executable,
                    sent.location,
                    sent.is_static,
                    sent.pose,
                )


def _bridged_by_default(workspace: Workspace, node: StartedNode) -> Iterator[GraphTransform]:
    """Yield the transforms of systems of Gazebo on their default topic that a bridge publishes.

    It is /model/NAME/tf, with the name of the model, which is that of the robot by default.
    """
    topics = topics_of_transforms(workspace, node) if node.package == BRIDGE else ()
    for root, place in roots(workspace) if topics else ():
        for plugin in root.iter("plugin"):
            frames = frames_of_system(plugin) if plugin.find("tf_topic") is None else None
            if frames is not None:
                by = f"the system {name_system(plugin)} of Gazebo"
                is_certain = f"model/{root.get('name')}/tf" in topics and node.when is True
                yield GraphTransform(*frames, "Gazebo", is_certain, by, place(plugin))


def is_for_transforms(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether a program is known to publish transforms, or does nothing else."""
    program = node.program
    if program == STATIC_PUBLISHER or find_transforms("/".join(program)):
        return True
    own_nodes = workspace.code.find_nodes(node)
    return bool(own_nodes) and not any(facts.endpoints for facts in own_nodes)


def unread_transforms(
    workspace: Workspace, number: int, graph: LaunchGraph, without: Collection[str] = ()
) -> Iterator[Unread]:
    """Yield what may publish transforms that are not known, and where it is started.

    `graph` is that of the launch file, without programs that cannot run.
    """
    launch = workspace.launches.outermost[number]
    yield from graph.unread
    managing = _MANAGING if spawned_by(launch).is_known else ()
    for transform in transforms_in(workspace, number, without):
        if not (transform.parent and transform.child) and transform.by not in managing:
            yield Unread(f"a frame of {transform.by} is not known", transform.location)
    own_programs = set()
    read_at = {node.location for node in launch.nodes if not node.is_component}
    for node in launch.nodes:
        reason = ""
        if node.when is False or node.name in without:
            continue
        if workspace.find_package(node):
            own_programs.add(node.name)
            reason = _why_own_is_unread(workspace, node)
        elif node.package == BRIDGE and topics_of_transforms(workspace, node):
            reason = "the transforms of Gazebo are not read"
        if reason:
            yield Unread(reason, node.location)
    for graph_node in graph.nodes:
        is_own = graph_node.program in own_programs or graph_node.kind == "container"
        if not is_own and _may_publish(graph_node, is_read=graph_node.location in read_at):
            reason = f"which transforms {graph_node.program} publishes is not known"
            yield Unread(reason, graph_node.location)


def _why_own_is_unread(workspace: Workspace, node: StartedNode) -> str:
    """Return why own code may publish transforms that are not known; empty if it may not."""
    own_nodes = workspace.code.find_nodes(node)
    if not own_nodes:
        return f"the code of {node.executable} is not read"
    for facts in own_nodes:
        if facts.doubts:
            return facts.doubts[0].reason
    package = workspace.find_package(node)
    assert package  # that has the code
    code = workspace.code.by_package[package.name]
    read = {sent.location.path for facts in code.nodes for sent in facts.transforms}
    for source in workspace.texts.read_sources(package, CODE_ENDINGS):
        if source.path not in read and any(word in source.text for word in _SENDING):
            return f"what {source.path} publishes is not known"
    return ""


def _may_publish(node: GraphNode, *, is_read: bool) -> bool:
    """Return whether a node of another package may publish transforms that are not known.

    What a Node of the launch file says of its own is read.
    """
    package, _, program = node.program.rpartition("/")
    package = package or program
    row = package_row(package)
    if node.kind == "controller":
        return bool(node.opens_more or row.publishes_transforms)
    is_open = "frames" not in row.without
    if package in _SIMULATORS or (is_open and not opened_ends(package, program)):
        return True
    if node.kind == "component":
        programs = row.program.values()
        publishes = package in _PUBLISHING or any(each.transforms for each in programs)
    else:
        publishes = bool(find_transforms(node.program))
    return not is_read and (is_open or publishes)
