"""Formats of platforms: valid for the programs that read them, with exact points; `tests/corpus/reports` has them whole."""

import os
from decimal import Decimal
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from junitparser import Error, Failure, Skipped
from junitparser.xunit2 import JUnitXml

from grader.lab.grading.report import Report
from grader.report.formats import Format, render
from tests.report.readers import READERS
from tests.report.reports import adjusted, half_points, marked
from tests.samples import REPORTED, SAMPLES

KINDS = {
    "passed": None,
    "failed": Failure,
    "errored": Error,
    "skipped": Skipped,
    "pending": Skipped,
}


@cache
def report_of(name: str, folder: Path) -> Report:
    """Return a sample's report, or one that no sample has."""
    if name == "fractions":
        return half_points(folder)
    return (
        SAMPLES[name].grade()
        if name in SAMPLES
        else {"adjusted": adjusted, "marked": marked}[name]()
    )


@pytest.fixture(params=[*REPORTED, "fractions", "adjusted", "marked"])
def report(request: pytest.FixtureRequest, tmp_path: Path) -> Report:
    """Return a report."""
    return report_of(request.param, tmp_path)


def read(report: Report, kind: Format) -> Any:
    """Return a report as its reader reads it, which checks it by its schema."""
    return READERS[kind].parse(render(report, kind))


def exact(numbers: Any) -> Decimal:
    """Return the sum of numbers as they are written."""
    return sum((Decimal(str(number)) for number in numbers), Decimal(0))


def test_json_adds_up(report: Report) -> None:
    """The score is the sum of the points; only what failed has feedback."""
    data = read(report, Format.JSON)
    assert exact(row["points"] for row in data["results"]) == exact([data["score"]]) == report.score
    assert all(
        (row["status"] == "skipped") == (row["because"] is not None) for row in data["results"]
    )
    assert all(row["status"] == "failed" or row["feedback"] == "" for row in data["results"])


def test_gradescope_adds_up(report: Report) -> None:
    """What is open has no score; extra credit has no maximum, so that the maxima are the automatic points."""
    data = read(report, Format.GRADESCOPE)
    assert (
        exact(test.get("score", 0) for test in data["tests"])
        == exact([data["score"]])
        == report.score
    )
    assert (
        exact(test.get("max_score", 0) for test in data["tests"])
        == report.max_score - report.pending
    )
    assert all(
        ("score" in test) == (not one.is_open)
        for test, one in zip(data["tests"], report.results, strict=True)
    )


def test_classroom50_has_whole_numbers(report: Report) -> None:
    """Its collector refuses a result above its maximum (validate_result of collect_scores.py in foundation50/classroom50)."""
    data = read(report, Format.CLASSROOM50)
    for scored in (data, *data["tests"]):
        assert {type(scored["score"]), type(scored["max-score"])} == {int}
        assert 0 <= scored["score"] <= scored["max-score"]
    scale = Decimal(data["max-score"]) / report.max_score
    assert data["score"] == min(report.score, report.max_score) * scale
    assert os.environ["USERNAME"] == data["owner"]


def test_junit_has_a_case_for_each_criterion(report: Report) -> None:
    """Of its kind, with exact points, at its place; counts are correct."""
    text = render(report, Format.JUNIT)
    READERS[Format.JUNIT].parse(text)
    xml = JUnitXml.fromstring(text.encode())
    found: list[Any] = [case for suite in xml for case in suite]
    for result, case in zip(report.results, found, strict=True):
        earned = {entry.name: entry.value for entry in case.properties()}["points"].partition("/")[
            0
        ]
        assert (earned == "–") if result.is_open else (Decimal(earned) == result.points)
        if (
            result.manual_mark is None
            and not result.is_adjusted
            and not result.carried
            and not result.criterion.bonus
        ):
            expected = KINDS[result.outcome.status]
            assert [type(one) for one in case.result] == ([expected] if expected else [])
        where = result.outcome.location
        assert case._elem.get("line") in (None, str(where.line) if where is not None else None)
    assert xml.tests == len(report.results)
    assert xml.failures == sum(isinstance(one, Failure) for case in found for one in case.result)
