"""The failures of a class, grouped by criterion and cause: measured values within the tolerance are one failure."""

from collections import Counter
from collections.abc import Iterable, Mapping
from math import acos, degrees, isfinite, radians
from typing import Any, NamedTuple

from grader.checks.outcome import Outcome
from grader.grading.criterion import Criterion

_MAX_MISTAKE = 200  # characters
_DIGITS = 6  # of a measured value
_NEIGHBOURS = (0, -1, 1)


class Failure(NamedTuple):
    """One failed criterion as the gradebook stores it: its position, and the mistake in words.

    `measured` are the measured numbers and then the expected ones, empty if something else than numbers was compared.
    """

    position: int
    mistake: str
    measured: tuple[float, ...] = ()
    tolerance: float = 0.0
    unit: str = ""

    @classmethod
    def from_json(cls, values: list[Any]) -> "Failure":
        """Return a failure as it was stored."""
        position, mistake, measured, *more = values
        return cls(position, mistake, tuple(measured), *more)


def failure_of(criterion: Criterion, outcome: Outcome) -> Failure:
    """Return the failure of a criterion, with the words that equal mistakes have in common."""
    words = outcome.mistake or outcome.message
    mistake = words if len(words) <= _MAX_MISTAKE else words[: _MAX_MISTAKE - 3] + "..."
    measured, expected = _numbers(outcome.measured), _numbers(outcome.expected)
    if outcome.tolerance is None or not measured:
        return Failure(criterion.position, mistake)
    return Failure(criterion.position, mistake, (*measured, *expected), outcome.tolerance, outcome.unit or "")


def _numbers(value: object) -> tuple[float, ...]:
    """Return a measured number or numbers, rounded; empty for anything else."""
    values = value if isinstance(value, tuple) else (value,)
    numbers = tuple(round(item, _DIGITS) for item in values if isinstance(item, float | int) and isfinite(item))
    return numbers if len(numbers) == len(values) else ()


def grouped(failures: Mapping[Failure, int]) -> list[tuple[Failure, int]]:
    """Return each cause once, by its most frequent failure, with the number of failures; the most frequent first."""
    counts: Counter[Failure] = Counter()
    for failure, group in groups_of(failures).items():
        counts[group] += failures[failure]
    return sorted(counts.items(), key=lambda item: (-item[1], item[0]))


def groups_of(failures: Mapping[Failure, int]) -> dict[Failure, Failure]:
    """Return the cause of each failure, given as the most frequent failure that has it.

    A measured failure belongs to the first group whose values are within the tolerance, any other to the group with the same message.
    """
    found: dict[Failure, Failure] = {}
    cells: dict[tuple[object, ...], list[Failure]] = {}
    for failure, _ in sorted(failures.items(), key=lambda item: (-item[1], item[0])):
        first, *others = _cells(failure)
        near = (group for cell in (first, *others) for group in cells.get(cell, ()))
        group = next((group for group in near if _is_same(failure, group)), None)
        if group is None:
            cells.setdefault(first, []).append(failure)
        found[failure] = group or failure
    return found


def _cells(failure: Failure) -> Iterable[tuple[object, ...]]:
    """Return where groups that a failure may belong to are kept, its own place first."""
    position, mistake, measured, tolerance, unit = failure
    if not measured:
        return [(position, mistake)]
    size = (radians(tolerance) if _is_direction(failure) else tolerance) or 10.0**-_DIGITS
    cell = sum(measured) // (size * len(measured))  # the sums of two groups that are the same differ by less
    return [(position, unit, len(measured), cell + step) for step in _NEIGHBOURS]


def _is_same(one: Failure, other: Failure) -> bool:
    if not one.measured:
        return one.mistake == other.mistake
    if _is_direction(one):
        cosine = sum(a * b for a, b in zip(one.measured[:3], other.measured[:3], strict=True))
        return degrees(acos(max(-1.0, min(1.0, cosine)))) <= one.tolerance
    return all(abs(a - b) <= one.tolerance for a, b in zip(one.measured, other.measured, strict=True))


def _is_direction(failure: Failure) -> bool:
    """Return whether a unit vector was compared with another, with a tolerance in degrees."""
    return failure.unit == "deg" and len(failure.measured) == len("xyzxyz")
