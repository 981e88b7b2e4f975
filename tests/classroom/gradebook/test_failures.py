"""Failures are grouped by criterion and cause: measured values within the tolerance are one failure; other failures by words."""

from collections.abc import Mapping
from itertools import pairwise
from math import cos, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.outcome import Measured, Outcome
from grader.classroom.gradebook.graded_students import Failure, grouped, stored_failure
from grader.classroom.gradebook.result import GradingResult, StoredOutcome
from grader.grading.graded_submission import GradedSubmission
from grader.grading.report import Report, Result
from tests.samples import LAB6

CRITERION = next(row for row in LAB6.criteria if row.id == "left-wheel-forward")


def failure(message: str, measured: Measured = None, expected: Measured = None, unit: str | None = "m") -> Failure:
    """Return the failure that a gradebook stores and gives back."""
    outcome = Outcome("failed", message, measured, expected, None if measured is None else 0.002, unit)
    return failure_of(outcome)


def failure_of(outcome: Outcome) -> Failure:
    """Return the failure that a gradebook makes of an outcome."""
    report = Report(GradedSubmission("a"), LAB6, ("task1",), (Result(CRITERION, outcome),))
    outcomes = GradingResult("a", "graded", "", "").with_report(report, b"").outcomes
    (found,) = [StoredOutcome(*row) for row in outcomes if row[0] == CRITERION.position]
    return stored_failure(found)


def counts(*failures: Failure) -> list[tuple[str, int]]:
    """Return the groups of these failures, each with its words and number."""
    found: dict[Failure, int] = {}
    for item in failures:
        found[item] = found.get(item, 0) + 1
    return [(kind.mistake, count) for kind, count in grouped(found)]


def test_values_within_the_tolerance_are_one_failure() -> None:
    """The words of the most frequent one are shown; a boundary between rounded values splits no group."""
    assert counts(
        failure("z = 0.2001", 0.2001), failure("z = 0.2", 0.2), failure("z = 0.1999", 0.1999), failure("z = 0.2", 0.2)
    ) == [("z = 0.2", 4)]
    assert counts(failure("z = 0.2", 0.2), failure("z = 0.2021", 0.2021)) == [("z = 0.2", 1), ("z = 0.2021", 1)]


def test_directions_are_compared_by_their_angle() -> None:
    """`0 -1 0` and `0 -1 0.0008` are one row, directions ten degrees apart are two."""

    def pointing(degrees: float) -> Failure:
        direction = (0.0, -cos(radians(degrees)), sin(radians(degrees)))
        outcome = Outcome("failed", f"{degrees}", direction, (0.0, 1.0, 0.0), 1.0, "deg")
        return failure_of(outcome)

    assert counts(pointing(0), pointing(0), pointing(0.046)) == [("0", 3)]
    assert counts(pointing(0), pointing(0), pointing(10)) == [("0", 2), ("10", 1)]


def test_another_expectation_is_another_failure() -> None:
    """The same height over another base is another cause."""
    assert len(counts(failure("too high", 0.2, 0.1), failure("over the edge", 0.2, 0.2))) == 2


def test_another_unit_is_another_failure() -> None:
    """A tilt of one degree is no distance of one metre."""
    assert len(counts(failure("tilted", 1.0, 0.0, "deg"), failure("away", 1.0, 0.0, "m"))) == 2


def test_words_group_what_is_not_measured() -> None:
    """Without numbers, or with numbers that cannot be compared, the words without details count."""
    assert counts(failure("fixed"), failure("fixed"), failure("loose")) == [("fixed", 2), ("loose", 1)]
    assert counts(failure("endless", float("inf")), failure("endless", float("inf"))) == [("endless", 2)]
    assert counts(failure("named", ("a", "b")), failure("named", ("c",))) == [("named", 2)]


def test_long_words_are_cut() -> None:
    """Statistics keep at most 200 characters."""
    assert len(failure("x" * 300).mistake) == 200


NUMBERS = st.floats(-1, 1).map(lambda value: round(value, 4))


@given(st.dictionaries(NUMBERS.map(lambda value: failure(f"{value}", value, 0.0)), st.integers(1, 9), max_size=30))
def test_nothing_is_lost_and_no_group_is_too_wide(failures: Mapping[Failure, int]) -> None:
    """The counts add up, and two groups are farther apart than the tolerance."""
    groups = grouped(failures)
    assert sum(count for _, count in groups) == sum(failures.values())
    values = sorted(kind.measured[0] for kind, _ in groups)
    assert all(after - before > 0.002 for before, after in pairwise(values))
    assert groups == grouped(dict(reversed(list(failures.items()))))


@pytest.mark.parametrize("value", [True, 3])
def test_flags_and_counts_are_numbers(value: Measured) -> None:
    """They are compared like any other number."""
    assert counts(failure("one", value), failure("two", value)) == [("one", 2)]
