"""A rubric with criteria about the graph is tested with mutants of names and types of what nodes open."""

from pathlib import Path

import pytest

from grader.lab.authoring.rubric_test import Trial
from grader.lab.rubric.rubric import load_rubric
from tests.labs.test_graph_labs import rubric_text, written

pytestmark = pytest.mark.slow


def test_names_and_types_are_changed(tmp_path: Path) -> None:
    """A topic of another type is found, and so are misspelt topics, services and frames on the way."""
    written("hallway", "solution", tmp_path)
    text = rubric_text("hallway").replace('title = "Lab"', 'title = "Lab"\nreference = "hallway"')
    (tmp_path / "lab.toml").write_text(text, "utf-8")
    trial = Trial(load_rubric(str(tmp_path / "lab.toml")))
    fates = {mutant.id: trial.outcome(mutant).fate for mutant in trial.mutants()}
    retyped = [fate for name, fate in fates.items() if name.startswith("type of a topic changed")]
    assert retyped == ["caught"]
    caught = [name for name, fate in fates.items() if fate == "caught"]
    for word in ("driver.py nearest", "eye.py scan", "driver.py cmd_vel"):
        assert any(name.endswith(word) for name in caught), caught
