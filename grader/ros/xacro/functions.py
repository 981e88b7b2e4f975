"""The names that every xacro expression knows.

They are Python's functions, math, and the namespaces python, math and xacro.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import yaml

from grader.base.patterns import on_use
from grader.ros.python.budget import Budget
from grader.ros.python.builtins import BUILTINS, MATH, make_dict
from grader.ros.python.expressions import evaluate
from grader.ros.python.values import (
    DottedDict,
    EvaluationFails,
    Namespace,
    PlainFunction,
    Undetermined,
    Value,
    call_plain,
    charge_str,
    checked_key,
)

_OLD_BUILTINS = ("list", "dict", "map", "len", "str", "float", "int", "bool", "min", "max", "round")
_NOT_IN_XACRO = ("iter", "next")
_PLAIN_SEPARATORS = on_use(r"[^\]\[\\^-]+")
_OF_EVENT = 10  # what a part of the file is charged
_MAX_NUMBER = 100  # characters
_UNITS = {
    "!radians": 1.0,
    "!degrees": 3.141592653589793 / 180.0,
    "!meters": 1.0,
    "!millimeters": 0.001,
    "!foot": 0.3048,
    "!inches": 0.0254,
}
_WORDS = {"true": True, "yes": True, "on": True, "false": False, "no": False, "off": False}
_INTEGER = on_use(r"[-+]?(?:0|[1-9][0-9]*|0x[0-9a-fA-F]+)")
_SPECIAL = {".nan": "nan", ".inf": "inf", "+.inf": "inf", "-.inf": "-inf"}
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_RESOLVER: Any = yaml.resolver.Resolver()


def namespace(name: str, names: Mapping[str, Value]) -> Namespace:
    """Return a namespace with these names."""

    def find(wanted: str) -> Value:
        if wanted not in names:
            raise EvaluationFails(f"name {name}.{wanted} is not defined")
        return names[wanted]

    return Namespace(name, find)


def _dotify(value: Value) -> Value:
    return _dot(call_plain(make_dict, value))


def _dot(value: Value) -> Value:
    if isinstance(value, dict):
        return DottedDict({key: _dot(item) for key, item in value.items()})
    if isinstance(value, list):
        return [_dot(item) for item in value]
    return value


def document_functions(
    load_yaml: Callable[[Value], Value],
    argument: Callable[[str], str],
    note: Callable[[str], object],
) -> dict[str, Value]:
    """Return the functions that need the document.

    These are those of the namespace xacro, and the old ones outside of it.

    `note` is called with the full name of each function that writes to stderr when it is called.
    """
    functions = {
        **_XACRO,
        "load_yaml": PlainFunction("load_yaml", load_yaml),
        "arg": PlainFunction("arg", argument),
    }
    old = {name: functions[name] for name in ("load_yaml", "abs_filename", "dotify")}
    old |= {name: BUILTINS[name] for name in ("sorted", "range")}
    functions |= {name: _noted(f"xacro.{name}", functions[name], note) for name in _MESSAGES}
    return {
        "xacro": namespace("xacro", functions),
        **{name: _noted(name, function, note) for name, function in old.items()},
    }


def _noted(name: str, function: PlainFunction, note: Callable[[str], object]) -> PlainFunction:
    """Return a function that notes each call of itself."""

    def run(*args: Value, **kwargs: Value) -> Value:
        note(name)
        return function.run(*args, **kwargs)

    return PlainFunction(function.name, run, function.kind)


def _tokenize(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:
    if not _PLAIN_SEPARATORS.fullmatch(sep):
        raise Undetermined("tokenize with these separators is not supported")
    parts = re.split(f"[{sep}]", text)
    if skip_empty:
        return [part for part in parts if part]
    return parts


def _fatal(*parts: Value) -> Value:
    raise EvaluationFails(" ".join(map(charge_str, parts)))


def _no_path(*_: Value) -> Value:
    raise Undetermined("an absolute path is known only at run time")


_MESSAGES = ("message", "warning", "error", "print_location")
_XACRO = {
    **{name: PlainFunction(name, lambda *_, **__: "") for name in _MESSAGES},
    "fatal": PlainFunction("fatal", _fatal),
    "tokenize": PlainFunction("tokenize", _tokenize),
    "dotify": PlainFunction("dotify", _dotify),
    "abs_filename": PlainFunction("abs_filename", _no_path),
}
_PYTHON = {name: value for name, value in BUILTINS.items() if name not in _NOT_IN_XACRO}
GLOBALS: Mapping[str, Value] = {
    **MATH,
    **{name: BUILTINS[name] for name in _OLD_BUILTINS},
    "python": namespace("python", _PYTHON),
    "math": namespace("math", MATH),
}


def read_yaml_values(data: bytes, find: Callable[[str], Value], budget: Budget) -> Value:
    """Return the value of a YAML text.

    `find` returns the value of a name in an expression with a unit: !radians pi/2.

    Raises EvaluationFails for what is not YAML, Undetermined for what is too large or rarely used.
    """
    budget.charge(1, len(data))
    try:
        events = yaml.parse(data.decode("utf-8"), _LOADER)
        values = list(_Values(events, find, budget).items(yaml.StreamEndEvent))
    except UnicodeDecodeError:
        raise EvaluationFails("the YAML file is not UTF-8 text") from None
    except (yaml.YAMLError, ValueError) as error:
        raise EvaluationFails(
            f"the file is not YAML: {' '.join(str(error).split())[:200]}"
        ) from None
    except RecursionError:
        raise Undetermined("the YAML file is nested too deeply") from None
    if len(values) > 1:
        raise EvaluationFails("the file is not YAML: it has more than one document")
    return budget.checked(values[0]) if values else None


class _Values:
    def __init__(self, events: Iterator[Any], find: Callable[[str], Value], budget: Budget) -> None:
        self._events = events
        self._find = find
        self._budget = budget
        self._anchors: dict[str, Value] = {}

    def items(self, end: type) -> Iterator[Value]:
        """Yield the values up to the end of a collection, or of all documents."""
        for event in self._events:
            if isinstance(event, end):
                return
            if isinstance(event, yaml.NodeEvent):
                yield self._value(event)

    def _value(self, event: Any) -> Value:
        self._budget.charge(_OF_EVENT)
        if isinstance(event, yaml.AliasEvent):
            if event.anchor not in self._anchors:
                raise Undetermined(f"the alias {event.anchor} has no value, or contains itself")
            return self._budget.checked(self._anchors[event.anchor])
        if event.anchor in self._anchors or (
            event.tag in _UNITS and not isinstance(event, yaml.ScalarEvent)
        ):
            raise EvaluationFails(
                f"the file is not YAML: {event.anchor or event.tag} is used twice, or not "
                "of a number"
            )
        if event.tag not in (None, "!", *_UNITS):
            raise Undetermined(f"the YAML tag {event.tag} is not supported")
        if isinstance(event, yaml.MappingStartEvent):
            items = self.items(yaml.MappingEndEvent)
            value: Value = DottedDict((checked_key(key), next(items)) for key in items)
        else:
            is_list = isinstance(event, yaml.SequenceStartEvent)
            value = list(self.items(yaml.SequenceEndEvent)) if is_list else self._scalar(event)
        if event.anchor is not None:
            self._anchors[event.anchor] = value
        return value

    def _scalar(self, event: Any) -> Value:
        text = event.value
        if event.tag in _UNITS:
            return call_plain(float, evaluate(text, self._find, self._budget)) * _UNITS[event.tag]
        match _RESOLVER.resolve(yaml.ScalarNode, text[:_MAX_NUMBER], event.implicit).rpartition(
            ":"
        )[2]:
            case "str":
                return text
            case "null":
                return None
            case "bool":
                return _WORDS[text.lower()]
            case "int" if _INTEGER.fullmatch(text):
                return int(text, 0)
            case "float" if not re.search("[_:]", text) and len(text) <= _MAX_NUMBER:
                return float(_SPECIAL.get(text.lower(), text))
        raise Undetermined(f"the YAML value {text[:_MAX_NUMBER]} is not supported")
