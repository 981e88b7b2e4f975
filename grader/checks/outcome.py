"""The outcome of a check, and its wording: measured against expected, the difference, its unit and frame."""

from collections.abc import Callable, Mapping
from functools import lru_cache
from math import isfinite
from typing import Literal, NamedTuple

from grader.robot.transforms import Vector
from grader.source import LazyLocation, Location

Status = Literal["passed", "failed", "skipped", "pending", "errored"]
Value = bool | float | str | tuple[float, ...] | tuple[str, ...] | Mapping[str, str] | None
AnyPlace = Location | LazyLocation | None

# A tolerance includes its end: 0.152 is within 0.002 of 0.15, although the floats differ by slightly more.
SLACK = 1e-9
_AXES = "xyz"
_FEW, _MANY = 100.0, 1e7  # from here on: no decimals, an exponent


class Outcome(NamedTuple):
    """The result of one check: a message, its location, and the measured values, in `unit`.

    `mistake` is the message without what differs between students who made the same mistake, such as the names of their
    joints: statistics count equal mistakes. It is empty where the message holds nothing of that kind.
    """

    status: Status
    message: str
    measured: Value = None
    expected: Value = None
    tolerance: float | None = None
    unit: str | None = None
    location: Location | None = None
    mistake: str = ""


def fault_of(returned: object) -> str:
    """Return what is wrong with the value that a check returned; empty for an Outcome that a report can hold."""
    if not isinstance(returned, Outcome):
        return f"it returned {type(returned).__name__}, not an Outcome"
    if returned.status not in ("passed", "failed", "pending"):
        return f"it returned the status {returned.status!r}; a check returns passed, failed or pending"
    for name, is_valid in _VALID.items():
        if not is_valid(getattr(returned, name)):
            return f"it returned an Outcome whose {name} no report can hold"
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


_VALID: Mapping[str, Callable[[object], bool]] = {
    "message": _is_text,
    "measured": _is_value,
    "expected": _is_value,
    "tolerance": lambda value: value is None or _is_number(value),
    "unit": lambda value: value is None or _is_text(value),
    "location": lambda value: value is None or isinstance(value, Location),
    "mistake": _is_text,
}


def passed(message: str) -> Outcome:
    """Return the outcome for a fact that is true of the submission."""
    return Outcome("passed", message)


def pending(message: str, at: Location | None = None) -> Outcome:
    """Return the outcome for a fact that needs manual grading."""
    return Outcome("pending", message, location=at)


def failed(message: str, at: AnyPlace = None, *, detail: str = "") -> Outcome:
    """Return the outcome for a fact that is not true; `detail` ends the message with what differs between students."""
    return judged(False, message, at=at, detail=detail)


def judged(
    fine: bool,
    message: str,
    actual: Value = None,
    expected: Value = None,
    tolerance: float | None = None,
    unit: str | None = None,
    *,
    at: AnyPlace = None,
    detail: str = "",
) -> Outcome:
    """Return a measurement that passes or fails; only a failure has a place to look at."""
    location = None if fine else location_of(at)
    mistake = message if detail and not fine else ""
    status: Status = "passed" if fine else "failed"
    return Outcome(status, message + detail, actual, expected, tolerance, unit, location, mistake)


def location_of(at: AnyPlace) -> Location | None:
    """Return the location in the file, computed only now because most locations are never used."""
    return at.resolve() if isinstance(at, LazyLocation) else at


def within(actual: float, expected: float, tolerance: float) -> bool:
    """Return whether a value is within a tolerance of another; never true of NaN."""
    return abs(actual - expected) <= tolerance + SLACK


def measured(
    what: str,
    actual: float,
    expected: float,
    tolerance: float,
    unit: str,
    *,
    sides: tuple[str, str] = ("too large", "too small"),
    at: LazyLocation | None = None,
) -> Outcome:
    """Compare one number: "the radius of 'wheel' is 0.2 m; it should be 0.1 m (100 mm too large)"."""
    fine = within(actual, expected, tolerance)
    message = f"{what} {quantity(actual, unit)}"
    if not fine:
        message += f"; it should be {quantity(expected, unit)} ({difference(actual - expected, unit, *sides)})"
    return judged(fine, message, actual, expected, tolerance, unit, at=at)


def measured_point(
    what: str, actual: Vector, expected: Vector, tolerance: float, frame: str, *, at: LazyLocation | None = None
) -> Outcome:
    """Compare a point in a frame, in metres; each coordinate must be within the tolerance."""
    off = [
        f"{axis} {difference(a - b, 'm')}"
        for axis, a, b in zip(_AXES, actual, expected, strict=True)
        if not within(a, b, tolerance)
    ]
    message = f"{what} is at {point(actual)} m in {frame!r}"
    if off:
        message += f"; it should be at {point(expected)} m ({', '.join(off)})"
    return judged(not off, message, actual, expected, tolerance, "m", at=at)


def difference(off: float, unit: str, over: str = "too large", under: str = "too small") -> str:
    """Return how far a value is off, and to which side."""
    return f"{size(off, unit)} {over if off > 0 else under}"


def size(value: float, unit: str) -> str:
    """Return the size of a difference in the unit that reads best: millimetres for lengths."""
    if unit != "m":
        return quantity(abs(value), unit)
    millimetres = abs(value) * 1000
    return f"{millimetres:.0f} mm" if _FEW <= millimetres < _MANY else f"{millimetres:.3g} mm"


def quantity(value: float, unit: str) -> str:
    """Return a value with its unit, rounded for reading."""
    if unit != "deg":
        return f"{_short(value)} {unit}".rstrip()
    return f"{value:.3g} degree{'' if f'{value:.3g}' == '1' else 's'}"


@lru_cache(maxsize=4096)
def point(values: tuple[float, ...]) -> str:
    """Return coordinates as a URDF writes them, rounded for reading."""
    return " ".join(map(_short, values))


def place(element: LazyLocation | None, attribute: str | None = None, inside: str | None = None) -> LazyLocation | None:
    """Return the place of an element that was read from the file, of one of its attributes, or of an element inside."""
    return element._replace(attribute=attribute, inside=inside) if element is not None else None


@lru_cache(maxsize=4096)
def _short(value: float) -> str:
    if abs(value) >= _MANY:
        return f"{value:.3g}"
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
