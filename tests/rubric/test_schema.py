"""The JSON Schema of a rubric: an editor with it describes every key, and finds the mistakes that the loader finds."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.lab.checks.registry import check_names, own_checks
from grader.lab.rubric.keys import (
    ADJUSTMENT,
    CARRIED,
    CRITERION,
    DEFAULTS,
    EVIDENCE,
    IGNORE,
    LATE,
    PART,
    RUBRIC,
    TEST,
)
from grader.lab.rubric.rubric import load_rubric, shipped_rubrics
from tests.command_line import ROOT, run
from tests.corpus.cases import CORPUS, read_corpus

SCHEMA = json.loads(run(("schema", "rubric")).stdout)
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
EVERY_KEY, WITH_DEFAULTS = (
    CORPUS / "rubrics" / name for name in ("every-key.toml", "with-defaults.toml")
)
RUBRICS = [
    EVERY_KEY,
    WITH_DEFAULTS,
    *shipped_rubrics().values(),
    *(ROOT / "docs").rglob("*_lab.toml"),
]
MISTAKES = [case for case in read_corpus() if case.path == CORPUS / "rubrics/schema.toml"]


def read(text: str) -> dict[str, Any]:
    """Return a rubric as a validator takes it: date and time are strings."""
    data = tomllib.loads(text)
    if "late" in data:
        data["late"]["due"] = str(data["late"]["due"])
    return data


def keys_without_description(schema: Any, path: str = "") -> Iterator[str]:
    """Yield the path of each key in a schema that has no description."""
    if isinstance(schema, list):
        for index, item in enumerate(schema):
            yield from keys_without_description(item, f"{path}/{index}")
    elif isinstance(schema, dict):
        described = schema.get("properties", {}) if schema.get("type") == "object" else {}
        without = [
            name
            for name, value in described.items()
            if "description" not in value and "$ref" not in value
        ]
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
        assert {
            name: argument["default"]
            for name, argument in described.items()
            if "default" in argument
        } == {
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
    """The shipped rubrics, those with every key, and that of the plug-in template, if its package is installed."""
    data = read(path.read_text(encoding="utf-8"))
    if {row["check"] for row in data["criterion"] if "check" in row} <= set(check_names()):
        VALIDATOR.validate(data)


def test_every_key_is_there() -> None:
    """The two rubrics together have every key of every table, and load."""
    every, defaults = (
        read(path.read_text(encoding="utf-8")) for path in (EVERY_KEY, WITH_DEFAULTS)
    )
    assert (load_rubric(str(EVERY_KEY)).id, load_rubric(str(WITH_DEFAULTS)).id) == ("lab0", "lab0")
    frame = every["criterion"][1]
    used = [(RUBRIC, every), (PART, every["part"][0]), (CRITERION, every["criterion"][0] | frame)]
    used += [(CARRIED, frame["carried"]), (EVIDENCE, every["evidence"][0]), (LATE, every["late"])]
    used += [(ADJUSTMENT, every["adjust"]["box"])]
    used += [
        (TEST, every["test"]),
        (IGNORE, every["test"]["ignore"][0]),
        (DEFAULTS, defaults["defaults"]),
    ]
    for table, row in used:
        assert set(row) == set(table.keys) - ({"defaults"} if table is RUBRIC else set())


@pytest.mark.parametrize("case", MISTAKES, ids=[case.about for case in MISTAKES])
def test_mistakes_are_found(case: Any) -> None:
    """The loader rejects what the schema rejects."""
    ((_, old, new),) = case.edits
    text = (ROOT / case.copies["lab.toml"]).read_text(encoding="utf-8")
    assert case.expected["exit"] == "2"
    assert not VALIDATOR.is_valid(read(text.replace(old, new)))
