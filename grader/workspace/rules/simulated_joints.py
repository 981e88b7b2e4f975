"""Positions of the joints of a robot in Gazebo: whether something publishes them."""

from grader.base.text import quoted
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.workspace.graph.bridge_rows import BRIDGE, are_rows_known
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.started_controllers import spawned_controllers
from grader.workspace.graph.unread_ends import may_publish_type
from grader.workspace.model.launches import SPAWNERS
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.companions import may_publish_joint_states
from grader.workspace.rules.names import (
    Compared,
    Facts,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_COMPANION,
    Rule,
)
from grader.workspace.rules.shared_symptoms import JOINTS_UNKNOWN, NO_TRANSFORM

_STATES = "sensor_msgs.msg.JointState"
_SIMULATION = "ros_gz_sim"


_SIMULATED_JOINTS = Rule(
    "simulated-joints",
    "wiring",
    NO_COMPANION,
    "Something publishes the positions of the joints of a robot in Gazebo.",
    why=(
        "Wheels turn in Gazebo, but robot_state_publisher gets no positions. RViz reports that "
        "their links have no transform."
    ),
    symptoms=(
        NO_TRANSFORM,
        JOINTS_UNKNOWN,
    ),
    wrong="""
IncludeLaunchDescription(os.path.join(gazebo, 'launch', 'gz_sim.launch.py')),
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot, 'use_sim_time': True}]),
Node(package='ros_gz_sim', executable='create', arguments=['-topic', 'robot_description']),
Node(package='ros_gz_bridge', executable='parameter_bridge',
     arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock']),
""",
    right="""
IncludeLaunchDescription(os.path.join(gazebo, 'launch', 'gz_sim.launch.py')),
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot, 'use_sim_time': True}]),
Node(package='ros_gz_sim', executable='create', arguments=['-topic', 'robot_description']),
Node(package='ros_gz_bridge', executable='parameter_bridge',
     arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock',
                '/joint_states@sensor_msgs/msg/JointState[gz.msgs.Model']),
""",
    beside={
        "rover.urdf": """
<link name="left_wheel"/>
<joint name="left" type="continuous"><parent link="base_link"/><child link="left_wheel"/></joint>
""",
        "show.launch.py": """
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='joint_state_publisher', executable='joint_state_publisher'),
    ])
""",
    },
)


def simulated_joint_facts(workspace: Workspace) -> Facts:
    """Yield launch files that create a robot with wheels in Gazebo without their positions.

    They are yielded only if all that the launch file starts is known, and each robot has such
    joints. Where nothing in the workspace publishes positions, the rule joint-states says that.
    """
    moving = []
    for robot in workspace.robots.known:
        joints = [joint for joint in robot.robot.joints if joint.has_position and not joint.mimic]
        if not joints:
            return
        moving += joints
    is_said = not (workspace.launches.unknown_nodes or may_publish_joint_states(workspace))
    if workspace.robots.may_be_others or is_said:
        return
    for number, (_, launch) in enumerate(workspace.launches.roots if moving else ()):
        publishers = [node for node in launch.nodes if node.is_state_publisher]
        if not _creates_robot(launch) or not publishers or launch.unknown or launch.commands:
            continue
        yield Compared("wiring")
        if not _may_have_states(workspace, number, launch):
            link = quoted(moving[0].child)
            message = (
                f"nothing publishes joint_states beside Gazebo, so links such as {link} have no "
                "transform: bridge the topic of a JointStatePublisher, or start a "
                "joint_state_broadcaster"
            )
            yield warning(_SIMULATED_JOINTS, message, publishers[0].location)


def _creates_robot(launch: Launch) -> bool:
    creators = [node for node in launch.nodes if node.package == _SIMULATION and node.when]
    return any(node.executable == "create" for node in creators)


def _may_have_states(workspace: Workspace, number: int, launch: Launch) -> bool:
    """Return whether something that a launch file starts may publish positions of joints."""
    if launch.components or spawned_controllers(workspace, number):
        return True
    for other in workspace.launches.outermost:  # that is launched beside it
        for node in other.nodes if other is not launch else ():
            if node.package == BRIDGE or node.executable in SPAWNERS:
                return True
    for passed in launch.passed:
        is_own = workspace.installed.find_source(passed.path) is not None
        if not is_own and f"share/{_SIMULATION}/" not in f"{passed.path}/":
            return True
    if any(_may_publish(workspace, node) for node in launch.nodes):
        return True
    ends = [end for end in make_graph(workspace).ends if end.launch == number]
    return any(end.kind == "publisher" and end.type in (_STATES, None) for end in ends)


def _may_publish(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether it is not known that a node publishes no positions of joints."""
    if node.package == BRIDGE:
        return not are_rows_known(workspace, node)
    if node.package == _SIMULATION or node.is_state_publisher:
        return False
    return may_publish_type(workspace, node, _STATES)
