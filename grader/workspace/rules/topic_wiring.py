"""Topics that connect, and yet no message arrives as it should.

Two sources send commands, images have another transport, displays of RViz ask for more, or
programs send another type.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import chain

from grader.base.text import quoted
from grader.ros.config.rviz import Display
from grader.ros.known.package_tables import transport_types
from grader.workspace.graph.code_ends import End
from grader.workspace.graph.graph import Graph, graph_of
from grader.workspace.graph.node_ends import deciding_parameter
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Fact, Mismatch, warning
from grader.workspace.rules.rule_table import (
    COMMAND_TYPE,
    DISPLAY_QUALITY,
    IMAGE_TRANSPORT,
    ONE_COMMANDER,
)

_COMMANDS = ("geometry_msgs.msg.Twist", "geometry_msgs.msg.TwistStamped")
_IMAGE = "sensor_msgs.msg.Image"


def topic_wiring_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield topics on which messages do not arrive as they should."""
    graph = graph_of(workspace)
    publishers = graph.certain("publisher", "code")
    subscriptions = graph.certain("subscription", "code")
    yield from _two_commanders(publishers, subscriptions)
    yield from _other_transport(publishers, subscriptions)
    yield from _displays(workspace, publishers)
    yield from _programs(graph)


def _two_commanders(publishers: Sequence[End], subscriptions: Sequence[End]) -> Iterator[Mismatch]:
    """Yield the topics of commands that two nodes publish, and another one obeys."""
    obeyed = {(subscription.launch, subscription.name) for subscription in subscriptions}
    first: dict[tuple[int, str], End] = {}
    said: set[tuple[int, str]] = set()
    for each in publishers:
        key = each.launch, each.name
        if each.type not in _COMMANDS or key not in obeyed or key in said:
            continue
        before = first.setdefault(key, each)
        if before.node is not each.node:
            said.add(key)
            message = (
                f"{each.node.executable} and {before.node.executable} both publish {each.name}: "
                "the robot obeys each in turn; twist_mux chooses one"
            )
            yield warning(ONE_COMMANDER, message, each.location, before.location)


def _other_transport(publishers: Sequence[End], subscriptions: Sequence[End]) -> Iterator[Mismatch]:
    """Yield subscriptions of images on a topic that carries compressed ones."""
    published = {publisher.name for publisher in publishers}
    for each in subscriptions:
        topic, _, transport = each.name.rpartition("/")
        kind = transport_types().get(transport)
        if kind is None or each.type != _IMAGE or each.name in published:
            continue
        message = (
            f"the topic {each.name} carries {kind}, and is subscribed to with {_IMAGE}: "
            f"subscribe to {topic}, or with the other type"
        )
        yield warning(IMAGE_TRANSPORT, message, each.location)


def _displays(workspace: Workspace, publishers: Sequence[End]) -> Iterator[Mismatch]:
    """Yield displays of RViz that ask for reliable messages of best-effort publishers.

    Every publisher of the topic sends as best effort.
    """
    offered: dict[str, set[str | None]] = {}
    for each in publishers:
        offered.setdefault(each.name, set()).add(each.endpoint.qos.reliability)
    for package in workspace.packages:
        files = [package.rviz(path) for path in package.rviz_files]
        for display in chain.from_iterable(file.displays for file in files):
            if display.enabled:
                yield from _other_reliability(display, offered)


def _other_reliability(
    display: Display, offered: Mapping[str, Collection[str | None]]
) -> Iterator[Mismatch]:
    """Yield that a display asks for reliable messages, which are published as best effort."""
    policy = display.node.get("Topic", "Reliability Policy")
    topic = display.node.get("Topic", "Value")
    if policy is None or topic is None:
        return
    if policy.text == "Reliable" and offered.get(topic.text or "") == {"best_effort"}:
        message = (
            f"the display {quoted(display.name)} asks for reliable messages of "
            f"{topic.text}, which are published as best effort: it stays empty"
        )
        yield warning(DISPLAY_QUALITY, message, policy.location)


def _programs(graph: Graph) -> Iterator[Mismatch]:
    """Yield the well-known programs that send a controller another type than it reads.

    A parameter decides the type.
    """
    subscriptions = graph.of_kind("subscription", sources=("controller",))
    publishers = graph.certain("publisher", "program")
    for reader, publisher in graph.pairs(subscriptions, publishers):
        parameter = deciding_parameter(publisher)
        is_same = reader.launch == publisher.launch
        if is_same and parameter is not None and publisher.type != reader.type:
            message = (
                f"{publisher.owner} publishes {publisher.name} with {publisher.type}, but the "
                f"controller subscribes to it with {reader.type}: set its parameter {parameter}"
            )
            yield warning(COMMAND_TYPE, message, publisher.location, reader.location)
