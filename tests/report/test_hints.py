"""Hints: each format shows the proven change in place of the feedback, once, and its edits where the format has a place for them."""

import pytest

from grader.base.source import Edit, Source
from grader.lab.grading.report import ManualMark
from grader.report.formats import Format, render
from grader.report.locations import diff_lines
from tests.report.reports import hinted

pytestmark = pytest.mark.slow


def test_a_manual_mark_leaves_no_hint() -> None:
    """What a person has graded is not to be changed."""
    report = hinted()
    results = tuple(
        result._replace(manual_mark=ManualMark(result.points, "Ada")) for result in report.results
    )
    assert "Change" not in render(report._replace(results=results), Format.TERMINAL)


def test_a_diff_names_a_renamed_file() -> None:
    """By its new path; a file that cannot be read again is new."""
    renamed = Edit("launch/a.py", 1, 1, "", "", renamed="launch/a.launch.py")
    assert diff_lines((renamed,), lambda _: None) == ["--- /dev/null", "+++ launch/a.launch.py"]


TEXT = "<a>\n  <b x='1' y='2'/>\r\n  <c/>\n</a>\n"


@pytest.mark.parametrize(
    ("edits", "expected"),
    [
        (
            [Edit("f", 2, 6, "x='1'", "x='3'")],
            ["@@ line 2 @@", "-  <b x='1' y='2'/>", "+  <b x='3' y='2'/>"],
        ),
        (
            [Edit("f", 2, 12, "y='2'", "y='4'"), Edit("f", 2, 6, "x='1'", "x='3'")],
            ["@@ line 2 @@", "-  <b x='1' y='2'/>", "+  <b x='3' y='4'/>"],
        ),
        ([Edit("f", 3, 1, "", "  <d/>\n")], ["@@ line 3 @@", "+  <d/>"]),
        ([Edit("f", 2, 1, "  <b x='1' y='2'/>\r\n", "")], ["@@ line 2 @@", "-  <b x='1' y='2'/>"]),
        (
            [Edit("f", 2, 3, "<b x='1' y='2'/>\r\n  <c/>", "<e/>")],
            ["@@ line 2 @@", "-  <b x='1' y='2'/>", "-  <c/>", "+  <e/>"],
        ),
        (
            [Edit("f", 3, 3, "<other/>", "<d/>")],
            ["@@ line 3 @@", "-<other/>", "+<d/>"],
        ),  # of another version
        (
            [Edit("f", 1, 1, "<a", "<r"), Edit("f", 4, 3, "a", "r")],
            ["@@ line 1 @@", "-<a>", "+<r>", "@@ line 4 @@", "-</a>", "+</r>"],
        ),
    ],
)
def test_a_diff_has_whole_lines(edits: list[Edit], expected: list[str]) -> None:
    """Edits of one line are shown together, whatever its line break; lines that do not change are not shown."""
    assert diff_lines(edits, lambda _: Source("f", TEXT))[2:] == expected


def test_a_diff_is_limited() -> None:
    """Of a line that is a whole file only the change is shown, and of many lines the first ones."""
    line = "<a/>" * 1000 + "<b/>"
    assert diff_lines([Edit("f", 1, 4001, "<b/>", "<c/>")], lambda _: Source("f", line))[2:] == [
        "@@ line 1 @@",
        "-<b/>",
        "+<c/>",
    ]
    many = diff_lines([Edit("f", 1, 1, "", "<x/>\n" * 100)], lambda _: Source("f", ""))
    assert len(many) == 41
    assert many[-1] == "... and 63 more"
