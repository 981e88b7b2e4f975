"""Make the graph of one launch file of a workspace."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import lru_cache

from grader.base.errors import NotDecided
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.known.end_rows import (
    OnlyMore,
    OpenedEnds,
    opened_ends,
)
from grader.ros.known.package_rows import controller_row, program_row
from grader.ros.known.parameter_rows import row_for
from grader.ros.known.releases import Release
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.launch.node_parameters import NodeParameters
from grader.ros.launch.started_commands import StartedCommand
from grader.ros.nodes.node_facts import NodeFacts, Qos
from grader.ros.package.package import Package
from grader.ros.python.values import Unknown
from grader.workspace.graph.bridge_rows import BRIDGE, are_rows_known, rows_of_bridge
from grader.workspace.graph.code_ends import opened_by_code
from grader.workspace.graph.included_nodes import included_nodes, unread_includes
from grader.workspace.graph.launch_graph import (
    EndedProcess,
    GivenValue,
    GraphEnd,
    GraphNode,
    GraphNodeKind,
    GraphTransform,
    LaunchGraph,
    Unread,
    has_more_connections,
)
from grader.workspace.graph.launched_transforms import transforms_in
from grader.workspace.graph.node_ends import list_ends
from grader.workspace.graph.opened_by_programs import ends_of_row, last_release, shown_type
from grader.workspace.graph.plugin_nodes import plugin_nodes
from grader.workspace.graph.rviz_ends import ends_of_displays, ends_of_tools, rviz_files
from grader.workspace.graph.started_controllers import (
    Controller,
    defined_controllers,
    spawned_controllers,
)
from grader.workspace.model.launches import CONTROL_NODE, MANAGER, SPAWNERS, list_spawned
from grader.workspace.model.workspace import Workspace

_RECORDER = "/rosbag2_recorder"
_BAG = "ros2bag/record"
_RVIZ = "rviz2"
_IMAGE_BRIDGE = "image_bridge"
_AT_RUN_TIME = "whether it is started is known only at run time"
_HIDDEN = frozenset({"/rosout", "/parameter_events", "/tf", "/tf_static"})
_GAZEBO_CLASSIC = ("gazebo", "gzserver")
_SPAWN = "gazebo_ros/spawn_entity.py"
_NO_RELEASE = "the release of ROS 2, on which it depends, is not stated"
_USUAL_RELEASES: tuple[Release, ...] = ("humble", "jazzy")
_TOO_MUCH = "reading it takes more work than one workspace may use"


class _Making(Named):
    """What the parts of the graph of a launch file are made from."""

    workspace: Workspace
    number: int  # of the launch file
    package: Package  # of the launch file
    launch: Launch
    release: Release


@lru_cache(maxsize=16)
def started_graph(workspace: Workspace, number: int) -> LaunchGraph:
    """Return what runs after a launch file is launched, by its number among the roots."""
    package, launch = workspace.launches.roots[number]
    making = _Making(workspace, number, package, launch, last_release(workspace))
    nodes = []
    processes = []
    not_started = []
    programs = [node for node in launch.nodes if not node.is_component]
    for process_number, node in enumerate(programs):
        process = EndedProcess(node.name, node.location, _find_doubt(node))
        if node.when is False:
            not_started.append(process)
        elif _is_process(node):
            processes.append(process)
        else:
            for graph_node in _nodes_of_program(making, node):
                nodes.append(graph_node._replace(process=process_number))
    nodes += _components(making, {node.location for node in programs})
    nodes += _controllers(making)
    nodes += _included_programs(making, processes)
    nodes += _plugins(making, list(nodes), processes)
    _add_commands(launch, nodes, processes)
    graph = LaunchGraph(
        launch.source.path,
        tuple(nodes),
        tuple(processes),
        tuple(not_started),
        tuple(_transforms(making)),
        tuple(_unread(making)),
        tuple(sorted(dict(reversed(launch.values)).items())),  # of an argument the first counts
    )
    if has_more_connections(graph):
        more = Unread("it has more connections, of which the first are listed", _start(launch))
        graph = graph._replace(unread=(*graph.unread, more))
    return graph


def _add_commands(launch: Launch, nodes: list[GraphNode], processes: list[EndedProcess]) -> None:
    """Add what the commands of a launch file start: recorders are nodes."""
    for command in launch.commands:
        recorder = _make_recorder(command) if command.when is not False else None
        if recorder:
            nodes.append(recorder)
        elif command.when is not False:
            doubt = _AT_RUN_TIME if command.when is None else ""
            processes.append(EndedProcess(command.text, command.location, doubt))


def _make_recorder(command: StartedCommand) -> GraphNode | None:
    """Return the node of a command that records topics; None for another command."""
    at = command.location
    doubt = _AT_RUN_TIME if command.when is None else ""
    ends = tuple(GraphEnd("subscription", name, "", at) for name in command.recorded_topics)
    return GraphNode(_RECORDER, _BAG, "program", at, ends, doubt) if ends else None


def included_files(launch: Launch) -> int:
    """Return how many launch files a launch file includes, directly or not."""
    return len({passed.path for passed in launch.passed})


def _start(launch: Launch) -> Location:
    return Location(launch.source.path, 1, 1)


def _find_doubt(node: StartedNode) -> str:
    return _AT_RUN_TIME if node.when is None else ""


def _is_process(node: StartedNode) -> bool:
    """Return whether a program is no node, or ends when it has done its work."""
    row = opened_ends(*node.program)
    if node.executable in SPAWNERS or (row and row.is_process):
        return True
    return program_row(*node.program).ends_unless is not None


def _nodes_of_program(making: _Making, node: StartedNode) -> Iterator[GraphNode]:
    """Yield the nodes of a program: those of own code, each, or that of a known one."""
    workspace = making.workspace
    if not workspace.find_package(node):
        yield from _known_nodes(making, node, "program")
        return
    own_nodes = workspace.code.find_nodes(node)
    for facts in own_nodes:
        yield _own_node(making, node, facts, "program")
    if not own_nodes:
        name = _full_name(node, node.node_name)
        reason = f"the code of {node.executable} is not read"
        doubt = _find_doubt(node)
        yield GraphNode(name, node.name, "program", node.location, (), doubt, reason)


def _full_name(node: StartedNode, name: str | None) -> str:
    """Return the name of a node with its namespace; empty where one is not known."""
    if not name or node.namespace is None:
        return ""
    return node.full_name(name)


def _own_node(
    making: _Making, node: StartedNode, facts: NodeFacts, kind: GraphNodeKind, inside: str = ""
) -> GraphNode:
    """Return a node of the workspace with what its code opens."""
    workspace = making.workspace
    name = facts.name if node.node_name == "" else node.node_name
    ends = []
    parameters = []
    opens_more = _doubt_of_code(workspace, node, facts)
    try:
        for end in opened_by_code(workspace, node, facts, making.number):
            doubt = "" if end.is_known else "a part of its name is computed"
            if end.endpoint.is_conditional:
                doubt = doubt or "a condition in the code decides whether it is opened"
            ends.append(
                GraphEnd(
                    end.kind,
                    end.name,
                    shown_type(end.type),
                    end.location,
                    end.endpoint.qos,
                    doubt,
                )
            )
        given = workspace.parameters.read(making.package, node, name or "")
        row = opened_ends(*node.program)
        if opens_more and row:  # a well-known program whose sources are here
            named = node._replace(node_name=name)
            ends += ends_of_row(row, named, given, making.release)
        ends += _clock_read(given)
        defaults = {each.name: each.default for each in facts.parameters if each.is_declared}
        parameters += _different(given, defaults)
    except NotDecided:
        opens_more = _TOO_MUCH
    made = _graph_node(node, name, kind, inside)
    shown = _shown(ends)
    different = tuple(parameters)
    return made._replace(ends=shown, opens_more=opens_more, parameters=different)


def _doubt_of_code(workspace: Workspace, node: StartedNode, facts: NodeFacts) -> str:
    """Return why a node may open more than its facts say: a doubt of it, or of its file."""
    if facts.doubts:
        return facts.doubts[0].reason
    code = workspace.code.by_package.get(node.package)
    for doubt in code.doubts if code else ():
        if doubt.location.path == facts.location.path:
            return doubt.reason
    return ""


def _graph_node(node: StartedNode, name: str | None, kind: GraphNodeKind, inside: str) -> GraphNode:
    """Return a started node under a name, without what it opens."""
    full = _full_name(node, name)
    at = node.location
    return GraphNode(full, node.name, kind, at, doubt=_find_doubt(node), inside=inside)


def _shown(ends: Sequence[GraphEnd]) -> tuple[GraphEnd, ...]:
    """Return the ends that are shown, each once."""
    first: dict[tuple[str, str], GraphEnd] = {}
    for end in ends:
        if end.name not in _HIDDEN:
            key = (end.kind, end.name) if not end.doubt else (end.kind, repr(end))
            first.setdefault(key, end)
    return tuple(first.values())


def _different(given: NodeParameters, defaults: Mapping[str | None, object]) -> list[GivenValue]:
    """Return the values that differ from the defaults, without those of files for all nodes.

    What is not declared under its name may be so under a computed one.
    """
    values = []
    for name, row in given.values.items():
        if isinstance(row.value, Unknown) or defaults.get(name, None) == row.value:
            continue
        values.append(GivenValue(name, row.value, row.location))
    return values


def _known_nodes(
    making: _Making, node: StartedNode, kind: GraphNodeKind, inside: str = ""
) -> Iterator[GraphNode]:
    """Yield the node of a program of another package, and those that it holds in its process.

    These are called as their own namespace: local_costmap/local_costmap.
    """
    outer = _known_node(making, node, kind, inside)
    yield outer
    row = opened_ends(*node.program)
    for name in row.holds if row else ():
        held = node._replace(executable=name, node_name=name)
        full = "" if node.namespace is None else node.full_name(f"{name}/{name}")
        space = f"{(node.namespace or '').rstrip('/')}/{name}"
        given_to = held._replace(namespace=space)
        inner = _known_node(making, held, "program", outer.label, given_to)
        yield inner._replace(name=full)


def _known_node(
    making: _Making,
    node: StartedNode,
    kind: GraphNodeKind,
    inside: str = "",
    given_to: StartedNode | None = None,
) -> GraphNode:
    """Return a node of a program, or of a component, of another package.

    `given_to` is what has its parameters, if that is in another namespace.
    """
    row = opened_ends(*node.program)
    name = node.node_name
    if name == "":
        in_program = making.workspace.code.name_in_program(node)
        name = (row.name if row else "") or in_program
    named = node._replace(node_name=name)
    ends: list[GraphEnd] = []
    parameters = []
    opens_more = f"what {node.name} opens is not known"
    only: OnlyMore = ""
    if row:
        opens_more = row.opens_more
        only = row.opens_only
    if node.package == BRIDGE and not are_rows_known(making.workspace, node):
        opens_more = "which topics it bridges is not known"
    try:
        given = making.workspace.parameters.read(making.package, given_to or node, name or "")
        if row:
            ends += ends_of_row(row, named, given, making.release)
        if node.executable == _RVIZ:
            ends = _ends_of_rviz(making, named) or ends
        ends += _ends_for_rules(making, named)
        ends += _clock_read(given)
        defaults: dict[str | None, object] = {}
        for parameter in given.values:
            parameter_row = row_for(node.name, parameter, making.release)
            if parameter_row:
                defaults[parameter] = parameter_row.default
        parameters += _different(given, defaults)
        if node.executable == _IMAGE_BRIDGE:
            ends += _bridged_images(named)
    except NotDecided:
        opens_more = _TOO_MUCH
        only = ""
    made = _graph_node(node, name, kind, inside)._replace(opens_more=opens_more, opens_only=only)
    return made._replace(ends=_shown(ends), parameters=tuple(parameters))


def _clock_read(given: NodeParameters) -> Iterator[GraphEnd]:
    """Yield the clock that a node subscribes to which uses simulated time: time_source.cpp."""
    used = given.values.get("use_sim_time")
    if used and used.value is True:
        qos = Qos(1, "best_effort", "volatile")
        yield GraphEnd("subscription", "/clock", "rosgraph_msgs/msg/Clock", used.location, qos)


def _ends_for_rules(making: _Making, node: StartedNode) -> Iterator[GraphEnd]:
    """Yield the ends of a program that rules know as well, and those of bridges."""
    notes = {}
    if node.package == BRIDGE:
        for row in rows_of_bridge(making.workspace, node):
            for kind in ("publisher", "subscription"):
                notes[kind, f"/{row.ros}"] = f"{row.gz} of Gazebo ({row.gz_type})"
    for end in list_ends(making.workspace, making.number, making.package, node):
        if end.source in ("program", "bridge"):
            note = notes.get((end.kind, end.name), "")
            yield GraphEnd(
                end.kind, end.name, shown_type(end.type), end.location, end.endpoint.qos, note=note
            )


def _ends_of_rviz(making: _Making, node: StartedNode) -> list[GraphEnd]:
    """Return what displays read and tools publish; nothing if no file of RViz is known."""
    ends: list[GraphEnd] = []
    for file in rviz_files(making.workspace, making.launch):
        ends += ends_of_displays(file, node)
        ends += ends_of_tools(file, node)
    return ends


def _bridged_images(node: StartedNode) -> Iterator[GraphEnd]:
    """Yield the images that the arguments of a bridge of images name."""
    for word in node.arguments or ():
        topic = node.topic(f"/{word.strip('/')}") if word and not word.startswith("-") else None
        if topic is not None:
            note = f"{(word or '').strip('/')} of Gazebo"
            yield GraphEnd("publisher", topic, "sensor_msgs/msg/Image", node.location, note=note)


def _components(making: _Making, programs: Collection[Location]) -> Iterator[GraphNode]:
    """Yield the containers of a launch file that are no programs, and the components it loads."""
    launch = making.launch
    for container in launch.containers:
        if container.when is not False and container.location not in programs:
            doubt = "" if container.when else _AT_RUN_TIME
            name = container.name or ""
            at = container.location
            yield GraphNode(name, "a container", "container", at, (), doubt)
    by_place = {container.location: container.name or "" for container in launch.containers}
    for component in launch.components:
        node = component.node
        if component.when is False:
            continue
        inside = component.container or by_place.get(component.loaded_at, "")
        if not node:
            at = component.location
            doubt = "" if component.when else _AT_RUN_TIME
            reason = "which class is loaded is not evaluated"
            yield GraphNode("", "a component", "component", at, (), doubt, reason, (), inside)
            continue
        own_nodes = making.workspace.code.find_nodes(node)
        if own_nodes:
            yield _own_node(making, node, own_nodes[0], "component", inside)
        else:
            yield from _known_nodes(making, node, "component", inside)


def _controllers(making: _Making) -> Iterator[GraphNode]:
    """Yield the controllers that a launch file spawns, in the process of their manager.

    Where no program of the launch is the manager, the one in Gazebo is meant.
    """
    workspace = making.workspace
    launch = making.launch
    try:
        spawned = spawned_controllers(workspace, making.number)
        defined = {each.name: each for each in reversed(defined_controllers(workspace))}
        owners = workspace.parameters.owners
    except NotDecided:
        return
    managers = [node for node in launch.nodes if node.executable == CONTROL_NODE and node.when]
    named = _spawned_nodes(launch)
    if named and not managers:
        name = _full_name(named[0][1], MANAGER)
        at = named[0][0].location
        yield GraphNode(name, "the controller manager", "program", at)
    for spawner, started in named:
        name = started.node_name or ""
        manager = managers[0] if managers else started._replace(remaps=())
        remaps = None
        if manager.remaps is not None:
            remaps = spawned.get(name, ()) + manager.remaps
        node = started._replace(remaps=remaps)
        gifts = owners.get(name, [])
        given = NodeParameters({}, node)
        if gifts:
            given = NodeParameters(gifts[0].values, node, gifts[0].unknown)
        inside = _full_name(started, MANAGER)
        yield _controller(making, given, defined.get(name), spawner, inside)


def _spawned_nodes(launch: Launch) -> list[tuple[StartedNode, StartedNode]]:
    """Return the controllers that spawners start, each behind its spawner."""
    named = []
    for node in launch.nodes:
        if node.when is not False:
            named += [(node, started) for started in list_spawned(node)]
    return named


def _controller(
    making: _Making,
    given: NodeParameters,
    controller: Controller | None,
    spawner: StartedNode,
    inside: str,
) -> GraphNode:
    """Return a controller as a node."""
    node = given.node
    name = _full_name(node, node.node_name)
    doubt = _find_doubt(spawner)
    if not controller:
        reason = "no file defines it"
        at = spawner.location
        return GraphNode(name, "a controller", "controller", at, (), doubt, reason, (), inside)
    kind = controller.type.text or ""
    package, _, cls = kind.partition("/")
    row = opened_ends(controller_row(kind).package or package, cls)
    ends: Sequence[GraphEnd] = ()
    opens_more = f"what {kind} opens is not known"
    only: OnlyMore = ""
    if row:
        located = node._replace(location=controller.location)
        ends = _shown(list(_ends_of_controller(making, row, located, given)))
        opens_more = row.opens_more
        only = row.opens_only
    at = controller.location
    shown = tuple(ends)
    return GraphNode(name, kind, "controller", at, shown, doubt, opens_more, (), inside, only)


def _ends_of_controller(
    making: _Making, row: OpenedEnds, node: StartedNode, given: NodeParameters
) -> Iterator[GraphEnd]:
    """Yield what a controller opens; if no release is stated, what depends on it is not certain."""
    others = []
    for release in () if making.workspace.releases else _USUAL_RELEASES:
        others.append({*ends_of_row(row, node, given, release)})
    for end in ends_of_row(row, node, given, making.release):
        is_certain = all(end in ends for ends in others)
        yield end if is_certain else end._replace(doubt=end.doubt or _NO_RELEASE)


def _included_programs(making: _Making, processes: list[EndedProcess]) -> Iterator[GraphNode]:
    """Yield the nodes of included launch files of other packages, and add their processes."""
    for node in included_nodes(making.workspace, making.package, making.launch):
        if _is_process(node):
            processes.append(EndedProcess(node.name, node.location, _find_doubt(node)))
        else:
            yield from _known_nodes(making, node, "program")


def _plugins(
    making: _Making, nodes: Sequence[GraphNode], processes: Sequence[EndedProcess]
) -> Iterator[GraphNode]:
    """Yield the nodes of plug-ins where Gazebo Classic is started."""
    programs = {node.program for node in nodes}
    commands = {command.split()[0] for command in making.launch.command_texts if command.strip()}
    if "gazebo_ros/gazebo" in programs or not commands.isdisjoint(_GAZEBO_CLASSIC):
        is_spawned = any(process.program == _SPAWN for process in processes)
        yield from plugin_nodes(making.workspace, making.release, is_spawned=is_spawned)


def _transforms(making: _Making) -> Iterator[GraphTransform]:
    """Yield the transforms whose frames are known, each once."""
    first: dict[tuple[str, str, str], GraphTransform] = {}
    try:
        for transform in transforms_in(making.workspace, making.number):
            if transform.parent and transform.child and transform.parent != transform.child:
                key = (transform.parent, transform.child, transform.by)
                first.setdefault(key, transform)
    except NotDecided:
        return
    yield from first.values()


def _unread(making: _Making) -> Iterator[Unread]:
    """Yield what may start more, without what the graph has of components and included files."""
    launch = making.launch
    if launch.syntax:
        yield Unread(launch.syntax.message, launch.syntax.location)
    elif launch.unread:
        yield Unread(launch.unread, _start(launch))
    drawn = {component.loaded_at for component in launch.components}
    for unknown in dict.fromkeys(launch.unknown):
        if unknown.location not in drawn:
            yield Unread(unknown.message, unknown.location)
    yield from unread_includes(making.workspace, launch)
