"""Attributes and methods of the values of closed expressions: an allow-list of methods without effects, with bounded results."""

import re
import string
from collections.abc import Callable, Mapping

from grader.static_python.closed_values import (
    MAX_TEXT,
    PLAIN,
    DottedDict,
    ExpressionFails,
    Function,
    Namespace,
    Undetermined,
    Value,
    items_of,
    run,
    text_of,
    too_large,
)

_MAX_WIDTH = 1_000  # of a formatted value
_SPEC = re.compile(r"[^{}]?[<>=^]?[-+ ]?#?0?(\d{0,3})[,_]?(?:\.\d{1,3})?[a-zA-Z%]?")


def attribute(owner: Value, name: str) -> Value:
    """Return the value of an attribute: of a namespace, of a dict from YAML, or a method of a plain value."""
    if name.startswith("__"):
        raise ExpressionFails(f"names that begin with two underscores are not allowed: {name}")
    if isinstance(owner, Namespace):
        if hasattr(dict, name):  # a namespace of xacro is a dict
            raise Undetermined(f"the method {name} of a namespace is not supported")
        return owner.find(name)
    kind = next((kind for kind in _METHODS if isinstance(owner, kind)), None)
    if kind is not None and name in _METHODS[kind]:
        return Function(name, lambda *args, **kwargs: _call_method(owner, name, args, kwargs))
    if isinstance(owner, PLAIN) and hasattr(owner, name):
        raise Undetermined(f"the attribute {name} is not supported")
    if isinstance(owner, DottedDict) and name in owner:
        return owner[name]
    if isinstance(owner, PLAIN):
        raise ExpressionFails(f"{type(owner).__name__!r} has no attribute {name!r}")
    raise Undetermined(f"the attribute {name} of this value is not supported")


def format_value(value: Value, spec: str, conversion: str | None = None) -> str:
    """Return a value as f-strings and str.format write it."""
    if not _SPEC.fullmatch(spec):
        raise Undetermined("this format is not supported")
    text = text_of(value)
    if conversion in ("r", "a"):
        value = repr(value)
    elif conversion == "s":
        value = text
    return str(run(format, value, spec))


def _format(template: str, *args: Value, **kwargs: Value) -> str:
    """Return template.format(...), whose fields may only be arguments, not attributes or items of them."""
    pieces, automatic = [], 0
    for literal, field, spec, conversion in string.Formatter().parse(template):
        pieces.append(literal)
        if field is None:
            continue
        key = field or str(automatic)
        automatic += not field
        if not key.isalnum() or "{" in (spec or ""):
            raise Undetermined("this format is not supported")
        value = args[int(key)] if key.isdigit() else kwargs[key]
        pieces.append(format_value(value, spec or "", conversion))
    return "".join(pieces)


def _replace(text: str, old: str, new: str, *count: int) -> str:
    if len(text) + (text.count(old) if old else len(text) + 1) * len(new) > MAX_TEXT:
        too_large("text")
    return text.replace(old, new, *count)


def _join(separator: str, items: Value) -> str:
    parts = list(items_of(items))
    if sum(len(part) + len(separator) for part in parts if isinstance(part, str)) > MAX_TEXT:
        too_large("text")
    return separator.join(parts)


def _padded(name: str) -> Callable[..., str]:
    def pad(text: str, *args: Value) -> str:
        if any(isinstance(value, int) and value > _MAX_WIDTH for value in args):
            too_large("text")
        return str(getattr(text, name)(*args))

    return pad


def _call_method(owner: Value, name: str, args: tuple[Value, ...], kwargs: dict[str, Value]) -> Value:
    own = _OWN_METHODS.get(name) if isinstance(owner, str) else None
    return run(own, owner, *args, **kwargs) if own is not None else run(getattr(owner, name), *args, **kwargs)


_OWN_METHODS: Mapping[str, Callable[..., Value]] = {
    "format": _format, "replace": _replace, "join": _join,
    **{name: _padded(name) for name in ("center", "ljust", "rjust", "zfill", "expandtabs")},
}  # fmt: skip
_METHODS: Mapping[type, frozenset[str]] = {
    str: frozenset(
        ("capitalize", "casefold", "count", "endswith", "find", "index", "isalnum", "isalpha", "isascii", "isdecimal",
         "isdigit", "isidentifier", "islower", "isnumeric", "isspace", "istitle", "isupper", "lower", "lstrip", "partition",
         "removeprefix", "removesuffix", "rfind", "rindex", "rpartition", "rsplit", "rstrip", "split", "splitlines",
         "startswith", "strip", "swapcase", "title", "upper", *_OWN_METHODS)
    ),
    list: frozenset(("count", "index", "copy")),
    tuple: frozenset(("count", "index")),
    dict: frozenset(("get", "keys", "values", "items", "copy")),
    set: frozenset(
        ("copy", "difference", "intersection", "isdisjoint", "issubset", "issuperset", "symmetric_difference", "union")
    ),
    float: frozenset(("is_integer", "hex")),
    int: frozenset(("bit_length",)),
}  # fmt: skip
