"""Gazebo: the topics of sensors and systems, and what launch files ask of the simulation.

The sensors and systems are those in the robot and in worlds.
"""

from collections.abc import Iterator, Mapping
from itertools import pairwise

from grader.base.names import closest, last_part
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.known.gazebo_rows import NO_SENSOR, gazebo
from grader.ros.known.package_tables import create_table
from grader.ros.launch.launch_model import StartedNode
from grader.ros.xml.parsing import Element, XmlFile
from grader.workspace.graph.bridge_rows import PARAMETER_BRIDGE
from grader.workspace.graph.gazebo_topics import list_systems, roots
from grader.workspace.graph.started_worlds import started_worlds
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Facts,
    Mismatch,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_COMPANION,
    NO_PARAMETER,
    NO_TOPIC,
    NO_WORD,
    Rule,
    Symptom,
)
from grader.workspace.rules.shared_symptoms import WORLD_AWAITED

_SIMULATION = "ros_gz_sim"
_CLASSIC_CREATOR = "spawn_entity.py"  # of gazebo_ros, with the same option
_OPTION = on_use(r"--?[A-Za-z]")
_WITHOUT_VALUE = "allow_renaming"  # an option of create


def gazebo_facts(workspace: Workspace) -> Facts:
    """Yield systems that worlds lack, and what is spawned, or bridged, from what is not there."""
    worlds = {}  # those that launch files name
    for file in workspace.texts.sdf_files:
        name = last_part(file.source.path)
        if any(name in text for text in workspace.texts.searched_launch_texts()):
            for world in file.root.iterchildren("world"):
                worlds[world.get("name", "")] = file
                yield from _missing_systems(workspace, file, world)
    for node in workspace.launches.nodes:
        if _is_creator(node) or node.executable == _CLASSIC_CREATOR:
            yield from _created_from_topic(workspace, node)
        if _is_creator(node):
            yield from _created_in_world(node, worlds)
            yield from _unknown_options(node)
            yield from _created_from_nothing(node)
    yield from _created_without_gazebo(workspace)
    yield from _bridges(workspace)


_SIMULATION_STARTED = Rule(
    "simulation-started",
    "wiring",
    NO_COMPANION,
    "Something starts the Gazebo in which a robot is created.",
    why=(
        "'create' waits for a service of Gazebo that nothing offers. No robot appears, and "
        "nodes that need /clock wait too."
    ),
    symptoms=(WORLD_AWAITED,),
    wrong="""
DeclareLaunchArgument('world', default_value=os.path.join(share, 'worlds', 'world.sdf')),
Node(package='ros_gz_sim', executable='create', arguments=['-string', robot]),
""",
    right="""
IncludeLaunchDescription(
    os.path.join(gazebo, 'launch', 'gz_sim.launch.py'),
    launch_arguments={'gz_args': os.path.join(share, 'worlds', 'world.sdf')}.items(),
),
Node(package='ros_gz_sim', executable='create', arguments=['-string', robot]),
""",
    beside={
        "world.sdf": """
<plugin filename="gz-sim-user-commands-system" name="gz::sim::systems::UserCommands"/>
""",
    },
)


def _created_without_gazebo(workspace: Workspace) -> Mismatches:
    """Yield that a robot is created, and that no launch file starts Gazebo with its world.

    Nothing is said where launch files name no world of the workspace: another command may start it.
    """
    creators = [node for node in workspace.launches.nodes if _is_creator(node) and node.when]
    if creators and not started_worlds(workspace).may_start:
        message = "no launch file starts Gazebo, for which create waits"
        yield warning(_SIMULATION_STARTED, message, creators[0].location)


def _is_creator(node: StartedNode) -> bool:
    """Return whether a node creates a robot in the simulation."""
    return node.package == _SIMULATION and node.executable == "create"


_SENSOR_SYSTEM = Rule(
    "sensor-system",
    "topics",
    NO_TOPIC,
    "A world has the systems that its sensors need.",
    why=(
        "Gazebo updates a sensor only if the world loads the system for its type. Without it "
        "the sensor publishes nothing, and RViz shows no data."
    ),
    wrong='<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>',
    right="""
<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>
""",
    frame="world.sdf",
    beside={
        "lidar/rover.urdf": "",
        "rover.launch.py": """
IncludeLaunchDescription(
    os.path.join(gazebo, 'launch', 'gz_sim.launch.py'),
    launch_arguments={'gz_args': os.path.join(share, 'worlds', 'world.sdf')}.items(),
),
Node(package='ros_gz_sim', executable='create', arguments=['-string', robot]),
""",
    },
    at="worlds/world.sdf",
)


def _missing_systems(workspace: Workspace, file: XmlFile, world: Element) -> Mismatches:
    """Yield the systems that a world lacks for sensors in it and in the robot.

    The world has systems of its own.

    Gazebo loads its default systems in a world without any. Which one of several robots is created
    in the world is not evaluated.
    """
    if next(world.iterchildren("plugin"), None) is None or not workspace.robots.known:
        return
    systems = list_systems(workspace)
    for sensor, at in _sensors_in_world(workspace, file):
        system = gazebo().sensor.get(sensor.get("type", ""), NO_SENSOR).system
        if system and system not in systems:
            systems.add(system)
            message = (
                f"the world has no plugin gz::sim::systems::{system}, so the sensor "
                f"{quoted(sensor.get('name', ''))} ({at.file_and_line}) publishes nothing"
            )
            yield Mismatch(_SENSOR_SYSTEM, message, file.location(world), at)


def _sensors_in_world(workspace: Workspace, file: XmlFile) -> Iterator[tuple[Element, Location]]:
    """Yield the sensors of a file of a world, and of the only robot, if it is created."""
    seen = [file.root]
    is_created = any(_is_creator(node) for node in workspace.launches.nodes)
    if is_created and len(workspace.robots.known) == 1:
        seen.append(workspace.robots.known[0].root)
    for root, place in roots(workspace):
        if any(root is each for each in seen):
            for sensor in root.iter("sensor"):
                yield sensor, place(sensor)


def _values_of_options(node: StartedNode) -> Mapping[str, str]:
    """Return the words after the options of a program, where both are known."""
    options = {}
    for key, value in pairwise(node.arguments or ()):
        if key is not None and value is not None:
            options[key.lstrip("-")] = value
    return options


_CREATED_WORLD = Rule(
    "created-world",
    "topics",
    NO_TOPIC,
    "A robot is created in the world that Gazebo runs.",
    why=(
        "'create' calls a service of the named world, which Gazebo does not offer. It waits or "
        "fails, and no robot appears in the simulation."
    ),
    symptoms=(WORLD_AWAITED,),
    wrong="""
IncludeLaunchDescription(
    os.path.join(gazebo, 'launch', 'gz_sim.launch.py'),
    launch_arguments={'gz_args': os.path.join(share, 'worlds', 'world.sdf')}.items(),
),
Node(package='ros_gz_sim', executable='create', arguments=['-world', 'feild', '-string', robot]),
""",
    right="""
IncludeLaunchDescription(
    os.path.join(gazebo, 'launch', 'gz_sim.launch.py'),
    launch_arguments={'gz_args': os.path.join(share, 'worlds', 'world.sdf')}.items(),
),
Node(package='ros_gz_sim', executable='create', arguments=['-world', 'field', '-string', robot]),
""",
    beside={
        "world.sdf": '<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>',
    },
)


def _created_in_world(node: StartedNode, worlds: Mapping[str, XmlFile]) -> Mismatches:
    """Yield that a robot is created in another world than the one that launch files name.

    The name is compared where launch files name only one world.
    """
    wanted = _values_of_options(node).get("world")
    if wanted is None or len(worlds) != 1 or wanted in worlds:
        return
    [(world, file)] = worlds.items()
    message = (
        f"the robot is created in the world {quoted(wanted)}, but the world of "
        f"{file.source.path} is {quoted(world)}"
    )
    at = file.location(next(file.root.iterchildren("world")))
    yield Mismatch(_CREATED_WORLD, message, node.location, at).correcting(wanted, world)


def _options_given(node: StartedNode) -> list[str] | None:
    """Return the options that the program that creates robots gets.

    The result is None where not all are known.
    """
    words = node.arguments
    if words is None or None in words:
        return None
    given = []
    is_value = False
    for word in words:
        if word is None or word == "--ros-args":
            break
        if is_value or not _OPTION.match(word):
            is_value = False
            continue
        name, equals, _ = word.lstrip("-").replace("-", "_").partition("=")  # as gflags does
        given.append(name)
        is_value = not equals and name in create_table().options and name != _WITHOUT_VALUE
    return given


_CREATE_OPTION = Rule(
    "create-option",
    "words",
    NO_WORD,
    "The program that creates a robot in Gazebo has the given options.",
    why=(
        "The program 'create' reports no unknown options. The robot appears with another name "
        "or at the origin of the world."
    ),
    wrong="""
Node(package='ros_gz_sim', executable='create',
     arguments=['-topic', 'robot_description', '-entity', 'rover']),
""",
    right="""
Node(package='ros_gz_sim', executable='create',
     arguments=['-topic', 'robot_description', '-name', 'rover']),
""",
)


def _unknown_options(node: StartedNode) -> Mismatches:
    """Yield the options that the program that creates robots does not have, and ignores."""
    for name in _options_given(node) or ():
        if name in create_table().options:
            continue
        similar = closest(name, create_table().options, is_clear=True)
        meant = create_table().older.get(name) or similar
        guess = f"; did you mean -{meant}?" if meant else ""
        message = f"create has no option -{name}, and ignores it{guess}"
        wrong = warning(_CREATE_OPTION, message, node.location)
        yield wrong.offering(f"-{name}", f"-{meant}" if meant else None)


_CREATED_FROM = Rule(
    "created-from",
    "parameters",
    NO_PARAMETER,
    "The program that creates a robot in Gazebo gets its source.",
    why=(
        "The program 'create' prints an error and ends, so no robot appears in Gazebo. Spawners"
        " that wait for its controller manager then wait too."
    ),
    symptoms=(
        Symptom(
            "create-source",
            pattern=r"Must specify either -file, -param, -string or -topic",
            source="gazebosim/ros_gz a4d00a9, ros_gz_sim/src/create.cpp:214",
            sentence="The program that creates a robot gets no source of it.",
            example="Must specify either -file, -param, -string or -topic",
        ),
    ),
    wrong="Node(package='ros_gz_sim', executable='create', arguments=['-name', 'rover']),",
    right="""
Node(package='ros_gz_sim', executable='create', arguments=['-name', 'rover', '-string', robot]),
""",
)


def _created_from_nothing(node: StartedNode) -> Mismatches:
    """Yield that the program that creates robots gets no source of one. Parameters may name it."""
    given = _options_given(node)
    if given is None or node.parameters != () or set(given).intersection(create_table().sources):
        return
    sources = enumerated([f"-{name}" for name in create_table().sources], word="or")
    message = f"create ends with an error: it needs {sources}"
    yield Mismatch(_CREATED_FROM, message, node.location, is_certain=node.when is True)


_CREATED_TOPIC = Rule(
    "created-topic",
    "topics",
    NO_TOPIC,
    "A robot is created from the topic that robot_state_publisher has.",
    why=(
        "'create' prints 'Waiting messages on topic' again and again, because nothing publishes"
        " the description there. No robot appears in Gazebo."
    ),
    symptoms=(
        Symptom(
            "robot-awaited",
            pattern=(
                r"Waiting (?:messages on topic \[|for entity xml on )/?(?P<topic>[\w/]{1,200}+)"
            ),
            source="gazebosim/ros_gz a4d00a9, ros_gz_sim/src/create.cpp:79",
            sentence=(
                "The program that creates a robot gets none: nothing publishes the topic, or in "
                "another namespace."
            ),
            example="Waiting messages on topic [robot_description].",
            within=("topic",),
            place="description",
        ),
    ),
    wrong="""
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot}]),
Node(package='ros_gz_sim', executable='create', arguments=['-topic', 'description']),
""",
    right="""
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot}]),
Node(package='ros_gz_sim', executable='create', arguments=['-topic', 'robot_description']),
""",
)


def _created_from_topic(workspace: Workspace, node: StartedNode) -> Mismatches:
    """Yield that no robot_state_publisher publishes the topic from which a robot is created.

    Nothing is said where more nodes may be started, or one of them may publish the topic.
    """
    topic = _values_of_options(node).get("topic")
    name = node.topic(topic) if topic is not None else None
    if topic is None or name is None or workspace.launches.unknown_nodes:
        return
    published: dict[str, Location] = {}
    for other in workspace.launches.nodes:
        if other.package == "robot_state_publisher":
            description = other.topic("robot_description")
            if description is None:
                return
            published.setdefault(description, other.location)
    if published and name not in published:
        meant, at = next(iter(published.items()))
        message = f"the robot is created from {name}, but robot_state_publisher publishes {meant}"
        wrong = Mismatch(_CREATED_TOPIC, message, node.location, at)
        yield wrong.correcting(topic, meant.strip("/"))


_BRIDGE_TOPICS = Rule(
    "bridge-topics",
    "topics",
    NO_TOPIC,
    "A bridge has topics.",
    why=(
        "The program passes no message between Gazebo and ROS 2: no sensor data arrive, and "
        "commands move nothing."
    ),
    wrong="Node(package='ros_gz_bridge', executable='parameter_bridge'),",
    right="""
Node(
    package='ros_gz_bridge',
    executable='parameter_bridge',
    arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock'],
),
""",
)


def _bridges(workspace: Workspace) -> Mismatches:
    """Yield bridges without any topic."""
    for package, node in workspace.launches.placed_nodes:
        if node.program == PARAMETER_BRIDGE and node.arguments == ():
            given = workspace.parameters.given_to(package, node)
            if not given.unknown and "config_file" not in given.values:
                message = (
                    "the bridge has no topics: neither arguments, nor the parameter config_file"
                )
                yield Mismatch(_BRIDGE_TOPICS, message, node.location)
