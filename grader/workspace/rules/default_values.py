"""The defaults of parameters that nodes do not get: of own and known nodes and controllers."""

from collections.abc import Iterator, Sequence

from grader.ros.known.parameter_rows import COVERED, node_rows, row_for
from grader.ros.launch.launch_model import ParameterValue, StartedNode
from grader.ros.launch.node_parameters import NodeParameters
from grader.ros.nodes.node_facts import NodeParameter
from grader.ros.python.parse import START
from grader.ros.python.values import SCALARS, Unknown, Value
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.model.launches import SPAWNERS
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.known_parameters import is_as_released
from grader.workspace.rules.parameter_rules import GivenNode, default_in

_EVERY_NODE = "rclcpp/node"
_NOT_KNOWN = Unknown("its default is not known", START)


def default_value(workspace: Workspace, node: str, parameter: str) -> ParameterValue | None:
    """Return the value of a parameter that a node does not get, and the place that says so.

    The place is where the node declares the parameter or is started. The value is Unknown where
    it is not known. The result is None if there is no value.

    Args:
        workspace: The packages.
        node: The name of a node or controller that is started, without its namespace.
        parameter: The name of the parameter.
    """
    owners = workspace.parameters.owners.get(node, [])
    defaults = {}
    for given in owners:
        for default in _defaults(workspace, node, given, parameter):
            value = default.value if default else None
            defaults[repr(value)] = default
    if len(defaults) > 1:
        return ParameterValue(_NOT_KNOWN, owners[0].node.location)
    return next(iter(defaults.values()), None)


def _defaults(
    workspace: Workspace, name: str, given: NodeParameters, parameter: str
) -> Iterator[ParameterValue | None]:
    """Yield the defaults that a node may have, as it is started: one for each release."""
    node = given.node
    if workspace.find_package(node):
        yield _own_default(workspace, node, parameter)
        return
    kind = node.program_path
    if node.executable in SPAWNERS:
        kinds = {
            controller.type.text or ""
            for controller in defined_controllers(workspace)
            if controller.name == name
        }
        kind = kinds.pop() if len(kinds) == 1 else ""
    if not is_as_released(workspace, kind):
        yield ParameterValue(_NOT_KNOWN, node.location)
        return
    table = node_rows(kind)
    read = [release for release in COVERED if not table or table.is_known_in(release)]
    for release in workspace.releases or read:
        default = default_in(GivenNode(kind, name, given.values, None), parameter, release)
        yield ParameterValue(default, node.location) if default is not None else None


def _own_default(workspace: Workspace, node: StartedNode, parameter: str) -> ParameterValue | None:
    """Return the value with which a node of the workspace declares a parameter."""
    unknown = ParameterValue(_NOT_KNOWN, node.location)
    own_node = workspace.code.own_node(node)
    if not own_node:
        return unknown
    for_all = row_for(_EVERY_NODE, parameter)
    if for_all:
        return ParameterValue(_scalar_or_list(for_all.default), node.location)
    same_name = [
        candidate for candidate in own_node.parameters if candidate.name in (parameter, None)
    ]
    nodes = workspace.code.by_package[node.package]
    if not same_name and not own_node.doubts and not nodes.has_loose_declarations:
        return None
    return _declared_default(same_name, unknown)


def _declared_default(
    parameters: Sequence[NodeParameter], unknown: ParameterValue
) -> ParameterValue | None:
    """Return the default of parameters, if all declarations agree in it; else an unknown one."""
    declarations = [
        parameter
        for parameter in parameters
        if parameter.is_declared and parameter.name is not None
    ]
    if len({repr(declaration.default) for declaration in declarations}) != 1:
        return unknown
    declared = declarations[0]
    if declared.default is None:
        return None
    return ParameterValue(_scalar_or_list(declared.default), declared.location)


def _scalar_or_list(value: Value) -> Value:
    """Return a default as a parameter has it; Unknown where it is not known."""
    items = list(value) if isinstance(value, list | tuple) else [value]
    if not all(isinstance(item, SCALARS) for item in items):
        return _NOT_KNOWN
    return items if isinstance(value, list | tuple) else value
