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
from tests.samples import REPORTED, SAMPLES

MAX_ANNOTATIONS = 10  # annotations of each type that GitHub shows for a step
NAMES = {"error": "error", "warning": "warning", "note": "notice"}
LAB = Base("lab/")


def annotated(report: Report, base: Base = LAB) -> list[Command]:
    """Return the annotations of a report."""
    return read_commands(render_github(report, base))


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
