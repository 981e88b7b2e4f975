"""Topics: those of own Python nodes as they are started, with their types and quality of service,
and bridge rows.
"""

from collections.abc import Iterator
from typing import NamedTuple

from grader.base.names import closest
from grader.base.source import Location
from grader.ros.launch.launch_model import StartedNode
from grader.ros.package.python_nodes import Endpoint
from grader.ros.workspace.bridges import bridge_rows
from grader.ros.workspace.controllers import controller_endpoints
from grader.ros.workspace.gazebo import BRIDGE
from grader.ros.workspace.names import (
    Compared,
    Definition,
    Fact,
    Mismatch,
    Open,
    Use,
    corrections,
    place_text,
)
from grader.ros.workspace.publishers import may_be_published
from grader.ros.workspace.workspace import Workspace

# Packages whose programs subscribe to no commands.
_WITHOUT_COMMANDS = (
    "controller_manager",
    "robot_state_publisher",
    "joint_state_publisher",
    "joint_state_publisher_gui",
    "rviz2",
)


class _Opened(NamedTuple):
    """A publisher or subscription of a node as it is started, with the full name of its topic."""

    topic: str
    endpoint: Endpoint
    launch: int  # of those that are started on their own
    node: StartedNode

    @property
    def of_controller(self) -> bool:
        """Return whether it is opened by a controller of ros2_control."""
        return self.node.executable == "ros2_control_node"

    @property
    def is_started(self) -> bool:
        """Return whether the node is started under the default arguments."""
        return self.node.when is True


def topic_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield topics of own nodes that differ in type or quality of service, and remappings of names
    that no node has.
    """
    opened: list[_Opened] = []
    for launch, node in workspace.launched:
        if node.when is not False:
            of_controllers = controller_endpoints(workspace, launch, node)
            opened += (_Opened(topic, endpoint, launch, node) for topic, endpoint in of_controllers)
        own = workspace.python_node(node)
        if own is None or node.when is False:
            continue
        for endpoint in own.endpoints:
            # What begins with ~ is below the name of the node.
            is_plain = endpoint.name is not None and not endpoint.name.startswith("~")
            topic = node.topic(endpoint.name or "") if is_plain else None
            if topic is not None and endpoint.kind in ("publisher", "subscription"):
                yield Compared("topics")
                opened.append(_Opened(topic, endpoint, launch, node))
        yield from _remappings(workspace, node)
    publishers = [it for it in opened if it.endpoint.kind == "publisher"]
    for it in opened:
        if it.endpoint.kind == "subscription":
            for other in [other for other in publishers if other.topic == it.topic]:
                is_sure = it.launch == other.launch and it.is_started and other.is_started
                yield from (found._replace(is_sure=is_sure) for found in _differences(it, other))
    yield from _bridged_types(workspace, opened)
    yield from _unconnected(workspace, opened)
    yield from _unheard(workspace, opened)


def _differences(subscription: _Opened, publisher: _Opened) -> Iterator[Mismatch]:
    """Yield why a subscription does not get what a publisher of its topic sends."""
    own, other = subscription.endpoint, publisher.endpoint
    at = place_text(other.location)
    if subscription.of_controller:
        if own.type != other.type and other.type is not None:
            there = f"the controller subscribes to it with {own.type} ({place_text(own.location)})"
            message = f"the topic {publisher.topic} is published with {other.type}, but {there}"
            yield Mismatch("topics", message, other.location, own.location)
        return
    if own.type is not None and other.type is not None and own.type != other.type:
        message = (
            f"the topic {subscription.topic} is subscribed to with {own.type}, but published "
            f"with {other.type} ({at})"
        )
        yield Mismatch("topics", message, own.location, other.location)
    for wanted, given, words in (
        (own.qos.reliability, other.qos.reliability, ("reliable", "best_effort")),
        (own.qos.durability, other.qos.durability, ("transient_local", "volatile")),
    ):
        if (wanted, given) == words:
            message = (
                f"the subscription of {subscription.topic} asks for {words[0]}, but its "
                f"publisher is {words[1]} ({at})"
            )
            yield Mismatch("topics", message, own.location, other.location)


def _bridged_types(workspace: Workspace, opened: list[_Opened]) -> Iterator[Mismatch]:
    """Yield topics that a node and a bridge open with different types."""
    bridges = [node for _, node in workspace.nodes if node.package == BRIDGE]
    is_plain = all(node.remaps == () and node.namespace in ("", "/") for node in bridges)
    for row in bridge_rows(workspace) if bridges and is_plain else ():
        for own in [it for it in opened if it.topic == f"/{row.ros}" and not it.of_controller]:
            is_met = row.is_published if own.endpoint.kind == "subscription" else row.is_read
            if is_met and own.endpoint.type is not None and own.endpoint.type != row.ros_type:
                done = "published" if row.is_published else "subscribed to"
                there = f"{done} by the bridge with {row.ros_type} ({place_text(row.location)})"
                message = f"the topic {own.topic} has {own.endpoint.type} here, but is {there}"
                yield Mismatch(
                    "topics",
                    message,
                    own.endpoint.location,
                    row.location,
                    row.is_used and own.is_started,
                )


def _remappings(workspace: Workspace, node: StartedNode) -> Iterator[Fact]:
    """Yield the names that a node has, and those that remappings of it alone replace."""
    own = workspace.python_node(node)
    if own is None or node.remaps is None:
        return
    owner = f"{node.package}/{node.executable} {place_text(node.location)}"
    if own.doubts or any(it.name is None for it in own.endpoints):
        yield Open("topic", owner)
    for endpoint in own.endpoints:
        if endpoint.name is not None:
            yield Definition("topic", _bare(endpoint.name), endpoint.location, owner)
    shared = [
        rule for _, other in workspace.nodes if other is not node for rule in other.remaps or ()
    ]
    for rule in node.remaps:
        name = _bare(rule[0])
        if rule not in shared and not name.startswith("__") and ":" not in name:
            # Actions and what rclpy itself opens, such as /tf, are not listed.
            said = f"the remapping of {node.executable}"
            yield Use("topic", name, node.location, said, owner, optional=True)


def _bare(name: str) -> str:
    return name.removeprefix("~").removeprefix("/")


def _unconnected(workspace: Workspace, opened: list[_Opened]) -> Iterator[Fact]:
    """Yield subscriptions to topics that nothing publishes, where a similar one is published and
    not subscribed to.
    """
    offers = list(_offers(workspace, opened))
    topics = {it.topic for it in offers}
    subscriptions = [it for it in opened if it.endpoint.kind == "subscription"]
    subscribed = {it.topic for it in subscriptions}
    unused = [it for it in offers if it.topic not in subscribed]
    yield Open("topic")
    yield from (Definition("topic", it.topic, it.location) for it in unused)
    for own in [it for it in subscriptions if it.topic not in topics and not it.of_controller]:
        alike = [it for it in unused if it.type == own.endpoint.type and own.launch in it.launches]
        names = {it.topic for it in alike}
        if (
            len(names) == 1
            and closest(own.topic, names)
            and not may_be_published(workspace, own.topic)
        ):
            [meant], at = names, alike[0].location
            if any(own.node.topic(rule[1]) == meant for rule in own.node.remaps or ()):
                continue  # a remapping of another name, which is said of it
            message = f"nothing publishes {own.topic}; did you mean {meant} ({place_text(at)})?"
            either = corrections(own.topic, own.endpoint.location, meant, at)
            yield Mismatch("topics", message, own.endpoint.location, at, corrections=either)
        else:
            yield Use("topic", own.topic, own.endpoint.location, "create_subscription")


def _unheard(workspace: Workspace, opened: list[_Opened]) -> Iterator[Mismatch]:
    """Yield publishers that nothing subscribes to, where a controller waits for such messages on
    another topic.
    """
    subscriptions = [it for it in opened if it.endpoint.kind == "subscription"]
    publishers = [it for it in opened if it.endpoint.kind == "publisher" and not it.of_controller]
    heard, spoken = {it.topic for it in subscriptions}, {it.topic for it in publishers}
    unheard = [it for it in publishers if it.topic not in heard]
    for waiting in [it for it in subscriptions if it.of_controller and it.topic not in spoken]:
        own = [
            it
            for it in unheard
            if it.launch == waiting.launch and it.endpoint.type == waiting.endpoint.type
        ]
        for publisher in own:
            is_sure = (
                publisher.is_started
                and waiting.is_started
                and _is_known(workspace, publisher.launch)
            )
            is_same = publisher.topic.rpartition("/")[2] == waiting.topic.rpartition("/")[2]
            if is_same or (is_sure and len(own) == 1):
                place = place_text(waiting.endpoint.location)
                message = (
                    f"nothing subscribes to {publisher.topic}; did you mean {waiting.topic} "
                    f"({place})?"
                )
                yield Mismatch(
                    "topics",
                    message,
                    publisher.endpoint.location,
                    waiting.endpoint.location,
                    is_sure,
                )


def _is_known(workspace: Workspace, launch: int) -> bool:
    """Return whether all topics are known that the nodes of a launch file open."""
    nodes = [node for number, node in workspace.launched if number == launch]
    own = [workspace.python_node(node) for node in nodes if node.package not in _WITHOUT_COMMANDS]
    return not workspace.roots[launch][1].unknown and all(
        it is not None and not it.doubts for it in own
    )


class _Offer(NamedTuple):
    """A topic that a node or bridge publishes, and in which launches."""

    topic: str
    type: str | None
    location: Location
    launches: frozenset[int]


def _offers(workspace: Workspace, opened: list[_Opened]) -> Iterator[_Offer]:
    for it in opened:
        if it.endpoint.kind == "publisher":
            yield _Offer(it.topic, it.endpoint.type, it.endpoint.location, frozenset({it.launch}))
    launches = frozenset(number for number, node in workspace.launched if node.package == BRIDGE)
    for row in bridge_rows(workspace):
        if row.is_published:
            yield _Offer(f"/{row.ros}", row.ros_type, row.location, launches)
