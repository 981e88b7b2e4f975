"""Small workspaces in which `grader inspect` says what is wrong, and nothing of what is right."""

from pathlib import Path

import pytest

from tests.workspace.small_workspaces import SMALL_WORKSPACES, SmallWorkspace
from tests.workspace.test_rule_examples import problems_of


@pytest.mark.parametrize("small", SMALL_WORKSPACES, ids=[small.about for small in SMALL_WORKSPACES])
def test_a_small_workspace(small: SmallWorkspace, tmp_path: Path) -> None:
    """Each line that is to be said is said, and nothing else of the codes."""
    lines: list[str] = []
    for problem in problems_of(tmp_path, small.files):
        at = problem["location"]
        if problem["code"] in small.codes and problem["severity"] != "note":
            lines.append(f"{at['path']}:{at['line']} {problem['message']}")
    for line in small.said:
        place, _, part = line.partition(" ")
        assert any(each.startswith(f"{place} ") and part in each for each in lines), lines
    assert len(lines) == len(small.said), lines
