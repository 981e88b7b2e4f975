"""Adjustments, extra credit and comments without points: in every format, once, and never as the student's mistake."""

import os
from decimal import Decimal
from html import unescape
from typing import Any
from unittest.mock import patch

import pytest

from grader.grading.report import Report
from grader.report.formats import Format, render
from tests.report.readers import READERS, page_text, reader, svg_text
from tests.report.reports import COMMENTED, adjusted

REPORT = adjusted()
ADJUSTED = [result for result in REPORT.results if result.is_adjusted]
_TEXTS = {**{kind: read.text for kind, read in READERS.items()}, Format.SVG: svg_text, Format.HTML: page_text}
_DATA = (Format.JSON, Format.GRADESCOPE)  # with what the check found, beside the adjustment


def shown(kind: Format, report: Report = REPORT, *, verbose: bool = False) -> str:
    """Return what a format shows, in one line: of data its text, without escapes of Markdown."""
    with patch.dict(os.environ, {"COLUMNS": "500"}), patch("grader.report.annotations._MAX_ANNOTATIONS", 20):
        text = render(report, kind, verbose=verbose)
    reader(kind).parse(text)
    is_page = kind in (Format.HTML, Format.SVG, Format.JUNIT, Format.MARKDOWN)
    return " ".join((_TEXTS[kind](text) if is_page else unescape(text.replace("\\", ""))).split())


@pytest.mark.parametrize("kind", list(_TEXTS))
def test_the_reason_is_there_once_for_each_criterion(kind: Format) -> None:
    """Also where the check passed, could not decide, or was skipped."""
    assert [result.outcome.status for result in ADJUSTED] == ["passed", "failed", "failed", "skipped", "pending"]
    for text in {shown(kind), shown(kind, verbose=True)}:
        for result in ADJUSTED:
            assert result.criterion.adjustment is not None
            is_twice = kind in (Format.GRADESCOPE, Format.SARIF)  # as data, and in words
            assert text.count(result.criterion.adjustment.reason) == 1 + is_twice, result.criterion.id


@pytest.mark.parametrize("kind", sorted(set(_TEXTS) - set(_DATA)))
def test_it_is_not_the_students_mistake(kind: Format) -> None:
    """What the check found is not shown, nor advice."""
    for text in {shown(kind), shown(kind, verbose=True)}:
        for result in (result for result in ADJUSTED if result.outcome.status != "skipped"):
            assert result.outcome.message not in text
            assert not result.criterion.feedback or result.criterion.feedback not in text or kind is Format.SARIF


def test_it_is_not_said_to_be_skipped() -> None:
    """Other criteria are, because of the same failure."""
    for kind in (Format.TERMINAL, Format.HTML):
        text = shown(kind, verbose=True)
        assert "rviz-shows-robot skipped because package-found failed" in text
        assert "rviz-fixed-frame skipped because" not in text


@pytest.mark.parametrize("kind", list(_TEXTS))
def test_comments_name_the_grader(kind: Format) -> None:
    """Of criteria that passed, failed, are skipped, pending, adjusted, or extra credit."""
    text = shown(kind)
    for name in COMMENTED:
        assert f"seen <{name}>" in text
    assert text.count("Ada") >= len(COMMENTED)


def test_the_score_may_exceed_the_maximum() -> None:
    """3 of 8 points of extra credit are in the score; nothing that was not earned is lost."""
    assert (REPORT.score, REPORT.max_score, REPORT.bonus) == (Decimal(56), Decimal(92), Decimal(3))
    text = shown(Format.TERMINAL)
    assert "56/92 IRP Lab 6" in text
    assert "Extra credit: 3 of 8 points, in addition to the maximum." in text
    assert "flat-base 0/5 bonus" in text
    assert "5 corrected after grading" in text
    full = report_of(*(result for result in REPORT.results if result.points >= result.criterion.points))
    assert full.score == full.max_score + 3
    assert f"{full.score}/{full.max_score} IRP" in shown(Format.TERMINAL, full)
    assert f'"score":{full.score},"max_score":{full.max_score}' in shown(Format.JSON, full).replace(" ", "")


def report_of(*results: Any) -> Report:
    """Return the report with these results only."""
    return REPORT._replace(results=results)


def test_junit_fails_for_neither() -> None:
    """An adjusted criterion passes, extra credit that was not earned is skipped."""
    root = READERS[Format.JUNIT].parse(render(REPORT, Format.JUNIT))
    found = {case.get("name").rpartition("(")[2][:-1]: [child.tag for child in case] for case in root.iter("testcase")}
    assert all(found[result.criterion.id] == ["properties", "system-out"] for result in ADJUSTED)
    assert found["flat-base"] == ["properties", "skipped"]
    assert found["base-is-there"] == ["properties", "system-out"]


def test_gradescope_has_no_maximum_for_extra_credit() -> None:
    """The maxima of the tests add up to the autograder points; the score is the sum of the points."""
    data = READERS[Format.GRADESCOPE].parse(render(REPORT, Format.GRADESCOPE))
    tests = {test["extra_data"]["id"]: test for test in data["tests"]}
    assert sum(test.get("max_score", 0) for test in tests.values()) == REPORT.max_score - REPORT.pending
    assert sum(test.get("score", 0) for test in tests.values()) == data["score"] == REPORT.score
    assert "max_score" not in tests["base-is-there"]
    assert tests["base-is-there"]["name"] == "The base is a box (up to 3 points, extra credit)"
    assert {tests[result.criterion.id]["status"] for result in ADJUSTED} == {"passed"}


def test_classroom50_never_exceeds_a_maximum() -> None:
    """Its collector refuses such a result (validate_result of collect_scores.py in foundation50/classroom50)."""
    full = report_of(*(result for result in REPORT.results if result.points >= result.criterion.points))
    for report in (REPORT, full):
        data = READERS[Format.CLASSROOM50].parse(render(report, Format.CLASSROOM50))
        assert data["score"] <= data["max-score"] == report.max_score
        assert all(test["score"] <= test["max-score"] for test in data["tests"])
        assert data["score"] == min(report.score, report.max_score)
    (bonus,) = (test for test in data["tests"] if "base-is-there" in test["test-name"])
    assert (bonus["score"], bonus["max-score"], bonus["passed"]) == (3, 3, True)
    assert bonus["message"].startswith("Extra credit: 3/3 bonus. It is not part of the maximum.\n")
