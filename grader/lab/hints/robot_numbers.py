"""Numbers that a person may have meant, and what is wrong with the written ones.

The mistake is in a sign, a unit, or the order.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations
from math import isclose, radians

from grader.base.records import Named
from grader.base.text import enumerated
from grader.ros.urdf.numbers import NumberError, numbers

Values = tuple[float, ...]

LARGE = 3.0  # metres: no part of a robot for a desk is as large
_SAME = 1e-6


class _NumberMistake(Named):
    """What a person does to numbers.

    It has the units, the size from which it is likely, how to undo it, and the cause.
    """

    units: Sequence[str]
    least: float
    correct: Callable[[float], float]
    cause: str

    def may_have_unit(self, unit: str) -> bool:
        """Return whether it is made with numbers of this unit."""
        return not self.units or unit in self.units


_LENGTHS = ("m",)
_ANGLES = ("rad", "rad or m")
_ANY = ()
_MISTAKES = (
    _NumberMistake(_ANY, 0.0, lambda value: -value, "the sign of {}"),
    _NumberMistake(_ANGLES, 6.3, radians, "the unit of {} is degrees; it should be radians"),
    _NumberMistake(
        _LENGTHS,
        LARGE,
        lambda value: value / 1000,
        "the unit of {} is millimetres; it should be metres",
    ),
    _NumberMistake(
        _LENGTHS,
        LARGE,
        lambda value: value / 100,
        "the unit of {} is centimetres; it should be metres",
    ),
    _NumberMistake(
        ("1",), 1.1, lambda value: value / 255, "the range of {} is 0..255; it should be 0..1"
    ),
    _NumberMistake(_LENGTHS, 0.0, lambda value: value / 2, "{}: twice the correct value"),
    _NumberMistake(_LENGTHS, 0.0, lambda value: value * 2, "{}: half of the correct value"),
)


def mistake_in(parts: Sequence[str], unit: str, old: Values, new: Values) -> str:
    """Return what is wrong with numbers; {} stands for what has them."""
    if not len(parts) == len(old) == len(new):
        return "the numbers of {}"
    off = [index for index in range(len(old)) if not _is_same(old[index], new[index])]
    if len(off) < 4:
        names = [parts[index] for index in off]
        in_words = [name if len(name) == 1 else f"the {name}" for name in names]
        wrong = f"{enumerated(in_words)} of {{}}"
    else:
        wrong = "the numbers of {}"
    for mistake in _MISTAKES:
        if off and mistake.may_have_unit(unit):
            fits = (_is_same(mistake.correct(old[index]), new[index], 2e-3) for index in off)
            if all(fits):
                return mistake.cause.replace("{}", wrong)
    if len(off) == 2:
        first, second = off
        if _is_same(old[first], new[second]) and _is_same(old[second], new[first]):
            return f"{wrong} are exchanged"
    return wrong


def plausible(unit: str, old: Values) -> Iterator[Values]:
    """Yield numbers that a person may have meant.

    They have another sign, another unit, twice or half of it, or another order.
    """
    largest = max(map(abs, old), default=0.0)
    for mistake in _MISTAKES:
        if largest < mistake.least or not mistake.may_have_unit(unit):
            continue
        # All numbers of a vector have the same unit.
        if mistake.least and len(old) > 1:
            yield tuple(map(mistake.correct, old))
            continue
        for index, value in enumerate(old):
            if value:
                yield (*old[:index], mistake.correct(value), *old[index + 1 :])
    for one, other in combinations(range(len(old)), 2):
        if old[one] != old[other]:
            exchanged = list(old)
            exchanged[one], exchanged[other] = old[other], old[one]
            yield tuple(exchanged)


def _is_same(one: float, other: float, relative: float = 1e-9) -> bool:
    return isclose(one, other, rel_tol=relative, abs_tol=_SAME)


def read_values(text: str | None) -> Values:
    """Return the numbers of an attribute; none where ROS 2 cannot read it."""
    if text is None:
        return ()
    try:
        return tuple(numbers(text))
    except NumberError:
        return ()
