"""The topics, services, actions and frames that own code opens, with full names for each node."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Literal, NamedTuple, get_args

from grader.base.source import Location
from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import (
    Endpoint,
    EndpointKind,
    NamePart,
    NodeFacts,
    NodeFrame,
    NodeTransform,
)
from grader.ros.python.values import Value
from grader.workspace.model.workspace import Workspace

_ANY = "*"  # in a name, in place of a part that is not known
EndSource = Literal["code", "controller", "bridge", "program"]
END_SOURCES: tuple[EndSource, ...] = get_args(EndSource)
_MAX_NAMES = 20  # of one endpoint


class End(NamedTuple):
    """An end of a topic, service or action, by its full name, of a node that is or may be started.

    `Graph` makes the ends of a workspace, and the rules of topics, services and messages read them.
    An endpoint is what the code has, or what is known of another program; a node that is started
    twice has each of its ends twice.
    """

    name: str  # _ANY stands for what is not known of it
    endpoint: Endpoint
    launch: int  # the number of the launch file that starts the node; -1 where none is asked for
    node: StartedNode
    source: EndSource
    owner: str  # the program, or the controller in its process

    @property
    def kind(self) -> EndpointKind:
        """What it is."""
        return self.endpoint.kind

    @property
    def type(self) -> str | None:
        """The full name of its type: std_msgs.msg.Float32; None where it is not known."""
        return self.endpoint.type

    @property
    def location(self) -> Location:
        """Where it is written: in code, or in the file that asks for the program."""
        return self.endpoint.location

    @property
    def is_known(self) -> bool:
        """Whether all of its name is known."""
        return _ANY not in self.name

    @property
    def is_certain(self) -> bool:
        """Whether its node is started under the default arguments."""
        return self.node.when is True

    def surely_meets(self, other: "End") -> bool:
        """Return whether one launch file certainly starts the nodes of both ends."""
        return self.is_certain and other.is_certain and self.launch == other.launch


def opened_by(workspace: Workspace, node: StartedNode, launch: int = -1) -> Iterator[End]:
    """Yield what the nodes of a program open as it is started. Raises NotDecided."""
    for own_node in workspace.code.find_all_nodes(node):
        yield from opened_by_code(workspace, node, own_node, launch)


def opened_by_code(
    workspace: Workspace, node: StartedNode, own_node: NodeFacts, launch: int
) -> Iterator[End]:
    """Yield what one node of a program opens as it is started. Raises NotDecided."""
    workspace.charge(len(own_node.endpoints) * (1 + len(node.remaps or ())))
    values: Mapping[str, Value] = {}
    if any(map(_has_parameter, own_node.endpoints)):
        values = _values_given(workspace, node, own_node)
    named = node
    if node.node_name == "":  # it keeps that of its program
        named = node._replace(node_name=own_node.name)
    for endpoint in own_node.endpoints:
        for name in _names(endpoint, named, values):
            full = _full_name(named, name)
            yield End(full, endpoint, launch, node, "code", node.executable)


def _has_parameter(endpoint: Endpoint) -> bool:
    """Return whether a parameter is a part of a name."""
    return any(part.kind in ("parameter", "item") for part in endpoint.parts)


def _full_name(node: StartedNode, name: str | None) -> str:
    """Return the full name of an end of a node; _ANY for one that is not known.

    A remapping may replace a name of which a part is not known.
    """
    if name is None or (_ANY in name and node.remaps != ()):
        return _ANY
    full = node.topic(name)
    if full is None or "~" in full or "//" in full:
        return _ANY
    return full


def list_frames(workspace: Workspace, node: StartedNode) -> Iterator[tuple[str | None, NodeFrame]]:
    """Yield the frames that the nodes of a program name as it is started, each with its name.

    It is None for one that is not known. Raises NotDecided.
    """
    for own_node in workspace.code.find_all_nodes(node):
        if not own_node.frames:
            continue
        workspace.charge(len(own_node.frames))
        values = _values_given(workspace, node, own_node)
        named = node if node.node_name != "" else node._replace(node_name=own_node.name)
        for frame in own_node.frames:
            for name in _names(frame, named, values):
                is_known = name is not None and _ANY not in name
                yield name if is_known else None, frame


def transforms_sent(
    workspace: Workspace, node: StartedNode, own_node: NodeFacts
) -> Iterator[tuple[str, str, NodeTransform]]:
    """Yield parent and child of each transform that one node of a program sends.

    One that is not known is empty. Raises NotDecided.
    """
    if not own_node.transforms:
        return
    workspace.charge(len(own_node.transforms))
    values = _values_given(workspace, node, own_node)
    named = node if node.node_name else node._replace(node_name=own_node.name)
    for sent in own_node.transforms:
        for parent in _names(sent.parent, named, values):
            for child in _names(sent.child, named, values):
                yield _frame_name(parent), _frame_name(child), sent


def _frame_name(name: str | None) -> str:
    """Return the name of a frame without its slash; empty if it is not known."""
    return name.removeprefix("/") if name is not None and _ANY not in name else ""


def _values_given(
    workspace: Workspace, node: StartedNode, own_node: NodeFacts
) -> Mapping[str, Value]:
    """Return the values of the parameters that a node declares, as it is started."""
    values = {
        declared.name: declared.default
        for declared in own_node.parameters
        if declared.name is not None and declared.is_declared
    }
    package = workspace.find_package(node)
    assert package  # that has the code of the node
    given = workspace.parameters.given_in_code(package, node, own_node.name)
    if given.unknown:
        return {}
    return {**values, **{name: given_value.value for name, given_value in given.values.items()}}


def _names(
    endpoint: Endpoint | NodeFrame, node: StartedNode, values: Mapping[str, Value]
) -> Sequence[str | None]:
    """Return the names that an endpoint or frame has in the code of a node.

    The result is None for one of which nothing is known.
    """
    if endpoint.name is not None or not endpoint.parts:
        return [endpoint.name]
    lists = [part.text for part in endpoint.parts if part.kind == "item"]
    items: Value = [_ANY]
    if len({*lists}) == 1:
        items = values.get(lists[0])
    if not isinstance(items, list | tuple):
        items = [_ANY]
    names = []
    for item in items[:_MAX_NAMES]:
        name = "".join(_make_text(part, node, values, item) for part in endpoint.parts)
        names.append(name if name.strip(f"{_ANY}/") else None)
    return names


def _make_text(part: NamePart, node: StartedNode, values: Mapping[str, Value], item: Value) -> str:
    """Return the text that a part is for a node, where `item` is the one of its list."""
    match part.kind:
        case "text":
            return part.text
        case "node name" if node.node_name:
            return node.node_name
        case "namespace" if node.namespace is not None:
            return f"/{node.namespace.strip('/')}"
        case "parameter":
            return _written(values.get(part.text))
        case "item":
            return _written(item)
    return _ANY


def _written(value: Value) -> str:
    """Return a value as it is in a text, if it surely is written so."""
    is_plain = isinstance(value, str | int) and not isinstance(value, bool)
    return str(value) if is_plain else _ANY
