"""The versions that setup.py states as texts."""

import ast
from collections.abc import Iterator

from grader.base.source import Source
from grader.ros.python.constants import last_name
from grader.ros.python.parse import Code, Position, every_node, parse, position_of


def stated_versions(setup: Source) -> Iterator[tuple[str, Position]]:
    """Yield the versions that setup() is given as texts, by their own or by a name of them."""
    code = parse(setup.text.encode("utf-8", "replace"), setup.path)
    if not isinstance(code, Code):
        return
    assigned: dict[str, list[ast.expr]] = {}
    given: list[ast.expr] = []
    for node in every_node(code.tree):
        match node:
            case (
                ast.Assign(targets=[ast.Name(id=name)], value=value)
                | ast.AugAssign(target=ast.Name(id=name), value=value)
            ):
                assigned.setdefault(name, []).append(value)
            case ast.Call(func=function) if last_name(function) == "setup":
                given += [word.value for word in node.keywords if word.arg == "version"]
    for value in given:
        match value:
            case ast.Name(id=name):
                values = assigned.get(name, [])
            case _:
                values = [value]
        match values:
            case [ast.Constant(value=str(version)) as text]:
                yield version, position_of(text)
