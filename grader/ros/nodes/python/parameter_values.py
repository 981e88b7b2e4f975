"""Parameters of a node that are computed with as if they were their values."""

import ast
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from grader.ros.nodes.message_uses import certain_nodes
from grader.ros.nodes.node_facts import CodeFault
from grader.ros.nodes.python.called_functions import methods_of
from grader.ros.python.bindings import bound_names
from grader.ros.python.constants import dotted, last_name
from grader.ros.python.parse import Code, every_node
from grader.ros.python.walking import walk

_METHODS = ("get_parameter", "declare_parameter")
# By these, code binds attributes that are not seen, or asks what it has.
_UNSEEN = ("setattr", "isinstance", "hasattr", "__dict__")
_ORDERS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)  # == and != take any objects
_OF_NUMBERS = ("abs", "round", "int", "float", "range", "self.create_timer")
_MESSAGE = (
    "returns a Parameter, with which Python cannot compute or compare: write .value behind it"
)


def parameters_as_values(code: Code, nodes: Collection[ast.ClassDef]) -> Iterator[CodeFault]:
    """Yield the first computation or comparison of a class with a Parameter.

    get_parameter() and declare_parameter() return it, which is no number. It is used directly, or
    by a variable or an attribute that is bound once.
    """
    text = code.source.text
    if "_parameter(" not in text or any(word in text for word in _UNSEEN):
        return
    for owner in nodes:
        attributes = _holders(owner)
        attributes = {name: method for name, method in attributes.items() if name[:5] == "self."}
        for part in methods_of(owner).values():
            held = {**attributes, **_holders(part)}
            used = next(_computations(certain_nodes(part), held), None)
            if used is not None and _is_sure(code, used[0]):
                at = code.at(used[0])
                yield CodeFault("call-arguments", f"{used[1]}() {_MESSAGE}", at)
                break


def _is_sure(code: Code, used: ast.expr) -> bool:
    """Return whether a module binds an operand to nothing else, and the methods to nothing."""
    counts = Counter[str]()
    for node in every_node(code.tree):
        counts.update(bound_names(node))
        if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load):
            counts[node.attr] += 1
    names = (*_METHODS, *(name.removeprefix("self.") for name in _OF_NUMBERS))
    return counts[last_name(used)] <= 1 and not any(counts[name] for name in names)


def _method_called(node: ast.expr) -> str:
    """Return which of the methods a call of a node's own method calls; empty for none of them."""
    name = dotted(node.func).removeprefix("self.") if isinstance(node, ast.Call) else ""
    return name if name in _METHODS else ""


def _holders(part: ast.AST) -> dict[str, str]:
    """Return the names that a part of a module binds to a Parameter, with the method called."""
    held: dict[str, str] = {}
    for node in walk(part):
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and _method_called(node.value):
            held[dotted(node.targets[0])] = _method_called(node.value)
    return held


def _computations(
    nodes: Iterable[ast.AST], held: Mapping[str, str]
) -> Iterator[tuple[ast.expr, str]]:
    """Yield the operands of computations that are a Parameter, with the method that returns it."""
    for node in nodes:
        for operand in _operands(node):
            method = held.get(dotted(operand)) or _method_called(operand)
            if method:
                yield operand, method


def _operands(node: ast.AST) -> Sequence[ast.expr]:
    """Return what has to be a number for Python to compute a node; a text with % takes any."""
    match node:
        case ast.BinOp(left=left, op=operator, right=right) if not isinstance(operator, ast.Mod):
            return (left, right)
        case ast.Compare(left=left, ops=operators, comparators=others):
            return (left, *others) if all(isinstance(each, _ORDERS) for each in operators) else ()
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return (operand,)
        case ast.Call(func=function, args=[operand, *_]) if dotted(function) in _OF_NUMBERS:
            return (operand,)
    return ()
