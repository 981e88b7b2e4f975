"""Bridges between Gazebo and ROS: the rows of ros_gz_bridge, and the topics of sensors in the robot and in worlds."""

import posixpath
import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from grader.errors import InputError
from grader.names import closest
from grader.package.yaml_nodes import YamlNode
from grader.source import Location, Source
from grader.text import quoted
from grader.workspace.names import Compared, Fact, Mismatch, corrections, place_text
from grader.workspace.workspace import Workspace
from grader.xml.parsing import Element, XmlFault, XmlFile

BRIDGE = "ros_gz_bridge"
_TO_ROS, _TO_GAZEBO, _BOTH = "GZ_TO_ROS", "ROS_TO_GZ", "BIDIRECTIONAL"
_DIRECTIONS = {"[": _TO_ROS, "]": _TO_GAZEBO, "@": _BOTH}
_ARGUMENT = re.compile(r"(?P<topic>[^@\s]+)@(?P<ros>[\w/]+)(?P<direction>[@\[\]])(?P<gz>[\w.]+)")
_LAUNCHES = (".launch.py", "_launch.py", ".launch.xml", ".launch.yaml", ".launch")
_MAX_SDF = 512 * 1024  # bytes
# The last word of a message's type, by the type of the sensor that publishes it on its <topic>: gz-sensors.
_SENSORS = {
    "camera": "Image", "depth_camera": "Image", "depth": "Image", "gpu_lidar": "LaserScan", "lidar": "LaserScan",
    "gpu_ray": "LaserScan", "ray": "LaserScan", "imu": "IMU",
}  # fmt: skip
_DERIVED = ("points", "image", "depth_image", "camera_info")  # below the topic, or beside it
# Models in worlds that have no sensors.
_WITHOUT_SENSORS = ("sun", "ground_plane", "ground plane")


class _BridgeRow(NamedTuple):
    """What a bridge takes from a topic on one side to one on the other, without the first slash of the names."""

    ros: str
    gz: str
    ros_type: str  # in the form of Python: sensor_msgs.msg.Image
    gz_type: str  # its last word
    direction: str
    location: Location
    is_used: bool  # whether a launch file names the file of the row

    @property
    def is_published(self) -> bool:
        """Return whether the bridge publishes in ROS."""
        return self.direction != _TO_GAZEBO


class _Sensor(NamedTuple):
    topic: str
    type: str
    location: Location


def bridge_rows(workspace: Workspace) -> Iterator[_BridgeRow]:
    """Yield the rows of bridges in YAML files, and those in the arguments of bridges."""
    launches = [source.text for package in workspace.packages for source in workspace.sources_of(package, _LAUNCHES)]
    for path, tree in workspace.trees:
        is_used = any(posixpath.basename(path) in text for text in launches)
        for row in tree.items:
            if row.get("ros_type_name") is not None and row.get("gz_type_name") is not None:
                yield from _row_in_yaml(row, is_used=is_used)
    for _, node in workspace.nodes:
        for word in node.arguments or () if node.package == BRIDGE else ():
            found = _ARGUMENT.fullmatch(word or "")
            if found is not None:
                name, types = found["topic"].strip("/"), (found["ros"].replace("/", "."), found["gz"].split(".")[-1])
                yield _BridgeRow(name, name, *types, _DIRECTIONS[found["direction"]], node.location, is_used=True)


def _row_in_yaml(row: YamlNode, *, is_used: bool) -> Iterator[_BridgeRow]:
    both = row.get("topic_name")
    ros, gz = row.get("ros_topic_name") or both, row.get("gz_topic_name") or both
    types = [row.get(key) for key in ("ros_type_name", "gz_type_name")]
    if ros is None or gz is None or not ros.text or not gz.text:
        return
    ros_type, gz_type = ((it.text or "") if it is not None else "" for it in types)
    direction = row.get("direction")
    way = _BOTH if direction is None else direction.text or _BOTH
    names = ros.text.strip("/"), gz.text.strip("/")
    yield _BridgeRow(*names, ros_type.replace("/", "."), gz_type.split(".")[-1], way, gz.location, is_used)


def bridge_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield rows of sensors that no sensor publishes, while nothing bridges the one that there is; clocks."""
    rows = list(bridge_rows(workspace))
    if not rows:
        return
    sensors, defined = _gazebo_topics(workspace)
    of_images = [node for _, node in workspace.nodes if node.package == "ros_gz_image"]
    images = {(word or "").strip("/") for node in of_images for word in node.arguments or ()}
    bridged = {row.gz for row in rows} | images
    is_known = not _is_open(workspace)
    for row in rows:
        yield Compared("topics")
        if row.gz_type == "Clock" and row.direction == _TO_GAZEBO:
            message = f"the bridge sends the time of ROS to Gazebo: the clock is Gazebo's, so write {_TO_ROS}"
            yield Mismatch("topics", message, row.location, is_sure=row.is_used)
        if not row.is_published or row.gz in defined or row.gz.startswith(("world/", "model/")) or "$" in row.gz:
            continue
        unused = {it.topic: it for it in sensors if it.type == row.gz_type and it.topic not in bridged}
        if unused:
            meant = closest(row.gz, unused) or min(unused)
            at = unused[meant].location
            message = (
                f"no sensor publishes {quoted(row.gz)} in Gazebo; did you mean {quoted(meant)} ({place_text(at)})?"
            )
            is_sure = row.is_used and is_known and len(unused) == 1
            yield Mismatch("topics", message, row.location, at, is_sure, corrections(row.gz, row.location, meant, at))


def _gazebo_topics(workspace: Workspace) -> tuple[list[_Sensor], set[str]]:
    """Return the sensors that have a topic, and every topic that the robot, models and worlds define."""
    sensors: list[_Sensor] = []
    defined: set[str] = set()
    for root, place in _roots(workspace):
        for element in root.iter("*"):
            text = (element.text or "").strip().strip("/")
            if str(element.tag).endswith("topic") and text:
                beside = [posixpath.join(posixpath.dirname(text), name) for name in _DERIVED]
                defined |= {text, *beside, *(f"{text}/{name}" for name in _DERIVED)}
                parent = element.getparent()
                kind = _SENSORS.get(parent.get("type", "")) if parent is not None and parent.tag == "sensor" else None
                if kind is not None and element.tag == "topic":
                    sensors.append(_Sensor(text, kind, place(element)))
    return sensors, defined


def _roots(workspace: Workspace) -> Iterator[tuple[Element, Callable[[Element], Location]]]:
    if workspace.robot_root is not None:
        yield workspace.robot_root, workspace.place
    yield from ((file.root, file.location) for file in _sdf_files(workspace))


def _sdf_files(workspace: Workspace) -> Iterator[XmlFile]:
    for package in workspace.packages:
        for path in [it for it in package.tree.files if it.endswith((".sdf", ".world"))]:
            try:
                data = package.tree.files[path].read(_MAX_SDF)
                yield XmlFile(data, Source(package.path(path), data.decode("utf-8", "replace")))
            except (InputError, XmlFault):
                continue


def _is_open(workspace: Workspace) -> bool:
    """Return whether there may be other sensors and bridges than those that were read."""
    launches = [launch for _, _, launch in workspace.launches]
    if workspace.robot is None or workspace.has_other_robots or any(it.syntax or it.unread for it in launches):
        return True
    arguments = [node.arguments for _, node in workspace.nodes if node.package in (BRIDGE, "ros_gz_image")]
    if any(launch.unknown for launch in launches) or any(words is None or None in words for words in arguments):
        return True
    models = [it.findtext("uri") or "" for file in _sdf_files(workspace) for it in file.root.iter("include")]
    return any(uri.rpartition("/")[2].lower() not in _WITHOUT_SENSORS for uri in models)
