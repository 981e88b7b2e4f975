"""The comparison of several numbers of an element of a joint with the expected ones."""

from collections.abc import Mapping, Sequence
from math import isfinite, isnan
from typing import NamedTuple

from grader.checks.outcome import Outcome, judged, place, within
from grader.robot.model import Joint
from grader.source import LazyLocation

EXACT = 1e-6  # for numbers that a URDF states as they are expected


class Number(NamedTuple):
    """A number that is compared: its attribute, and what is said where it is wrong."""

    attribute: str
    actual: float
    expected: float
    tolerance: float
    fault: str

    @property
    def is_wrong(self) -> bool:
        """Whether it is outside of its tolerance, or NaN."""
        return not within(self.actual, self.expected, self.tolerance)


def expected_numbers(values: Mapping[str, tuple[float, float | None]], tolerance: float) -> list[Number]:
    """Return the numbers that are compared, by attribute: those with an expected value."""
    return [
        Number(
            name,
            actual,
            expected,
            tolerance,
            f"its {name} is {number_text(actual)}; it should be {number_text(expected)}",
        )
        for name, (actual, expected) in values.items()
        if expected is not None
    ]


def compared(
    message: str, numbers: Sequence[Number], joint: Joint, element: LazyLocation | None, of: str | None = None
) -> Outcome:
    """Compare numbers of an element, which are in the unit `of` if they have one tolerance; NaN fails."""
    faults = {number.fault: number.attribute for number in reversed(numbers) if number.is_wrong}
    message = "; ".join((message, *reversed(faults)))
    values = [(number.actual, number.expected) for number in numbers]
    actual, expected = zip(*values, strict=True) if values and isfinite(sum(map(sum, values))) else (None, None)
    tolerances = {number.tolerance for number in numbers}
    tolerance = tolerances.pop() if len(tolerances) == 1 else None
    at = place(element, next(reversed(faults.values()), None))
    detail = named(joint) if faults else ""
    return judged(
        not faults, message, actual, expected, tolerance, of if tolerance is not None else None, at=at, detail=detail
    )


def named(joint: Joint) -> str:
    """Return the end of a message that names a joint."""
    return f" (joint {joint.name!r})"


def number_text(value: float, digits: int = 9) -> str:
    """Return a number of a URDF for a message."""
    return "missing or unreadable" if isnan(value) else f"{value + 0.0:.{digits}g}"
