"""The ends of topics, services and actions that nodes open as launch files start them.

The nodes are those of own code, controllers, bridges and well-known programs.
"""

from collections.abc import Iterator, Sequence

from grader.base.records import Named
from grader.ros.known.package_rows import CommandRow, ProgramRow, program_row
from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import Endpoint, EndpointKind
from grader.ros.package.package import Package
from grader.ros.python.values import Unknown
from grader.workspace.graph.bridge_rows import BRIDGE, are_rows_known, rows_of_bridge
from grader.workspace.graph.code_ends import End, opened_by
from grader.workspace.graph.started_controllers import controller_endpoints
from grader.workspace.model.workspace import Workspace

_IMAGE_BRIDGES = "ros_gz_image"  # whose topics are those of its arguments


class KnownProgram(Named):
    """A well-known program in a launch file of a package, and what is known of its topics."""

    launch: int
    package: Package
    node: StartedNode
    row: ProgramRow


def programs_in(workspace: Workspace) -> Iterator[KnownProgram]:
    """Yield the well-known programs that launch files certainly start. Raises NotDecided."""
    for launch, (package, file) in enumerate(workspace.launches.roots):
        workspace.charge(1 + len(file.nodes))
        for node in file.nodes:
            if node.when:
                row = program_row(*node.program)
                yield KnownProgram(launch, package, node, row)


def deciding_parameter(end: End) -> str | None:
    """Return the parameter of a well-known program that decides the type of an end."""
    command = program_row(*end.node.program).command
    if not command or end.node.topic(command.topic) != end.name:
        return None
    return command.parameter


def list_ends(
    workspace: Workspace, launch: int, package: Package, node: StartedNode
) -> Iterator[End]:
    """Yield the ends of a node that a launch file of a package starts. Raises NotDecided."""
    program = node.executable
    yield from opened_by(workspace, node, launch)
    for controller, endpoint in controller_endpoints(workspace, launch, node):
        yield End(endpoint.name or "", endpoint, launch, node, "controller", controller)
    for endpoint in _bridged(workspace, node):
        yield End(endpoint.name or "", endpoint, launch, node, "bridge", program)
    for kind, name, message in _topics_of_program(workspace, package, node):
        topic = node.topic(name)
        if topic is not None:
            endpoint = Endpoint(kind, message, topic, node.location)
            yield End(topic, endpoint, launch, node, "program", program)


def opened_by_bridge(workspace: Workspace, node: StartedNode) -> tuple[Sequence[End], bool] | None:
    """Return the topics of ROS that a bridge opens, and whether these are all; None for others."""
    if node.package == _IMAGE_BRIDGES:
        return (), False
    if node.package != BRIDGE:
        return None
    ends = [
        End(endpoint.name or "", endpoint, -1, node, "bridge", node.executable)
        for endpoint in _bridged(workspace, node)
    ]
    return ends, are_rows_known(workspace, node)


def _bridged(workspace: Workspace, node: StartedNode) -> Iterator[Endpoint]:
    """Yield the topics of ROS that a bridge opens."""
    if node.package != BRIDGE or node.namespace not in ("", "/"):
        return
    for row in rows_of_bridge(workspace, node):
        topic = node.topic(f"/{row.ros}")
        if topic is not None and row.is_published:
            yield Endpoint("publisher", row.ros_type, topic, row.location)
        if topic is not None and row.is_read:
            yield Endpoint("subscription", row.ros_type, topic, row.location)


def _topics_of_program(
    workspace: Workspace, package: Package, node: StartedNode
) -> Iterator[tuple[EndpointKind, str, str]]:
    """Yield kind, name and type of the topics that a well-known program opens."""
    row = program_row(*node.program)
    for name, message in row.subscriptions.items():
        yield "subscription", name, message
    for name, message in row.publishers.items():
        yield "publisher", name, message
    if row.command:
        type_of_command = _type_by_parameter(workspace, package, node, row.command)
        if type_of_command is not None:
            yield "publisher", row.command.topic, type_of_command


def _type_by_parameter(
    workspace: Workspace, package: Package, node: StartedNode, row: CommandRow
) -> str | None:
    """Return the type with which a program publishes a topic, which a parameter of it decides.

    The result is None where that is not known.
    """
    parameters = workspace.parameters.given_to(package, node)
    if parameters.unknown:
        return None
    given = parameters.values.get(row.parameter)
    if not given:
        return row.type
    if isinstance(given.value, Unknown):
        return None
    return row.other_type if given.value == row.value else row.type
