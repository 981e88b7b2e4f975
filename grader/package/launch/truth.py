"""Texts that launch reads as true or false."""

from math import isclose

import yaml

from grader.package.launch.model import LaunchFails
from grader.static_python.parse import Position
from grader.static_python.values import Call, Unknown, Value

_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


def boolean(text: str, at: Position) -> bool:
    """Return the value of a text as launch reads it where it wants a boolean, by the rules of YAML."""
    found = _BOOLEANS.get(text) if text in ("0", "1") else _yaml_boolean(text)
    if found is None:
        raise LaunchFails(f"{text[:40]!r} is neither true nor false", at)
    return found


def _yaml_boolean(text: str) -> bool | None:
    try:
        found = yaml.safe_load(text) if len(text) < 20 else None
    except yaml.YAMLError:
        return None
    return found if isinstance(found, bool) else None


def condition(text: str, at: Position) -> bool:
    """Return the value of a text as a condition."""
    found = _BOOLEANS.get(text.strip().lower())
    if found is None:
        raise LaunchFails(f"a condition is {text[:40]!r}, expected true or false", at)
    return found


def are_equal(left: str, right: str) -> bool:
    """Return whether two texts are equal to launch: true equals True, and 1 equals 1.0."""
    values = [_BOOLEANS.get(text.lower()) for text in (left, right)]
    if None not in values:
        return values[0] == values[1]
    try:
        return isclose(float(left), float(right))
    except ValueError:
        return left == right


def operand(value: Value) -> Value:
    """Return an operand of EqualsSubstitution, which takes any value, as the text that it is compared as."""
    if isinstance(value, bool | None):
        return str(value).lower() if value is not None else ""
    is_text = isinstance(value, str | Call | Unknown) or (
        isinstance(value, list | tuple) and any(isinstance(it, Call) for it in value)
    )
    return value if is_text else str(value)
