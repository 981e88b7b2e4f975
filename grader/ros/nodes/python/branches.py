"""The calls of a module that a condition or loop decides, or whose errors it may catch."""

import ast
from collections.abc import Iterator

from grader.ros.nodes.message_uses import suppresses
from grader.ros.python.constants import last_name
from grader.ros.python.parse import caught_by
from grader.ros.python.walking import children, walk

_BRANCHES = (ast.If, ast.IfExp, ast.Match, ast.ExceptHandler)
# What a handler of these does not keep from stopping the program.
_INTERRUPTS = frozenset({"KeyboardInterrupt", "SystemExit", "ExternalShutdownException"})


def calls_in_branches(tree: ast.Module) -> frozenset[ast.Call]:
    """Return the calls inside of conditions, but for that of a program: `__name__`."""
    calls = []
    pending: list[tuple[ast.AST, bool]] = [(tree, False)]
    while pending:
        node, is_inside = pending.pop()
        if is_inside and isinstance(node, ast.Call):
            calls.append(node)
        if isinstance(node, _BRANCHES) and not program_name(getattr(node, "test", None)):
            is_inside = True
        pending += [(child, is_inside) for child in children(node)]
    return frozenset(calls)


def loops_over_tuples(
    tree: ast.AST,
) -> Iterator[tuple[ast.Tuple, ast.expr, list[ast.AST]]]:
    """Yield the loops that bind several names: these, what is iterated, and what runs each time."""
    for node in walk(tree):
        match node:
            case ast.For(target=ast.Tuple() as target, iter=items, body=body):
                yield target, items, [part for statement in body for part in walk(statement)]
            case ast.ListComp(
                elt=element,
                generators=[ast.comprehension(target=ast.Tuple() as target, iter=items, ifs=[])],
            ):
                yield target, items, walk(element)


def program_name(test: ast.expr | None) -> str:
    """Return the text that a condition compares __name__ with; empty for another condition."""
    match test:
        case ast.Compare(
            left=ast.Name(id="__name__"),
            ops=[ast.Eq()],
            comparators=[ast.Constant(value=str(name))],
        ):
            return name
    return ""


def calls_caught(tree: ast.Module) -> frozenset[ast.Call]:
    """Return the calls whose errors the code around them may catch or suppress."""
    calls = set[ast.Call]()
    pending: list[ast.AST] = [tree]
    while pending:
        node = pending.pop()
        match node:
            case ast.Try(body=body, handlers=handlers) if any(map(may_catch_error, handlers)):
                inside = body
            case ast.With(items=items, body=body) if suppresses(items):
                inside = body
            case _:
                pending += children(node)
                continue
        for statement in inside:
            calls.update(part for part in walk(statement) if isinstance(part, ast.Call))
        caught = {*inside}
        pending += [child for child in children(node) if child not in caught]
    return frozenset(calls)


def may_catch_error(handler: ast.ExceptHandler) -> bool:
    """Return whether a handler may catch anything but what interrupts a program."""
    return any(not kind or last_name(kind) not in _INTERRUPTS for kind in caught_by(handler))
