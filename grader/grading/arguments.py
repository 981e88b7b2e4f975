"""The `with` table of a criterion against the signature of its check, which is its schema."""

from collections.abc import Mapping
from contextlib import suppress
from decimal import Decimal
from math import isfinite
from types import GenericAlias, UnionType
from typing import Any, Literal, get_args, get_origin

from grader.checks.registry import Check
from grader.names import did_you_mean

Fault = tuple[tuple[str, ...], str]


def bind(check: Check, given: Mapping[str, Any]) -> tuple[dict[str, Any], list[Fault]]:
    """The arguments for a check, and one fault for each that is unknown, missing or of another type."""
    arguments: dict[str, Any] = {}
    faults: list[Fault] = []
    for name, value in given.items():
        parameter = check.parameters.get(name)
        if parameter is None:
            known = [each for each in check.parameters if each not in given]
            guess = did_you_mean(name, known) or f"; it takes: {', '.join(check.parameters) or 'nothing'}"
            faults.append(((name,), f"the check {check.name} takes no {name!r}{guess}"))
            continue
        try:
            arguments[name] = convert(value, parameter.type)
            fault = _out_of_range(name, arguments[name])
            if fault:
                faults.append(((name,), f"{name} of {check.name} {fault}, not {_shown(value)}"))
        except TypeError:
            faults.append(
                ((name,), f"{name} of {check.name} must be {type_words(parameter.type)}, not {_shown(value)}")
            )
    for name, parameter in check.parameters.items():
        if parameter.required and name not in given:
            faults.append(((), f"the check {check.name} needs {name}: {type_words(parameter.type)}"))
    return arguments, faults


def convert(value: Any, wanted: Any) -> Any:
    """A TOML value as the Python value of an annotation; raises TypeError where it is another type."""
    if wanted is bool or wanted is str:
        if isinstance(value, wanted):
            return value
    elif wanted is float:
        if isinstance(value, int | Decimal) and not isinstance(value, bool):
            try:
                number = float(value)
            except OverflowError:
                raise TypeError from None
            if isfinite(number):
                return number
    elif wanted is int:
        if isinstance(value, int) and not isinstance(value, bool):
            return value
    elif get_origin(wanted) is Literal:
        if value in get_args(wanted):
            return value
    elif get_origin(wanted) is UnionType:
        for each in get_args(wanted):
            with suppress(TypeError):
                return convert(value, each)
    elif get_origin(wanted) in (list, tuple):
        return _convert_list(value, wanted)
    elif isinstance(value, dict) and value:
        return {key: convert(each, get_args(wanted)[1]) for key, each in value.items()}
    raise TypeError


def type_words(wanted: Any) -> str:
    """An annotation in words, for messages and listings."""
    words = {float: "a number", int: "a whole number", str: "a text", bool: "true or false"}
    if wanted in words:
        return words[wanted]
    inner = get_args(wanted)
    if get_origin(wanted) is Literal:
        return f"one of {', '.join(inner)}"
    if get_origin(wanted) is UnionType:
        return " or ".join(map(type_words, inner))
    if get_origin(wanted) is tuple and Ellipsis not in inner:
        return f"{len(inner)} numbers"
    kind = {float: "numbers", str: "texts"}
    if get_origin(wanted) in (list, tuple):
        return f"a list of {kind.get(inner[0], 'values')}"
    return "a table of texts"


def _convert_list(value: Any, wanted: GenericAlias) -> Any:
    inner = get_args(wanted)
    if not isinstance(value, list) or not value:
        raise TypeError
    if get_origin(wanted) is tuple and Ellipsis not in inner and len(inner) != len(value):
        raise TypeError
    made = [convert(each, inner[0]) for each in value]
    return tuple(made) if get_origin(wanted) is tuple else made


def _out_of_range(name: str, value: Any) -> str | None:
    """What is wrong with an argument that no robot could ever meet, told by its name."""
    match name:
        case "tolerance" | "angle" | "radius" | "length" if value < 0:
            return "must be at least 0"
        case "size" if min(value) < 0:
            return "must be at least 0 in each number"
        case "colour" if min(value) < 0 or max(value) > 1:
            return "must be from 0 to 1 in each number"
        case "axis" | "direction" | "forward" | "up" if not any(value):
            return "must have a direction"
        case _:
            return None


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_shown, value[:6]))}{', ...' if len(value) > 6 else ''}]"
    text = repr(value) if isinstance(value, str) else str(value)
    return text if len(text) <= 40 else text[:37] + "..."
