"""The values that launch and launch_ros take as texts and as parameters of nodes, and what is wrong with others."""

from collections.abc import Callable, Mapping
from pathlib import PurePosixPath
from typing import Any

import yaml

from grader.package.launch.api import ENTITY, SUBSTITUTION, class_named, is_a
from grader.package.launch.model import UnknownText
from grader.python.parse import Position
from grader.python.values import (
    VIEWS,
    Call,
    EvaluationFails,
    Function,
    Items,
    QualifiedName,
    Undetermined,
    Unknown,
    Value,
    iterate,
)

BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
SCALARS = (bool, int, float, str)
TYPED = ("launch_ros.parameter_descriptions.ParameterValue", "launch_ros.parameter_descriptions.Parameter")
FILE = "launch_ros.parameter_descriptions.ParameterFile"
# What is no text yet: the calls that give it, and what is missing.
OPENED = {
    "builtins.open": "an open file: add .read()", "xacro.process_file": "a document, not its text: add .toxml()",
    "xacro.parse": "a document, not its text: add .toxml()",
}  # fmt: skip
_COLLECTIONS: Any = (list, tuple, dict, set, frozenset, *VIEWS)
_NAMES = {
    type(None): "None", bool: "a boolean", int: "a number", float: "a number", dict: "a dict", Function: "a function",
}  # fmt: skip


def is_text(value: Value) -> bool:
    """Return whether a value is a string or a substitution. Raises Undetermined."""
    match value:
        case UnknownText():
            return True
        case Unknown():
            raise Undetermined(value.reason)
        case QualifiedName():
            raise Undetermined(f"the value of {value.name}")
        case Call() if class_named(value.name) is not None:
            return is_a(value.name, SUBSTITUTION)
        case Call() if value.name not in OPENED:
            raise Undetermined(f"the result of {value.name}")
    return isinstance(value, str)


def is_entity(call: Call) -> bool:
    """Return whether a call makes an action, or a description of some. Raises Undetermined."""
    if class_named(call.name) is None:
        raise Undetermined(f"the result of {call.name}")
    return is_a(call.name, ENTITY)


def items_in(value: Value) -> list[Value] | None:
    """Return what iterating over a value gives; None where Python cannot. Raises Undetermined."""
    if isinstance(value, Unknown):
        raise Undetermined(value.reason)
    if isinstance(value, Call) and class_named(value.name) is None:
        raise Undetermined(f"the result of {value.name}")
    if isinstance(value, Items):
        return list(iterate(value))
    kinds: Any = (*_COLLECTIONS, str, range)
    return list(value) if isinstance(value, kinds) else None


def wrong_text(value: Value) -> str:
    """Return what is wrong with a value that has to be a text, or nothing. Raises Undetermined."""
    if isinstance(value, _COLLECTIONS):
        wrong = next((item for item in value if not is_text(item)), "")
        return f"takes strings and substitutions, not {kind_of(wrong)} in a list" if wrong != "" else ""
    return "" if is_text(value) else "takes a string or a substitution"


def kind_of(value: Value) -> str:
    """Return what a value is, in words."""
    if isinstance(value, Call):
        return OPENED.get(value.name, f"{value.name.rpartition('.')[2]}(...)")
    if isinstance(value, PurePosixPath):
        return "a path: write str(...) around it"
    return _NAMES.get(type(value), f"a {type(value).__name__}")


def typed(kind: type) -> Callable[[Value], str]:
    """Return the check of a value of a type, or of a substitution whose text is read as one."""

    def checked(value: Value) -> str:
        if isinstance(value, str | int | float):
            return "" if isinstance(value, kind) else f"takes {_WANTED[kind]} or a substitution"
        if isinstance(value, list | tuple) and any(isinstance(item, Call | Unknown) for item in value):
            return wrong_text(value)
        return (
            "" if not isinstance(value, _COLLECTIONS) and is_text(value) else f"takes {_WANTED[kind]} or a substitution"
        )

    return checked


_WANTED = {bool: "True, False", float: "a decimal number such as 2.0", int: "an integer", str: "a string"}


def wrong_parameters(value: Value) -> str:
    """Return what is wrong with the parameters of a node, or nothing. Raises Undetermined."""
    if isinstance(value, Unknown):
        raise Undetermined(value.reason)
    if not isinstance(value, list):
        return "has to be a list: put [ ] around it"
    return next(filter(None, map(_wrong_item, value)), "")


def _wrong_item(item: Value) -> str:
    if isinstance(item, PurePosixPath) or (isinstance(item, Call) and item.name in (*TYPED, FILE)):
        return ""
    return _wrong_dict(item) if isinstance(item, dict) else wrong_text(item)


def _wrong_dict(table: dict[Any, Value]) -> str:
    return next(filter(None, (wrong_text(key) or wrong_parameter(value) for key, value in table.items())), "")


def wrong_parameter(value: Value) -> str:
    """Return what is wrong with the value of a parameter, or nothing. Raises Undetermined."""
    match value:
        case dict():
            return _wrong_dict(value)
        case str() | int() | float() | bytes():
            return ""
        case Call() if value.name in TYPED:
            return ""
        case list() | tuple() | range():
            items = [item for item in value if not isinstance(item, SCALARS)]
            return next(filter(None, map(wrong_text, items)), "")
    return "" if is_text(value) else f"has a value that is {kind_of(value)}"


def wrong_typed(call: Call) -> str:
    """Return what is wrong with the value of ParameterValue, or nothing. Raises Undetermined."""
    value, kind = call.kwargs["value"], type_of(call)
    if isinstance(value, UnknownText):
        return "" if kind in (None, str) else "the value is a text"
    if isinstance(value, SCALARS):
        return "" if kind is None or isinstance(value, kind) else f"the value is {kind_of(value)}, not {kind.__name__}"
    if isinstance(value, list | tuple) and not any(isinstance(it, Call | Unknown) for it in value):
        is_wrong = kind is not None or not all(isinstance(it, SCALARS) for it in value)
        return f"the value is {kind_of(value)}" if is_wrong else ""
    return wrong_text(value)


def type_of(call: Call) -> "type | None":
    """Return the type that ParameterValue is given; None for none. Raises Undetermined for the type of a list."""
    given = call.kwargs.get("value_type")
    if given is None:
        return None
    name = getattr(given, "name", "").removeprefix("builtins.")
    found = {kind.__name__: kind for kind in SCALARS}.get(name)
    if found is None:
        raise Undetermined(f"the type {name}")
    return found


def _texts(value: Value) -> str:
    items = items_in(value)
    return "has to be a list: put [ ] around it" if items is None else next(filter(None, map(wrong_text, items)), "")


def _mapping(value: Value) -> str:
    if not isinstance(value, dict):
        return "" if items_in(value) is None and isinstance(value, Unknown) else "has to be a dict"
    return next(filter(None, (wrong_text(item) for pair in value.items() for item in pair)), "")


def _period(value: Value) -> str:
    return "" if isinstance(value, str) else typed(float)(value)  # a string is read as a number


def _actions(value: Value) -> str:
    return "takes a list of actions: put [ ] around them" if items_in(value) is None else ""


def _remappings(value: Value) -> str:
    for rule in items_in(value) or []:
        if isinstance(rule, Unknown):
            raise Undetermined(rule.reason)
        if not isinstance(rule, tuple) or len(rule) != 2:
            return "takes pairs: ('from', 'to')"
        if wrong := wrong_text(rule[0]) or wrong_text(rule[1]):
            return wrong
    return "has to be a list: put [ ] around it" if items_in(value) is None else ""


CHECKS: Mapping[str, Callable[[Value], str]] = {
    "text": wrong_text, "texts": _texts, "mapping": _mapping, "bool": typed(bool), "float": _period,
    "remappings": _remappings, "actions": _actions, "parameters": wrong_parameters, "parameter": wrong_parameter,
}  # fmt: skip


def boolean(text: str, at: Position) -> bool:
    """Return the value of a text as launch reads it where it wants a boolean, by the rules of YAML."""
    try:
        found = BOOLEANS[text] if text in ("0", "1") else yaml.safe_load(text) if len(text) < 20 else None
    except yaml.YAMLError:
        found = None
    if not isinstance(found, bool):
        raise EvaluationFails(f"{text[:40]!r} is neither true nor false", at)
    return found
