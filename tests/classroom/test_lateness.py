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


def test_points_for_a_delay() -> None:
    """Points are deducted once, for each day, or both; a student who is not late loses none."""
    assert cost("11", 3, "points_per_day = 2\n") == -6
    assert cost("11", 3, "points = 1.5\n") == Decimal("-1.5")
    assert cost("11", 3, "points = 1\npoints_per_day = 1\nfloor_percent = 90\n") == Decimal("-1.1")
    assert cost("11", 0, "points = 1.5\n") == 0


def test_tokens_cover_days() -> None:
    """Days that tokens cover cost nothing, and the reason says how many they are."""
    policy = lab("points = 1\npoints_per_day = 2\n")
    late = lateness(policy, Student("ann", days_late=3, tokens=2), Decimal(11))
    assert (late.points, late.days) == (Decimal(-3), 3)
    assert late.reason.endswith("; tokens cover 2 days")
    covered = lateness(policy, Student("ann", days_late=1, tokens=2), Decimal(11))
    assert (covered.points, covered.reason.partition("; ")[2]) == (Decimal(0), "tokens cover 1 day")
    assert lateness(policy, Student("ann", tokens=2), Decimal(11)).reason == ""
