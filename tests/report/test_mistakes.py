"""The mistakes of a report: their costs add up to the points lost, and each shows the line to change."""

from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path

import pytest

from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.hints.hinting import hinted
from grader.lab.submission.opening import read_submission
from grader.report.content import report_sections, result_line
from grader.report.criteria import Entry
from tests.report.reports import half_points
from tests.samples import REPORTED, RUBRICS, SAMPLES

pytestmark = pytest.mark.slow

ROBOTS = 1000


def of_mistakes(report: Report) -> Iterator[Entry]:
    """Yield what loses points in a report."""
    found = report_sections(report)
    yield from (*found.mistakes, *found.unbuilt)


def lost(report: Report) -> Decimal:
    """Return the points that a report's student lost: those that are neither earned nor need manual grading."""
    return report.max_score - report.pending - (report.score - report.bonus)


def assert_mistakes_add_up(report: Report) -> None:
    """Check that each criterion that lost points is in one mistake."""
    mistakes = [*of_mistakes(report)]
    named = [result.criterion.id for entry in mistakes for result in entry.results]
    assert sum((entry.lost for entry in mistakes), Decimal(0)) == lost(report)
    assert len(named) == len(set(named))


def test_a_faulty_check_is_no_mistake_of_the_student(tmp_path: Path) -> None:
    """The result names what a faulty check costs apart from the mistakes."""
    report = half_points(tmp_path)
    assert result_line(report, report_sections(report)).endswith(
        " cost 0.5, 1 faulty check costs 0.125."
    )


@pytest.mark.parametrize("name", REPORTED)
def test_the_costs_of_mistakes_add_up(name: str) -> None:
    """With hints and without, they are the points lost; no criterion is in two mistakes."""
    report = SAMPLES[name].grade()
    assert_mistakes_add_up(report)
    assert_mistakes_add_up(hinted(report, report.submission, "edit").report)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SAMPLES)
def test_the_line_to_change_is_shown(name: str) -> None:
    """Where a hint is proven, the line of a mistake is one that the hint changes; what a hint adds is shown where the
    failure is. The costs add up.
    """
    report = hinted(SAMPLES[name].grade(), SAMPLES[name].open(), "edit").report
    assert_mistakes_add_up(report)
    for entry in of_mistakes(report):
        hint = entry.result.hint
        if hint is not None and hint.gains and entry.location is not None:
            lines = {(edit.path, edit.line) for edit in hint.edits}
            is_added = any(not edit.old for edit in hint.edits)
            if is_added:
                assert entry.location.path in {path for path, _ in lines}, entry.id
            else:
                assert (entry.location.path, entry.location.line) in lines, entry.id


@pytest.mark.exhaustive
def test_the_costs_of_generated_robots_add_up() -> None:
    """Robots with random changes are graded by the rubric that they are made for."""
    from tests.second_opinion.robots import random_robot  # needs the group oracle

    for seed in range(ROBOTS):
        robot = random_robot(seed)
        assert_mistakes_add_up(
            grade(RUBRICS[robot.rubric], read_submission(robot.text, identity="a", path="a.urdf"))
        )
