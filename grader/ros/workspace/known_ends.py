"""Topics of well-known programs and of displays: whether what is published there has their type,
whether their inputs are published at all, and whether remappings replace names that they have.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from grader.base.names import near
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.known import known
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.package.package import Package
from grader.ros.workspace.graph.bridge_rows import BRIDGE, rows_of_bridge
from grader.ros.workspace.graph.endpoints import ANY, opened_by
from grader.ros.workspace.graph.publishers import may_be_published_by
from grader.ros.workspace.graph.started_controllers import controller_endpoints
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.names import Compared, Fact, Mismatch, warning

_INPUT = re.compile(r"([a-z]+)\d+")
_CLASSIC = "libgazebo_ros_"  # how the names of plugins of Gazebo Classic begin, which publish


class _Published(NamedTuple):
    """A topic that a launch file certainly publishes, and who does."""

    topic: str
    type: str
    location: Location


class _Input(NamedTuple):
    """A topic that a parameter of a program names, with the type that the program reads there."""

    parameter: str
    topic: str
    type: str
    location: Location


_ByTopic = Mapping[str, Sequence[_Published]]


def known_end_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield topics that well-known programs and displays cannot read, and names that these do not
    have.
    """
    everything: dict[str, list[_Published]] = {}
    for number, (package, launch) in enumerate(workspace.roots):
        published: dict[str, list[_Published]] = {}
        for each in _published(workspace, number, launch):
            published.setdefault(each.topic, []).append(each)
            everything.setdefault(each.topic, []).append(each)
        for node in launch.nodes:
            if node.when is True:
                for row in _rows_of_program(node):
                    yield from _other_types(node, row, published)
                    inputs = _inputs(workspace, package, node, row)
                    yield from _other_inputs(workspace, node, inputs, published)
                    yield from _remappings(node, row)
    yield from _displays(workspace, everything)


def _rows_of_program(node: StartedNode) -> Iterator[Mapping[str, Any]]:
    """Yield what is known of the topics of a program."""
    for row in known()["program_ends"]:
        if f"{node.package}/{node.executable}" in row["by"]:
            yield row


def _published(workspace: Workspace, number: int, launch: Launch) -> Iterator[_Published]:
    """Yield the topics that nodes of a launch file certainly publish, with their types."""
    workspace.charge(1 + len(launch.nodes))
    for node in launch.nodes:
        if node.when is not True:
            continue
        yield from _published_by_code(workspace, number, node)
        is_plain = node.package == BRIDGE and node.namespace in ("", "/")
        for row in rows_of_bridge(workspace, node) if is_plain else ():
            topic = node.topic(f"/{row.ros}") if row.is_published else None
            if topic is not None:
                yield _Published(topic, row.ros_type, row.location)
        for known_row in _rows_of_program(node):
            for name, kind in known_row.get("publisher", {}).items():
                topic = node.topic(name)
                if topic is not None:
                    yield _Published(topic, kind, node.location)


def _published_by_code(
    workspace: Workspace, number: int, node: StartedNode
) -> Iterator[_Published]:
    """Yield what an own node publishes, or the controllers in the process of a node."""
    for name, endpoint in opened_by(workspace, node):
        is_known = name is not None and ANY not in name and endpoint.type is not None
        if endpoint.kind == "publisher" and is_known:
            yield _Published(name or "", endpoint.type or "", endpoint.location)
    for name, endpoint in controller_endpoints(workspace, number, node):
        if endpoint.kind == "publisher" and endpoint.type is not None:
            yield _Published(name, endpoint.type, endpoint.location)


def _other_type(published: Sequence[_Published], wanted: str) -> _Published | None:
    """Return what is published with another type, if nothing is with the one that is wanted."""
    if any(each.type == wanted for each in published):
        return None
    return next(iter(published), None)


def _other_types(node: StartedNode, row: Mapping[str, Any], published: _ByTopic) -> Iterator[Fact]:
    """Yield the topics that a program reads, and that are published with another type."""
    for name, wanted in row.get("subscription", {}).items():
        topic = node.topic(name)
        found = published.get(topic or "", ())
        if found:
            yield Compared("wiring")
        other = _other_type(found, wanted)
        if other is not None:
            message = (
                f"{node.executable} reads {topic} with {wanted}, but it is published with "
                f"{other.type} ({other.location.file_and_line})"
            )
            yield warning("wiring", message, node.location, other.location)


def _inputs(
    workspace: Workspace, package: Package, node: StartedNode, row: Mapping[str, Any]
) -> list[_Input]:
    """Return the topics that parameters of a program name, such as `odom0` of an ekf_node."""
    types = row.get("inputs")
    if types is None:
        return []
    inputs = []
    for name, given in workspace.parameters_given(package, node).values.items():
        numbered = _INPUT.fullmatch(name)
        if numbered is None or numbered[1] not in types or not isinstance(given.value, str):
            continue
        topic = node.topic(given.value)
        if topic is not None:
            inputs.append(_Input(name, topic, types[numbered[1]], given.location))
    return inputs


def _other_inputs(
    workspace: Workspace, node: StartedNode, inputs: Sequence[_Input], published: _ByTopic
) -> Iterator[Fact]:
    """Yield the inputs that are published with another type, or not at all while another topic of
    their type is.
    """
    read = {each.topic for each in inputs}
    for each in inputs:
        yield Compared("wiring")
        other = _other_type(published.get(each.topic, ()), each.type)
        if other is not None:
            message = (
                f"{each.parameter} reads {each.topic} with {each.type}, but it is published with "
                f"{other.type} ({other.location.file_and_line})"
            )
            yield warning("wiring", message, each.location, other.location)
        elif each.topic not in published and not _may_be_published(workspace, each.topic):
            meant = _only_unread(workspace, node, each.type, published, read)
            if meant is not None:
                message = (
                    f"{each.parameter} reads {each.topic}, which nothing publishes; did you mean "
                    f"{meant.topic} ({meant.location.file_and_line})?"
                )
                yield warning("wiring", message, each.location, meant.location)


def _only_unread(
    workspace: Workspace, node: StartedNode, wanted: str, published: _ByTopic, read: set[str]
) -> _Published | None:
    """Return what others than a node publish with a type, and it does not read; None if that is
    not one topic.
    """
    workspace.charge(len(published))
    of_type = [it for row in published.values() for it in row if it.type == wanted]
    topics = {it.topic for it in of_type if it.location != node.location} - read
    if len(topics) != 1:
        return None
    return next(it for it in of_type if it.topic in topics)


def _may_be_published(workspace: Workspace, topic: str) -> bool:
    """Return whether something that is not read may publish a topic."""
    for robot in workspace.robots:
        if any(_CLASSIC in it.get("filename", "") for it in robot.root.iter("plugin")):
            return True
    if any(launch.more for _, _, launch in workspace.launches):
        return True
    return any(may_be_published_by(workspace, node, topic) for _, node in workspace.nodes)


def _remappings(node: StartedNode, row: Mapping[str, Any]) -> Iterator[Mismatch]:
    """Yield the remappings of names that surely stand for one that a program has."""
    names = [*row.get("subscription", ()), *row.get("publisher", ()), *row.get("names", ())]
    replaced = [rule[0].removeprefix("~/").strip("/") for rule in node.remaps or ()]
    left = [name for name in names if name not in replaced]
    plain = {name.replace("_", ""): name for name in left}
    for written in replaced:
        if written in names or ":" in written or written.startswith("__"):
            continue
        meant = plain.get(written.replace("_", "")) or near(written, left)
        if meant is not None:
            message = (
                f"{node.executable} has no topic {quoted(written)}, so its remapping does nothing; "
                f"did you mean {meant}?"
            )
            yield Mismatch("words", message, node.location, is_certain=False)


def _displays(workspace: Workspace, published: _ByTopic) -> Iterator[Mismatch]:
    """Yield displays of RViz that read other messages than are published."""
    for package in workspace.packages:
        for path in package.rviz_files:
            for display in package.rviz(path).displays:
                wanted = known()["display_types"].get(f"{display.package}/{display.kind}")
                topic = display.node.get("Topic", "Value")
                if wanted is None or topic is None or not display.enabled:
                    continue
                other = _other_type(published.get(topic.text or "", ()), wanted)
                if other is not None:
                    message = (
                        f"the display {quoted(display.name)} reads {wanted}, but {topic.text} is "
                        f"published with {other.type} ({other.location.file_and_line})"
                    )
                    yield warning("wiring", message, topic.location, other.location)
