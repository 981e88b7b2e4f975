"""The late penalty of a submission under a rubric's policy: a separate line, never part of a criterion.

As in Canvas (app/models/late_policy.rb): a percentage of the maximum for each day begun, and never below the floor.
"""

from contextlib import suppress
from datetime import date, datetime, time, timedelta, tzinfo
from decimal import Decimal
from math import ceil
from typing import NamedTuple

from grader.errors import InputError
from grader.grading.criterion import Late
from grader.grading.rubric import Rubric
from grader.text import counted

_DAY = timedelta(days=1)


class Lateness(NamedTuple):
    """The lateness of a submission: days begun, the penalty in points (0 or less), and the reason in words."""

    days: int = 0
    points: Decimal = Decimal(0)
    reason: str = ""


class SubmissionTimes(NamedTuple):
    """When something was submitted and was due: ISO 8601, empty or None where unknown. `extension` is in days.

    `is_extended`: the deadline is that of `grader mark STUDENT deadline`.
    """

    is_late: bool = False
    submitted: str = ""
    deadline: str = ""
    extension: float = 0.0
    days_late: float | None = None
    is_extended: bool = False

    def extended(self, deadline: str) -> "SubmissionTimes":
        """Return the times with the deadline of `grader mark STUDENT deadline`, unless empty."""
        days = None if self.submitted and self.days_late else self.days_late  # without a time no days can be counted
        return self._replace(deadline=deadline, extension=0.0, days_late=days, is_extended=True) if deadline else self


def lateness(rubric: Rubric, times: SubmissionTimes, score: Decimal, deadline: datetime | None = None) -> Lateness:
    """Return the lateness of a submission with this score.

    The student's own deadline comes first, then `deadline`, then the rubric's.
    """
    policy = rubric.late
    days, reason = _days_late(times, policy, deadline)
    if policy is None or not days:
        return Lateness(days, Decimal(0), reason)
    floor = min(score, rubric.points * policy.floor_percent / 100)
    reduced = max(floor, score - rubric.points * policy.percent_per_day * days / 100)
    return Lateness(days, reduced - score, reason)


def read_time(text: str) -> datetime:
    """Return a deadline that is written as ISO 8601; a date alone means the end of that day. Raises InputError."""
    with suppress(ValueError):
        return datetime.combine(date.fromisoformat(text.strip()), time.max)
    try:
        return datetime.fromisoformat(text.strip())
    except ValueError:
        raise InputError(f"{text!r} is not a date or time: write it as 2026-11-20T23:59+01:00") from None


def time_text(when: datetime | str, zone: tzinfo | None = None) -> str:
    """Return a time in a time zone, by default that of this machine, with its offset: 2026-11-20 23:59 (UTC+01:00).

    A time without an offset is returned without one.
    """
    moment = datetime.fromisoformat(when) if isinstance(when, str) else when
    if moment.tzinfo is not None:
        with suppress(OverflowError):  # in the year 1 or 9999
            moment = moment.astimezone(zone)
    plain = moment.replace(tzinfo=None)
    offset = moment.isoformat().removeprefix(plain.isoformat())
    shown = plain.isoformat(" ", "seconds" if plain.second and plain.time() != time.max else "minutes")
    return f"{shown} (UTC{offset.replace('+00:00', '')})" if offset else shown


def _days_late(times: SubmissionTimes, policy: Late | None, deadline: datetime | None) -> tuple[int, str]:
    grace = timedelta(minutes=float(policy.grace_minutes) if policy is not None else 0)
    if times.days_late is not None:
        # A whole number is what a person has decided; a fraction is a time, which Moodle has measured.
        late = times.days_late - grace / _DAY if times.days_late % 1 else times.days_late
        days = max(0, ceil(late))
        return days, f"{counted(days, 'day')} late, as recorded by the instructor" if days else ""
    of_class = deadline or (policy.due if policy is not None else None)
    due = read_time(times.deadline) if times.deadline else of_class
    if not times.submitted or due is None:
        return _of_flag(times, of_class) if times.is_late else (0, "")
    submitted = datetime.fromisoformat(times.submitted)
    # A time without an offset is in the time zone of the other one.
    due = due.replace(tzinfo=due.tzinfo or submitted.tzinfo)
    submitted = submitted.replace(tzinfo=submitted.tzinfo or due.tzinfo)
    days = max(0, -((times.extension * _DAY + grace - (submitted - due)) // _DAY))  # rounded up to days begun
    extension = f", {_extension(times)}" if times.extension else ""
    shown = f"submitted {time_text(submitted, due.tzinfo)}, deadline {time_text(due, due.tzinfo)}{extension}"
    return days, f"{counted(days, 'day')} late: {shown}" if days else ""


def _of_flag(times: SubmissionTimes, of_class: datetime | None) -> tuple[int, str]:
    """Return the days late and the reason if the LMS says only that a submission is late.

    The LMS does not know the extensions in the roster.
    """
    own = read_time(times.deadline) if times.deadline else None
    if own is not None:
        own = own.replace(tzinfo=own.tzinfo or (of_class.tzinfo if of_class is not None else None))
        if times.is_extended if of_class is None else own > of_class.replace(tzinfo=of_class.tzinfo or own.tzinfo):
            return 0, f"late for the LMS, on time with the student's own deadline {time_text(own, own.tzinfo)}"
    if times.extension > 0:
        return 0, f"late for the LMS, on time with the {_extension(times)}"
    return 1, "late by an unknown time, which counts as 1 day"


def _extension(times: SubmissionTimes) -> str:
    return f"extension {times.extension:g} day{'s' * (times.extension != 1)}"
