"""The JSON Schema of a rubric: an editor with it describes every key, and finds the mistakes that the loader finds."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.checks.registry import check_names, own_checks
from grader.errors import RubricError
from grader.grading.keys import ADJUSTMENT, CARRIED, CRITERION, DEFAULTS, EVIDENCE, IGNORE, LATE, PART, RUBRIC, TEST
from grader.grading.rubric import load_rubric, shipped_rubrics
from tests.command_line import ROOT, run

SCHEMA = json.loads(run(("schema", "rubric")).stdout)
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
RUBRICS = [*shipped_rubrics().values(), *(ROOT / "docs").rglob("*_lab.toml")]

EVERY_KEY = """\
#:schema ./rubric.schema.json
id = "lab0"
title = "Lab 0"
urdf = "urdf/robot.urdf"
package = "my_robot"
folders = ["Lab0"]
points = 6.5
answers = "lab0.answers.toml"
without_urdf = "manual"
without_package = "manual"
hints = "edit"
reference = "solution"

[[part]]
id = "a"
title = "Part A"
needs = "urdf"
points = 6.5

[[criterion]]
id = "box"
part = "a"
about = "The base"
title = "It is a box"
points = 2.5
check = "shows_box"
with = { link = "base", size = [1, 2.5, 3], tolerance = 0.002 }
feedback = "Look at its size."

[[criterion]]
id = "frame"
part = "a"
title = "The tip is at the point"
points = 4
check = "frame_at"
with = { link = "tip", relative_to = "base", xyz = [0, 0, 1], tolerance = 0.002, rpy = [0, 0, 0], angle = 1 }
at = { shoulder = 90, slide = 0.1 }
requires = ["box"]
bonus = false
choices = { "names no unit" = -1, "too short" = -0.5 }

[criterion.carried]
from = ["box"]
check = "shows_sphere"
with = { link = "base", radius = 1, tolerance = 0.002 }

[[evidence]]
id = "picture"
part = "a"
title = "The robot in RViz"
names = ["task 1 step 8"]

[[test.ignore]]
mutants = ["name *"]
reason = "Names are not graded."

[late]
due = 2026-11-20T23:59:00+01:00
grace_minutes = 15
percent_per_day = 10
floor_percent = 50

[adjust.box]
action = "drop"
reason = "The handout had another size."
"""
WITH_DEFAULTS = """\
id = "lab0"
title = "Lab 0"
[defaults]
part = "a"
points = 2
about = "The base"
with.shows_box = { link = "base", tolerance = 0.002 }
with.frame_at = { tolerance = 0.002 }
[[part]]
id = "a"
title = "Part A"
[[criterion]]
id = "box"
title = "It is a box"
check = "shows_box"
with = { size = [1, 2.5, 3] }
"""


def read(text: str) -> dict[str, Any]:
    """Return a rubric as a validator takes it: date and time are strings."""
    data = tomllib.loads(text)
    if "late" in data:
        data["late"]["due"] = str(data["late"]["due"])
    return data


def loads(folder: Path, text: str) -> bool:
    """Return whether the grader loads a rubric."""
    (folder / "lab.toml").write_text(text, encoding="utf-8")
    try:
        load_rubric(str(folder / "lab.toml"))
    except RubricError:
        return False
    return True


def keys_without_description(schema: Any, path: str = "") -> Iterator[str]:
    """Yield the path of each key in a schema that has no description."""
    if isinstance(schema, list):
        for index, item in enumerate(schema):
            yield from keys_without_description(item, f"{path}/{index}")
    elif isinstance(schema, dict):
        described = schema.get("properties", {}) if schema.get("type") == "object" else {}
        without = [name for name, value in described.items() if "description" not in value and "$ref" not in value]
        yield from (f"{path}/{name}" for name in without)
        for name, value in schema.items():
            yield from keys_without_description(value, f"{path}/{name}")


def test_every_key_has_a_description() -> None:
    """An editor shows the meaning of every key, and of every argument of every check."""
    assert list(keys_without_description(SCHEMA)) == []
    for check in own_checks():
        described = SCHEMA["$defs"][check.name]["properties"]
        meanings = {name: argument["description"] for name, argument in described.items()}
        assert meanings == check.documentation.arguments
        assert {name: argument["default"] for name, argument in described.items() if "default" in argument} == {
            name: json.loads(json.dumps(parameter.default))
            for name, parameter in check.parameters.items()
            if parameter.default is not None
        }


def test_an_editor_completes_the_names_of_checks() -> None:
    """Each name has the fact that the check tests; taplo shows it beside the name."""
    check = SCHEMA["properties"]["criterion"]["items"]["properties"]["check"]
    assert check["enum"] == check_names()
    facts = dict(zip(check["enum"], check["x-taplo"]["docs"]["enumValues"], strict=True))
    assert facts["shows_sphere"] == "A link shows a sphere of the given radius in metres."


@pytest.mark.parametrize("path", RUBRICS, ids=lambda path: path.name)
def test_rubrics_are_valid(path: Path) -> None:
    """The shipped rubrics and that of the plug-in template, if its package is installed, are valid."""
    data = read(path.read_text(encoding="utf-8"))
    if {row["check"] for row in data["criterion"]} <= set(check_names()):
        VALIDATOR.validate(data)


def test_every_key_is_valid(tmp_path: Path) -> None:
    """A rubric with every key is valid under the schema, and loads."""
    assert loads(tmp_path, EVERY_KEY)
    assert loads(tmp_path, WITH_DEFAULTS)
    every = read(EVERY_KEY)
    VALIDATOR.validate(every)
    VALIDATOR.validate(read(WITH_DEFAULTS))
    frame = every["criterion"][1]
    used = [(RUBRIC, every), (PART, every["part"][0]), (CRITERION, every["criterion"][0] | frame)]
    used += [(CARRIED, frame["carried"]), (EVIDENCE, every["evidence"][0]), (LATE, every["late"])]
    used += [(ADJUSTMENT, every["adjust"]["box"])]
    used += [(TEST, every["test"]), (IGNORE, every["test"]["ignore"][0])]
    used += [(DEFAULTS, tomllib.loads(WITH_DEFAULTS)["defaults"])]
    for table, row in used:
        assert set(row) == set(table.keys) - ({"defaults"} if table is RUBRIC else set())


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('title = "Lab 0"', ""),
        ('title = "Lab 0"', 'titel = "Lab 0"'),
        ("points = 6.5\nanswers", 'points = "6.5"\nanswers'),
        ('needs = "urdf"', 'needs = "robot"'),
        ('hints = "edit"', 'hints = "all"'),
        ('answers = "lab0.answers.toml"', 'answers = "lab0.answers"'),
        ('part = "a"\nabout', "about"),
        ("points = 2.5", ""),
        ("points = 2.5", "points = -1"),
        ('check = "shows_box"', 'check = "show_box"'),
        ('check = "shows_box"', ""),
        ("size = [1, 2.5, 3]", "size = [1, 2.5]"),
        ("size = [1, 2.5, 3]", "size = [1, 2.5, -3]"),
        ("size = [1, 2.5, 3], ", ""),
        ("tolerance = 0.002 }\nfeedback", 'tolerance = "2 mm" }\nfeedback'),
        ("tolerance = 0.002 }\nfeedback", "tolerance = -1 }\nfeedback"),
        ("tolerance = 0.002 }\nfeedback", "tolerance = 0.002, colour = 1 }\nfeedback"),
        ("at = { shoulder = 90,", 'at = { shoulder = "90",'),
        ('from = ["box"]', "from = []"),
        ("radius = 1", "radius = true"),
        ("radius = 1, ", ""),
        ('check = "shows_sphere"', 'check = "sphere"'),
        ("percent_per_day = 10", "percent_per_day = 101"),
        ("names = [", "name = ["),
    ],
)
def test_mistakes_are_found(old: str, new: str, tmp_path: Path) -> None:
    """What the schema rejects, the loader rejects as well."""
    text = EVERY_KEY.replace(old, new)
    assert text != EVERY_KEY
    assert not VALIDATOR.is_valid(read(text))
    assert not loads(tmp_path, text)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("with.shows_box = { link", "with.shows_boxes = { link"),
        ("with.shows_box = { link", "with.shows_box = { linke"),
        ("points = 2", 'points = "2"'),
        ("size = [1, 2.5, 3]", "size = [1, 2.5]"),
    ],
)
def test_mistakes_with_defaults_are_found(old: str, new: str, tmp_path: Path) -> None:
    """Defaults are checked by the schema as well."""
    text = WITH_DEFAULTS.replace(old, new)
    assert text != WITH_DEFAULTS
    assert not VALIDATOR.is_valid(read(text))
    assert not loads(tmp_path, text)
