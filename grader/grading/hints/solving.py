"""Solve for numbers: which number of a robot, with which value, brings what a criterion measures to what it expects.

By Newton's method on the numbers of one slot: the residual is what is measured less what is expected, and a column of
the Jacobian says how it changes with one number.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from itertools import islice
from math import hypot, isfinite, pi

from grader.checks.outcome import Outcome
from grader.grading.hints.slots import Slot
from grader.grading.hints.state_edits import QuickGrading
from grader.robot.edits.difference import RobotDifference
from grader.robot.edits.numbers import Values, plausible, round_numbers
from grader.robot.edits.pieces import FITTED, SOLVED, Piece

_EXACT = 0.05  # of the tolerance: an edit brings a value to the expected one, not just into the tolerance
_STEP = 1e-4
_FLAT, _WILD = 1e-6, 1e3  # slopes that are none, and that are a leap
_DIGITS = range(2, 7)
_SHORT = 3  # decimals of a number that a person would write
_MAX_SLOTS = 60

Residuals = Callable[[Values], Values | None]  # what is measured less what is expected, with other numbers


class Solver:
    """Searches the values with which one criterion measures what it expects."""

    def __init__(self, quick: QuickGrading, difference: RobotDifference, name: str, outcome: Outcome) -> None:
        self._quick, self._difference, self._name = quick, difference, name
        self._outcome = outcome
        measured, expected = _vector(outcome.measured), _vector(outcome.expected)
        is_each = measured is not None and expected is not None and len(expected) == 1
        self._expected = expected * len(measured) if is_each and measured and expected else expected
        self._is_direction = outcome.unit == "deg" and len(self._expected or ()) == 3
        scale = pi / 180 if self._is_direction else 1.0
        self._start = self._difference_of(outcome)
        self._exact = _EXACT * scale * (outcome.tolerance or 1e-4) + 1e-9

    def pieces(self, found: Iterator[Slot]) -> Iterator[Piece]:
        """Yield the pieces that set one slot; none for a criterion that measures no number."""
        if self._start is None:
            return
        for slot in islice(found, _MAX_SLOTS):
            is_size = slot.unit == "m" and slot.tag != "origin"
            solved = dict.fromkeys(self._values(slot, self._start))
            for values in (it for it in solved if slot.sets(it) and not (is_size and min(it) <= 0.0)):
                changed = [new for old, new in zip(slot.values, values, strict=True) if old != new]
                is_short = slot.unit == "rad" or all(round_numbers((new,), _SHORT)[0] == new for new in changed)
                yield self._difference.of_sets(slot.sets(values), SOLVED if is_short and len(changed) == 1 else FITTED)

    def _values(self, slot: Slot, start: Values) -> Iterator[Values]:
        @cache
        def residual_of(values: Values) -> Values | None:
            if values == slot.values:
                return start
            return self._residual(slot, values) if all(map(isfinite, values)) else None

        nudged = tuple(value + _STEP * 1.37**index for index, value in enumerate(slot.values, 1))
        moved = residual_of(nudged)
        if moved and all(abs(b - a) < _FLAT * _STEP for a, b in zip(start, moved, strict=True)):  # no number matters
            return
        columns = [self._jacobian_column(residual_of, slot.values, index) for index in range(len(slot.values))]
        touched = [index for index, column in enumerate(columns) if column is None or any(column)]
        if _is_nonlinear(slot):
            for values in plausible(slot.unit, slot.values):
                if self._is_exact(residual_of(values)):
                    yield values
        known = {index: column for index in touched if (column := columns[index]) is not None}
        subsets = [(index,) for index in known] + ([tuple(known)] if len(known) > 1 else [])
        for subset in subsets:
            solved = self._solve(residual_of, slot.values, start, {index: known[index] for index in subset})
            if solved is not None:
                yield solved

    def _solve(
        self, residual_of: Residuals, old: Values, start: Values, columns: Mapping[int, Values]
    ) -> Values | None:
        """Return values that leave no residual: by Newton's method, then with as few digits as possible."""
        values, residual = old, start
        while not self._is_exact(residual) or hypot(*residual) >= 1e-9:
            step = least_squares([columns[index] for index in columns], residual)
            if step is None:
                return None
            values = tuple(
                value - dict(zip(columns, step, strict=True)).get(index, 0.0) for index, value in enumerate(values)
            )
            after = residual_of(values)
            if after is None or hypot(*after) > 0.9 * hypot(*residual):
                return self._short(residual_of, old, values) if self._is_exact(after) else None
            residual = after
            found = {index: self._jacobian_column(residual_of, values, index) for index in columns}
            columns = {index: column for index, column in found.items() if column is not None}
        return self._short(residual_of, old, values)

    def _short(self, residual_of: Residuals, old: Values, values: Values) -> Values | None:
        shorts = [
            tuple(
                before if abs(before - value) < _STEP / 10 else value
                for before, value in zip(old, round_numbers(values, digits), strict=True)
            )
            for digits in _DIGITS
        ]
        shorts += [values] if max(map(abs, values)) < 0.01 else []
        return next((short for short in shorts if self._is_exact(residual_of(short))), None)

    def _jacobian_column(self, residual_of: Residuals, values: Values, index: int) -> Values | None:
        """Return how what is measured changes with one of the values; None where it cannot be told."""
        size = _STEP * max(abs(values[index]), 1e-2 if abs(values[index]) < 1e-2 and values[index] else 1.0)
        slopes = (_slope(residual_of, values, index, step) for step in (size, -size))  # a channel of a colour ends at 1
        return next((slope for slope in slopes if slope and max(map(abs, slope)) < _WILD), None)

    def _residual(self, slot: Slot, values: Values) -> Values | None:
        sets = self._difference.with_twins(slot.sets(values, lambda values: " ".join(map(repr, values))))
        return self._difference_of(self._quick.results(sets, (self._name,))[self._name].outcome)

    def _difference_of(self, outcome: Outcome) -> Values | None:
        actual, expected = _vector(outcome.measured), self._expected
        if actual is None or expected is None or len(actual) != len(expected) or outcome.unit != self._outcome.unit:
            return None
        return tuple(a - b for a, b in zip(actual, expected, strict=True))

    def _is_exact(self, residual: Values | None) -> bool:
        return residual is not None and all(abs(value) <= self._exact for value in residual)


def _slope(residual_of: Residuals, values: Values, index: int, step: float) -> Values:
    """Return how what is measured changes with one of the values, from this one on; empty where it cannot be told."""
    before = residual_of(values)
    after = residual_of(tuple(value + step if other == index else value for other, value in enumerate(values)))
    slope = ((b - a) / step for a, b in zip(before, after, strict=True)) if before and after else ()
    return tuple(value if abs(value) > _FLAT else 0.0 for value in slope)


def _is_nonlinear(slot: Slot) -> bool:
    """Return whether numbers do not change what is measured in proportion: angles, and the directions of axes."""
    return slot.unit in ("rad", "1")


def _vector(value: object) -> Values | None:
    """Return numbers that a check measured or expects."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return (float(value),)
    if isinstance(value, tuple) and value and all(isinstance(one, int | float) for one in value):
        return tuple(map(float, value))
    return None


def least_squares(columns: Sequence[Values], residual: Values) -> Values | None:
    """Return the factors with which the sum of columns is nearest to the residual; None if they are undetermined."""
    count = len(columns)
    rows = [
        [sum(a * b for a, b in zip(one, other, strict=True)) for other in columns]
        + [sum(a * b for a, b in zip(one, residual, strict=True))]
        for one in columns
    ]
    for index in range(count):
        pivot = max(range(index, count), key=lambda row: abs(rows[row][index]))
        if abs(rows[pivot][index]) < 1e-12:
            return None
        rows[index], rows[pivot] = rows[pivot], rows[index]
        for row in range(count):
            if row != index:
                factor = rows[row][index] / rows[index][index]
                rows[row] = [a - factor * b for a, b in zip(rows[row], rows[index], strict=True)]
    return tuple(rows[index][count] / rows[index][index] for index in range(count))
