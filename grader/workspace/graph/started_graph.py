"""Make the graph of one launch file of a workspace."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from grader.base.errors import NotDecided
from grader.base.source import Location
from grader.ros.known.end_rows import (
    IncludedNode,
    OnlyMore,
    launch_file_is_known,
    nodes_of_launch_file,
    opened_ends,
)
from grader.ros.known.package_rows import controller_row, package_row, program_row
from grader.ros.known.parameter_rows import row_for
from grader.ros.known.releases import Release
from grader.ros.launch.launch_model import GivenParameters, Launch, PassedArguments, StartedNode
from grader.ros.launch.node_parameters import NodeParameters, list_controllers
from grader.ros.nodes.node_facts import NodeFacts
from grader.ros.package.package import Package
from grader.ros.python.values import Unknown
from grader.workspace.graph.bridge_rows import BRIDGE, are_rows_known, rows_of_bridge
from grader.workspace.graph.code_ends import opened_by_code
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
from grader.workspace.model.launches import CONTROL_NODE, MANAGER, SPAWNERS
from grader.workspace.model.workspace import Workspace

_RVIZ, _IMAGE_BRIDGE = "rviz2", "image_bridge"
_AT_RUN_TIME = "whether it is started is known only at run time"
_HIDDEN = frozenset({"/rosout", "/parameter_events", "/tf", "/tf_static"})
_GAZEBO_CLASSIC, _SPAWN = ("gazebo", "gzserver"), "gazebo_ros/spawn_entity.py"
_TOO_MUCH = "reading it takes more work than one workspace may use"


class _Making(NamedTuple):
    """What the parts of the graph of a launch file are made from."""

    workspace: Workspace
    number: int  # of the launch file
    package: Package  # of the launch file
    launch: Launch
    release: Release


def started_graph(workspace: Workspace, number: int) -> LaunchGraph:
    """Return what runs after a launch file is launched, by its number among the roots."""
    package, launch = workspace.launches.roots[number]
    making = _Making(workspace, number, package, launch, last_release(workspace))
    nodes: list[GraphNode] = []
    processes: list[EndedProcess] = []
    not_started: list[EndedProcess] = []
    for process_number, node in enumerate(launch.nodes):
        process = EndedProcess(node.name, node.location, _find_doubt(node))
        if node.when is False:
            not_started.append(process)
        elif _is_process(node):
            processes.append(process)
        else:
            for graph_node in _nodes_of_program(making, node):
                nodes.append(graph_node._replace(process=process_number))
    nodes += _components(making)
    nodes += _controllers(making)
    nodes += _included_programs(making, processes)
    nodes += _plugins(making, [*nodes], processes)
    processes += [EndedProcess(command, _start(launch)) for command in launch.commands]
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


def included_files(launch: Launch) -> int:
    """Return how many launch files a launch file includes, directly or not."""
    return len({passed.path for passed in launch.passed})


def _start(launch: Launch) -> Location:
    return Location(launch.source.path, 1, 1)


def _find_doubt(node: StartedNode) -> str:
    return _AT_RUN_TIME if node.when is None else ""


def _is_process(node: StartedNode) -> bool:
    """Return whether a program is no node, or ends when it has done its work."""
    row = opened_ends(node.package, node.executable)
    if node.executable in SPAWNERS or (row is not None and row.is_process):
        return True
    return program_row(node.package, node.executable).ends_unless is not None


def _nodes_of_program(making: _Making, node: StartedNode) -> Iterator[GraphNode]:
    """Yield the nodes of a program: those of own code, each, or that of a known one."""
    workspace = making.workspace
    if workspace.find_package(node) is None:
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
    ends: list[GraphEnd] = []
    parameters: list[GivenValue] = []
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
        row = opened_ends(node.package, node.executable)
        if opens_more and row is not None:  # a well-known program whose sources are here
            named = node._replace(node_name=name)
            ends += ends_of_row(row, named, given, making.release)
        defaults = {each.name: each.default for each in facts.parameters if each.is_declared}
        parameters += _different(given, defaults)
    except NotDecided:
        opens_more = _TOO_MUCH
    made = _graph_node(node, name, kind, inside)
    shown, different = _shown(ends), tuple(parameters)
    return made._replace(ends=shown, opens_more=opens_more, parameters=different)


def _doubt_of_code(workspace: Workspace, node: StartedNode, facts: NodeFacts) -> str:
    """Return why a node may open more than its facts say: a doubt of it, or of its file."""
    if facts.doubts:
        return facts.doubts[0].reason
    code = workspace.code.by_package.get(node.package)
    for doubt in code.doubts if code is not None else ():
        if doubt.location.path == facts.location.path:
            return doubt.reason
    return ""


def _graph_node(node: StartedNode, name: str | None, kind: GraphNodeKind, inside: str) -> GraphNode:
    """Return a started node under a name, without what it opens."""
    full, at = _full_name(node, name), node.location
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
    values: list[GivenValue] = []
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
    row = opened_ends(node.package, node.executable)
    for name in row.holds if row is not None else ():
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
    row = opened_ends(node.package, node.executable)
    of_program = program_row(node.package, node.executable)
    name = node.node_name
    if name == "":
        name = (row.name if row is not None else "") or of_program.name
    named = node._replace(node_name=name)
    ends: list[GraphEnd] = []
    parameters: list[GivenValue] = []
    opens_more = f"what {node.name} opens is not known"
    only: OnlyMore = ""
    if row is not None:
        opens_more, only = row.opens_more, row.opens_only
    if node.package == BRIDGE and not are_rows_known(making.workspace, node):
        opens_more = "which topics it bridges is not known"
    try:
        given = making.workspace.parameters.read(making.package, given_to or node, name or "")
        if row is not None:
            ends += ends_of_row(row, named, given, making.release)
        if node.executable == _RVIZ:
            ends = _ends_of_rviz(making, named) or ends
        ends += _ends_for_rules(making, named)
        defaults: dict[str | None, object] = {}
        for parameter in given.values:
            parameter_row = row_for(node.name, parameter, making.release)
            if parameter_row is not None:
                defaults[parameter] = parameter_row.default
        parameters += _different(given, defaults)
        if node.executable == _IMAGE_BRIDGE:
            ends += _bridged_images(named)
    except NotDecided:
        opens_more, only = _TOO_MUCH, ""
    made = _graph_node(node, name, kind, inside)._replace(opens_more=opens_more, opens_only=only)
    return made._replace(ends=_shown(ends), parameters=tuple(parameters))


def _ends_for_rules(making: _Making, node: StartedNode) -> Iterator[GraphEnd]:
    """Yield the ends of a program that rules know as well, and those of bridges."""
    notes: dict[tuple[str, str], str] = {}
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


def _components(making: _Making) -> Iterator[GraphNode]:
    """Yield the containers of a launch file, and the components that it loads."""
    launch = making.launch
    places = {node.location for node in launch.nodes}
    for container in launch.containers:
        if container.when is not False and container.location not in places:
            doubt = "" if container.when else _AT_RUN_TIME
            name, at = container.name or "", container.location
            yield GraphNode(name, "a container", "container", at, (), doubt)
    by_place = {container.location: container.name or "" for container in launch.containers}
    for component in launch.components:
        node = component.node
        if component.when is False:
            continue
        inside = component.container or by_place.get(component.loaded_at, "")
        if node is None:
            at, doubt = component.location, "" if component.when else _AT_RUN_TIME
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
    workspace, launch = making.workspace, making.launch
    try:
        spawned = spawned_controllers(workspace, making.number)
        defined = {each.name: each for each in reversed(defined_controllers(workspace))}
        owners = workspace.parameters.owners
    except NotDecided:
        return
    managers = [node for node in launch.nodes if node.executable == CONTROL_NODE and node.when]
    named = _spawned_nodes(launch)
    if named and not managers:
        name, at = _full_name(named[0][1], MANAGER), named[0][0].location
        yield GraphNode(name, "the controller manager", "program", at)
    for spawner, started in named:
        name = started.node_name or ""
        manager = managers[0] if managers else started._replace(remaps=())
        remaps = None
        if manager.remaps is not None:
            remaps = (*spawned.get(name, ()), *manager.remaps)
        node, gifts = started._replace(remaps=remaps), owners.get(name, [])
        given = NodeParameters({}, node)
        if gifts:
            given = NodeParameters(gifts[0].values, node, gifts[0].unknown)
        inside = _full_name(started, MANAGER)
        yield _controller(making, given, defined.get(name), spawner, inside)


def _spawned_nodes(launch: Launch) -> list[tuple[StartedNode, StartedNode]]:
    """Return the controllers that spawners start, each behind its spawner."""
    named = []
    for node in launch.nodes:
        if node.executable in SPAWNERS and node.when is not False:
            named += [(node, started) for started in list_controllers(node) or ()]
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
    name, doubt = _full_name(node, node.node_name), _find_doubt(spawner)
    if controller is None:
        reason = "no file defines it"
        at = spawner.location
        return GraphNode(name, "a controller", "controller", at, (), doubt, reason, (), inside)
    kind = controller.type.text or ""
    package, _, cls = kind.partition("/")
    row = opened_ends(controller_row(kind).package or package, cls)
    ends: Sequence[GraphEnd] = ()
    opens_more = f"what {kind} opens is not known"
    only: OnlyMore = ""
    if row is not None:
        located = node._replace(location=controller.location)
        ends = _shown([*ends_of_row(row, located, given, making.release)])
        opens_more, only = row.opens_more, row.opens_only
    at, shown = controller.location, tuple(ends)
    return GraphNode(name, kind, "controller", at, shown, doubt, opens_more, (), inside, only)


def _included_programs(making: _Making, processes: list[EndedProcess]) -> Iterator[GraphNode]:
    """Yield the nodes of included launch files of other packages, and add their processes."""
    for passed in making.launch.passed:
        package, file = _included_file(passed)
        if passed.when is False or making.package.find(package) is not None:
            continue
        for included in nodes_of_launch_file(package, file, making.release):
            owner, _, executable = included.node.partition("/")
            node = StartedNode(
                owner,
                executable,
                None if passed.when is None else True,
                passed.location,
                remaps=_remappings_passed(passed, included),
                node_name=included.name,
                parameters=_parameters_passed(passed, included.parameters),
            )
            if _is_process(node):
                processes.append(EndedProcess(included.node, node.location, _find_doubt(node)))
            else:
                yield from _known_nodes(making, node, "program")


def _remappings_passed(
    passed: PassedArguments, included: IncludedNode
) -> tuple[tuple[str, str], ...] | None:
    """Return the remappings of a node; None if an include passes a name that is not known."""
    values = dict(passed.values)
    remaps: list[tuple[str, str]] = []
    for name, default in included.remappings.items():
        to = values.get(included.arguments.get(name, ""), default)
        if to is None:
            return None
        remaps.append((name, to))
    return tuple(remaps)


def _parameters_passed(
    passed: PassedArguments, arguments: Sequence[str]
) -> tuple[GivenParameters, ...] | None:
    """Return the parameter files that an include passes; None if not all are known."""
    values = dict(passed.values)
    paths = [values.get(name) for name in arguments]
    known = [path for path in paths if path]
    if not known or len(known) < len(paths):
        return None
    return tuple(GivenParameters(passed.location, path) for path in known)


def _plugins(
    making: _Making, nodes: Sequence[GraphNode], processes: Sequence[EndedProcess]
) -> Iterator[GraphNode]:
    """Yield the nodes of plug-ins where Gazebo Classic is started."""
    programs = {node.program for node in nodes}
    commands = {command.split()[0] for command in making.launch.commands if command.strip()}
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
    if launch.syntax is not None:
        yield Unread(launch.syntax.message, launch.syntax.location)
    elif launch.unread:
        yield Unread(launch.unread, _start(launch))
    places = {container.location for container in launch.containers}
    places.update(component.loaded_at for component in launch.components)
    for unknown in dict.fromkeys(launch.unknown):
        if unknown.location not in places:
            yield Unread(unknown.message, unknown.location)
    yield from unread_includes(making.workspace, launch)


def unread_includes(workspace: Workspace, launch: Launch) -> Iterator[Unread]:
    """Yield the included launch files of known packages of which it is not known what they open."""
    own_packages = {package.name for package in workspace.packages}
    for passed in launch.passed:
        package, file = _included_file(passed)
        is_known = launch_file_is_known(package, file) or file not in package_row(package).launch
        if passed.when is not False and not is_known and package not in own_packages:
            reason = f"what {file} of {package} starts is not known"
            yield Unread(reason, passed.location)


def _included_file(passed: PassedArguments) -> tuple[str, str]:
    """Return the package and the name of an included launch file."""
    package, _, file = passed.path.rpartition("share/")[2].partition("/launch/")
    return package, file
