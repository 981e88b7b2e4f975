"""The summary of changes when a submission is graded again: the score, and the criteria that changed."""

from collections.abc import Callable
from decimal import Decimal

import pytest

from grader.app.commands.watch import comparison_lines
from grader.lab.checks.outcome import Status
from grader.lab.grading.report import Report, Result
from tests.samples import SAMPLES

pytestmark = pytest.mark.slow

SHORT = SAMPLES["lidar-offset-in-visual"].alone.grade()  # 64 of 70: lidar-frame fails
Change = Callable[[Result], Result]


def with_status(status: Status, message: str = "so it is") -> Change:
    """Return a change that gives a criterion another status."""
    return lambda result: result._replace(
        outcome=result.outcome._replace(status=status, message=message)
    )


def changed(report: Report, **changes: Change) -> Report:
    """Return a report with other results for some criteria; underscores in keywords stand for hyphens."""
    known = {name.replace("_", "-"): change for name, change in changes.items()}
    results = [
        known[result.criterion.id](result) if result.criterion.id in known else result
        for result in report.results
    ]
    return report._replace(results=tuple(results))


def test_score_passes_and_failures() -> None:
    """New passes precede new failures, each with its points."""
    after = changed(
        SHORT,
        lidar_frame=with_status("passed"),
        base_green=with_status("failed"),
        base_box=with_status("failed"),
    )
    assert comparison_lines(SHORT, after) == [
        "64 -> 62 of 70 points (-2)",
        "now passed: lidar-frame (+6)",
        "now failed: base-box (-2) and base-green (-6)",
    ]


def test_a_failure_that_costs_nothing_is_no_new_failure() -> None:
    """It fails because of another one: it was skipped before, and gets its points."""
    before = changed(SHORT, base_box=with_status("skipped"))
    after = changed(
        SHORT, base_box=lambda one: with_status("failed")(one)._replace(carried="lidar-frame")
    )
    assert comparison_lines(before, after) == [
        "62 -> 64 of 70 points (+2)",
        "failed, but not deducted: base-box (+2)",
    ]


@pytest.mark.parametrize(
    ("status", "words"),
    [
        ("skipped", "now skipped"),
        ("pending", "now needs manual grading"),
        ("errored", "now errored"),
    ],
)
def test_every_status_is_described(status: Status, words: str) -> None:
    """Points are named only if they change."""
    after = changed(SHORT, lidar_frame=with_status(status))
    assert comparison_lines(SHORT, after) == ["64 -> 64 of 70 points", f"{words}: lidar-frame"]


def test_another_rubric() -> None:
    """An added criterion, other points and other messages; what is removed is no longer in the report."""
    first, second, *others = SHORT.results
    dearer = second._replace(criterion=second.criterion._replace(points=Decimal("2.5")))
    new = first._replace(criterion=first.criterion._replace(id="new\x1b", points=Decimal(1)))
    assert comparison_lines(SHORT, SHORT._replace(results=(new, dearer, *others))) == [
        "64 -> 62.5 of 68.5 points (-1.5)",
        "now passed: new\\x1b (+1)",
        f"changed: {second.criterion.id} (+0.5)",
    ]
    assert comparison_lines(SHORT, changed(SHORT, lidar_frame=with_status("failed"))) == [
        "64 -> 64 of 70 points",
        "changed: lidar-frame",
    ]
