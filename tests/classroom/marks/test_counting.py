"""Which rows of files of marks count, and which are refused."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from grader.base.errors import InputError
from tests.classroom.marks import folder_of, read, said

CASES = tomllib.loads(Path(__file__).with_name("counting.toml").read_text(encoding="utf-8"))["case"]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["about"])
def test_the_marks_that_count(case: dict[str, Any], tmp_path: Path) -> None:
    """As the table says."""
    folder = folder_of(tmp_path, case["files"])
    if "error" in case or "last" in case:
        with pytest.raises(InputError) as caught:
            read(folder)
        lines = str(caught.value).splitlines()
        assert (
            lines[-1:] == [case["last"]] if "last" in case else lines == case["error"].splitlines()
        )
        return
    marks = read(folder)
    assert {" ".join(key): said(mark) for key, mark in marks.counting.items()} == case.get(
        "counting", {}
    )
    assert {" ".join(key): mark.comment for key, mark in marks.comments.items()} == case.get(
        "comments", {}
    )
    assert marks.ignored == case.get("ignored", [])
