"""The keys of a rubric, each declared once.

The loader, its messages, the JSON Schema and a page use these tables.

The JSON Schema, for editors, also has the arguments of every installed check.
"""

from collections.abc import Mapping
from datetime import datetime
from decimal import Decimal
from typing import Any, Literal

from grader.base.grouping import Strings
from grader.base.toml_file import KeyTable
from grader.base.toml_types import (
    Constraint,
    TomlType,
    constrained,
    described,
    simple_type,
    toml_type,
)
from grader.lab.checks.check import Check
from grader.lab.checks.registry import check_names, usable_check
from grader.lab.rubric.hint_levels import HintLevel
from grader.ros.known.releases import Release

MAX_POINTS = 1_000_000
_MAX_CHOICES = 9  # one key each
_ARGUMENT = str | bool | int | Decimal
_DECIMALS = 4  # of points: gradebooks store them as whole numbers of ten-thousandths


def _is_number(value: Any) -> bool:
    return (
        isinstance(value, int | Decimal)
        and not isinstance(value, bool)
        and Decimal(value).is_finite()
    )


def _are_choices(value: Any) -> bool:
    is_table = (
        isinstance(value, dict)
        and len(value) <= _MAX_CHOICES
        and all(map(_is_number, value.values()))
    )
    return is_table and all(
        text == text.strip() != ""
        and text.isprintable()
        and ";" not in text
        and -MAX_POINTS <= points < 0
        and not Decimal(points).scaleb(_DECIMALS) % 1
        for text, points in value.items()
    )


def _is_list(value: Any, kind: type) -> bool:
    return isinstance(value, list) and all(isinstance(item, kind) for item in value)


def _is_below(path: str) -> bool:
    """Return whether a path names a TOML file in the rubric's folder or below.

    The answer is the same on every operating system.
    """
    return (
        path.endswith(".toml")
        and not set(path) & set("\\:\0")
        and ".." not in path.split("/")
        and path[0] != "/"
    )


def _in_range(least: int, most: int) -> Constraint:
    schema = {"minimum": least, "maximum": most} if most < MAX_POINTS else {"minimum": least}
    return Constraint(
        f"a number from {least} to {most}", lambda value: least <= value <= most, schema
    )


def _table_type(schema: Mapping[str, Any]) -> TomlType:
    return simple_type("a table", schema, lambda value: isinstance(value, dict))


_TEXT = toml_type(str)
_NUMBER = simple_type("a number", {"type": "number"}, _is_number, Decimal)
_POINTS = constrained(
    _NUMBER,
    _in_range(0, MAX_POINTS),
    Constraint(
        f"a number with at most {_DECIMALS} decimals",
        lambda points: not points.scaleb(_DECIMALS) % 1,
    ),
)
_PERCENT, _AMOUNT = (constrained(_NUMBER, _in_range(0, most)) for most in (100, MAX_POINTS))
NAMES = simple_type(
    "a list of strings",
    {"type": "array", "items": _TEXT.schema},
    lambda value: _is_list(value, str),
    tuple,
)
_ID = constrained(
    _TEXT,
    Constraint(
        "one printable word",
        lambda text: text.isprintable() and len(text.split(" ")) == 1 and text != "",
    ),
)
_TITLE = constrained(
    simple_type(
        "a string",
        _TEXT.schema,
        lambda value: isinstance(value, str),
        lambda text: " ".join(text.split()),
    ),
    Constraint("a non-empty string", bool),
)
_TIME = simple_type(
    "a date and time with its offset, such as 2026-11-20T23:59:00+01:00",
    {"type": "string"},
    lambda value: isinstance(value, datetime) and value.tzinfo is not None,
)
_FILE = constrained(
    _TEXT,
    Constraint(
        "the path of a file",
        lambda path: path.strip().rstrip("/").split("/")[-1] not in ("", ".", ".."),
    ),
)
_FOLDERS = constrained(
    toml_type(Strings),
    Constraint(
        "a list of names of folders, each with a letter or digit and without a slash",
        lambda names: all("/" not in name and any(map(str.isalnum, name)) for name in names),
    ),
)
_CHOICES = simple_type(
    f"a table of at most {_MAX_CHOICES} comments without a semicolon, each with points below 0",
    {
        "type": "object",
        "additionalProperties": {"type": "number", "exclusiveMaximum": 0},
        "maxProperties": _MAX_CHOICES,
    },
    _are_choices,
    lambda table: {text: Decimal(points) for text, points in table.items()},
)
_FEEDBACK = simple_type(
    "a string, or a table of strings by the cause of the failure",
    {"type": ["string", "object"], "additionalProperties": _TEXT.schema},
    lambda value: (
        isinstance(value, str)
        or (isinstance(value, dict) and all(isinstance(text, str) for text in value.values()))
    ),
    lambda value: {"": value} if isinstance(value, str) else value,
)
_LAUNCH_ARGUMENTS = simple_type(
    "a table of strings, numbers, true or false",
    {
        "type": "object",
        "additionalProperties": {"type": ["string", "number", "boolean"]},
        "minProperties": 1,
    },
    lambda value: (
        isinstance(value, dict)
        and value != {}
        and all(isinstance(argument, _ARGUMENT) for argument in value.values())
    ),
    lambda table: {
        name: str(argument).lower() if isinstance(argument, bool) else str(argument)
        for name, argument in table.items()
    },
)
_FALLBACK = toml_type(Literal["failed", "manual"])
_ANSWERS = constrained(
    _TEXT, Constraint("a .toml file in the rubric's folder", _is_below, {"pattern": r"\.toml$"})
)

PART = KeyTable(
    "part",
    {
        "id": described(_ID, "The part's id, one word."),
        "title": described(_TITLE, "The heading of the part in reports."),
        "needs": described(
            toml_type(Literal["urdf", "package", "files"]),
            "What the part is graded on; files: all files.",
        ),
        "points": described(_POINTS, "The sum of the part's points, which is then verified."),
    },
    required=("id", "title"),
)
CARRIED = KeyTable(
    "carried table",
    {
        "from": described(
            constrained(NAMES, Constraint("at least one id", bool, {"minItems": 1})),
            (
                "The ids of other criteria, also of those below: their mistakes can make this "
                "one fail."
            ),
        ),
        "check": described(_TEXT, "The check that counts instead."),
        "with": described(_table_type({"type": "object"}), "The arguments of that check."),
        "at": described(
            toml_type(Mapping[str, float]),
            "Positions of joints for that check; default: those of the criterion.",
        ),
    },
    required=("from", "check"),
)
CRITERION = KeyTable(
    "criterion",
    {
        "id": described(
            _ID,
            (
                "The criterion's id, one word. Gradebooks and manual marks refer to it: never "
                "change it later."
            ),
        ),
        "part": described(_TEXT, "The id of the part that it belongs to."),
        "about": described(
            _TEXT, "A heading that consecutive criteria share, such as the name of a link."
        ),
        "title": described(_TITLE, "What should be true, in one sentence. Students read it."),
        "points": described(
            _POINTS,
            "The points for passing, with at most four decimals. A criterion is all or nothing.",
        ),
        "check": described(
            _TEXT, "The check that decides it: one of the grader, or of an installed plug-in."
        ),
        "with": described(_table_type({"type": "object"}), "The arguments of the check."),
        "at": described(
            toml_type(Mapping[str, float]),
            "Positions of joints for the check, in degrees or metres; default: 0.",
        ),
        "args": described(
            _LAUNCH_ARGUMENTS,
            "Launch arguments for the check. xacro gets those that launch files do not give it.",
        ),
        "requires": described(
            NAMES, "Ids of criteria above this one: it is skipped unless they passed."
        ),
        "carried": described(
            CARRIED.one_or_more,
            "What counts instead if an earlier mistake makes the criterion fail.",
        ),
        "package": described(
            _TEXT,
            "Which of the `packages` it is about; default: the one with the robot, else the first.",
        ),
        "feedback": described(
            _FEEDBACK,
            (
                "An explanation for students whose submission fails the criterion: one for every "
                "failure, or one for each of some causes, and none for others."
            ),
        ),
        "choices": described(
            _CHOICES, "Usual deductions for manual grading: a comment, and points below 0."
        ),
        "bonus": described(
            toml_type(bool), "Extra credit: its points are not part of the maximum; default: false."
        ),
    },
    required=("id", "part", "title", "points", "check"),
)
DEFAULTS = KeyTable(
    "defaults table",
    {
        "part": described(_TEXT, "The part of criteria that name none."),
        "points": described(_POINTS, "The points of criteria that give none."),
        "about": described(_TEXT, "The heading of criteria that give none."),
        "with": described(
            _table_type({"type": "object", "additionalProperties": {"type": "object"}}),
            "For each check a table of arguments, for criteria that do not give them.",
        ),
    },
)
EVIDENCE = KeyTable(
    "evidence",
    {
        "id": described(_ID, "The id of this piece of evidence, one word."),
        "part": described(_TEXT, "The id of the part that it belongs to."),
        "title": described(_TITLE, "What it should show."),
        "names": described(
            toml_type(Strings),
            "Labels in the name of its file, in any spelling: task 1 step 8.",
        ),
    },
    required=("id", "part", "title", "names"),
)
LATE = KeyTable(
    "late policy",
    {
        "due": described(_TIME, "The deadline, with its offset from UTC."),
        "grace_minutes": described(
            _AMOUNT, "Minutes after the deadline that do not count as late."
        ),
        "percent_per_day": described(
            _PERCENT, "The penalty for each day begun, in percent of the maximum."
        ),
        "points_per_day": described(_AMOUNT, "The penalty for each day begun, in points."),
        "points": described(_AMOUNT, "The penalty for being late at all, in points."),
        "floor_percent": described(
            _PERCENT, "The penalty lowers no grade below this, in percent of the maximum."
        ),
    },
)
ADJUSTMENT = KeyTable(
    "adjustment",
    {
        "action": described(
            toml_type(Literal["drop", "full"]),
            "drop: the criterion does not count; full: every graded submission gets its points.",
        ),
        "reason": described(_TITLE, "Why. Reports show it."),
    },
    required=("action", "reason"),
)
IGNORE = KeyTable(
    "test.ignore",
    {
        "mutants": described(
            constrained(NAMES, Constraint("at least one pattern", bool, {"minItems": 1})),
            "Patterns of mutants that may keep full marks, as `grader rubric test` names them.",
        ),
        "reason": described(_TITLE, "Why no criterion looks at what they change."),
    },
    required=("mutants", "reason"),
)
TEST = KeyTable(
    "test table",
    {"ignore": described(IGNORE.rows, "Mutants that may keep full marks, with the reason.")},
)
RUBRIC = KeyTable(
    "rubric",
    {
        "id": described(_ID, "The rubric's id, one word."),
        "title": described(_TITLE, "The title of the lab."),
        "reference": described(
            _TEXT, "The solution that must get full marks: a path relative to this file's folder."
        ),
        "urdf": described(_FILE, "Where a package keeps the graded file (default: robot.urdf)."),
        "package": described(_TEXT, "The name of the graded ROS 2 package."),
        "packages": described(
            constrained(NAMES, Constraint("at least one name", bool, {"minItems": 1})),
            "The names of the graded packages, if there are several.",
        ),
        "folders": described(
            _FOLDERS, "The names of the lab's folder in a repository of several labs."
        ),
        "distro": described(
            toml_type(Release),
            "The release of ROS 2 that the lab is for (default: jazzy): names of this release are "
            "right.",
        ),
        "transforms": described(
            toml_type(Strings),
            (
                "Launch files, by their paths in the package, whose static transforms are "
                "frames of the robot."
            ),
        ),
        "points": described(_POINTS, "The sum of all points, which is then verified."),
        "answers": described(
            _ANSWERS, "The file with the model answers, in this file's folder or below."
        ),
        "without_urdf": described(
            _FALLBACK,
            (
                "The criteria of the URDF if there is evidence, but no URDF: failed (the "
                "default), or manual grading."
            ),
        ),
        "without_package": described(
            _FALLBACK,
            "The criteria of the package if there is evidence, but no package: "
            "failed (the default), or manual grading.",
        ),
        "hints": described(
            toml_type(HintLevel),
            "How much hints tell students: none, place, cause (the default) or edit.",
        ),
        "defaults": described(_table_type(DEFAULTS.schema), "Default values for the criteria."),
        "part": described(PART.rows, "The parts of the lab, in the order of the report."),
        "criterion": described(
            CRITERION.rows, "The criteria, in the order in which they are checked."
        ),
        "evidence": described(EVIDENCE.rows, "The pictures and documents that the lab asks for."),
        "late": described(
            _table_type(LATE.schema),
            "The late penalty. It applies to classes, when grades are exported.",
        ),
        "adjust": described(
            _table_type({"type": "object", "additionalProperties": ADJUSTMENT.schema}),
            (
                "Corrections after grading: a table for each criterion that is dropped, or "
                "whose points all students get."
            ),
        ),
        "test": described(_table_type(TEST.schema), "Settings for `grader rubric test`."),
    },
    required=("id", "title", "part", "criterion"),
)


_Schema = dict[str, Any]


def rubric_schema() -> _Schema:
    """Return the JSON Schema of a rubric.

    It has the arguments of every check, also of installed plug-ins.
    """
    checks = {name: usable_check(name) for name in check_names()}
    facts = [check.documentation.fact if check else "" for check in checks.values()]
    schema = RUBRIC.schema
    criterion = CRITERION.schema
    carried = criterion["properties"]["carried"]
    for row in (criterion, carried, carried["items"]):
        row["properties"]["check"] |= {
            "enum": list(checks),
            "x-taplo": {"docs": {"enumValues": facts}},
        }
        # In a row with allOf, taplo completes no key.
        row |= {"if": {"required": ["check"]}, "then": {"$ref": "#/$defs/arguments"}}
    # Only the loader knows which of the missing keys and arguments the defaults give.
    criterion["required"] = [key for key in criterion["required"] if key not in DEFAULTS.keys]
    schema["properties"]["criterion"]["items"] = criterion
    definitions = {}
    arguments_of_checks = {}
    rules = []
    for check in checks.values():
        if not check:
            continue
        arguments = {name: _argument_type(check, name) for name in check.parameters}
        definitions[check.name] = KeyTable(check.name, arguments).schema
        reference = {"$ref": f"#/$defs/{check.name}"}
        arguments_of_checks[check.name] = reference
        is_check = {"properties": {"check": {"const": check.name}}, "required": ["check"]}
        rules.append({"if": is_check, "then": {"properties": {"with": reference}}})
    schema["properties"]["defaults"]["properties"]["with"] |= {
        "properties": arguments_of_checks,
        "additionalProperties": False,
    }
    definitions["arguments"] = {"allOf": rules}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "grader rubric",
        **schema,
        "$defs": definitions,
    }


def _argument_type(check: Check, name: str) -> TomlType:
    """Return the type of an argument with its meaning.

    It has its default, too, if a rubric can give that.
    """
    import json  # late: only the schema needs it

    parameter = check.parameters[name]
    meaning = check.documentation.arguments.get(name, "")
    try:
        json.dumps(parameter.default, allow_nan=False)
    except (TypeError, ValueError):  # of a plug-in
        return described(parameter.type, meaning)
    return described(
        parameter.type,
        meaning,
        **({} if parameter.default is None else {"default": parameter.default}),
    )
