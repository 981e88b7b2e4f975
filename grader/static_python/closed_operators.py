"""Operators, comparisons and subscripts of closed expressions: Python's own, on values of bounded size."""

import ast
import operator
import re
from collections.abc import Callable

from grader.static_python.closed_values import (
    MAX_BITS,
    MAX_ITEMS,
    PLAIN,
    Namespace,
    Undetermined,
    Value,
    check_text,
    run,
    too_large,
)

_NUMBERS = (float, int)
_LONG_NUMBER = re.compile(r"[0-9]{4}")


def operate(op: ast.operator, left: Value, right: Value) -> Value:
    """Return the value of a binary operator."""
    simple = _SIMPLE.get(type(op))
    if simple is not None and type(left) in _NUMBERS and type(right) in _NUMBERS:
        return run(simple, left, right)
    if not (isinstance(left, PLAIN) and isinstance(right, PLAIN)):
        raise Undetermined("this operation is not supported")
    match op, left, right:
        case ast.Pow(), int(), int() if right > 0 and left.bit_length() * right > MAX_BITS:
            too_large("number")
        case ast.LShift(), int(), int() if left.bit_length() + right > MAX_BITS:
            too_large("number")
        case ast.Mult(), (str() | list() | tuple()), int() if len(left) * right > MAX_ITEMS:
            too_large("value")
        case ast.Mult(), int(), (str() | list() | tuple()) if len(right) * left > MAX_ITEMS:
            too_large("value")
        case ast.Mod(), str(), _:
            return run(_percent_format, left, right)
    return run(_OPERATORS[type(op)], left, right)


def compare(op: ast.cmpop, left: Value, right: Value) -> bool:
    """Return the value of one comparison."""
    if not (isinstance(left, PLAIN) and isinstance(right, PLAIN)):
        raise Undetermined("this comparison is not supported")
    if isinstance(op, ast.Is | ast.IsNot) and not any(
        value is None or isinstance(value, bool) for value in (left, right)
    ):
        raise Undetermined("which values are one object is not defined")
    return bool(run(_COMPARISONS[type(op)], left, right))


def subscript(owner: Value, key: Value) -> Value:
    """Return the value of owner[key]."""
    if isinstance(owner, Namespace) and isinstance(key, str):
        return owner.find(key)
    if not isinstance(owner, PLAIN):
        raise Undetermined("this index is not supported")
    return run(operator.getitem, owner, key)


def _percent_format(template: str, value: Value) -> str:
    if "*" in template or _LONG_NUMBER.search(template):
        raise Undetermined("this format is not supported")
    check_text(value)
    return str(template % value)


_OPERATORS: dict[type[ast.operator], Callable[[Value, Value], Value]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv, ast.Mod: operator.mod, ast.Pow: operator.pow, ast.LShift: operator.lshift,
    ast.RShift: operator.rshift, ast.BitOr: operator.or_, ast.BitAnd: operator.and_, ast.BitXor: operator.xor,
    ast.MatMult: operator.matmul,
}  # fmt: skip
_SIMPLE: dict[type[ast.operator], Callable[[Value, Value], Value]] = {
    kind: _OPERATORS[kind] for kind in (ast.Add, ast.Sub, ast.Mult, ast.Div)
}  # whose results grow slowly
_COMPARISONS: dict[type[ast.cmpop], Callable[[Value, Value], Value]] = {
    ast.Eq: operator.eq, ast.NotEq: operator.ne, ast.Is: operator.is_, ast.IsNot: operator.is_not,
    ast.In: lambda left, right: left in right, ast.NotIn: lambda left, right: left not in right,
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
}  # fmt: skip
