"""Late penalties: grace period, days begun, the floor, whose deadline counts, and times with and without an offset."""

from datetime import UTC, datetime, timedelta, timezone
from decimal import Decimal
from typing import Any
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.gradebook.lateness import Lateness, SubmissionTimes, lateness, read_time, time_text
from grader.errors import InputError
from grader.grading.rubric import Rubric
from tests.classroom.gradebooks import lab

DUE = "due = 2026-09-10T12:00:00+02:00\n"
POLICY = "percent_per_day = 10\nfloor_percent = 50\n"
LAB = lab(DUE + POLICY)  # of 11 points
LONG_GRACE = lab(f"{DUE}{POLICY}grace_minutes = 30\n")


def cost(score: str, days: float, policy: str = POLICY) -> Decimal:
    """Return the penalty for so many days late on a submission with this score."""
    return lateness(lab(policy), SubmissionTimes(days_late=days), Decimal(score)).points


def days(submitted: str, rubric: Rubric = LAB, due: datetime | None = None, own: str = "", **more: Any) -> int:
    """Return how many days late a submission is; `own` is the student's own deadline."""
    return lateness(rubric, SubmissionTimes(submitted=submitted, deadline=own, **more), Decimal(11), due).days


@pytest.mark.parametrize(
    ("score", "late", "points"),
    [
        ("11", 0, "0"),
        ("11", 1, "-1.1"),
        ("11", 1.01, "-2.2"),
        ("11", 5, "-5.5"),
        ("11", 50, "-5.5"),  # never below half of the maximum
        ("6", 1, "-0.5"),
        ("5.5", 3, "0"),
        ("2", 3, "0"),  # a score below the floor is unchanged
        ("0", 3, "0"),
    ],
)
def test_percent_of_the_maximum_down_to_the_floor(score: str, late: float, points: str) -> None:
    """Each day begun costs a tenth of the maximum, and no score falls below the floor."""
    assert cost(score, late) == Decimal(points)


def test_without_a_floor_the_penalty_is_at_most_the_score() -> None:
    """A total is never negative."""
    assert cost("3", 2, "percent_per_day = 10\n") == Decimal("-2.2")
    assert cost("3", 9, "percent_per_day = 10\n") == Decimal(-3)
    assert cost("11", 1, "percent_per_day = 100\n") == Decimal(-11)
    assert cost("11", 4, "percent_per_day = 100\nfloor_percent = 100\n") == 0


@pytest.mark.parametrize(
    ("submitted", "late", "with_grace"),
    [
        ("2026-09-10T12:00:00+02:00", 0, 0),
        ("2026-09-10T11:00:00+02:00", 0, 0),
        ("2026-09-10T12:00:01+02:00", 1, 0),
        ("2026-09-10T12:30:00+02:00", 1, 0),
        ("2026-09-10T12:30:01+02:00", 1, 1),
        ("2026-09-11T12:00:00+02:00", 1, 1),
        ("2026-09-11T12:00:01+02:00", 2, 1),
        ("2026-09-11T12:30:00+02:00", 2, 1),  # days are counted from the end of the grace period
        ("2026-09-11T12:30:01+02:00", 2, 2),
        ("2026-09-10T10:00:00Z", 0, 0),
        ("2026-09-10T10:00:01Z", 1, 0),
        ("2026-09-10T12:00:00", 0, 0),  # no offset: that of the deadline
        ("2026-09-10T12:00:01", 1, 0),
        ("2026-09-10", 0, 0),
    ],
)
def test_days_begin_after_the_grace_period(submitted: str, late: int, with_grace: int) -> None:
    """One second late is a day, and the grace period moves the whole count, as in Canvas."""
    assert days(submitted) == late
    assert days(submitted, LONG_GRACE) == with_grace


def test_whose_deadline_counts() -> None:
    """The student's own deadline precedes --due, which precedes the rubric's; an extension is added to any of them."""
    submitted = "2026-09-12T12:00:00+02:00"
    assert days(submitted) == 2
    assert days(submitted, due=read_time("2026-09-11T12:00:00+02:00")) == 1
    assert days(submitted, due=read_time("2026-09-11T12:00:00+02:00"), own="2026-09-09T12:00:00+02:00") == 3
    assert days(submitted, extension=1.5) == 1
    assert days(submitted, extension=2.0) == 0


def test_a_date_alone_ends_with_the_day() -> None:
    """A submission on the day of the deadline is on time."""
    assert days("2026-09-12T23:59:59", own="2026-09-12") == 0
    assert days("2026-09-13T00:00:01", own="2026-09-12") == 1
    assert days("2026-09-12T18:00:00", lab(POLICY), due=read_time("2026-09-12")) == 0
    assert days("2026-09-13T18:00:00", lab(POLICY), due=read_time("2026-09-12")) == 1


def test_days_in_the_roster_take_precedence() -> None:
    """They are rounded up to whole days; 0 is not late, whatever the LMS has flagged."""
    late = SubmissionTimes(is_late=True, submitted="2026-10-10T12:00:00Z", days_late=1.2)
    assert lateness(LAB, late, Decimal(11)) == Lateness(
        2, Decimal("-2.2"), "2 days late, as recorded by the instructor"
    )
    assert days("", is_late=True, days_late=0.0) == 0


def test_a_flag_without_a_time_is_one_day() -> None:
    """The message says that the time is unknown; a known time takes precedence over the flag."""
    assert days("", is_late=True) == 1
    assert "unknown" in lateness(LAB, SubmissionTimes(is_late=True), Decimal(11)).reason
    assert days("2026-09-10T11:00:00+02:00", is_late=True) == 0
    assert days("2026-09-15T12:00:00Z", lab(POLICY), is_late=True) == 1  # no deadline to compare with


def test_without_a_policy_there_is_no_penalty() -> None:
    """The lateness is still reported."""
    found = lateness(
        lab(), SubmissionTimes(submitted="2026-09-12T12:00:00Z", deadline="2026-09-10T12:00:00Z"), Decimal(11)
    )
    assert (found.days, found.points) == (2, Decimal(0))


def test_the_reason_names_the_deadline() -> None:
    """Both times are in the zone of the deadline, with its offset, so that a wrong one is noticed."""
    stored = SubmissionTimes(submitted="2026-09-11T22:30:00Z")
    words = "2 days late: submitted 2026-09-12 00:30 (UTC+02:00), deadline 2026-09-10 12:00 (UTC+02:00)"
    assert lateness(LAB, stored, Decimal(11)).reason == words
    late = SubmissionTimes(submitted="2026-09-12T12:00:00Z", deadline="2026-09-10T23:59", extension=1.0)
    words = "1 day late: submitted 2026-09-12 12:00 (UTC), deadline 2026-09-10 23:59 (UTC), extension 1 day"
    assert lateness(LAB, late, Decimal(11)).reason == words


def test_daylight_saving_time_is_in_the_offset() -> None:
    """The hour between two offsets is no lateness."""
    berlin = ZoneInfo("Europe/Berlin")
    due = datetime(2026, 10, 25, 2, 30, tzinfo=berlin, fold=0)  # the first of the two
    with_submission = datetime(2026, 10, 25, 2, 15, tzinfo=berlin, fold=1).isoformat()  # 45 minutes later
    assert with_submission.endswith("+01:00")
    assert days(with_submission, lab(POLICY), due=datetime.fromisoformat(due.isoformat())) == 1
    assert days("2026-10-26T01:30:00+01:00", lab(POLICY), due=read_time("2026-10-25T02:30+02:00")) == 1
    assert days("2026-10-26T01:30:01+01:00", lab(POLICY), due=read_time("2026-10-25T02:30+02:00")) == 2


@pytest.mark.parametrize("due", ["0001-01-01T00:00:00+14:00", "9999-12-31T23:59:59-12:00", "9999-12-31"])
def test_deadlines_at_the_ends_of_the_calendar(due: str) -> None:
    """No extension and no offset overflows the calendar."""
    for submitted in ("0001-01-01T00:00:00", "2026-09-10T12:00:00Z", "9999-12-31T23:59:59-12:00"):
        assert days(submitted, own=due, extension=9999.0) >= 0


@pytest.mark.parametrize("text", ["", "tomorrow", "2026-13-01", "12:00", "2026-11-20T25:00"])
def test_invalid_times(text: str) -> None:
    """One line says how to write a time."""
    with pytest.raises(InputError, match="is not a date or time: write it as 2026-11-20T23:59"):
        read_time(text)


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
    assert days(submitted, lab(f"{DUE}{POLICY}grace_minutes = {grace}\n")) == (0 if over <= 0 else -(-over // 86_400))


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        ({"extension": 2.0}, "late for the LMS, on time with the extension 2 days"),
        ({"extension": 0.5}, "late for the LMS, on time with the extension 0.5 days"),
        (
            {"deadline": "2026-09-10T12:01+02:00"},
            "late for the LMS, on time with the student's own deadline 2026-09-10 12:01 (UTC+02:00)",
        ),
        (
            {"deadline": "2026-09-10"},
            "late for the LMS, on time with the student's own deadline 2026-09-10 23:59 (UTC+02:00)",
        ),
        ({"deadline": "2026-09-10T12:00+02:00"}, "late by an unknown time, which counts as 1 day"),
        ({"deadline": "2026-09-09"}, "late by an unknown time, which counts as 1 day"),
        ({}, "late by an unknown time, which counts as 1 day"),
    ],
)
def test_a_flag_with_an_extension_is_on_time(more: dict[str, Any], reason: str) -> None:
    """An LMS knows no extension and no later deadline of the roster; the reason says so. Without the flag it says nothing."""
    found = lateness(LAB, SubmissionTimes(is_late=True, **more), Decimal(11))
    assert found.reason == reason
    assert (found.days, found.points) == ((0, 0) if "on time" in reason else (1, Decimal("-1.1")))
    assert lateness(LAB, SubmissionTimes(**more), Decimal(11)) == Lateness()
    known = SubmissionTimes(is_late=True, submitted="2026-09-20T12:00+02:00", **more)
    assert lateness(LAB, known, Decimal(11)).days >= 8  # a known time still counts


def test_an_own_deadline_needs_that_of_the_class() -> None:
    """Without the deadline of the class nobody knows whether the student's own one is later."""
    times = SubmissionTimes(is_late=True, deadline="2026-09-12")
    assert lateness(lab(POLICY), times, Decimal(11)).days == 1
    assert lateness(lab(POLICY), times, Decimal(11), read_time("2026-09-11")).days == 0
    extended = SubmissionTimes(is_late=True).extended("2026-09-12")
    assert lateness(lab(POLICY), extended, Decimal(11)).days == 0  # `grader extend` gives no earlier one
    assert lateness(lab(POLICY), extended, Decimal(11), read_time("2026-09-13")).days == 1


def test_the_grace_period_applies_to_fractions_of_days() -> None:
    """Moodle says 10 mins or 1 day 10 mins late: within the grace period. A whole number is what a person has decided."""
    late = {
        days: lateness(LONG_GRACE, SubmissionTimes(days_late=days), Decimal(11)).days
        for days in (0.007, 1.007, 1.03, 1.0, 2.0)
    }
    assert late == {0.007: 0, 1.007: 1, 1.03: 2, 1.0: 1, 2.0: 2}


def test_times_are_written_for_people() -> None:
    """To the minute unless seconds count, with the offset; without one if none is known, or the zone has no such time."""
    vienna = timezone(timedelta(hours=1))
    assert time_text("2026-11-20T22:59:00Z", vienna) == "2026-11-20 23:59 (UTC+01:00)"
    assert time_text("2026-11-20T22:59:30+00:00", vienna) == "2026-11-20 23:59:30 (UTC+01:00)"
    assert time_text("2026-11-20T23:59:00+01:00", UTC) == "2026-11-20 22:59 (UTC)"
    assert time_text(read_time("2026-11-20")) == "2026-11-20 23:59"
    assert time_text("9999-12-31T23:59:00-12:00", vienna) == "9999-12-31 23:59 (UTC-12:00)"


@pytest.mark.parametrize(
    ("times", "days"),
    [
        (SubmissionTimes(submitted="2026-09-12T10:00+02:00"), 0),
        (SubmissionTimes(submitted="2026-09-12T13:00+02:00"), 1),
        (SubmissionTimes(submitted="2026-09-13T10:00+02:00", deadline="2026-09-30", extension=9), 1),
        (SubmissionTimes(submitted="2026-09-12T10:00+02:00", days_late=3), 0),
        (SubmissionTimes(submitted="2026-09-30T10:00+02:00", days_late=0), 0),
        (SubmissionTimes(days_late=3), 3),
        (SubmissionTimes(is_late=True), 0),
        (SubmissionTimes(), 0),
    ],
)
def test_an_extension_of_a_person(times: SubmissionTimes, days: int) -> None:
    """It replaces the roster's deadline and extension, and a number of days if the time is known; a waiver stays."""
    assert times.extended("") is times
    assert lateness(LAB, times.extended("2026-09-12T12:00+02:00"), Decimal(11)).days == days
