"""Python's built-in functions and those of math, as a closed expression may call them."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from grader.static_python.closed_values import (
    MAX_PARTS,
    Budget,
    ClosedFunction,
    ExpressionFails,
    Items,
    Undetermined,
    Value,
    call_plain,
    checked_key,
    items_of,
    str_of,
    too_large,
)

_MAX_DIGITS = 400  # that round leaves
_MAX_SMALL = 200  # arguments of factorial and its like


def call(function: Value, args: list[Value], kwargs: dict[str, Value], budget: Budget) -> Value:
    """Return what a call of a function of the allow-list returns."""
    budget.measure([args, list(kwargs.values())])
    if not isinstance(function, ClosedFunction):
        return call_plain(function, *args, **kwargs) if not callable(function) else _refuse("this call")
    if function is BUILTINS["map"] and args and not kwargs:
        mapped, *lists = args
        try:
            return Items([call(mapped, list(items), {}, budget) for items in zip(*map(items_of, lists), strict=False)])
        except ExpressionFails as error:  # only where a loop gets there
            raise Undetermined(f"a map of items that fails is not supported: {error}") from None
    return budget.checked(call_plain(function.run, *args, **kwargs))


def _refuse(what: str) -> Value:
    raise Undetermined(f"{what} is not supported")


def _refuse_function(name: str) -> Callable[..., Value]:
    return lambda *_, **__: _refuse(f"the function {name}")


def _of_items(function: Callable[..., Value]) -> Callable[..., Value]:
    """Return a function whose first argument is a loop's items, as list and sorted take it."""
    return lambda *args, **kwargs: function(*map(items_of, args[:1]), *args[1:], **kwargs)


def _largest(function: Callable[..., Value]) -> Callable[..., Value]:
    """Return min or max: of the items of a value, or of several values."""
    return lambda *args, **named: function(*(map(items_of, args) if len(args) == 1 else args), **named)


def make_dict(*args: Value, **kwargs: Value) -> Value:
    """Return dict() of values."""
    if not args or isinstance(args[0], dict):
        return dict(*args, **kwargs)
    pairs = [[items_of(pair) for pair in items_of(value)] for value in args]
    for key, *_ in filter(None, pairs[0]):
        checked_key(key)
    return dict(*pairs, **kwargs)


def _sum(values: Value, start: Value = 0) -> Value:
    items = items_of(values)
    if any(isinstance(item, list | tuple) for item in (start, *items)):
        _refuse("the sum of lists")
    return sum(items, start)


def _round(number: Value, ndigits: Value = None) -> Value:
    if isinstance(ndigits, int) and abs(ndigits) > _MAX_DIGITS:
        _refuse("a number of digits of this size")
    return round(number, ndigits)


def _small(function: Callable[..., Value]) -> Callable[..., Value]:
    """Return a function of integers whose results grow fast, for small arguments only."""

    def bounded(*args: Value, **kwargs: Value) -> Value:
        parts = [part for value in args for part in (value if isinstance(value, list | tuple | range) else [value])]
        if len(parts) > _MAX_SMALL or any(isinstance(part, int) and abs(part) > _MAX_SMALL for part in parts):
            too_large("number")
        return function(*args, **kwargs)

    return bounded


def _range(*bounds: int) -> range:
    numbers = range(*bounds)
    if numbers[MAX_PARTS:]:
        too_large("range")
    return numbers


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "list": _of_items(list), "dict": make_dict, "str": lambda *args: str_of(*args) if args else "",
    "float": float, "int": int, "bool": bool, "len": len, "abs": abs, "ord": ord, "round": _round, "range": _range,
    "min": _largest(min), "max": _largest(max), "sorted": _of_items(sorted), "sum": _sum,
    **{
        name: _refuse_function(name)
        for name in ("all", "any", "complex", "divmod", "enumerate", "filter", "frozenset", "hash", "isinstance",
                     "issubclass", "map", "repr", "reversed", "set", "slice", "tuple", "type", "vars", "zip")
    },
}  # fmt: skip
BUILTINS: Mapping[str, ClosedFunction] = {name: ClosedFunction(name, function) for name, function in _FUNCTIONS.items()}
MATH: Mapping[str, Value] = {
    **{name: getattr(math, name) for name in ("pi", "e", "tau", "inf", "nan")},
    **{
        name: ClosedFunction(name, _small(value) if name in ("factorial", "comb", "perm", "prod", "lcm") else value)
        for name, value in vars(math).items()
        if callable(value) and not name.startswith("_")
    },
}
