"""The nodes of plug-ins of Gazebo Classic in the robot that a launch file spawns."""

from collections.abc import Callable, Iterator

from grader.base.source import Location
from grader.ros.known.end_rows import OpenedEnds, opened_ends
from grader.ros.known.releases import Release
from grader.ros.launch.launch_model import ParameterValue, StartedNode
from grader.ros.launch.node_parameters import NodeParameters
from grader.ros.xml.elements import first_text
from grader.ros.xml.parsing import Element
from grader.workspace.graph.launch_graph import GraphNode
from grader.workspace.graph.opened_by_programs import ends_of_row
from grader.workspace.model.workspace import Workspace

_PACKAGE = "gazebo_plugins"
_OTHER_ROBOT = "which robot Gazebo loads is not known"
_SWITCHES = {"true": True, "1": True, "false": False, "0": False}
_CAMERA = "{camera_name}"


def plugin_nodes(
    workspace: Workspace, release: Release, *, is_spawned: bool
) -> Iterator[GraphNode]:
    """Yield the nodes of the plug-ins of the robots that have rows.

    They are certain if the launch file spawns a robot, and there is no other one.
    """
    robots = workspace.robots.known
    is_one = len(robots) == 1 and not workspace.robots.may_be_others
    doubt = "" if is_one and is_spawned else _OTHER_ROBOT
    for robot in robots:
        for plugin in robot.root.iter("plugin"):
            file = plugin.get("filename", "").removeprefix("lib").removesuffix(".so")
            row = opened_ends(_PACKAGE, file)
            if row:
                yield _plugin_node(plugin, file, row, robot.place, release, doubt)


def _plugin_node(
    plugin: Element,
    file: str,
    row: OpenedEnds,
    place: Callable[[Element], Location],
    release: Release,
    doubt: str,
) -> GraphNode:
    """Return a plug-in as the node that it makes."""
    location = place(plugin)
    node = StartedNode(
        _PACKAGE,
        file,
        True,
        location,
        namespace=_text(plugin, "ros/namespace"),
        node_name=plugin.get("name", ""),
        remaps=tuple(_list_remaps(plugin)),
    )
    values = {}
    for child in plugin.iterchildren("*"):
        text = first_text(child)
        values[child.tag] = ParameterValue(_SWITCHES.get(text.lower(), text), location)
    camera = _text(plugin, "camera_name")
    publishers = {}
    for written, message in row.publishers.items():
        if camera or _CAMERA not in written:
            publishers[written.replace(_CAMERA, camera)] = message
    row = row._replace(publishers=publishers)
    ends = tuple(ends_of_row(row, node, NodeParameters(values, node), release))
    name = node.full_name(node.node_name) if node.node_name else ""
    program = f"{_PACKAGE}/{file}"
    made = GraphNode(name, program, "program", location, ends, doubt, row.opens_more)
    return made._replace(opens_only=row.opens_only)


def _text(plugin: Element, path: str) -> str:
    return (plugin.findtext(path) or "").strip()


def _list_remaps(plugin: Element) -> Iterator[tuple[str, str]]:
    """Yield the remappings of a plug-in: ~/out:=scan."""
    for element in plugin.iterfind("ros/remapping"):
        name, _, to = first_text(element).partition(":=")
        if to:
            yield name, to
