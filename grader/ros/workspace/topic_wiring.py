"""Topics that connect, and yet no message arrives as it should: two sources of commands, images of
another transport, displays of RViz that ask for more, and programs that send another type.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from grader.base.text import quoted
from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import NodeParameters
from grader.ros.package.node_facts import Endpoint
from grader.ros.python.values import Unknown
from grader.ros.workspace.graph.endpoints import CertainEnd, certainly_opened
from grader.ros.workspace.graph.started_controllers import controller_endpoints
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.names import Fact, Mismatch, warning

_COMMANDS = ("geometry_msgs.msg.Twist", "geometry_msgs.msg.TwistStamped")
_IMAGE = "sensor_msgs.msg.Image"
_PUBLISHER, _SUBSCRIPTION = "publisher", "subscription"


def topic_wiring_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield topics on which messages do not arrive as they should."""
    opened = [*certainly_opened(workspace)]
    publishers = [it for it in opened if it.endpoint.kind == _PUBLISHER]
    subscriptions = [it for it in opened if it.endpoint.kind == _SUBSCRIPTION]
    yield from _two_commanders(publishers, subscriptions)
    yield from _other_transport(publishers, subscriptions)
    yield from _displays(workspace, publishers)
    yield from _programs(workspace)


def _two_commanders(
    publishers: Sequence[CertainEnd], subscriptions: Sequence[CertainEnd]
) -> Iterator[Mismatch]:
    """Yield the topics of commands that two nodes publish, and another one obeys."""
    obeyed = {(it.launch, it.name) for it in subscriptions}
    first: dict[tuple[int, str], CertainEnd] = {}
    said: set[tuple[int, str]] = set()
    for each in publishers:
        key = each.launch, each.name
        if each.endpoint.type not in _COMMANDS or key not in obeyed or key in said:
            continue
        before = first.setdefault(key, each)
        if before.node is not each.node:
            said.add(key)
            message = (
                f"{each.node.executable} and {before.node.executable} both publish {each.name}: "
                "the robot obeys each in turn; twist_mux chooses one"
            )
            yield warning("wiring", message, each.endpoint.location, before.endpoint.location)


def _other_transport(
    publishers: Sequence[CertainEnd], subscriptions: Sequence[CertainEnd]
) -> Iterator[Mismatch]:
    """Yield subscriptions of images on a topic that carries compressed ones."""
    published = {it.name for it in publishers}
    for each in subscriptions:
        topic, _, transport = each.name.rpartition("/")
        kind = known()["transport_types"].get(transport)
        if kind is None or each.endpoint.type != _IMAGE or each.name in published:
            continue
        message = (
            f"the topic {each.name} carries {kind}, and is subscribed to with {_IMAGE}: "
            f"subscribe to {topic}, or with the other type"
        )
        yield warning("wiring", message, each.endpoint.location)


def _displays(workspace: Workspace, publishers: Sequence[CertainEnd]) -> Iterator[Mismatch]:
    """Yield displays of RViz that ask for reliable messages, which every publisher sends as best
    effort.
    """
    offered: dict[str, set[str | None]] = {}
    for each in publishers:
        offered.setdefault(each.name, set()).add(each.endpoint.qos.reliability)
    for package in workspace.packages:
        for path in package.rviz_files:
            for display in package.rviz(path).displays:
                policy = display.node.get("Topic", "Reliability Policy")
                topic = display.node.get("Topic", "Value")
                if policy is None or topic is None or policy.text != "Reliable":
                    continue
                if display.enabled and offered.get(topic.text or "") == {"best_effort"}:
                    message = (
                        f"the display {quoted(display.name)} asks for reliable messages of "
                        f"{topic.text}, which are published as best effort: it stays empty"
                    )
                    yield warning("wiring", message, policy.location)


def _programs(workspace: Workspace) -> Iterator[Mismatch]:
    """Yield the well-known programs that send a controller another type than it reads."""
    for number, (package, launch) in enumerate(workspace.roots):
        readers: dict[str, Endpoint] = {}
        for node in launch.nodes:
            for full, endpoint in controller_endpoints(workspace, number, node):
                if endpoint.kind == _SUBSCRIPTION:
                    readers[full] = endpoint
        for node in launch.nodes:
            for row in known()["program_topics"].get(f"{node.package}/{node.executable}", ()):
                reader = readers.get(node.topic(row["topic"]) or "")
                if reader is not None and node.when is True:
                    given = workspace.parameters_given(package, node)
                    yield from _other_command(node, given, row, reader)


def _other_command(
    node: StartedNode, given: NodeParameters, row: Mapping[str, Any], reader: Endpoint
) -> Iterator[Mismatch]:
    """Yield that a well-known program sends a controller another type than it reads, with the
    parameters that it is given.
    """
    parameter, value, other = row["if"]  # `other` is the type if the parameter has this value
    found = given.values.get(parameter)
    if given.unknown or (found is not None and isinstance(found.value, Unknown)):
        return
    is_other = found is not None and found.value == value
    kind = other if is_other else row["type"]
    if kind != reader.type:
        message = (
            f"{node.executable} publishes {node.topic(row['topic'])} with {kind}, but the "
            f"controller subscribes to it with {reader.type}: set its parameter {parameter}"
        )
        yield warning("wiring", message, node.location, reader.location)
