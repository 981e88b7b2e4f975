"""The table of what a reviewer saw in public workspaces before `inspect` read them."""

import re
import tomllib
from collections.abc import Iterable, Sequence
from typing import Any

from grader.ros.workspace.rules.problem_kinds import EVERY_KIND
from tests.command_line import ROOT

_TABLE = tomllib.loads(
    (ROOT / "tests/workspace/reviewed_workspaces.toml").read_text(encoding="utf-8")
)
_MISTAKES = [mistake for each in _TABLE["workspace"] for mistake in each["mistake"]]
_CODES = {kind.code for kind in EVERY_KIND}
_NEW = 4  # the workspaces that were reviewed last
# Measured, not wanted: how many were found when the workspaces were read first, of how many; and with later rules.
_FOUND = {"first": (48, 140), "new": (31, 67), "later": (101, 207)}
_FOUND_OF_WHAT_STOPS = {"first": (18, 46), "new": (4, 10), "later": (31, 56)}


def _counted(mistakes: Iterable[Any]) -> tuple[int, int]:
    """Return how many mistakes were found when their workspace was read first, and how many there are."""
    were_found = ["rule" in mistake and "is_later" not in mistake for mistake in mistakes]
    return sum(were_found), len(were_found)


def _shares(mistakes: Sequence[Any]) -> dict[str, tuple[int, int]]:
    """Return what was found of the first workspaces, of those that are new, and what is found now."""
    new = [mistake for each in _TABLE["workspace"][-_NEW:] for mistake in each["mistake"]]
    return {
        "first": _counted(each for each in mistakes if each not in new),
        "new": _counted(each for each in mistakes if each in new),
        "later": (sum("rule" in each for each in mistakes), len(mistakes)),
    }


def test_each_mistake_has_its_place_in_a_known_commit() -> None:
    """Workspaces that no other table names; each row says what, where, and which code found it."""
    repositories = [workspace["repository"] for workspace in _TABLE["workspace"]]
    assert len({*repositories}) == len(repositories) == 16
    others = (ROOT / "tests/workspace/public_workspaces.toml").read_text(encoding="utf-8")
    for workspace in _TABLE["workspace"]:
        assert re.fullmatch(r"[\w.-]+/[\w.-]+", workspace["repository"])
        assert workspace["repository"] not in others
        assert re.fullmatch(r"[0-9a-f]{40}", workspace["commit"])
    for mistake in _MISTAKES:
        assert {"what", "place", "kind", "half", "stops"} <= mistake.keys()
        assert re.fullmatch(r"[^:]+:[1-9]\d*", mistake["place"]), mistake
        assert mistake["half"] in ("python", "cpp", "files"), mistake
        assert isinstance(mistake["stops"], bool), mistake
        assert mistake.get("rule") in {None, *_CODES}, mistake
        assert mistake.get("is_later") in (None, True), mistake
        assert "rule" in mistake or "is_later" not in mistake, mistake


def test_the_share_that_was_found_is_the_one_that_is_stated() -> None:
    """Of all rows, and of those that stop something; every error and warning was true."""
    assert _shares(_MISTAKES) == _FOUND
    assert _shares([each for each in _MISTAKES if each["stops"]]) == _FOUND_OF_WHAT_STOPS
    for findings in (_TABLE["findings"], _TABLE["later_findings"]):
        assert findings["true_errors"] <= findings["errors"]
        assert findings["true_warnings"] <= findings["warnings"]
