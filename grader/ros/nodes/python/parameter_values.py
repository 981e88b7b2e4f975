"""Parameters of a node that are computed with as if they were their values."""

import ast
from collections import Counter
from collections.abc import Collection, Iterable, Iterator

from grader.ros.nodes.message_uses import certain_nodes
from grader.ros.nodes.node_facts import CodeFault
from grader.ros.nodes.python.called_functions import list_methods
from grader.ros.python.bindings import bound_names
from grader.ros.python.constants import dotted
from grader.ros.python.parse import Code, every_node
from grader.ros.python.walking import walk

_METHOD = "get_parameter"
_GET = f"self.{_METHOD}"
# By these, code binds attributes that are not seen, or asks what it has.
_UNSEEN = ("setattr", "isinstance", "hasattr", "__dict__")


def parameters_as_values(code: Code, nodes: Collection[ast.ClassDef]) -> Iterator[CodeFault]:
    """Yield the first computation of a class with what get_parameter() returns.

    That is no number. It is used directly, or by a variable or an attribute that is bound once.
    """
    text = code.source.text
    if _GET not in text or any(word in text for word in _UNSEEN):
        return
    for owner in nodes:
        attributes = {name for name in _holders(owner) if name.startswith("self.")}
        for method in list_methods(owner).values():
            held = attributes | _holders(method)
            used = next(_computations(certain_nodes(method), held), None)
            if used is not None and _is_sure(code, used):
                message = (
                    "get_parameter() returns a Parameter, with which Python cannot compute: write "
                    ".value behind it"
                )
                yield CodeFault("call-arguments", message, code.at(used))
                break


def _is_sure(code: Code, used: ast.BinOp) -> bool:
    """Return whether a module binds no operand to anything else, and get_parameter to nothing."""
    names = {dotted(side).rpartition(".")[2] for side in (used.left, used.right)}
    counts = Counter[str]()
    for node in every_node(code.tree):
        counts.update(bound_names(node))
        if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load):
            counts[node.attr] += 1
    return not counts[_METHOD] and all(counts[name] <= 1 for name in names)


def _holders(part: ast.AST) -> set[str]:
    """Return the names that a part of a module binds to what get_parameter() returns."""
    held = set[str]()
    for node in walk(part):
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=function)):
                held |= {dotted(target)} if dotted(function) == _GET else set()
    return held


def _computations(nodes: Iterable[ast.AST], held: Collection[str]) -> Iterator[ast.BinOp]:
    """Yield the computations of which an operand is a Parameter; a text with % takes any."""
    for node in nodes:
        if not isinstance(node, ast.BinOp) or isinstance(node.op, ast.Mod):
            continue
        for side in (node.left, node.right):
            if dotted(side) in held or (isinstance(side, ast.Call) and dotted(side.func) == _GET):
                yield node
                break
