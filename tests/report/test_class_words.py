"""What is said of a class in every format for people."""

import pytest

from grader.report.class_words import edit_lines, percent
from grader.source import Edit


@pytest.mark.parametrize(("share", "words"), [(0, "0%"), (0.001, "1%"), (0.5, "50%"), (0.999, "99%"), (1, "100%")])
def test_a_share_is_not_rounded_to_all_or_none(share: float, words: str) -> None:
    """Only all are 100 %, and only none 0 %."""
    assert percent(share) == words


def test_edits_are_cut() -> None:
    """Long lines, many lines and many edits are cut, with a line that counts the rest; a renamed file is named."""
    rename = Edit("a.urdf", 1, 1, "", "", "b.urdf")
    long = Edit("a.urdf", 1, 1, "x" * 300, "\n".join("123456789"))
    lines = list(edit_lines([rename, long, *[Edit("a.urdf", 1, 1, "x", "y")] * 3]))
    assert lines[0] == (" ", "rename a.urdf to b.urdf")
    assert lines[1] == ("-", "x" * 197 + "...")
    assert lines[7:9] == [("+", "6"), (" ", "... 3 more lines")]
    assert lines[-1] == (" ", "... 1 more edit")
