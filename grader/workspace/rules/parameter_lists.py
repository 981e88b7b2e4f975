"""Values for which rcl refuses a whole parameter file: lists of several types, and no value.

The rules and words are those of rcl_yaml_param_parser/src/parse.c of ros2/rcl (c19dab55).
"""

from collections.abc import Iterator
from itertools import pairwise

from grader.base.text import quoted
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import YamlValue, sections_in, values_in
from grader.ros.launch.node_parameters import value_in_file
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Fact, Mismatch
from grader.workspace.rules.parameters import parameter_trees
from grader.workspace.rules.rule_table import (
    NO_PARAMETER,
    SIMILAR,
    Rule,
)

_RCL_TYPES = {bool: "bool", int: "integer", float: "double", str: "string"}
_IN_WORDS = {bool: "booleans", int: "integers", float: "doubles", str: "strings"}


def list_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the values in the parameter files of nodes that rcl refuses, with the whole file.

    A value with a tag is not compared: Lyrical reads some.
    """
    for tree in parameter_trees(workspace):
        for _, section in sections_in(tree):
            workspace.charge(1)
            for value in values_in(section):
                tables = [each.value for each in value.node.items if isinstance(each.value, dict)]
                workspace.charge(1 + len(value.node.items) + sum(map(len, tables)))
                yield from _refused_list(value)
                yield from _without_value(value)


_PARAMETER_LIST = Rule(
    "parameter-list",
    "parameters",
    NO_PARAMETER,
    SIMILAR,
    "A list in a parameter file has values of one type, and a key has a value.",
    why=(
        "rcl refuses the whole file, for example with 'Sequence should be of same type', so the"
        " node ends at its start. A mix of 1.0 and 0 is enough."
    ),
    wrong="""
pilot:
  ros__parameters:
    gains: [2.0, 0]
""",
    right="""
pilot:
  ros__parameters:
    gains: [2.0, 0.0]
""",
    frame="pilot.yaml",
    beside={
        "start/pilot.py": "self.declare_parameter('gains', [1.0, 0.0])",
        "tune/rover.launch.py": "",
    },
)


def _refused_list(value: YamlValue) -> Iterator[Mismatch]:
    """Yield the first entry of a list that rcl does not take."""
    items = value.node.items
    for item, following in pairwise(items):
        if isinstance(item.value, list) and isinstance(following.value, list):
            words = f"Sequences cannot be key at line {following.location.line}"
            message = f"{value.said}: rcl reads no lists in a list, and refuses the file: {words}"
            yield Mismatch(_PARAMETER_LIST, message, following.location)
            return
    entries = [entry for item in items for entry in _entries_in(item)]
    kinds = [kind for entry in entries if (kind := _choose_type(entry)) is not None]
    if len(kinds) < len(entries):
        return
    for entry, kind in zip(entries, kinds, strict=True):
        if kind is not kinds[0]:
            yield _mixed(value, kinds[0], entry, kind)
            return


def _entries_in(item: YamlNode) -> Iterator[YamlNode]:
    """Yield what rcl reads as entries of a list: of a mapping all that follows its first key."""
    if not isinstance(item.value, dict):
        yield item
        return
    for number, (key, value) in enumerate(item.value.items()):
        if number:
            yield YamlNode(item.source, item.key_marks[key], key)
        yield value


def _mixed(value: YamlValue, first: type[object], item: YamlNode, kind: type[object]) -> Mismatch:
    """Return that an entry of a list has another type than the first one."""
    at = item.location
    words = (
        f"Sequence should be of same type. Value type {_RCL_TYPES[kind]!r} do not belong at "
        f"line_num {at.line}"
    )
    advice = ""
    if {first, kind} == {int, float}:
        advice = "; write each number with a decimal point"
    if any(isinstance(each.value, dict) for each in value.node.items):
        message = f"{value.said}: rcl reads no mappings in a list, and refuses the file: {words}"
        return Mismatch(_PARAMETER_LIST, message, at)
    message = (
        f"{value.said}: the list begins with {_IN_WORDS[first]}, and {quoted(item.text or '')} is "
        f"none, so rcl refuses the file: {words}{advice}"
    )
    return Mismatch(_PARAMETER_LIST, message, at)


def _choose_type(node: YamlNode) -> type[object] | None:
    """Return the type that rcl gives a value; None for one that is not compared."""
    if node.text is None or node.has_type:
        return None
    kind = type(value_in_file(node).value)
    return kind if kind in _RCL_TYPES else None


def _without_value(value: YamlValue) -> Iterator[Mismatch]:
    """Yield that a key, or an entry of a list, has no value."""
    for text, node in value.texts():
        if not text and not node.is_string and not node.has_type:
            line = node.location.line
            message = f"{value.said} has no value, so rcl refuses the file: No value at line {line}"
            yield Mismatch(_PARAMETER_LIST, message, node.location)
            return
