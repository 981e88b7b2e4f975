"""Operators, subscripts, attributes and methods in closed expressions: Python's own, on values of bounded size."""

import ast
import operator
import re
from collections.abc import Callable, Mapping

from grader.static_python.closed_values import (
    CHARACTERS,
    MAX_BITS,
    MAX_PARTS,
    MAX_TEXT,
    PLAIN,
    Budget,
    ClosedFunction,
    DottedDict,
    ExpressionFails,
    Items,
    Namespace,
    Undetermined,
    Value,
    call_plain,
    items_of,
    str_of,
    too_large,
)

_WIDE = re.compile(r"\*|\d{3}")


def attribute(owner: Value, name: str, budget: Budget) -> Value:
    """Return the value of an attribute: of a namespace, of a dict from YAML, or a method of a plain value."""
    if name.startswith("__"):
        raise ExpressionFails(f"names that begin with two underscores are not allowed: {name}")
    if isinstance(owner, Namespace):
        if hasattr(dict, name):  # a namespace of xacro is a dict
            raise Undetermined(f"the method {name} of a namespace is not supported")
        return owner.find(name)
    methods = next((methods for kind, methods in _METHODS.items() if isinstance(owner, kind)), {})
    if name in methods:
        return ClosedFunction(name, lambda *args, **kwargs: _call(methods[name], owner, args, kwargs, budget))
    if isinstance(owner, PLAIN) and hasattr(owner, name):
        raise Undetermined(f"the attribute {name} is not supported")
    if isinstance(owner, DottedDict) and name in owner:
        return owner[name]
    if isinstance(owner, PLAIN):
        raise ExpressionFails(f"{type(owner).__name__!r} has no attribute {name!r}")
    raise Undetermined(f"the attribute {name} of this value is not supported")


def _call(
    method: Callable[..., Value], owner: Value, args: tuple[Value, ...], kwargs: dict[str, Value], budget: Budget
) -> Value:
    """Call a method; its arguments are charged."""
    if method is not dict.get:
        budget.charge(budget.measure(owner), sum(search_cost(owner, value) for value in args))
    return call_plain(method, owner, *args, **kwargs)


def search_cost(text: Value, part: Value) -> int:
    """Return how many characters a search for one text in another looks at, at most."""
    return len(text) * len(part) // 16 if isinstance(text, str) and isinstance(part, str) else 0


def percent_format(template: str, value: Value) -> str:
    """Return template % value."""
    if _WIDE.search(template):
        raise Undetermined("this format is not supported")
    str_of(value)
    return str(template % value)


def _replace(text: str, old: str, new: str, *count: int) -> str:
    if len(text) + (text.count(old) if old else len(text) + 1) * len(new) > MAX_TEXT:
        too_large("text")
    return text.replace(old, new, *count)


def _join(separator: str, items: Value) -> str:
    parts = items_of(items)
    if sum(len(part) + len(separator) for part in parts if isinstance(part, str)) > MAX_TEXT:
        too_large("text")
    return separator.join(parts)


def _view(method: Callable[[dict[Value, Value]], Value]) -> Callable[[dict[Value, Value]], Items]:
    return lambda owner: Items(list(method(owner)), is_iterator=False)


_METHODS: Mapping[type, Mapping[str, Callable[..., Value]]] = {
    str: {
        "replace": _replace, "join": _join,
        **{
            name: getattr(str, name)
            for name in ("capitalize", "count", "endswith", "find", "index", "isdigit", "lower", "lstrip", "rsplit",
                         "rstrip", "split", "startswith", "strip", "title", "upper")
        },
    },
    dict: {"get": dict.get, "keys": _view(dict.keys), "values": _view(dict.values), "items": _view(dict.items)},
}  # fmt: skip


_NUMBERS = (float, int)


def operate(op: ast.operator, left: Value, right: Value, budget: Budget) -> Value:
    """Return the value of a binary operator."""
    operation = _OPERATORS.get(type(op))
    are_numbers = type(left) in _NUMBERS and type(right) in _NUMBERS
    if operation is None or not (are_numbers or (isinstance(left, PLAIN) and isinstance(right, PLAIN))):
        raise Undetermined("this operation is not supported")
    if not are_numbers:
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
    return budget.checked(call_plain(operation, left, right))


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
    return bool(call_plain(_COMPARISONS[type(op)], left, right))


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
    return budget.checked(call_plain(operator.getitem, owner, key))


_OPERATORS: dict[type[ast.operator], Callable[[Value, Value], Value]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv, ast.Mod: operator.mod, ast.Pow: operator.pow,
}  # fmt: skip
_COMPARISONS: dict[type[ast.cmpop], Callable[[Value, Value], Value]] = {
    ast.Eq: operator.eq, ast.NotEq: operator.ne, ast.Is: operator.is_, ast.IsNot: operator.is_not,
    ast.In: lambda left, right: left in right, ast.NotIn: lambda left, right: left not in right,
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
}  # fmt: skip
