"""Hints: each format shows the proven change in place of the feedback, once, and its edits where the format has a place for them."""

from typing import Any

import pytest

from grader.grading.report import ManualMark, Result
from grader.report.formats import Format, render
from grader.report.locations import diff_lines
from grader.source import Edit, Source
from tests.report.reports import hinted


def _with_hint(results: tuple[Result, ...], **changes: Any) -> tuple[Result, ...]:
    return tuple(it._replace(hint=it.hint._replace(**changes)) if it.hint is not None else it for it in results)


def test_a_hint_is_never_cut() -> None:
    """Half an edit would be a wrong one: a long message is cut instead."""
    report = hinted()
    change = "Change " + " ".join(f"part{number}" for number in range(20))
    results = tuple(
        result._replace(outcome=result.outcome._replace(message="wrong " * 200)) if result.hint is not None else result
        for result in report.results
    )
    text = render(report._replace(results=_with_hint(results, message=change)), Format.TERMINAL)
    assert f"{change}." in " ".join(text.split())
    assert "wrong\u2026" in text


def test_a_hint_without_room_is_described() -> None:
    """What it changes; the lines that change are in the whole report."""
    report = hinted()
    change = "Change " + " ".join(f"part{number}" for number in range(80))
    results = _with_hint(report.results, message=change, cause="the sign of the roll")
    short, whole = (
        render(report._replace(results=results), Format.TERMINAL, verbose=verbose) for verbose in (False, True)
    )
    assert "Wrong: the sign of the roll. --verbose shows the edits. Also fixes right-wheel-axis, -1." in " ".join(
        short.split()
    )
    assert "part79" not in short
    assert "part79." in whole
    assert '    +      <origin xyz="-0.15 -0.2 0" rpy="-1.57 0 0" />\n' in whole


def test_a_manual_mark_leaves_no_hint() -> None:
    """What a person has graded is not to be changed."""
    report = hinted()
    results = tuple(result._replace(manual_mark=ManualMark(result.points, "Ada")) for result in report.results)
    assert "Change" not in render(report._replace(results=results), Format.TERMINAL)


def test_a_diff_names_a_renamed_file() -> None:
    """By its new path; a file that cannot be read again is new."""
    renamed = Edit("launch/a.py", 1, 1, "", "", renamed="launch/a.launch.py")
    assert diff_lines((renamed,), lambda _: None) == ["--- /dev/null", "+++ launch/a.launch.py"]


TEXT = "<a>\n  <b x='1' y='2'/>\r\n  <c/>\n</a>\n"


@pytest.mark.parametrize(
    ("edits", "expected"),
    [
        ([Edit("f", 2, 6, "x='1'", "x='3'")], ["@@ line 2 @@", "-  <b x='1' y='2'/>", "+  <b x='3' y='2'/>"]),
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
        ([Edit("f", 3, 3, "<other/>", "<d/>")], ["@@ line 3 @@", "-<other/>", "+<d/>"]),  # of another version
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
