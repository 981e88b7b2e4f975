"""The types of the values in a rubric: name, JSON Schema and conversion of each, made from Python annotations."""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from decimal import Decimal
from functools import lru_cache
from math import isfinite
from types import UnionType
from typing import Annotated, Any, Literal, get_args, get_origin

from grader.robot.transforms import Vector


class WrongValue(ValueError):
    """A value of another type or outside the constraints; the text says what it must be."""


@dataclass(frozen=True, slots=True)
class TomlType:
    """A type: its name for messages, its JSON Schema, and `parse`, which converts a TOML value or raises WrongValue."""

    name: str
    schema: Mapping[str, Any]
    parse: Callable[[Any], Any]


@dataclass(frozen=True, slots=True)
class Constraint:
    """What a value must be beyond its type, for `Annotated`: `must_be` ends the message "... must be", `schema` adds to it."""

    must_be: str
    holds: Callable[[Any], bool]
    schema: Mapping[str, Any] = field(default_factory=dict, hash=False)


AtLeastZero = Constraint("at least 0", lambda value: value >= 0)
EachAtLeastZero = Constraint("at least 0 in each number", lambda values: min(values) >= 0)
EachFromZeroToOne = Constraint("from 0 to 1 in each number", lambda values: min(values) >= 0 and max(values) <= 1)
NotZero = Constraint("a direction: not 0 in each number", any)

NonNegative = Annotated[float, AtLeastZero]
Size = Annotated[Vector, EachAtLeastZero]
Direction = Annotated[Vector, NotZero]
Colour = Annotated[tuple[float, float, float] | tuple[float, float, float, float], EachFromZeroToOne]


def _simple(name: str, schema: str, kind: type) -> TomlType:
    def parse(value: Any) -> Any:
        if isinstance(value, kind) and (kind is bool or not isinstance(value, bool)):
            return value
        raise WrongValue(name)

    return TomlType(name, {"type": schema}, parse)


def _parse_float(value: Any) -> float:
    if isinstance(value, int | Decimal) and not isinstance(value, bool):
        with suppress(OverflowError):
            number = float(value)
            if isfinite(number):
                return number
    raise WrongValue("a number")


_SIMPLE = {
    float: TomlType("a number", {"type": "number"}, _parse_float),
    int: _simple("a whole number", "integer", int),
    str: _simple("a text", "string", str),
    bool: _simple("true or false", "boolean", bool),
}
_PLURALS = {float: "numbers", str: "texts"}


@lru_cache(maxsize=256)
def toml_type(annotation: Any) -> TomlType:
    """Return the type for an annotation: str, float, int, bool, Literal, a union, list, tuple, Mapping, or Annotated."""
    inner = get_args(annotation)
    origin = get_origin(annotation)
    if annotation in _SIMPLE:
        return _SIMPLE[annotation]
    if origin is Annotated:
        return constrained(toml_type(inner[0]), *(item for item in inner[1:] if isinstance(item, Constraint)))
    if origin is Literal:
        return _choice(inner)
    if origin is UnionType:
        return _union([toml_type(member) for member in inner])
    if origin in (list, tuple):
        length = len(inner) if origin is tuple and Ellipsis not in inner else None
        return _sequence(toml_type(inner[0]), origin, length, _PLURALS.get(inner[0], "values"))
    return _mapping(toml_type(inner[1]) if len(inner) == 2 else _SIMPLE[str])


def constrained(base: TomlType, *constraints: Constraint) -> TomlType:
    """Return a type whose values also meet constraints."""

    def parse(value: Any) -> Any:
        parsed = base.parse(value)
        for constraint in constraints:
            if not constraint.holds(parsed):
                raise WrongValue(constraint.must_be)
        return parsed

    schema = dict(base.schema)
    for constraint in constraints:
        schema |= constraint.schema
    return TomlType(base.name, schema, parse)


def _choice(values: tuple[str, ...]) -> TomlType:
    name = f"one of {', '.join(values)}"

    def parse(value: Any) -> Any:
        if value in values:
            return value
        raise WrongValue(name)

    return TomlType(name, {"enum": list(values)}, parse)


def _union(members: list[TomlType]) -> TomlType:
    name = " or ".join(member.name for member in members)

    def parse(value: Any) -> Any:
        for member in members:
            with suppress(WrongValue):
                return member.parse(value)
        raise WrongValue(name)

    return TomlType(name, {"anyOf": [member.schema for member in members]}, parse)


def _sequence(item: TomlType, origin: type, length: int | None, plural: str) -> TomlType:
    name = f"a list of {plural}" if length is None else f"{length} {plural}"
    schema: dict[str, Any] = {"type": "array", "items": item.schema, "minItems": length or 1}
    if length is not None:
        schema["maxItems"] = length

    def parse(value: Any) -> Any:
        if not isinstance(value, list) or not value or length not in (None, len(value)):
            raise WrongValue(name)
        with suppress(WrongValue):
            return origin(item.parse(member) for member in value)
        raise WrongValue(name)

    return TomlType(name, schema, parse)


def _mapping(item: TomlType) -> TomlType:
    name = "a table of texts"
    schema = {"type": "object", "additionalProperties": item.schema, "minProperties": 1}

    def parse(value: Any) -> Any:
        if not isinstance(value, dict) or not value:
            raise WrongValue(name)
        with suppress(WrongValue):
            return {key: item.parse(member) for key, member in value.items()}
        raise WrongValue(name)

    return TomlType(name, schema, parse)
