"""Adjusted criteria and extra credit in a report: points, sums, and what other criteria make of them."""

from collections.abc import Callable
from decimal import Decimal

import pytest

from grader.grading.criterion import Adjustment, Criterion
from grader.grading.report import Report
from tests.checks.outcomes import AnyCheck
from tests.grading.test_carried import carried_from, misses_, report_on
from tests.grading.test_grade import ask, breaks, fails_, passes_, pends

CHECKS: tuple[AnyCheck, ...] = (passes_, fails_, pends, breaks, misses_)


def full(criterion: Criterion) -> Criterion:
    """Return a criterion whose points everybody gets."""
    return criterion._replace(adjustment=Adjustment("full", "why"))


def dropped(criterion: Criterion) -> Criterion:
    """Return a criterion that does not count."""
    return criterion._replace(points=Decimal(0), adjustment=Adjustment("drop", "why"))


def statuses(report: Report) -> list[str]:
    """Return the status of each criterion."""
    return [result.outcome.status for result in report.results]


@pytest.mark.parametrize("check", CHECKS)
def test_the_outcome_does_not_decide(check: AnyCheck) -> None:
    """Whatever the check finds, even if it is faulty."""
    report = report_on(full(ask("one", check, points="2.5")), dropped(ask("two", check, points="4")))
    assert [result.points for result in report.results] == [Decimal("2.5"), 0]
    assert [report.score, report.max_score, report.pending] == [Decimal("2.5"), Decimal("2.5"), 0]
    assert (report.has_failures, report.fault, report.unearned) == (False, "", ())
    assert not any(result.is_open or result.is_lost for result in report.results)


@pytest.mark.parametrize("adjusted", [full, dropped])
def test_it_skips_nothing(adjusted: Callable[[Criterion], Criterion]) -> None:
    """Not what requires it, and not what misses the same thing."""
    report = report_on(
        adjusted(ask("one", fails_)),
        ask("two", passes_, requires=["one"]),
        adjusted(ask("three", misses_)),
        ask("four", misses_),
        ask("five", misses_),
        adjusted(ask("six", misses_)),
    )
    assert statuses(report) == ["failed", "passed", "failed", "failed", "skipped", "skipped"]
    assert [result.because for result in report.results] == [None, None, None, None, "four", "four"]


def test_a_criterion_below_a_skipped_one_names_the_mistake() -> None:
    """An adjusted criterion in between does not hide a failure that another one requires as well."""
    report = report_on(
        ask("one", fails_),
        dropped(ask("two", passes_, requires=["one"])),
        ask("three", passes_, requires=["two"]),
        ask("four", passes_, requires=["two", "one"]),
    )
    assert statuses(report) == ["failed", "skipped", "passed", "skipped"]
    assert report.results[3].because == "one"


def test_errors_are_carried_from_an_adjusted_criterion() -> None:
    """What fails only because of it has its points, so that nobody loses any by it; it is not carried itself."""
    report = report_on(dropped(ask("one", fails_)), carried_from("two", ["one"], fails_))
    assert [result.carried for result in report.results] == ["", "one"]
    assert [report.score, report.max_score, report.has_failures] == [1, 1, False]
    report = report_on(ask("one", fails_), full(carried_from("two", ["one"], fails_)))
    assert [result.carried for result in report.results] == ["", ""]
    assert report.results[1].why_given == "Points given to all students: why"


@pytest.mark.parametrize(("check", "score"), [(passes_, 3), (fails_, 1), (pends, 1)])
def test_extra_credit(check: AnyCheck, score: int) -> None:
    """It is in the score, not in the maximum; it needs manual grading like any other."""
    report = report_on(ask("one"), ask("two", check, points="2")._replace(bonus=True))
    assert [report.score, report.max_score, report.bonus] == [score, 1, score - 1]
    assert report.pending == (2 if check is pends else 0)
    assert report.unearned == ()


def test_adjusted_extra_credit() -> None:
    """It can be given to everybody, or dropped."""
    bonus = ask("two", fails_, points="2")._replace(bonus=True)
    given, gone = (report_on(ask("one"), adjusted(bonus)) for adjusted in (full, dropped))
    assert [given.score, given.max_score, given.bonus] == [3, 1, 2]
    assert [gone.score, gone.max_score, gone.bonus] == [1, 1, 0]
