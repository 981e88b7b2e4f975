"""Topics: those of own Python nodes as they are started, with their types and quality of service,
and bridge rows.
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from grader.base.names import closest
from grader.base.source import Location
from grader.base.text import enumerated
from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.package.node_facts import Endpoint
from grader.ros.workspace.graph.bridge_rows import BRIDGE, bridge_rows
from grader.ros.workspace.graph.endpoints import opened_by
from grader.ros.workspace.graph.publishers import is_own_type, may_be_published
from grader.ros.workspace.graph.started_controllers import controller_endpoints
from grader.ros.workspace.interfaces import is_absent
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.names import (
    Compared,
    Counted,
    Definition,
    Fact,
    Mismatch,
    Open,
    Use,
    corrections,
)

_ENDS = ("publisher", "subscription")
_MAX_NAMED = 3  # programs


class _OpenedTopic(NamedTuple):
    """A publisher or subscription of a node as it is started, with the full name of its topic."""

    topic: str
    endpoint: Endpoint
    launch: int  # of those that are started on their own
    node: StartedNode

    @property
    def is_of_controller(self) -> bool:
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
    opened: list[_OpenedTopic] = []
    computed = 0
    for launch, node in workspace.launched:
        if node.when is False:
            continue
        for topic, endpoint in controller_endpoints(workspace, launch, node):
            opened.append(_OpenedTopic(topic, endpoint, launch, node))
        for found in opened_by(workspace, node):
            if found.endpoint.kind in _ENDS and found.is_known:
                opened.append(_OpenedTopic(found.name or "", found.endpoint, launch, node))
            elif found.endpoint.kind in _ENDS:
                computed += 1
    yield from _all_remappings(workspace)
    distinct = _distinct(opened)
    publishers = _by_topic(_opened_as("publisher", distinct))
    for subscription in _opened_as("subscription", distinct):
        for publisher in publishers.get(subscription.topic, ()):
            yield Compared("topics")
            are_started = subscription.is_started and publisher.is_started
            is_certain = are_started and subscription.launch == publisher.launch
            for mismatch in _differences(workspace, subscription, publisher):
                yield mismatch._replace(is_certain=is_certain)
    yield from _bridged_types(workspace, distinct)
    yield from _unconnected(workspace, distinct)
    yield from _unheard(workspace, distinct)
    yield _count(workspace, opened, computed)


def _distinct(opened: Iterable[_OpenedTopic]) -> list[_OpenedTopic]:
    """Return what differs: a loop starts a program often, with the same topics."""
    found: dict[object, _OpenedTopic] = {}
    for each in opened:
        node = each.node
        of_node = (node.executable, node.when, node.namespace, node.remaps)
        found.setdefault((each.topic, each.endpoint, each.launch, of_node), each)
    return list(found.values())


def _by_topic(opened: Iterable[_OpenedTopic]) -> dict[str, list[_OpenedTopic]]:
    by_topic: dict[str, list[_OpenedTopic]] = {}
    for each in opened:
        by_topic.setdefault(each.topic, []).append(each)
    return by_topic


def _count(workspace: Workspace, opened: Iterable[_OpenedTopic], computed: int) -> Counted:
    """Return how many topics of own nodes have another end, which a node, a controller or a bridge
    of the workspace opens; the names of others are `computed`.
    """
    rows = list(bridge_rows(workspace))
    published = {f"/{row.ros}" for row in rows if row.is_published}
    subscribed = {f"/{row.ros}" for row in rows if row.is_read}
    published |= {each.topic for each in _opened_as("publisher", opened)}
    subscribed |= {each.topic for each in _opened_as("subscription", opened)}
    own = [each for each in opened if not each.is_of_controller]
    compared = [
        each
        for each in own
        if each.topic in (subscribed if each.endpoint.kind == "publisher" else published)
    ]
    unread = set[str]()
    for _, node in workspace.launched:
        owner = workspace.package_of(node)
        if node.when is False or owner is None:
            continue
        own_node = workspace.own_node(node)
        if own_node is None and owner.has_program(node.package, node.executable):
            unread.add(node.executable)
    reasons = []
    if computed:
        reasons.append(f"{computed} {'is' if computed == 1 else 'are'} computed")
    if unread:
        reasons.append(f"the source of {enumerated(sorted(unread), _MAX_NAMED)} is not read")
    return Counted("topics", len(compared), len(own) + computed, ", and ".join(reasons))


def _opened_as(kind: str, opened: Iterable[_OpenedTopic]) -> list[_OpenedTopic]:
    return [each for each in opened if each.endpoint.kind == kind]


def _differences(
    workspace: Workspace, subscription: _OpenedTopic, publisher: _OpenedTopic
) -> Iterator[Mismatch]:
    """Yield why a subscription does not get what a publisher of its topic sends."""
    reader, writer = subscription.endpoint, publisher.endpoint
    if subscription.is_of_controller:
        if reader.type != writer.type and writer.type is not None:
            message = (
                f"the topic {publisher.topic} is published with {writer.type}, but the controller "
                f"subscribes to it with {reader.type} ({reader.location.file_and_line})"
            )
            yield Mismatch("topics", message, writer.location, reader.location, is_of_type=True)
        return
    at = writer.location.file_and_line
    types = [kind for kind in (reader.type, writer.type) if kind is not None]
    is_said = any(is_absent(workspace, kind) for kind in types)  # of the type
    if len({*types}) == 2 and not is_said:
        message = (
            f"the topic {subscription.topic} is subscribed to with {reader.type}, but published "
            f"with {writer.type} ({at})"
        )
        yield Mismatch("topics", message, reader.location, writer.location, is_of_type=True)
    incompatible = []  # what is asked for, and what is offered
    if reader.qos.reliability == "reliable" and writer.qos.reliability == "best_effort":
        incompatible.append(("reliable", "best_effort"))
    if reader.qos.durability == "transient_local" and writer.qos.durability == "volatile":
        incompatible.append(("transient_local", "volatile"))
    for wanted, offered in incompatible:
        message = (
            f"the subscription of {subscription.topic} asks for {wanted}, but its "
            f"publisher is {offered} ({at})"
        )
        yield Mismatch("topics", message, reader.location, writer.location)


def _bridged_types(workspace: Workspace, opened: list[_OpenedTopic]) -> Iterator[Mismatch]:
    """Yield topics that a node and a bridge open with different types."""
    bridges = [node for _, node in workspace.nodes if node.package == BRIDGE]
    is_plain = all(node.remaps == () and node.namespace in ("", "/") for node in bridges)
    if not bridges or not is_plain:
        return
    by_topic = _by_topic(each for each in opened if not each.is_of_controller)
    for row in bridge_rows(workspace):
        for each in by_topic.get(f"/{row.ros}", ()):
            workspace.charge(1)
            kind, at = each.endpoint.type, each.endpoint.location
            is_met = row.is_published if each.endpoint.kind == "subscription" else row.is_read
            if is_met and kind is not None and kind != row.ros_type:
                done = "published" if row.is_published else "subscribed to"
                message = (
                    f"the topic {each.topic} has {kind} here, but is {done} by the "
                    f"bridge with {row.ros_type} ({row.location.file_and_line})"
                )
                is_certain = row.is_used and each.is_started
                yield Mismatch("topics", message, at, row.location, is_certain, is_of_type=True)


def _all_remappings(workspace: Workspace) -> Iterator[Fact]:
    """Yield the names that nodes have, and those that remappings of one node alone replace."""
    owners: dict[tuple[str, ...], list[StartedNode]] = {}  # of each rule the first nodes with it
    for _, node in workspace.nodes:
        for rule in node.remaps or ():
            of_rule = owners.setdefault(rule, [])
            if len(of_rule) < 2 and not any(node is it for it in of_rule):
                of_rule.append(node)
    said: set[object] = set()
    for _, node in workspace.launched:
        key = (node.package, node.executable, node.location, node.remaps)
        if node.when is False or key in said:
            continue
        said.add(key)
        own = [rule for rule in node.remaps or () if len(owners[rule]) == 1]
        yield from _remappings(workspace, node, own)


def _remappings(
    workspace: Workspace, node: StartedNode, rules: Iterable[tuple[str, ...]]
) -> Iterator[Fact]:
    """Yield the names that a node has, and those that these remappings, of it alone, replace."""
    own_node = workspace.own_node(node)
    if own_node is None or node.remaps is None:
        return
    owner = f"{node.package}/{node.executable} {node.location.file_and_line}"
    plain = node._replace(remaps=(), namespace="")
    opened = [*opened_by(workspace, plain)]
    if own_node.doubts or not all(found.is_known for found in opened):
        yield Open("topic", owner)
    for endpoint in own_node.endpoints:
        if endpoint.name is not None:
            yield Definition("topic", _bare(endpoint.name), endpoint.location, owner)
    for found in opened:
        if found.name is not None and found.is_known:
            yield Definition("topic", _bare(found.name), found.endpoint.location, owner)
    for rule in rules:
        name = _bare(rule[0])
        if not name.startswith("__") and ":" not in name:
            # Actions and what rclpy itself opens, such as /tf, are not listed.
            said = f"the remapping of {node.executable}"
            yield Use("topic", name, node.location, said, owner, optional=True)


def _bare(name: str) -> str:
    return name.removeprefix("~").removeprefix("/")


def _unconnected(workspace: Workspace, opened: list[_OpenedTopic]) -> Iterator[Fact]:
    """Yield subscriptions to topics that nothing publishes, where a similar one is published and
    not subscribed to.
    """
    offers = list(_offers(workspace, opened))
    offered = {offer.topic for offer in offers}
    subscriptions = _opened_as("subscription", opened)
    subscribed = {subscription.topic for subscription in subscriptions}
    unused = [offer for offer in offers if offer.topic not in subscribed]
    by_type: dict[str | None, list[_Offer]] = {}
    for offer in unused:
        by_type.setdefault(offer.type, []).append(offer)
    yield Open("topic")
    for offer in unused:
        yield Definition("topic", offer.topic, offer.location)
    for subscription in subscriptions:
        topic, endpoint, node = subscription.topic, subscription.endpoint, subscription.node
        if topic in offered or subscription.is_of_controller:
            continue
        alike = by_type.get(endpoint.type, [])
        workspace.charge(len(alike))
        alike = [offer for offer in alike if subscription.launch in offer.launches]
        names = {offer.topic: offer.location for offer in alike}
        meant = closest(topic, names)
        is_one = len(names) == 1 or is_own_type(workspace, endpoint.type)
        if meant is None or not is_one or may_be_published(workspace, topic, endpoint.type):
            yield Use("topic", topic, endpoint.location, "create_subscription")
            continue
        at = names[meant]
        if any(node.topic(rule[1]) == meant for rule in node.remaps or ()):
            continue  # a remapping of another name, which is said of it
        message = f"nothing publishes {topic}; did you mean {meant} ({at.file_and_line})?"
        either = corrections(topic, endpoint.location, meant, at)
        yield Mismatch("topics", message, endpoint.location, at, corrections=either)


def _unheard(workspace: Workspace, opened: list[_OpenedTopic]) -> Iterator[Mismatch]:
    """Yield publishers that nothing subscribes to, where a controller waits for such messages on
    another topic.
    """
    subscriptions = _opened_as("subscription", opened)
    publishers = [each for each in _opened_as("publisher", opened) if not each.is_of_controller]
    heard = {subscription.topic for subscription in subscriptions}
    published = {publisher.topic for publisher in publishers}
    unheard = [publisher for publisher in publishers if publisher.topic not in heard]
    said: set[Location] = set()
    for waiting in subscriptions:
        if not waiting.is_of_controller or waiting.topic in published:
            continue
        kind, place = waiting.endpoint.type, waiting.endpoint.location
        workspace.charge(len(unheard))
        fitting = [publisher for publisher in unheard if publisher.launch == waiting.launch]
        fitting = [publisher for publisher in fitting if publisher.endpoint.type == kind]
        for publisher in fitting:
            are_started = publisher.is_started and waiting.is_started
            is_certain = are_started and _is_known(workspace, publisher.launch)
            is_same = publisher.topic.rpartition("/")[2] == waiting.topic.rpartition("/")[2]
            at = publisher.endpoint.location
            ends = [it.topic.split("/")[-2:] for it in (publisher, waiting)]
            if workspace.has_controllers_in_gazebo and ends[0] == ends[1]:
                continue  # Gazebo may have the same controller in another namespace
            if at not in said and (is_same or (is_certain and len(fitting) == 1)):
                said.add(at)
                message = (
                    f"nothing subscribes to {publisher.topic}; did you mean {waiting.topic} "
                    f"({place.file_and_line})?"
                )
                yield Mismatch("topics", message, at, place, is_certain)


def _is_known(workspace: Workspace, launch: int) -> bool:
    """Return whether all topics are known that the nodes of a launch file open."""
    if workspace.roots[launch][1].unknown:
        return False
    for number, node in workspace.launched:
        if number == launch and node.package not in known()["without_commands"]:
            own_node = workspace.own_node(node)
            if own_node is None or own_node.doubts:
                return False
    return True


class _Offer(NamedTuple):
    """A topic that a node or bridge publishes, and in which launches."""

    topic: str
    type: str | None
    location: Location
    launches: frozenset[int]


def _offers(workspace: Workspace, opened: list[_OpenedTopic]) -> Iterator[_Offer]:
    for publisher in _opened_as("publisher", opened):
        endpoint = publisher.endpoint
        launches = frozenset({publisher.launch})
        yield _Offer(publisher.topic, endpoint.type, endpoint.location, launches)
    launches = frozenset(number for number, node in workspace.launched if node.package == BRIDGE)
    for row in bridge_rows(workspace):
        if row.is_published:
            yield _Offer(f"/{row.ros}", row.ros_type, row.location, launches)
