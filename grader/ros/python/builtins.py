"""Python's built-in functions and those of math, as an expression may call them."""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from grader.base.grouping import texts_among
from grader.base.patterns import on_use
from grader.ros.known.python_names import python_names
from grader.ros.python.budget import Budget
from grader.ros.python.values import (
    MAX_PARTS,
    OPAQUE,
    PLAIN,
    EvaluationFails,
    Items,
    PlainFunction,
    Undetermined,
    Value,
    call_plain,
    charge_str,
    checked_key,
    explain_unknown,
    is_object,
    iterate,
    known,
    list_items,
    too_large,
)

_Function = Callable[..., Value]

_MAX_DIGITS = 400  # that round leaves
_OF_SIGNATURE = on_use(r"positional argument|keyword argument|required keyword")
# What takes the arguments that Python's own function takes, and no others.
_SAME_ARGUMENTS = (
    "list",
    "tuple",
    "len",
    "reversed",
    "enumerate",
    "any",
    "all",
    "join",
    "index",
    "count",
    "copy",
    "get",
    "replace",
    "with_name",
    "with_suffix",
)
_OF_ANY_LETTERS = ("bool", "print")  # whatever the letters of a text are
_ABOVE = frozenset(  # what may be above a path
    {f"os.path.{name}" for name in ("dirname", "normpath", "abspath", "realpath")}
    | {"pathlib.Path.resolve", "pathlib.Path.absolute"}
)
# Of math: what grows fast, and what is newer than the oldest Python that runs the grader.
_NOT_EVALUATED = ("factorial", "comb", "perm", "prod", "lcm", "sumprod", "fma")

# Calls a function value with arguments, for the functions that call others: map, filter, sorted.
_Apply = Callable[[Value, list[Value]], Value]


def call(
    function: Value,
    args: list[Value],
    kwargs: dict[str, Value],
    budget: Budget,
    apply: _Apply,
) -> Value:
    """Return what a call of a function of the allow-list returns."""
    if not isinstance(function, PlainFunction):
        budget.measure([args, list(kwargs.values())], "holds")
        if not callable(function):
            return call_plain(function, *args, **kwargs)
        return _refuse("this call")
    budget.measure(
        [args, list(kwargs.values())], "holds" if function.kind == "applies" else function.kind
    )
    if function.kind in ("holds", "applies") and function.name not in _OF_ANY_LETTERS:
        budget.measure(texts_among(args))
    given = (apply, *args) if function.kind == "applies" else args
    try:
        result = budget.checked(call_plain(function.run, *given, **kwargs), function.kind)
    except EvaluationFails as error:
        if function.kind == "plain" or not _OF_SIGNATURE.search(str(error)):
            raise
        if function.name not in _SAME_ARGUMENTS:
            _refuse(f"this use of {function.name}")
        message = f"TypeError: {function.name}() takes other arguments"
        raise EvaluationFails(message) from None
    if function.kind == "path" and (function.name in _ABOVE or str(result).startswith("..")):
        _require_below(result, args, budget)
    return result


def _require_below(path: Value, given: list[Value], budget: Budget) -> None:
    if not all(budget.is_below(value, path) for value in given):
        raise Undetermined("what is above a folder that is not known is not known")


def _refuse(what: str) -> Value:
    raise Undetermined(f"{what} is not supported")


def _refuse_function(name: str) -> _Function:
    return lambda *_, **__: _refuse(f"the function {name}")


def _taking_items(function: _Function) -> _Function:
    """Return a function whose first argument is a loop's items, as list takes it: known or not."""
    return lambda *args, **kwargs: function(
        *(list(iterate(value)) for value in args[:1]), *args[1:], **kwargs
    )


def make_dict(*args: Value, **kwargs: Value) -> Value:
    """Return dict() of values."""
    if not args or isinstance(args[0], dict):
        return dict(*args, **kwargs)
    pairs = [list(map(list, map(iterate, iterate(value)))) for value in args]
    for key, *_ in filter(None, pairs[0]):
        checked_key(known(key))
    return dict(*pairs, **kwargs)


def _sum(values: Value, start: Value = 0) -> Value:
    items = list_items(values)
    if any(isinstance(item, list | tuple) for item in (start, *items)):
        _refuse("the sum of lists")
    total = sum((), start)
    lost = 0.0
    for item in items:
        before = total
        total = total + item
        if isinstance(before, float) and isinstance(item, float):
            large, small = sorted((before, item), key=abs, reverse=True)
            lost += large - total + small
    return total + lost if lost and math.isfinite(lost) else total


def _round(number: Value, ndigits: Value = None) -> Value:
    if isinstance(ndigits, int) and abs(ndigits) > _MAX_DIGITS:
        _refuse("a number of digits of this size")
    return round(number, ndigits)


def _range(*bounds: int) -> range:
    numbers = range(*bounds)
    if numbers[MAX_PARTS:]:
        too_large("range")
    return numbers


def _sized(value: Value) -> Value:
    if isinstance(value, (*PLAIN, Items)):
        return value
    return known(value)


def _next(value: Value, *default: Value) -> Value:
    try:
        return next(value.iterator if isinstance(value, Items) else known(value), *default)
    except StopIteration:
        return _refuse("the end of an iterator")


def _map(apply: _Apply, function: Value, first: Value, *lists: Value) -> Items:
    return Items(
        apply(function, list(items)) for items in zip(*map(iterate, (first, *lists)), strict=False)
    )


def _filter(apply: _Apply, function: Value, values: Value) -> Items:
    return Items(_kept(apply, function, iterate(values)))


def _kept(apply: _Apply, function: Value, items: Iterator[Value]) -> Iterator[Value]:
    for item in items:
        if truth(item if function is None else apply(function, [item])):
            yield item


def truth(value: Value) -> bool:
    """Return whether a value counts as true. Raises Undetermined."""
    if is_object(value):
        return True
    if isinstance(value, OPAQUE) and explain_unknown(value):
        known(value)
    return bool(call_plain(bool, value))


def _taking_known_items(function: _Function) -> _Function:
    """Return sorted, min or max: of the items of a value, or of several values."""

    def of_known(*args: Value, **named: Value) -> Value:
        if "key" in named:
            _refuse("a key of sorted, min or max")
        items = list_items(args[0]) if len(args) == 1 else list(args)
        known([*items, *named.values()])
        return function(*([items] if len(args) == 1 else items), **named)

    return of_known


_HOLDING: dict[str, Callable[..., Any]] = {
    "list": _taking_items(list),
    "tuple": _taking_items(tuple),
    "dict": make_dict,
    "next": _next,
    "len": lambda value: len(_sized(value)),
    "reversed": lambda value: Items(reversed(_sized(value))),
    "bool": lambda *args: truth(*args) if args else False,
    "iter": lambda value: Items(iterate(value)),
    "enumerate": lambda iterable, start=0: Items(enumerate(iterate(iterable), known(start))),
    "zip": lambda *values: Items(zip(*map(iterate, values), strict=False)),
    "any": lambda items: any(map(truth, iterate(items))),
    "all": lambda items: all(map(truth, iterate(items))),
}
_APPLYING: dict[str, Callable[..., Any]] = {"map": _map, "filter": _filter}
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "float": float,
    "int": int,
    "abs": abs,
    "sorted": _taking_known_items(sorted),
    "min": _taking_known_items(min),
    "max": _taking_known_items(max),
    "ord": ord,
    "round": _round,
    "range": _range,
    "sum": _sum,
    **{
        name: _refuse_function(name)
        for name in (
            "complex",
            "divmod",
            "frozenset",
            "hash",
            "isinstance",
            "issubclass",
            "repr",
            "set",
            "slice",
            "type",
            "vars",
        )
    },
}
BUILTINS: Mapping[str, PlainFunction] = {
    **{
        name: PlainFunction(name, function, kind)
        for kind, table in (("plain", _FUNCTIONS), ("holds", _HOLDING), ("applies", _APPLYING))
        for name, function in table.items()
    },
    "str": PlainFunction("str", lambda *args: charge_str(*args) if args else "", "text"),
}


def _math_value(name: str) -> Value:
    value = _refuse_function(name) if name in _NOT_EVALUATED else getattr(math, name)
    return PlainFunction(name, value) if callable(value) else value


MATH: Mapping[str, Value] = {
    name: _math_value(name) for name in sorted(python_names("math", ("jazzy", "lyrical")))
}
