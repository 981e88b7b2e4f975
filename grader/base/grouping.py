"""Parts of collections: values by a key, those that differ, the only one, the texts."""

from collections.abc import Collection, Iterable, Mapping
from typing import Any, TypeVar

Strings = tuple[str, ...]
StringsByName = Mapping[str, str]
Span = tuple[int, int]  # the offsets at which a part of a text begins and ends
_Key = TypeVar("_Key")
_Value = TypeVar("_Value")


def group_values(pairs: Iterable[tuple[_Key, _Value]]) -> dict[_Key, list[_Value]]:
    """Return the values of each key, in their order."""
    groups: dict[_Key, list[_Value]] = {}
    for key, value in pairs:
        groups.setdefault(key, []).append(value)
    return groups


def distinct(values: Iterable[_Value]) -> tuple[_Value, ...]:
    """Return values in their order, each once."""
    return tuple(dict.fromkeys(values))


def only_one(values: Collection[_Value]) -> _Value | None:
    """Return the value of a collection that has one; None of any other."""
    return next(iter(values)) if len(values) == 1 else None


def known_values(values: Mapping[_Key, _Value | None]) -> dict[_Key, _Value]:
    """Return the values that are not None, by their keys."""
    return {key: value for key, value in values.items() if value is not None}


def as_list(value: Any) -> list[Any]:
    """Return a list as it is, and another value as the only one of a list."""
    return value if isinstance(value, list) else [value]


def as_text(value: object) -> str | None:
    """Return a value that is a text; None of any other."""
    return value if isinstance(value, str) else None


def texts_among(values: Iterable[object]) -> list[str]:
    """Return those of some values that are texts."""
    return [value for value in values if isinstance(value, str)]


def are_texts(values: Iterable[object]) -> bool:
    """Return whether all of some values are texts."""
    return all(isinstance(value, str) for value in values)
