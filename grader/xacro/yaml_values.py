"""Values from a YAML file, as load_yaml of xacro returns them: plain values, numbers with units, nothing constructed."""

from collections.abc import Callable
from typing import Any

import yaml

from grader.static_python.closed_values import ExpressionFails, Undetermined, Value, check_size, run
from grader.xacro.functions import dotted

_MAX_EVENTS = 20_000
_MAX_DEPTH = 100
_MAX_MERGES = 20  # of mappings into each other with <<
_UNITS = {
    "!radians": 1.0, "!degrees": 3.141592653589793 / 180.0, "!meters": 1.0, "!millimeters": 0.001, "!foot": 0.3048,
    "!inches": 0.0254,
}  # fmt: skip


_BASE: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class _Loader(_BASE):  # type: ignore[misc]
    """PyYAML's safe loader with xacro's units, whose numbers are expressions that `number` evaluates."""

    number: Callable[[str], Value]


def _with_unit(loader: _Loader, node: yaml.ScalarNode) -> float:
    value: float = run(float, loader.number(str(loader.construct_scalar(node))))
    return value * _UNITS[node.tag]


for _unit in _UNITS:
    _Loader.add_constructor(_unit, _with_unit)


def _check_shape(text: str) -> None:
    """Raise Undetermined for a text that takes long to load: too many values, too deep, or merged too often."""
    depth = merges = 0
    for count, event in enumerate(yaml.parse(text, Loader=_BASE)):
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        merges += isinstance(event, yaml.ScalarEvent) and event.value == "<<"
        if count > _MAX_EVENTS or depth > _MAX_DEPTH or merges > _MAX_MERGES:
            raise Undetermined("the YAML file is too large")


def read_yaml_values(data: bytes, number: Callable[[str], Value]) -> Value:
    """Return the value of a YAML text. `number` evaluates an expression that has a unit, such as !degrees 90.

    Raises ExpressionFails for what is not YAML, Undetermined for what is too large.
    """
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        raise ExpressionFails("the YAML file is not UTF-8 text") from None
    try:
        _check_shape(text)
        loader = _Loader(text)
        loader.number = number
        value = loader.get_single_data()
    except (yaml.YAMLError, ValueError) as error:
        raise ExpressionFails(f"the file is not YAML: {' '.join(str(error).split())[:200]}") from None
    check_size(value)
    return dotted(value)
