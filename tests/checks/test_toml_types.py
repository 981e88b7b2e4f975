"""The types of arguments: their names in messages, their JSON Schema, and the values that they convert or refuse."""

from collections.abc import Mapping
from decimal import Decimal
from typing import Any, Literal

import pytest

from grader.base.toml_types import (
    Colour,
    Content,
    Count,
    Direction,
    NonNegative,
    Scalar,
    Size,
    WrongValue,
    described,
    toml_type,
)

pytestmark = pytest.mark.slow

NUMBER, TEXT, WHOLE = {"type": "number"}, {"type": "string"}, {"type": "integer"}
SCALAR = {"anyOf": [TEXT, NUMBER, {"type": "boolean"}]}
CONTENT = {"anyOf": [*SCALAR["anyOf"], {"type": "array", "items": SCALAR, "minItems": 1}]}
TABLE = {"type": "object", "minProperties": 1}
THREE = {"type": "array", "items": NUMBER, "minItems": 3, "maxItems": 3}
ONE, HALF = Decimal(1), Decimal("0.5")
BOUNDED = {"type": "number", "minimum": 0, "maximum": 1}
# The name and the schema of a type, values with what they become, and values that it refuses.
TYPES: dict[Any, tuple[str, Any, list[tuple[Any, Any]], list[Any]]] = {
    float: ("a number", NUMBER, [(HALF, 0.5), (3, 3.0)], [True, "1", Decimal("NaN"), 10**400]),
    int: ("a whole number", WHOLE, [(3, 3)], [True, ONE, "3"]),
    bool: ("true or false", {"type": "boolean"}, [(True, True)], [1, "true"]),
    Literal["a", "b"]: ("one of a, b", {"enum": ["a", "b"]}, [("b", "b")], ["c", 1]),
    str | None: ("a string", TEXT, [("a", "a")], [1]),
    int | list[str]: (
        "a whole number or a list of strings",
        {"anyOf": [WHOLE, {"type": "array", "items": TEXT, "minItems": 1}]},
        [(2, 2), (["a"], ["a"])],
        ["a", [], [1]],
    ),
    list[int]: (
        "a list of values",
        {"type": "array", "items": WHOLE, "minItems": 1},
        [([1], [1])],
        [1, [], [ONE]],
    ),
    tuple[float, ...]: (
        "a list of numbers",
        {"type": "array", "items": NUMBER, "minItems": 1},
        [([1], (1.0,))],
        [[]],
    ),
    tuple[float, float, float]: (
        "3 numbers",
        THREE,
        [([1, 2, HALF], (1.0, 2.0, 0.5))],
        [[1, 2], [1, 2, 3, 4]],
    ),
    Mapping[str, str]: (
        "a table of strings",
        {**TABLE, "additionalProperties": TEXT},
        [({"a": "b"}, {"a": "b"})],
        [{}, []],
    ),
    Mapping[str, int]: (
        "a table of values",
        {**TABLE, "additionalProperties": WHOLE},
        [({"a": 1}, {"a": 1})],
        [{"a": "b"}],
    ),
    Mapping[str, Content]: (
        "a table of strings, numbers, booleans or lists of these",
        {**TABLE, "additionalProperties": CONTENT},
        [({"a": [1, "b"]}, {"a": [1.0, "b"]})],
        [{"a": []}],
    ),
    Mapping: (
        "a table of strings",
        {**TABLE, "additionalProperties": TEXT},
        [({"a": "b"}, {"a": "b"})],
        [{"a": 1}],
    ),
    list[Scalar]: (
        "a list of strings, numbers or booleans",
        {"type": "array", "items": SCALAR, "minItems": 1},
        [],
        [[[1]]],
    ),
    Colour: (
        "3 numbers or 4 numbers",
        {"anyOf": [THREE, THREE | {"minItems": 4, "maxItems": 4}], "items": BOUNDED},
        [([0, 1, HALF], (0.0, 1.0, 0.5))],
        [[1]],
    ),
}


@pytest.mark.parametrize(
    ("annotation", "expected"), TYPES.items(), ids=[row[0] for row in TYPES.values()]
)
def test_a_type(
    annotation: Any, expected: tuple[str, Any, list[tuple[Any, Any]], list[Any]]
) -> None:
    """A value of the type is converted, any other one is refused with the name of the type."""
    name, schema, values, refused = expected
    found = toml_type(annotation)
    assert (found.name, found.schema) == (name, schema)
    assert [found.parse(value) for value, _ in values] == [value for _, value in values]
    for value in refused:
        with pytest.raises(WrongValue) as caught:
            found.parse(value)
        assert str(caught.value) == name


@pytest.mark.parametrize(
    ("annotation", "fine", "wrong", "must_be"),
    [
        (NonNegative, 0, Decimal(-1), "at least 0"),
        (Count, 0, -1, "at least 0"),
        (Size, [0, 1, 2], [1, 2, Decimal(-1)], "at least 0 in each number"),
        (Direction, [0, 0, -1], [0, 0, 0], "a direction: not 0 in each number"),
        (Colour, [0, 1, 0, 1], [0, 0, 2], "from 0 to 1 in each number"),
    ],
)
def test_a_constraint(annotation: Any, fine: Any, wrong: Any, must_be: str) -> None:
    """A value of the type that does not meet the constraint is refused with what it must be."""
    toml_type(annotation).parse(fine)
    with pytest.raises(WrongValue) as caught:
        toml_type(annotation).parse(wrong)
    assert str(caught.value) == must_be


def test_a_description() -> None:
    """It is added to the schema, with other keywords; without a text only these."""
    assert described(toml_type(str), "A name.", default="a").schema == {
        **TEXT,
        "description": "A name.",
        "default": "a",
    }
    assert described(toml_type(str), "").schema == TEXT
