"""The keys of a rubric, each declared once: the loader, its messages and the JSON Schema are made from these tables."""

from collections.abc import Mapping
from datetime import datetime
from decimal import Decimal
from typing import Any, Literal, NamedTuple

from grader.checks.registry import CHECKS, Check, describe
from grader.checks.toml_types import Constraint, TomlType, constrained, simple_type, toml_type
from grader.grading.levels import Level

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


def _is_number(value: Any) -> bool:
    return isinstance(value, int | Decimal) and not isinstance(value, bool) and Decimal(value).is_finite()


def _is_list(value: Any, kind: type) -> bool:
    return isinstance(value, list) and all(isinstance(item, kind) for item in value)


def _is_below(path: str) -> bool:
    """Return whether a path names a TOML file in the rubric's folder or below, on every operating system."""
    return path.endswith(".toml") and not set(path) & set("\\:\0") and ".." not in path.split("/") and path[0] != "/"


def _range(least: int, most: int) -> Constraint:
    schema = {"minimum": least, "maximum": most} if most < MAX_POINTS else {"minimum": least}
    return Constraint(f"a number from {least} to {most}", lambda value: least <= value <= most, schema)


def _rows(table: KeyTable) -> TomlType:
    schema = {"type": "array", "items": table.schema, "minItems": 1}
    return simple_type(
        f"one or more [[{table.name}]] tables", schema, lambda value: value != [] and _is_list(value, dict)
    )


def _table(schema: Mapping[str, Any]) -> TomlType:
    return simple_type("a table", schema, lambda value: isinstance(value, dict))


_TEXT = toml_type(str)
_NUMBER = simple_type("a number", {"type": "number"}, _is_number, Decimal)
_POINTS = constrained(
    _NUMBER,
    _range(0, MAX_POINTS),
    Constraint(f"a number with at most {_DECIMALS} decimals", lambda points: not points.scaleb(_DECIMALS) % 1),
)
_PERCENT = constrained(_NUMBER, _range(0, 100))
_MINUTES = constrained(_NUMBER, _range(0, MAX_POINTS))
_NAMES = simple_type(
    "a list of strings", {"type": "array", "items": _TEXT.schema}, lambda value: _is_list(value, str), tuple
)
_ID = constrained(
    _TEXT,
    Constraint("one printable word", lambda text: text.isprintable() and len(text.split(" ")) == 1 and text != ""),
)
_TITLE = constrained(
    simple_type("a string", _TEXT.schema, lambda value: isinstance(value, str), lambda text: " ".join(text.split())),
    Constraint("a non-empty string", bool),
)
_TIME = simple_type(
    "a date and time with its offset, such as 2026-11-20T23:59:00+01:00",
    {"type": "string"},
    lambda value: isinstance(value, datetime) and value.tzinfo is not None,
)
_FILE = constrained(
    _TEXT, Constraint("the path of a file", lambda path: path.strip().rstrip("/").split("/")[-1] not in ("", ".", ".."))
)
_FOLDERS = constrained(
    toml_type(tuple[str, ...]),
    Constraint(
        "a list of names of folders, each with a letter or digit and without a slash",
        lambda names: all("/" not in name and any(map(str.isalnum, name)) for name in names),
    ),
)
_ANSWERS = constrained(_TEXT, Constraint("a .toml file in the rubric's folder", _is_below, {"pattern": r"\.toml$"}))

PART = KeyTable(
    "part",
    {"id": _ID, "title": _TITLE, "needs": toml_type(Literal["urdf", "package", "files"]), "points": _POINTS},
    optional=("needs", "points"),
)
CARRIED = KeyTable(
    "carried table",
    {
        "from": constrained(_NAMES, Constraint("at least one id", bool, {"minItems": 1})),
        "check": _TEXT,
        "with": _table({"type": "object"}),
    },
    optional=("with",),
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
        "with": _table({"type": "object"}),
        "requires": _NAMES,
        "carried": _table(CARRIED.schema),
        "feedback": _TEXT,
    },
    optional=("about", "with", "requires", "carried", "feedback"),
)
EVIDENCE = KeyTable("evidence", {"id": _ID, "part": _TEXT, "title": _TITLE, "names": toml_type(tuple[str, ...])})
LATE = KeyTable(
    "late policy",
    {"due": _TIME, "grace_minutes": _MINUTES, "percent_per_day": _PERCENT, "floor_percent": _PERCENT},
    optional=("due", "grace_minutes", "floor_percent"),
)
IGNORE = KeyTable(
    "test.ignore",
    {"mutants": constrained(_NAMES, Constraint("at least one pattern", bool, {"minItems": 1})), "reason": _TITLE},
)
TEST = KeyTable("test table", {"ignore": _rows(IGNORE)}, optional=("ignore",))
RUBRIC = KeyTable(
    "rubric",
    {
        "id": _ID,
        "title": _TITLE,
        "reference": _TEXT,
        "urdf": _FILE,
        "package": _TEXT,
        "folders": _FOLDERS,
        "points": _POINTS,
        "answers": _ANSWERS,
        "without_urdf": toml_type(Literal["failed", "manual"]),
        "hints": toml_type(Level),
        "part": _rows(PART),
        "criterion": _rows(CRITERION),
        "evidence": _rows(EVIDENCE),
        "late": _table(LATE.schema),
        "test": _table(TEST.schema),
    },
    optional=(
        "reference",
        "urdf",
        "package",
        "folders",
        "points",
        "answers",
        "without_urdf",
        "hints",
        "evidence",
        "late",
        "test",
    ),
)


def rubric_schema() -> dict[str, Any]:
    """Return the JSON Schema of a rubric, with the arguments of every check that comes with the grader."""
    schema = RUBRIC.schema
    criterion = CRITERION.schema
    rules = [_arguments_rule(describe(function)) for function in CHECKS]
    criterion["allOf"] = rules
    criterion["properties"]["carried"]["allOf"] = rules
    schema["properties"]["criterion"]["items"] = criterion
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "grader rubric", **schema}


def _arguments_rule(check: Check) -> dict[str, Any]:
    optional = tuple(name for name, parameter in check.parameters.items() if not parameter.required)
    arguments = KeyTable(check.name, {name: parameter.type for name, parameter in check.parameters.items()}, optional)
    then: dict[str, Any] = {"properties": {"with": arguments.schema}}
    if arguments.schema["required"]:
        then["required"] = ["with"]
    return {"if": {"properties": {"check": {"const": check.name}}, "required": ["check"]}, "then": then}
