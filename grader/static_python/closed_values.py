"""The functions, methods and operators that a closed expression may use, run by Python itself on values of bounded size."""

import ast
import math
import operator
import re
import string
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

Value = Any

MAX_TEXT = 100_000  # characters
MAX_ITEMS = 20_000  # of a value, with all that it contains
_MAX_BITS = 4_096  # of an integer
_MAX_WIDTH = 1_000  # of a formatted value
_MAX_SMALL = 200  # arguments of factorial and its like
_VIEWS: tuple[Any, ...] = (type({}.keys()), type({}.values()), type({}.items()))
_ITERATOR: Any = type(iter([]))
_CONTAINERS: tuple[Any, ...] = (list, tuple, set, frozenset, dict, *_VIEWS)
_NUMBERS = (float, int)
_PLAIN: tuple[Any, ...] = (str, int, float, complex, type(None), range, *_CONTAINERS)
_SPEC = re.compile(r"[^{}]?[<>=^]?[-+ ]?#?0?(\d{0,3})[,_]?(?:\.\d{1,3})?[a-zA-Z%]?")
_LONG_NUMBER = re.compile(r"[0-9]{4}")


class ExpressionFails(Exception):
    """Python certainly raises an error for this expression; the text is a sentence without its end."""


class Undetermined(Exception):
    """The value of an expression cannot be determined statically; the text says why."""


@dataclass(frozen=True, slots=True)
class Function:
    """A function that an expression may call."""

    name: str
    run: Callable[..., Value]


@dataclass(frozen=True, slots=True)
class Namespace:
    """Names that are reached with a dot: math.pi. `find` raises ExpressionFails for other names."""

    name: str
    find: Callable[[str], Value]


class DottedDict(dict[Value, Value]):
    """A dict whose items are also attributes, as xacro makes them of YAML."""


def check_size(value: Value) -> int:
    """Return how many parts a value has, each as often as it occurs; raise Undetermined if that is too many."""
    pending, count = [value], 0
    while pending:
        part = pending.pop()
        count += 1
        if isinstance(part, str):
            if len(part) > MAX_TEXT:
                _too_large("text")
            count += len(part) // 32
        elif isinstance(part, _CONTAINERS):
            if count + len(part) > MAX_ITEMS:
                _too_large("list")
            pending += [*part.keys(), *part.values()] if isinstance(part, dict) else part
        elif isinstance(part, int) and part.bit_length() > _MAX_BITS:
            _too_large("number")
        elif isinstance(part, range) and len(part) > MAX_ITEMS:
            _too_large("range")
        if count > MAX_ITEMS:
            _too_large("value")
    return count


def run(function: Callable[..., Value], *args: Value, **kwargs: Value) -> Value:
    """Return what a function of plain values returns; what it raises is ExpressionFails."""
    try:
        return function(*args, **kwargs)
    except (ExpressionFails, Undetermined, RecursionError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  whatever Python raises here, it raises for the student's expression
        raise ExpressionFails(f"{type(error).__name__}: {error}") from None


def operate(op: ast.operator, left: Value, right: Value) -> Value:
    """Return the value of a binary operator."""
    simple = _SIMPLE.get(type(op))
    if simple is not None and type(left) in _NUMBERS and type(right) in _NUMBERS:
        return run(simple, left, right)
    if not (isinstance(left, _PLAIN) and isinstance(right, _PLAIN)):
        raise Undetermined("this operation is not supported")
    match op, left, right:
        case ast.Pow(), int(), int() if right > 0 and left.bit_length() * right > _MAX_BITS:
            _too_large("number")
        case ast.LShift(), int(), int() if left.bit_length() + right > _MAX_BITS:
            _too_large("number")
        case ast.Mult(), (str() | list() | tuple()), int() if len(left) * right > MAX_ITEMS:
            _too_large("value")
        case ast.Mult(), int(), (str() | list() | tuple()) if len(right) * left > MAX_ITEMS:
            _too_large("value")
        case ast.Mod(), str(), _:
            return run(_percent_format, left, right)
    return run(_OPERATORS[type(op)], left, right)


def compare(op: ast.cmpop, left: Value, right: Value) -> bool:
    """Return the value of one comparison."""
    if not (isinstance(left, _PLAIN) and isinstance(right, _PLAIN)):
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
    if not isinstance(owner, _PLAIN):
        raise Undetermined("this index is not supported")
    return run(operator.getitem, owner, key)


def attribute(owner: Value, name: str) -> Value:
    """Return the value of an attribute: of a namespace, of a dict from YAML, or a method of a plain value."""
    if name.startswith("__"):
        raise ExpressionFails(f"names that begin with two underscores are not allowed: {name}")
    if isinstance(owner, Namespace):
        return owner.find(name)
    kind = next((kind for kind in _METHODS if isinstance(owner, kind)), None)
    if kind is not None and name in _METHODS[kind]:
        return Function(name, lambda *args, **kwargs: _call_method(owner, name, args, kwargs))
    if isinstance(owner, _PLAIN) and hasattr(owner, name):
        raise Undetermined(f"the attribute {name} is not supported")
    if isinstance(owner, DottedDict) and name in owner:
        return owner[name]
    if isinstance(owner, _PLAIN):
        raise ExpressionFails(f"{type(owner).__name__!r} has no attribute {name!r}")
    raise Undetermined(f"the attribute {name} of this value is not supported")


def items_of(value: Value) -> Iterator[Value]:
    """Return an iterator over what a loop over a value yields."""
    if isinstance(value, _ITERATOR):
        return value  # type: ignore[no-any-return]
    if isinstance(value, _PLAIN):
        check_size(value)
        return iter(list(run(iter, value)))
    raise Undetermined("this loop is not supported")


def text_of(value: Value) -> str:
    """Return str() of a value."""
    if not isinstance(value, _PLAIN):
        raise Undetermined("this value has no text")
    check_size(value)
    return str(value)


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


def _percent_format(template: str, value: Value) -> str:
    if "*" in template or _LONG_NUMBER.search(template):
        raise Undetermined("this format is not supported")
    check_size(value)
    return str(template % value)


def _replace(text: str, old: str, new: str, *count: int) -> str:
    if len(text) + (text.count(old) if old else len(text) + 1) * len(new) > MAX_TEXT:
        _too_large("text")
    return text.replace(old, new, *count)


def _join(separator: str, items: Value) -> str:
    parts = list(items_of(items))
    if sum(len(part) + len(separator) for part in parts if isinstance(part, str)) > MAX_TEXT:
        _too_large("text")
    return separator.join(parts)


def _padded(name: str) -> Callable[..., str]:
    def pad(text: str, width: int = 8, *fill: str) -> str:
        if isinstance(width, int) and width > _MAX_WIDTH:
            _too_large("text")
        return str(getattr(text, name)(width, *fill))

    return pad


def _call_method(owner: Value, name: str, args: tuple[Value, ...], kwargs: dict[str, Value]) -> Value:
    own = _OWN_METHODS.get(name) if isinstance(owner, str) else None
    return run(own, owner, *args, **kwargs) if own is not None else run(getattr(owner, name), *args, **kwargs)


def _too_large(what: str) -> NoReturn:
    raise Undetermined(f"a {what} grows too large")


def _small(function: Callable[..., Value]) -> Callable[..., Value]:
    """Return a function of integers whose results grow fast, for small arguments only."""

    def bounded(*args: Value, **kwargs: Value) -> Value:
        parts = [part for value in args for part in (items_of(value) if isinstance(value, _CONTAINERS) else [value])]
        if len(parts) > _MAX_SMALL or any(isinstance(part, int) and abs(part) > _MAX_SMALL for part in parts):
            _too_large("number")
        return function(*args, **kwargs)

    return bounded


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
_OWN_METHODS: Mapping[str, Callable[..., Value]] = {
    "format": _format, "replace": _replace, "join": _join,
    **{name: _padded(name) for name in ("center", "ljust", "rjust", "zfill")},
}  # fmt: skip
_METHODS: dict[type, frozenset[str]] = {
    str: frozenset(
        [
            "capitalize",
            "casefold",
            "count",
            "endswith",
            "find",
            "index",
            "isalnum",
            "isalpha",
            "isascii",
            "isdecimal",
            "isdigit",
            "isidentifier",
            "islower",
            "isnumeric",
            "isspace",
            "istitle",
            "isupper",
            "lower",
            "lstrip",
            "partition",
            "removeprefix",
            "removesuffix",
            "rfind",
            "rindex",
            "rpartition",
            "rsplit",
            "rstrip",
            "split",
            "splitlines",
            "startswith",
            "strip",
            "swapcase",
            "title",
            "upper",
            "format",
            "replace",
            "join",
            "center",
            "ljust",
            "rjust",
            "zfill",
        ]
    ),
    list: frozenset(("count", "index", "copy")),
    tuple: frozenset(("count", "index")),
    dict: frozenset(("get", "keys", "values", "items", "copy")),
    set: frozenset(
        ["copy", "difference", "intersection", "isdisjoint", "issubset", "issuperset", "symmetric_difference", "union"]
    ),
    float: frozenset(("is_integer", "hex")),
    int: frozenset(("bit_length",)),
}
MATH: Mapping[str, Value] = {
    **{name: getattr(math, name) for name in ("pi", "e", "tau", "inf", "nan")},
    **{
        name: Function(name, _small(value) if name in ("factorial", "comb", "perm", "prod", "lcm") else value)
        for name, value in vars(math).items()
        if callable(value) and not name.startswith("_")
    },
}
