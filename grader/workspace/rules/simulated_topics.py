"""Rows of a bridge for which Gazebo runs no system, and odometry that no row takes to tf2.

They are found only where all robots, models and worlds are read, and all systems in them are known.
"""

from collections.abc import Collection, Iterator, Mapping

from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.gazebo_rows import NO_SYSTEM, gazebo
from grader.workspace.graph.bridge_rows import BRIDGE, BridgeRow, bridge_rows
from grader.workspace.graph.gazebo_topics import elements_in, name_system
from grader.workspace.graph.graph import make_graph
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.bridges import has_unread_topics
from grader.workspace.rules.frames import openings
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_TOPIC,
    Rule,
)

_TRANSFORMS = "tf2_msgs.msg.TFMessage"
# Programs of ros_gz that publish no transform but those of rows.
_WITHOUT_TRANSFORMS = ("create", "parameter_bridge")
_ODOM = "odom"  # the parent of the transform of a system that names none


class _Need(Named):
    """What takes or sends the messages of a type in Gazebo."""

    systems: Collection[str]
    what: str


def simulated_topic_facts(workspace: Workspace) -> Facts:
    """Yield rows without a system, and odometry without a row."""
    rows = [row for row in bridge_rows(workspace) if row.is_used]
    creates = any(node.executable == "create" for node in workspace.launches.nodes)
    if not rows or not creates or has_unread_topics(workspace):
        return
    systems = _systems(workspace)
    yield Compared("topics")
    yield from _without_system(rows, systems)
    yield from _odometry(workspace, rows)


def _systems(workspace: Workspace) -> Mapping[str, Location]:
    """Return the systems of robots, models and worlds, without those of windows."""
    systems: dict[str, Location] = {}
    for plugin, place in elements_in(workspace, "plugin"):
        if not any(above.tag == "gui" for above in plugin.iterancestors()):
            systems.setdefault(name_system(plugin), place(plugin))
    return systems


def _needs() -> Mapping[str, _Need]:
    odometry = (*gazebo().odometry_systems, "OdometryPublisher")
    return {
        "gz.msgs.Twist": _Need((), "takes commands"),
        "gz.msgs.Model": _Need(("JointStatePublisher",), "sends the positions of joints"),
        "gz.msgs.Odometry": _Need(odometry, "sends odometry"),
    }


_BRIDGE_SYSTEM = Rule(
    "bridge-system",
    "topics",
    NO_TOPIC,
    "The robot has a system for the commands, joints and odometry of a bridge.",
    why=(
        "Nothing in Gazebo reads the commands or publishes the messages. The topics exist in "
        "ROS 2, but the robot does not move or no data arrive."
    ),
    wrong="<!-- without a plugin -->",
    right="""
<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <topic>cmd_vel</topic><frame_id>odom</frame_id><child_frame_id>base_link</child_frame_id>
</plugin></gazebo>
""",
    frame="rover.urdf",
    beside={
        "rover.launch.py": """
Node(
    package='robot_state_publisher', executable='robot_state_publisher',
    parameters=[{'robot_description': robot}],
),
Node(package='ros_gz_sim', executable='create', arguments=['-topic', 'robot_description']),
Node(package='ros_gz_bridge', executable='parameter_bridge',
     arguments=['/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist']),
""",
    },
    at="launch/rover.launch.py",
)


def _without_system(rows: Collection[BridgeRow], systems: Mapping[str, Location]) -> Mismatches:
    """Yield the rows whose messages no system takes or sends."""
    for row in rows:
        need = _needs().get(row.gz_type)
        is_input = row.gz_type == "gz.msgs.Twist"
        if not need or (is_input and not row.is_read) or (not is_input and row.is_read):
            continue
        passive = gazebo().passive_systems.difference(need.systems)
        if passive.issuperset(systems):
            message = (
                f"no system of Gazebo {need.what}, so this row of {quoted(row.gz)} brings "
                "nothing: the robot needs a <plugin> for it"
            )
            yield warning(_BRIDGE_SYSTEM, message, row.location)


_ODOMETRY_BRIDGED = Rule(
    "odometry-bridged",
    "topics",
    NO_TOPIC,
    "A bridge takes the transform of odometry that RViz shows to /tf.",
    why=(
        "RViz reports that its fixed frame does not exist and cannot place the robot, although "
        "the robot moves in Gazebo."
    ),
    wrong="""
Node(package='ros_gz_sim', executable='create', arguments=['-string', robot]),
Node(package='ros_gz_bridge', executable='parameter_bridge',
     arguments=['/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist']),
""",
    right="""
Node(package='ros_gz_sim', executable='create', arguments=['-string', robot]),
Node(package='ros_gz_bridge', executable='parameter_bridge',
     arguments=['/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist',
                '/tf@tf2_msgs/msg/TFMessage[gz.msgs.Pose_V']),
""",
    beside={
        "odom.rviz": "",
        "diff/rover.urdf": "",
    },
    at="rviz/odom.rviz",
)


def _odometry(workspace: Workspace, rows: Collection[BridgeRow]) -> Mismatches:
    """Yield the fixed frame of RViz that Gazebo publishes, and that no row takes to tf2."""
    if any(row.ros_type == _TRANSFORMS for row in rows) or _has_more_bridges(workspace):
        return
    if any(fact.kind == "frame" for fact in openings(workspace)):
        return
    frames = set()
    for edge in make_graph(workspace).edges:
        if not edge.is_known and edge.by not in _WITHOUT_TRANSFORMS:
            return
        frames |= {edge.parent.removeprefix("/"), edge.child.removeprefix("/")}
    for parent, by, at in _parents(workspace):
        for package in workspace.packages:
            for file in map(package.rviz, package.rviz_files):
                if file.fixed_frame == parent and parent not in frames:
                    message = (
                        f"the system {by} publishes the transform of {quoted(parent)} in Gazebo "
                        "only: no row of a bridge takes it to /tf"
                    )
                    yield warning(_ODOMETRY_BRIDGED, message, file.frame_location, at)


def _has_more_bridges(workspace: Workspace) -> bool:
    """Return whether a bridge may have other rows, or publish them under other names."""
    return any(
        node.package == BRIDGE and (node.remaps != () or node.parameters is None)
        for node in workspace.launches.nodes
    )


def _parents(workspace: Workspace) -> Iterator[tuple[str, str, Location]]:
    """Yield the parents of the transforms of systems, with their systems and places."""
    for plugin, place in elements_in(workspace, "plugin"):
        frames = gazebo().system.get(name_system(plugin), NO_SYSTEM).transform
        if frames:
            parent = (plugin.findtext(frames.parent) or _ODOM).strip()
            yield parent, name_system(plugin), place(plugin)
