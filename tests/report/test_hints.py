"""Hints: each format shows the proven change in place of the feedback, once, and its edits where the format has a place for them."""

from typing import Any

import pytest

from grader.grading.report import ManualMark, Result
from grader.report.findings import findings
from grader.report.formats import Format, render
from grader.report.locations import diff_lines
from grader.source import Base, Edit, Source
from tests.report.readers import read_sarif
from tests.report.reports import hinted
from tests.samples import ROOT

CHANGE = 'Change `rpy="1.57 0 0"` to `rpy="-1.57 0 0"` (line 73). Also fixes right-wheel-axis, -1.'
MISTAKEN = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"


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


def test_sarif_fixes_apply() -> None:
    """The replaced region of the file is the old text, counted in characters; what is inserted is the new text."""
    run = read_sarif(render(hinted(), Format.SARIF, Base("lab/")))
    fixes = [fix for result in run["results"] for fix in result.get("fixes", [])]
    assert [fix["description"]["text"] for fix in fixes] == [
        CHANGE,
        "Raise the base by 50 mm.",
    ]
    lines = MISTAKEN.read_text(encoding="utf-8").splitlines()
    for fix, (old, new) in zip(fixes, (('"1.57 0 0"', '"-1.57 0 0"'), ('"0 0 0.05"', '"0 0 0.1"')), strict=True):
        change = fix["artifactChanges"][0]
        assert change["artifactLocation"]["uri"] == "lab/my_robot.urdf"
        (replacement,) = change["replacements"]
        region = replacement["deletedRegion"]
        assert region["startLine"] == region["endLine"]
        line = lines[region["startLine"] - 1]
        assert line[region["startColumn"] - 1 : region["endColumn"] - 1].endswith(old)
        assert replacement["insertedContent"]["text"].endswith(new)


def test_sarif_has_no_fix_that_it_cannot_express() -> None:
    """A file in an archive is no file of the repository, and no file is renamed; the message has the hint all the same."""
    renamed = Edit("launch/a.py", 1, 1, "", "", renamed="launch/a.launch.py")
    report = hinted()
    others = _with_hint(report.results, edits=(renamed,))
    for given, base in ((report, Base(archive="lab.zip")), (report._replace(results=others), Base())):
        run = read_sarif(render(given, Format.SARIF, base))
        assert not any("fixes" in result for result in run["results"])
        assert any(finding.hint for finding in findings(given, base))
    assert diff_lines((renamed,), lambda _: None) == ["--- /dev/null", "+++ launch/a.launch.py"]


def test_a_region_of_several_lines_ends_in_the_last_one() -> None:
    """Columns count from the last line break of the old text."""
    edit = Edit("my_robot.urdf", 3, 5, "<a>\n  <b/>", "<c/>")
    report = hinted()
    results = _with_hint(report.results, edits=(edit,))
    (fix,) = next(
        result["fixes"]
        for result in read_sarif(render(report._replace(results=results), Format.SARIF))["results"]
        if "fixes" in result
    )
    region = fix["artifactChanges"][0]["replacements"][0]["deletedRegion"]
    assert region == {"startLine": 3, "startColumn": 5, "endLine": 4, "endColumn": 7}


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
