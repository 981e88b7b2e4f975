"""The keys of a rubric, each declared once: the loader, its messages and the JSON Schema are made from these tables."""

from collections.abc import Mapping
from datetime import datetime
from decimal import Decimal
from typing import Any, Literal, NamedTuple

from grader.checks.registry import Check, check_names, find_check
from grader.checks.toml_types import Constraint, TomlType, constrained, described, simple_type, toml_type
from grader.errors import InputError
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
        "at": toml_type(Mapping[str, float]),
        "requires": _NAMES,
        "carried": _table(CARRIED.schema),
        "feedback": _TEXT,
    },
    optional=("about", "with", "at", "requires", "carried", "feedback"),
)
DEFAULTS = KeyTable(
    "defaults table",
    {"part": _TEXT, "points": _POINTS, "about": _TEXT, "with": _table({"type": "object"})},
    optional=("part", "points", "about", "with"),
)
EVIDENCE = KeyTable("evidence", {"id": _ID, "part": _TEXT, "title": _TITLE, "names": toml_type(tuple[str, ...])})
LATE = KeyTable(
    "late policy",
    {"due": _TIME, "grace_minutes": _MINUTES, "percent_per_day": _PERCENT, "floor_percent": _PERCENT},
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
        "folders": _FOLDERS,
        "points": _POINTS,
        "answers": _ANSWERS,
        "without_urdf": toml_type(Literal["failed", "manual"]),
        "hints": toml_type(Level),
        "defaults": _table(DEFAULTS.schema),
        "part": _rows(PART),
        "criterion": _rows(CRITERION),
        "evidence": _rows(EVIDENCE),
        "late": _table(LATE.schema),
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
        "defaults",
        "evidence",
        "late",
    ),
)


def rubric_schema() -> dict[str, Any]:
    """Return the JSON Schema of a rubric, with the arguments of every check, also of installed plug-ins."""
    schema = RUBRIC.schema
    criterion = CRITERION.schema
    names = check_names()
    rules = [_arguments_rule(check) for name in names if (check := _usable(name)) is not None]
    for row in (criterion, criterion["properties"]["carried"]):
        row["properties"]["check"] |= {"enum": names}
        row["allOf"] = [{"$ref": "#/$defs/arguments"}]
    schema["properties"]["criterion"]["items"] = criterion
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "grader rubric"}
    return {**head, **schema, "$defs": {"arguments": {"allOf": rules}}}


def _usable(name: str) -> Check | None:
    try:
        return find_check(name)
    except InputError:  # in another package: a rubric that names it is refused
        return None


def _arguments_rule(check: Check) -> dict[str, Any]:
    optional = tuple(name for name, parameter in check.parameters.items() if not parameter.required)
    arguments = KeyTable(check.name, {name: _argument(check, name) for name in check.parameters}, optional)
    then: dict[str, Any] = {"properties": {"with": arguments.schema}}
    if arguments.schema["required"]:
        then["required"] = ["with"]
    return {"if": {"properties": {"check": {"const": check.name}}, "required": ["check"]}, "then": then}


def _argument(check: Check, name: str) -> TomlType:
    """Return the type of an argument with its meaning and its default for the JSON Schema."""
    parameter, meaning = check.parameters[name], check.documentation.arguments.get(name, "")
    default = {} if parameter.required else {"default": parameter.default}
    return described(parameter.type, meaning, **default)
