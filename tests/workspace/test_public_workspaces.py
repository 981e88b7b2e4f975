"""The table of what is said of public workspaces, each finding of which somebody read."""

import re
import tomllib
from collections import Counter

from grader.workspace.rules.rule_table import RULES
from tests.command_line import ROOT

_TABLE = ROOT / "tests/workspace/public_workspaces.toml"
_LEAST = 0.97  # of the errors are true


def test_the_errors_of_public_workspaces_are_true() -> None:
    """Each error has a place in a known commit; nearly all are true, and the others have a reason."""
    workspaces = tomllib.loads(_TABLE.read_text(encoding="utf-8"))["workspace"]
    verdicts: Counter[bool] = Counter()
    for workspace in workspaces:
        assert re.fullmatch(r"[\w.-]+/[\w.-]+", workspace["repository"])
        assert re.fullmatch(r"[0-9a-f]{40}", workspace["commit"])
        for error in workspace.get("error", ()):
            assert error["is_true"] == ("why" not in error), error
            verdicts[error["is_true"]] += len(error["places"])
    assert len({workspace["repository"] for workspace in workspaces}) == len(workspaces) >= 40
    assert verdicts[True] >= _LEAST * verdicts.total()


def test_the_rules_without_findings_are_rules() -> None:
    """Each rule that found no error in public workspaces is a rule, and is listed once."""
    names = tomllib.loads(_TABLE.read_text(encoding="utf-8"))["without_findings"]
    assert len({*names}) == len(names) > 50
    assert {*names} <= RULES.keys()


_RULES = ROOT / "tests/workspace/public_rules.toml"
_LEAST_OF_RULE = 0.9  # of the findings of a rule are true


def test_the_findings_of_a_rule_are_true() -> None:
    """Each rule of which the findings in public workspaces were counted is true in nearly all of them."""
    table = tomllib.loads(_RULES.read_text(encoding="utf-8"))
    names = [rule["name"] for rule in table["rule"]]
    assert len({*names}) == len(names)
    assert {*names} <= RULES.keys()
    for rule in table["rule"]:
        assert rule["true"] >= _LEAST_OF_RULE * (rule["true"] + rule["false"]), rule
