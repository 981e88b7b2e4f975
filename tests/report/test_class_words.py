"""What is said of a class in every format for people."""

import pytest

from grader.classroom.gradebook.identical import IdenticalWork
from grader.report.class_words import edit_lines, identical_line, percent
from grader.source import Edit

TREES = ("ash", "birch", "cedar")


@pytest.mark.parametrize(
    ("same_file", "line"),
    [
        ((), "Ash (ash), birch and cedar: the same robot"),
        ((TREES,), "Ash (ash), birch and cedar: the same file"),
        ((("ash", "cedar"),), "Ash (ash), birch and cedar: the same robot; the same file: Ash (ash) and cedar"),
    ],
)
def test_identical_work_in_a_line(same_file: tuple[tuple[str, ...], ...], line: str) -> None:
    """It says who of them has the same file."""
    names = {"ash": "Ash (ash)", "birch": "birch", "cedar": "cedar"}
    assert identical_line(IdenticalWork(TREES, same_file), names) == line


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
