"""Nodes that a launch file starts beside Gazebo: whether they use the time of the simulation."""

from collections.abc import Collection

from grader.base.names import first_part
from grader.base.source import Location
from grader.base.text import enumerated
from grader.ros.known.package_rows import package_row
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.workspace.graph.bridge_rows import BRIDGE
from grader.workspace.graph.graph import make_graph
from grader.workspace.model.text_files import CODE_ENDINGS
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    warning,
)
from grader.workspace.rules.rule_table import (
    OTHER_TIME,
    Rule,
)
from grader.workspace.rules.shared_symptoms import EXTRAPOLATION

_TIME = "use_sim_time"
_SIMULATIONS = ("ros_gz_sim", "ros_ign_gazebo", "gazebo_ros")
# Programs that compare or publish times, besides those of packages whose rows say so.
_WITH_TIME = (
    "rviz2",
    "robot_state_publisher",
    "joint_state_publisher",
    "joint_state_publisher_gui",
)


_SIMULATED_NODE = Rule(
    "simulated-node",
    "wiring",
    OTHER_TIME,
    "The nodes that a launch file starts beside Gazebo use its time.",
    why=(
        "What the node publishes has the time of the machine. RViz, tf2 and filters beside "
        "Gazebo may drop it as too far from their own time."
    ),
    symptoms=(EXTRAPOLATION,),
    wrong="""
IncludeLaunchDescription(os.path.join(gazebo, 'launch', 'gz_sim.launch.py')),
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot}]),
""",
    right="""
IncludeLaunchDescription(os.path.join(gazebo, 'launch', 'gz_sim.launch.py')),
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot, 'use_sim_time': True}]),
""",
)


def simulated_node_facts(workspace: Workspace) -> Facts:
    """Yield well-known nodes that are started beside Gazebo and use the time of the machine.

    Own nodes count where another node of the launch file uses the time of the simulation. Nodes
    whose parameters are not all known may use it.
    """
    told: dict[Location, set[bool]] = {}
    for node, value in make_graph(workspace).given(_TIME):
        told.setdefault(node.location, set()).add(value.value is True)
    seen: set[Location] = set()
    for launch in workspace.launches.outermost:
        if not _starts_simulation(launch):
            continue
        yield Compared("wiring")
        is_mixed = any(True in told.get(node.location, ()) for node in launch.nodes)
        late = []
        for node in launch.nodes:
            is_own = is_mixed and _has_silent_code(workspace, node)
            has_time = node.executable in _WITH_TIME or package_row(node.package).compares_time
            is_meant = (is_own or has_time) and node.package not in (*_SIMULATIONS, BRIDGE)
            if is_meant and node.location not in seen and _is_untold(node, told):
                late.append(node)
        seen.update(node.location for node in late)
        if late:
            names = enumerated(dict.fromkeys(node.executable for node in late))
            message = (
                f"{launch.source.path} starts Gazebo, but gives {names} no {_TIME}: the time of "
                "the machine counts there"
            )
            if "SetUseSimTime" in launch.source.text:
                message += "; SetUseSimTime sets only the clock of launch itself"
            yield warning(_SIMULATED_NODE, message, late[0].location)


def _starts_simulation(launch: Launch) -> bool:
    """Return whether a launch file certainly starts Gazebo, or creates a robot in it."""
    if any(node.package in _SIMULATIONS and node.when for node in launch.nodes):
        return True
    for passed in launch.passed:
        folder, _, inside = passed.path.partition("/")
        if folder == "share" and first_part(inside) in _SIMULATIONS and passed.when:
            return True
    return False


def _has_silent_code(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether the code of a node is in the workspace, and does not set its time itself."""
    package = workspace.find_package(node)
    if not package:
        return False
    sources = workspace.texts.read_sources(package, CODE_ENDINGS)
    launches = {source.path for source in workspace.texts.launch_sources(package)}
    return not any(_TIME in source.text for source in sources if source.path not in launches)


def _is_untold(node: StartedNode, told: Collection[Location]) -> bool:
    """Return whether a node is certainly started, and certainly not told which time to use."""
    if not node.when or node.location in told or node.parameters is None:
        return False
    if any(given.unknown or given.path for given in node.parameters):
        return False
    return not any(_TIME in (word or _TIME) for word in node.arguments or ())
