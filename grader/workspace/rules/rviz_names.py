"""Names in RViz files: the fixed frame, and the topics of displays."""

from collections.abc import Collection, Iterator

from grader.base.names import near
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.config.rviz import RvizFile
from grader.ros.known.package_tables import display_types
from grader.ros.known.shared_names import shared_names
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.rviz_ends import list_rviz_files
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    charge_guess,
    warning,
)
from grader.workspace.rules.rule_table import NO_COMPANION, UNREAD, Rule

_TOPICS = ("Topic", "Description Topic")

_RVIZ_NAME = Rule(
    "rviz-name",
    "wiring",
    NO_COMPANION,
    "RViz names frames of the robot and topics that are published.",
    why=(
        "RViz prints 'Frame [...] does not exist', or a display waits for a topic that nothing "
        "publishes: it stays empty."
    ),
    wrong="""
- Class: rviz_default_plugins/Image
  Name: Image
  Enabled: true
  Topic: {Value: /imag_raw}
""",
    right="""
- Class: rviz_default_plugins/Image
  Name: Image
  Enabled: true
  Topic: {Value: /image_raw}
""",
    frame="show/rover.rviz",
    beside={
        "start/pilot.py": "self.images = self.create_publisher(Image, 'image_raw', 10)",
    },
)

_DISPLAY_TOPIC = Rule(
    "display-topic",
    "effects",
    UNREAD,
    "A display that is enabled has a topic.",
    why="RViz prints 'Error subscribing: Empty topic name', and the display shows nothing.",
    wrong="""
- Class: rviz_default_plugins/Image
  Name: Image
  Enabled: true
  Topic: {Value: ""}
""",
    right="""
- Class: rviz_default_plugins/Image
  Name: Image
  Enabled: true
  Topic: {Value: /image}
""",
    frame="show/rover.rviz",
    beside={
        "start/pilot.py": "self.images = self.create_publisher(Image, 'image', 10)",
    },
)


def rviz_name_facts(workspace: Workspace) -> Facts:
    """Yield names in RViz files that surely are misspelt, and enabled displays without a topic.

    Names that are not similar may be those of what another machine publishes.
    """
    files = list_rviz_files(workspace)
    if not files:
        return
    graph = make_graph(workspace)
    topics = graph.names_opened("publisher")
    frames = _list_frames(workspace)
    for file in files:
        yield Compared("wiring")
        names = list(_list_topics(file))
        for name, at in names:
            yield from _misspelt(workspace, "topic", name, at, topics)
        if file.fixed_frame and workspace.robots.known:
            yield from _misspelt(workspace, "frame", file.fixed_frame, file.frame_location, frames)
        yield from _without_topic(file)


def _list_frames(workspace: Workspace) -> set[str]:
    """Return the frames of the robots, and those that well-known programs publish."""
    frames = {*shared_names().frames}
    for known in workspace.robots.known:
        frames.update(link.name for link in known.robot.links)
    return frames


def _list_topics(file: RvizFile) -> Iterator[tuple[str, Location]]:
    """Yield the topics of the enabled displays of a file."""
    for display in file.displays:
        for key in _TOPICS if display.enabled else ():
            topic = display.node.get(key, "Value")
            if topic and topic.text:
                yield topic.text, topic.location


def _misspelt(
    workspace: Workspace, noun: str, name: str, at: Location, known: Collection[str]
) -> Mismatches:
    """Yield that a name surely is another one that is known."""
    full = f"/{name.lstrip('/')}" if noun == "topic" else name
    charge_guess(workspace, known)
    meant = near(full, known) if full not in known else None
    if meant is not None:
        start = "nothing publishes the topic" if noun == "topic" else "there is no frame"
        yield warning(_RVIZ_NAME, f"{start} {quoted(name)}", at).meaning(name, meant)


def _without_topic(file: RvizFile) -> Mismatches:
    """Yield the enabled displays of messages that have no topic."""
    for display in file.displays:
        topic = display.node.get("Topic", "Value")
        is_empty = topic is not None and not topic.text
        if topic and is_empty and display.enabled and display.kind in display_types():
            message = f"the display {quoted(display.name)} has no topic, so it shows nothing"
            yield warning(_DISPLAY_TOPIC, message, topic.location)
