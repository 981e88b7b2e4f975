"""Namespaces: parameter files whose keys are of another namespace than the node that gets them."""

from collections.abc import Iterator, Mapping

from grader.base.grouping import Strings
from grader.base.names import last_part
from grader.base.text import quoted
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import keys_of_sections
from grader.ros.known.package_rows import package_row
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import is_section_key
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
)
from grader.workspace.rules.rule_table import (
    NO_PARAMETER,
    Rule,
)


def namespace_facts(workspace: Workspace) -> Facts:
    """Yield the parameter files that have a section of a node's name, not in its namespace.

    rcl compares the full names, so the node gets none of its parameters.
    """
    for path, nodes in workspace.parameters.files.items():
        tree = workspace.installed.find_tree(path)
        if tree:
            keys = keys_of_sections(tree)
            said = set()  # of several nodes that do not get a section, the first
            for node in nodes:
                workspace.charge(1 + len(keys))
                for fact in _other_namespace(workspace, tree, node, keys):
                    if isinstance(fact, Compared) or fact.location not in said:
                        yield fact
                    if isinstance(fact, Mismatch):
                        said.add(fact.location)


_PARAMETER_NAMESPACE = Rule(
    "parameter-namespace",
    "parameters",
    NO_PARAMETER,
    "The section of a node has the node's namespace.",
    why=(
        "rcl compares the key with the full name of the node. The node ignores the section "
        "without a message and starts with its defaults."
    ),
    wrong="""
joystick:
  ros__parameters:
    speed: 2.0
""",
    right="""
/robot1/joystick:
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
    name='joystick',
    namespace='robot1',
    parameters=[os.path.join(share, 'config', 'joystick.yaml')],
),
""",
    },
)


def _other_namespace(
    workspace: Workspace, tree: YamlNode, node: StartedNode, keys: Mapping[str, Strings]
) -> Iterator[Compared | Mismatch]:
    name = workspace.code.find_name(node)
    if not name or node.namespace is None or package_row(node.package).holds_nodes:
        return
    full = node.full_name(name)
    same = [key for key in keys if last_part(key) == last_part(full)]
    if not same:
        return
    yield Compared("parameters")
    if any(is_section_key(key, full) for key in keys):
        return
    written = same[0].strip("/")
    message = (
        f"the node {full} gets nothing of {quoted(written)}, which is the key of the node "
        f"{same[0]}: write {quoted('/**/' + full.rpartition('/')[2])}, which matches any namespace"
    )
    at = tree.key_location(*keys[same[0]])
    wrong = Mismatch(_PARAMETER_NAMESPACE, message, at, node.location, is_certain=node.when is True)
    yield wrong.offering(written, f"/**/{full.rpartition('/')[2]}")
