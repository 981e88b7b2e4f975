"""Late penalties: grace period, days begun, the floor, whose deadline counts, and times with and without an offset."""

from datetime import datetime, timedelta
from decimal import Decimal
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.roster.lateness import lateness, read_time
from grader.classroom.roster.roster import Student
from grader.lab.rubric.rubric import Rubric
from tests.classroom.gradebooks import lab

DUE = "due = 2026-09-10T12:00:00+02:00\n"
POLICY = "percent_per_day = 10\nfloor_percent = 50\n"
LAB = lab(DUE + POLICY)  # of 11 points


def cost(score: str, days: float, policy: str = POLICY) -> Decimal:
    """Return the penalty for so many days late on a submission with this score."""
    return lateness(lab(policy), Student("ann", days_late=days), Decimal(score)).points


def days(
    submitted: str, rubric: Rubric = LAB, due: datetime | None = None, own: str = "", **more: Any
) -> int:
    """Return how many days late a submission is; `own` is the student's own deadline."""
    return lateness(
        rubric, Student("ann", submitted=submitted, due=own, **more), Decimal(11), due
    ).days


PERCENT = st.decimals(0, 100, places=2)
SCORE = st.decimals(0, 11, places=4)


@given(PERCENT, PERCENT, SCORE, st.integers(0, 400))
def test_totals_respect_the_floor_and_fall_with_the_days(
    percent: Decimal, floor: Decimal, score: Decimal, late: int
) -> None:
    """A total lies between the score and the lower of score and floor, and falls with the days by whole steps."""
    policy = f"percent_per_day = {percent}\nfloor_percent = {floor}\n"
    totals = [score + cost(str(score), days_late, policy) for days_late in (late, late + 1)]
    least = min(score, 11 * floor / 100)
    assert score >= totals[0] >= totals[1] >= least
    if totals[1] > least:
        assert totals[0] - totals[1] == 11 * percent / 100


@given(st.integers(-(10**7), 10**7), st.integers(0, 10**5))
def test_days_by_time(seconds: int, grace: int) -> None:
    """The number of days is the number begun after the grace period."""
    submitted = (read_time("2026-09-10T12:00:00+02:00") + timedelta(seconds=seconds)).isoformat()
    over = seconds - 60 * grace
    assert days(submitted, lab(f"{DUE}{POLICY}grace_minutes = {grace}\n")) == (
        0 if over <= 0 else -(-over // 86_400)
    )
