"""Values from a YAML file, as load_yaml of xacro returns them: mappings, lists, plain scalars and numbers with units."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import yaml

from grader.static_python.closed_values import (
    Budget,
    DottedDict,
    ExpressionFails,
    Undetermined,
    Value,
    checked_key,
    run,
)

_OF_EVENT = 10  # what a part of the file is charged
_MAX_DEPTH = 100
_MAX_PLAIN = 100  # characters of a scalar that may be a number
_STANDARD = "tag:yaml.org,2002:"
_UNITS = {
    "!radians": 1.0, "!degrees": 3.141592653589793 / 180.0, "!meters": 1.0, "!millimeters": 0.001, "!foot": 0.3048,
    "!inches": 0.0254,
}  # fmt: skip
_WORDS = {"true": True, "yes": True, "on": True, "false": False, "no": False, "off": False}
_INTEGER = re.compile(r"[-+]?(?:0|[1-9][0-9]*|0x[0-9a-fA-F]+)")
_SPECIAL = {".nan": "nan", ".inf": "inf", "+.inf": "inf", "-.inf": "-inf"}
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_RESOLVER: Any = yaml.resolver.Resolver()


def read_yaml_values(data: bytes, number: Callable[[str], Value], budget: Budget) -> Value:
    """Return the value of a YAML text. `number` evaluates an expression that has a unit, such as !degrees 90.

    Raises ExpressionFails for what is not YAML, Undetermined for what is too large or rarely used.
    """
    budget.charge(1, len(data))
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        raise ExpressionFails("the YAML file is not UTF-8 text") from None
    try:
        return budget.checked(_Values(yaml.parse(text, _LOADER), number, budget).document())
    except (yaml.YAMLError, ValueError) as error:
        raise ExpressionFails(f"the file is not YAML: {' '.join(str(error).split())[:200]}") from None


class _Values:
    def __init__(self, events: Iterator[Any], number: Callable[[str], Value], budget: Budget) -> None:
        self._events, self._number, self._budget = events, number, budget
        self._anchors: dict[str, Value] = {}
        self._depth = 0

    def document(self) -> Value:
        """Return the value of the only document, None if there is none."""
        value: Value = None
        documents = 0
        for event in self._events:
            if isinstance(event, yaml.DocumentStartEvent):
                documents += 1
                if documents > 1:
                    raise ExpressionFails("the file is not YAML: expected a single document")
                value = self._value(next(self._events))
        return value

    def _value(self, event: Any) -> Value:
        self._budget.charge(_OF_EVENT)
        if isinstance(event, yaml.AliasEvent):
            if event.anchor not in self._anchors:
                raise Undetermined(f"the alias {event.anchor} has no value, or contains itself")
            return self._budget.checked(self._anchors[event.anchor])
        if isinstance(event, yaml.ScalarEvent):
            value = self._scalar(event)
        elif event.tag not in (None, "!"):
            raise self._unknown(event.tag)
        else:
            self._depth += 1
            if self._depth > _MAX_DEPTH:
                raise Undetermined("the YAML file is nested too deeply")
            value = self._mapping() if isinstance(event, yaml.MappingStartEvent) else [*self._items()]
            self._depth -= 1
        if event.anchor is not None:
            self._anchors[event.anchor] = value
        return value

    def _items(self) -> Iterator[Value]:
        for event in self._events:
            if isinstance(event, yaml.CollectionEndEvent):
                return
            yield self._value(event)

    def _mapping(self) -> DottedDict:
        items = self._items()
        return DottedDict((checked_key(key), next(items)) for key in items)

    def _scalar(self, event: Any) -> Value:
        tag, text = event.tag, event.value
        if tag in _UNITS:
            return run(float, self._number(text)) * _UNITS[tag]
        if tag not in (None, "!"):
            raise self._unknown(tag)
        kind = _RESOLVER.resolve(yaml.ScalarNode, text[:_MAX_PLAIN], event.implicit).removeprefix(_STANDARD)
        match kind:
            case "str":
                return text
            case "null":
                return None
            case "bool":
                return _WORDS[text.lower()]
            case "int" if _INTEGER.fullmatch(text):
                return int(text, 0)
            case "float" if not re.search("[_:]", text) and len(text) <= _MAX_PLAIN:
                return float(_SPECIAL.get(text.lower(), text))
        raise Undetermined(f"the YAML value {text[:_MAX_PLAIN]} is not supported")

    @staticmethod
    def _unknown(tag: str) -> ExpressionFails | Undetermined:
        if tag.startswith(_STANDARD) and ":python/" not in tag:
            return Undetermined(f"the YAML tag {tag} is not supported")
        return ExpressionFails(f"the file is not YAML: there is no tag {tag}")
