"""The building blocks of the JSON Schemas (draft 2020-12)."""

from typing import Any

_DRAFT = "https://json-schema.org/draft/2020-12/schema"
TEXT: dict[str, Any] = {"type": "string"}
NUMBER: dict[str, Any] = {"type": "number"}
COUNT: dict[str, Any] = {"type": "integer", "minimum": 1}
POINTS: dict[str, Any] = {"type": "number", "minimum": 0}
TOTAL: dict[str, Any] = {"type": "integer", "minimum": 0}
FLAG: dict[str, Any] = {"type": "boolean"}
HASH: dict[str, Any] = {"type": "string", "pattern": "^[0-9a-f]{64}$"}


def record(properties: dict[str, Any], optional: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the schema of an object with exactly these properties."""
    required = [name for name in properties if name not in optional]
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def document(title: str, properties: dict[str, Any], optional: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the schema of a whole document."""
    return {"$schema": _DRAFT, "title": f"grader {title}", **record(properties, optional)}


def array(items: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of an array."""
    return {"type": "array", "items": items}


def nullable(schema: dict[str, Any]) -> dict[str, Any]:
    """Return a schema that also allows null."""
    return {"anyOf": [schema, {"type": "null"}]}


def each(schema: dict[str, Any], names: str) -> dict[str, Any]:
    """Return properties of one type, from their names between spaces."""
    return dict.fromkeys(names.split(), schema)


GRADER = record({"version": TEXT})
RUBRIC = record({**each(TEXT, "id title"), "sha256": HASH})
PLACE = {"path": TEXT, **each(COUNT, "line column")}
EDIT = record({**PLACE, **each(TEXT, "old new renamed")}, ("renamed",))
VALUE: dict[str, Any] = {"type": ["null", "boolean", "number", "string", "array", "object"]}
ADJUSTMENT = record({"action": {"enum": ["drop", "full"]}, "reason": TEXT})
