"""The version that a setup.py gives to setup()."""

import ast
from collections.abc import Iterator, Sequence

from grader.base.source import Location, Source
from grader.ros.python.constants import last_name
from grader.ros.python.parse import Code, location_in, make_position, parse


def versions_in(setup: Source) -> Iterator[tuple[str, Location]]:
    """Yield the versions that a setup.py surely gives, each with its place.

    It is a text, or a variable that is set once.
    """
    code = parse(setup.text.encode("utf-8", "replace"), setup.path)
    if not isinstance(code, Code):
        return
    nodes = code.nodes
    for value in _given_versions(nodes):
        values = [value]
        if isinstance(value, ast.Name):
            values = _assigned_to(value.id, nodes)
        match values:
            case [ast.Constant(value=str(version)) as text]:
                yield version, location_in(setup, make_position(text))


def _given_versions(nodes: Sequence[ast.AST]) -> list[ast.expr]:
    given = []
    for node in nodes:
        if isinstance(node, ast.Call) and last_name(node.func) == "setup":
            given += [word.value for word in node.keywords if word.arg == "version"]
    return given


def _assigned_to(variable: str, nodes: Sequence[ast.AST]) -> list[ast.expr]:
    """Return what a variable is set to."""
    values = []
    for node in nodes:
        match node:
            case (
                ast.Assign(targets=[ast.Name(id=name)], value=value)
                | ast.AugAssign(target=ast.Name(id=name), value=value)
            ) if name == variable:
                values.append(value)
    return values
