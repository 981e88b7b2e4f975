"""Transforms: who publishes which one, as far as launch files start what is known.

A frame has one parent, which one program publishes; and frames form a tree.
"""

from collections.abc import Iterator, Mapping, Sequence
from math import hypot

from grader.base.text import quoted
from grader.base.transforms import minus, turn_between
from grader.workspace.graph.graph import grouped, make_graph
from grader.workspace.graph.transform_edges import Edge, is_zero_rotation
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Compared, Fact, Mismatch, warning
from grader.workspace.rules.rule_table import (
    OTHER_TRANSFORM,
    OTHER_VALUE,
    WRONG_TRANSFORM,
    Rule,
)

_SAME_PLACE, _SAME_ANGLE = 1e-3, 0.1  # metres, degrees


_TRANSFORM_ROTATION = Rule(
    "transform-rotation",
    "transforms",
    WRONG_TRANSFORM,
    OTHER_TRANSFORM,
    "The quaternion of a static transform is a rotation.",
    why=(
        "tf2 ignores the static transform and prints TF_DENORMALIZED_QUATERNION. The frame is "
        "missing, and each lookup of it fails."
    ),
    wrong="""
Node(package='tf2_ros', executable='static_transform_publisher',
     arguments=['0', '0', '0', '0', '0', '0', '0', 'base_link', 'camera']),
""",
    right="""
Node(package='tf2_ros', executable='static_transform_publisher',
     arguments=['0', '0', '0', '0', '0', '0', '1', 'base_link', 'camera']),
""",
)


def transform_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield transforms that two programs publish, frames with two parents, and cycles."""
    for _, node in workspace.launches.nodes:
        if is_zero_rotation(node):
            message = (
                "the quaternion of a static_transform_publisher is 0 0 0 0, which is no "
                "rotation: tf2 ignores the transform; without one it is 0 0 0 1"
            )
            yield Mismatch(_TRANSFORM_ROTATION, message, node.location)
    has_robots = len(workspace.robots.known) > 1  # of which one may run in Gazebo
    certain = [edge for edge in make_graph(workspace).edges if edge.is_certain]
    for of_launch in grouped(certain, lambda edge: edge.launch).values():
        edges: list[Edge] = []
        joints: dict[str, Edge] = {}
        for edge in of_launch:
            if edge.source == "robot":
                joints[edge.child] = edge
            elif edge.is_known and not (edge.source == "Gazebo" and has_robots):
                edges.append(edge)
        if edges:
            yield Compared("transforms")
        yield from _owned_twice(edges)
        yield from _children_of_robot(edges, joints)
        yield from _cycles([*edges, *joints.values()])


_TRANSFORM_OWNER = Rule(
    "transform-owner",
    "transforms",
    WRONG_TRANSFORM,
    OTHER_TRANSFORM,
    "One program publishes the transform of a frame.",
    why=(
        "The frame jumps between two poses as each program publishes. The robot flickers in "
        "RViz, and localization and navigation get worse."
    ),
    wrong="""
Node(package='robot_localization', executable='ekf_node', name='wheels'),
Node(package='robot_localization', executable='ekf_node', name='imu'),
""",
    right="""
Node(package='robot_localization', executable='ekf_node', name='wheels'),
Node(
    package='robot_localization', executable='ekf_node', name='imu',
    parameters=[{'publish_tf': False}],
),
""",
)


def _owned_twice(edges: Sequence[Edge]) -> Iterator[Mismatch]:
    """Yield the frames that a second program places; two equal static transforms are one."""
    first: dict[str, Edge] = {}
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
        yield warning(_TRANSFORM_OWNER, message, edge.location, before.location)


def _children_of_robot(edges: Sequence[Edge], joints: Mapping[str, Edge]) -> Iterator[Mismatch]:
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
        yield Mismatch(_TRANSFORM_OWNER, message, edge.location, joint.location)


_STATIC_POSE = Rule(
    "static-pose",
    "values",
    OTHER_VALUE,
    OTHER_VALUE,
    "A static transform of a link equals its fixed joint.",
    why=(
        "Two programs publish different poses of one link. Which one counts depends on the "
        "order of their start, so sensor data are sometimes displaced."
    ),
    wrong="""
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot}]),
Node(package='tf2_ros', executable='static_transform_publisher',
     arguments=['--z', '0.2', '--frame-id', 'base_link', '--child-frame-id', 'lidar']),
""",
    right="""
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot}]),
Node(package='tf2_ros', executable='static_transform_publisher',
     arguments=['--z', '0.1', '--frame-id', 'base_link', '--child-frame-id', 'lidar']),
""",
    beside={
        "lidar/rover.urdf": "",
    },
)


def _elsewhere(edge: Edge, joint: Edge) -> Iterator[Mismatch]:
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
    yield warning(_STATIC_POSE, message, edge.location, joint.location)


_TRANSFORM_CYCLE = Rule(
    "transform-cycle",
    "transforms",
    WRONG_TRANSFORM,
    OTHER_TRANSFORM,
    "The transforms of a robot have no cycle.",
    why=(
        "tf2 cannot resolve frames in a loop: lookups fail with 'The tf tree is invalid because"
        " it contains a loop'."
    ),
    wrong="""
Node(package='tf2_ros', executable='static_transform_publisher',
     arguments=['--frame-id', 'base_link', '--child-frame-id', 'camera']),
Node(package='tf2_ros', executable='static_transform_publisher',
     arguments=['--frame-id', 'camera', '--child-frame-id', 'base_link']),
""",
    right="""
Node(package='tf2_ros', executable='static_transform_publisher',
     arguments=['--frame-id', 'base_link', '--child-frame-id', 'camera']),
Node(package='tf2_ros', executable='static_transform_publisher',
     arguments=['--frame-id', 'camera', '--child-frame-id', 'camera_optical']),
""",
)


def _cycles(edges: Sequence[Edge]) -> Iterator[Mismatch]:
    """Yield the cycles of frames, each once, at a transform that the robot does not have."""
    above = {edge.child: edge for edge in edges}
    seen: set[str] = set()
    for start in above:
        path: list[str] = []
        frame = start
        while frame in above and frame not in seen:
            seen.add(frame)
            path.append(frame)
            frame = above[frame].parent
        if frame in path:
            cycle = path[path.index(frame) :]
            names = " -> ".join(map(quoted, [*reversed(cycle), cycle[-1]]))
            message = f"the frames {names} are a cycle: tf2 has no transform of them"
            at = min((above[name] for name in cycle), key=lambda edge: edge.source == "robot")
            yield Mismatch(_TRANSFORM_CYCLE, message, at.location)
