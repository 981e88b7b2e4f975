"""What is said first when a submission is graded again: the score, and what has become of which criteria."""

from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal

import pytest

from grader.checks.outcome import Status
from grader.grading.report import Report, Result
from grader.report.comparison import comparison_lines, unchanged_line
from tests.samples import SAMPLES

SHORT = SAMPLES["lidar-offset-in-visual"].grade()  # 64 of 70: lidar-frame fails
Change = Callable[[Result], Result]


def turned(status: Status, message: str = "so it is") -> Change:
    """A change that gives a criterion another status."""
    return lambda result: result._replace(outcome=result.outcome._replace(status=status, message=message))


def changed(report: Report, **changes: Change) -> Report:
    """A report with other results for some criteria, which are named with underscores."""
    known = {name.replace("_", "-"): change for name, change in changes.items()}
    results = [
        known[result.criterion.id](result) if result.criterion.id in known else result for result in report.results
    ]
    return replace(report, results=tuple(results))


def test_the_score_and_who_passes_and_fails() -> None:
    """What passes now comes before what fails now, each with what it brings or costs."""
    after = changed(SHORT, lidar_frame=turned("passed"), base_green=turned("failed"), base_box=turned("failed"))
    assert comparison_lines(SHORT, after) == [
        "64 -> 62 of 70 points (-2)",
        "now passed: lidar-frame (+6)",
        "now failed: base-box (-2), base-green (-6)",
    ]


def test_an_equal_score_hides_no_change() -> None:
    """One criterion won and one lost for as many points."""
    after = changed(SHORT, lidar_frame=turned("passed"), base_green=turned("failed"))
    assert comparison_lines(SHORT, after) == [
        "64 of 70 points, as before",
        "now passed: lidar-frame (+6)",
        "now failed: base-green (-6)",
    ]


@pytest.mark.parametrize(
    ("status", "words"),
    [("skipped", "now skipped"), ("pending", "now needs manual grading"), ("errored", "now errored")],
)
def test_every_status_has_its_words(status: Status, words: str) -> None:
    """Points are named only where they change."""
    after = changed(SHORT, lidar_frame=turned(status))
    assert comparison_lines(SHORT, after) == ["64 of 70 points, as before", f"{words}: lidar-frame"]


def test_a_failure_that_is_another_one() -> None:
    """Nearer, but not there yet: the points are the same, and the message is not. What passes has nothing to say."""
    after = changed(SHORT, lidar_frame=turned("failed", "it is 2 mm off"), base_box=turned("passed", "it is 1 m wide"))
    assert comparison_lines(SHORT, after) == ["64 of 70 points, as before", "with another message: lidar-frame"]


def test_only_the_rest_has_changed() -> None:
    """Notes, problems and places are no business of the criteria."""
    after = replace(SHORT, notes=("something else",))
    assert comparison_lines(SHORT, after) == ["64 of 70 points, as before; only other parts of the report changed"]


def test_nothing_has_changed() -> None:
    """One line with the score."""
    assert unchanged_line(SHORT) == "nothing has changed: 64 of 70 points"


def test_many_are_counted() -> None:
    """Of many criteria the first eight are named."""
    after = replace(SHORT, results=tuple(turned("skipped")(result) for result in SHORT.results))
    score, line = comparison_lines(SHORT, after)
    assert score == "64 -> 0 of 70 points (-64)"
    assert line.startswith("now skipped: urdf-loads (-3), base-box (-2), ")
    assert line.endswith(", and 24 more (-44)")
    assert line.count(",") == 8


def test_another_rubric() -> None:
    """Criteria that come, go, or are worth something else; both maxima are named."""
    first, second, *others = SHORT.results
    dearer = second._replace(criterion=replace(second.criterion, points=Decimal("2.5")))
    new = first._replace(criterion=replace(first.criterion, id="new\x1b", points=Decimal(1)))
    assert comparison_lines(SHORT, replace(SHORT, results=(new, dearer, *others))) == [
        "64 of 70 -> 62.5 of 68.5 points (-1.5)",
        "now passed: new\\x1b (+1)",
        f"with other points: {second.criterion.id} (+0.5)",
        f"removed: {first.criterion.id} (-3)",
    ]
    failing = next(result for result in SHORT.results if result.outcome.status == "failed")
    cheaper = {"lidar_frame": lambda item: item._replace(criterion=replace(failing.criterion, points=Decimal(5)))}
    assert comparison_lines(SHORT, changed(SHORT, **cheaper)) == [
        "64 of 70 -> 64 of 69 points",
        "with other points: lidar-frame",
    ]
