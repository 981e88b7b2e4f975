"""Nodes that need others, such as a publisher of joint states, the clock or the robot.

Nodes that have one name are compared here as well.
"""

from collections.abc import Iterator, Sequence

from grader.base.patterns import on_use
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.installation.places import PREFIX, share_parts
from grader.ros.known.package_rows import (
    commands_that_end,
    package_row,
    program_row,
)
from grader.ros.known.ros_machine import ros_machine
from grader.ros.known.shared_names import shared_names
from grader.ros.launch.launch_model import Launch, PassedArguments, StartedNode
from grader.ros.urdf.model import Joint
from grader.workspace.graph.bridge_rows import BRIDGE, are_rows_known, bridge_rows
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.launch_graph import GraphNode
from grader.workspace.graph.started_controllers import defined_controllers, spawned_controllers
from grader.workspace.graph.unread_ends import may_publish_type
from grader.workspace.model.launches import CONTROL_NODE, MANAGER
from grader.workspace.model.text_files import CODE_ENDINGS
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import NO_COMPANION, Rule, Symptom
from grader.workspace.rules.shared_symptoms import EXTRAPOLATION, JOINTS_UNKNOWN, NO_TRANSFORM

_ROBOT_PUBLISHER = "robot_state_publisher"
_JOINT_STATE = "sensor_msgs.msg.JointState"
_CLOCK = "rosgraph_msgs.msg.Clock"
_JOINT_STATE_WORDS = ("joint_state", "JointState")
_TIME = "use_sim_time"
_PAGES = (".md", ".sh", ".bash", "Makefile")
_LOOSE = (*_PAGES, ".rst", ".txt", ".yaml", ".yml", "Dockerfile")  # outside of packages
_SOURCES = (*CODE_ENDINGS, *_PAGES, ".yaml")
# Launch files that start Gazebo or a part of it, and no bridge.
_OF_GAZEBO = ("gz_sim.launch.py", "gz_server.launch.py", "gz_spawn_model.launch.py")
_GAZEBO = ("gz sim", "ign gazebo")  # processes that open no topic of ROS
_BRIDGES = (BRIDGE, "ros_ign_bridge")
_WORD = on_use(r"[a-z0-9]+")


def companion_facts(workspace: Workspace) -> Facts:
    """Yield nodes whose companions are missing or are there twice.

    A launch file may be one of several that a person starts: what is missing is missing in all of
    them. Where a launch file may start more than is known, nothing is.
    """
    if not workspace.launches.nodes:
        return
    yield Compared("wiring")
    yield from _same_names(workspace)
    yield from _two_joint_state_publishers(workspace)
    if not workspace.launches.unknown_nodes:
        yield from _no_joint_states(workspace)
        yield from _no_robot(workspace)
        yield from _no_clock(workspace)
        yield from _wall_time(workspace)


_NODE_NAME = Rule(
    "node-name",
    "wiring",
    NO_COMPANION,
    "The nodes of a launch file have different names.",
    why=(
        "ros2 node list warns of an exact name that two nodes share. A parameter or service "
        "request may reach the wrong one of the two."
    ),
    symptoms=(
        Symptom(
            "node-twice",
            pattern=r"Publisher already registered for (?:provided )?node name",
            source="ros2/rcl c19dab5, rcl/src/rcl/logging_rosout.c:229",
            sentence="Two nodes have one name.",
            example=(
                "Publisher already registered for node name: 'mover'. If this is due to multiple "
                "nodes with the same name then all logs for the logger named 'mover' will go out "
                "over the existing publisher."
            ),
        ),
    ),
    wrong="""
Node(package='turtlesim', executable='turtlesim_node', name='sim'),
Node(package='turtlesim', executable='turtlesim_node', name='sim'),
""",
    right="""
Node(package='turtlesim', executable='turtlesim_node', name='sim'),
Node(package='turtlesim', executable='turtlesim_node', name='sim2'),
""",
)


def _same_names(workspace: Workspace) -> Mismatches:
    """Yield the nodes that a launch file gives a name which it gives another one."""
    for graph, launch in zip(
        make_graph(workspace).launched, workspace.launches.outermost, strict=True
    ):
        named = {node.location for node in launch.nodes if node.node_name}
        first: dict[str, GraphNode] = {}
        for node in graph.nodes:
            if node.location in named and node.name and not node.doubt:
                before = first.setdefault(node.name, node)
                if before is not node:
                    message = _describe_same_name(node, before)
                    yield warning(_NODE_NAME, message, node.location, before.location)


def _describe_same_name(node: GraphNode, before: GraphNode) -> str:
    other = f"the other one is at {before.location.file_and_line}"
    if node.process is not None and before.process == node.process:
        other = f"the name is for both nodes of {node.program}"
    message = f"two nodes are named {node.name}: their parameters and services cannot be told"
    return f"{message} apart; {other}"


def _broadcasters(workspace: Workspace) -> set[str]:
    """Return the names of the controllers that publish joint states."""
    names = set()
    for controller in defined_controllers(workspace):
        if controller.row.publishes_joint_states:
            names.add(controller.name)
    return names


_ONE_JOINT_STATE = Rule(
    "one-joint-state",
    "wiring",
    NO_COMPANION,
    "One program publishes the positions of the joints.",
    why=(
        "robot_state_publisher uses each message that arrives. The links jump between the "
        "measured positions and those of the other program in RViz."
    ),
    wrong="""
Node(package='controller_manager', executable='ros2_control_node', parameters=[controllers]),
Node(package='controller_manager', executable='spawner', arguments=['joint_state_broadcaster']),
Node(package='joint_state_publisher', executable='joint_state_publisher'),
""",
    right="""
Node(package='controller_manager', executable='ros2_control_node', parameters=[controllers]),
Node(package='controller_manager', executable='spawner', arguments=['joint_state_broadcaster']),
""",
    frame="control/rover.launch.py",
    beside={
        "arm/rover.urdf": "",
        "types/controllers.yaml": """
joint_state_broadcaster:
  type: joint_state_broadcaster/JointStateBroadcaster
""",
    },
)


def _two_joint_state_publishers(workspace: Workspace) -> Mismatches:
    """Yield the programs that publish joint states beside a controller that does."""
    broadcasters = _broadcasters(workspace)
    for launch, node in workspace.launches.launched:
        is_source = program_row(*node.program).publishes_joint_states
        if not is_source or not node.when or node.remaps or node.parameters:
            continue
        spawned = spawned_controllers(workspace, launch)
        for name in sorted(broadcasters.intersection(spawned)):
            if not spawned[name] and not node.namespace:
                message = (
                    f"{node.executable} and the controller {quoted(name)} both publish "
                    "joint_states: the joints jump between their positions"
                )
                yield warning(_ONE_JOINT_STATE, message, node.location)


_JOINT_STATES = Rule(
    "joint-states",
    "wiring",
    NO_COMPANION,
    "Something publishes the positions of the joints.",
    why=(
        "robot_state_publisher publishes no transforms for moving joints. RViz prints 'No "
        "transform from [...]' for their links and shows the robot incomplete."
    ),
    symptoms=(
        NO_TRANSFORM,
        JOINTS_UNKNOWN,
    ),
    wrong="""
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot}]),
""",
    right="""
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot}]),
Node(package='joint_state_publisher', executable='joint_state_publisher'),
""",
    beside={
        "plain/rover.urdf": """
<robot name="rover">
  <link name="base_link"/> <link name="arm"/>
  <joint name="arm_joint" type="continuous"><parent link="base_link"/><child link="arm"/></joint>
</robot>
""",
    },
)


def _no_joint_states(workspace: Workspace) -> Mismatches:
    """Yield a robot with moving joints whose positions nothing publishes.

    Joints that follow others have no positions of their own. Nothing is said where there may be
    other robots, or where a node, a bridge, a controller or a plugin of Gazebo may publish them, or
    a page says what does.
    """
    publishers = []
    for node in workspace.launches.nodes:
        if node.executable == _ROBOT_PUBLISHER and node.when:
            publishers.append(node)
    moving = _moving_joints(workspace)
    if not publishers or not moving or workspace.robots.may_be_others:
        return
    if may_publish_joint_states(workspace):
        return
    first = moving[0]
    message = (
        f"nothing publishes joint_states, so the links of {len(moving)} moving joints such as "
        f"{quoted(first.name)} have no transform: start joint_state_publisher or a "
        "joint_state_broadcaster"
    )
    at = first.location.resolve() if first.location else None
    yield warning(_JOINT_STATES, message, publishers[0].location, at)


def _moving_joints(workspace: Workspace) -> list[Joint]:
    """Return the joints of the robots that have positions of their own."""
    moving = []
    for robot in workspace.robots.known:
        for joint in robot.robot.joints:
            if joint.has_position and not joint.mimic:
                moving.append(joint)
    return moving


def may_publish_joint_states(workspace: Workspace) -> bool:
    """Return whether something may publish the positions of the joints."""
    for node in workspace.launches.nodes:
        if program_row(*node.program).publishes_joint_states:
            return True
        if may_publish_type(workspace, node, _JOINT_STATE):
            return True
    if _is_bridged(workspace, _JOINT_STATE) or _broadcasters(workspace):
        return True
    texts = [robot.source.text for robot in workspace.robots.known]  # of plugins of Gazebo
    is_in_robot = any(word in text for text in texts for word in _JOINT_STATE_WORDS)
    return is_in_robot or _is_mentioned(workspace, _JOINT_STATE_WORDS)


def _is_bridged(workspace: Workspace, message: str) -> bool:
    """Return whether a bridge publishes messages of a type."""
    return any(row.is_published and row.ros_type == message for row in bridge_rows(workspace))


def _is_mentioned(workspace: Workspace, words: Sequence[str]) -> bool:
    """Return whether a launch file, a program or a page of the workspace has one of some words."""
    texts = list(workspace.texts.searched_launch_texts())
    texts += [source.text for source in workspace.texts.every_source(_SOURCES)]
    return any(word in text for text in texts for word in words)


_ROBOT_PUBLISHED = Rule(
    "robot-published",
    "wiring",
    NO_COMPANION,
    "robot_state_publisher gives the controller manager the robot.",
    why=(
        "The controller manager waits for the topic robot_description and loads no hardware. "
        "Spawners wait or fail, and nothing moves."
    ),
    symptoms=(
        Symptom(
            "robot-waited-for",
            pattern=(
                r"Waiting for data on '[\w/~]{0,100}robot_description' topic to finish "
                r"initialization"
            ),
            source=(
                "ros-controls/ros2_control 53b9999d1, controller_manager/src/"
                "controller_manager.cpp:769"
            ),
            sentence="Nothing publishes the robot where the controller manager listens.",
            example="Waiting for data on 'robot_description' topic to finish initialization",
            place="description",
        ),
    ),
    wrong="Node(package='controller_manager', executable='ros2_control_node'),",
    right="""
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot}]),
Node(package='controller_manager', executable='ros2_control_node'),
""",
    beside={
        "arm/rover.urdf": "",
    },
)


def _no_robot(workspace: Workspace) -> Mismatches:
    """Yield a controller manager that waits for a robot which nothing publishes."""
    managers = []
    for node in workspace.launches.nodes:
        if node.executable == _ROBOT_PUBLISHER:
            return
        if node.package == MANAGER and node.executable == CONTROL_NODE:
            if node.has_description:
                return
            managers.append(node)
        elif "frames" not in package_row(node.package).without:
            return
    if managers and not _is_mentioned(workspace, ("robot_description",)):
        message = (
            "the controller manager waits for the topic robot_description, which nothing "
            "publishes: start robot_state_publisher"
        )
        yield warning(_ROBOT_PUBLISHED, message, managers[0].location)


def _sim_time(workspace: Workspace) -> Iterator[Location]:
    """Yield where nodes that are started are told to use the time of a simulation.

    robot_state_publisher sends what it gets, whatever the time is.
    """
    for node, value in make_graph(workspace).given(_TIME):
        if node.when and value.value is True and node.executable != _ROBOT_PUBLISHER:
            yield value.location


_CLOCK_PUBLISHED = Rule(
    "clock-published",
    "wiring",
    NO_COMPANION,
    "Something publishes the clock of nodes with use_sim_time.",
    why=(
        "The time of the nodes stays 0: timers on their clock never fire, and tf2 finds no "
        "transforms for their messages."
    ),
    symptoms=(EXTRAPOLATION,),
    wrong="""
Node(package='rplidar_ros', executable='rplidar_node', parameters=[{'use_sim_time': True}]),
""",
    right="Node(package='rplidar_ros', executable='rplidar_node'),",
)


def _no_clock(workspace: Workspace) -> Mismatches:
    """Yield that nodes wait for the time of a simulation that nothing publishes."""
    at = next(_sim_time(workspace), None)
    if not at or _may_have_clock(workspace):
        return
    message = "use_sim_time is true, but nothing publishes /clock: the time of the node stays 0"
    yield warning(_CLOCK_PUBLISHED, message, at)


def _may_have_clock(workspace: Workspace) -> bool:
    """Return whether something may publish /clock.

    It may be a node, a launch file or a command that is not read, or what a page tells people to
    start.
    """
    if _is_bridged(workspace, _CLOCK):
        return True
    if any(_may_start_clock(workspace, launch) for launch in workspace.launches.outermost):
        return True
    for node in workspace.launches.nodes:
        is_open_bridge = node.package == BRIDGE and None in (node.arguments or (None,))
        if is_open_bridge or _may_be_clock(workspace, node):
            return True
    return _may_bridge_clock(workspace) if _starts_gazebo(workspace) else _is_told(workspace)


def _starts_gazebo(workspace: Workspace) -> bool:
    """Return whether a launch file starts Gazebo by a command, or a file that starts no more."""
    for launch in workspace.launches.outermost:
        if any(command.startswith(_GAZEBO) for command in launch.command_texts):
            return True
        if any(map(_is_of_gazebo, launch.passed)):
            return True
    return False


def _is_of_gazebo(passed: PassedArguments) -> bool:
    """Return whether a launch file that is included starts Gazebo, or a robot in it, alone."""
    package, file = share_parts(f"{PREFIX}/{passed.path}")
    is_alone = package == "ros_gz_sim" and file.removeprefix("launch/") in _OF_GAZEBO
    return is_alone and passed.when is not False


def _may_bridge_clock(workspace: Workspace) -> bool:
    """Return whether a bridge that is not read, or a person, may take the clock from Gazebo."""
    if _is_mentioned(workspace, ("/clock", _CLOCK.partition(".")[0])):
        return True
    if any("/clock" in text for text in workspace.texts.loose_texts(_LOOSE)):
        return True
    bridges = [node for node in workspace.launches.nodes if node.package in _BRIDGES]
    if not bridges:
        return any(bridge in text for text in workspace.texts.launch_texts for bridge in _BRIDGES)
    return not all(are_rows_known(workspace, node) for node in bridges)


def _may_start_clock(workspace: Workspace, launch: Launch) -> bool:
    """Return whether a command or an included launch file may start a simulation."""
    ending = (*ros_machine().ending_commands, *commands_that_end(), *_GAZEBO)
    if not all(command.startswith(ending) for command in launch.command_texts):
        return True
    for passed in launch.passed:
        package = share_parts(f"{PREFIX}/{passed.path}")[0]
        is_own = workspace.installed.find_source(passed.path) is not None
        if not (is_own or _is_of_gazebo(passed) or package_row(package).launches_no_clock):
            return True
    return False


def _may_be_clock(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether a node may publish /clock: own code, or a program whose name says so."""
    package = workspace.find_package(node)
    if package:
        code = workspace.code.by_package.get(package.name)
        if code and not code.doubts:
            programs = {program.name for program in code.programs}
            if node.executable not in programs:
                return False  # there is none, which another rule says
        return may_publish_type(workspace, node, _CLOCK)
    is_open = "frames" not in package_row(node.package).without
    return is_open and _says_clock(f"{node.package} {node.executable}")


def _says_clock(text: str) -> bool:
    """Return whether a name or a page has a word of simulations or of players."""
    return not set(_WORD.findall(text.lower())).isdisjoint(shared_names().clock_words)


def _is_told(workspace: Workspace) -> bool:
    """Return whether the workspace says how to start a simulation, or uses the time.

    A page or a script says it, or a program that is not started uses the type of the time.
    """
    if any(map(_says_clock, workspace.texts.loose_texts(_LOOSE))):
        return True
    for package in workspace.packages:
        for source in workspace.texts.read_sources(package, _PAGES):
            if _says_clock(source.text):
                return True
        for source in workspace.texts.read_sources(package, CODE_ENDINGS):
            if _CLOCK.partition(".")[0] in source.text:
                return True
    return False


_SIMULATION_TIME = Rule(
    "simulation-time",
    "wiring",
    NO_COMPANION,
    "The nodes of a simulation use its time.",
    why=(
        "Such a node compares simulated stamps with the time of the machine. It takes messages "
        "and transforms for outdated and ignores them."
    ),
    symptoms=(EXTRAPOLATION,),
    wrong="""
Node(package='ros_gz_bridge', executable='parameter_bridge',
     arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock']),
Node(package='robot_localization', executable='ekf_node'),
""",
    right="""
Node(package='ros_gz_bridge', executable='parameter_bridge',
     arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock']),
Node(package='robot_localization', executable='ekf_node', parameters=[{'use_sim_time': True}]),
""",
)


def _wall_time(workspace: Workspace) -> Mismatches:
    """Yield that nodes compare times in a simulation whose clock they do not use."""
    rows = [row for row in bridge_rows(workspace) if row.is_published and row.ros_type == _CLOCK]
    if not rows or _is_mentioned(workspace, (_TIME,)):
        return
    for node in workspace.launches.nodes:
        if package_row(node.package).compares_time and node.when:
            message = (
                f"{node.executable} uses the time of the machine, but the simulation has its own "
                f"clock ({rows[0].location.file_and_line}): give the nodes use_sim_time"
            )
            yield warning(_SIMULATION_TIME, message, node.location, rows[0].location)
            return
