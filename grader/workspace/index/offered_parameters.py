"""The parameters of the node that a section of a parameter file is for.

The nodes are own nodes, controllers and well-known nodes.
"""

from collections.abc import Iterator

from grader.ros.known.package_rows import usual_names
from grader.ros.known.parameter_rows import find_rows, node_rows, row_for
from grader.ros.known.parameter_texts import row_text
from grader.ros.known.releases import Release
from grader.ros.nodes.node_facts import NodeParameter
from grader.ros.python.values import Unknown
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.model.workspace import Workspace


def parameters_below(workspace: Workspace, section: str, prefix: str) -> list[str]:
    """Return the keys that a section of a parameter file may have, in alphabetical order.

    Args:
        workspace: The packages.
        section: The name of the node or controller.
        prefix: The keys of the tables around, each with a dot.
    """
    names = [parameter.name or "" for parameter in _own_parameters(workspace, section)]
    node = _known_node(workspace, section)
    if node is not None:
        names += (row.name for row in find_rows(node, _only_release(workspace)))
    keys = {_key_behind(name, prefix) for name in names}
    return sorted(keys - {""})


def parameter_text(workspace: Workspace, section: str, name: str) -> str:
    """Return what is known of a parameter of a node, a fact a line; empty where nothing is."""
    for parameter in _own_parameters(workspace, section):
        if parameter.name == name:
            where = f"declared at {parameter.location.file_and_line}"
            is_known = parameter.default is not None and not isinstance(parameter.default, Unknown)
            return f"default: {parameter.default}\n{where}" if is_known else where
    node = _known_node(workspace, section)
    known = node_rows(node) if node is not None else None
    row = row_for(node, name, _only_release(workspace)) if node is not None else None
    if known is None or row is None:
        return ""
    return f"parameter of {node}\n{row_text(row, known.read)}"


def _own_parameters(workspace: Workspace, section: str) -> Iterator[NodeParameter]:
    for package in workspace.code.by_package.values():
        for node in package.nodes:
            if node.name == section:
                yield from (parameter for parameter in node.parameters if parameter.is_declared)


def _known_node(workspace: Workspace, section: str) -> str | None:
    """Return the well-known node that has a section.

    It is found by the type of a controller, else by the name that a node usually has.
    """
    for controller in defined_controllers(workspace):
        if controller.name == section:
            return controller.type.text
    return usual_names().get(section)


def _only_release(workspace: Workspace) -> Release | None:
    """Return the release of a workspace; None where it states none or several."""
    return workspace.releases[0] if len(workspace.releases) == 1 else None


def _key_behind(name: str, prefix: str) -> str:
    """Return the part of a parameter's name behind a prefix.

    The result is empty where the name does not begin so, or where any key may be.
    """
    tables, parts = prefix.split(".")[:-1], name.split(".")
    for table, part in zip(tables, parts, strict=False):
        if part != table and not part.startswith("<"):
            return ""
    key = parts[len(tables)] if len(parts) > len(tables) else ""
    return "" if key.startswith("<") else key
