"""Python's built-in functions and those of math, as an expression may call them."""

import math
import re
from collections.abc import Callable, Iterator, Mapping
from types import FunctionType
from typing import Any

from grader.static_python.budget import Budget
from grader.static_python.values import (
    MAX_PARTS,
    OPAQUE,
    ExpressionFails,
    Items,
    PlainFunction,
    Undetermined,
    Value,
    call_plain,
    checked_key,
    items_of,
    iterate,
    known,
    reason_of,
    str_of,
    too_large,
)

_MAX_DIGITS = 400  # that round leaves
_OF_SIGNATURE = re.compile(r"positional argument|keyword argument|required keyword")
_MAX_SMALL = 200  # arguments of factorial and its like

# Calls a function value with arguments, for the functions that call others: map, filter, sorted.
Apply = Callable[[Value, list[Value]], Value]


def call(function: Value, args: list[Value], kwargs: dict[str, Value], budget: Budget, apply: Apply) -> Value:
    """Return what a call of a function of the allow-list returns."""
    if not isinstance(function, PlainFunction):
        budget.measure([args, list(kwargs.values())], "holds")
        return call_plain(function, *args, **kwargs) if not callable(function) else _refuse("this call")
    budget.measure([args, list(kwargs.values())], "holds" if function.kind == "applies" else function.kind)
    given = (apply, *args) if function.kind == "applies" else args
    try:
        return budget.checked(call_plain(function.run, *given, **kwargs), function.kind)
    except ExpressionFails as error:
        if isinstance(function.run, FunctionType) and _OF_SIGNATURE.search(str(error)):  # Python's own may have another
            _refuse(f"this use of {function.name}")
        raise


def _refuse(what: str) -> Value:
    raise Undetermined(f"{what} is not supported")


def _refuse_function(name: str) -> Callable[..., Value]:
    return lambda *_, **__: _refuse(f"the function {name}")


def _of_items(function: Callable[..., Value]) -> Callable[..., Value]:
    """Return a function whose first argument is a loop's items, as list takes it: known or not."""
    return lambda *args, **kwargs: function(*(list(iterate(value)) for value in args[:1]), *args[1:], **kwargs)


def make_dict(*args: Value, **kwargs: Value) -> Value:
    """Return dict() of values."""
    if not args or isinstance(args[0], dict):
        return dict(*args, **kwargs)
    pairs = [[list(iterate(pair)) for pair in iterate(value)] for value in args]
    for key, *_ in filter(None, pairs[0]):
        checked_key(known(key))
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


def _len(value: Value) -> int:
    if isinstance(value, Items):
        raise ExpressionFails("TypeError: an iterator (map, zip, reversed, a generator ...) has no len()")
    return len(value if not isinstance(value, OPAQUE) else known(value))


def _next(value: Value, *default: Value) -> Value:
    if not isinstance(value, Items):
        return next(known(value), *default)
    return next(value.iterator, *default)


def _reversed(value: Value) -> Items:
    return Items(reversed(value if not isinstance(value, OPAQUE) else known(value)))


def _map(apply: Apply, function: Value, first: Value, *lists: Value) -> Items:
    return Items(apply(function, list(items)) for items in zip(*map(iterate, (first, *lists)), strict=False))


def _filter(apply: Apply, function: Value, values: Value) -> Items:
    return Items(_kept(apply, function, iterate(values)))


def _kept(apply: Apply, function: Value, items: Iterator[Value]) -> Iterator[Value]:
    for item in items:
        if truth(item if function is None else apply(function, [item])):
            yield item


def truth(value: Value) -> bool:
    """Return whether a value counts as true. Raises Undetermined."""
    if isinstance(value, OPAQUE) and reason_of(value):
        known(value)
    return bool(call_plain(bool, value))


def _keyed(function: Callable[..., Value]) -> Callable[..., Value]:
    """Return sorted, min or max: of the items of a value, or of several values, by a key."""

    def by_key(apply: Apply, *args: Value, key: Value = None, **named: Value) -> Value:
        items = items_of(args[0]) if len(args) == 1 else list(args)
        known([*items, *named.values()])
        arguments = [items] if len(args) == 1 else items
        if key is None or (function is sorted and len(args) != 1):
            return function(*arguments, **named)
        keys = [known(apply(key, [item])) for item in items]
        order = function(range(len(items)), key=keys.__getitem__, **named)
        return [items[index] for index in order] if isinstance(order, list) else items[order]

    return by_key


_HOLDING: dict[str, Callable[..., Any]] = {
    "list": _of_items(list), "tuple": _of_items(tuple), "dict": make_dict, "len": _len, "next": _next,
    "bool": lambda *args: truth(*args) if args else False, "iter": lambda value: Items(iterate(value)),
    "enumerate": lambda value, start=0: Items(enumerate(iterate(value), known(start))),
    "zip": lambda *values: Items(zip(*map(iterate, values), strict=False)), "reversed": _reversed,
    "any": lambda values: any(map(truth, iterate(values))), "all": lambda values: all(map(truth, iterate(values))),
}  # fmt: skip
_APPLYING: dict[str, Callable[..., Any]] = {
    "map": _map, "filter": _filter, "sorted": _keyed(sorted), "min": _keyed(min), "max": _keyed(max),
}  # fmt: skip
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "float": float, "int": int, "abs": abs, "ord": ord, "round": _round, "range": _range, "sum": _sum,
    **{
        name: _refuse_function(name)
        for name in ("complex", "divmod", "frozenset", "hash", "isinstance", "issubclass", "repr", "set", "slice",
                     "type", "vars")
    },
}  # fmt: skip
BUILTINS: Mapping[str, PlainFunction] = {
    **{name: PlainFunction(name, function) for name, function in _FUNCTIONS.items()},
    **{name: PlainFunction(name, function, "holds") for name, function in _HOLDING.items()},
    **{name: PlainFunction(name, function, "applies") for name, function in _APPLYING.items()},
    "str": PlainFunction("str", lambda *args: str_of(*args) if args else "", "text"),
}
MATH: Mapping[str, Value] = {
    **{name: getattr(math, name) for name in ("pi", "e", "tau", "inf", "nan")},
    **{
        name: PlainFunction(name, _small(value) if name in ("factorial", "comb", "perm", "prod", "lcm") else value)
        for name, value in vars(math).items()
        if callable(value) and not name.startswith("_")
    },
}
