"""JUnit XML: valid under the schemas of its readers, read back by one of them, and equal to the report."""

from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from junitparser import Error, Failure, Skipped
from junitparser.xunit2 import JUnitXml

from grader.grading.report import Report, Result
from grader.report.junit import render_junit
from grader.source import Base
from tests.report.readers import read_junit
from tests.report.reports import half_points, marked
from tests.samples import REPORTED, SAMPLES

KINDS = {"passed": None, "failed": Failure, "errored": Error, "skipped": Skipped, "pending": Skipped}
LAB = Base("lab/")


def read_back(report: Report, base: Base = LAB) -> Any:
    """Return a report as junitparser reads it, after validation."""
    text = render_junit(report, base)
    read_junit(text)
    return JUnitXml.fromstring(text.encode())


def cases(report: Report, base: Base = LAB) -> list[tuple[Result, Any]]:
    """Return each criterion's result with its test case."""
    found = [case for suite in read_back(report, base) for case in suite]
    return list(zip(report.results, found, strict=True))


@pytest.mark.parametrize("name", REPORTED)
def test_every_criterion_is_a_test_case(name: str) -> None:
    """Kind, points, file and line are those of the report, and every count is correct."""
    report = SAMPLES[name].grade()
    xml = read_back(report)
    assert (xml.tests, xml.failures, xml.errors) == (
        len(report.results),
        report.counts("failed"),
        report.counts("errored"),
    )
    assert sum(suite.skipped for suite in xml) == report.counts("skipped", "pending")
    assert [suite.name for suite in xml] == [report.rubric.part(part).title for part in report.parts]
    for part, suite in zip(report.parts, xml, strict=True):
        own = [result for result in report.results if result.criterion.part == part]
        assert (suite.tests, suite.failures) == (len(own), sum(result.outcome.status == "failed" for result in own))
    for result, case in cases(report):
        _is_equal(result, case)
        assert case.classname == f"{report.rubric.id}.{result.criterion.part}"


def _is_equal(result: Result, case: Any) -> None:
    criterion, outcome = result.criterion, result.outcome
    assert case.name == f"{criterion.title} ({criterion.id})"
    points = {entry.name: entry.value for entry in case.properties()}["points"]
    earned, _, most = points.partition("/")
    assert (earned if result.is_open else Decimal(earned)) == ("–" if result.is_open else result.points)
    assert Decimal(most) == criterion.points
    expected = KINDS[outcome.status]
    assert [type(result) for result in case.result] == ([expected] if expected else [])
    for found in case.result:
        assert found.type == outcome.status
        assert found.text.startswith(found.message + "\n")
    where = outcome.location if outcome.status == "failed" else None
    assert case._elem.get("file") == (f"lab/{where.path}" if where is not None else None)
    assert case._elem.get("line") == (str(where.line) if where is not None else None)


def test_the_submission_is_in_the_properties() -> None:
    """Score, pending points, versions and paths are exact strings."""
    report = SAMPLES["reference"].grade()
    (first, *others) = read_back(report)
    assert {entry.name: entry.value for entry in first.properties()} == {
        "score": "90",
        "max_score": "100",
        "pending": "10",
        "submission": "reference",
        "submission_sha256": report.submission.sha256,
        "rubric": "lab6",
        "rubric_sha256": report.rubric.sha256,
        "grader": report.version,
    }
    assert not any(list(suite.properties()) for suite in others)


def test_a_file_in_an_archive_has_no_line_in_the_repository() -> None:
    """Readers would look for the file beside the archive."""
    for _, case in cases(SAMPLES["several-mistakes"].alone.grade(), Base(archive="lab6.zip")):
        assert case._elem.get("file") is None


def test_manual_marks_count() -> None:
    """Full points are no failure, whatever the check found; fewer are one."""
    found = [(result, case.result) for result, case in cases(marked()) if result.manual_mark is not None]
    assert sorted((result.outcome.status, [type(item) for item in reported]) for result, reported in found) == [
        ("failed", []),
        ("passed", [Failure]),
        ("pending", [Failure]),
    ]
    assert {item.type for _, reported in found for item in reported} == {"manual mark"}


def test_an_error_of_the_grader_is_an_error(tmp_path: Path) -> None:
    """Half and quarter points are exact."""
    report = half_points(tmp_path)
    shown = [next(iter(case.properties())).value for _, case in cases(report)]
    assert shown == ["0/0.5", "0.25/0.25", "0/0", "0/0", "0/0.125"]
    assert [type(result).__name__ for _, case in cases(report) for result in case.result] == [
        "Failure",
        "Failure",
        "Skipped",
        "Error",
    ]
