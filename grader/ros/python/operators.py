"""Operators, subscripts, attributes and methods on values of bounded size.

They are Python's own, from an allow-list.
"""

import ast
import operator
import re
from collections.abc import Callable, Mapping
from io import StringIO
from pathlib import PurePosixPath

from grader.base.grouping import texts_among
from grader.base.patterns import on_use
from grader.ros.known.python_names import python_names
from grader.ros.known.releases import Releases
from grader.ros.python.budget import CHARACTERS, Budget
from grader.ros.python.values import (
    MAX_BITS,
    MAX_PARTS,
    MAX_TEXT,
    PLAIN,
    DottedDict,
    EvaluationFails,
    Items,
    Namespace,
    PlainFunction,
    Undetermined,
    Value,
    call_plain,
    charge_str,
    is_object,
    known,
    list_items,
    refuse,
    too_large,
)

_WIDE = on_use(r"\*|\d{3}")
_FIELD = on_use(r"\{(?:\w*)\}")
_NUMBERS = (float, int)


def attribute(owner: Value, name: str, budget: Budget) -> Value:
    """Return the value of an attribute.

    It is of a namespace, of a dict from YAML, or a method of a plain value.
    """
    if name.startswith("__"):
        raise EvaluationFails(f"names that begin with two underscores are not allowed: {name}")
    if isinstance(owner, Namespace):
        if name in python_names("class dict"):  # a namespace of xacro is a dict
            raise Undetermined(f"the method {name} of a namespace is not supported")
        return owner.find(name)
    bound_method = method(owner, name, budget)
    if bound_method:
        return bound_method
    if has_attribute(owner, name):
        raise Undetermined(f"the attribute {name} is not supported")
    if isinstance(owner, DottedDict) and name in owner:
        return owner[name]
    if isinstance(owner, PLAIN):
        raise EvaluationFails(f"{type(owner).__name__!r} has no attribute {name!r}")
    raise Undetermined(f"the attribute {name} of this value is not supported")


def has_attribute(owner: Value, name: str, releases: Releases = ()) -> bool:
    """Return whether a plain value has an attribute, or may have one that is private."""
    kind = "dict" if isinstance(owner, dict) else type(owner).__name__
    names = python_names(f"class {kind}", releases)
    return isinstance(owner, PLAIN) and (name in names or name.startswith("_"))


def method(owner: Value, name: str, budget: Budget) -> PlainFunction | None:
    """Return a method of a plain value that changes nothing, whose work is charged.

    Returns None for any other.
    """
    run = next(
        (table.get(name) for kind, table in _METHODS.items() if isinstance(owner, kind)), None
    )
    if run is None:
        return None
    kind = "holds" if isinstance(owner, list | tuple | dict) else _KINDS.get(name, "plain")

    def charged(*args: Value, **kwargs: Value) -> Value:
        if run is _join:
            budget.measure(texts_among(args))
        if run is not _get:
            budget.charge(
                budget.measure(owner, kind), sum(_search_cost(owner, value) for value in args)
            )
        return call_plain(run, owner, *args, **kwargs)

    return PlainFunction(name, charged, kind)


def _search_cost(text: Value, part: Value) -> int:
    """Return how many characters a search for one text in another looks at, at most."""
    if isinstance(text, str) and isinstance(part, str):
        return len(text) * len(part) // 16
    return 0


_FORMATTED = on_use(r"%(?:\(\w*\))?[-+ #0-9.*]")  # a width, a precision, or a sign


def _percent_format(template: str, value: Value) -> str:
    """Return template % value."""
    if _WIDE.search(template):
        raise Undetermined("this format is not supported")
    charge_str(value)
    return str(template % value)


def _format(text: str, *args: Value, **kwargs: Value) -> str:
    """Return text.format(...), for fields that are names or numbers."""
    if re.search(r"[{}]", _FIELD.sub("", text)):
        raise Undetermined("a format of this kind is not supported")
    size = sum(len(charge_str(value)) for value in (*args, *kwargs.values()))
    if len(text) + size * text.count("{") > MAX_TEXT:
        too_large("text")
    return text.format(*args, **kwargs)


def _replace(text: str, old: str, new: str, *count: int) -> str:
    if len(text) + (text.count(old) if old else len(text) + 1) * len(new) > MAX_TEXT:
        too_large("text")
    return text.replace(old, new, *count)


def _join(separator: str, items: Value) -> str:
    parts = list_items(items)
    if sum(len(part) + len(separator) for part in parts if isinstance(part, str)) > MAX_TEXT:
        too_large("text")
    return separator.join(parts)


def _get(table: dict[Value, Value], key: Value, default: Value = None) -> Value:
    return table.get(known(key), default)


def _named(kind: type, *names: str) -> dict[str, Callable[..., Value]]:
    return {name: getattr(kind, name) for name in names}


_OF_PATHS = (
    "joinpath",
    "as_posix",
    "with_name",
    "with_suffix",
    "with_stem",
    "relative_to",
    "read",
    "close",
    "replace",
)
_KINDS = {**dict.fromkeys(_OF_PATHS, "path"), "format": "text", "join": "text"}
_METHODS: Mapping[type, Mapping[str, Callable[..., Value]]] = {
    str: {
        "replace": _replace,
        "join": _join,
        "format": _format,
        **_named(
            str,
            "capitalize",
            "count",
            "endswith",
            "find",
            "index",
            "isdigit",
            "lower",
            "lstrip",
            "partition",
            "removeprefix",
            "removesuffix",
            "rfind",
            "rpartition",
            "rsplit",
            "rstrip",
            "split",
            "splitlines",
            "startswith",
            "strip",
            "title",
            "upper",
        ),
    },
    dict: {"get": _get, **_named(dict, "keys", "values", "items", "copy")},
    list: _named(list, "copy"),
    PurePosixPath: _named(PurePosixPath, *_OF_PATHS[:6]),
    StringIO: _named(StringIO, "read", "readline", "readlines", "close"),
}


def operate(op: ast.operator, left: Value, right: Value, budget: Budget) -> Value:
    """Return the value of a binary operator."""
    operation = _OPERATORS.get(type(op))
    _refuse_object(op, left, right)
    if type(left) in _NUMBERS and type(right) in _NUMBERS:
        if (
            isinstance(op, ast.Pow)
            and type(left) is type(right) is int
            and left.bit_length() * right > MAX_BITS
        ):
            too_large("number")
        kind = "plain"
    else:
        kind = _kind(op, left, right)
        if isinstance(op, ast.Mod) and isinstance(left, str):
            operation = _percent_format
            if _FORMATTED.search(left):
                budget.measure(right)
        made = _size_made(op, left, right, kind, budget)
        if made > MAX_PARTS:
            too_large("value")
        budget.charge(max(made, 0))
    if operation is None:
        raise Undetermined("this operation is not supported")
    return budget.checked(_run(operation, left, right), kind)


def _size_made(op: ast.operator, left: Value, right: Value, kind: str, budget: Budget) -> int:
    """Return the size of what an operator makes beyond its operands, which are charged."""
    for value in (left, right):
        # An iterator has no operators, as Python says itself.
        if not isinstance(value, (*PLAIN, Items)):
            refuse(value, "this operation is not supported")
    size = budget.measure(left, kind) + budget.measure(right, kind)
    match op, left, right:
        case ast.Mod(), str(), _:
            return size * left.count("%")
        case (ast.Mult(), str() as text, int() as times) | (
            ast.Mult(),
            int() as times,
            str() as text,
        ):
            return len(text) * times // CHARACTERS
        case (ast.Mult(), list() | tuple(), int() as times) | (
            ast.Mult(),
            int() as times,
            list() | tuple(),
        ):
            return size * times
    return 0


def _refuse_object(op: ast.operator, left: Value, right: Value) -> None:
    """Raise EvaluationFails for an operator of an object that has none, as Python does."""
    refused = next(filter(is_object, (left, right)), None)
    other = right if refused is left else left
    if refused is None or (isinstance(op, ast.Mod) and isinstance(left, str)):
        return
    if isinstance(other, PLAIN) or is_object(other):
        raise EvaluationFails(
            f"TypeError: {refused.short}(...) is an object, not a text: use "
            "PathJoinSubstitution([...])"
        )


def _kind(op: ast.operator, left: Value, right: Value) -> str:
    """Return what the operands may contain: an operator of two lists passes their items on."""
    if isinstance(left, _CONTAINERS) or (
        isinstance(right, _CONTAINERS) and not isinstance(left, str)
    ):
        return "holds"
    if isinstance(op, ast.Add | ast.Div | ast.Mod):
        return "text"
    return "plain"


def _run(operation: Callable[[Value, Value], Value], left: Value, right: Value) -> Value:
    try:
        return call_plain(operation, left, right)
    except Undetermined:
        if isinstance(left, PLAIN) and isinstance(right, PLAIN) and type(left) is not type(right):
            kinds = f"{type(left).__name__} and {type(right).__name__}"
            raise EvaluationFails(f"TypeError: no such operator for {kinds}") from None
        raise


def compare(op: ast.cmpop, left: Value, right: Value, budget: Budget) -> bool:
    """Return the value of one comparison."""
    are_plain = all(isinstance(value, PLAIN) or is_object(value) for value in (left, right))
    if are_plain and any(map(is_object, (left, right))) and isinstance(op, _OF_IDENTITY):
        return (left is right) == isinstance(op, ast.Eq | ast.Is)
    _check_comparison(op, left, right)
    if type(left) not in _NUMBERS or type(right) not in _NUMBERS:
        budget.charge(budget.measure(left) + budget.measure(right), _search_cost(right, left))
    return bool(call_plain(_COMPARISONS[type(op)], left, right))


def _check_comparison(op: ast.cmpop, left: Value, right: Value) -> None:
    """Raise Undetermined for a comparison that is not supported."""
    if isinstance(op, ast.Is | ast.IsNot) and not any(
        value is None or isinstance(value, bool) for value in (left, right)
    ):
        raise Undetermined("which values are one object is not defined")
    for value in (left, right):
        if not isinstance(value, PLAIN) and not (
            isinstance(value, Items) and isinstance(op, ast.Eq | ast.NotEq)
        ):
            refuse(value, "this comparison is not supported")


def subscript(owner: Value, key: Value, budget: Budget) -> Value:
    """Return the value of owner[key]."""
    if isinstance(owner, Namespace) and isinstance(key, str):
        return owner.find(key)
    if not isinstance(owner, (*PLAIN, Items)):
        refuse(owner, "this index is not supported")
    if isinstance(owner, str):
        budget.measure(owner)
    if not isinstance(key, slice):
        budget.measure(key)  # it is hashed, and shown where it is missing
    elif isinstance(owner, str | list | tuple):
        budget.charge(len(owner))
    return budget.checked(call_plain(operator.getitem, owner, key))


def _exclusive_or(left: Value, right: Value) -> Value:
    """Return left ^ right, which Python has for integers only."""
    if isinstance(left, int) and isinstance(right, int):
        return left ^ right
    if isinstance(left, (*_NUMBERS, str)) and isinstance(right, (*_NUMBERS, str)):
        kinds = f"{type(left).__name__} and {type(right).__name__}"
        raise EvaluationFails(f"TypeError: no exclusive or (^) of {kinds}; power is **")
    raise Undetermined("this operation is not supported")


_CONTAINERS = (list, tuple, dict)
_OF_IDENTITY = (ast.Eq, ast.NotEq, ast.Is, ast.IsNot)
_OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.BitOr: operator.or_,
    ast.BitXor: _exclusive_or,
}
_COMPARISONS = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda left, right: left in right,
    ast.NotIn: lambda left, right: left not in right,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}
