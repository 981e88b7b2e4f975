"""Python's built-in functions and those of math, as a closed expression may call them."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from grader.static_python.closed_values import (
    CONTAINERS,
    SETS,
    Function,
    Undetermined,
    Value,
    check_size,
    items_of,
    run,
    text_of,
    too_large,
)

_MAX_DIGITS = 400  # that round leaves
_MAX_SMALL = 200  # arguments of factorial and its like
_TYPES: Mapping[str, type] = {
    kind.__name__: kind for kind in (list, dict, str, float, int, bool, complex, set, frozenset, tuple, range)
}


def call(function: Value, args: list[Value], kwargs: dict[str, Value]) -> Value:
    """Return what a call of a function of the allow-list returns."""
    if not isinstance(function, Function):
        return run(function, *args, **kwargs) if not callable(function) else _refuse("this call")
    value = run(function.run, *args, **kwargs)
    check_size(value)
    return value


def _refuse(what: str) -> Value:
    raise Undetermined(f"{what} is not supported")


def _unsupported(name: str) -> Callable[..., Value]:
    return lambda *_, **__: _refuse(f"the function {name}")


def _items(value: Value) -> list[Value]:
    return list(items_of(value))


def _members(value: Value) -> Value:
    return value if isinstance(value, SETS) else _items(value)


def _of_items(function: Callable[..., Value]) -> Callable[..., Value]:
    """Return a function whose first argument is a loop's items, as list and sum take it."""
    return lambda *args, **kwargs: function(*map(_items, args[:1]), *args[1:], **kwargs)


def _with_key(function: Callable[..., Value]) -> Callable[..., Value]:
    """Return a function that takes the items of a value, or several values, and perhaps a key."""

    def keyed(*args: Value, key: Value = None, **kwargs: Value) -> Value:
        by = None if key is None else lambda item: call(key, [item], {})
        values = [(sorted if by is None and _is_sortable(args[0]) else _items)(args[0])] if len(args) == 1 else args
        return function(*values, key=by, **kwargs)

    return keyed


def _is_sortable(value: Value) -> bool:
    """Return whether a value is a set whose items have one order, whichever they are taken in."""
    return isinstance(value, SETS) and (
        all(isinstance(item, str) for item in value)
        or all(isinstance(item, int | float) and item == item for item in value)  # not NaN
    )


def make_dict(*args: Value, **kwargs: Value) -> Value:
    """Return dict() of values."""
    if args and not isinstance(args[0], dict):
        return dict(*([_items(pair) for pair in items_of(value)] for value in args), **kwargs)
    return dict(*args, **kwargs)


def _map(function: Value, *lists: Value) -> Value:
    return iter([call(function, list(items), {}) for items in zip(*map(_items, lists), strict=False)])


def _filter(function: Value, items: Value) -> Value:
    return iter([item for item in _items(items) if (item if function is None else call(function, [item], {}))])


def _isinstance(value: Value, kinds: Value) -> bool:
    named = [
        kind.name if isinstance(kind, Function) else "" for kind in (kinds if isinstance(kinds, tuple) else (kinds,))
    ]
    if not set(named) <= _TYPES.keys():
        _refuse("this use of isinstance")
    return isinstance(value, tuple(_TYPES[name] for name in named))


def _round(number: Value, *digits: Value) -> Value:
    if digits and isinstance(digits[0], int) and abs(digits[0]) > _MAX_DIGITS:
        _refuse("a number of digits of this size")
    return round(number, *digits)


def _small(function: Callable[..., Value]) -> Callable[..., Value]:
    """Return a function of integers whose results grow fast, for small arguments only."""

    def bounded(*args: Value, **kwargs: Value) -> Value:
        parts = [part for value in args for part in (items_of(value) if isinstance(value, CONTAINERS) else [value])]
        if len(parts) > _MAX_SMALL or any(isinstance(part, int) and abs(part) > _MAX_SMALL for part in parts):
            too_large("number")
        return function(*args, **kwargs)

    return bounded


def _range(*bounds: int) -> range:
    numbers = range(*bounds)
    check_size(numbers)
    return numbers


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "list": lambda *args: list(*map(_items, args)), "tuple": lambda *args: tuple(*map(_items, args)),
    "set": lambda *args: set(*map(_members, args)), "frozenset": lambda *args: frozenset(*map(_members, args)),
    "dict": make_dict, "str": lambda *args: text_of(*args) if args else "", "repr": lambda value: text_of([value])[1:-1],
    "float": float, "int": int, "bool": bool, "complex": complex, "len": len, "abs": abs, "round": _round, "ord": ord,
    "divmod": divmod, "range": _range, "min": _with_key(min), "max": _with_key(max), "sorted": _with_key(sorted),
    "sum": _of_items(sum), "all": _of_items(all), "any": _of_items(any), "map": _map, "filter": _filter,
    "zip": lambda *lists: iter(list(zip(*map(_items, lists), strict=False))),
    "enumerate": lambda items, start=0: iter(list(enumerate(_items(items), start))),
    "reversed": lambda items: iter(_items(items)[::-1]), "isinstance": _isinstance,
    **{name: _unsupported(name) for name in ("hash", "issubclass", "slice", "type", "vars")},
}  # fmt: skip
BUILTINS: Mapping[str, Function] = {name: Function(name, function) for name, function in _FUNCTIONS.items()}
MATH: Mapping[str, Value] = {
    **{name: getattr(math, name) for name in ("pi", "e", "tau", "inf", "nan")},
    **{
        name: Function(name, _small(value) if name in ("factorial", "comb", "perm", "prod", "lcm") else value)
        for name, value in vars(math).items()
        if callable(value) and not name.startswith("_")
    },
}
