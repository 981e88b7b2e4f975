"""The rows of ros_gz_bridge: which topic it takes to which one, with their types."""

import posixpath
from collections.abc import Iterator

from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.launch.launch_model import StartedNode
from grader.workspace.model.workspace import Workspace

BRIDGE = "ros_gz_bridge"  # the package
PARAMETER_BRIDGE = (BRIDGE, "parameter_bridge")  # its program
TO_ROS = "GZ_TO_ROS"
TO_GAZEBO = "ROS_TO_GZ"
_BOTH = "BIDIRECTIONAL"
_DIRECTIONS = {"[": TO_ROS, "]": TO_GAZEBO, "@": _BOTH}
_ARGUMENT = on_use(r"(?P<topic>[^@\s]++)@(?P<ros>[\w/]++)(?P<direction>[@\[\]])(?P<gz>[\w./]++)")
_OLDER_FORM = on_use("^ignition[.]msgs(?=[.])")


class BridgeRow(Named):
    """What a bridge takes from a topic on one side to one on the other.

    The names have no first slash.
    """

    ros: str
    gz: str
    ros_type: str  # in the form of Python: sensor_msgs.msg.Image
    gz_type: str  # in its newer form: gz.msgs.Image
    direction: str
    location: Location
    ros_location: Location
    ros_type_location: Location
    gz_type_location: Location
    direction_location: Location
    is_used: bool  # whether a launch file names the file of the row

    @property
    def is_published(self) -> bool:
        """Return whether the bridge publishes in ROS."""
        return self.direction != TO_GAZEBO

    @property
    def is_read(self) -> bool:
        """Return whether the bridge subscribes in ROS."""
        return self.direction != TO_ROS


def bridge_rows(workspace: Workspace) -> Iterator[BridgeRow]:
    """Yield the rows of bridges in YAML files, and those in the arguments of bridges."""
    for tree in workspace.installed.trees:
        name = posixpath.basename(tree.source.path)
        rows = [row for row in map(_row_in_yaml, tree.items) if row]
        is_used = bool(rows) and any(
            name in text for text in workspace.texts.searched_launch_texts()
        )
        yield from (row._replace(is_used=is_used) for row in rows)
    for node in workspace.launches.nodes:
        if node.package == BRIDGE:
            yield from _rows_in_arguments(node)


def rows_of_bridge(workspace: Workspace, node: StartedNode) -> Iterator[BridgeRow]:
    """Yield the rows that a bridge is given."""
    yield from _rows_in_arguments(node)
    for given in node.parameters or ():
        file = given.values.get("config_file")
        path = file.value if file and isinstance(file.value, str) else ""
        tree = workspace.installed.tree_at(path)
        items = tree.items if tree else ()
        workspace.charge(1 + len(items))
        for item in items:
            row = _row_in_yaml(item)
            if row:
                yield row


def are_rows_known(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether all rows that a bridge is given are read."""
    if node.arguments is None or None in node.arguments or node.parameters is None:
        return False
    for given in node.parameters:
        file = given.values.get("config_file")
        if given.unknown or given.path:
            return False
        if file:
            path = file.value if isinstance(file.value, str) else ""
            if not workspace.installed.tree_at(path):
                return False
    return node.namespace in ("", "/") and node.remaps is not None


def _rows_in_arguments(node: StartedNode) -> Iterator[BridgeRow]:
    for word in node.arguments or ():
        match = _ARGUMENT.fullmatch(word or "")
        if match:
            topic = match["topic"].strip("/")
            at = node.location
            yield BridgeRow(
                ros=topic,
                gz=topic,
                ros_type=_newer_ros_type(match["ros"]),
                gz_type=_newer_gz_type(match["gz"]),
                direction=_DIRECTIONS[match["direction"]],
                location=at,
                ros_location=at,
                ros_type_location=at,
                gz_type_location=at,
                direction_location=at,
                is_used=True,
            )


def _newer_ros_type(written: str) -> str:
    return written.replace("/", ".")


def _newer_gz_type(written: str) -> str:
    return _OLDER_FORM.sub("gz.msgs", written)


class _RowSide(Named):
    """The topic of a row in ROS or in Gazebo, with its type."""

    topic: str
    type: str
    location: Location
    type_location: Location


def _row_in_yaml(row: YamlNode) -> BridgeRow | None:
    """Return a row of a file that is used; None where it has no topics or types, and is ignored."""
    ros = _side_of_row(row, "ros")
    gz = _side_of_row(row, "gz")
    if ros is None or gz is None:
        return None
    direction = row.get("direction")
    written = direction.text if direction else None
    return BridgeRow(
        ros=ros.topic,
        gz=gz.topic,
        ros_type=_newer_ros_type(ros.type),
        gz_type=_newer_gz_type(gz.type),
        direction=written or _BOTH,
        location=gz.location,
        ros_location=ros.location,
        ros_type_location=ros.type_location,
        gz_type_location=gz.type_location,
        direction_location=direction.location if direction else gz.location,
        is_used=True,
    )


def _side_of_row(row: YamlNode, side: str) -> _RowSide | None:
    """Return the topic and the type of a side; None where one of them is missing."""
    topic = row.get(f"{side}_topic_name") or row.get("topic_name")
    kind = row.get(f"{side}_type_name")
    if topic is None or not topic.text or kind is None:
        return None
    return _RowSide(topic.text.strip("/"), kind.text or "", topic.location, kind.location)
