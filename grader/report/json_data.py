"""JSON text that is the same bytes everywhere, and descriptions of its objects.

Data and schemas follow from these.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import cached_property
from operator import attrgetter
from typing import Any, TypeVar

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.text import without_tag_commands

_ENCODER = json.JSONEncoder(ensure_ascii=False, allow_nan=False)
_UNPRINTABLE = on_use(r"[^\n -~]")  # or any other character that is not ASCII


def to_json(data: Mapping[str, Any]) -> str:
    """Return data as JSON text: a line for each key, and for the objects of a list.

    `indent` of the standard library takes three times as long, because it does not use the C
    encoder.
    """
    lines = ",\n".join(
        f" {_ENCODER.encode(key)}: {_laid_out(value)}" for key, value in data.items()
    )
    return _harmless(f"{{\n{lines}\n}}\n")


def list_to_json(objects: Sequence[Mapping[str, Any]]) -> str:
    """Return objects as JSON text, a line for each."""
    lines = ",\n ".join(map(_ENCODER.encode, objects))
    return _harmless(f"[\n {lines}\n]\n") if lines else "[]\n"


def _harmless(text: str) -> str:
    """Return JSON with escapes for unprintable characters.

    What a CI system takes for a command is escaped, too.
    """
    if not text.isascii() or "\x7f" in text:
        text = _UNPRINTABLE.sub(
            lambda match: match[0] if match[0].isprintable() else json.dumps(match[0])[1:-1], text
        )
    return without_tag_commands(text, "\\u005b")


def _laid_out(value: Any) -> str:
    if _is_of_objects(value):
        return f"[\n  {_objects(value, next(iter(value[0])))}\n ]"
    return _ENCODER.encode(value)


def _is_of_objects(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict)


def _objects(values: Sequence[Mapping[str, Any]], first: str) -> str:
    """Return objects between commas.

    Each that begins with the key `first` starts a line, also in an inner list.
    """
    text = ""
    for value in values:
        if text:
            text += ",\n  " if next(iter(value)) == first else ", "
        text += _object(value, first)
    return text


def _object(value: Mapping[str, Any], first: str) -> str:
    inner = {
        key for key, item in value.items() if _is_of_objects(item) and next(iter(item[0])) == first
    }
    if not inner:
        return _ENCODER.encode(value)
    members = []
    for key, item in value.items():
        text = f"[{_objects(item, first)}]" if key in inner else _ENCODER.encode(item)
        members.append(f"{_ENCODER.encode(key)}: {text}")
    return f"{{{', '.join(members)}}}"


def exact(points: Decimal | None) -> int | float | None:
    """Return points as a JSON number: 58.5, and 70 rather than 70.0."""
    if points is None:
        return None
    if points == points.to_integral_value():
        return int(points)
    return float(points)


def rounded(value: Any) -> Any:
    """Return plain data: points exact, floats to 1e-6, because machines differ beyond.

    There is no -0, NaN or infinity in it.
    """
    if value is None or isinstance(value, str | int):
        return value
    if isinstance(value, float):
        if value - value == 0:
            return round(value, 6) + 0.0
        return None
    if isinstance(value, Decimal):
        return exact(value)
    if isinstance(value, Mapping):
        return {key: rounded(item) for key, item in value.items()}
    return [rounded(item) for item in value]


_K = TypeVar("_K")
Schema = dict[str, Any]
TEXT: Schema = {"type": "string"}
NUMBER: Schema = {"type": "number"}
COUNT: Schema = {"type": "integer", "minimum": 1}
POINTS: Schema = {"type": "number", "minimum": 0}
TOTAL: Schema = {"type": "integer", "minimum": 0}
FLAG: Schema = {"type": "boolean"}
HASH: Schema = {"type": "string", "pattern": "^[0-9a-f]{64}$"}
VALUE: Schema = {"type": ["null", "boolean", "number", "string", "array", "object"]}


def object_schema(properties: Mapping[str, Schema], optional: Sequence[str] = ()) -> Schema:
    """Return the schema of an object with exactly these properties."""
    required = [name for name in properties if name not in optional]
    return {
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": False,
    }


def array(items: Schema) -> Schema:
    """Return the schema of an array."""
    return {"type": "array", "items": items}


def mapping(values: Schema) -> Schema:
    """Return the schema of an object with any keys."""
    return {"type": "object", "additionalProperties": values}


def nullable(schema: Schema) -> Schema:
    """Return a schema that also allows null."""
    return {"anyOf": [schema, {"type": "null"}]}


def each(kind: _K, names: str) -> dict[str, _K]:
    """Return keys of one type, from their names between spaces."""
    return dict.fromkeys(names.split(), kind)


@dataclass(frozen=True)
class JsonObject:
    """A JSON object that describes a value.

    Each key has its type, and the attribute of the value or the function of it; without either it
    has the attribute of its name. Attributes become plain data; a function returns plain data, or
    what an object describes. mypy does not check the names of attributes. Every document has all
    keys, so any test of it finds a wrong one.
    """

    keys: Mapping[str, "KeyType | Key"]
    optional: Strings = ()  # keys that are absent where they would be empty

    @cached_property
    def _pairs(self) -> dict[str, "Key"]:
        return {
            name: key if isinstance(key, tuple) else (key, name) for name, key in self.keys.items()
        }

    @cached_property
    def _readers(self) -> dict[str, Callable[[Any], Any]]:
        return {name: _reader(*pair) for name, pair in self._pairs.items()}

    @property
    def schema(self) -> Schema:
        """The schema of the object."""
        return object_schema(
            {name: _schema(kind) for name, (kind, _) in self._pairs.items()}, self.optional
        )

    def data(self, value: Any) -> dict[str, Any]:
        """Return the object that describes a value."""
        values = {name: read(value) for name, read in self._readers.items()}
        for name in self.optional:
            if not values[name]:
                del values[name]
        return values


@dataclass(frozen=True, slots=True)
class Many:
    """An array of objects."""

    of: JsonObject


@dataclass(frozen=True, slots=True)
class Maybe:
    """An object or null."""

    of: JsonObject


KeyType = Schema | JsonObject | Many | Maybe
_Origin = str | Callable[[Any], Any]
Key = tuple[KeyType, _Origin]


def _schema(kind: KeyType) -> Schema:
    match kind:
        case JsonObject():
            return kind.schema
        case Many():
            return array(kind.of.schema)
        case Maybe():
            return nullable(kind.of.schema)
    return kind


def _reader(kind: KeyType, origin: _Origin) -> Callable[[Any], Any]:
    """Return the function from a value to what a key of its object has."""
    get = attrgetter(origin) if isinstance(origin, str) else origin
    match kind:
        case Many():
            return lambda value: list(map(kind.of.data, get(value)))
        case Maybe():
            return lambda value: _optional(kind.of, get(value))
        case JsonObject():
            return lambda value: _optional(kind, get(value))
    is_plain = callable(origin) or kind.get("type") in ("string", "integer", "boolean")
    if is_plain:
        return get
    return lambda value: rounded(get(value))


def _optional(of: JsonObject, value: Any) -> dict[str, Any] | None:
    return of.data(value) if value is not None else None


def inner(owner: str, keys: Mapping[str, KeyType]) -> dict[str, Key]:
    """Return keys that have the attributes of their names of an attribute of a value."""
    return {name: (kind, f"{owner}.{name}") for name, kind in keys.items()}


def make_schema(title: str, described: "JsonObject") -> dict[str, Any]:
    """Return the JSON Schema of a document."""
    draft = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": draft, "title": f"grader {title}", **described.schema}


def schema_key(schema: str) -> dict[str, Key]:
    """Return the key that names the schema of a document."""
    return {"schema": ({"const": schema}, lambda _: schema)}


GRADER = object_schema({"version": TEXT})
RUBRIC = JsonObject({**each(TEXT, "id title"), "sha256": HASH})
PLACE = {"path": TEXT, **each(COUNT, "line column")}
EDIT = JsonObject({**PLACE, **each(TEXT, "old new renamed")}, ("renamed",))
ADJUSTMENT = JsonObject({"action": {"enum": ["drop", "full"]}, "reason": TEXT})
