"""Parameters of a node that are computed with as if they were their values."""

import ast
from collections import Counter
from collections.abc import Iterator, Sequence

from grader.ros.nodes.message_uses import CodePart, certain_nodes
from grader.ros.nodes.node_facts import CodeFault
from grader.ros.python.constants import dotted
from grader.ros.python.parse import Code, location_in, position_of
from grader.ros.python.walking import walk

_GET = "self.get_parameter"


def parameters_as_values(code: Code, parts: Sequence[CodePart]) -> Iterator[CodeFault]:
    """Yield the first computation with what get_parameter() returns, which is no number.

    What it returns is used directly, or by a variable or an attribute that is bound once.
    """
    if _GET not in code.source.text:
        return
    held = _holders(code)
    for part in parts:
        for node in certain_nodes(part.node) if part.of is not None else ():
            if not isinstance(node, ast.BinOp) or isinstance(node.op, ast.Mod):  # of a text
                continue
            if _is_parameter(node.left, held) or _is_parameter(node.right, held):
                message = (
                    "get_parameter() returns a Parameter, with which Python cannot compute: write "
                    ".value behind it"
                )
                yield CodeFault("wrong call", message, location_in(code.source, position_of(node)))
                return


def _holders(code: Code) -> set[str]:
    """Return the variables and attributes that are bound once, to what get_parameter() returns."""
    counts, bound = Counter[str](), set[str]()
    for node in walk(code.tree):
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=function)):
                bound |= {dotted(target)} if dotted(function) == _GET else set()
            case ast.Name(ctx=ast.Store() | ast.Del()) | ast.Attribute(ctx=ast.Store() | ast.Del()):
                counts[dotted(node)] += 1
            case ast.arg(arg=name):
                counts[name] += 1
    return {name for name in bound if counts[name] == 1}


def _is_parameter(node: ast.expr, held: set[str]) -> bool:
    """Return whether an operand is a Parameter."""
    return dotted(node) in held or (isinstance(node, ast.Call) and dotted(node.func) == _GET)
