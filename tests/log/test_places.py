"""Each kind of place answers its message where the files have a mistake, and no place where it is fixed."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from grader.workspace.api import LogAnswer
from tests.log.log_workspaces import explain, make_workspace

_ROWS = tomllib.loads(Path(__file__).with_name("place_rows.toml").read_text("utf-8"))["row"]


def _placed(row: Mapping[str, Any]) -> list[LogAnswer]:
    """Return the answers with a place to the log of a row."""
    files = {"README.md": "For ROS 2 Jazzy.", **row.get("around", {})}
    files |= make_workspace(row.get("files", {}), row.get("nodes", ""))
    if "other" in row:
        files |= make_workspace({}, row["other"], name="other")
    return [answer for answer in explain(files, row["log"]) if answer.location is not None]


@pytest.mark.parametrize("row", _ROWS, ids=lambda row: row["about"])
def test_a_place_answers_a_message(row: Mapping[str, Any]) -> None:
    """It is the first place of all, and its relation to the message is said."""
    first, *_ = _placed(row)
    assert first.location is not None
    assert first.location.file_and_line == row["place"]
    assert first.relation == row.get("relation", "explains")
    assert row.get("message", "") in first.message


@pytest.mark.parametrize(
    "row", [row for row in _ROWS if "fixed" in row], ids=lambda row: row["about"]
)
def test_no_place_answers_it_where_the_mistake_is_fixed(row: Mapping[str, Any]) -> None:
    """Neither as the cause nor as a line that is named."""
    fixed = {
        **row,
        **row["fixed"],
        "files": {**row.get("files", {}), **row["fixed"].get("files", {})},
    }
    assert [answer for answer in _placed(fixed) if answer.relation != "see also"] == []
