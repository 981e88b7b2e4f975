"""Topics whose publishers and subscriptions never meet: of other types, or of other names.

Only where all of the code is read, as another program may be the partner that is missed.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from grader.base.names import closest
from grader.base.source import Location
from grader.ros.known.package_tables import transport_types
from grader.ros.known.shared_names import shared_names
from grader.ros.nodes.node_facts import Endpoint
from grader.workspace.graph.code_ends import END_SOURCES, End
from grader.workspace.graph.graph import Graph, make_graph
from grader.workspace.graph.unread_ends import Sought, is_all_read, may_be_opened
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.meeting_ends import TOPICS
from grader.workspace.rules.names import Fact, Mismatch, warning
from grader.workspace.rules.rule_table import (
    NO_COMPANION,
    Rule,
)

_OF_ENDPOINT = 2  # parts of an endpoint that is compared


class _Opened(NamedTuple):
    """A topic that a program opens which no launch file starts, or another node."""

    program: str  # empty for a node that is started, or of no program
    package: str
    endpoint: Endpoint


def unmet_topic_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the topics that connect nothing."""
    yield from _of_unstarted(workspace)
    yield from _of_one_launch(make_graph(workspace))


# --- Programs that no launch file starts
# ----------------------------------------------------------------------


_UNSTARTED_TYPE = Rule(
    "unstarted-type",
    "wiring",
    NO_COMPANION,
    NO_COMPANION,
    "Two programs of a package that share a topic have one type for it.",
    why=(
        "The middleware matches only ends with equal types. Once both programs run, the "
        "subscription receives nothing, and no error tells why."
    ),
    wrong="self.create_subscription(Twist, 'distance', self.receive, 10)",
    right="self.create_subscription(Float64, 'distance', self.receive, 10)",
    frame="start/pilot.py",
    beside={
        "meter.py": "",
        "rover.launch.py": "",
    },
)


def _of_unstarted(workspace: Workspace) -> Iterator[Mismatch]:
    """Yield topics that two programs of a package open with types that never agree.

    No launch file starts the programs, and no node of the workspace has a partner for either one.
    A topic of a well-known name may have one in another program.
    """
    if workspace.launches.has_more_nodes or workspace.launches.unknown_nodes:
        return
    topics = _all_topics(workspace)
    if topics is None:
        return
    for name, opened in topics.items():
        if name.rpartition("/")[2] in shared_names().topics:
            continue
        published = [each for each in opened if each.endpoint.kind == "publisher"]
        subscribed = [each for each in opened if each.endpoint.kind == "subscription"]
        sent = {each.endpoint.type for each in published}
        read = {each.endpoint.type for each in subscribed}
        if None in sent | read or sent & read:
            continue
        for each in subscribed:
            other = _of_same_package(each, published)
            if other is not None:
                at, place = each.endpoint.location, other.endpoint.location
                message = (
                    f"{each.program} subscribes to {name} with {each.endpoint.type}, and only "
                    f"{other.program} publishes it, with {other.endpoint.type} "
                    f"({place.file_and_line})"
                )
                yield warning(_UNSTARTED_TYPE, message, at, place)


def _of_same_package(one: _Opened, others: Sequence[_Opened]) -> _Opened | None:
    """Return the only publisher, if it is of another program of the package."""
    if len(others) != 1 or not one.program or not others[0].program:
        return None
    is_same = one.package == others[0].package and one.program != others[0].program
    return others[0] if is_same else None


def _all_topics(workspace: Workspace) -> "Mapping[str, Sequence[_Opened]] | None":
    """Return the topics of all code by their names; None where there may be more."""
    started = {(node.package, node.executable) for _, node in workspace.launches.nodes}
    opened: dict[str, list[_Opened]] = {}
    for package, code in workspace.code.by_package.items():
        if code.doubts:
            return None
        programs: dict[Location, str] = {}
        for program in code.programs:
            if (package, program.name) not in started and len(program.nodes) == 1:
                programs[program.nodes[0].location] = program.name
        for node in code.nodes:
            workspace.charge(1 + _OF_ENDPOINT * len(node.endpoints))
            if node.doubts:
                return None
            for endpoint in node.endpoints:
                if endpoint.kind not in ("publisher", "subscription"):
                    continue
                if endpoint.name is None or endpoint.name.startswith("~"):
                    return None
                name = f"/{endpoint.name.removeprefix('/')}"
                each = _Opened(programs.get(node.location, ""), package, endpoint)
                opened.setdefault(name, []).append(each)
    return opened


# --- Nodes that one launch file starts
# ----------------------------------------------------------------------


def _of_one_launch(graph: Graph) -> Iterator[Mismatch]:
    """Yield a subscription that nothing publishes, where the only unread topic has its type.

    One launch file certainly starts both nodes, and all that it starts is read.
    """
    subscriptions, publishers = TOPICS.ends(graph)
    published = {end.name for end in graph.of_kind("publisher", sources=END_SOURCES)}
    subscribed = {end.name for end in graph.of_kind("subscription", sources=END_SOURCES)}
    unheard = [end for end in publishers if _is_free(end, subscribed)]
    waiting = [end for end in subscriptions if _is_free(end, published)]
    for asking in waiting:
        rivals = graph.alike(asking, waiting)
        offering = graph.alike(asking, unheard)
        if len(rivals) == 1 and len(offering) == 1 and asking.type is not None:
            yield from _partners(graph.workspace, asking, offering[0])


_TOPIC_PARTNER = Rule(
    "topic-partner",
    "wiring",
    NO_COMPANION,
    NO_COMPANION,
    "A topic that a node waits for is one that another node of its launch publishes.",
    why=(
        "The callback is never called, and the messages of the other node have no reader. Both "
        "nodes run without an error."
    ),
    wrong="self.create_subscription(Float64, 'height', self.receive, 10)",
    right="self.create_subscription(Float64, 'distance', self.receive, 10)",
    frame="start/pilot.py",
    beside={
        "meter.py": "",
    },
)


def _partners(workspace: Workspace, asking: End, offering: End) -> Iterator[Mismatch]:
    """Yield that the topic of a subscription is meant to be that of a publisher."""
    if _is_of_other_rule(asking, offering):
        return
    if asking.owner != offering.owner and _is_closed(workspace, asking):
        message = (
            f"nothing publishes {asking.name}, and nothing subscribes to {offering.name}, "
            f"which has its type {asking.type} ({offering.location.file_and_line})"
        )
        yield warning(_TOPIC_PARTNER, message, asking.location, offering.location)


def _is_of_other_rule(asking: End, offering: End) -> bool:
    """Return whether another rule says what is wrong.

    The names are similar, the topic is one of compressed images, or a remapping names another one.
    """
    is_similar = closest(asking.name, [offering.name]) is not None
    is_compressed = asking.name.rpartition("/")[2] in transport_types()
    plain = asking.node._replace(remaps=()).topic(asking.endpoint.name or "")
    is_missed = bool(asking.node.remaps) and plain == asking.name
    return is_similar or is_compressed or is_missed


def _is_free(end: End, partners: "set[str]") -> bool:
    """Return whether an end of a node that certainly is started has no partner."""
    is_shared = end.name.rpartition("/")[2] in shared_names().topics
    return end.source == "code" and end.is_certain and end.name not in partners and not is_shared


def _is_closed(workspace: Workspace, end: End) -> bool:
    """Return whether nothing else may publish what an end subscribes to."""
    if not is_all_read(workspace, end.launch):
        return False
    return not may_be_opened(workspace, Sought("publisher", end.name, end.type))
