"""The table of what a reviewer saw in public workspaces before `inspect` read them."""

import re
import tomllib
from collections.abc import Iterable
from typing import Any

from grader.workspace.rules.problem_kinds import EVERY_KIND
from tests.command_line import ROOT

_TABLE = tomllib.loads(
    (ROOT / "tests/workspace/reviewed_workspaces.toml").read_text(encoding="utf-8")
)
_MISTAKES = [mistake for each in _TABLE["workspace"] for mistake in each["mistake"]]
_CODES = {kind.code for kind in EVERY_KIND}
# The workspaces that were reviewed before there were rules for their mistakes, those that were reviewed then, and the last ones.
_REVIEWS = {"first": slice(0, 12), "new": slice(12, 16), "newest": slice(16, None)}
# Measured, not wanted: how many were found when the workspaces were read first, of how many; and with later rules.
_FOUND = {"first": (48, 140), "new": (31, 66), "newest": (18, 37), "later": (150, 243)}
_FOUND_OF_WHAT_STOPS = {"first": (18, 46), "new": (4, 10), "newest": (5, 14), "later": (45, 70)}


def _counted(mistakes: Iterable[Any]) -> tuple[int, int]:
    """Return how many mistakes were found when their workspace was read first, and how many there are."""
    were_found = ["rule" in mistake and "is_later" not in mistake for mistake in mistakes]
    return sum(were_found), len(were_found)


def _shares(*, that_stop: bool) -> dict[str, tuple[int, int]]:
    """Return what was found of the workspaces of each review, and what is found now."""
    mistakes = [each for each in _MISTAKES if each["stops"] or not that_stop]
    shares = {"later": (sum("rule" in each for each in mistakes), len(mistakes))}
    for name, places in _REVIEWS.items():
        of_review = [each for row in _TABLE["workspace"][places] for each in row["mistake"]]
        shares[name] = _counted(each for each in of_review if each["stops"] or not that_stop)
    return shares


def test_each_mistake_has_its_place_in_a_known_commit() -> None:
    """Workspaces that no other table names; each row says what, where, and which code found it."""
    repositories = [workspace["repository"] for workspace in _TABLE["workspace"]]
    assert len({*repositories}) == len(repositories) == 18
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
    assert _shares(that_stop=False) == _FOUND
    assert _shares(that_stop=True) == _FOUND_OF_WHAT_STOPS
    for findings in (_TABLE["findings"], _TABLE["later_findings"], _TABLE["newest_findings"]):
        assert findings["true_errors"] <= findings["errors"]
        assert findings["true_warnings"] <= findings["warnings"]
