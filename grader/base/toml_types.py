"""The types of values in a TOML file, made from Python annotations.

Each has a name, a JSON Schema and a conversion.
"""

from collections.abc import Callable, Mapping
from contextlib import suppress
from decimal import Decimal
from functools import lru_cache, partial
from math import isfinite
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from grader.base.records import Named
from grader.base.transforms import Vector


class WrongValue(ValueError):
    """A value of another type or outside the constraints; the text says what it must be."""


class TomlType(Named):
    """A type of values: its name for messages, its JSON Schema and its conversion.

    `parse` converts a TOML value or raises WrongValue.
    """

    name: str
    schema: Mapping[str, Any]
    parse: Callable[[Any], Any]


class Constraint(Named):
    """A constraint for `Annotated`.

    `must_be` ends the message "... must be", `schema` adds to the type's schema.
    """

    must_be: str
    holds: Callable[[Any], bool]
    schema: Mapping[str, Any] = {}

    def __hash__(self) -> int:
        return hash((self.must_be, self.holds))


_AtLeastZero = Constraint("at least 0", lambda value: value >= 0, {"minimum": 0})
_EachAtLeastZero = Constraint(
    "at least 0 in each number",
    lambda values: min(values) >= 0,
    {"items": {"type": "number", "minimum": 0}},
)
_EachFromZeroToOne = Constraint(
    "from 0 to 1 in each number",
    lambda values: min(values) >= 0 and max(values) <= 1,
    {"items": {"type": "number", "minimum": 0, "maximum": 1}},
)
_NotZero = Constraint("a direction: not 0 in each number", any, {"contains": {"not": {"const": 0}}})

NonNegative = Annotated[float, _AtLeastZero]
Count = Annotated[int, _AtLeastZero]
Size = Annotated[Vector, _EachAtLeastZero]
RadiusAndLength = Annotated[tuple[float, float], _EachAtLeastZero]
Direction = Annotated[Vector, _NotZero]
Colour = Annotated[
    tuple[float, float, float] | tuple[float, float, float, float], _EachFromZeroToOne
]

Scalar = str | float | bool
Content = Scalar | list[Scalar]


def simple_type(
    name: str,
    schema: Mapping[str, Any],
    accepts: Callable[[Any], bool],
    convert: Callable[[Any], Any] = lambda value: value,
) -> TomlType:
    """Return a type whose values `accepts` recognises and `convert` converts.

    A value for which `convert` raises WrongValue does not belong to it.
    """

    def parse(value: Any) -> Any:
        if accepts(value):
            with suppress(WrongValue):
                return convert(value)
        raise WrongValue(name)

    return TomlType(name, schema, parse)


def _is_integer(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_float(value: Any) -> bool:
    with suppress(OverflowError):
        return (isinstance(value, Decimal) or _is_integer(value)) and isfinite(float(value))
    return False


_SIMPLE = {
    float: simple_type("a number", {"type": "number"}, _is_float, float),
    int: simple_type("a whole number", {"type": "integer"}, _is_integer),
    str: simple_type("a string", {"type": "string"}, lambda value: isinstance(value, str)),
    bool: simple_type("true or false", {"type": "boolean"}, lambda value: isinstance(value, bool)),
}
_PLURALS = {
    float: "numbers",
    str: "strings",
    Scalar: "strings, numbers or booleans",
    Content: "strings, numbers, booleans or lists of these",
}


@lru_cache(maxsize=256)
def toml_type(annotation: Any) -> TomlType:
    """Return the type for an annotation.

    The annotation is str, float, int, bool, Literal, a union, list, tuple, Mapping, or Annotated.
    """
    inner = get_args(annotation)
    origin = get_origin(annotation)
    if annotation in _SIMPLE:
        return _SIMPLE[annotation]
    if origin is Annotated:
        return constrained(
            toml_type(inner[0]), *(item for item in inner[1:] if isinstance(item, Constraint))
        )
    if origin is Literal:
        return simple_type(
            f"one of {', '.join(inner)}", {"enum": list(inner)}, lambda value: value in inner
        )
    if origin in (UnionType, Union):
        return _union_type(
            [toml_type(member) for member in inner if member is not NoneType]
        )  # None: the argument is absent
    if origin in (list, tuple):
        length = len(inner) if origin is tuple and Ellipsis not in inner else None
        return _sequence_type(toml_type(inner[0]), origin, length, _PLURALS.get(inner[0], "values"))
    return _table_type(inner)


def _union_type(members: "list[TomlType]") -> TomlType:
    if len(members) == 1:
        return members[0]
    name = " or ".join(member.name for member in members)
    choices = {"anyOf": [member.schema for member in members]}
    return simple_type(name, choices, lambda _: True, partial(_parse_any, members))


def _table_type(inner: tuple[Any, ...]) -> TomlType:
    item, plural = (
        (toml_type(inner[1]), _PLURALS.get(inner[1], "values"))
        if len(inner) == 2
        else (_SIMPLE[str], "strings")
    )
    schema = {"type": "object", "additionalProperties": item.schema, "minProperties": 1}
    return simple_type(
        f"a table of {plural}",
        schema,
        _is_table,
        lambda table: {key: item.parse(table[key]) for key in table},
    )


def described(base: TomlType, description: str, **keywords: Any) -> TomlType:
    """Return a type whose JSON Schema says what the value means.

    Without a description, only the keywords are added.
    """
    text = {"description": description} if description else {}
    return base._replace(schema={**base.schema, **text, **keywords})


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


def _parse_any(members: list[TomlType], value: Any) -> Any:
    for member in members:
        with suppress(WrongValue):
            return member.parse(value)
    raise WrongValue


def _is_table(value: Any) -> bool:
    return isinstance(value, dict) and value != {}


def _sequence_type(item: TomlType, origin: type, length: int | None, plural: str) -> TomlType:
    schema = {"type": "array", "items": item.schema, "minItems": length or 1}
    if length is not None:
        schema["maxItems"] = length

    def accepts(value: Any) -> bool:
        return isinstance(value, list) and value != [] and length in (None, len(value))

    name = f"a list of {plural}" if length is None else f"{length} {plural}"
    return simple_type(name, schema, accepts, lambda value: origin(map(item.parse, value)))
