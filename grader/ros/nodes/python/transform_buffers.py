"""Buffers of transforms that nodes in Python ask, and that nothing fills."""

import ast
from collections.abc import Mapping

from grader.ros.nodes.node_facts import CodeFault, CodeFaults
from grader.ros.python.constants import dotted
from grader.ros.python.parse import Code, every_node

_BUFFERS = ("tf2_ros.Buffer", "tf2_ros.buffer.Buffer")
_LOOKS_UP = frozenset({"lookup_transform", "can_transform", "transform", "lookup_transform_async"})


def buffers_without_listener(code: Code, names: Mapping[str, str]) -> CodeFaults:
    """Yield the buffers that look up transforms, and that nothing fills.

    `names` has the full names of what is imported. A buffer that anything is given may be filled.
    """
    if "set_transform" in code.source.text:
        return
    made: dict[str, list[ast.Call]] = {}
    for node in every_node(code.tree):
        match node:
            case ast.Assign(targets=[ast.Name() | ast.Attribute() as to], value=ast.Call() as call):
                first, dot, rest = dotted(call.func).partition(".")
                if f"{names.get(first, first)}{dot}{rest}" in _BUFFERS:
                    made.setdefault(dotted(to), []).append(call)
    for name, calls in made.items():
        if len(calls) == 1 and _is_only_asked(name, code):
            message = f"no TransformListener fills {name}: it never has a transform"
            yield CodeFault("buffer-listener", message, code.at(calls[0]))


def _is_only_asked(name: str, code: Code) -> bool:
    """Return whether code looks up transforms in a buffer and does nothing else with it."""
    asked = others = 0
    owners = set[ast.AST]()
    for node in every_node(code.tree):
        if isinstance(node, ast.Attribute) and dotted(node.value) == name:
            owners.add(node.value)
            asked += node.attr in _LOOKS_UP
    for node in every_node(code.tree):
        is_read = isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Load)
        if isinstance(node, ast.Name | ast.Attribute) and is_read and dotted(node) == name:
            others += node not in owners
    return asked > 0 and others == 0
