"""Gazebo: the topics of sensors and systems in the robot and in worlds, and what launch files
ask of the simulation.
"""

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import pairwise
from typing import NamedTuple

from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import parameters_of
from grader.ros.package.installed_files import open_meant
from grader.ros.workspace.names import Fact, Mismatch, corrections, place_text
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
            for kinds, is_input in _topic_elements(element):
                for tag, kind in kinds.items():
                    for child in element.iterchildren(tag):
                        name = (child.text or "").strip().strip("/")
                        if name:
                            yield GazeboTopic(name, kind, is_input, place(child))


def _topic_elements(element: Element) -> Iterator[tuple[Mapping[str, str], bool]]:
    """Yield the types of the topics of a sensor or a system by the elements that name them, and
    if it reads these.
    """
    if element.tag == "sensor":
        kind = known()["gazebo_sensors"].get(element.get("type", ""))
        yield ({"topic": kind} if kind is not None else {}), False
    else:
        system = known()["gazebo_systems"].get(system_of(element), {})
        yield system.get("in", {}), True
        yield system.get("out", {}), False


def system_of(plugin: Element) -> str:
    """Return the name of the class of a system, such as DiffDrive."""
    return plugin.get("name", "").rpartition("::")[2]


def roots(workspace: Workspace) -> Iterator[tuple[Element, Callable[[Element], Location]]]:
    """Yield the roots of the robot and of the models and worlds, each with where its elements
    are written.
    """
    if workspace.robot_root is not None:
        yield workspace.robot_root, workspace.place
    yield from ((file.root, file.location) for file in workspace.sdf_files)


def gazebo_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield systems that worlds lack, and what is spawned, or bridged, from what is not there."""
    texts = workspace.launch_texts
    files = [
        it
        for it in workspace.sdf_files
        if any(it.source.path.rpartition("/")[2] in text for text in texts)
    ]
    worlds = [(file, world) for file in files for world in file.root.iterchildren("world")]
    for file, world in worlds:
        yield from _missing_systems(workspace, file, world)
    for _, node in workspace.nodes:
        if node.package == _SIMULATION and node.executable == "create":
            yield from _spawned(
                workspace, node, {world.get("name", ""): file for file, world in worlds}
            )
    yield from _bridges(workspace)


def _missing_systems(workspace: Workspace, file: XmlFile, world: Element) -> Iterator[Mismatch]:
    """Yield the systems that a world of its own systems lacks for sensors in it and in the
    robot.
    """
    own = {system_of(plugin) for root, _ in roots(workspace) for plugin in root.iter("plugin")}
    is_created = any(
        node.package == _SIMULATION and node.executable == "create" for _, node in workspace.nodes
    )
    if next(world.iterchildren("plugin"), None) is None or workspace.robot is None:
        return  # Gazebo loads its default systems
    sensors = [
        (sensor, place(sensor))
        for root, place in roots(workspace)
        for sensor in root.iter("sensor")
        if root is file.root or (root is workspace.robot_root and is_created)
    ]
    for sensor, at in sensors:
        system = known()["sensor_systems"].get(sensor.get("type", ""))
        if system is not None and system not in own:
            own.add(system)
            message = (
                f"the world has no plugin gz::sim::systems::{system}, so the sensor "
                f"{quoted(sensor.get('name', ''))}"
            )
            text = f"{message} ({place_text(at)}) publishes nothing"
            yield Mismatch("topics", text, file.location(world), at)


def _spawned(
    workspace: Workspace, node: StartedNode, worlds: Mapping[str, XmlFile]
) -> Iterator[Mismatch]:
    """Yield that a robot is spawned from a topic that nothing publishes, or in a world of another
    name.
    """
    words = node.arguments or ()
    given = {
        key.lstrip("-"): value
        for key, value in pairwise(words)
        if key is not None and value is not None
    }
    publishers = [it for _, it in workspace.nodes if it.package == "robot_state_publisher"]
    topics = [it.topic("robot_description") for it in publishers]
    name = node.topic(given["topic"]) if "topic" in given else None
    if (
        name is not None
        and topics
        and None not in topics
        and name not in topics
        and not workspace.unknown_nodes
    ):
        meant = topics[0] or ""
        message = f"the robot is created from {name}, but robot_state_publisher publishes {meant}"
        either = corrections(given["topic"], node.location, meant.strip("/"))
        yield Mismatch("topics", message, node.location, publishers[0].location, corrections=either)
    if "world" in given and len(worlds) == 1 and given["world"] not in worlds:
        [(world, file)] = worlds.items()
        message = (
            f"the robot is created in the world {quoted(given['world'])}, but the world of "
            f"{file.source.path}"
        )
        at = file.location(next(file.root.iterchildren("world")))
        either = corrections(given["world"], node.location, world)
        yield Mismatch(
            "topics", f"{message} is {quoted(world)}", node.location, at, corrections=either
        )


def _bridges(workspace: Workspace) -> Iterator[Mismatch]:
    """Yield bridges without any topic."""
    for package, node in workspace.nodes:
        if (
            node.package == BRIDGE
            and node.executable == "parameter_bridge"
            and node.arguments == ()
        ):
            found = parameters_of(
                node, partial(open_meant, package), workspace.name_of(node) or "", is_python=False
            )
            if not found.unknown and "config_file" not in found.values:
                message = (
                    "the bridge has no topics: neither arguments, nor the parameter config_file"
                )
                yield Mismatch("topics", message, node.location)
