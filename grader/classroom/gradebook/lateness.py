"""What a late hand-in costs under a rubric's policy: a line of its own, never part of a criterion.

As Canvas does it (app/models/late_policy.rb): so many percent of all points that can be earned for each day begun, and never
more than down to the floor.
"""

from dataclasses import dataclass
from datetime import date, datetime, time, timedelta
from decimal import Decimal
from math import ceil

from grader.errors import InputError
from grader.grading.rubric import Late, Rubric

_DAY = timedelta(days=1)


@dataclass(frozen=True, slots=True)
class Lateness:
    """How late a hand-in is, in days begun, and the points (0 or less) that it costs. `reason` says why."""

    days: int = 0
    points: Decimal = Decimal(0)
    reason: str = ""


@dataclass(frozen=True, slots=True)
class SubmissionTimes:
    """What is known of when something was handed in and when it was due: ISO 8601, empty or None where nobody says."""

    is_late: bool = False
    submitted: str = ""
    due: str = ""
    extension: float = 0.0
    days_late: float | None = None


def lateness(rubric: Rubric, times: SubmissionTimes, score: Decimal, due: datetime | None = None) -> Lateness:
    """What a hand-in with these times and points loses. `due` goes before the rubric's; a student's own before both."""
    policy = rubric.late
    days, words = _days(times, policy, due)
    if policy is None or not days:
        return Lateness(days, Decimal(0), words)
    least = min(score, rubric.points * policy.floor_percent / 100)
    left = max(least, score - rubric.points * policy.percent_per_day * days / 100)
    return Lateness(days, left - score, words)


def read_time(text: str) -> datetime:
    """When something is due, as ISO 8601: a date alone is the end of that day. Raises InputError."""
    try:
        return datetime.combine(date.fromisoformat(text.strip()), time.max)
    except ValueError:
        pass
    try:
        return datetime.fromisoformat(text.strip())
    except ValueError:
        raise InputError(f"{text!r} is no time: write it as 2026-11-20T23:59+01:00") from None


def _days(times: SubmissionTimes, policy: Late | None, due: datetime | None) -> tuple[int, str]:
    if times.days_late is not None:
        days = max(0, ceil(times.days_late))
        return days, f"{_many(days)} late, by the roster" if days else ""
    due = read_time(times.due) if times.due else due or (policy.due if policy is not None else None)
    if not times.submitted or due is None:
        return (1, "late by an unknown time, which counts as 1 day") if times.is_late else (0, "")
    due, handed_in = _in_one_zone(due, datetime.fromisoformat(times.submitted))
    allowed = times.extension * _DAY + timedelta(minutes=float(policy.grace_minutes) if policy is not None else 0)
    days = max(0, -((allowed - (handed_in - due)) // _DAY))  # those begun: rounded up
    if not days:
        return 0, ""
    more = f", extended by {times.extension:g} day{'' if times.extension == 1 else 's'}" if times.extension else ""
    return days, f"{_many(days)} late: handed in {times.submitted}, due {due.isoformat(timespec='minutes')}{more}"


def _in_one_zone(due: datetime, handed_in: datetime) -> tuple[datetime, datetime]:
    """Two times that can be compared: one without an offset is taken for one where the other is."""
    return due.replace(tzinfo=due.tzinfo or handed_in.tzinfo), handed_in.replace(tzinfo=handed_in.tzinfo or due.tzinfo)


def _many(days: int) -> str:
    return f"{days} day{'' if days == 1 else 's'}"
