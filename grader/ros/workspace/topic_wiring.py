"""Topics that connect, and yet no message arrives as it should: two sources of commands, images of
another transport, displays of RViz that ask for more, and programs that send another type.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.package.node_facts import Endpoint
from grader.ros.python.values import Unknown
from grader.ros.workspace.controllers import controller_endpoints
from grader.ros.workspace.endpoints import opened_by
from grader.ros.workspace.names import Fact, Mismatch
from grader.ros.workspace.workspace import Workspace

_COMMANDS = ("geometry_msgs.msg.Twist", "geometry_msgs.msg.TwistStamped")
_IMAGE = "sensor_msgs.msg.Image"
_PUBLISHER, _SUBSCRIPTION = "publisher", "subscription"


class _TopicEnd(NamedTuple):
    """An end of a topic in one launch, by a node that is certainly started."""

    topic: str
    endpoint: Endpoint
    launch: int
    node: StartedNode


def topic_wiring_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield topics on which messages do not arrive as they should."""
    opened: list[_TopicEnd] = []
    for launch, node in workspace.launched:
        if node.when is True:
            for name, endpoint in opened_by(workspace, node):
                if name is not None and "*" not in name:
                    opened.append(_TopicEnd(name, endpoint, launch, node))
    publishers = [it for it in opened if it.endpoint.kind == _PUBLISHER]
    subscriptions = [it for it in opened if it.endpoint.kind == _SUBSCRIPTION]
    yield from _two_commanders(publishers, subscriptions)
    yield from _other_transport(publishers, subscriptions)
    yield from _displays(workspace, publishers)
    yield from _programs(workspace)


def _warning(message: str, at: Location, related: Location | None = None) -> Mismatch:
    return Mismatch("wiring", message, at, related, is_certain=False)


def _two_commanders(
    publishers: Sequence[_TopicEnd], subscriptions: Sequence[_TopicEnd]
) -> Iterator[Mismatch]:
    """Yield the topics of commands that two nodes publish, and another one obeys."""
    obeyed = {(it.launch, it.topic) for it in subscriptions}
    first: dict[tuple[int, str], _TopicEnd] = {}
    said: set[tuple[int, str]] = set()
    for each in publishers:
        key = each.launch, each.topic
        if each.endpoint.type not in _COMMANDS or key not in obeyed or key in said:
            continue
        before = first.setdefault(key, each)
        if before.node is not each.node:
            said.add(key)
            message = (
                f"{each.node.executable} and {before.node.executable} both publish {each.topic}: "
                "the robot obeys each in turn; twist_mux chooses one"
            )
            yield _warning(message, each.endpoint.location, before.endpoint.location)


def _other_transport(
    publishers: Sequence[_TopicEnd], subscriptions: Sequence[_TopicEnd]
) -> Iterator[Mismatch]:
    """Yield subscriptions of images on a topic that carries compressed ones."""
    published = {it.topic for it in publishers}
    for each in subscriptions:
        topic, _, transport = each.topic.rpartition("/")
        kind = known()["transport_types"].get(transport)
        if kind is None or each.endpoint.type != _IMAGE or each.topic in published:
            continue
        message = (
            f"the topic {each.topic} carries {kind}, and is subscribed to with {_IMAGE}: "
            f"subscribe to {topic}, or with the other type"
        )
        yield _warning(message, each.endpoint.location)


def _displays(workspace: Workspace, publishers: Sequence[_TopicEnd]) -> Iterator[Mismatch]:
    """Yield displays of RViz that ask for reliable messages, which every publisher sends as best
    effort.
    """
    offered: dict[str, set[str | None]] = {}
    for each in publishers:
        offered.setdefault(each.topic, set()).add(each.endpoint.qos.reliability)
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
                    yield _warning(message, policy.location)


def _programs(workspace: Workspace) -> Iterator[Mismatch]:
    """Yield the well-known programs that send a controller another type than it reads."""
    for number, (package, launch) in enumerate(workspace.roots):
        wanted: dict[str, Endpoint] = {}
        for node in launch.nodes:
            for full, endpoint in controller_endpoints(workspace, number, node):
                if endpoint.kind == _SUBSCRIPTION:
                    wanted[full] = endpoint
        for node in launch.nodes:
            for row in known()["program_topics"].get(f"{node.package}/{node.executable}", ()):
                parameter, value, other = row["if"]
                given = workspace.parameters_given(package, node)
                topic, reader = node.topic(row["topic"]), None
                if topic is not None and node.when is True and not given.unknown:
                    reader = wanted.get(topic)
                found = given.values.get(parameter)
                if reader is None or (found is not None and isinstance(found.value, Unknown)):
                    continue
                is_other = found is not None and found.value == value
                kind = other if is_other else row["type"]
                if kind != reader.type:
                    message = (
                        f"{node.executable} publishes {topic} with {kind}, but the controller "
                        f"subscribes to it with {reader.type}: set its parameter {parameter}"
                    )
                    yield _warning(message, node.location, reader.location)
