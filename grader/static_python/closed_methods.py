"""Attributes and methods of the values of closed expressions: an allow-list of methods without effects, with bounded results."""

import re
from collections.abc import Callable, Mapping

from grader.static_python.closed_values import (
    MAX_TEXT,
    PLAIN,
    Budget,
    DottedDict,
    ExpressionFails,
    Function,
    Items,
    Namespace,
    Undetermined,
    Value,
    items_of,
    run,
    text_of,
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
        return Function(name, lambda *args, **kwargs: _call(methods[name], owner, args, kwargs, budget))
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
    return run(method, owner, *args, **kwargs)


def search_cost(text: Value, part: Value) -> int:
    """Return how many characters a search for one text in another looks at, at most."""
    return len(text) * len(part) // 16 if isinstance(text, str) and isinstance(part, str) else 0


def percent_format(template: str, value: Value) -> str:
    """Return template % value."""
    if _WIDE.search(template):
        raise Undetermined("this format is not supported")
    text_of(value)
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
            for name in ("capitalize", "count", "endswith", "find", "index", "isdigit", "lower", "lstrip", "rsplit", "rstrip",
                         "split", "startswith", "strip", "title", "upper")
        },
    },
    dict: {"get": dict.get, "keys": _view(dict.keys), "values": _view(dict.values), "items": _view(dict.items)},
}  # fmt: skip
