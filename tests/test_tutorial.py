"""The tutorial of rubrics works as it is written, and the examples of the reference are rubrics."""

import json
import re
import tomllib
from decimal import Decimal
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from grader.lab.checks.registry import find_check
from grader.lab.rubric.keys import CRITERION, DEFAULTS, PART, RUBRIC
from grader.lab.rubric.rubric import load_rubric
from tests.command_line import ROOT
from tests.tutorial import CODE_PAGE, PAGE, Step, follow

REFERENCE = (ROOT / "docs" / "rubric-reference.md").read_text(encoding="utf-8")
BLOCKS: list[dict[str, Any]] = [
    tomllib.loads(block, parse_float=Decimal)
    for block in re.findall(r"^```toml\n(.*?)^```", REFERENCE, re.DOTALL | re.MULTILINE)
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder in which the tutorial is followed."""
    return tmp_path_factory.mktemp("tutorial")


@pytest.fixture(scope="module")
def followed(folder: Path) -> tuple[str, list[Step]]:
    """Return the page with current outputs, and what was run."""
    return follow(PAGE.read_text(encoding="utf-8"), folder)


def test_every_command_prints_what_the_page_shows(followed: tuple[str, list[Step]]) -> None:
    """The outputs on the page are current, and every command that is on it was run."""
    page, steps = followed
    assert page == PAGE.read_text(encoding="utf-8"), "run python -m tests.tutorial"
    assert "".join(step.commands for step in steps).count("grader ") == len(
        re.findall("^grader [a-z]", page, re.M)
    )
    for step in steps:
        expected = 0 if not (step.shown or "").startswith("grader: ") else 2
        lost = "✗" in step.printed or "differ from their expected.toml" in step.printed
        assert step.code == (1 if lost else expected), step


def test_the_tutorial_for_code_prints_what_it_shows(tmp_path: Path) -> None:
    """From a solution to a tested rubric: each command was run, and only the mistake loses points."""
    page, steps = follow(CODE_PAGE.read_text(encoding="utf-8"), tmp_path)
    assert page == CODE_PAGE.read_text(encoding="utf-8"), "run python -m tests.tutorial"
    assert [step.code for step in steps] == [0, 0, 0, 0, 0, 1]
    assert len(load_rubric(str(tmp_path / "lab.toml")).criteria) == 12


def test_the_rubric_of_the_tutorial_is_valid(
    folder: Path, followed: tuple[str, list[Step]]
) -> None:
    """It loads, and an editor finds nothing to complain of."""
    text = (folder / "my_lab.toml").read_text(encoding="utf-8")
    assert len(load_rubric(str(folder / "my_lab.toml")).criteria) > 10
    assert text.startswith("#:schema ./rubric.schema.json\n")
    schema = json.loads((folder / "rubric.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator(schema).validate(tomllib.loads(text))


@pytest.mark.parametrize(
    "block", [block for block in BLOCKS if "criterion" in block or "defaults" in block]
)
def test_examples_of_the_reference_are_criteria(block: dict[str, Any]) -> None:
    """Each has keys that exist, a check that exists, and arguments that it takes, with all that it needs."""
    assert set(block) <= set(RUBRIC.keys)
    defaults = block.get("defaults", {})
    assert set(defaults) <= set(DEFAULTS.keys)
    rows = [*block.get("criterion", [])]
    for carried in (row.get("carried", []) for row in block.get("criterion", [])):
        rows += [carried] if isinstance(carried, dict) else carried
    for row in rows:
        assert set(row) <= {*CRITERION.keys, "from"}
        check = find_check(row["check"])
        assert check is not None
        given = {**defaults.get("with", {}).get(check.name, {}), **row["with"]}
        for name, value in given.items():
            check.parameters[name].type.parse(value)
        assert {name for name, parameter in check.parameters.items() if parameter.required} <= set(
            given
        )


def test_every_key_is_on_the_reference() -> None:
    """The page is generated from the tables; its sections name the keys that need more than a line."""
    for table in (RUBRIC, PART, CRITERION, DEFAULTS):
        for key in table.keys:
            assert f"\n- `{key}` (" in REFERENCE


def test_a_new_output_keeps_what_a_page_leaves_out(tmp_path: Path) -> None:
    """A line with "..." stays where it still matches: a time of today would fail tomorrow."""
    page = "```sh\ngrader diff\n```\n\n```\nrun 2 of ...\n1 student\n```\n"
    written, _ = follow(page, tmp_path, lambda *_: ("run 2 of 13:12\n2 students", 0))
    assert written == page.replace("1 student", "2 students")
