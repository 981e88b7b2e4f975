"""Equivalents of the YAML files of packages: the same values in another text.

Each must keep full marks.
"""

import re
from collections.abc import Iterator
from contextlib import suppress

from grader.base.grouping import StringsByName, known_values
from grader.lab.submission.submission import Submission
from grader.ros.config.yaml_nodes import YamlNode, yaml_value
from grader.ros.config.yaml_values import sections_in
from grader.workspace.model.workspace import Workspace

EVERY_NODE = "parameters of /**"
_FLOW_STYLE = "flow style of YAML"


def file_equivalents(submission: Submission) -> Iterator[tuple[str, StringsByName]]:
    """Yield each rewriting with the new texts of all files that it changes, by their paths."""
    workspace = submission.workspace
    trees = {tree.source.path: tree for tree in workspace.installed.trees}
    wide = {path: _for_every_node(workspace, path, tree) for path, tree in trees.items()}
    flow = {path: _in_flow_style(tree) for path, tree in trees.items()}
    for rewriting, texts in ((EVERY_NODE, wide), (_FLOW_STYLE, flow)):
        changed = known_values(texts)
        if changed:
            yield rewriting, changed


def _for_every_node(workspace: Workspace, path: str, tree: YamlNode) -> str | None:
    """Return the file of a node with /** in place of the node's name.

    Only that node gets the file, and the file has only its parameters.
    """
    sections = [keys for keys, _ in sections_in(tree)]
    nodes = workspace.parameters.files.get(path, [])
    if (
        len(nodes) != 1
        or len(tree.value) != 1
        or sections != [(workspace.code.find_name(nodes[0]),)]
    ):
        return None
    before = tree.source.text
    text = re.sub(rf"(?m)^([\"']?){re.escape(sections[0][0])}\1(?=\s*:)", "/**", before, count=1)
    return text if text != before else None


def _in_flow_style(tree: YamlNode) -> str | None:
    """Return a file as one mapping in braces.

    It is None for texts that would mean something else there.
    """
    text = _flow(tree)
    with suppress(ValueError):
        if yaml_value(text) == yaml_value(tree.source.text):
            return text
        return None
    return None


def _flow(node: YamlNode) -> str:
    if isinstance(node.value, dict):
        return f"{{{', '.join(f'{key}: {_flow(inner)}' for key, inner in node.value.items())}}}"
    if node.text is None:
        return f"[{', '.join(map(_flow, node.items))}]"
    return node.source.text[slice(*node.span)]
