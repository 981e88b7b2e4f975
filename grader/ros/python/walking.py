"""All nodes of Python's syntax in a part of it, as `ast.walk` gives them, in half the time.

The readers of a module walk over it some twenty times. What says only how a name is used or which
operator is meant (`ast.Load`, `ast.Add`) is no node here: it is an attribute of the node that has
it.
"""

import ast
from ast import AST
from collections.abc import Iterator

from grader.base.grouping import Strings

# Attributes in which no other node is.
_PLAIN = frozenset(
    (
        *("arg", "asname", "attr", "conversion", "ctx", "id", "is_async", "kind", "level"),
        *("module", "op", "ops", "rest", "simple", "tag", "type_comment", "type_ignores"),
    )
)


def _fields_with_nodes() -> Iterator[tuple[type[AST], Strings]]:
    """Yield the kinds of nodes, each with its attributes in which other nodes may be."""
    for kind in vars(ast).values():
        if isinstance(kind, type) and issubclass(kind, AST):
            fields = tuple(field for field in kind._fields if field not in _PLAIN)
            yield kind, fields if kind is not ast.Constant else ()


_FIELDS = dict(_fields_with_nodes())


def children(node: AST) -> list[AST]:
    """Return the nodes right below a node, in the order of the grammar."""
    nodes = []
    for field in _FIELDS[node.__class__]:
        value = getattr(node, field, None)
        if value.__class__ is list:
            for inner in value:
                if isinstance(inner, AST):
                    nodes.append(inner)
        elif isinstance(value, AST):
            nodes.append(value)
    return nodes


def walk(node: AST) -> list[AST]:
    """Return a node and all nodes in it, level by level."""
    nodes = [node]
    for each in nodes:  # which grows
        if _FIELDS[each.__class__]:
            nodes += children(each)
    return nodes
