"""What of a reference becomes a criterion: what the handout leaves open is not asked for."""

from typing import Any

import pytest

from grader.lab.authoring.draft_choice import DraftChoice
from grader.lab.authoring.expectations import Expectation

_LOOKUP = {"target": "odom", "source": "base"}


def _expectation(check: str, arguments: dict[str, Any]) -> Expectation:
    return Expectation("The package", check, arguments, check, package="")


@pytest.mark.parametrize(
    ("check", "arguments", "free", "left"),
    [
        ("looks_up", _LOOKUP, {"map"}, _LOOKUP),
        ("looks_up", _LOOKUP, {"odom"}, None),
        ("looks_up", _LOOKUP, {"base"}, None),
        ("node_runs", {"launch": "a", "spawns": ["arm", "hand"]}, {"arm"}, ["hand"]),
        ("node_runs", {"launch": "a", "spawns": ["arm"]}, {"arm"}, None),
    ],
)
def test_names_that_are_free(
    check: str, arguments: dict[str, Any], free: set[str], left: Any
) -> None:
    """A criterion about nothing else is omitted."""
    expectation = DraftChoice(free=frozenset(free)).freed(_expectation(check, arguments), None)
    if left is None:
        assert expectation is None
    else:
        assert isinstance(expectation, Expectation)
        assert expectation.arguments.get("spawns", expectation.arguments) == left


@pytest.mark.parametrize(
    ("check", "word"), [("looks_up", "nodes"), ("node_runs", "nodes"), ("world_has", "worlds")]
)
def test_kinds_that_are_omitted(check: str, word: str) -> None:
    """One word stands for the checks of a kind."""
    assert not DraftChoice(without=frozenset({word})).takes(_expectation(check, {}))
    assert DraftChoice(without=frozenset({"masses"})).takes(_expectation(check, {}))
