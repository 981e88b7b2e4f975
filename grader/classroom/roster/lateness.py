"""The late penalty of a submission under a rubric's policy.

It is a separate line, never part of a criterion.

As in Canvas (app/models/late_policy.rb), it is a percentage of the maximum for each day begun, and
never leads below the floor. It can be points, too, and late tokens cover days.
"""

from contextlib import suppress
from datetime import date, datetime, time, timedelta, tzinfo
from decimal import Decimal
from math import ceil
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.patterns import on_use
from grader.base.text import counted
from grader.classroom.roster.roster import Student
from grader.lab.rubric.criterion import Late
from grader.lab.rubric.rubric import Rubric

_DAY = timedelta(days=1)
# The time from which Moodle writes a smaller unit beside the first one, and that unit.
_MOODLE_UNITS = (
    (timedelta(days=365), _DAY),
    (_DAY, timedelta(hours=1)),
    (timedelta(hours=1), timedelta(minutes=1)),
)
_LAST = 999_999  # microsecond, of a deadline that is the end of a day or a minute
_IN_MINUTES = on_use(r"\S+[T ]\d\d(:?\d\d)?(Z|[+-].*)?")  # a time without seconds


class Lateness(NamedTuple):
    """The lateness of a submission.

    Days begun, the penalty in points (0 or less), and the reason in words.

    If the LMS does not tell when it was submitted, the days are a guess, and no deadline of the
    student can change them: they are not timed.
    """

    days: int = 0
    points: Decimal = Decimal(0)
    reason: str = ""
    is_guess: bool = False
    is_timed: bool = False


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
        if days_late and times.measured_by:  # without the extension that Moodle does not know
            days_late += times.extension_days
        times = times._replace(due=own_deadline, extension_days=0.0, days_late=days_late)
    late = _days_late(times, policy, deadline)
    days = max(0, late.days - times.tokens)
    if late.days and times.tokens:
        covered = counted(late.days - days, "day")
        late = late._replace(reason=f"{late.reason}; tokens cover {covered}")
    if not policy or not days:
        return late._replace(is_guess=False)
    floor = min(score, rubric.points * policy.floor_percent / 100)
    a_day = policy.points_per_day + rubric.points * policy.percent_per_day / 100
    reduced = max(floor, score - policy.points - a_day * days)
    return late._replace(points=reduced - score)


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


def _days_late(times: Student, policy: Late | None, deadline: datetime | None) -> Lateness:
    """Return the lateness without a penalty: the days begun, and the reason in words."""
    grace = timedelta(minutes=float(policy.grace_minutes) if policy else 0)
    due = deadline
    if due is None and policy:
        due = policy.due
    if times.days_late and times.measured_by and times.due and due is not None:
        measured = _measured_days(times, grace, due)
        if measured:
            return measured
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
        reason = f"{counted(days, 'day')} late, {source}" if days else ""
        return Lateness(days, reason=reason, is_guess=is_guess)
    if times.due:
        due = read_time(times.due)
    if times.submitted and due is not None:
        # A time without an offset is in the time zone of the other one.
        submitted = _in_zone(datetime.fromisoformat(times.submitted), due)
        due = _in_zone(due, submitted)
        days = max(
            0, -((times.extension_days * _DAY + grace - (submitted - due)) // _DAY)
        )  # rounded up to days begun
        shown = (
            f"submitted {time_text(submitted, due.tzinfo)}, deadline "
            f"{time_text(due, due.tzinfo)}{_extension_text(times)}"
        )
        reason = f"{counted(days, 'day')} late: {shown}" if days else ""
        return Lateness(days, reason=reason, is_timed=True)
    # The LMS says only that the submission is late, and may not know the student's own deadline.
    if times.is_late:
        reason = "late by an unknown time, which counts as 1 day"
        return Lateness(1, reason=reason, is_guess=True)
    return Lateness()


def _measured_days(times: Student, grace: timedelta, due: datetime) -> Lateness | None:
    """Return the lateness of a student with a later deadline, of whom Moodle measured the time.

    Moodle measures it from the deadline of the class, `due`, and rounds down: where the rest
    decides about a day, the days are a guess. They are None if the deadline of the class is later:
    then it may not be the one that Moodle knows.
    """
    # Without an extension that only the roster has.
    measured = timedelta(days=(times.days_late or 0) + times.extension_days)
    own_due = _in_zone(read_time(times.due), due)
    later = own_due - _in_zone(due, own_due)
    if later < timedelta(0):
        return None
    later += times.extension_days * _DAY + grace
    days = max(0, -((later - measured) // _DAY))  # rounded up to days begun
    most = max(0, -((later - measured - _rounded_by(measured)) // _DAY))
    deadline = f"the student's deadline {time_text(own_due, own_due.tzinfo)}"
    reason = ""
    if days:
        reason = (
            f"{counted(days, 'day')} late, by {times.measured_by}'s own status and {deadline}"
            f"{_extension_text(times)}"
        )
    return Lateness(days, reason=reason, is_guess=days != most, is_timed=True)


def _extension_text(times: Student) -> str:
    if not times.extension_days:
        return ""
    return f", extension {times.extension_days:g} day{'s' * (times.extension_days != 1)}"


def _rounded_by(measured: timedelta) -> timedelta:
    """Return by how much Moodle may have rounded a time down: to its second unit.

    It is a microsecond less than that, moodlelib.php, format_time().
    """
    unit = timedelta(seconds=1)
    for least, second in _MOODLE_UNITS:
        if measured >= least:
            unit = second
            break
    return unit - timedelta(microseconds=1)


def _in_zone(time: datetime, other: datetime) -> datetime:
    """Return a time without an offset in the time zone of another one."""
    return time.replace(tzinfo=time.tzinfo or other.tzinfo)
