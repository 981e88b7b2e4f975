"""Transforms: who publishes which one, as far as launch files start what is known.

A frame has one parent, which one program publishes; and frames form a tree.
"""

from collections.abc import Mapping, Sequence
from math import hypot

from grader.base.patterns import on_use
from grader.base.text import quoted
from grader.base.transforms import minus, turn_between
from grader.workspace.graph.launch_graph import GraphTransform
from grader.workspace.graph.launched_transforms import transforms_in
from grader.workspace.graph.transform_edges import is_zero_rotation
from grader.workspace.model.text_files import MAX_YAML
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Compared, Facts, Mismatch, Mismatches, warning
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    WRONG_TRANSFORM,
    Rule,
)
from grader.workspace.rules.shared_symptoms import TWO_PUBLISHERS

_LETTERS_A_PART = 1_000  # that are searched for a switch
_SAME_PLACE, _SAME_ANGLE = 1e-3, 0.1  # metres, degrees
# A parameter, or an attribute that is named as a switch: self.publish_tf.
_SWITCH = on_use(
    r"get_parameter|(?:publish|broadcast|send|enable|use)\w{0,20}_(?:tf|transform|odom)"
)


_TRANSFORM_ROTATION = Rule(
    "transform-rotation",
    "transforms",
    WRONG_TRANSFORM,
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


def transform_facts(workspace: Workspace) -> Facts:
    """Yield transforms that two programs publish, frames with two parents, and cycles."""
    for node in workspace.launches.nodes:
        if is_zero_rotation(node):
            message = (
                "the quaternion of a static_transform_publisher is 0 0 0 0, which is no "
                "rotation: tf2 ignores the transform; without one it is 0 0 0 1"
            )
            yield Mismatch(_TRANSFORM_ROTATION, message, node.location)
    has_robots = len(workspace.robots.known) > 1  # of which one may run in Gazebo
    for number in range(len(workspace.launches.roots)):
        edges = []
        joints = {}
        for edge in transforms_in(workspace, number):
            if edge.source == "robot" and edge.is_certain:
                joints[edge.child] = edge
            elif _is_switched(workspace, edge):
                continue
            elif edge.is_certain and edge.is_known and not (edge.source == "Gazebo" and has_robots):
                edges.append(edge)
        if edges:
            yield Compared("transforms")
        yield from _owned_twice(edges)
        yield from _children_of_robot(edges, joints)
        yield from _cycles([*edges, *joints.values()])


def _is_switched(workspace: Workspace, edge: GraphTransform) -> bool:
    """Return whether code may send a transform or not, as a parameter or an attribute says."""
    if edge.source != "code":
        return False
    text = (workspace.tree.read(edge.location.path, MAX_YAML) or b"").decode(errors="replace")
    workspace.charge(1 + len(text) // _LETTERS_A_PART)
    return any("if" in line and _SWITCH.search(line) for line in text.splitlines())


_TRANSFORM_OWNER = Rule(
    "transform-owner",
    "transforms",
    WRONG_TRANSFORM,
    "One program publishes the transform of a frame.",
    why=(
        "The frame jumps between two poses as each program publishes. The robot flickers in "
        "RViz, and localization and navigation get worse."
    ),
    symptoms=(TWO_PUBLISHERS,),
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


def _owned_twice(edges: Sequence[GraphTransform]) -> Mismatches:
    """Yield the frames that a second program places; two static transforms of a pair are one."""
    first: dict[str, GraphTransform] = {}
    for edge in edges:
        before = first.setdefault(edge.child, edge)
        if _are_one(before, edge):
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
        wrong = warning(_TRANSFORM_OWNER, message, edge.location, before.location)
        yield wrong._replace(names=(edge.child,))


def _are_one(one: GraphTransform, other: GraphTransform) -> bool:
    """Return whether two transforms are of one program, or static ones of one pair of frames."""
    if one.location == other.location or (other.source == "code" and one.by == other.by):
        return True
    return one.parent == other.parent and one.is_static and other.is_static


def _children_of_robot(
    edges: Sequence[GraphTransform], joints: Mapping[str, GraphTransform]
) -> Mismatches:
    """Yield the programs that place a link of the robot which a joint places."""
    for edge in edges:
        joint = joints.get(edge.child)
        if not joint or (edge.source == "code" and joint.needs):
            continue  # where nothing publishes the states of joints, code may do the work of these
        if edge.is_static:  # with another parent it is a mistake of frames
            yield from _elsewhere(edge, joint)
            continue
        message = (
            f"{edge.by} publishes {quoted(edge.child)} in {quoted(edge.parent)}, but {joint.by} "
            f"places it in {quoted(joint.parent)}: a frame has one parent"
        )
        is_certain = edge.source != "code"
        at = edge.named_at or edge.location
        yield Mismatch(
            _TRANSFORM_OWNER, message, at, joint.location, is_certain, names=(edge.child,)
        )


_STATIC_POSE = Rule(
    "static-pose",
    "values",
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


def _elsewhere(edge: GraphTransform, joint: GraphTransform) -> Mismatches:
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


def _cycles(edges: Sequence[GraphTransform]) -> Mismatches:
    """Yield the cycles of frames, each once, at a transform that the robot does not have."""
    above = {edge.child: edge for edge in edges}
    seen = set()
    for start in above:
        path = []
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
