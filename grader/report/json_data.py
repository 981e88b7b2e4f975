"""JSON text and values that are the same bytes on every machine."""

import json
import re
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import Any

from grader.problems import Problem
from grader.source import Edit, Location

_ENCODER = json.JSONEncoder(ensure_ascii=False, allow_nan=False)
_UNPRINTABLE = re.compile(r"[^\n -~]")  # or any other character that is not ASCII


def to_json(data: Mapping[str, Any]) -> str:
    """Return data as JSON text: a line for each key, and for each entry of a list of objects.

    `indent` of the standard library takes three times as long, because it does not use the C encoder.
    """
    lines = ",\n".join(f" {_ENCODER.encode(key)}: {_lines(value)}" for key, value in data.items())
    return _harmless(f"{{\n{lines}\n}}\n")


def to_json_list(data: Sequence[Mapping[str, Any]]) -> str:
    """Return a list of objects as JSON text, a line for each."""
    lines = ",\n".join(f" {_ENCODER.encode(item)}" for item in data)
    return _harmless(f"[\n{lines}\n]\n" if lines else "[]\n")


def _harmless(text: str) -> str:
    """Return JSON with escapes for unprintable characters, and for what GitHub's runner takes for a command."""
    if not text.isascii() or "\x7f" in text:
        text = _UNPRINTABLE.sub(lambda found: found[0] if found[0].isprintable() else json.dumps(found[0])[1:-1], text)
    return text.replace("##[", "##\\u005b")


def _lines(value: Any) -> str:
    text = _ENCODER.encode(value)
    if not isinstance(value, list) or not value or not isinstance(value[0], dict):
        return text
    # In a JSON string every quote is escaped, so this matches only between two entries.
    first = _ENCODER.encode(next(iter(value[0])))
    return "[\n  " + text[1:-1].replace("}, {" + first, "},\n  {" + first) + "\n ]"


def exact(points: Decimal | None) -> int | float | None:
    """Return points as a JSON number: 58.5, and 70 rather than 70.0."""
    if points is None:
        return None
    return int(points) if points == points.to_integral_value() else float(points)


def rounded(value: Any) -> Any:
    """Return a value rounded to 1e-6, because machines differ in the last digits; never -0, None if it is not finite."""
    if isinstance(value, float):
        return round(value, 6) + 0.0 if value - value == 0 else None
    if isinstance(value, tuple | list):
        return [rounded(item) for item in value]
    return dict(value) if isinstance(value, Mapping) else value


def plain(value: Any) -> Any:
    """Return points as a JSON number, and any other value rounded."""
    return exact(value) if isinstance(value, Decimal) else rounded(value)


def fields(value: object, names: str) -> dict[str, Any]:
    """Return some fields of an object as plain data; `names` are separated by spaces."""
    return {name: plain(getattr(value, name)) for name in names.split()}


def location(where: Location | None) -> dict[str, Any] | None:
    """Return a location as plain data."""
    if where is None:
        return None
    place: dict[str, Any] = {"path": where.path, "line": where.line, "column": where.column}
    calls = [{"macro": macro, "location": location(called)} for macro, called in where.calls]
    return {**place, "calls": calls} if calls else place


def problem(found: Problem) -> dict[str, Any]:
    """Return a problem as plain data."""
    words = {"code": found.code, "severity": found.severity, "message": found.message}
    return {**words, "location": location(found.location)}


def edit(change: Edit) -> dict[str, Any]:
    """Return an edit as plain data; only the name of a file that is renamed has the key `renamed`."""
    data = change._asdict()
    return data if change.renamed else {key: value for key, value in data.items() if key != "renamed"}
