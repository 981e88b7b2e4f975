"""Edits of a launch file with which it runs xacro on the robot that it reads."""

import ast
import re
from collections.abc import Iterator

from grader.source import Edit, Source
from grader.static_python.parse import Code, parse

_CAT = re.compile(r"\bcat(?=\s)")


def with_xacro(source: Source) -> Iterator[tuple[Edit, ...]]:
    """Yield the edits of a launch file that read the robot with xacro instead of open or cat."""
    for found in _CAT.finditer(source.text):
        yield (source.edit(found.start(), found.end(), "xacro"),)
    if not source.path.endswith(".py"):
        return
    code = parse(source.text.encode("utf-8", "replace"), source.path)
    if not isinstance(code, Code):
        return
    for call, path in _reads(code.tree):
        expression = ast.get_source_segment(source.text, path)
        old = ast.get_source_segment(source.text, call)
        if old and expression:
            at = source.offset(call.lineno, len(source.line(call.lineno).encode()[: call.col_offset].decode()) + 1)
            edit = source.edit(at, at + len(old), f"xacro.process_file({expression}).toxml()")
            yield (*_import(source, code.tree), edit)


def _reads(tree: ast.Module) -> Iterator[tuple[ast.Call, ast.expr]]:
    """Yield the calls that return the text of a file, each with the path of the file."""
    opened: dict[str, ast.expr] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.With):
            for item in node.items:
                path = _opened(item.context_expr)
                if path is not None and isinstance(item.optional_vars, ast.Name):
                    opened[item.optional_vars.id] = path
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            path = _opened(node.value)
            if path is not None:
                opened[node.targets[0].id] = path
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="read")) if name in opened:
                yield node, opened[name]
            case ast.Call(func=ast.Attribute(value=owner, attr="read" | "read_text" as method)):
                path = owner if method == "read_text" else _opened(owner)
                if path is not None:
                    yield node, path


def _opened(value: ast.expr) -> ast.expr | None:
    """Return the path in a call of open."""
    match value:
        case ast.Call(func=ast.Name(id="open"), args=[path, *_]):
            return path
        case _:
            return None


def _import(source: Source, tree: ast.Module) -> Iterator[Edit]:
    """Yield the edit that imports xacro, unless the file does."""
    imports = [node for node in tree.body if isinstance(node, ast.Import | ast.ImportFrom)]
    first = next((node for node in imports if getattr(node, "module", "") != "__future__"), None)
    if first is None or any(alias.name == "xacro" for node in imports for alias in node.names):
        return
    newline = "\r\n" if "\r\n" in source.text else "\n"
    at = source.offset(first.lineno, first.col_offset + 1)
    yield source.edit(at, at, f"import xacro{newline}")
