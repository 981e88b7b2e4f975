"""Renamed nodes: parameter files whose keys are the names that programs give their nodes.

A launch file gives such a node another name.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence

from grader.base.grouping import Strings
from grader.base.names import last_part
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import keys_of_sections
from grader.ros.known.package_rows import package_row
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import is_section_key
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Compared, Facts, Mismatch
from grader.workspace.rules.rule_table import (
    NO_PARAMETER,
    Rule,
)

_ANY_NAMES = ("*", "**")
_Keys = Mapping[str, Strings]  # of the sections of a file, by the full names that they are


def renamed_node_facts(workspace: Workspace) -> Facts:
    """Yield the sections named after a node's name in its program, where it is renamed.

    The launch file renames the node: rcl compares the new name, so the node gets none of them.

    A container gives its components the files that it gets itself, and so may an action whose
    components are not known. The nodes of a launch file to which a file is passed may read its
    sections.
    """
    with_unknown = set()
    for launch, root in enumerate(workspace.launches.outermost):
        if any(not component.node for component in root.components):
            with_unknown.add(launch)
    for (path, launch), nodes in _nodes_by_file(workspace).items():
        tree = workspace.installed.find_tree(path)
        others = workspace.parameters.files[path]
        workspace.charge(len(others))
        has_container = any(package_row(node.package).holds_nodes for node in others)
        is_open = has_container or path in workspace.installed.passed_files
        if not tree or launch in with_unknown or is_open:
            continue
        elsewhere = _names_read(workspace, others)
        if with_unknown:
            elsewhere.add(None)
        yield from _unread_sections(workspace, tree, nodes, elsewhere)


def _nodes_by_file(workspace: Workspace) -> Mapping[tuple[str, int], list[StartedNode]]:
    """Return the nodes that get each parameter file in each launch file."""
    given: dict[tuple[str, int], list[StartedNode]] = {}
    for launch, node in workspace.launches.launched:
        for path in dict.fromkeys(workspace.parameters.files_given(node)):
            given.setdefault((path, launch), []).append(node)
    return given


def _unread_sections(
    workspace: Workspace,
    tree: YamlNode,
    nodes: Sequence[StartedNode],
    elsewhere: Collection[str | None],
) -> Iterator[Compared | Mismatch]:
    """Yield the sections that no node of a launch file gets, for nodes of that name.

    A node would get one by the name of its program. If it gets another section of the file, one
    that a node of any launch file reads is not reported: `elsewhere` are the names of these
    nodes.
    """
    keys = keys_of_sections(tree)
    workspace.charge(len(nodes) * (1 + len(keys)))
    read = _names_read(workspace, nodes)
    unread = []
    for node in nodes:
        key = key_of_program_name(workspace, node, keys)
        full = node.full_name(node.node_name or "")
        names = (
            elsewhere if any(is_section_key(section_key, full) for section_key in keys) else read
        )
        if key is not None and None not in names and last_part(key) not in names:
            unread.append((node, key))
    for node, key in unread:
        yield Compared("parameters")
        at = tree.key_location(*keys[key])
        is_read_elsewhere = last_part(key) in elsewhere
        yield _unread_section(node, key, at, is_only=len(unread) == 1, is_read=is_read_elsewhere)


_NODE_SECTION = Rule(
    "node-section",
    "parameters",
    NO_PARAMETER,
    "The section of a node has the name that its launch file gives it.",
    why=(
        "The name in the launch file replaces the name in the code. The node ignores the "
        "section with its old name without a message, so its defaults count."
    ),
    wrong="""
joystick:
  ros__parameters:
    speed: 2.0
""",
    right="""
left_stick:
  ros__parameters:
    speed: 2.0
""",
    frame="joystick.yaml",
    beside={
        "joystick.py": "",
        "rover.launch.py": """
Node(
    package='rover',
    executable='joystick',
    name='left_stick',
    parameters=[os.path.join(share, 'config', 'joystick.yaml')],
),
""",
    },
)


def _unread_section(
    node: StartedNode, key: str, at: Location, *, is_only: bool, is_read: bool
) -> Mismatch:
    """Return that a node ignores a section, which another node of another launch file may read."""
    old = last_part(key)
    name = node.node_name or ""
    advice = "add a section" if is_read else "rename the section to"
    message = (
        f"the launch file names this node {name!r}, so it ignores the section {quoted(old)}, "
        f"its name in its program: {advice} {quoted(name)}"
    )
    wrong = Mismatch(_NODE_SECTION, message, at, node.location, node.when is True)
    return wrong.correcting(old, name if is_only and not is_read else None)


def _names_read(workspace: Workspace, nodes: Sequence[StartedNode]) -> set[str | None]:
    """Return the names of nodes and of those that they make in their processes.

    None is among them where one is not known.
    """
    names = set()
    for name in {workspace.code.find_name(node) for node in nodes}:
        names |= {name, *workspace.code.find_children(name or "")}
    return names


def key_of_program_name(workspace: Workspace, node: StartedNode, keys: _Keys) -> str | None:
    """Return the section that a node would get if it had the name of its program.

    The result is None where there is none, or one for the name that it has.
    """
    name = node.node_name
    old = workspace.code.name_in_program(node)
    if not name or not old or name == old or node.namespace is None:
        return None
    full = node.full_name(name)
    full_name = node.full_name(old)
    found_key = None
    for key in keys:
        last = last_part(key)
        if last == name or (last not in _ANY_NAMES and is_section_key(key, full)):
            return None
        if last == old and is_section_key(key, full_name):
            found_key = key
    return found_key
