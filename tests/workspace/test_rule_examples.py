"""Each rule has an example, in which `grader inspect` finds what breaks the rule."""

from pathlib import Path
from typing import Any

import pytest

from grader.ros.python import budget
from grader.workspace.rules.rule_table import NAME_CATALOGUE, RULES
from tests.test_catalogue_examples import ENTRIES, KINDS
from tests.test_misconfigurations import inspected
from tests.workspace.rule_examples import (
    EXAMPLES,
    FRAMES,
    VARIANTS,
    files_of_rule,
    files_of_variant,
)

_MAX_LINES, _MAX_WIDTH = 16, 110


def problems_of(folder: Path, files: dict[str, str]) -> list[dict[str, Any]]:
    """Return what `grader inspect` reports of a package."""
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return inspected(folder)


def test_a_code_has_the_example_of_a_rule() -> None:
    """In which a problem of the code is found."""
    for kind in NAME_CATALOGUE:
        rule = RULES[ENTRIES[kind.code]["example"]]
        assert kind in (rule.kind, rule.doubtful), kind.code


def test_every_rule_has_an_example() -> None:
    """Each is short, and its two sides differ; no frame is unused."""
    used = {"rover.launch.py"}
    for example in (*EXAMPLES.values(), *KINDS.values()):
        used |= {example.get("frame", "rover.launch.py"), *example.get("beside", {})}
    for name, example in EXAMPLES.items():
        assert example["wrong"] != example["right"], name
        for text in (example["wrong"], example["right"]):
            assert text.count("\n") <= _MAX_LINES, name
            assert max(map(len, text.split("\n"))) <= _MAX_WIDTH, name
    assert set(FRAMES) <= used


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_breaks_the_rule_where_it_says(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The wrong side has a problem of the rule at a line of the example, and the right one has neither it nor an error."""
    if name == "names-compared":  # a file that is short enough for an example asks for less
        monkeypatch.setattr(budget, "_OF_WORKSPACE", 5_000)
    wrong, right = files_of_rule(name, "wrong"), files_of_rule(name, "right")
    found = problems_of(tmp_path / "wrong", wrong.files)
    places = [each["location"] for each in found if each["rule"] == name]
    at = EXAMPLES[name]["at"]
    if not at:
        assert any(it["path"] == wrong.path and it["line"] in wrong.lines for it in places), found
    else:
        assert at in [place["path"] for place in places], found
    left = problems_of(tmp_path / "right", right.files)
    assert [each for each in left if each["rule"] == name or each["severity"] == "error"] == []


@pytest.mark.parametrize("variant", VARIANTS, ids=[variant["about"] for variant in VARIANTS])
def test_a_variant_of_an_example(variant: dict[str, Any], tmp_path: Path) -> None:
    """What may be right is not reported, and what is wrong in another way is."""
    problems = problems_of(tmp_path, files_of_variant(variant))
    messages = [each["message"] for each in problems if each["rule"] == variant["of"]]
    if variant["found"] is False:
        assert messages == []
    else:
        assert any(variant["found"] in message for message in messages), problems
