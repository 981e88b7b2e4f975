"""Transforms: who publishes which one, as far as launch files start what is known.

A frame has one parent, which one program publishes; and frames form a tree.
"""

from collections.abc import Iterator, Mapping, Sequence
from math import hypot
from typing import Any, NamedTuple

from grader.base.source import Location
from grader.base.text import quoted
from grader.base.transforms import Transform, minus, turn_between
from grader.ros.known.known import known
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
from grader.ros.workspace.graph.bridge_rows import BRIDGE, rows_of_bridge
from grader.ros.workspace.graph.gazebo_topics import roots, system_of
from grader.ros.workspace.graph.started_controllers import defined_controllers, spawned_controllers
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.names import Compared, Fact, Mismatch

_SAME_PLACE, _SAME_ANGLE = 1e-3, 0.1  # metres, degrees
_ROBOT_PUBLISHER = "robot_state_publisher"
_TF = "/tf"
_OF_ROBOT = 100  # parts of searching the plugins of a robot or a world


class _Edge(NamedTuple):
    """A transform that something certainly publishes."""

    parent: str
    child: str
    by: str
    location: Location
    is_static: bool = False
    is_of_robot: bool = False
    pose: Transform | None = None  # T_parent_child, where it never changes and is known


def transform_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield transforms that two programs publish, frames with two parents, and cycles."""
    joints = _joints_of_robot(workspace)
    for number, (package, launch) in enumerate(workspace.roots):
        edges: list[_Edge] = []
        has_robot = False
        for node in launch.nodes:
            is_of_robot = node.executable == _ROBOT_PUBLISHER and not node.frame_prefix
            has_robot = has_robot or (is_of_robot and _is_certain(node))
            for each in _published_by(workspace, package, node):
                if isinstance(each, Mismatch):
                    yield each
                else:
                    edges.append(each)
        edges += _broadcast_by_controllers(workspace, number)
        if edges:
            yield Compared("transforms")
        yield from _owned_twice(edges)
        if has_robot:
            yield from _children_of_robot(edges, joints)
        yield from _cycles([*edges, *(joints.values() if has_robot else ())])


def _published_by(
    workspace: Workspace, package: Package, node: StartedNode
) -> Iterator[_Edge | Mismatch]:
    """Yield the transforms that a node publishes but for those of the robot, and that one is no
    transform.
    """
    if (node.package, node.executable) == (BRIDGE, "parameter_bridge"):
        yield from _broadcast_by_gazebo(workspace, node)
    elif not _is_certain(node):
        return
    elif (node.package, node.executable) == STATIC_PUBLISHER:
        if has_zero_rotation(node):
            message = (
                "the quaternion of a static_transform_publisher is 0 0 0 0, which is no "
                "rotation: tf2 ignores the transform; without one it is 0 0 0 1"
            )
            yield Mismatch("transforms", message, node.location)
            return
        parent, child = frames_named(node)
        if parent and child:
            by, pose = STATIC_PUBLISHER[1], static_pose(node)
            yield _Edge(parent, child, by, node.location, is_static=True, pose=pose)
    elif node.executable != _ROBOT_PUBLISHER:
        given = workspace.parameters_given(package, node)
        name = f"{node.package}/{node.executable}"
        yield from _broadcast(name, node.executable, given, node.location)


def _is_certain(node: StartedNode) -> bool:
    """Return whether a node is started for certain, and publishes on /tf."""
    is_plain = not node.namespace and node.remaps is not None
    return node.when is True and is_plain and not any("tf" in rule[0] for rule in node.remaps or ())


def _joints_of_robot(workspace: Workspace) -> Mapping[str, _Edge]:
    """Return the transforms that robot_state_publisher publishes, by their children; none where it
    is not known of which robot.
    """
    if workspace.has_other_robots or len(workspace.robots) != 1:
        return {}
    robot = workspace.robots[0].robot
    edges = {}
    for joint in robot.joints:
        if joint.location is not None:
            at = joint.location.resolve()
            by = f"the joint {quoted(joint.name)} of the robot"
            is_fixed = joint.type == "fixed" and joint.origin is not None
            pose = joint.origin.placed_in() if is_fixed and joint.origin is not None else None
            edges[joint.child] = _Edge(joint.parent, joint.child, by, at, is_fixed, True, pose)
    return edges


def _broadcast_by_controllers(workspace: Workspace, launch: int) -> Iterator[_Edge]:
    spawned = spawned_controllers(workspace, launch)
    for controller in defined_controllers(workspace):
        if controller.name not in spawned or spawned[controller.name]:
            continue  # a remapping may be of /tf
        gifts = workspace.parameter_owners.get(controller.name, [])
        if len(gifts) == 1:
            kind = controller.type.text or ""
            yield from _broadcast(kind, controller.name, gifts[0], controller.location)


def _broadcast_by_gazebo(workspace: Workspace, bridge: StartedNode) -> Iterator[_Edge]:
    """Yield the transforms of systems of Gazebo that a bridge publishes on /tf, where these name
    their frames.
    """
    if bridge.when is not True or bridge.namespace not in ("", "/"):
        return
    topics = {
        row.gz
        for row in rows_of_bridge(workspace, bridge)
        if row.is_published and bridge.topic(f"/{row.ros}") == _TF
    }
    for root, place in roots(workspace) if topics else ():
        plugins = [*root.iter("plugin")]
        workspace.charge(_OF_ROBOT + len(plugins))
        for plugin in plugins:
            frames = known()["gazebo_transforms"].get(system_of(plugin))
            topic = (plugin.findtext("tf_topic") or "").strip().strip("/")
            if frames is None or topic not in topics:
                continue
            parent = (plugin.findtext(frames["parent"]) or "").strip()
            child = (plugin.findtext(frames["child"]) or "").strip()
            if parent and child:
                by = f"the system {system_of(plugin)} of Gazebo"
                yield _Edge(parent, child, by, place(plugin))


def _broadcast(kind: str, by: str, given: NodeParameters, at: Location) -> Iterator[_Edge]:
    """Yield the transforms that a program or a controller publishes with its parameters."""
    for row in known()["broadcasts"]:
        if kind not in row["by"]:
            continue
        parts = [row["on"], row["parent"], row["child"], *row.get("if_equal", ())]
        values = [_value(given, part) for part in parts]
        if given.unknown or None in values:
            continue
        on, parent, child, *equal = values
        if on != row["on"]["off"] and len({*equal}) < 2:
            yield _Edge(str(parent).strip("/"), str(child).strip("/"), by, at)


def _value(given: NodeParameters, part: Mapping[str, Any]) -> Any:
    """Return the value of a parameter, or its default; None where it is not known."""
    row = given.values.get(part["parameter"])
    value = row.value if row is not None else part["default"]
    return None if isinstance(value, Unknown) else value


def _owned_twice(edges: Sequence[_Edge]) -> Iterator[Mismatch]:
    """Yield the frames that a second program places; two equal static transforms are one."""
    first: dict[str, _Edge] = {}
    for edge in edges:
        before = first.setdefault(edge.child, edge)
        if before.location == edge.location or (before.is_static and edge.is_static):
            continue
        if before.parent == edge.parent:
            message = (
                f"{edge.by} publishes the transform from {quoted(edge.parent)} to "
                f"{quoted(edge.child)}, and so does {before.by} ({before.location.file_and_line})"
            )
        else:
            message = (
                f"{edge.by} publishes {quoted(edge.child)} in {quoted(edge.parent)}, and "
                f"{before.by} in {quoted(before.parent)} ({before.location.file_and_line}): a "
                "frame has one parent"
            )
        yield Mismatch("transforms", message, edge.location, before.location, is_certain=False)


def _children_of_robot(edges: Sequence[_Edge], joints: Mapping[str, _Edge]) -> Iterator[Mismatch]:
    """Yield the programs that place a link of the robot which a joint places."""
    for edge in edges:
        joint = joints.get(edge.child)
        if joint is None:
            continue
        if edge.is_static:  # with another parent it is a mistake of frames
            yield from _elsewhere(edge, joint)
            continue
        message = (
            f"{edge.by} publishes {quoted(edge.child)} in {quoted(edge.parent)}, but {joint.by} "
            f"places it in {quoted(joint.parent)}: a frame has one parent"
        )
        yield Mismatch("transforms", message, edge.location, joint.location)


def _elsewhere(edge: _Edge, joint: _Edge) -> Iterator[Mismatch]:
    """Yield that a static transform places a link elsewhere than its fixed joint."""
    if edge.parent != joint.parent or edge.pose is None or joint.pose is None:
        return
    away = hypot(*minus(edge.pose.translation, joint.pose.translation))
    turn = turn_between(edge.pose.rotation, joint.pose.rotation)
    if away <= _SAME_PLACE and turn <= _SAME_ANGLE:
        return
    message = (
        f"{edge.by} places {quoted(edge.child)} {1000.0 * away:.3g} mm and {turn:.3g} degrees from "
        f"where {joint.by} places it"
    )
    yield Mismatch("values", message, edge.location, joint.location, is_certain=False)


def _cycles(edges: Sequence[_Edge]) -> Iterator[Mismatch]:
    """Yield the cycles of frames, each once."""
    above = {edge.child: edge for edge in edges}
    seen: set[str] = set()
    for start in above:
        path: list[str] = []
        frame = start
        while frame in above and frame not in seen:
            seen.add(frame)
            path.append(frame)
            frame = above[frame].parent
        if frame not in path:
            continue
        cycle = path[path.index(frame) :]
        own = [above[name] for name in cycle if above[name] in edges]
        published = [edge for edge in own if not edge.is_of_robot] or own
        names = " -> ".join(quoted(name) for name in [*reversed(cycle), cycle[-1]])
        message = f"the frames {names} are a cycle: tf2 has no transform of them"
        yield Mismatch("transforms", message, published[0].location)
