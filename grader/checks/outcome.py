"""What a check found, and the ways to say it: measured against expected, how far off, in which unit and frame."""

from collections.abc import Callable, Mapping
from functools import lru_cache
from math import isfinite
from typing import Literal, NamedTuple

from grader.robot.transforms import Vector
from grader.source import LazyLocation, Location

Status = Literal["passed", "failed", "skipped", "pending", "errored"]
Value = bool | float | str | tuple[float, ...] | tuple[str, ...] | Mapping[str, str] | None

# A tolerance includes its end: 0.152 is within 0.002 of 0.15, though the floats differ by a hair more.
SLACK = 1e-9
_AXES = "xyz"
_FEW, _MANY = 100.0, 1e7  # from here on: no decimals, an exponent


class Outcome(NamedTuple):
    """What one check found: a sentence, and where it measured something, the values in `unit`."""

    status: Status
    message: str
    measured: Value = None
    expected: Value = None
    tolerance: float | None = None
    unit: str | None = None
    location: Location | None = None


def fault_of(returned: object) -> str:
    """What is wrong with what a check has returned, in words; empty for an Outcome that a report can hold."""
    if not isinstance(returned, Outcome):
        return f"it returned {type(returned).__name__}, not an Outcome"
    if returned.status not in ("passed", "failed", "pending"):
        return f"it returned the status {returned.status!r}; a check says passed, failed or pending"
    wrong = [name for name, holds in _HOLDS.items() if not holds(getattr(returned, name))]
    return f"it returned an Outcome whose {wrong[0]} no report can hold" if wrong else ""


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and isfinite(value)


def _is_value(value: object) -> bool:
    match value:
        case None | str():
            return True
        case tuple():
            return all(map(_is_number, value)) or all(map(_is_text, value))
        case Mapping():
            return all(map(_is_text, (*value, *value.values())))
        case _:
            return _is_number(value)


_HOLDS: Mapping[str, Callable[[object], bool]] = {
    "message": _is_text,
    "measured": _is_value,
    "expected": _is_value,
    "tolerance": lambda value: value is None or _is_number(value),
    "unit": lambda value: value is None or _is_text(value),
    "location": lambda value: value is None or isinstance(value, Location),
}


def passed(message: str) -> Outcome:
    """The fact is true of the submission."""
    return Outcome("passed", message)


def failed(message: str, at: LazyLocation | None = None) -> Outcome:
    """The fact is not true of the submission; `at` is where to look."""
    return Outcome("failed", message, location=at.resolve() if at else None)


def judged_as(status: Status, message: str, at: Location | None = None) -> Outcome:
    """A finding about a file other than the URDF, with the place to look at."""
    return Outcome(status, message, location=at)


def judged(
    fine: bool,
    message: str,
    *,
    actual: Value,
    expected: Value,
    tolerance: float | None = None,
    unit: str | None = None,
    at: LazyLocation | None = None,
) -> Outcome:
    """A measurement that passes or fails; only a failure has a place to look at."""
    location = at.resolve() if at and not fine else None
    return Outcome("passed" if fine else "failed", message, actual, expected, tolerance, unit, location)


def within(actual: float, expected: float, tolerance: float) -> bool:
    """Whether a value is within a tolerance of another; never true of NaN."""
    return abs(actual - expected) <= tolerance + SLACK


def measured(
    what: str,
    *,
    actual: float,
    expected: float,
    tolerance: float,
    unit: str,
    sides: tuple[str, str] = ("too large", "too small"),
    at: LazyLocation | None = None,
) -> Outcome:
    """One number against the one that is expected, as in "the bottom is at -0.1 m, expected 0 m: 100 mm too low"."""
    fine = within(actual, expected, tolerance)
    message = f"{what} is {quantity(actual, unit)}"
    if not fine:
        message += f", expected {quantity(expected, unit)}: {difference(actual - expected, unit, *sides)}"
    return judged(fine, message, actual=actual, expected=expected, tolerance=tolerance, unit=unit, at=at)


def measured_point(
    what: str, *, actual: Vector, expected: Vector, tolerance: float, frame: str, at: LazyLocation | None = None
) -> Outcome:
    """A point in metres against the one that is expected; each coordinate must be within the tolerance."""
    off = [
        f"{axis} is {difference(a - b, 'm')}"
        for axis, a, b in zip(_AXES, actual, expected, strict=True)
        if not within(a, b, tolerance)
    ]
    message = f"{what} is at {point(actual)} m in {frame!r}"
    if off:
        message += f", expected {point(expected)} m: {', '.join(off)}"
    return judged(not off, message, actual=actual, expected=expected, tolerance=tolerance, unit="m", at=at)


def difference(off: float, unit: str, over: str = "too large", under: str = "too small") -> str:
    """How far a value is off, and to which side."""
    return f"{size(off, unit)} {over if off > 0 else under}"


def size(value: float, unit: str) -> str:
    """The size of a difference in the unit that reads best: millimetres for lengths."""
    if unit != "m":
        return quantity(abs(value), unit)
    millimetres = abs(value) * 1000
    return f"{millimetres:.0f} mm" if _FEW <= millimetres < _MANY else f"{millimetres:.3g} mm"


def quantity(value: float, unit: str) -> str:
    """A value with its unit, rounded for reading."""
    if unit != "deg":
        return f"{_short(value)} {unit}".rstrip()
    return f"{value:.3g} degree{'' if f'{value:.3g}' == '1' else 's'}"


@lru_cache(maxsize=4096)
def point(values: tuple[float, ...]) -> str:
    """Coordinates for reading, as a URDF writes them."""
    return " ".join(map(_short, values))


def place(element: LazyLocation | None, attribute: str | None = None, inside: str | None = None) -> LazyLocation | None:
    """Return where one of an element's attributes is in the file, or an element inside; None for an element made in code."""
    return element._replace(attribute=attribute, inside=inside) if element is not None else None


def listing(names: tuple[str, ...] | list[str]) -> str:
    """Names for a sentence: 'a', 'b' and 'c'."""
    quoted = [repr(each) for each in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}" if quoted else "none"


@lru_cache(maxsize=4096)
def _short(value: float) -> str:
    if abs(value) >= _MANY:
        return f"{value:.3g}"
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
