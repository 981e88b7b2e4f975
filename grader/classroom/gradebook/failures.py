"""The failures of a class, grouped by criterion and cause: measured values within the tolerance are one failure."""

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from math import acos, degrees, radians
from typing import NamedTuple

from grader.classroom.gradebook.result import StoredOutcome

_FINEST = 1e-6  # the digits of a measured value
_NEIGHBOURS = (0, -1, 1)


class Failure(NamedTuple):
    """One failed criterion: its position, and the mistake in words.

    `measured` are the measured numbers and then the expected ones, empty if something else than numbers was compared.
    """

    position: int
    mistake: str
    measured: tuple[float, ...] = ()
    tolerance: float = 0.0
    unit: str = ""

    @classmethod
    def of(cls, outcome: StoredOutcome) -> "Failure":
        """Return the failure that an outcome of the gradebook is."""
        if outcome.measured is None:
            return cls(outcome.position, outcome.cause)
        compared = json.loads(outcome.measured)
        return cls(outcome.position, outcome.cause, tuple(compared["numbers"]), compared["tolerance"], compared["unit"])


def grouped(failures: Mapping[Failure, int]) -> list[tuple[Failure, int]]:
    """Return each cause once, by its most frequent failure, with the number of failures; the most frequent first."""
    counts: Counter[Failure] = Counter()
    for failure, group in groups_of(failures).items():
        counts[group] += failures[failure]
    return sorted(counts.items(), key=lambda item: (-item[1], item[0]))


def groups_of(failures: Mapping[Failure, int]) -> dict[Failure, Failure]:
    """Return the cause of each failure, given as the most frequent failure that has it.

    A measured failure belongs to the first group whose values are within the tolerance, any other to the group with the
    same message.
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
    size = (radians(tolerance) if _is_direction(failure) else tolerance) or _FINEST
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
