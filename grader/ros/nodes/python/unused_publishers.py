"""Publishers that a node opens and never uses, so that it certainly publishes nothing with them."""

import ast
from collections.abc import Iterable, Iterator

from grader.base.source import Location
from grader.ros.python.constants import binds_unseen, dotted, last_name
from grader.ros.python.parse import AnyFunction, Code
from grader.ros.python.walking import walk

_OPENING = ("create_publisher", "create_lifecycle_publisher")


def unused_publishers(modules: Iterable[Code]) -> set[Location]:
    """Return where the modules of a package open publishers that nothing in them uses.

    Such a publisher is not kept, or it is kept in an attribute or variable that no code reads. One
    whose name is a text may be asked for by getattr().
    """
    codes = list(modules)
    nodes = [node for code in codes for node in code.nodes]
    if binds_unseen(nodes) or any(map(_asks_computed, nodes)):
        return set()
    read = _read_names(nodes)
    if "publishers" in read:  # those of a node, all of them
        return set()
    return {at for code in codes for at in _unused_in(code, read)}


def _read_names(nodes: Iterable[ast.AST]) -> set[str]:
    """Return the attributes that code reads, and the texts in it."""
    read = set()
    for node in nodes:
        match node:
            case ast.Attribute(attr=name, ctx=ast.Load() | ast.Del()):
                read.add(name)
            case ast.AugAssign(target=ast.Attribute(attr=name)):
                read.add(name)
            case ast.Constant(value=str(name)):
                read.add(name)
            case ast.MatchClass(kwd_attrs=names):
                read.update(names)
    return read


def _asks_computed(node: ast.AST) -> bool:
    """Return whether code asks a node for an attribute by a name that it computes."""
    match node:
        case ast.Call(func=ast.Name(id="getattr"), args=[ast.Name(id="self" | "node"), name, *_]):
            return not isinstance(name, ast.Constant)
    return False


def _unused_in(code: Code, read: set[str]) -> Iterator[Location]:
    """Yield where a module opens them; `read` are the attributes that the package reads."""
    for function in code.nodes:
        if not isinstance(function, AnyFunction):
            continue
        inside = walk(function)
        variables = {
            node.id
            for node in inside
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
        }
        for node in inside:
            if isinstance(node, ast.Global | ast.Nonlocal):
                variables.update(node.names)
        for statement in inside:
            call = _opened_by(statement, read, variables)
            if call:
                yield code.at(call)


def _opened_by(statement: ast.AST, read: set[str], variables: set[str]) -> ast.Call | None:
    """Return the call by which a statement opens a publisher that nothing uses."""
    match statement:
        case ast.Expr(value=ast.Call() as call):
            is_unused = True
        case ast.Assign(targets=[ast.Attribute() as target], value=ast.Call() as call):
            is_unused = dotted(target.value) == "self" and target.attr not in read
        case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call() as call):
            is_unused = name not in variables
        case _:
            return None
    return call if is_unused and last_name(call.func) in _OPENING else None
