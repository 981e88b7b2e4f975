"""Operators, comparisons and subscripts of closed expressions: Python's own, on values of bounded size."""

import ast
import operator
from collections.abc import Callable

from grader.static_python.closed_methods import percent_format, search_cost
from grader.static_python.closed_values import (
    CHARACTERS,
    MAX_BITS,
    MAX_PARTS,
    PLAIN,
    Budget,
    Namespace,
    Undetermined,
    Value,
    run,
    too_large,
)

_NUMBERS = (float, int)


def operate(op: ast.operator, left: Value, right: Value, budget: Budget) -> Value:
    """Return the value of a binary operator."""
    operation = _OPERATORS.get(type(op))
    if operation is None or not (isinstance(left, PLAIN) and isinstance(right, PLAIN)):
        raise Undetermined("this operation is not supported")
    if type(left) not in _NUMBERS or type(right) not in _NUMBERS:
        size = budget.measure(left) + budget.measure(right)
        made = 0
        match op, left, right:
            case ast.Mod(), str(), _:
                operation, made = percent_format, size * left.count("%")
            case (ast.Mult(), str() as text, int() as times) | (ast.Mult(), int() as times, str() as text):
                made = len(text) * times // CHARACTERS
            case (ast.Mult(), list() | tuple(), int() as times) | (ast.Mult(), int() as times, list() | tuple()):
                made = size * times
        if made > MAX_PARTS:
            too_large("value")
        budget.charge(max(made, 0))
    elif isinstance(op, ast.Pow) and type(left) is type(right) is int and left.bit_length() * right > MAX_BITS:
        too_large("number")
    return budget.checked(run(operation, left, right))


def compare(op: ast.cmpop, left: Value, right: Value, budget: Budget) -> bool:
    """Return the value of one comparison."""
    if not (isinstance(left, PLAIN) and isinstance(right, PLAIN)):
        raise Undetermined("this comparison is not supported")
    if isinstance(op, ast.Is | ast.IsNot) and not any(
        value is None or isinstance(value, bool) for value in (left, right)
    ):
        raise Undetermined("which values are one object is not defined")
    if type(left) not in _NUMBERS or type(right) not in _NUMBERS:
        budget.charge(budget.measure(left) + budget.measure(right), search_cost(right, left))
    return bool(run(_COMPARISONS[type(op)], left, right))


def subscript(owner: Value, key: Value, budget: Budget) -> Value:
    """Return the value of owner[key]."""
    if isinstance(owner, Namespace) and isinstance(key, str):
        return owner.find(key)
    if not isinstance(owner, PLAIN):
        raise Undetermined("this index is not supported")
    if not isinstance(key, slice):
        budget.measure(key)  # it is hashed, and shown where it is missing
    elif isinstance(owner, str | list | tuple):
        budget.charge(len(owner))
    return budget.checked(run(operator.getitem, owner, key))


_OPERATORS: dict[type[ast.operator], Callable[[Value, Value], Value]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv, ast.Mod: operator.mod, ast.Pow: operator.pow,
}  # fmt: skip
_COMPARISONS: dict[type[ast.cmpop], Callable[[Value, Value], Value]] = {
    ast.Eq: operator.eq, ast.NotEq: operator.ne, ast.Is: operator.is_, ast.IsNot: operator.is_not,
    ast.In: lambda left, right: left in right, ast.NotIn: lambda left, right: left not in right,
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
}  # fmt: skip
