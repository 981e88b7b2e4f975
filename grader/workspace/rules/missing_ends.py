"""Topics, services and actions without another end, where a similar or fitting one is free."""

from collections.abc import Collection, Iterator, Sequence

from grader.base.names import closest, first_part, is_misspelling, last_part
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.known.shared_names import shared_names
from grader.workspace.graph.bridge_rows import BRIDGE, bridge_rows
from grader.workspace.graph.code_ends import End
from grader.workspace.graph.graph import Graph, grouped, make_graph
from grader.workspace.graph.unread_ends import (
    Sought,
    is_all_read,
    is_own_type,
    may_be_opened,
)
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.meeting_ends import SERVICES, TOPICS, Meeting
from grader.workspace.rules.names import (
    Definition,
    Facts,
    Mismatch,
    Mismatches,
    Open,
    Use,
    charge_guess,
)
from grader.workspace.rules.rule_table import (
    NO_SERVICE,
    NO_TOPIC,
    Rule,
)


class _Offer(Named):
    """A topic that something publishes in a launch, by its name and its type."""

    topic: str
    type: str | None
    location: Location
    launch: int  # -1 for a row of a bridge that no launch file starts


def missing_end_facts(workspace: Workspace) -> Facts:
    """Yield the ends that nothing answers, where what they surely mean waits under another name."""
    graph = make_graph(workspace)
    subscriptions, publishers = TOPICS.ends(graph)
    yield from _without_publisher(graph, subscriptions, publishers)
    yield from _without_subscription(graph, subscriptions, publishers)
    for meeting in SERVICES:
        yield from _without_server(graph, meeting)


def _without_publisher(
    graph: Graph, subscriptions: Sequence[End], publishers: Sequence[End]
) -> Facts:
    """Yield subscriptions to unpublished topics where a similar one is published.

    The similar topic is one that is not subscribed to.
    """
    workspace = graph.workspace
    offers = list(_offers(workspace, publishers))
    offered = {offer.topic for offer in offers}
    offered |= {end.name for end in graph.of_kind("publisher", sources=("program",))}
    subscribed = {end.name for end in subscriptions}
    unused = [offer for offer in offers if offer.topic not in subscribed]
    yield Open("topic")
    for offer in unused:
        yield Definition("topic", offer.topic, offer.location)
    by_type = grouped(unused, lambda offer: offer.type)
    for end in subscriptions:
        if end.name not in offered and end.source != "controller":
            yield from _similar_topic(workspace, end, by_type.get(end.type, ()))


def _offers(workspace: Workspace, publishers: Sequence[End]) -> Iterator[_Offer]:
    """Yield what own code, controllers and bridges publish."""
    for end in publishers:
        yield _Offer(end.name, end.type, end.location, end.launch)
    launches = {
        launch for launch, node in workspace.launches.launched if node.package == BRIDGE
    } or {-1}
    for row in bridge_rows(workspace):
        if row.is_published:
            for launch in launches:
                yield _Offer(f"/{row.ros}", row.ros_type, row.location, launch)


_TOPIC_PUBLISHED = Rule(
    "topic-published",
    "topics",
    NO_TOPIC,
    "The topic that a node subscribes to is published.",
    why=(
        "The subscription waits without an error, and its callback is never called. ros2 topic "
        "info shows a publisher count of 0."
    ),
    wrong="""
self.commands = self.create_publisher(Twist, 'cmd_vel', 10)
self.create_subscription(Twist, 'cmd_vell', self.receive, 10)
""",
    right="""
self.commands = self.create_publisher(Twist, 'cmd_vel', 10)
self.create_subscription(Twist, 'cmd_vel', self.receive, 10)
""",
    frame="start/pilot.py",
)


def _similar_topic(workspace: Workspace, end: End, alike: Sequence[_Offer]) -> Facts:
    """Yield the topic that a subscription surely means, of those of its type.

    Else yield that it uses its own, to which a similar name may be a correction. Names that differ
    in a whole word are of two things: hardware may have the other end of each.
    """
    charge_guess(workspace, alike)
    places = {offer.topic: offer.location for offer in alike if offer.launch == end.launch}
    meant = closest(end.name, places)
    if meant is not None and not is_misspelling(end.name, meant):
        return
    is_one = len(places) == 1 or is_own_type(workspace, end.type)
    if meant is None or not is_one or _may_be_published(workspace, end):
        yield Use("topic", end.name, end.location, "create_subscription")
    elif not any(end.node.topic(rule[1]) == meant for rule in end.node.remaps or ()):
        # Else it is a remapping of another name, which is said of it.
        yield _no_other_end(
            _TOPIC_PUBLISHED, f"nothing publishes {end.name}", end, meant, places[meant]
        )


def _may_be_published(workspace: Workspace, end: End) -> bool:
    """Return whether a topic may be published: by what is not read, or as names in files say."""
    if may_be_opened(workspace, Sought("publisher", end.name, end.type)):
        return True
    if is_own_type(workspace, end.type):
        return False
    name = end.name.strip("/")
    last = last_part(end.name)
    if last in shared_names().topics or first_part(name) in workspace.installed.controllers:
        return True
    # A parameter, or a remapping of a plugin, may name what something publishes.
    texts = [tree.source.text for tree in workspace.installed.trees]
    for robot in workspace.robots.known:
        texts += [tag.text or "" for tag in robot.root.iter("remapping", "ros_topic")]
    return any(name in text for text in texts)


def _no_other_end(rule: Rule, what: str, end: End, meant: str, at: Location) -> Mismatch:
    """Return that an end has no other one, and the name that it surely means."""
    message = f"{what}; did you mean {meant} ({at.file_and_line})?"
    return Mismatch(rule, message, end.location, at).correcting(end.name, meant, at)


def _without_subscription(
    graph: Graph, subscriptions: Sequence[End], publishers: Sequence[End]
) -> Mismatches:
    """Yield publishers that nothing subscribes to, where a controller waits on another topic.

    The controller waits for such messages there.

    It is certain where one launch file starts both, and all of its topics are read. A publisher of
    the same name may be meant for a controller of Gazebo in another namespace.
    """
    of_code = [end for end in publishers if end.source == "code"]
    subscribed = {end.name for end in subscriptions} | graph.names_read
    unheard = [end for end in of_code if end.name not in subscribed]
    named: set[Location] = set()
    publishing = grouped(of_code, lambda end: end.name)
    for waiting in subscriptions:
        launches = {end.launch for end in publishing.get(waiting.name, ())}
        if waiting.source == "controller" and waiting.launch not in launches:
            meant = unheard
            if launches:  # a person may start another one, which feeds it
                meant = [end for end in unheard if is_misspelling(end.name, waiting.name)]
            yield from _meant_for(graph, waiting, meant, named)


def _meant_for(
    graph: Graph, waiting: End, unheard: Sequence[End], named: set[Location]
) -> Mismatches:
    """Yield the publishers that mean the topic of a controller; `named` are those of others."""
    fitting = graph.alike(waiting, unheard)
    for publisher in fitting:
        if publisher.location in named:
            continue
        mismatch = _unheard(graph.workspace, publisher, waiting, is_only=len(fitting) == 1)
        if mismatch:
            named.add(publisher.location)
            yield mismatch


_TOPIC_SUBSCRIBED = Rule(
    "topic-subscribed",
    "topics",
    NO_TOPIC,
    "The topic that a node publishes is the one that a controller waits for.",
    why=(
        "Commands are published, and the robot does not move. ros2 topic info shows a "
        "subscription count of 0 for the topic of the node."
    ),
    wrong="self.commands = self.create_publisher(TwistStamped, 'cmd_vel', 10)",
    right="self.commands = self.create_publisher(TwistStamped, 'drive_controller/cmd_vel', 10)",
    frame="start/pilot.py",
    beside={
        "drive/rover.urdf": "",
        "drive/controllers.yaml": "",
        "drive/rover.launch.py": "Node(package='rover', executable='pilot'),",
    },
)


def _unheard(
    workspace: Workspace, publisher: End, waiting: End, *, is_only: bool
) -> Mismatch | None:
    """Return that a publisher means the topic on which a controller waits.

    The result is None where that is not known.
    """
    if _may_be_of_gazebo(workspace, publisher, waiting):
        return None
    at = publisher.location
    place = waiting.location
    is_certain = publisher.surely_meets(waiting) and is_all_read(workspace, waiting.launch)
    is_same = _last_names(publisher, 1) == _last_names(waiting, 1)
    if not is_same and not (is_certain and is_only):
        return None
    message = (
        f"nothing subscribes to {publisher.name}; did you mean {waiting.name} "
        f"({place.file_and_line})?"
    )
    wrong = Mismatch(_TOPIC_SUBSCRIBED, message, at, place, is_certain)
    return wrong.offering(publisher.name, waiting.name)


def _last_names(end: End, count: int) -> list[str]:
    """Return the last parts of the name of a topic."""
    return end.name.split("/")[-count:]


def _may_be_of_gazebo(workspace: Workspace, publisher: End, waiting: End) -> bool:
    """Return whether Gazebo may have the same controller in another namespace."""
    is_same = _last_names(publisher, 2) == _last_names(waiting, 2)
    return is_same and workspace.robots.has_controllers_in_gazebo


def _without_server(graph: Graph, meeting: Meeting) -> Mismatches:
    """Yield that nothing serves what a client calls, where a server waits under another name.

    The server has the type of the client, and there is one such name only. It is certain where
    the nodes of both certainly are started.
    """
    clients, servers = meeting.ends(graph)
    called = {end.name for end in clients}
    served = {end.name for end in servers}
    uncalled = [end for end in servers if end.name not in called]
    for client in clients:
        if client.name not in served and client.type is not None:
            yield from _served_elsewhere(graph, meeting, client, uncalled)


_SERVICE_SERVED = Rule(
    "service-served",
    "services",
    NO_SERVICE,
    "The service or action that a node calls is served.",
    why=(
        "The client waits for a server that does not exist: wait_for_service() or "
        "wait_for_server() returns False after its timeout, or never returns."
    ),
    wrong="""
self.create_service(Trigger, 'stop', self.serve)
self.client = self.create_client(Trigger, 'stopp')
""",
    right="""
self.create_service(Trigger, 'stop', self.serve)
self.client = self.create_client(Trigger, 'stop')
""",
    frame="start/pilot.py",
)


def _served_elsewhere(
    graph: Graph, meeting: Meeting, client: End, uncalled: Sequence[End]
) -> Mismatches:
    """Yield that the server of a client's type waits under one other name."""
    alike = {end.name: end for end in reversed(graph.alike(client, uncalled))}
    if len(alike) != 1 or _may_be_served(graph.workspace, meeting, client, alike):
        return
    [(meant, server)] = alike.items()
    what = f"nothing serves the {meeting.noun} {client.name}"
    mismatch = _no_other_end(_SERVICE_SERVED, what, client, meant, server.location)
    yield mismatch._replace(is_certain=client.is_certain and server.is_certain)


def _may_be_served(
    workspace: Workspace, meeting: Meeting, client: End, names: Collection[str]
) -> bool:
    """Return whether a client may mean another server than those of some names."""
    is_meant = is_own_type(workspace, client.type) or closest(client.name, names) is not None
    if not is_meant:
        return True
    return may_be_opened(workspace, Sought(meeting.offering, client.name, client.type))
