"""Bridges between Gazebo and ROS: the rows of ros_gz_bridge, compared with the topics that Gazebo
has.
"""

import posixpath
import re
from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

from grader.base.names import closest
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.config.yaml_nodes import YamlFault, YamlNode
from grader.ros.known.known import known
from grader.ros.launch.node_parameters import parameters_of
from grader.ros.package.installed_files import open_meant
from grader.ros.workspace.gazebo import BRIDGE, GazeboTopic, gazebo_topics, roots
from grader.ros.workspace.names import Compared, Fact, Mismatch, corrections, place_text
from grader.ros.workspace.workspace import Workspace

_TO_ROS, _TO_GAZEBO, _BOTH = "GZ_TO_ROS", "ROS_TO_GZ", "BIDIRECTIONAL"
_DIRECTIONS = {"[": _TO_ROS, "]": _TO_GAZEBO, "@": _BOTH}
_ARGUMENT = re.compile(r"(?P<topic>[^@\s]+)@(?P<ros>[\w/]+)(?P<direction>[@\[\]])(?P<gz>[\w.]+)")
_OLDER_FORM = re.compile("^ignition[.]msgs(?=[.])")
_DERIVED = ("points", "image", "depth_image", "camera_info")  # below the topic, or beside it
# Models in worlds that have no sensors.
_WITHOUT_SENSORS = ("sun", "ground_plane", "ground plane")


class _BridgeRow(NamedTuple):
    """What a bridge takes from a topic on one side to one on the other, without the first slash of
    the names.
    """

    ros: str
    gz: str
    ros_type: str  # in the form of Python: sensor_msgs.msg.Image
    gz_type: str  # in its newer form: gz.msgs.Image
    direction: str
    location: Location
    ros_type_location: Location
    gz_type_location: Location
    direction_location: Location
    is_used: bool  # whether a launch file names the file of the row

    @property
    def is_published(self) -> bool:
        """Return whether the bridge publishes in ROS."""
        return self.direction != _TO_GAZEBO

    @property
    def is_read(self) -> bool:
        """Return whether the bridge subscribes in ROS."""
        return self.direction != _TO_ROS


def bridge_rows(workspace: Workspace) -> Iterator[_BridgeRow]:
    """Yield the rows of bridges in YAML files, and those in the arguments of bridges."""
    for path, tree in workspace.trees:
        is_used = any(posixpath.basename(path) in text for text in workspace.launch_texts)
        for row in tree.items:
            yield from _row_in_yaml(row, is_used=is_used)
    for _, node in workspace.nodes:
        for word in node.arguments or () if node.package == BRIDGE else ():
            found = _ARGUMENT.fullmatch(word or "")
            if found is not None:
                name, types, at = (
                    found["topic"].strip("/"),
                    _types_of(found["ros"], found["gz"]),
                    node.location,
                )
                yield _BridgeRow(
                    name,
                    name,
                    *types,
                    _DIRECTIONS[found["direction"]],
                    at,
                    at,
                    at,
                    at,
                    is_used=True,
                )


def _types_of(ros: str, gz: str) -> tuple[str, str]:
    return ros.replace("/", "."), _OLDER_FORM.sub("gz.msgs", gz)


def _row_in_yaml(row: YamlNode, *, is_used: bool) -> Iterator[_BridgeRow]:
    both = row.get("topic_name")
    ros, gz = row.get("ros_topic_name") or both, row.get("gz_topic_name") or both
    ros_type, gz_type = row.get("ros_type_name"), row.get("gz_type_name")
    if (
        ros is None
        or gz is None
        or ros_type is None
        or gz_type is None
        or not ros.text
        or not gz.text
    ):
        return
    direction = row.get("direction")
    way = _BOTH if direction is None else direction.text or _BOTH
    names = ros.text.strip("/"), gz.text.strip("/")
    types = _types_of(ros_type.text or "", gz_type.text or "")
    places = gz.location, ros_type.location, gz_type.location, (direction or gz).location
    yield _BridgeRow(*names, *types, way, *places, is_used)


def bridge_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield rows with types or directions that no bridge has, those of topics that Gazebo does not
    have, and clocks.
    """
    for path in bridge_files(workspace):
        fault = workspace.yaml_files.get(path)
        if isinstance(fault, YamlFault):
            yield Mismatch("topics", f"this is not YAML: {fault}", fault.location)
    rows = list(bridge_rows(workspace))
    if not rows:
        return
    topics = list(gazebo_topics(workspace))
    of_images = [node for _, node in workspace.nodes if node.package == "ros_gz_image"]
    images = {(word or "").strip("/") for node in of_images for word in node.arguments or ()}
    bridged, defined = {row.gz for row in rows} | images, _defined(workspace)
    unused = [it for it in topics if it.name not in bridged]
    is_known = not _is_open(workspace)
    for row in rows:
        yield Compared("topics")
        same = [it for it in topics if it.name == row.gz]
        yield from _conversions(row, {f"gz.msgs.{it.type}" for it in same})
        if row.gz in defined:
            yield from _contradictions(row, same)
        elif not row.gz.startswith(("world/", "model/")) and "$" not in row.gz:
            yield from _not_there(row, unused, is_known=is_known)
    yield from _clocks(workspace, rows)


def bridge_files(workspace: Workspace) -> set[str]:
    """Return the files with rows that launch files give to bridges, by their paths in the
    submission.
    """
    bridges = [node for _, node in workspace.nodes if node.package == BRIDGE]
    given = [it.values.get("config_file") for node in bridges for it in node.parameters or ()]
    paths = [it.value for it in given if it is not None]
    passed = [
        it for _, launch in workspace.roots for it in launch.passed if f"/{BRIDGE}/" in it.path
    ]
    paths += [value for it in passed for name, value in it.values if name == "config_file"]
    return {
        found
        for path in paths
        if isinstance(path, str) and (found := workspace.source_of(path)) is not None
    }


def _conversions(row: _BridgeRow, of_gazebo: set[str]) -> Iterator[Mismatch]:
    """Yield that no bridge converts a type into the other one, and that the time of ROS is sent to
    Gazebo.

    Where the topics of Gazebo have the type of the row, the other one is wrong.
    """
    kinds = known()["bridge_types"]
    fitting = [f"gz.msgs.{it}" for it in kinds.get(row.ros_type, ())]
    if fitting and row.gz_type not in fitting:
        ros = row.ros_type.replace(".", "/")
        message = f"the bridge does not convert {ros} and {row.gz_type or 'an empty type'}"
        plain = row.gz_type.removeprefix("gz.msgs.")
        meant = [name.replace(".", "/") for name, own in kinds.items() if plain in own]
        if of_gazebo == {row.gz_type} and meant:
            wrong, at = ros, row.ros_type_location
        else:
            wrong, meant, at = row.gz_type, fitting[:1], row.gz_type_location
        either = corrections(wrong, at, meant[0]) if wrong and len(meant) == 1 else ()
        yield Mismatch(
            "topics",
            f"{message}; write {enumerated(meant, word='or')}",
            at,
            None,
            row.is_used,
            either,
        )
    if row.gz_type == "gz.msgs.Clock" and row.direction == _TO_GAZEBO:
        message = (
            f"the bridge sends the time of ROS to Gazebo: the clock is Gazebo's, so write {_TO_ROS}"
        )
        yield _in_direction(row, message, _TO_ROS)


def _in_direction(
    row: _BridgeRow, message: str, right: str, at: Location | None = None
) -> Mismatch:
    """Return that a row has the wrong direction, with the right one; in an argument it is a
    character.
    """
    where = row.direction_location
    either = corrections(row.direction, where, right) if where != row.location else ()
    return Mismatch("topics", message, where, at, row.is_used, either)


def _contradictions(row: _BridgeRow, topics: list[GazeboTopic]) -> Iterator[Mismatch]:
    """Yield that a topic of Gazebo is bridged in the other direction, or has messages of another
    type.
    """
    inputs = {it.is_input for it in topics}
    wrong, right = (_TO_ROS, _TO_GAZEBO) if inputs == {True} else (_TO_GAZEBO, _TO_ROS)
    if topics and len(inputs) == 1 and row.direction == wrong:
        done = "reads it" if inputs == {True} else "publishes it"
        at = topics[0].location
        message = (
            f"the topic {row.gz} is bridged {wrong}, but Gazebo {done} ({place_text(at)}): "
            f"write {right}"
        )
        yield _in_direction(row, message, right, at)
    fitting = [f"gz.msgs.{it}" for it in known()["bridge_types"].get(row.ros_type, ())]
    if (
        topics
        and row.gz_type in fitting
        and all(f"gz.msgs.{it.type}" != row.gz_type for it in topics)
    ):
        at = topics[0].location
        message = (
            f"the topic {row.gz} of Gazebo has gz.msgs.{topics[0].type} ({place_text(at)}), not "
            f"{row.gz_type}"
        )
        yield Mismatch("topics", message, row.gz_type_location, at, row.is_used)


def _not_there(row: _BridgeRow, unused: list[GazeboTopic], *, is_known: bool) -> Iterator[Mismatch]:
    """Yield that Gazebo does not have the topic of a row, while no row has one of the same type
    that it has.
    """
    fitting = {
        it.name: it
        for it in unused
        if f"gz.msgs.{it.type}" == row.gz_type and it.is_input != row.is_published
    }
    if fitting:
        meant = closest(row.gz, fitting) or min(fitting)
        at = fitting[meant].location
        what = "no sensor publishes" if row.is_published else "nothing reads"
        message = (
            f"{what} {quoted(row.gz)} in Gazebo; did you mean {quoted(meant)} ({place_text(at)})?"
        )
        is_sure = row.is_used and is_known and len(fitting) == 1
        yield Mismatch(
            "topics",
            message,
            row.location,
            at,
            is_sure,
            corrections(row.gz, row.location, meant, at),
        )


def _clocks(workspace: Workspace, rows: list[_BridgeRow]) -> Iterator[Mismatch]:
    """Yield that nodes wait for the time of the simulation, and no bridge takes it from Gazebo."""
    bridges = [node for _, node in workspace.nodes if node.package == BRIDGE]
    own = [row for row in rows if row.is_used]
    if not bridges or not own or any(row.ros == "clock" for row in rows) or _is_open(workspace):
        return
    included = [passed.path for _, launch in workspace.roots for passed in launch.passed]
    if any(not workspace.source_of(path) and "/ros_gz_sim/" not in path for path in included):
        return
    for package, node in workspace.nodes:
        given = parameters_of(
            node, partial(open_meant, package), workspace.name_of(node) or "", is_python=None
        ).values
        found = given.get("use_sim_time")
        if found is not None and str(found.value).lower() == "true" and node.when:
            message = (
                f"{node.executable} waits for the time of the simulation, but no bridge takes "
                "clock from Gazebo"
            )
            yield Mismatch("topics", message, found.location, own[0].location)
            return


def _defined(workspace: Workspace) -> set[str]:
    """Return every topic that the robot, models and worlds name, and those that Gazebo derives from
    them.
    """
    defined: set[str] = set()
    for root, _ in roots(workspace):
        for element in root.iter("*"):
            text = (element.text or "").strip().strip("/")
            if str(element.tag).endswith("topic") and text:
                beside = [posixpath.join(posixpath.dirname(text), name) for name in _DERIVED]
                defined |= {text, *beside, *(f"{text}/{name}" for name in _DERIVED)}
    return defined


def _is_open(workspace: Workspace) -> bool:
    """Return whether there may be other sensors and bridges than those that were read."""
    is_whole = workspace.robot is not None and not workspace.has_other_robots
    if not is_whole or any(launch.more for _, _, launch in workspace.launches):
        return True
    arguments = [
        node.arguments for _, node in workspace.nodes if node.package in (BRIDGE, "ros_gz_image")
    ]
    if any(words is None or None in words for words in arguments):
        return True
    models = [
        it.findtext("uri") or "" for file in workspace.sdf_files for it in file.root.iter("include")
    ]
    return any(uri.rpartition("/")[2].lower() not in _WITHOUT_SENSORS for uri in models)
