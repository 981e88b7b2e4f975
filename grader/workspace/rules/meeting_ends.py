"""Topics, services and actions whose ends meet, and whether these agree.

They agree in type and quality of service.
"""

from collections.abc import Hashable, Iterator, Sequence

from grader.base.records import Named
from grader.ros.nodes.node_facts import EndpointKind
from grader.workspace.graph.bridge_rows import BRIDGE, BridgeRow
from grader.workspace.graph.code_ends import End, EndSource
from grader.workspace.graph.graph import Graph, distinct, grouped, make_graph
from grader.workspace.graph.node_ends import deciding_parameter
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.interfaces import is_absent
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
)
from grader.workspace.rules.rule_table import (
    NO_SERVICE,
    NO_TOPIC,
    Rule,
)
from grader.workspace.rules.shared_symptoms import INCOMPATIBLE_QUALITY

# What well-known programs subscribe to is compared by a rule of their topics.
_ASKING: tuple[EndSource, ...] = ("code", "controller", "bridge")
_OFFERING: tuple[EndSource, ...] = (*_ASKING, "program")


class Meeting(Named):
    """A kind of ends that ask for another kind, and how the two are called."""

    asking: EndpointKind
    offering: EndpointKind
    rule: Rule  # of its types
    noun: str
    is_asked: str  # the verb for an end that asks
    is_offered: str

    def ends(self, graph: Graph) -> tuple[list[End], list[End]]:
        """Return the ends of own code and of controllers that ask, and those that offer."""
        asking = distinct(graph.of_kind(self.asking))
        return asking, distinct(graph.of_kind(self.offering))


_TOPIC_TYPE = Rule(
    "topic-type",
    "topics",
    NO_TOPIC,
    "Publishers and subscriptions of a topic have one type.",
    is_of_type=True,
    why=(
        "Publisher and subscription of one topic with two types are never matched, so no "
        "message arrives. ros2 topic list -t shows both types."
    ),
    wrong="""
self.commands = self.create_publisher(Twist, 'cmd_vel', 10)
self.create_subscription(TwistStamped, 'cmd_vel', self.receive, 10)
""",
    right="""
self.commands = self.create_publisher(Twist, 'cmd_vel', 10)
self.create_subscription(Twist, 'cmd_vel', self.receive, 10)
""",
    frame="start/pilot.py",
)

TOPICS = Meeting("subscription", "publisher", _TOPIC_TYPE, "topic", "subscribed to", "published")
_SERVICE_TYPE = Rule(
    "service-type",
    "services",
    NO_SERVICE,
    "A service or action is called with the type with which it is served.",
    is_of_type=True,
    why=(
        "No request reaches a server with another type, so the client waits for an answer that "
        "never comes. No error is printed."
    ),
    wrong="""
self.create_service(Trigger, 'stop', self.serve)
self.client = self.create_client(SetBool, 'stop')
""",
    right="""
self.create_service(Trigger, 'stop', self.serve)
self.client = self.create_client(Trigger, 'stop')
""",
    frame="start/pilot.py",
)

SERVICES = (
    Meeting("client", "service", _SERVICE_TYPE, "service", "called", "served"),
    Meeting("action client", "action server", _SERVICE_TYPE, "action", "called", "served"),
)


# What a subscription asks for of a quality of service, and what is not enough.
_POLICIES = (
    ("reliability", "reliable", "best_effort"),
    ("durability", "transient_local", "volatile"),
)


def meeting_facts(workspace: Workspace) -> Facts:
    """Yield the ends that do not agree with another end of their name."""
    graph = make_graph(workspace)
    for meeting in (TOPICS, *SERVICES):
        every_asking = distinct(graph.of_kind(meeting.asking, sources=_ASKING))
        every_offering = distinct(graph.of_kind(meeting.offering, sources=_OFFERING))
        is_compared = False
        for asking, offering in _pairs(graph, every_asking, every_offering):
            if _is_of_other_rule(asking, offering):
                continue
            is_compared = True
            if asking.source == "controller":
                yield from _other_type_of_controller(asking, offering)
            else:
                yield from _other_type(workspace, meeting, asking, offering)
                yield from _other_quality(asking, offering)
        if is_compared:
            yield Compared(meeting.rule.family)
    yield from _other_type_of_bridge(graph)


def _pairs(
    graph: Graph, every_asking: Sequence[End], every_offering: Sequence[End]
) -> Iterator[tuple[End, End]]:
    """Yield each end with those that offer it; one of those that are alike and agree with it."""
    groups = grouped(every_offering, _compared_by)
    firsts = [alike[0] for alike in groups.values()]
    for asking, first in graph.pairs(every_asking, firsts):
        if asking.type == first.type and asking.source == "controller":
            yield asking, first
            continue
        alike = groups[_compared_by(first)]
        graph.workspace.charge(len(alike))
        for offering in alike:
            yield asking, offering


def _compared_by(end: End) -> Hashable:
    """Return what decides whether an end agrees with one that asks for it."""
    key = end.name, end.source, end.type
    if end.source != "program":
        return key
    node = end.node  # a parameter of a program may decide its type
    return *key, node.package, node.executable, node.namespace, node.node_name, node.remaps


def _is_of_other_rule(asking: End, offering: End) -> bool:
    """Return whether another rule compares two ends.

    Another rule is that of rows of bridges, also of those that nothing starts, or that of the
    parameters of programs.
    """
    if asking.source == "bridge":
        return offering.source in ("bridge", "code")
    if offering.source == "bridge":
        return asking.source == "code"
    is_command = asking.source == "controller" and offering.source == "program"
    return is_command and deciding_parameter(offering) is not None


def _differ(asking: End, offering: End) -> bool:
    """Return whether the types of two ends are known, and not the same."""
    types = {asking.type, offering.type}
    return None not in types and len(types) == 2


def _other_type(workspace: Workspace, meeting: Meeting, asking: End, offering: End) -> Mismatches:
    """Yield that an end of own code or a bridge asks for another type than is offered.

    Of a type that is nowhere, that is said instead.
    """
    if not _differ(asking, offering):
        return
    if any(is_absent(workspace, end.type or "") for end in (asking, offering)):
        return
    by = f" by {offering.owner}" if offering.source == "program" else ""
    message = (
        f"the {meeting.noun} {asking.name} is {meeting.is_asked} with {asking.type}, but "
        f"{meeting.is_offered} with {offering.type}{by} ({offering.location.file_and_line})"
    )
    yield Mismatch(
        meeting.rule,
        message,
        asking.location,
        offering.location,
        is_certain=asking.surely_meets(offering),
    )


def _other_type_of_controller(asking: End, offering: End) -> Mismatches:
    """Yield that a topic is published with another type than a controller reads."""
    if _differ(asking, offering):
        message = (
            f"the topic {offering.name} is published with {offering.type}, but the controller "
            f"subscribes to it with {asking.type} ({asking.location.file_and_line})"
        )
        yield Mismatch(
            _TOPIC_TYPE,
            message,
            offering.location,
            asking.location,
            is_certain=asking.surely_meets(offering),
        )


_TOPIC_QUALITY = Rule(
    "topic-quality",
    "topics",
    NO_TOPIC,
    "A publisher offers the quality of service that a subscription needs.",
    why=(
        "The middleware does not connect the two. ROS 2 warns of incompatible QoS, and no "
        "message arrives although ros2 topic list shows the topic."
    ),
    symptoms=(INCOMPATIBLE_QUALITY,),
    wrong="""
best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
self.speeds = self.create_publisher(Float64, 'speed', best_effort)
self.create_subscription(Float64, 'speed', self.receive, 10)
""",
    right="""
best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
self.speeds = self.create_publisher(Float64, 'speed', best_effort)
self.create_subscription(Float64, 'speed', self.receive, best_effort)
""",
    frame="start/pilot.py",
)


def _other_quality(asking: End, offering: End) -> Mismatches:
    """Yield the policies of a publisher that do not satisfy a subscription: no message arrives."""
    if asking.kind != "subscription":
        return
    for policy, *unequal in _POLICIES:
        asked = getattr(asking.endpoint.qos, policy)
        offered = getattr(offering.endpoint.qos, policy)
        if [asked, offered] == unequal:
            message = (
                f"the subscription of {asking.name} asks for {asked}, but its publisher is "
                f"{offered} ({offering.location.file_and_line})"
            )
            is_certain = asking.surely_meets(offering)
            wrong = Mismatch(
                _TOPIC_QUALITY, message, asking.location, offering.location, is_certain
            )
            yield wrong._replace(names=(asking.name,))


def _other_type_of_bridge(graph: Graph) -> Mismatches:
    """Yield topics that own code and a row of a bridge open with different types.

    A row of a file that no launch file names counts too, as far as all bridges keep their names.
    """
    bridges = [node for node in graph.workspace.launches.nodes if node.package == BRIDGE]
    is_plain = all(node.remaps == () and node.namespace in ("", "/") for node in bridges)
    if not bridges or not is_plain:
        return
    ends = distinct(graph.of_kind("subscription", "publisher", sources=("code",)))
    for end, row in graph.bridged(ends):
        if end.type not in (None, row.ros_type):
            yield _other_type_in_row(end, row)


def _other_type_in_row(end: End, row: BridgeRow) -> Mismatch:
    verb = "published" if row.is_published else "subscribed to"
    message = (
        f"the topic {end.name} has {end.type} here, but is {verb} by the bridge with "
        f"{row.ros_type} ({row.location.file_and_line})"
    )
    is_certain = row.is_used and end.is_certain
    return Mismatch(_TOPIC_TYPE, message, end.location, row.location, is_certain)
