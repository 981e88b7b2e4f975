"""Each symptom of a rule explains its message where the rule is broken, and nothing where it is not."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from grader.workspace.api import RULES, LogAnswer
from tests.log.log_workspaces import explain
from tests.workspace.rule_examples import EXAMPLES, files_of_example

_ROWS = tomllib.loads(Path(__file__).with_name("symptom_rows.toml").read_text("utf-8"))["row"]


def _explained(row: Mapping[str, Any], side: str) -> list[LogAnswer]:
    """Return what explains the log of a row in one side of the example of its rule."""
    example = {**EXAMPLES[row["rule"]], **row.get("example", {})}
    if side == "right":
        example |= row.get("fixed", {})
    release = row.get("release", "Jazzy")
    files = {"README.md": f"For ROS 2 {release}.", **files_of_example(example, side).files}
    return [
        answer
        for answer in explain(files, row["log"])
        if answer.location is not None and answer.relation == "explains"
    ]


@pytest.mark.parametrize("row", _ROWS, ids=lambda row: f"{row['rule']} {row['symptom']}")
def test_a_symptom_explains_its_message(row: Mapping[str, Any]) -> None:
    """By a finding of the rule with its code; where the mistake is fixed, nothing is the cause."""
    codes = (RULES[row["rule"]].kind.code, RULES[row["rule"]].doubtful.code)
    wrong = [answer for answer in _explained(row, "wrong") if answer.output == row["symptom"]]
    assert any(answer.code in codes for answer in wrong), wrong
    assert _explained(row, "right") == []


def test_each_symptom_of_a_rule_has_a_row() -> None:
    """A symptom that is never shown may be wrong."""
    symptoms = {(rule.name, each.name) for rule in RULES.values() for each in rule.symptoms}
    assert {(row["rule"], row["symptom"]) for row in _ROWS} == symptoms
