"""Names in launch files and YAML: arguments, sections of controllers, frames of RViz."""

from collections.abc import Collection, Iterator
from contextlib import suppress

from grader.base.names import last_part
from grader.ros.config.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.ros.config.yaml_values import PARAMETERS, tables_in, values_in
from grader.ros.launch.argument_names import argument_names
from grader.workspace.index.written_names import (
    Role,
    WrittenName,
    WrittenNames,
    written_name,
)
from grader.workspace.model.workspace import Workspace

_FRAMES_OF_RVIZ = ("Fixed Frame", "Reference Frame", "Target Frame")
_MAX_TEXT = 4 * 1024 * 1024  # bytes of a file


def names_in_launch_files(workspace: Workspace) -> WrittenNames:
    """Yield the arguments in launch files, whose owner is the installed file.

    It is also the owner of the arguments that includes pass.
    """
    for package, path, _ in workspace.launches.files:
        data = package.tree.read(path, _MAX_TEXT)
        if data is None:
            continue
        source, argument_uses = argument_names(data, package.path(path))
        for owner in workspace.launches.find_targets(package, path) or (source.path,):
            for argument in argument_uses:
                role: Role = "definition" if argument.is_definition else "use"
                span = argument.start, argument.end
                yield written_name(source, span, "launch argument", argument.name, role, owner)


def names_in_yaml(workspace: Workspace, nodes: Collection[str]) -> WrittenNames:
    """Yield what sections of parameters are for, and the frames of RViz files.

    The sections are those of controllers and of these nodes.
    """
    for tree in workspace.installed.trees:
        for key, mapping in _keys_with_parameters(tree):
            name = last_part(key)
            if key in workspace.installed.typed_sections:
                yield _name_of_key(mapping, key, "controller", name)
            elif name in nodes:
                yield _name_of_key(mapping, key, "node", name)
    for package in workspace.packages:
        for path in [file for file in package.tree.files if file.endswith(".rviz")]:
            data = package.tree.read(path, _MAX_TEXT)
            with suppress(YamlFault):
                yield from _frames_of_rviz(read_yaml(data or b"", package.path(path)))


def _keys_with_parameters(tree: YamlNode) -> Iterator[tuple[str, YamlNode]]:
    """Yield the keys that have parameters of ROS below them, each with its mapping."""
    for mapping in tables_in(tree):
        for key, inner in mapping.table.items():
            if inner.get(PARAMETERS):
                yield key, mapping


def _name_of_key(mapping: YamlNode, key: str, kind: str, name: str) -> WrittenName:
    source = mapping.source
    at = mapping.key_location(key)
    start = source.start_offset(at)
    start += int(source.text[start : start + 1] in ("'", '"'))
    end = start + len(key)
    return written_name(source, (end - len(name), end), kind, name, "use")


def _frames_of_rviz(tree: YamlNode) -> WrittenNames:
    for value in values_in(tree):
        name = value.node.text
        if value.keys and value.keys[-1] in _FRAMES_OF_RVIZ and name and name[0] != "<":
            start, end = value.node.span
            quotes = int(value.node.quoted)
            span = start + quotes, end - quotes
            yield written_name(value.node.source, span, "frame", name, "use")
