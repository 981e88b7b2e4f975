"""The outcome of a check, and its wording.

It says measured against expected, the difference, its unit and frame.
"""

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Literal, NamedTuple

from grader.base.grouping import Strings, StringsByName
from grader.base.quantities import SLACK, in_degrees, in_millimetres, point, within
from grader.base.source import LazyLocation, Location
from grader.base.transforms import Vector

Status = Literal["passed", "failed", "skipped", "pending", "errored"]
_Measured = bool | float | str | tuple[float, ...] | Strings | StringsByName | None
_AnyPlace = Location | LazyLocation | None

_SIDES = ("too large", "too small")
# begins the names of the frames of a base: its x axis points forward, y left, z up (REP 103, REP
# 105)
_BASE = "base"
_DIRECTIONS = (
    ("too far forward", "too far back"),
    ("too far left", "too far right"),
    ("too high", "too low"),
)
_UNITS = ((1000.0, "millimetres"), (100.0, "centimetres"))
# The causes of failures that every check has; an outcome without one is of the first.
WRONG = "wrong"
MISSING = "missing"
SLIP = "slip"


class Outcome(NamedTuple):
    """The result of one check.

    It says whether its fact is true, has a sentence about it, what was measured, and where to
    look.

    A check returns it, mostly from `judged`, `measured`, `failed` or `passed` below; the grader
    itself makes those that are skipped or errored. Points come from the status alone, and every
    format shows the message.

    >>> outcome = measured("the radius of 'wheel' is", 0.2, 0.1, 0.002)
    >>> outcome.status, outcome.measured, outcome.unit
    ('failed', 0.2, 'm')
    >>> outcome.message
    "the radius of 'wheel' is 0.2 m; it should be 0.1 m (100 mm too large)"
    >>> failed("there is no link 'chassis'", detail="; the file has: 'base'").mistake
    "there is no link 'chassis'"
    """

    status: Status
    message: str
    measured: _Measured = None  # in `unit`, as are the next two
    expected: _Measured = None
    tolerance: float | None = None
    unit: str | None = None
    location: Location | None = None  # the place to look at, of a failure
    # the message without what differs between students: equal mistakes are counted together
    mistake: str = ""
    # the message of the file's problem that it reports, or in a few words what is in doubt
    problem: str = ""
    # what is not built yet, of a failure that is due to that alone: "lidar", "package"
    absent: Sequence[str] = ()
    # one of the causes of failures that the check declares, by which a rubric's feedback is chosen
    cause: str = ""


def find_fault(returned: object) -> str:
    """Return what is wrong with the value that a check returned; empty for a valid Outcome."""
    if not isinstance(returned, Outcome):
        return f"it returned {type(returned).__name__}, not an Outcome"
    if returned.status not in ("passed", "failed", "pending"):
        return (
            f"it returned the status {returned.status!r}; a check returns passed, failed or pending"
        )
    for name, is_valid in _VALID.items():
        if not is_valid(getattr(returned, name)):
            return f"it returned an Outcome with an invalid {name}"
    return ""


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and isfinite(value)


def _is_value(value: object) -> bool:
    if isinstance(value, tuple):
        return all(map(_is_number, value)) or all(map(_is_text, value))
    if isinstance(value, Mapping):
        return all(map(_is_text, (*value, *value.values())))
    return value is None or _is_text(value) or _is_number(value)


_VALID = {
    "message": _is_text,
    "measured": _is_value,
    "expected": _is_value,
    "tolerance": lambda value: value is None or _is_number(value),
    "unit": lambda value: value is None or _is_text(value),
    "location": lambda value: value is None or isinstance(value, Location),
    "mistake": _is_text,
    "problem": _is_text,
    "absent": lambda value: isinstance(value, tuple) and all(map(_is_text, value)),
    "cause": _is_text,
}


def passed(message: str) -> Outcome:
    """Return the outcome for a fact that is true of the submission."""
    return Outcome("passed", message)


def pending(message: str, cause: str = "", at: _AnyPlace = None, *, problem: str = "") -> Outcome:
    """Return the outcome for manual grading.

    `cause` is the reason without what differs between students.
    """
    return Outcome(
        "pending", message, location=compute_location(at), mistake=cause, problem=problem
    )


def failed(
    message: str,
    at: _AnyPlace = None,
    *,
    detail: str = "",
    problem: str = "",
    mistake: str = "",
    cause: str = "",
) -> Outcome:
    """Return the outcome for a fact that is not true.

    `detail` ends the message with what differs between students; `mistake` replaces a message in
    which something else does.
    """
    outcome = judged(False, message, at=at, detail=detail)
    return outcome._replace(problem=problem, mistake=mistake or outcome.mistake, cause=cause)


def judged(
    fine: bool,
    message: str,
    actual: _Measured = None,
    expected: _Measured = None,
    tolerance: float | None = None,
    unit: str | None = None,
    *,
    at: _AnyPlace = None,
    detail: str = "",
) -> Outcome:
    """Return a measurement that passes or fails; only a failure has a place to look at."""
    location = None if fine else compute_location(at)
    mistake = message if detail and not fine else ""
    status: Status = "passed" if fine else "failed"
    return Outcome(status, message + detail, actual, expected, tolerance, unit, location, mistake)


def compute_location(at: _AnyPlace) -> Location | None:
    """Return the place in the file, computed on demand: most places are never used."""
    if isinstance(at, LazyLocation):
        return at.resolve()
    return at


def measured(
    what: str,
    actual: float,
    expected: float,
    tolerance: float,
    *,
    sides: tuple[str, str] = _SIDES,
    at: _AnyPlace = None,
) -> Outcome:
    """Compare one length in metres.

    "the radius of 'wheel' is 0.2 m; it should be 0.1 m (100 mm too large)".
    """
    fine = within(actual, expected, tolerance)
    message = f"{what} {point((actual,))} m"
    if not fine:
        off = other_unit((actual,), (expected,)) or difference(actual - expected, *sides)
        message += f"; it should be {point((expected,))} m ({off})"
    return judged(fine, message, actual, expected, tolerance, "m", at=at)


def measured_point(
    what: str,
    actual: Vector,
    expected: Vector,
    tolerance: float,
    frame: str,
    *,
    at: _AnyPlace = None,
) -> Outcome:
    """Compare a point in a frame, in metres; each coordinate must be within the tolerance."""
    wrong = [axis for axis in range(3) if not within(actual[axis], expected[axis], tolerance)]
    off = [_off_along(axis, actual[axis] - expected[axis], frame) for axis in wrong]
    message = f"{what} is at {point(actual)} m in {frame!r}"
    if off:
        message += (
            f"; it should be at {point(expected)} m "
            f"({other_unit(actual, expected) or ', '.join(off)})"
        )
    return judged(not off, message, actual, expected, tolerance, "m", at=at)


def measured_turn(
    position: Outcome, turned: float, angle: float, wanted: str, at: _AnyPlace = None
) -> Outcome:
    """Return the outcome of a position, or the failure of an orientation that is off.

    Args:
        position: The outcome of the position.
        turned: By how many degrees the orientation is off.
        angle: By how many degrees it may be off.
        wanted: The orientation, in words.
        at: Where it is written.
    """
    if turned <= angle + SLACK:
        return position
    message = f"{position.message}; its orientation is {in_degrees(turned)} off {wanted}"
    return position._replace(status="failed", message=message, location=compute_location(at))


def _off_along(axis: int, off: float, frame: str) -> str:
    """Return how far a coordinate is off.

    In the frame of a base, words say where that is, else its sign does.
    """
    if not frame.startswith(_BASE):
        return f"{'xyz'[axis]} {difference(off)}"
    return difference(off, *_DIRECTIONS[axis])


def how_far_off(outcome: Outcome) -> float | None:
    """Return by how many metres a length or a point is off that fails.

    It is None if it fails for another reason.
    """
    if outcome.status != "failed" or outcome.unit != "m":
        return None
    actual, expected = (
        one if isinstance(one, tuple) else (one,) for one in (outcome.measured, outcome.expected)
    )
    pairs = list(zip(actual, expected, strict=False))
    numbers = [
        abs(a - b) for a, b in pairs if isinstance(a, float | int) and isinstance(b, float | int)
    ]
    is_off = isfinite(sum(numbers)) and max(numbers, default=0) > (outcome.tolerance or 0)
    return max(numbers) if is_off else None


def other_unit(actual: Sequence[float], expected: Sequence[float]) -> str:
    """Return that lengths seem to be in millimetres or centimetres.

    It is empty unless all are too large by that factor.
    """
    pairs = [
        (a, b) for a, b in zip(actual, expected, strict=True) if abs(a) > SLACK or abs(b) > SLACK
    ]
    for factor, unit in _UNITS:
        if pairs and all(abs(a - b * factor) < abs(b) for a, b in pairs):
            return f"a URDF is in metres, not in {unit}"
    return ""


def difference(off: float, over: str = _SIDES[0], under: str = _SIDES[1]) -> str:
    """Return how far a length in metres is off, and to which side."""
    return f"{in_millimetres(off)} {over if off > 0 else under}"
