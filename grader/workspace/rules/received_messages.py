"""Messages that arrive, and that their reader cannot use; and queues of no length.

They have no header where a synchroniser compares times, or are images with an encoding that
cannot be converted.
"""

from collections.abc import Mapping, Sequence

from grader.base.patterns import on_use
from grader.base.text import quoted
from grader.ros.interfaces.known_interfaces import known_interfaces
from grader.ros.known.package_tables import colour_encodings
from grader.ros.nodes.node_facts import EndpointKind, ImageEncoding
from grader.workspace.graph.code_ends import End
from grader.workspace.graph.graph import grouped, make_graph
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_MESSAGE,
    Rule,
)

_HEADER = "header"
# An encoding without colours: the type of a channel, and how many there are.
_PLAIN_ENCODING = on_use(r"(?:8U|8S|16U|16S|32S|32F|64F)(?:C(\d{1,2}))?")
# What the synchronisers of Python do with messages without a header. Those of C++ take a time of 0.
# Up to Jazzy it has another type of clock, and rclcpp compares no such times (message_traits.h).
_EFFECTS = {
    "TimeSynchronizer": "stops at messages",
    "ApproximateTimeSynchronizer": "drops messages without allow_headerless",
}
_ENDS = ("publisher", "subscription")


def received_message_facts(workspace: Workspace) -> Facts:
    """Yield messages that their reader cannot use."""
    for package in workspace.packages:
        yield from _without_header(workspace, package.name)
        yield from _without_queue(workspace, package.name)
    yield from _other_encodings(workspace)


_MESSAGE_HEADER = Rule(
    "message-header",
    "messages",
    NO_MESSAGE,
    "The messages of a filter or synchroniser have a header.",
    why=(
        "A synchroniser in Python drops messages without a header. One in C++ takes their time "
        "as 0, so the callback is never called or the node stops."
    ),
    wrong="""
filters = [Subscriber(self, TwistStamped, 'speed'), Subscriber(self, Twist, 'cmd_vel')]
self.pairs = ApproximateTimeSynchronizer(filters, 10, 0.1)
self.pairs.registerCallback(self.receive)
""",
    right="""
filters = [Subscriber(self, TwistStamped, 'speed'), Subscriber(self, TwistStamped, 'cmd_vel')]
self.pairs = ApproximateTimeSynchronizer(filters, 10, 0.1)
self.pairs.registerCallback(self.receive)
""",
    frame="start/pilot.py",
)


def _without_header(workspace: Workspace, package: str) -> Mismatches:
    """Yield the messages that a synchroniser drops, or stops at, since they have no header."""
    for each in workspace.code.by_package[package].synchronised:
        if _has_header(workspace, each.type) is not False:
            continue
        if each.together and not any(
            _has_header(workspace, type_name) for type_name in each.together
        ):
            continue  # all have the same time in C++, and each pair fits
        effect = _EFFECTS.get(
            each.by, "uses time 0 instead, so it stops or never matches the messages"
        )
        message = f"{each.type} has no header with a time: {each.by} {effect}"
        yield warning(_MESSAGE_HEADER, message, each.location)


def _has_header(workspace: Workspace, name: str) -> bool | None:
    """Return whether messages of a type have a header; None where this is not known."""
    package, _, own_name = name.partition(".")
    interfaces = workspace.code.interfaces.get(package)
    if interfaces:
        own_type = interfaces.types.get(own_name)
        interface = own_type.interface if own_type is not None and interfaces.is_complete else None
    else:
        interface = (known_interfaces(package, workspace.releases) or {}).get(own_name)
    if not interface or not interface.sections:
        return None
    return _HEADER in interface.sections[0].fields


_MESSAGE_DEPTH = Rule(
    "message-depth",
    "messages",
    NO_MESSAGE,
    "A publisher or subscription keeps messages.",
    why=(
        "ROS 2 replaces a depth of 0 with the default of the middleware, mostly 1. Of several "
        "messages in a short time only the last one is kept."
    ),
    wrong="self.speeds = self.create_publisher(Float64, 'speed', 0)",
    right="self.speeds = self.create_publisher(Float64, 'speed', 10)",
    frame="start/pilot.py",
)


def _without_queue(workspace: Workspace, package: str) -> Mismatches:
    """Yield publishers and subscriptions whose queue has no length."""
    for node in workspace.code.by_package[package].nodes:
        for endpoint in node.endpoints:
            if endpoint.kind in _ENDS and endpoint.qos.depth == 0:
                message = (
                    f"the {endpoint.kind} keeps 0 messages, which ROS 2 reads as the default of "
                    "the middleware, mostly 1: write how many"
                )
                yield warning(_MESSAGE_DEPTH, message, endpoint.location)


def _other_encodings(workspace: Workspace) -> Facts:
    """Yield the callbacks that convert images to an encoding to which they cannot be converted."""
    sent = _by_launch_and_topic(workspace, "publisher")
    for key, subscriptions in _by_launch_and_topic(workspace, "subscription").items():
        publishers = sent.get(key, ())
        if not publishers or not all(end.endpoint.encodings for end in publishers):
            continue
        made = [encoding for end in publishers for encoding in end.endpoint.encodings]
        for subscription in subscriptions:
            asked = subscription.endpoint.encodings
            workspace.charge(len(made) * len(asked))
            # Of several conversions, one may be for these images.
            are_lost = all(_is_lost(each.name, other.name) for each in made for other in asked)
            for encoding in asked:
                yield Compared("messages")
                if are_lost:
                    yield _cannot_convert(subscription.name, made[0], encoding)


def _by_launch_and_topic(
    workspace: Workspace, kind: EndpointKind
) -> Mapping[tuple[int, str], Sequence[End]]:
    """Return the ends of own code that certainly are opened, by launch and topic."""
    ends = make_graph(workspace).certain(kind, "code")
    return grouped(ends, lambda end: (end.launch, end.name))


_IMAGE_ENCODING = Rule(
    "image-encoding",
    "messages",
    NO_MESSAGE,
    "cv_bridge converts the images of a topic to the asked encoding.",
    why=(
        "cv_bridge raises an exception because it cannot convert between the encodings. The "
        "node stops at its first image."
    ),
    wrong="image = self.bridge.imgmsg_to_cv2(message, 'bgr8')",
    right="image = self.bridge.imgmsg_to_cv2(message, '16UC1')",
    frame="depth/pilot.py",
)


def _cannot_convert(topic: str, made: ImageEncoding, asked: ImageEncoding) -> Mismatch:
    at = made.location
    message = (
        f"the images of {topic} have the encoding {quoted(made.name)} ({at.file_and_line}), which "
        f"cv_bridge does not convert to {quoted(asked.name)}"
    )
    return warning(_IMAGE_ENCODING, message, asked.location, at)


def _is_lost(made: str, asked: str) -> bool:
    """Return whether cv_bridge certainly raises an error for a conversion.

    It is one of depths to colours, or to another number of channels.
    """
    colours = colour_encodings()
    before = _channels(made, colours)
    after = _channels(asked, colours)
    if made == asked or before is None or after is None:
        return False
    if made in colours and asked in colours:
        return False
    return asked in colours or before != after


def _channels(encoding: str, colours: Mapping[str, int]) -> int | None:
    """Return how many channels an encoding has; None for one that is not known."""
    if encoding in colours:
        return colours[encoding]
    plain = _PLAIN_ENCODING.fullmatch(encoding)
    return int(plain[1] or 1) if plain else None
