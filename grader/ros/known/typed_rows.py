"""Tables of TOML as typed rows: each key is a field of the row, and each value has its type."""

from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, TypeVar, get_args, get_origin

import tomli

_Row = TypeVar("_Row")
_Reading = Callable[[Any], Any]


def read_row(kind: Callable[..., _Row], table: Mapping[str, Any]) -> _Row:
    """Return a table as a row of a named tuple.

    Raises ValueError for a key that is no field of it and a value of another type.

    Arrays become tuples. A frozenset of strings is written as words in one string.

    Examples:
        >>> from typing import NamedTuple
        >>> class Wheel(NamedTuple):
        ...     radius: float
        ...     joints: tuple[str, ...] = ()
        >>> read_row(Wheel, {"radius": 0.1, "joints": ["left"]})
        Wheel(radius=0.1, joints=('left',))
        >>> read_row(Wheel, {"raduis": 0.1})
        Traceback (most recent call last):
        ValueError: a Wheel has no 'raduis'
    """
    readings = _list_readings(kind)
    values = {}
    for key, value in table.items():
        if key not in readings:
            raise ValueError(f"a {getattr(kind, '__name__', kind)} has no {key!r}")
        try:
            values[key] = readings[key](value)
        except ValueError as error:
            raise ValueError(f"{key}: {error}") from None
    try:
        return kind(**values)
    except TypeError:
        raise ValueError(f"a {getattr(kind, '__name__', kind)} lacks a key") from None


def read_file(kind: Callable[..., _Row], name: str) -> _Row:
    """Return a file of this folder as a row. Raises ValueError."""
    text = Path(__file__).with_name(f"{name}.toml").read_text("utf-8")
    return read_row(kind, tomli.loads(text))


def read_typed(hint: Any, value: Any) -> Any:
    """Return a value of TOML as the type of an annotation has it. Raises ValueError."""
    return _choose_reading(hint)(value)


@cache
def _list_readings(kind: Callable[..., Any]) -> Mapping[str, _Reading]:
    return {name: _choose_reading(hint) for name, hint in kind.__annotations__.items()}


@cache
def _choose_reading(hint: Any) -> _Reading:
    """Return the function that reads values of a type."""
    origin = get_origin(hint)
    arguments = get_args(hint)
    if origin is UnionType:
        [hint] = [argument for argument in arguments if argument is not NoneType]
        return _choose_reading(hint)
    if origin in _COLLECTIONS:
        return _COLLECTIONS[origin](arguments)
    if hasattr(hint, "_fields"):
        return partial(read_row, hint)
    return partial(_read_plain, hint, arguments)


def _choose_items(arguments: Sequence[Any]) -> _Reading:
    read_item = _choose_reading(arguments[0])
    return lambda items: tuple(map(read_item, _checked(items, list)))


def _choose_words(_: Sequence[Any]) -> _Reading:
    return lambda words: frozenset(_checked(words, str).split())


def _choose_table(arguments: Sequence[Any]) -> _Reading:
    read_value = _choose_reading(arguments[1])
    return lambda table: {key: read_value(value) for key, value in _checked(table, dict).items()}


def _checked(value: Any, kind: type) -> Any:
    if not isinstance(value, kind):
        raise ValueError(f"{value!r} is no {kind.__name__}")  # noqa: TRY004  a value of a file
    return value


_COLLECTIONS = {
    tuple: _choose_items,
    frozenset: _choose_words,
    Mapping: _choose_table,
}


def _read_plain(hint: Any, words: tuple[Any, ...], value: Any) -> Any:
    """Return a value that is one of some words, or of a type, as it is."""
    if words:
        is_of_it = value in words
    else:
        is_of_it = hint is Any or type(value) in (hint, int if hint is float else hint)
    if not is_of_it:
        raise ValueError(f"{value!r} is no {hint}")
    return value
