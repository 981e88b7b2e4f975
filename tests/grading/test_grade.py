"""Faults of checks, and sums of points; which criteria are skipped, carried or corrected is in `tests/corpus/grading`."""

from collections.abc import Callable, Sequence
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import MissingElement
from grader.lab.checks.check import describe
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.rubric.criterion import Adjustment, Carried, Criterion, Part
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.opening import read_submission
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Mesh
from grader.ros.urdf.shapes import UnknownShape
from tests.examples import examples


def passes_(robot: Configuration) -> Outcome:
    """A check that always passes."""
    return passed("it is so")


def fails_(robot: Configuration) -> Outcome:
    """A check that always fails."""
    return failed("it is not so")


def pends(robot: Configuration) -> Outcome:
    """A check that needs manual grading."""
    raise UnknownShape(Mesh("part.stl"))


def breaks(robot: Configuration) -> Outcome:
    """A check with an error of the grader."""
    raise ZeroDivisionError("a secret detail")


def misses(robot: Configuration) -> Outcome:
    """A check that misses a thing."""
    raise MissingElement("thing", "x")


def ask(
    name: str,
    check: Callable[..., Outcome] = passes_,
    *,
    points: str = "1",
    requires: Sequence[str] = (),
    part: str = "a",
    **more: Any,
) -> Criterion:
    """Return a criterion."""
    return Criterion(
        name, name.title(), part, Decimal(points), describe(check), {}, tuple(requires)
    )._replace(**more)


def run(*criteria: Criterion, parts: Sequence[str] = ()) -> Report:
    """Return the report on a robot under a rubric with these criteria, in parts a and b."""
    rubric = Rubric(
        "r", "R", (Part("a", "A"), Part("b", "B")), criteria, "robot.urdf", "", b"", Path("r.toml")
    )
    robot = b'<robot name="r"><link name="base"/></robot>'
    return grade(rubric, read_submission(robot, identity="me", path="robot.urdf"), parts)


def statuses(report: Report) -> list[str]:
    """Return the status of each criterion, in order."""
    return [result.outcome.status for result in report.results]


def test_an_exception_in_a_check_is_an_error_of_the_grader() -> None:
    """The criterion is errored, not failed; the traceback is kept, and the message is short."""
    result = run(ask("one", breaks)).results[0]
    assert result.outcome.status == "errored"
    assert "ZeroDivisionError" in result.outcome.message
    assert "a secret detail" not in result.outcome.message
    assert result.traceback.startswith("Traceback (most recent call last):")
    assert "in breaks" in result.traceback
    assert result.traceback.endswith("ZeroDivisionError: a secret detail\n")


def test_an_errored_criterion_affects_no_other() -> None:
    """Earlier and later criteria are graded as usual; one that requires it is not said to be skipped by a mistake."""
    report = run(
        ask("one"),
        ask("two", breaks),
        ask("three", requires=["two"]),
        ask("four", fails_),
        ask("five", pends),
    )
    assert [*statuses(report)[:2], *statuses(report)[3:]] == [
        "passed",
        "errored",
        "failed",
        "pending",
    ]
    assert [bool(result.traceback) for result in report.results] == [
        False,
        True,
        False,
        False,
        False,
    ]
    after = report.results[2]
    assert after.outcome.status == "passed" or (
        after.because,
        "failed" in after.outcome.message,
    ) == ("two", False)


def test_a_skipped_check_is_not_run() -> None:
    """An error in a check that is skipped does not occur."""
    assert statuses(run(ask("one", fails_), ask("two", breaks, requires=["one"]))) == [
        "failed",
        "skipped",
    ]


def test_a_faulty_fact_is_a_fault_of_the_grader() -> None:
    """An exception in the check that counts instead makes the criterion errored, never a silent zero."""
    carried = (Carried(("one",), describe(breaks), {}),)
    report = run(ask("one", fails_), ask("two", fails_, carried=carried))
    assert statuses(report) == ["failed", "errored"]
    assert report.results[1].traceback


@pytest.mark.parametrize("check", [passes_, fails_, pends, breaks, misses])
def test_the_outcome_does_not_decide_a_corrected_criterion(check: Callable[..., Outcome]) -> None:
    """Whatever the check finds, even if it is faulty: all get the points, or it does not count."""
    full = ask("one", check, points="2.5", adjustment=Adjustment("full", "why"))
    dropped = ask("two", check, points="0", adjustment=Adjustment("drop", "why"))
    report = run(full, dropped)
    assert [report.score, report.max_score, report.pending] == [Decimal("2.5"), Decimal("2.5"), 0]
    assert (report.has_failures, report.fault, report.unearned) == (False, "", ())
    assert not any(result.is_open or result.is_lost for result in report.results)


@pytest.mark.parametrize(
    "error",
    [
        KeyError("x"),
        LookupError("x"),
        ValueError("x"),
        RecursionError("x"),
        AssertionError("x"),
        MemoryError("x"),
    ],
)
def test_every_exception_of_a_check_is_caught(error: Exception) -> None:
    """Whatever a check raises unexpectedly, the run continues."""

    def raises(robot: Configuration) -> Outcome:
        raise error

    assert statuses(run(ask("one", raises), ask("two"))) == ["errored", "passed"]


def test_an_interrupt_is_not_caught() -> None:
    """An interrupt by the user is not an error of a check."""

    def interrupted(robot: Configuration) -> Outcome:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(ask("one", interrupted))


@examples(20)
@given(
    rows=st.lists(
        st.tuples(
            st.sampled_from([passes_, fails_, pends, breaks]),
            st.integers(0, 1000),
            st.sampled_from("ab"),
        ),
        max_size=12,
    )
)
def test_sums_equal_those_of_the_rows(rows: list[tuple[Callable[..., Outcome], int, str]]) -> None:
    """For any mix of outcomes the sums are exact, part by part and together, and the same in another run."""
    criteria = [
        ask(f"c{index}", check, points=f"{points // 100}.{points % 100:02d}", part=part)
        for index, (check, points, part) in enumerate(rows)
    ]
    for parts in ((), ("a",), ("b",)):
        chosen = [(check, points) for check, points, part in rows if not parts or part in parts]
        report = run(*criteria, parts=parts)
        assert report.max_score * 100 == sum(points for _, points in chosen)
        assert report.score * 100 == sum(points for check, points in chosen if check is passes_)
        assert report.pending * 100 == sum(points for check, points in chosen if check is pends)
        assert [result.outcome for result in run(*criteria, parts=parts).results] == [
            result.outcome for result in report.results
        ]
