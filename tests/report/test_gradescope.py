"""Gradescope's results.json: valid, exact, and without points for pending criteria."""

from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.grading.report import Report
from grader.report.platforms import render_gradescope
from tests.report.readers import read_as_github, read_by_schema
from tests.report.reports import half_points, marked
from tests.samples import REPORTED, SAMPLES

READ = read_by_schema("gradescope")


def results(report: Report) -> Any:
    """Return the data of a report; each score is an exact decimal, and their sum is the score."""
    data = READ(render_gradescope(report))
    assert _sum(test.get("score", 0) for test in data["tests"]) == _exact(data["score"]) == report.score
    most = _sum(test.get("max_score", 0) for test in data["tests"])
    assert most + _exact(data["extra_data"]["pending"]) == report.max_score
    return data


def _exact(number: float) -> Decimal:
    return Decimal(str(number))


def _sum(numbers: Any) -> Decimal:
    return sum(map(_exact, numbers), Decimal(0))


@pytest.mark.parametrize("name", REPORTED)
def test_every_criterion_is_a_test(name: str) -> None:
    """In the rubric's order, with its number; pending ones have no score, so that they do not look failed."""
    report = SAMPLES[name].grade()
    data = results(report)
    for test, result in zip(data["tests"], report.results, strict=True):
        criterion = result.criterion
        assert test["name"].startswith(criterion.title)
        assert test["tags"] == [criterion.id, criterion.part, result.outcome.status]
        assert ("score" in test) == ("max_score" in test) == ("status" in test) == (not result.is_open)
        assert ("manual grading" in test["name"]) == result.is_open
        if not result.is_open:
            assert test["status"] == ("passed" if result.outcome.status == "passed" else "failed")
            assert (_exact(test["score"]), _exact(test["max_score"])) == (result.points, criterion.points)
    numbers = [tuple(map(int, test["number"].split("."))) for test in data["tests"]]
    assert numbers == sorted(set(numbers))


def test_one_part_alone_keeps_its_numbers() -> None:
    """A criterion has the same number whatever else is graded."""
    whole = results(SAMPLES["reference"].grade())
    alone = results(SAMPLES["several-mistakes"].alone.grade())
    by_id = {test["tags"][0]: test["number"] for test in whole["tests"]}
    assert all(by_id[test["tags"][0]] == test["number"] for test in alone["tests"])


def test_points_are_exact(tmp_path: Path) -> None:
    """Halves, quarters and eighths add up; a test without points has a score of 0."""
    data = results(half_points(tmp_path))
    assert [(test["score"], test["max_score"], test["status"]) for test in data["tests"]] == [
        (0, 0.5, "failed"),
        (0.25, 0.25, "passed"),
        (0, 0, "failed"),
        (0, 0, "failed"),
        (0, 0.125, "failed"),
    ]


def test_manual_marks_have_their_points() -> None:
    """A marked criterion is not pending, and passed only with full points."""
    report = marked()
    data = results(report)
    manual = {
        result.outcome.status: (test["score"], test["status"])
        for test, result in zip(data["tests"], report.results, strict=True)
        if result.manual_mark is not None
    }
    assert {status: decided for status, (_, decided) in manual.items()} == {
        "failed": "passed",
        "passed": "failed",
        "pending": "failed",
    }


def test_each_output_is_complete_markdown() -> None:
    """The submission's output is first, and each test has its own; every one is rendered alone."""
    data = results(SAMPLES["several-mistakes"].alone.grade())
    assert read_as_github(data["output"]).findtext("h1") == "43 / 70 points: IRP Lab 6: a wheeled base"
    by_id = {test["tags"][0]: read_as_github(test["output"]) for test in data["tests"]}
    assert [element.tag for element in by_id["base-green"]] == ["p", "p", "p", "pre", "p"]
    assert by_id["base-green"].findtext("pre/code") == '6 | <color rgba="0 1 0 1" />\n  |        --------------\n'
    assert data["visibility"] == "visible"
    assert data["stdout_visibility"] == "hidden"
