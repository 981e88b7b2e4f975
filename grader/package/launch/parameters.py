"""The parameters of nodes, as launch_ros evaluates them before it starts a node: texts have the types of YAML."""

from collections.abc import Iterator
from pathlib import PurePosixPath
from typing import Any

import yaml

from grader.package.launch.model import Contents, Context, UnknownText
from grader.package.launch.substitutions import resolve
from grader.package.launch.value_types import FILE, SCALARS, TYPED, boolean, items_in, kind_of, type_of
from grader.python.parse import Position
from grader.python.values import Call, EvaluationFails, Undetermined, Unknown, Value

_MAX_YAML = 200_000  # characters
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def evaluate_parameters(parameters: Value, context: Context, at: Position) -> None:
    """Evaluate the parameters of a node, as launch_ros does first. Raises EvaluationSignal and Undetermined."""
    for item in items_in(parameters) or ():
        if isinstance(item, dict):
            evaluate_dict(item, context, at)
        elif isinstance(item, Call) and item.name in (*TYPED, FILE):
            raise Undetermined("a parameter of this kind is not evaluated", item.at)
        elif not isinstance(item, PurePosixPath):
            resolve(item, context, at)


def evaluate_dict(table: dict[Any, Value], context: Context, at: Position) -> None:
    """Evaluate a dict of parameters. Raises EvaluationSignal."""
    for key, value in table.items():
        name = resolve(list(key) if isinstance(key, tuple) else key, context, at)
        shown = name if isinstance(name, str) else "?"
        match value:
            case dict():
                evaluate_dict(value, context, at)
            case Call() if value.name in TYPED:
                _evaluate_typed(value, context)
            case UnknownText():
                resolve(value, context, at)
            case list() | tuple() | range():
                _evaluate_list(shown, list(value), context, at)
            case Call() | Unknown():
                _read_as_yaml(shown, value, context, at)


def _evaluate_list(name: str, items: list[Value], context: Context, at: Position) -> None:
    kinds = {type(item) for item in items if isinstance(item, SCALARS)}
    if any(isinstance(item, Call) for item in items) and all(isinstance(it, str | Call | Unknown) for it in items):
        _read_as_yaml(name, items, context, at)
    elif not items or not all(isinstance(item, SCALARS) for item in items):
        raise Undetermined(f"the value of the parameter {name!r} is not evaluated", at)
    elif len(kinds) > 1 and kinds != {int, float}:
        raise EvaluationFails(f"the parameter {name!r} is a list of values of different types", at)


def _is_uniform(values: list[Any]) -> bool:
    kind = type(values[0]) if values else None
    return kind in SCALARS and all(isinstance(value, kind) for value in values if kind)


def _yaml_of(name: str, value: Value, context: Context, at: Position) -> Any:
    """Return the value of a text as YAML. Raises EvaluationSignal."""
    found = resolve(value, context, at)
    if isinstance(found, Unknown):
        raise Undetermined(f"the value of the parameter {name!r} is not evaluated: {found.reason}", at)
    text = context.text_of(found.path) if isinstance(found, Contents) else found
    if text is None:
        return ""  # a file that is not there is reported for itself
    try:
        if len(text) > _MAX_YAML:
            raise Undetermined(f"the parameter {name!r} is too long to be read as YAML", at)
        return yaml.load(text or "''", Loader=_LOADER)  # noqa: S506  a safe loader
    except (yaml.YAMLError, ValueError, RecursionError):
        if isinstance(found, Contents) and found.by == "xacro":
            raise Undetermined(
                f"whether the output of xacro is YAML, as which {name!r} is read, is not evaluated", at
            ) from None
        hint = "write ParameterValue(..., value_type=str)"
        raise EvaluationFails(f"the parameter {name!r} is read as YAML, which fails: {hint}", at) from None


def _read_as_yaml(name: str, value: Value, context: Context, at: Position) -> None:
    found = _yaml_of(name, value, context, at)
    if isinstance(found, list) and _is_uniform(found):
        return
    if not isinstance(found, (*SCALARS, bytes)):
        hint = "write ParameterValue(..., value_type=str)"
        raise EvaluationFails(f"the parameter {name!r} is read as YAML, and is {kind_of(found)} then: {hint}", at)


def _evaluate_typed(call: Call, context: Context) -> None:
    value = call.kwargs["value"]
    if isinstance(value, UnknownText):
        resolve(value, context, call.at)
    if isinstance(value, (*SCALARS, UnknownText)) or (
        isinstance(value, list | tuple) and not any(isinstance(it, Call) for it in value)
    ):
        return
    try:
        kind = type_of(call)
    except Undetermined as error:
        raise Undetermined(f"{error} is not evaluated", call.at) from None
    if kind is None:
        _read_as_yaml("value", value, context, call.at)
        return
    text = resolve(value, context, call.at)
    if kind is str:
        return
    if not isinstance(text, str):
        raise Undetermined("the value of a parameter is not evaluated", call.at)
    try:
        boolean(text, call.at) if kind is bool else kind(text)
    except ValueError:
        raise EvaluationFails(f"the value {text[:40]!r} of a parameter is not {kind.__name__}", call.at) from None


def tables_in(parameters: Value) -> Iterator[dict[Any, Value]]:
    """Yield the dicts among the parameters of a node."""
    yield from (table for table in parameters if isinstance(table, dict)) if isinstance(parameters, list) else ()
