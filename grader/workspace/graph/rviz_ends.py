"""What RViz reads and publishes: the displays and the tools of the files that it is given."""

from collections.abc import Iterator, Sequence

from grader.base.names import last_part
from grader.ros.config.rviz import RvizFile
from grader.ros.config.yaml_nodes import read_yaml
from grader.ros.known.package_tables import display_types
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.workspace.graph.launch_graph import GraphEnd
from grader.workspace.graph.opened_by_programs import shown_type
from grader.workspace.model.workspace import Workspace

# The settings of displays that name topics, with their types; empty for that of the display.
_TOPICS_OF_DISPLAYS = {
    "Topic": "",
    "Description Topic": "std_msgs.msg.String",
    "Update Topic": "map_msgs.msg.OccupancyGridUpdate",
}
# The types that tools publish, by their classes.
TOOL_TYPES = {
    "SetInitialPose": "geometry_msgs.msg.PoseWithCovarianceStamped",
    "SetGoal": "geometry_msgs.msg.PoseStamped",
    "PublishPoint": "geometry_msgs.msg.PointStamped",
}


def list_rviz_files(workspace: Workspace) -> Sequence[RvizFile]:
    """Return the RViz files of the packages."""
    return [package.rviz(path) for package in workspace.packages for path in package.rviz_files]


def rviz_files(workspace: Workspace, launch: Launch) -> Sequence[RvizFile]:
    """Return the files that a launch file gives RViz, as far as they are in the workspace."""
    named = launch.named("rviz")
    paths = {workspace.installed.find_source(each.path or "") for each in named}
    files = []
    for package in workspace.packages:
        for path in package.rviz_files:
            if package.path(path) in paths:
                files.append(package.rviz(path))
    return [file for file in files if not file.fault and not file.unread]


def ends_of_displays(file: RvizFile, node: StartedNode) -> Iterator[GraphEnd]:
    """Yield what the displays of a file read that are on."""
    for display in file.displays:
        for key, other in _TOPICS_OF_DISPLAYS.items() if display.enabled else ():
            message = other or display_types().get(display.kind, "")
            topic = display.node.get(key, "Value") or display.node.get(key)
            if topic and topic.text:
                name, doubt = _full_name(topic.text, node)
                yield GraphEnd(
                    "subscription",
                    name,
                    shown_type(message),
                    topic.location,
                    doubt=doubt,
                    note=f"the display {display.kind}",
                )


def ends_of_tools(
    file: RvizFile, node: StartedNode, *, is_placed: bool = False
) -> Iterator[GraphEnd]:
    """Yield what the tools of a file publish; each is where its name is only if it `is_placed`."""
    root = read_yaml(file.source.text.encode(), file.source.path)  # which is known to be YAML
    tools = root.get("Visualization Manager", "Tools")
    for tool in tools.items if tools else ():
        written = tool.get("Class")
        kind = last_part((written.text or "") if written is not None else "")
        topic = tool.get("Topic", "Value") or tool.get("Topic")
        if kind in TOOL_TYPES and topic is not None and topic.text:
            name, doubt = _full_name(topic.text, node)
            # Its place is that of RViz: what a tool may publish is drawn where something reads it.
            at = topic.location if is_placed else node.location
            note = f"the tool {kind}"
            message = shown_type(TOOL_TYPES[kind])
            yield GraphEnd("publisher", name, message, at, doubt=doubt, note=note)


def _full_name(topic: str, node: StartedNode) -> tuple[str, str]:
    """Return the full name of a topic of RViz, and why it may be another one."""
    full = node.topic(topic)
    if full is None:
        return topic, "the remappings of RViz are known only at run time"
    return full, ""
