"""The margin of each tolerance: how far off the reference is."""

from math import atan2, degrees, hypot
from typing import NamedTuple

from grader.checks.outcome import SLACK, Outcome, Value
from grader.grading.report import Result
from grader.robot.transforms import cross, dot, unit

_NEAR = 0.5  # of the tolerance: a reference that is farther off is near the limit
_CHANGE = 0.01  # of the tolerance: less is no change
_NOTHING = 1e-9


class Margin(NamedTuple):
    """The tolerance of a criterion, and the deviation of the reference in its unit."""

    criterion: str
    unit: str
    tolerance: float
    reference: float

    @property
    def is_near(self) -> bool:
        """Return whether the reference uses more than half of the tolerance."""
        return self.reference > max(_NEAR * self.tolerance, _NOTHING)

    def is_changed(self, result: Result) -> bool:
        """Return whether a mutant has another measured value than the reference."""
        off = deviation(result.outcome)
        return off is not None and abs(off - self.reference) > _CHANGE * self.tolerance


def margin_of(result: Result) -> Margin | None:
    """Return the margin of a criterion of the reference; None where its outcome is no deviation within a tolerance."""
    outcome = result.outcome
    off = deviation(outcome)
    if off is None or outcome.tolerance is None or outcome.status != "passed" or off > outcome.tolerance + SLACK:
        return None
    return Margin(result.criterion.id, outcome.unit or "", outcome.tolerance, off)


def deviation(outcome: Outcome) -> float | None:
    """Return how far the measured value is from the expected one: the largest difference of several numbers, or the angle in degrees."""
    measured, expected = _numbers(outcome.measured), _numbers(outcome.expected)
    if not measured or not expected or len(expected) not in (1, len(measured)):
        return None
    if outcome.unit == "deg" and len(measured) == len(expected) == 3:  # directions
        one, other = unit((measured[0], measured[1], measured[2])), unit((expected[0], expected[1], expected[2]))
        return degrees(atan2(hypot(*cross(one, other)), dot(one, other))) if one and other else None
    pairs = zip(measured, expected if len(expected) > 1 else expected * len(measured), strict=True)
    return max(abs(one - other) for one, other in pairs)


def _numbers(value: Value) -> tuple[float, ...]:
    values = value if isinstance(value, tuple) else (value,)
    numbers = tuple(one for one in values if isinstance(one, int | float) and not isinstance(one, bool))
    return numbers if len(numbers) == len(values) else ()
