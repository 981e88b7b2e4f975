"""Annotations of GitHub Actions: read back as the runner reads them, each is on its own line of the file."""

from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.grading.report import Report
from grader.problems import Problem
from grader.report.annotations import command, render_github
from grader.report.findings import findings
from grader.report.locations import RepositoryLocation
from grader.robot.catalogue import UNDEFINED_MATERIAL
from grader.source import Base, Location
from grader.text import printable
from tests.report.readers import read_commands
from tests.report.workflow_commands import Command
from tests.samples import REPORTED, ROOT, SAMPLES

MAX_ANNOTATIONS = 10  # annotations of each type that GitHub shows for a step
NAMES = {"error": "error", "warning": "warning", "note": "notice"}
LAB = Base("lab/")


def annotated(report: Report, base: Base = LAB) -> list[Command]:
    """Return the annotations of a report."""
    return read_commands(render_github(report, base))


def test_each_finding_is_on_its_line() -> None:
    """File, line and columns are those of the finding, the title has criterion and points, the most points come first."""
    report = SAMPLES["several-mistakes"].alone.grade()
    lines = (
        (ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf")
        .read_text(encoding="utf-8")
        .splitlines()
    )
    lost = sorted((result for result in report.results if result.is_lost), key=lambda item: -item.criterion.points)
    summary, *found = annotated(report)
    assert [command.get("title") for command in found][:2] == [
        "base-green (6 points lost)",
        "lidar-frame (6 points lost)",
    ]
    assert (len(found), len(lost)) == (7, 6)  # and what is carried
    for reported, result in zip(found[:6], lost, strict=True):
        assert reported.name == "error"
        assert (
            reported.get("title")
            == f"{result.criterion.id} ({result.criterion.points} point{'s' * (result.criterion.points != 1)} lost)"
        )
        assert result.outcome.message[1:].rstrip(".") in reported.data
        assert result.criterion.title in reported.data
        assert result.criterion.feedback in reported.data
        where = result.outcome.location
        assert [key for key, _ in reported.properties[:-1]] == (
            ["file", "line", "endLine", "col", "endColumn"] if where else []
        )
        if where is not None:
            assert reported.get("file") == "lab/my_robot.urdf"
            assert reported.get("line") == reported.get("endLine") == str(where.line)
            start, end = int(reported.get("col") or 0), int(reported.get("endColumn") or 0)
            assert start == where.column
            assert lines[where.line - 1][start - 1 : end].endswith('"')
            assert lines[where.line - 1][start - 1 : end].count('"') == 2
    assert summary.name == "notice"
    assert summary.get("title") == "43 / 70 points: IRP Lab 6: a wheeled base"
    assert f"rubric lab6, sha256 {report.rubric.sha256}" in summary.data
    assert "25 passed, 7 failed" in summary.data


@pytest.mark.parametrize("name", REPORTED)
def test_the_number_of_annotations_is_limited(name: str) -> None:
    """Ten of each type at most; the last one counts the rest and its points, and names all criteria that lost some."""
    report = SAMPLES[name].grade()
    found = findings(report, LAB)
    shown = annotated(report)
    assert shown[0].get("title") == f"{report.score} / {report.max_score} points: {report.rubric.title}"
    for level, called in NAMES.items():
        own = [command for command in found if command.level == level]
        reported = [command for command in shown[1:] if command.name == called]
        assert len(reported) + (called == "notice") <= MAX_ANNOTATIONS
        rest = [command for command in reported if "more" in (command.get("title") or "").split(" (")[0].split()]
        more = int((rest[0].get("title") or "").split()[0]) if rest else 0
        assert len(reported) - len(rest) + more == len(own)
        assert len(reported) == min(len(own), MAX_ANNOTATIONS - (called == "notice"))
        words = "\n".join(f"{command.get('title')} {command.data}" for command in reported)
        assert all(finding.rule in words for finding in own)
        if rest and any(finding.lost for finding in own):
            lost = sum((finding.lost for finding in own[len(reported) - 1 :]), Decimal(0))
            assert f"{more} more ({lost} point" in (rest[0].get("title") or "")
    words = shown[0].data
    assert all(
        result.criterion.id in words
        for result in report.results
        if result.is_open or result.outcome.status == "skipped"
    )


def test_eleven_findings_are_nine_and_the_rest() -> None:
    """Ten findings are all shown; only with more does the last annotation count the rest."""
    report = SAMPLES["reference"].grade()
    for count, last in ((10, UNDEFINED_MATERIAL.code), (11, "2 more")):
        problems = tuple(
            Problem(UNDEFINED_MATERIAL, f"message {number}", Location("a.urdf", number, 1))
            for number in range(1, count + 1)
        )
        found = [command for command in annotated(report._replace(problems=problems)) if command.name == "warning"]
        assert len(found) == MAX_ANNOTATIONS
        assert found[-1].get("title") == last


def test_a_whole_archive_is_annotated_as_one_file() -> None:
    """Its lines cannot be shown, so the text has the location inside it."""
    report = SAMPLES["several-mistakes"].alone.grade()
    for reported in annotated(report, Base(archive="lab/lab6.zip"))[1:]:
        assert reported.get("file") in ("lab/lab6.zip", None)
        assert reported.get("line") is None
        assert ("In my_robot.urdf:" in reported.data) == (reported.get("file") is not None)


def test_a_correct_submission_has_one_notice() -> None:
    """It has the score, and the pending criteria."""
    (only,) = annotated(SAMPLES["reference"].grade())
    assert only.name == "notice"
    assert "Needs manual grading: evidence-webcam, answer-floating-link, answer-launch-nodes" in only.data
    assert "10 points need manual grading" in only.data


def test_a_long_message_is_cut_before_escaping() -> None:
    """No escape is cut in two."""
    (reported,) = read_commands(command("error", None, "t", "%" * 5000))
    assert reported.data == "%" * 4000 + "..."


TEXT = st.text().map(printable).filter(lambda text: text == text.strip() and text)


@given(st.sampled_from(list(NAMES.values())), TEXT, TEXT, st.lists(TEXT, min_size=1).map("\n".join))
def test_any_text_survives_escaping(name: str, path: str, title: str, text: str) -> None:
    """Colons, commas, percent signs and line breaks are unchanged in every part of a command."""
    (reported,) = read_commands(command(name, RepositoryLocation(path, 3, 4, 9), title, text))
    expected = (("file", path), ("line", "3"), ("endLine", "3"), ("col", "4"), ("endColumn", "8"), ("title", title))
    assert reported == Command(name, expected, text)


def test_an_empty_range_is_one_column_wide() -> None:
    """The end never precedes the beginning, which GitHub would refuse."""
    for reported in annotated(SAMPLES["broken-tag-parent"].grade()):
        assert int(reported.get("endColumn") or 1) >= int(reported.get("col") or 1) >= 1
