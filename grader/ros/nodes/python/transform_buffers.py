"""Buffers of transforms that nodes in Python ask, and that nothing fills."""

import ast
from collections.abc import Sequence

from grader.base.grouping import StringsByName, group_values
from grader.ros.nodes.message_uses import CodePart
from grader.ros.nodes.node_facts import CodeFault, CodeFaults
from grader.ros.nodes.python.called_functions import bound_calls, name_fully
from grader.ros.python.constants import dotted
from grader.ros.python.parse import Code

_BUFFERS = ("tf2_ros.Buffer", "tf2_ros.buffer.Buffer")
_LOOKS_UP = frozenset({"lookup_transform", "can_transform", "transform", "lookup_transform_async"})


def buffers_without_listener(code: Code, imports: StringsByName) -> CodeFaults:
    """Yield the buffers that look up transforms, and that nothing fills.

    `imports` has the full names of what is imported. A buffer that anything is given may be filled.
    """
    if "set_transform" in code.text:
        return
    for name, calls in _find_buffers(code, imports).items():
        if len(calls) == 1 and _is_only_asked(name, code):
            message = f"no TransformListener fills {name}: it never has a transform"
            yield CodeFault("buffer-listener", message, code.at(calls[0]))


def unregistered_transforms(
    code: Code, parts: Sequence[CodePart], imports: StringsByName
) -> CodeFaults:
    """Yield the calls that transform messages, in a package that imports no conversions of them."""
    buffers = _find_buffers(code, imports)
    for part in parts:
        for call in part.calls:
            owner, _, method = dotted(call.func).rpartition(".")
            if method == "transform" and owner in buffers:
                message = (
                    "no module with the conversions of messages is imported, so transform() raises "
                    "a TypeException: import tf2_geometry_msgs"
                )
                yield CodeFault("transform-registered", message, code.at(call))


def _find_buffers(code: Code, imports: StringsByName) -> dict[str, list[ast.Call]]:
    """Return the calls that make buffers, by the variables and attributes that hold them."""
    made = bound_calls(code.nodes)
    buffers = [row for row in made if name_fully(row[1].func, imports) in _BUFFERS]
    return group_values(buffers)


def _is_only_asked(name: str, code: Code) -> bool:
    """Return whether code looks up transforms in a buffer and does nothing else with it."""
    asked = others = 0
    owners = set()
    for node in code.nodes:
        if isinstance(node, ast.Attribute) and dotted(node.value) == name:
            owners.add(node.value)
            asked += node.attr in _LOOKS_UP
    for node in code.nodes:
        is_used = isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Load)
        if is_used and dotted(node) == name:
            others += node not in owners
    return asked > 0 and others == 0
