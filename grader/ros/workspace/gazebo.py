"""Gazebo: the topics of sensors and systems in the robot and in worlds, and what launch files
ask of the simulation.
"""

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.workspace.names import Fact, Mismatch, corrections
from grader.ros.workspace.workspace import Workspace
from grader.ros.xml.parsing import Element, XmlFile

BRIDGE, _SIMULATION = "ros_gz_bridge", "ros_gz_sim"


class GazeboTopic(NamedTuple):
    """A topic of a sensor or a system, without the first slash, and the last word of the type of
    its messages.
    """

    name: str
    type: str
    is_input: bool  # of commands, to which Gazebo subscribes
    location: Location


def gazebo_topics(workspace: Workspace) -> Iterator[GazeboTopic]:
    """Yield the topics that are named in the robot, in models and in worlds, and whose types are
    known.
    """
    for root, place in roots(workspace):
        for element in root.iter("sensor", "plugin"):
            for tag, kind, is_input in _topic_elements(element):
                for child in element.iterchildren(tag):
                    name = (child.text or "").strip().strip("/")
                    if name:
                        yield GazeboTopic(name, kind, is_input, place(child))


def _topic_elements(element: Element) -> Iterator[tuple[str, str, bool]]:
    """Yield the elements that name the topics of a sensor or a system, with the types of these, and
    whether it reads them.
    """
    if element.tag == "sensor":
        kind = known()["gazebo_sensors"].get(element.get("type", ""))
        if kind is not None:
            yield "topic", kind, False
        return
    system = known()["gazebo_systems"].get(system_of(element), {})
    for tag, kind in system.get("in", {}).items():
        yield tag, kind, True
    for tag, kind in system.get("out", {}).items():
        yield tag, kind, False


def system_of(plugin: Element) -> str:
    """Return the name of the class of a system, such as DiffDrive."""
    return plugin.get("name", "").rpartition("::")[2]


def roots(workspace: Workspace) -> Iterator[tuple[Element, Callable[[Element], Location]]]:
    """Yield the roots of the robots and of the models and worlds, each with where its elements
    are written.
    """
    yield from ((robot.root, robot.place) for robot in workspace.robots)
    yield from ((file.root, file.location) for file in workspace.sdf_files)


def gazebo_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield systems that worlds lack, and what is spawned, or bridged, from what is not there."""
    worlds: dict[str, XmlFile] = {}  # those that launch files name
    for file in workspace.sdf_files:
        name = file.source.path.rpartition("/")[2]
        if any(name in text for text in workspace.searched_launch_texts()):
            for world in file.root.iterchildren("world"):
                worlds[world.get("name", "")] = file
                yield from _missing_systems(workspace, file, world)
    for _, node in workspace.nodes:
        if _is_creator(node):
            yield from _created(workspace, node, worlds)
    yield from _bridges(workspace)


def _is_creator(node: StartedNode) -> bool:
    """Return whether a node creates a robot in the simulation."""
    return node.package == _SIMULATION and node.executable == "create"


def _missing_systems(workspace: Workspace, file: XmlFile, world: Element) -> Iterator[Mismatch]:
    """Yield the systems that a world of its own systems lacks for sensors in it and in the
    robot.
    """
    if next(world.iterchildren("plugin"), None) is None or not workspace.robots:
        return  # Gazebo loads its default systems
    systems = set()
    for root, _ in roots(workspace):
        systems |= {system_of(plugin) for plugin in root.iter("plugin")}
    seen = [file.root]
    # Which one of several robots is created in it is not evaluated.
    if len(workspace.robots) == 1 and any(_is_creator(node) for _, node in workspace.nodes):
        seen.append(workspace.robots[0].root)
    for root, place in roots(workspace):
        if not any(root is it for it in seen):
            continue
        for sensor in root.iter("sensor"):
            system = known()["sensor_systems"].get(sensor.get("type", ""))
            if system is None or system in systems:
                continue
            systems.add(system)
            at = place(sensor)
            message = (
                f"the world has no plugin gz::sim::systems::{system}, so the sensor "
                f"{quoted(sensor.get('name', ''))} ({at.file_and_line}) publishes nothing"
            )
            yield Mismatch("topics", message, file.location(world), at)


def _created(
    workspace: Workspace, node: StartedNode, worlds: Mapping[str, XmlFile]
) -> Iterator[Mismatch]:
    """Yield that a robot is created from a topic that nothing publishes, or in a world of another
    name.
    """
    options: dict[str, str] = {}
    for key, value in pairwise(node.arguments or ()):
        if key is not None and value is not None:
            options[key.lstrip("-")] = value
    if "topic" in options:
        yield from _created_from(workspace, node, options["topic"])
    if "world" in options and len(worlds) == 1 and options["world"] not in worlds:
        [(world, file)] = worlds.items()
        message = (
            f"the robot is created in the world {quoted(options['world'])}, but the world of "
            f"{file.source.path} is {quoted(world)}"
        )
        at = file.location(next(file.root.iterchildren("world")))
        either = corrections(options["world"], node.location, world)
        yield Mismatch("topics", message, node.location, at, corrections=either)


def _created_from(workspace: Workspace, node: StartedNode, topic: str) -> Iterator[Mismatch]:
    """Yield that no robot_state_publisher publishes the topic from which a robot is created."""
    name = node.topic(topic)
    if name is None or workspace.unknown_nodes:
        return
    published: dict[str, Location] = {}
    for _, other in workspace.nodes:
        if other.package == "robot_state_publisher":
            description = other.topic("robot_description")
            if description is None:
                return  # it may publish the topic
            published.setdefault(description, other.location)
    if published and name not in published:
        meant, at = next(iter(published.items()))
        message = f"the robot is created from {name}, but robot_state_publisher publishes {meant}"
        either = corrections(topic, node.location, meant.strip("/"))
        yield Mismatch("topics", message, node.location, at, corrections=either)


def _bridges(workspace: Workspace) -> Iterator[Mismatch]:
    """Yield bridges without any topic."""
    for package, node in workspace.nodes:
        is_bridge = node.package == BRIDGE and node.executable == "parameter_bridge"
        if is_bridge and node.arguments == ():
            given = workspace.parameters_given(package, node)
            if not given.unknown and "config_file" not in given.values:
                message = (
                    "the bridge has no topics: neither arguments, nor the parameter config_file"
                )
                yield Mismatch("topics", message, node.location)
