"""Services and actions of own nodes as they are started: clients and servers have to agree in name
and type.
"""

from collections.abc import Iterable, Iterator
from fnmatch import fnmatchcase
from typing import NamedTuple

from grader.base.names import closest
from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.package.node_facts import Endpoint, EndpointKind
from grader.ros.workspace.graph.endpoints import ANY, OpenedName, opened_by
from grader.ros.workspace.graph.publishers import is_own_type
from grader.ros.workspace.interfaces import is_absent
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.names import (
    Compared,
    Fact,
    Mismatch,
    corrections,
)

_SERVERS: dict[EndpointKind, EndpointKind] = {
    "client": "service",
    "action client": "action server",
}
_NOUNS: dict[EndpointKind, str] = {"client": "service", "action client": "action"}


class _Opened(NamedTuple):
    """A client or server of a node as it is started."""

    name: str
    endpoint: Endpoint
    launch: int
    node: StartedNode


def service_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield clients of own nodes that have another type than the server of their name, or a name
    that no server has.
    """
    opened: list[_Opened] = []
    unknown: list[OpenedName] = []
    for launch, node in workspace.launched:
        for found in opened_by(workspace, node) if node.when is not False else ():
            if found.is_known:
                opened.append(_Opened(found.name or "", found.endpoint, launch, node))
            else:
                unknown.append(found)
    for kind, server_kind in _SERVERS.items():
        clients = _distinct(it for it in opened if it.endpoint.kind == kind)
        servers = _distinct(it for it in opened if it.endpoint.kind == server_kind)
        patterns = [it.name or ANY for it in unknown if it.endpoint.kind == server_kind]
        yield from _compared(workspace, clients, servers, patterns)


def _distinct(opened: Iterable[_Opened]) -> list[_Opened]:
    found: dict[object, _Opened] = {}
    for each in opened:
        found.setdefault((each.name, each.endpoint, each.launch, each.node.when), each)
    return list(found.values())


def _compared(
    workspace: Workspace,
    clients: Iterable[_Opened],
    servers: list[_Opened],
    patterns: list[str],
) -> Iterator[Fact]:
    by_name: dict[str, list[_Opened]] = {}
    for server in servers:
        by_name.setdefault(server.name, []).append(server)
    clients = list(clients)
    called = {client.name for client in clients}
    for client in clients:
        if client.name in by_name:
            yield Compared("services")
        for server in by_name.get(client.name, ()):
            types = (client.endpoint.type, server.endpoint.type)
            if not any(is_absent(workspace, kind) for kind in types if kind is not None):
                yield from _other_type(client, server)
        if client.name in by_name or any(fnmatchcase(client.name, it) for it in patterns):
            continue
        workspace.charge(1 + len(servers))
        unused = [it for it in servers if it.name not in called and it.launch == client.launch]
        alike = [it for it in unused if it.endpoint.type == client.endpoint.type is not None]
        yield from _without_server(workspace, client, alike)


def _other_type(client: _Opened, server: _Opened) -> Iterator[Mismatch]:
    wanted, offered = client.endpoint.type, server.endpoint.type
    if wanted is None or offered is None or wanted == offered:
        return
    at, noun = server.endpoint.location, _NOUNS[client.endpoint.kind]
    is_certain = client.node.when is True and server.node.when is True
    is_certain = is_certain and client.launch == server.launch
    message = (
        f"the {noun} {client.name} is called with {wanted}, but served with {offered} "
        f"({at.file_and_line})"
    )
    yield Mismatch("services", message, client.endpoint.location, at, is_certain, is_of_type=True)


def _without_server(
    workspace: Workspace, client: _Opened, alike: list[_Opened]
) -> Iterator[Mismatch]:
    """Yield that nothing serves what a client calls, where a server of its type waits under one
    other name.
    """
    names = {it.name for it in alike}
    if len(names) != 1 or _may_be_served(workspace, client):
        return
    [name] = names
    if not is_own_type(workspace, client.endpoint.type) and closest(client.name, names) is None:
        return
    server = alike[0]
    at, noun = server.endpoint.location, _NOUNS[client.endpoint.kind]
    is_certain = client.node.when is True and server.node.when is True
    message = f"nothing serves the {noun} {client.name}; did you mean {name} ({at.file_and_line})?"
    either = corrections(client.name, client.endpoint.location, name, at)
    yield Mismatch("services", message, client.endpoint.location, at, is_certain, either)


def _may_be_served(workspace: Workspace, client: _Opened) -> bool:
    """Return whether something that is not read may serve what a client calls."""
    if any(launch.more for _, _, launch in workspace.launches):
        return True
    is_own = is_own_type(workspace, client.endpoint.type)
    last = client.name.rpartition("/")[2]
    for _, node in workspace.nodes:
        if workspace.package_of(node) is None:
            # A program of another package does not know an own type.
            if not is_own and node.package not in known()["without_frames"]:
                return True
            continue
        own_node = workspace.own_node(node)
        if own_node is None or own_node.doubts:
            return True
        if any(rule[1].rpartition("/")[2] == last for rule in node.remaps or ()):
            return True
    return any(nodes.doubts for nodes in workspace.nodes_by_package.values())
