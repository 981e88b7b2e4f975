"""Gazebo: the topics of sensors and systems in the robot and in worlds, and what launch files
ask of the simulation.
"""

import re
from collections.abc import Iterator, Mapping
from itertools import pairwise

from grader.base.names import closest
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.known.gazebo_rows import NO_SENSOR, gazebo
from grader.ros.known.package_tables import create_table
from grader.ros.launch.launch_model import StartedNode
from grader.ros.workspace.graph.bridge_rows import BRIDGE
from grader.ros.workspace.graph.gazebo_topics import roots, system_of
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Fact, Mismatch, corrections, warning
from grader.ros.workspace.rules.rule_table import (
    BRIDGE_TOPICS,
    CREATE_OPTION,
    CREATED_FROM,
    CREATED_TOPIC,
    CREATED_WORLD,
    SENSOR_SYSTEM,
)
from grader.ros.xml.parsing import Element, XmlFile

_SIMULATION = "ros_gz_sim"
_OPTION = re.compile(r"--?[A-Za-z]")
_WITHOUT_VALUE = "allow_renaming"  # an option of create


def gazebo_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield systems that worlds lack, and what is spawned, or bridged, from what is not there."""
    worlds: dict[str, XmlFile] = {}  # those that launch files name
    for file in workspace.texts.sdf_files:
        name = file.source.path.rpartition("/")[2]
        if any(name in text for text in workspace.texts.searched_launch_texts()):
            for world in file.root.iterchildren("world"):
                worlds[world.get("name", "")] = file
                yield from _missing_systems(workspace, file, world)
    for _, node in workspace.launches.nodes:
        if _is_creator(node):
            yield from _created(workspace, node, worlds)
            yield from _options_of_creator(node)
    yield from _bridges(workspace)


def _is_creator(node: StartedNode) -> bool:
    """Return whether a node creates a robot in the simulation."""
    return node.package == _SIMULATION and node.executable == "create"


def _missing_systems(workspace: Workspace, file: XmlFile, world: Element) -> Iterator[Mismatch]:
    """Yield the systems that a world of its own systems lacks for sensors in it and in the
    robot.
    """
    if next(world.iterchildren("plugin"), None) is None or not workspace.robots.known:
        return  # Gazebo loads its default systems
    systems = set()
    for root, _ in roots(workspace):
        systems |= {system_of(plugin) for plugin in root.iter("plugin")}
    seen = [file.root]
    # Which one of several robots is created in it is not evaluated.
    if len(workspace.robots.known) == 1 and any(
        _is_creator(node) for _, node in workspace.launches.nodes
    ):
        seen.append(workspace.robots.known[0].root)
    for root, place in roots(workspace):
        if not any(root is it for it in seen):
            continue
        for sensor in root.iter("sensor"):
            system = gazebo().sensor.get(sensor.get("type", ""), NO_SENSOR).system
            if not system or system in systems:
                continue
            systems.add(system)
            at = place(sensor)
            message = (
                f"the world has no plugin gz::sim::systems::{system}, so the sensor "
                f"{quoted(sensor.get('name', ''))} ({at.file_and_line}) publishes nothing"
            )
            yield Mismatch(SENSOR_SYSTEM, message, file.location(world), at)


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
        yield Mismatch(CREATED_WORLD, message, node.location, at, corrections=either)


def _options_of_creator(node: StartedNode) -> Iterator[Mismatch]:
    """Yield the options that the program does not have, and that it gets no model."""
    words = node.arguments
    if words is None or None in words:
        return
    given: list[str] = []
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
    for name in given:
        if name in create_table().options:
            continue
        similar = closest(name, create_table().options, is_clear=True)
        meant = create_table().older.get(name) or similar
        guess = f"; did you mean -{meant}?" if meant else ""
        message = f"create has no option -{name}, and ignores it{guess}"
        yield warning(CREATE_OPTION, message, node.location)
    if node.parameters == () and not set(given).intersection(create_table().sources):
        sources = enumerated([f"-{name}" for name in create_table().sources], word="or")
        message = f"create ends with an error: it needs {sources}"
        yield Mismatch(CREATED_FROM, message, node.location, is_certain=node.when is True)


def _created_from(workspace: Workspace, node: StartedNode, topic: str) -> Iterator[Mismatch]:
    """Yield that no robot_state_publisher publishes the topic from which a robot is created."""
    name = node.topic(topic)
    if name is None or workspace.launches.unknown_nodes:
        return
    published: dict[str, Location] = {}
    for _, other in workspace.launches.nodes:
        if other.package == "robot_state_publisher":
            description = other.topic("robot_description")
            if description is None:
                return  # it may publish the topic
            published.setdefault(description, other.location)
    if published and name not in published:
        meant, at = next(iter(published.items()))
        message = f"the robot is created from {name}, but robot_state_publisher publishes {meant}"
        either = corrections(topic, node.location, meant.strip("/"))
        yield Mismatch(CREATED_TOPIC, message, node.location, at, corrections=either)


def _bridges(workspace: Workspace) -> Iterator[Mismatch]:
    """Yield bridges without any topic."""
    for package, node in workspace.launches.nodes:
        is_bridge = node.package == BRIDGE and node.executable == "parameter_bridge"
        if is_bridge and node.arguments == ():
            given = workspace.parameters.given_to(package, node)
            if not given.unknown and "config_file" not in given.values:
                message = (
                    "the bridge has no topics: neither arguments, nor the parameter config_file"
                )
                yield Mismatch(BRIDGE_TOPICS, message, node.location)
