"""The transforms that nodes publish, or may publish, as launch files start them.

They are what `ros2 run tf2_tools view_frames` would show.
"""

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from typing import Any

from grader.base.grouping import Strings
from grader.base.text import quoted
from grader.ros.known.gazebo_rows import NO_SYSTEM, gazebo
from grader.ros.known.package_rows import DecidingParameter, find_transforms, package_row
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import NodeParameters
from grader.ros.package.package import Package
from grader.ros.package.static_transforms import (
    STATIC_PUBLISHER,
    frames_named,
    has_zero_rotation,
    static_pose,
)
from grader.ros.python.values import Unknown
from grader.ros.xml.parsing import Element
from grader.workspace.graph.bridge_rows import PARAMETER_BRIDGE, rows_of_bridge
from grader.workspace.graph.code_ends import list_frames
from grader.workspace.graph.gazebo_topics import name_system, roots
from grader.workspace.graph.included_nodes import included_nodes
from grader.workspace.graph.launch_graph import GraphTransform
from grader.workspace.graph.started_controllers import defined_controllers, spawned_controllers
from grader.workspace.model.workspace import Workspace

_TF = "/tf"
_OF_ROBOT = 100  # parts of searching the plugins of a robot or a world
_MOVING = ("revolute", "continuous", "prismatic")
_PUBLISHED = ("publishes", "is above")


def _edges_of_publishers(
    workspace: Workspace, publishers: Sequence[StartedNode]
) -> Iterator[GraphTransform]:
    """Yield the joints of the robots that robot_state_publishers of a launch file publish."""
    is_certain = any(not node.frame_prefix and publishes_as_named(node) for node in publishers)
    topics = [node.topic("joint_states") for node in publishers]
    states = tuple(topic for topic in topics if topic is not None)
    yield from _edges_of_robots(workspace, states, is_certain)


def edges_in(workspace: Workspace, launch: int) -> Iterator[GraphTransform]:
    """Yield the transforms of the nodes and controllers of a launch file. Raises NotDecided."""
    package, file = workspace.launches.roots[launch]
    workspace.charge(1 + len(file.nodes))
    publishers = []
    for node in (*file.nodes, *included_nodes(workspace, package, file)):
        if node.is_state_publisher:
            publishers.append(node)
        else:
            yield from _published_by(workspace, package, node)
        if package_row(node.package).publishes_transforms or node.frame_prefix != "":
            yield GraphTransform("", "", "program", False, node.executable, node.location)
    if publishers:
        yield from _edges_of_publishers(workspace, publishers)
    yield from _broadcast_by_controllers(workspace, launch)


def is_zero_rotation(node: StartedNode) -> bool:
    """Return whether a node certainly publishes a static transform that tf2 ignores.

    Its quaternion is 0 0 0 0.
    """
    is_static = node.program == STATIC_PUBLISHER
    return is_static and publishes_as_named(node) and has_zero_rotation(node)


def _published_by(
    workspace: Workspace, package: Package, node: StartedNode
) -> Iterator[GraphTransform]:
    """Yield the transforms that a node publishes, but for those of the robot."""
    program = node.program
    if program == PARAMETER_BRIDGE:
        yield from _broadcast_by_gazebo(workspace, node)
    elif program == STATIC_PUBLISHER:
        parent, child = frames_named(node)
        pose = static_pose(node)
        is_certain = publishes_as_named(node) and not has_zero_rotation(node)
        yield GraphTransform(
            parent or "",
            child or "",
            "static",
            is_certain,
            node.executable,
            node.location,
            is_static=True,
            pose=pose,
        )
    else:
        yield from _edges_of_code(workspace, node)
        if find_transforms("/".join(program)):
            given = workspace.parameters.given_to(package, node)
            for parent, child in _broadcast("/".join(program), given):
                is_certain = publishes_as_named(node)
                by = node.executable
                at = node.location
                yield GraphTransform(parent, child, "program", is_certain, by, at)


def publishes_as_named(node: StartedNode) -> bool:
    """Return whether a node is started for certain, and publishes on /tf."""
    if not node.when or node.remaps is None:
        return False
    return not any("tf" in rule[0] for rule in node.remaps)


def _edges_of_code(workspace: Workspace, node: StartedNode) -> Iterator[GraphTransform]:
    """Yield the transforms of own code.

    Which of its frames is in which one is not known: each is connected with the first.
    """
    first = ""
    for name, frame in list_frames(workspace, node):
        if frame.use in _PUBLISHED:
            first = first or name or ""
            yield GraphTransform(first, name or "", "code", False, node.executable, frame.location)


@lru_cache(maxsize=4)
def _edges_of_robots(
    workspace: Workspace, states: Strings, is_certain: bool
) -> Sequence[GraphTransform]:
    """Return the joints of the robots, which robot_state_publisher publishes.

    `states` are the topics of the states of joints that move.

    It is certain where it is known of which robot.
    """
    is_one = len(workspace.robots.known) == 1 and not workspace.robots.may_be_others
    edges = []
    for known_robot in workspace.robots.known:
        for joint in known_robot.robot.joints:
            if not joint.location:
                continue
            pose = None
            if joint.type == "fixed" and joint.origin:
                pose = joint.origin.placed_in()
            edge = GraphTransform(
                joint.parent,
                joint.child,
                "robot",
                is_certain and is_one,
                f"the joint {quoted(joint.name)} of the robot",
                joint.location.resolve(),
                is_static=pose is not None,
                pose=pose,
                needs=states if joint.type in _MOVING else (),
            )
            edges.append(edge)
    return edges


def _broadcast_by_controllers(workspace: Workspace, launch: int) -> Iterator[GraphTransform]:
    """Yield the transforms of the controllers that a launch file spawns."""
    spawned = spawned_controllers(workspace, launch)
    for controller in defined_controllers(workspace):
        if controller.name not in spawned:
            continue
        kind = controller.type.text or ""
        gifts = workspace.parameters.owners.get(controller.name, [])
        frames: Iterable[tuple[str, str]] = [("", "")] * len(find_transforms(kind))
        # A remapping may be of /tf; a namespace or a prefix is part of the frames.
        is_plain = not spawned[controller.name]
        is_plain = is_plain and [gift.node.namespace for gift in gifts] == ["/"]
        if is_plain and "tf_frame_prefix" not in gifts[0].values:
            frames = _broadcast(kind, gifts[0])
        for parent, child in frames:
            edge = GraphTransform(
                parent, child, "controller", bool(child), controller.name, controller.location
            )
            named = [
                row.location for gift in gifts for row in gift.values.values() if row.value == child
            ]
            yield edge._replace(named_at=next(iter(named), None))


def _broadcast_by_gazebo(workspace: Workspace, bridge: StartedNode) -> Iterator[GraphTransform]:
    """Yield the transforms of systems of Gazebo that a bridge publishes on /tf.

    The systems are those that name their frames.
    """
    if bridge.namespace not in ("", "/"):
        return
    topics = topics_of_transforms(workspace, bridge)
    for root, place in roots(workspace) if topics else ():
        plugins = list(root.iter("plugin"))
        workspace.charge(_OF_ROBOT + len(plugins))
        for plugin in plugins:
            topic = (plugin.findtext("tf_topic") or "").strip().strip("/")
            frames = frames_of_system(plugin) if topic in topics else None
            if frames is not None:
                is_certain = bridge.when is True
                by = f"the system {name_system(plugin)} of Gazebo"
                yield GraphTransform(*frames, "Gazebo", is_certain, by, place(plugin))


def topics_of_transforms(workspace: Workspace, bridge: StartedNode) -> set[str]:
    """Return the topics of Gazebo whose transforms a bridge publishes, without their slash."""
    rows = rows_of_bridge(workspace, bridge)
    return {row.gz for row in rows if row.is_published and bridge.topic(f"/{row.ros}") == _TF}


def frames_of_system(plugin: Element) -> tuple[str, str] | None:
    """Return parent and child of the transform that a system of Gazebo publishes.

    The result is None if it does not name both.
    """
    frames = gazebo().system.get(name_system(plugin), NO_SYSTEM).transform
    if not frames:
        return None
    parent = (plugin.findtext(frames.parent) or "").strip()
    child = (plugin.findtext(frames.child) or "").strip()
    return (parent, child) if parent and child else None


def _broadcast(kind: str, given: NodeParameters) -> Iterator[tuple[str, str]]:
    """Yield parent and child of the transforms that a program or controller publishes.

    The parameters of the program or controller name them.
    """
    for row in find_transforms(kind):
        parts = [row.on, row.parent, row.child, *row.if_equal]
        values = [_value(given, part) for part in parts]
        if given.unknown or None in values:
            yield "", ""
            continue
        on, parent, child, *equal = values
        if on != row.on.off and len({*equal}) < 2:
            yield str(parent).strip("/"), str(child).strip("/")


def _value(given: NodeParameters, part: DecidingParameter) -> Any:
    """Return the value of a parameter, or its default; None where it is not known."""
    row = given.values.get(part.parameter)
    value = row.value if row else part.default
    return None if isinstance(value, Unknown) else value
