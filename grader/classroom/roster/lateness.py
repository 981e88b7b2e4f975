"""The late penalty of a submission under a rubric's policy.

It is a separate line, never part of a criterion.

As in Canvas (app/models/late_policy.rb): a percentage of the maximum for each day begun, and never
below the floor.
"""

import re
from contextlib import suppress
from datetime import date, datetime, time, timedelta, tzinfo
from decimal import Decimal
from math import ceil
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.text import counted
from grader.classroom.roster.roster import Student
from grader.lab.rubric.criterion import Late
from grader.lab.rubric.rubric import Rubric

_DAY = timedelta(days=1)
_LAST = 999_999  # microsecond, of a deadline that is the end of a day or a minute
_IN_MINUTES = re.compile(r"\S+[T ]\d\d(:?\d\d)?(Z|[+-].*)?")  # a time without seconds


class Lateness(NamedTuple):
    """The lateness of a submission.

    Days begun, the penalty in points (0 or less), and the reason in words.

    If the LMS does not tell when it was submitted, the days are a guess.
    """

    days: int = 0
    points: Decimal = Decimal(0)
    reason: str = ""
    is_guess: bool = False


def lateness(
    rubric: Rubric,
    times: Student,
    score: Decimal,
    deadline: datetime | None = None,
    own_deadline: str = "",
) -> Lateness:
    """Return the lateness of a student's submission with this score.

    The deadline of `grader mark STUDENT deadline`, `own_deadline`, comes first, then the student's,
    `deadline` and the rubric's.
    """
    policy = rubric.late
    if own_deadline:
        is_timed = times.submitted and times.days_late  # without a time no days can be counted
        days_late = None if is_timed else times.days_late
        times = times._replace(due=own_deadline, extension_days=0.0, days_late=days_late)
    days, reason, is_guess = _days_late(times, policy, deadline)
    if policy is None or not days:
        return Lateness(days, Decimal(0), reason)
    floor = min(score, rubric.points * policy.floor_percent / 100)
    reduced = max(floor, score - rubric.points * policy.percent_per_day * days / 100)
    return Lateness(days, reduced - score, reason, is_guess)


def read_time(text: str, where: str = "") -> datetime:
    """Return a deadline that is written as ISO 8601. Raises InputError.

    A date alone means the end of that day, a time without seconds the end of that minute.
    """
    text = text.strip()
    with suppress(ValueError):
        return datetime.combine(date.fromisoformat(text), time.max)
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        raise InputError(
            f"{where}{text!r} is not a date or time: write it as 2026-11-20T23:59+01:00"
        ) from None
    if _IN_MINUTES.fullmatch(text):
        return moment.replace(second=59, microsecond=_LAST)
    return moment


def time_text(when: datetime | str, zone: tzinfo | None = None) -> str:
    """Return a time in a time zone with its offset: 2026-11-20 23:59 (UTC+01:00).

    By default the time zone is that of this machine.

    A time without an offset is returned without one.
    """
    moment = datetime.fromisoformat(when) if isinstance(when, str) else when
    if moment.tzinfo is not None:
        with suppress(OverflowError):  # in the year 1 or 9999
            moment = moment.astimezone(zone)
    plain = moment.replace(tzinfo=None)
    offset = moment.isoformat().removeprefix(plain.isoformat())
    shown = plain.isoformat(
        " ", "seconds" if plain.second and plain.microsecond != _LAST else "minutes"
    )
    if offset:
        return f"{shown} (UTC{offset.replace('+00:00', '')})"
    return shown


def _days_late(
    times: Student, policy: Late | None, deadline: datetime | None
) -> tuple[int, str, bool]:
    """Return the days begun, the reason in words, and whether the days are a guess."""
    grace = timedelta(minutes=float(policy.grace_minutes) if policy is not None else 0)
    if times.days_late is not None:
        # A whole number is what a person has decided; a fraction is a time, which Moodle has
        # measured.
        days = max(
            0, ceil(times.days_late - grace / _DAY if times.days_late % 1 else times.days_late)
        )
        if times.measured_by:
            source = f"by {times.measured_by}'s own status"
        else:
            source = "as recorded by the instructor"
        is_guess = bool(times.measured_by and times.due)  # which the LMS may not know
        return days, f"{counted(days, 'day')} late, {source}" if days else "", is_guess
    due = deadline
    if times.due:
        due = read_time(times.due)
    elif due is None and policy is not None:
        due = policy.due
    if times.submitted and due is not None:
        # A time without an offset is in the time zone of the other one.
        submitted = _in_zone(datetime.fromisoformat(times.submitted), due)
        due = _in_zone(due, submitted)
        days = max(
            0, -((times.extension_days * _DAY + grace - (submitted - due)) // _DAY)
        )  # rounded up to days begun
        extension = f", extension {times.extension_days:g} day{'s' * (times.extension_days != 1)}"
        more = extension if times.extension_days else ""
        shown = (
            f"submitted {time_text(submitted, due.tzinfo)}, deadline "
            f"{time_text(due, due.tzinfo)}{more}"
        )
        return days, f"{counted(days, 'day')} late: {shown}" if days else "", False
    # The LMS says only that the submission is late, and may not know the student's own deadline.
    if times.is_late:
        return (1, "late by an unknown time, which counts as 1 day", True)
    return (0, "", False)


def _in_zone(time: datetime, other: datetime) -> datetime:
    """Return a time without an offset in the time zone of another one."""
    return time.replace(tzinfo=time.tzinfo or other.tzinfo)
