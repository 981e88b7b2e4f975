"""Renamed nodes: parameter files whose keys are the name that a program gives its node, where a
launch file gives it another one.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence

from grader.base.text import quoted
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import keys_of_sections
from grader.ros.known.package_rows import package_row
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import is_key_of
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Compared, Fact, Mismatch, corrections
from grader.ros.workspace.rules.rule_table import (
    NODE_SECTION,
)

_ANY_NAMES = ("*", "**")
_Keys = Mapping[str, tuple[str, ...]]  # of the sections of a file, by the full names that they are


def renamed_node_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the sections named after a node's name in its program, where the launch file renames
    the node: rcl compares the new name, so the node gets none of them.
    """
    given: dict[tuple[str, int], list[StartedNode]] = {}
    for launch, node in workspace.launches.launched:
        for path in dict.fromkeys(workspace.parameters.files_given(node)):
            given.setdefault((path, launch), []).append(node)
    # What components get is not evaluated; a container gives them the files that it gets itself.
    with_components: set[int] = set()
    for launch, (_, root) in enumerate(workspace.launches.roots):
        if any(component.has_parameters for component in root.components):
            with_components.add(launch)
    for (path, launch), nodes in given.items():
        tree, others = workspace.installed.yaml.get(path), workspace.parameters.files[path]
        workspace.charge(len(others))
        has_container = any(package_row(node.package).holds_nodes for node in others)
        if not isinstance(tree, YamlNode) or launch in with_components or has_container:
            continue
        if path in workspace.installed.passed_files:
            continue  # whose nodes may read the section
        elsewhere = _names_read(workspace, others)
        if with_components:
            elsewhere.add(None)
        yield from _unread_sections(workspace, tree, nodes, elsewhere)


def _unread_sections(
    workspace: Workspace,
    tree: YamlNode,
    nodes: Sequence[StartedNode],
    elsewhere: Collection[str | None],
) -> Iterator[Compared | Mismatch]:
    """Yield the sections that no node of a launch file gets, for each of its nodes that would get
    one by the name of its program. If it gets another section of the file, one that a node of any
    launch file reads is not reported: `elsewhere` are the names of these nodes.
    """
    keys = keys_of_sections(tree)
    workspace.charge(len(nodes) * (1 + len(keys)))
    read = _names_read(workspace, nodes)
    unread = []
    for node in nodes:
        key = key_of_program_name(workspace, node, keys)
        full = node.full_name(node.node_name or "")
        names = elsewhere if any(is_key_of(it, full) for it in keys) else read
        if key is not None and None not in names and key.rpartition("/")[2] not in names:
            unread.append((node, key))
    for node, key in unread:
        yield Compared("parameters")
        old, name, at = key.rpartition("/")[2], node.node_name or "", tree.key_location(*keys[key])
        is_read_elsewhere = old in elsewhere
        advice = "add a section" if is_read_elsewhere else "rename the section to"
        message = (
            f"the launch file names this node {name!r}, so it ignores the section {quoted(old)}, "
            f"its name in its program: {advice} {quoted(name)}"
        )
        is_only_one = len(unread) == 1 and not is_read_elsewhere
        either = corrections(old, at, name if is_only_one else None)
        yield Mismatch(NODE_SECTION, message, at, node.location, node.when is True, either)


def _names_read(workspace: Workspace, nodes: Sequence[StartedNode]) -> set[str | None]:
    """Return the names of nodes and of those that they make in their processes; with None where one
    is not known.
    """
    names: set[str | None] = set()
    for name in {workspace.code.name_of(node) for node in nodes}:
        names |= {name, *workspace.code.children_of(name or "")}
    return names


def key_of_program_name(workspace: Workspace, node: StartedNode, keys: _Keys) -> str | None:
    """Return the section that a node would get if it had the name of its program; None where there
    is none, or one for the name that it has.
    """
    name, old = node.node_name, workspace.code.name_in_program(node)
    if not name or not old or name == old or node.namespace is None:
        return None
    full, full_name = node.full_name(name), node.full_name(old)
    found = None
    for key in keys:
        last = key.rpartition("/")[2]
        if last == name or (last not in _ANY_NAMES and is_key_of(key, full)):
            return None
        if last == old and is_key_of(key, full_name):
            found = key
    return found
