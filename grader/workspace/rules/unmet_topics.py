"""Topics whose publishers and subscriptions never meet: of other types, or of other names.

They are found only where all of the code is read, as another program may be the partner that is
missed.
"""

from collections.abc import Iterator, Mapping, Sequence

from grader.base.names import closest, first_part, is_misspelling, last_part
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.known.package_rows import package_row
from grader.ros.known.package_tables import transport_types
from grader.ros.known.shared_names import shared_names
from grader.ros.launch.launch_model import Launch
from grader.ros.nodes.node_facts import Endpoint, EndpointKind
from grader.workspace.graph.bridge_rows import BRIDGE
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.launch_graph import OPPOSITES, GraphEnd, GraphNode, LaunchGraph
from grader.workspace.graph.manual_ends import manual_ends
from grader.workspace.graph.message_ways import is_named, may_open
from grader.workspace.graph.unread_ends import Sought, may_be_opened
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Facts, Mismatch, Mismatches, warning
from grader.workspace.rules.rule_table import (
    NO_COMPANION,
    NO_TOPIC,
    Rule,
)

_OF_ENDPOINT = 2  # parts of an endpoint that is compared
_SPEEDS = "geometry_msgs/msg/Twist"
_TEXT = "std_msgs/msg/String"
_COMMANDED = (BRIDGE, "gazebo_plugins")  # what they subscribe to is for commands
_MANAGER = "controller_manager/ros2_control_node"
_PLAYS = on_use(r"\bros2\s++(?:topic|bag\s++play)\b")  # commands that may publish


class _Opened(Named):
    """A topic that a program opens which no launch file starts, or another node."""

    program: str  # empty for a node that is started, or of no program
    package: str
    endpoint: Endpoint


def unmet_topic_facts(workspace: Workspace) -> Facts:
    """Yield the topics that connect nothing."""
    yield from _of_unstarted(workspace)
    for graph, launch in zip(
        make_graph(workspace).launched, workspace.launches.outermost, strict=True
    ):
        yield from _of_one_launch(workspace, graph, launch)
        yield from _unpublished(workspace, graph, launch)


# --- Programs that no launch file starts
# ----------------------------------------------------------------------


_UNSTARTED_TYPE = Rule(
    "unstarted-type",
    "wiring",
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


def _of_unstarted(workspace: Workspace) -> Mismatches:
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
        if last_part(name) in shared_names().topics:
            continue
        published = [each for each in opened if each.endpoint.kind == "publisher"]
        subscribed = [each for each in opened if each.endpoint.kind == "subscription"]
        sent = {each.endpoint.type for each in published}
        read = {each.endpoint.type for each in subscribed}
        if None in sent | read or sent & read:
            continue
        for each in subscribed:
            other = _of_same_package(each, published)
            if other:
                at = each.endpoint.location
                place = other.endpoint.location
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
    started = workspace.launches.programs
    opened: dict[str, list[_Opened]] = {}
    for package, code in workspace.code.by_package.items():
        if code.doubts:
            return None
        programs = {}
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


class _FreeEnd(Named):
    """An end that certainly is opened, and that no other node of its launch has a partner for."""

    node: GraphNode
    end: GraphEnd
    is_own: bool  # whether code of the workspace opens it

    @property
    def plain_type(self) -> str:
        """The type without a stamp."""
        return self.end.type.removesuffix("Stamped")

    @property
    def is_usual(self) -> bool:
        """Whether programs elsewhere open it, by its usual name."""
        return last_part(self.end.name) in shared_names().topics

    @property
    def may_be_meant(self) -> bool:
        """Whether it may be one of two that mean the same topic.

        Those of other programs exist to be commanded; programs elsewhere have the usual names.
        """
        if self.plain_type == _SPEEDS:
            return True
        package = first_part(self.node.program)
        is_commanded = self.node.kind == "controller" or package in _COMMANDED
        opened = [end.name for end in self.node.ends].count(self.end.name)  # twice: both ways
        is_meant = self.is_own or (is_commanded and opened == 1)
        return is_meant and self.end.type != _TEXT and not self.is_usual


def _of_one_launch(workspace: Workspace, graph: LaunchGraph, launch: Launch) -> Mismatches:
    """Yield a subscription that nothing publishes, where the only unread topic has its type.

    One launch file certainly starts both nodes, and all that it starts is read. Own code has the
    publisher. It has the subscription too, or a controller, a bridge, a plug-in or a program that
    exists to be commanded has it.
    """
    unheard = [free for free in _free_ends(workspace, graph, "publisher") if free.is_own]
    if not unheard or _may_open_more(graph):
        return
    waiting = list(_free_ends(workspace, graph, "subscription"))
    workspace.charge(len(waiting) * (len(waiting) + len(unheard)))
    for asking in waiting:
        rivals = [free for free in waiting if free.plain_type == asking.plain_type]
        offering = [free for free in unheard if free.plain_type == asking.plain_type]
        if len(rivals) == 1 and len(offering) == 1 and asking.node is not offering[0].node:
            yield from _partners(workspace, launch, graph, asking, offering[0])


def _free_ends(workspace: Workspace, graph: LaunchGraph, kind: EndpointKind) -> Iterator[_FreeEnd]:
    """Yield the ends of a kind that certainly are opened and have no partner in the launch."""
    own_packages = workspace.own_packages
    partners = []
    for node in graph.nodes:
        partners += [(node, end.name) for end in node.ends if end.kind == OPPOSITES[kind]]
    for node in graph.nodes:
        is_own = node.kind != "controller" and first_part(node.program) in own_packages
        for end in node.ends:
            free = _FreeEnd(node, end, is_own)
            is_known = end.type and not (node.doubt or end.doubt)
            if end.kind == kind and is_known and free.may_be_meant:
                workspace.charge(1 + len(partners))
                others = [name for other, name in partners if other is not node]
                if not any(is_named(name, end.name) for name in others):
                    yield free


def _may_open_more(graph: LaunchGraph) -> bool:
    """Return whether a launch may have ends that are not known."""
    if graph.unread or any(_PLAYS.search(process.program) for process in graph.processes):
        return True
    for node in graph.nodes:
        without = package_row(first_part(node.program)).without
        if may_open(node, ("publisher", "subscription")) and "commands" not in without:
            return True
    return False


_TOPIC_PARTNER = Rule(
    "topic-partner",
    "wiring",
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
    at="rover/meter.py",
)


def _partners(
    workspace: Workspace,
    launch: Launch,
    graph: LaunchGraph,
    asking: _FreeEnd,
    offering: _FreeEnd,
) -> Mismatches:
    """Yield that the topic of a subscription is meant to be that of a publisher.

    Another launch file, or a person, may join either one with others.
    """
    asked = asking.end
    offered = offering.end
    if _is_of_other_rule(launch, graph, asking, offering):
        return
    is_similar = is_misspelling(asked.name, offered.name)
    is_similar = is_similar or last_part(asked.name) == last_part(offered.name)
    joined = make_graph(workspace)
    is_fed = asked.name in joined.names_opened("publisher") and not is_similar
    if is_fed or offered.name in joined.names_opened("subscription") | joined.names_read:
        return
    sought = Sought("publisher", asked.name, asked.type.replace("/", "."))
    if asking.is_own and may_be_opened(workspace, sought):
        return
    is_of_person = bool(manual_ends([asked])) or not (
        asking.is_own or asked.type.startswith("geometry_msgs/")
    )
    if is_similar or not is_of_person:
        one = "one name" if asked.type == offered.type else "one name and one type"
        message = (
            f"nothing subscribes to {offered.name}, and nothing publishes {asked.name}, on which "
            f"{asking.node.label} waits for {asked.type} ({asked.location.file_and_line}): give "
            f"both {one}"
        )
        yield warning(_TOPIC_PARTNER, message, offered.location, asked.location)


def _is_of_other_rule(
    launch: Launch, graph: LaunchGraph, asking: _FreeEnd, offering: _FreeEnd
) -> bool:
    """Return whether another rule says what is wrong with two ends, or their types differ.

    Their names are similar, a controller of own code waits for the type, the topic is one of
    compressed images, or a remapping that should join the two names another topic.
    """
    asked = asking.end
    is_of_type = asked.type == offering.end.type
    if asking.is_own:
        is_compressed = last_part(asked.name) in transport_types()
        is_similar = closest(asked.name, [offering.end.name]) is not None
        is_said = is_compressed or (is_similar and not asking.is_usual) or not is_of_type
    else:
        has_manager = any(node.program == _MANAGER for node in graph.nodes)
        is_said = asking.node.kind == "controller" and is_of_type and has_manager
    return is_said or _is_remapped(launch, asking, offering)


def _is_remapped(launch: Launch, asking: _FreeEnd, offering: _FreeEnd) -> bool:
    """Return whether a remapping of a node of two ends is about the name that is asked for."""
    name = asking.end.name
    for node in launch.nodes:
        names = [node.full_name(rule[1]) for rule in node.remaps or ()]
        if node.location == offering.node.location and name in names:
            return True
        is_asking = node.location == asking.node.location and asking.is_own
        if is_asking and names and name not in names:
            return True
    return False


_TOPIC_RECORDED = Rule(
    "topic-recorded",
    "topics",
    NO_TOPIC,
    "A topic that a launch file records is one that a node of it publishes.",
    why="The recording has no messages of the topic: ros2 bag record waits for it for ever.",
    wrong="""
Node(package='rover', executable='meter'),
ExecuteProcess(cmd=['ros2', 'bag', 'record', '/distanc']),
""",
    right="""
Node(package='rover', executable='meter'),
ExecuteProcess(cmd=['ros2', 'bag', 'record', '/distance']),
""",
    beside={
        "meter.py": "",
    },
)


def _unpublished(workspace: Workspace, graph: LaunchGraph, launch: Launch) -> Mismatches:
    """Yield the recorded topics that no node publishes, where one publishes a similar one."""
    names = [(name, each) for each in launch.commands for name in each.recorded_topics]
    if not names or graph.not_started or _may_open_more(graph):
        return
    published = _list_published(graph)
    elsewhere = make_graph(workspace).names_opened("publisher")
    for name, command in names:
        meant = closest(name, published) if name not in elsewhere else None
        if meant is not None:
            place = published[meant].file_and_line
            message = f"nothing publishes {name}; did you mean {meant} ({place})?"
            wrong = Mismatch(_TOPIC_RECORDED, message, command.location, published[meant])
            yield wrong.correcting(name, meant, published[meant])


def _list_published(graph: LaunchGraph) -> Mapping[str, Location]:
    """Return the topics that nodes publish, and where."""
    ends = [end for node in graph.nodes for end in node.ends if end.kind == "publisher"]
    return {end.name: end.location for end in ends}
