"""The topics of sensors and systems of Gazebo, as robots, models and worlds name them."""

from collections.abc import Callable, Iterator

from grader.base.records import Named
from grader.base.source import Location
from grader.ros.known.gazebo_rows import NO_SYSTEM, gazebo
from grader.ros.xml.elements import first_text
from grader.ros.xml.parsing import Element
from grader.workspace.model.workspace import Workspace


class GazeboTopic(Named):
    """A topic of a sensor or a system, and the last word of the type of its messages.

    The topic has no first slash.
    """

    name: str
    type: str
    is_input: bool  # of commands, to which Gazebo subscribes
    location: Location


def gazebo_topics(workspace: Workspace) -> Iterator[GazeboTopic]:
    """Yield the topics that the robot, models and worlds name, and whose types are known."""
    for root, place in roots(workspace):
        for sensor in root.iter("sensor"):
            for child in sensor.iterchildren("topic"):
                for name, kind in sensor_topics(sensor, child):
                    yield GazeboTopic(name, kind, is_input=False, location=place(child))
        for plugin in root.iter("plugin"):
            system = gazebo().system.get(name_system(plugin), NO_SYSTEM)
            for is_input, topics in ((True, system.subscriptions), (False, system.publishers)):
                for tag, kind in topics.items():
                    for child in plugin.iterchildren(tag):
                        name = _plain_topic(child)
                        if name:
                            yield GazeboTopic(name, kind, is_input, place(child))


def _plain_topic(element: Element) -> str:
    return first_text(element).strip("/")


def sensor_topics(sensor: Element, element: Element) -> Iterator[tuple[str, str]]:
    """Yield the topics that a sensor makes of the one in its <topic>, with the types of messages.

    The type of the sensor is a known one.
    """
    types = gazebo().sensor.get(sensor.get("type", ""))
    name = _plain_topic(element)
    if not types or not name:
        return
    if types.topic:
        yield name, types.topic
    for last, kind in types.below.items():
        yield f"{name}/{last}", kind
    if next(sensor.iter("camera_info_topic"), None) is None:
        above = name.rpartition("/")[0]
        for last, kind in types.beside.items():
            yield f"{above}/{last}".removeprefix("/"), kind


def name_system(plugin: Element) -> str:
    """Return the name of the class of a system, such as DiffDrive."""
    return plugin.get("name", "").rpartition("::")[2]


def elements_in(
    workspace: Workspace, tag: str
) -> Iterator[tuple[Element, Callable[[Element], Location]]]:
    """Yield the elements of a tag in robots, models and worlds, with where these are written."""
    for root, place in roots(workspace):
        yield from ((element, place) for element in root.iter(tag))


def list_systems(workspace: Workspace) -> set[str]:
    """Return the systems that robots, models and worlds load."""
    return {name_system(plugin) for plugin, _ in elements_in(workspace, "plugin")}


def roots(workspace: Workspace) -> Iterator[tuple[Element, Callable[[Element], Location]]]:
    """Yield the roots of robots, models and worlds, each with where its elements are written."""
    yield from ((robot.root, robot.place) for robot in workspace.robots.known)
    yield from ((file.root, file.location) for file in workspace.texts.sdf_files)
