"""The calls of a module that a condition decides."""

import ast

from grader.ros.python.walking import children

_BRANCHES = (ast.If, ast.IfExp, ast.Match, ast.ExceptHandler)


def calls_in_branches(tree: ast.Module) -> frozenset[ast.Call]:
    """Return the calls inside of conditions, but for that of a program: `__name__`."""
    calls: list[ast.Call] = []
    pending: list[tuple[ast.AST, bool]] = [(tree, False)]
    while pending:
        node, is_inside = pending.pop()
        if is_inside and isinstance(node, ast.Call):
            calls.append(node)
        if isinstance(node, _BRANCHES) and not _asks_for_program(node):
            is_inside = True
        pending += [(child, is_inside) for child in children(node)]
    return frozenset(calls)


def _asks_for_program(node: ast.AST) -> bool:
    test = getattr(node, "test", None)
    left = test.left if isinstance(test, ast.Compare) else None
    return isinstance(left, ast.Name) and left.id == "__name__"
