"""Checks of the graph: what connects after launch files are launched, by whatever nodes.

The graph is that of `grader graph`. What is not read, or known only at run time, leaves a
criterion open where it may decide it.
"""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from grader.base.errors import NotDecided, RubricError
from grader.base.names import closest
from grader.base.quantities import point
from grader.base.text import MAX_NAMED, enumerated, quoted
from grader.base.toml_types import NonNegative
from grader.base.transforms import Transform, Vector, rotation_from_rpy, turn_between
from grader.lab.checks.check import About
from grader.lab.checks.launching import (
    OPENS,
    RUNS,
    Launched,
    Quality,
    check_open,
    fail_absent,
    full_name,
    launch_together,
    type_name,
)
from grader.lab.checks.outcome import Outcome, failed, judged, measured_point, measured_turn
from grader.lab.submission.submission import Submission
from grader.ros.package.package import Package

if TYPE_CHECKING:
    from grader.ros.api import EndpointKind
    from grader.workspace.api import GraphEnd, GraphTransform

_NAMED = {**OPENS, "type": "a type differs"}
ABOUT = {
    "connects": About(
        ("launch",),
        causes={
            **_NAMED,
            "way": "nodes are not connected",
            "quality": "the quality of service differs",
        },
    ),
    "topic_has_type": About(("launch",), causes=_NAMED),
    "reaches": About(("launch",), causes=_NAMED),
    "publishes_transform": About(
        ("launch",),
        causes={
            **RUNS,
            "frame": "nothing publishes a frame",
            "parent": "a frame has another parent",
            "reversed": "parent and child are exchanged",
            "states": "nothing publishes joint states",
        },
    ),
}
_HIDDEN = ("/tf", "/tf_static", "/rosout", "/parameter_events")
_SERVERS: "Sequence[EndpointKind]" = ("service", "action server")
_CLIENTS: "Sequence[EndpointKind]" = ("client", "action client")
_SENDS: "Sequence[EndpointKind]" = ("publisher",)
_READS: "Sequence[EndpointKind]" = ("subscription",)
_ENDS_OF_TOPIC = (*_SENDS, *_READS)


def connects(
    package: Package,
    submission: Submission,
    *,
    from_: str,
    to: str,
    read: bool = False,
    qos: Quality | None = None,
    launch: str | None = None,
) -> Outcome:
    """Messages find a way from one topic to another one through nodes that are started, whatever
    their names and their number.

    A node passes on what it receives in all that it publishes: what its code does with it is not
    examined. Goals of actions pass it on as well; a way through a service needs manual grading. It
    does not matter what publishes the first topic, and reads the last one. RViz passes nothing on.

    Args:
        from: The topic where the way begins.
        to: The topic where it ends.
        read: Whether a node, a controller or a bridge must read the last topic, with its type. If
            both topics are one, nothing else is asked.
        qos: The quality of service of nodes that are not submitted: of what publishes the first
            topic, and of what reads the last one.
        launch: The name of the launch file; default: all launch files together.
    """
    start, end = full_name(from_), full_name(to)
    _refuse_hidden("connects follows no messages of", start, end)
    launched = launch_together(package, submission, launch)
    unheard = _judge_quality(launched, (start, end), qos)
    if unheard:
        return unheard
    if read and start == end:
        return _judge_reader(launched, end, f"messages are published on {end}")
    way = launched.graph.find_way(start, end)
    if not way.arrives:
        return launched.failure or _fail_way(launched, start, end, way.nodes)
    if way.doubt:
        cause = "cannot determine statically whether messages find a way"
        raise NotDecided(f"{cause} from {start} to {end}: {way.doubt}", cause)
    names = tuple(launched.graph.graph.nodes[number].label for number in way.nodes)
    message = f"messages go from {start} to {end} through {enumerated(names)}"
    return _judge_reader(launched, end, message) if read else judged(True, message, names)


def _refuse_hidden(what: str, *topics: str) -> None:
    """Raise RubricError for topics that every node has."""
    for topic in topics:
        if topic in _HIDDEN:
            raise RubricError((f"{what} {topic}",))


def _judge_quality(
    launched: Launched, way: tuple[str, str], others: Quality | None
) -> Outcome | None:
    """Return that an end of a way does not connect to a node outside; None if all do."""
    from grader.workspace.api import fault_with_others  # late: few rubrics ask

    if others is None:
        return None
    ends = [*launched.graph.ends(_READS, way[0]), *launched.graph.ends(_SENDS, way[1])]
    for placed in ends:
        if not placed.doubt:
            end = placed.end
            fault = fault_with_others(end.kind, end.qos, others)
            if fault:
                message = (
                    f"{end.name} does not connect to nodes whose quality of service is "
                    f"{quoted(others)}"
                )
                return failed(message, end.location, detail=f": {fault}", cause="quality")
    return None


def _judge_reader(launched: Launched, topic: str, message: str) -> Outcome:
    """Return whether what is published on a topic is read."""
    reader = launched.graph.find_reader(topic)
    if reader:
        return judged(True, f"{message}, which {reader.node.label} reads", reader.node.label)
    sent, read = launched.graph.ends(_SENDS, topic), launched.graph.ends(_READS, topic)
    check_open(launched, f"{topic} is published", sent, _SENDS)
    check_open(launched, f"something reads {topic}", read, _READS)
    if launched.failure or not sent:
        return launched.failure or fail_absent(launched, _SENDS, "publishes", topic)
    publisher = sent[0]
    message = f"{publisher.node.label} publishes {topic} with {publisher.end.type}"
    if read:
        detail = f", and {read[0].node.label} reads it with {read[0].end.type}"
        return failed(f"{message}{detail}", publisher.end.location, cause="type")
    detail = ""
    for placed in launched.graph.unfed(publisher.end.type):
        detail = f"; {placed.node.label} waits for {placed.end.type} on {placed.end.name}"
    message = f"{message}, which nothing reads"
    return failed(message, publisher.end.location, detail=detail, cause="way")


def topic_has_type(
    package: Package,
    submission: Submission,
    *,
    topic: str,
    type: str,  # noqa: A002  a rubric calls it so
    launch: str | None = None,
) -> Outcome:
    """A topic has this type in all nodes that are started, and one of them opens it.

    Args:
        topic: The topic.
        type: Its type: sensor_msgs/msg/LaserScan.
        launch: The name of the launch file; default: all launch files together.
    """
    name, wanted = full_name(topic), type_name(type)
    _refuse_hidden("topic_has_type knows no types of", name)
    launched = launch_together(package, submission, launch)
    ends = launched.graph.ends(_ENDS_OF_TOPIC, name)
    certain = [placed.end for placed in ends if not placed.doubt]
    for end in certain:
        if end.type != wanted:
            message = f"{name} has the type {end.type}; it should be {wanted}"
            return failed(message, end.location, cause="type")
    if certain:
        return judged(True, f"{name} has the type {wanted}", wanted, wanted)
    check_open(launched, f"{name} has the type {wanted}", ends, _ENDS_OF_TOPIC)
    return launched.failure or fail_absent(launched, _ENDS_OF_TOPIC, "opens", name)


def reaches(
    package: Package,
    submission: Submission,
    *,
    service: str,
    type: str | None = None,  # noqa: A002  a rubric calls it so
    launch: str | None = None,
) -> Outcome:
    """A client and a server of a service or an action meet: nodes that are started have both, by
    one name and with one type.

    Args:
        service: The service or the action.
        type: Its type: std_srvs/srv/Trigger.
        launch: The name of the launch file; default: all launch files together.
    """
    name, wanted = full_name(service), type_name(type or "")
    launched = launch_together(package, submission, launch)
    servers = launched.graph.ends(_SERVERS, name)
    clients = launched.graph.ends(_CLIENTS, name)
    for server in servers:
        for client in clients:
            if not (server.doubt or client.doubt) and _do_meet(server.end, client.end, wanted):
                nodes = (client.node.label, server.node.label)
                return judged(True, f"{nodes[0]} calls {name}, which {nodes[1]} serves", nodes)
    for verb, kinds, ends in (("serves", _SERVERS, servers), ("calls", _CLIENTS, clients)):
        check_open(launched, f"a node {verb} {name}", ends, kinds)
    if launched.failure:
        return launched.failure
    for verb, kinds, ends in (("serves", _SERVERS, servers), ("calls", _CLIENTS, clients)):
        if not ends:
            return fail_absent(launched, kinds, verb, name)
    return _fail_pair(name, servers[0].end, clients[0].end, wanted)


def publishes_transform(
    package: Package,
    submission: Submission,
    *,
    parent: str,
    child: str,
    xyz: Vector | None = None,
    rpy: Vector | None = None,
    tolerance: NonNegative = 0.002,
    angle: NonNegative = 1.0,
    launch: str | None = None,
) -> Outcome:
    """A frame is published below another one by what is started: a node, a static publisher, a
    controller, a bridge, or the joints of the robot. There may be frames between them.

    A pose is known of static publishers, of fixed joints, and of code that sets it to numbers.
    robot_state_publisher publishes a joint that moves only if something publishes joint states.

    Args:
        parent: The frame above.
        child: The frame below.
        xyz: Where the frame is in the one above: x, y and z, in metres.
        rpy: Its orientation: roll, pitch and yaw about fixed axes, in radians.
        tolerance: How far each coordinate may be off, in metres.
        angle: How far the orientation may be off, in degrees.
        launch: The name of the launch file; default: all launch files together.
    """
    launched = launch_together(package, submission, launch)
    above = parent.removeprefix("/")
    below = child.removeprefix("/")
    transforms = launched.graph.transforms()
    certain = [transform for transform in transforms if transform.is_certain]
    with_states = [each for each in certain if _gets_joint_states(launched, each)]
    chain = _chain(with_states, above, below)
    if chain is None:
        chain = _chain(certain, above, below)
        if chain is not None:
            return _fail_without_states(launched, chain)
    if chain is not None:
        by = tuple(dict.fromkeys(transform.by for transform in chain))
        if xyz is None and rpy is None:
            return judged(True, f"{below} is published below {above} by {enumerated(by)}", by)
        T_above_below = _pose_along(chain, above, below)
        at = chain[-1].location
        if xyz is not None:
            what = f"the frame {quoted(below)}"
            placed = measured_point(what, T_above_below.translation, xyz, tolerance, above, at=at)
        else:
            placed = judged(True, f"{below} is published below {above} by {enumerated(by)}", by)
        if rpy is None:
            return placed
        turned = turn_between(T_above_below.rotation, rotation_from_rpy(rpy))
        return measured_turn(placed, turned, angle, f"rpy = {point(rpy)} (radians)", at)
    doubt = _doubt_of_transform(launched, transforms, above, below)
    if doubt:
        cause = "cannot determine statically which transforms are published"
        raise NotDecided(f"{cause}: {doubt}", cause)
    return launched.failure or _fail_transform(transforms, above, below)


def _pose_along(chain: "Sequence[GraphTransform]", above: str, below: str) -> Transform:
    """Return T_above_below of a row of transforms, the lowest first."""
    T_above_below = Transform()
    for transform in chain:
        if not transform.pose:
            cause = f"cannot determine statically where {below} is in {above}"
            raise NotDecided(f"{cause}: {transform.by} computes it", cause)
        T_above_below = transform.pose @ T_above_below
    return T_above_below


def _gets_joint_states(launched: Launched, transform: "GraphTransform") -> bool:
    """Return whether the joint states are certainly published that a transform needs, if any."""
    ends = [end for topic in transform.needs for end in launched.graph.ends(_SENDS, topic)]
    return not transform.needs or any(not placed.doubt for placed in ends)


def _fail_without_states(launched: Launched, chain: "Sequence[GraphTransform]") -> Outcome:
    """Return that nothing publishes the joint states that a transform needs.

    Raises NotDecided if something may.
    """
    lacking = next(each for each in chain if not _gets_joint_states(launched, each))
    for topic in lacking.needs:
        ends = launched.graph.ends(_SENDS, topic)
        check_open(launched, f"something publishes {topic}", ends, _SENDS)
    if launched.has_commands:
        cause = f"cannot determine statically whether something publishes {lacking.needs[0]}"
        raise NotDecided(f"{cause}: a command of a launch file may start it", cause)
    message = f"nothing publishes {lacking.needs[0]}"
    detail = f", without which {lacking.by} has no transform"
    return failed(message, lacking.location, detail=detail, cause="states")


def _doubt_of_transform(
    launched: Launched, transforms: "Sequence[GraphTransform]", parent: str, child: str
) -> str:
    """Return why a frame may be published below another one; empty if it certainly is not."""
    for transform in _chain(transforms, parent, child) or ():
        if not transform.is_certain:
            return f"whether {transform.by} publishes {transform.child} is not known"
    unread = next(launched.graph.unread_transforms(), None)
    return unread.reason if unread else ""


def _do_meet(offered: "GraphEnd", asked: "GraphEnd", wanted: str) -> bool:
    """Return whether a server and a client are of one kind and of one type, the wanted one."""
    is_pair = offered.carrier == asked.carrier
    return is_pair and offered.type == asked.type and wanted in ("", offered.type)


def _fail_pair(name: str, offered: "GraphEnd", asked: "GraphEnd", wanted: str) -> Outcome:
    """Return that a server and a client of one name differ, or have another type than wanted."""
    if offered.type == asked.type and wanted:
        message = f"{name} has the type {offered.type}; it should be {wanted}"
    else:
        message = f"{name} is served with {offered.type}, and called with {asked.type}"
    at = asked.location if offered.type == wanted else offered.location
    return failed(message, at, cause="type")


def _fail_way(launched: Launched, start: str, end: str, reached: Sequence[int]) -> Outcome:
    """Return that messages of a topic reach some nodes, and none of them publishes another one."""
    nodes = launched.graph.graph.nodes
    if not reached:
        read = launched.graph.ends(_READS, start)
        if not read:
            return fail_absent(launched, _READS, "subscribes to", start)
        message = f"what subscribes to {start} does not connect to what publishes it"
        faulty = launched.graph.faulty_connections()
        detail = next((f": {each.fault}" for each in faulty if each.name == start), "")
        return failed(message, read[0].end.location, detail=detail, cause="type")
    for connection in launched.graph.faulty_connections():
        if connection.from_node in reached:
            message = f"messages of {start} do not find a way to {end}"
            detail = f": {connection.name} does not connect, {connection.fault}"
            return failed(message, connection.to_end.location, detail=detail, cause="type")
    publishing = launched.graph.ends(_SENDS, end)
    if not publishing:
        return fail_absent(launched, _SENDS, "publishes", end)
    labels = [nodes[number].label for number in reached]
    message = f"messages of {start} do not find a way to {end}"
    names = enumerated([placed.node.label for placed in publishing], MAX_NAMED)
    detail = f": they reach {enumerated(labels, MAX_NAMED)}, and {names} publishes {end}"
    return failed(message, publishing[0].end.location, detail=detail, cause="way")


def _chain(
    transforms: "Iterable[GraphTransform]", parent: str, child: str
) -> "list[GraphTransform] | None":
    """Return the shortest row of transforms from a frame up to another one; None without."""
    above: dict[str, list[GraphTransform]] = {}
    for transform in transforms:
        if transform.parent and transform.child:
            above.setdefault(transform.child, []).append(transform)
    chains: dict[str, list[GraphTransform]] = {child: []}
    waiting = [child]
    for frame in waiting:  # grows
        for transform in above.get(frame, ()):
            chain = [*chains[frame], transform]
            if transform.parent == parent:
                return chain
            if transform.parent not in chains:
                chains[transform.parent] = chain
                waiting.append(transform.parent)
    return None


def _fail_transform(transforms: "Sequence[GraphTransform]", parent: str, child: str) -> Outcome:
    """Return that a frame is not published below another one, and where it is instead."""
    message = f"nothing publishes {child} below {parent}"
    if _chain(transforms, child, parent):
        reversed_ = next(each for each in transforms if each.child == parent)
        detail = f": {reversed_.by} publishes {parent} below {child}"
        return failed(message, reversed_.location, detail=detail, cause="reversed")
    for transform in transforms:
        if transform.child == child:
            detail = f": {transform.by} publishes it below {transform.parent}"
            return failed(message, transform.location, detail=detail, cause="parent")
    meant = closest(child, [transform.child for transform in transforms])
    for transform in transforms:
        if transform.child == meant:
            detail = f"; there is {quoted(meant)}"
            return failed(message, transform.location, detail=detail, cause="frame")
    return failed(message, cause="frame")
