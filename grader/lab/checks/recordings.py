"""Checks of recordings: whether there is one, its topics, and the values in them."""

from collections.abc import Mapping, Sequence
from math import inf, isfinite
from typing import TYPE_CHECKING

from grader.base.errors import NotDecided, RubricError
from grader.base.quantities import point
from grader.base.text import enumerated
from grader.base.toml_types import Count, NonNegative
from grader.lab.checks.check import About
from grader.lab.checks.opened_recordings import ask_recordings, need_topic, weigh_losses
from grader.lab.checks.outcome import Outcome, failed, judged, passed, pending
from grader.lab.submission.submission import Submission

if TYPE_CHECKING:
    from grader.ros.api import RecordedTopic, Recording

_SLOWER = 0.95  # of a rate: timers are not exact
ABOUT = {
    "recording_found": About(
        causes={"short": "the recording is shorter", "part": "a file of the recording is missing"}
    ),
    "recorded_topic": About(
        causes={
            "type": "the topic has another type",
            "count": "it has fewer messages",
            "rate": "it has fewer messages a second",
            "stamps": "the time in the headers is 0",
        }
    ),
}


def recording_found(
    submission: Submission, *, seconds: NonNegative = 0.0, name: str = ""
) -> Outcome:
    """The submission has a recording of `ros2 bag record` with messages.

    It is a folder with `metadata.yaml`, or a file with the ending `.mcap` or `.db3` alone.

    Args:
        seconds: How long it lasts at least, by the clock of the robot, with 5 % below.
        name: A pattern for the name of its folder or file; default: any.
    """
    return ask_recordings(submission, name, lambda recording: _judge_length(recording, seconds))


def _judge_length(recording: "Recording", seconds: float) -> Outcome:
    for note in recording.notes:
        if note.kind == "missing":
            return failed(
                f"a part of the recording is missing: {note.text}",
                mistake="a part of the recording is missing",
                cause="part",
            )
    lasts = recording.seconds
    told = f"{recording.path!r} lasts {lasts:.1f} s"
    if lasts >= seconds * _SLOWER:
        notes = "; ".join(note.text for note in recording.notes)
        return judged(True, f"{told} ({notes})" if notes else told, lasts, seconds, unit="s")
    message = f"{told}, expected at least {point((seconds,))} s"
    outcome = judged(False, message, lasts, seconds, unit="s")
    return weigh_losses(outcome, recording, mistake="the recording is too short", cause="short")


def recorded_topic(
    submission: Submission,
    *,
    topic: str,
    type: str | None = None,  # noqa: A002  a rubric calls it so
    at_least: Count = 1,
    rate: NonNegative = 0.0,
    stamped: bool = True,
    name: str = "",
) -> Outcome:
    """A topic was recorded, with messages of a type.

    Rates are those of the times in headers, so they do not depend on the speed of a simulation. Of
    types without a header, they are those of the recorder.

    Args:
        topic: The topic.
        type: Its type: sensor_msgs/msg/LaserScan; default: any.
        at_least: How many messages it has at least.
        rate: How many messages it has a second at least, with 5 % below for timers that are slow.
        stamped: Whether the headers of odometry and of data of sensors need a time other than 0.
        name: A pattern for the name of the recording; default: the only one.
    """
    wanted = _type_name(type) if type else ""

    def judge(recording: "Recording") -> Outcome:
        recorded = need_topic(recording, topic)
        return (
            _judge_type(recorded, wanted)
            or _judge_count(recorded, at_least, recording)
            or _judge_stamps(recorded, is_needed=stamped)
            or _judge_rate(recorded, rate, recording)
        )

    return ask_recordings(submission, name, judge)


def _type_name(written: str) -> str:
    """Return a type with its kind: geometry_msgs/msg/Twist for geometry_msgs/Twist."""
    package, _, name = written.partition("/")
    if not name:
        raise RubricError((f"{written!r} is no type: write geometry_msgs/msg/Twist",))
    return written if "/" in name else f"{package}/msg/{name}"


def _judge_type(recorded: "RecordedTopic", wanted: str) -> Outcome | None:
    others = sorted(each for each, count in recorded.types.items() if count and each != wanted)
    if not wanted or not others:
        return None
    message = f"{recorded.name} has the type {enumerated(others)}, expected {wanted}"
    return failed(message, cause="type")


def _judge_count(
    recorded: "RecordedTopic", at_least: int, recording: "Recording"
) -> Outcome | None:
    if recorded.count >= at_least:
        return None
    message = f"{recorded.name} has {recorded.count} messages, expected at least {at_least}"
    outcome = judged(False, message, recorded.count, at_least)
    return weigh_losses(
        outcome, recording, mistake=f"{recorded.name} has too few messages", cause="count"
    )


def _judge_stamps(recorded: "RecordedTopic", *, is_needed: bool) -> Outcome | None:
    if not is_needed or not recorded.needs_stamps:
        return None
    stamps = [stamp for stamp in recorded.stamps if stamp is not None]
    if not stamps or any(stamps):
        return None
    message = f"the time in the headers of all messages of {recorded.name} is 0"
    return failed(f"{message}: set header.stamp", mistake=message, cause="stamps")


def _judge_rate(recorded: "RecordedTopic", rate: float, recording: "Recording") -> Outcome:
    actual = recorded.rate or 0.0
    told = f"{recorded.name} has {recorded.count} messages"
    if not rate:
        return passed(told)
    message = f"{recorded.name} has {actual:.1f} messages a second"
    if actual >= rate * _SLOWER:
        return judged(True, message, actual, rate, unit="Hz")
    outcome = judged(False, f"{message}, expected {point((rate,))}", actual, rate, unit="Hz")
    return weigh_losses(
        outcome, recording, mistake=f"{recorded.name} has too low a rate", cause="rate"
    )


def recorded_value(
    submission: Submission,
    *,
    topic: str,
    field: str,
    smallest: float | None = None,
    largest: float | None = None,
    last: bool = False,
    name: str = "",
) -> Outcome:
    """The numbers in a field of a recorded topic are within limits.

    Numbers that are not finite do not count. If none is finite, manual grading is needed.

    Args:
        topic: The topic.
        field: The field: ranges, or pose.pose.position.x. Of a list, all items count, or one:
            position[2], or position[elbow_joint] with the name of a joint.
        smallest: What they are at least; default: no limit.
        largest: What they are at most; default: no limit.
        last: Whether only the last message counts.
        name: A pattern for the name of the recording; default: the only one.
    """
    low = -inf if smallest is None else smallest
    high = inf if largest is None else largest
    path = field.replace("[", ".").replace("]", "").split(".")

    def judge(recording: "Recording") -> Outcome:
        recorded = need_topic(recording, topic)
        outcome = _judge_numbers(recorded, field, path, (low, high), is_last=last)
        for note in recording.losses:
            if outcome.status != "pending" and (last or note.kind == "limit"):
                message = f"{outcome.message}, but {note.text}; needs manual grading"
                return pending(message, "the recording is not complete")
        return outcome

    return ask_recordings(submission, name, judge)


def _judge_numbers(
    recorded: "RecordedTopic",
    field: str,
    path: Sequence[str],
    limits: tuple[float, float],
    *,
    is_last: bool,
) -> Outcome:
    if not recorded.messages or recorded.is_large:
        raise NotDecided(f"messages of {recorded.name} cannot be decoded", "cannot be decoded")
    counted = recorded.messages[-1:] if is_last else recorded.messages
    numbers = []
    has_field = False
    for time, message in counted:
        values = _find_numbers(message, path)
        if values is not None:
            has_field = True
            numbers += [(value, time) for value in values if isfinite(value)]
    what = f"{field} of {recorded.name}"
    if not has_field:
        types = enumerated(sorted(recorded.types))
        return failed(f"{recorded.name} has no field {field}: its type is {types}")
    if not numbers:
        return pending(f"no number in {what} is finite; needs manual grading", "nothing is finite")
    (least, least_at), (most, most_at) = min(numbers), max(numbers)
    start = recorded.messages[0].time
    if least < limits[0]:
        return _fail_number("smallest", what, least, limits[0], least_at - start)
    if most > limits[1]:
        return _fail_number("largest", what, most, limits[1], most_at - start)
    return passed(f"the numbers in {what} are {point((least,))} to {point((most,))}")


def _fail_number(end: str, what: str, value: float, limit: float, seconds: float) -> Outcome:
    start = f"the {end} number in {what} is"
    message = f"{start} {point((value,))}, expected {point((limit,))} (at {seconds:.1f} s)"
    outcome = judged(False, message, value, limit)
    return outcome._replace(mistake=f"{start} out of range")


def _find_numbers(
    value: object, path: Sequence[str], owner: Mapping[str, object] | None = None
) -> list[float] | None:
    """Return the numbers at the end of a path through fields and items of lists.

    The result is None if there is no such field. `owner` is the message that a list is in.
    """
    if isinstance(value, list | tuple):
        index = _find_index(path[0], owner or {}) if path else None
        if index is not None:
            return _find_numbers(value[index], path[1:]) if index < len(value) else []
        numbers: list[float] = []
        for item in value:
            numbers += _find_numbers(item, path) or ()
        return numbers
    if path:
        if not isinstance(value, dict) or path[0] not in value:
            return None
        return _find_numbers(value[path[0]], path[1:], value)
    return [float(value)] if isinstance(value, int | float) else None


def _find_index(name: str, owner: Mapping[str, object]) -> int | None:
    """Return which item of a list is meant: by its number, or by the name of a joint beside it."""
    if name.isdecimal():
        return int(name[:9])
    names = owner.get("name")
    return names.index(name) if isinstance(names, list) and name in names else None
