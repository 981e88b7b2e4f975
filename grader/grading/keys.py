"""The keys of a rubric, each declared once: the loader, its messages and the JSON Schema are made from these tables."""

from collections.abc import Mapping
from datetime import datetime
from decimal import Decimal
from typing import Any, Literal, NamedTuple

from grader.checks.registry import CHECKS, Check, describe
from grader.checks.toml_types import Constraint, TomlType, WrongValue, constrained, toml_type

MAX_POINTS = 1_000_000
_DECIMALS = 4  # of points: gradebooks store them as whole numbers of ten-thousandths


class KeyTable(NamedTuple):
    """A table of the rubric: what one is called, and its keys."""

    name: str
    keys: Mapping[str, TomlType]
    optional: tuple[str, ...] = ()

    @property
    def schema(self) -> dict[str, Any]:
        """The JSON Schema of the table."""
        return {
            "type": "object",
            "properties": {key: dict(value.schema) for key, value in self.keys.items()},
            "required": [key for key in self.keys if key not in self.optional],
            "additionalProperties": False,
        }


def _parse_number(value: Any) -> Decimal:
    if isinstance(value, int | Decimal) and not isinstance(value, bool) and Decimal(value).is_finite():
        return Decimal(value)
    raise WrongValue("a number")


def _parse_title(value: Any) -> str:
    if isinstance(value, str) and value.strip():
        return " ".join(value.split())  # one line, however it is broken in the file
    raise WrongValue("a text that is not empty" if isinstance(value, str) else "a text")


def _parse_table(value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        return value
    raise WrongValue("a table")


def _parse_texts(value: Any) -> tuple[str, ...]:
    if isinstance(value, list) and all(isinstance(text, str) for text in value):
        return tuple(value)
    raise WrongValue("a list of texts")


def _parse_time(value: Any) -> datetime:
    if isinstance(value, datetime) and value.tzinfo is not None:
        return value
    raise WrongValue("a date and time with its offset, such as 2026-11-20T23:59:00+01:00")


def _is_below(path: str) -> bool:
    """Return whether a path names a TOML file in the rubric's folder or below, on every operating system."""
    return path.endswith(".toml") and not set(path) & set("\\:\0") and ".." not in path.split("/") and path[0] != "/"


def _range(least: int, most: int) -> Constraint:
    schema = {"minimum": least, "maximum": most} if most < MAX_POINTS else {"minimum": least}
    return Constraint(f"a number from {least} to {most}", lambda value: least <= value <= most, schema)


def _rows(table: KeyTable) -> TomlType:
    name = f"one or more [[{table.name}]] tables"

    def parse(value: Any) -> list[dict[str, Any]]:
        if isinstance(value, list) and value and all(isinstance(row, dict) for row in value):
            return value
        raise WrongValue(name)

    return TomlType(name, {"type": "array", "items": table.schema, "minItems": 1}, parse)


_TEXT = toml_type(str)
_NUMBER = TomlType("a number", {"type": "number"}, _parse_number)
_POINTS = constrained(
    _NUMBER,
    _range(0, MAX_POINTS),
    Constraint(f"a number with at most {_DECIMALS} decimals", lambda points: not points.scaleb(_DECIMALS) % 1),
)
_PERCENT = constrained(_NUMBER, _range(0, 100))
_MINUTES = constrained(_NUMBER, _range(0, MAX_POINTS))
_ID = constrained(
    _TEXT,
    Constraint("one printable word", lambda text: text.isprintable() and len(text.split(" ")) == 1 and text != ""),
)
_TITLE = TomlType("a text", {"type": "string"}, _parse_title)
_FILE = constrained(
    _TEXT, Constraint("the path of a file", lambda path: path.strip().rstrip("/").split("/")[-1] not in ("", ".", ".."))
)
_ANSWERS = constrained(_TEXT, Constraint("a .toml file in the rubric's folder", _is_below, {"pattern": r"\.toml$"}))

PART = KeyTable(
    "part",
    {"id": _ID, "title": _TITLE, "needs": toml_type(Literal["urdf", "package", "files"]), "points": _POINTS},
    optional=("needs", "points"),
)
CRITERION = KeyTable(
    "criterion",
    {
        "id": _ID,
        "part": _TEXT,
        "about": _TEXT,
        "title": _TITLE,
        "points": _POINTS,
        "check": _TEXT,
        "with": TomlType("a table", {"type": "object"}, _parse_table),
        "requires": TomlType("a list of texts", {"type": "array", "items": _TEXT.schema}, _parse_texts),
        "feedback": _TEXT,
    },
    optional=("about", "with", "requires", "feedback"),
)
EVIDENCE = KeyTable("evidence", {"id": _ID, "part": _TEXT, "title": _TITLE, "names": toml_type(tuple[str, ...])})
LATE = KeyTable(
    "late policy",
    {
        "due": TomlType("a time", {"type": "string"}, _parse_time),
        "grace_minutes": _MINUTES,
        "percent_per_day": _PERCENT,
        "floor_percent": _PERCENT,
    },
    optional=("due", "grace_minutes", "floor_percent"),
)
RUBRIC = KeyTable(
    "rubric",
    {
        "id": _ID,
        "title": _TITLE,
        "reference": _TEXT,
        "urdf": _FILE,
        "package": _TEXT,
        "points": _POINTS,
        "answers": _ANSWERS,
        "part": _rows(PART),
        "criterion": _rows(CRITERION),
        "evidence": _rows(EVIDENCE),
        "late": TomlType("a table", LATE.schema, _parse_table),
    },
    optional=("reference", "urdf", "package", "points", "answers", "evidence", "late"),
)


def rubric_schema() -> dict[str, Any]:
    """Return the JSON Schema of a rubric, with the arguments of every check that comes with the grader."""
    schema = RUBRIC.schema
    criterion = CRITERION.schema
    criterion["allOf"] = [_arguments_rule(describe(function)) for function in CHECKS]
    schema["properties"]["criterion"]["items"] = criterion
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "grader rubric", **schema}


def _arguments_rule(check: Check) -> dict[str, Any]:
    optional = tuple(name for name, parameter in check.parameters.items() if not parameter.required)
    arguments = KeyTable(check.name, {name: parameter.type for name, parameter in check.parameters.items()}, optional)
    then: dict[str, Any] = {"properties": {"with": arguments.schema}}
    if arguments.schema["required"]:
        then["required"] = ["with"]
    return {"if": {"properties": {"check": {"const": check.name}}, "required": ["check"]}, "then": then}
