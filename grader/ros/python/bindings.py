"""The names that nodes of Python's syntax bind."""

import ast
from collections.abc import Iterable, Sequence

from grader.base.text import first_part


def bound_names(node: ast.AST) -> Sequence[str]:
    """Return the names that one node binds. An attribute or an item is changed, not bound."""
    match node:
        case ast.Name(id=name, ctx=ast.Store() | ast.Del()) | ast.arg(arg=name):
            return [name]
        case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
            return [node.name]
        case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)):
            return [name]
        case ast.MatchStar(name=str(name)) | ast.MatchMapping(rest=str(name)):
            return [name]
        case ast.alias(name=full, asname=asname):
            return [asname or first_part(full)]
    return []


def names_bound(nodes: Iterable[ast.AST]) -> set[str]:
    """Return the names that nodes bind."""
    return {name for node in nodes for name in bound_names(node)}
