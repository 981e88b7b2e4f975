"""Numbers that a person may have meant, and what is wrong with those that are written: a sign, a unit, the order."""

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations
from math import isclose, isfinite, pi, radians
from typing import NamedTuple

from grader.robot.numbers import NumberError, numbers
from grader.text import enumerated

Values = tuple[float, ...]

_SAME = 1e-6
_QUARTER_TURNS = (0.0, pi / 2, -pi / 2, pi)
_LARGE = 1.0  # metres: larger parts are often in another unit


class Mistake(NamedTuple):
    """What a person does to a number: the units in which it happens, the correct number, the cause and what to do."""

    units: tuple[str, ...]
    correct: Callable[[float], float]
    cause: str
    action: str


_LENGTHS, _ANGLES, _ANY = ("m",), ("rad", "rad or m"), ()
_MISTAKES = (
    Mistake(_ANY, lambda value: -value, "the sign of {}", "negate {}"),
    Mistake(_ANGLES, radians, "the unit of {}: degrees, not radians", "convert {} to radians"),
    Mistake(_LENGTHS, lambda value: value / 1000, "the unit of {}: millimetres, not metres", "convert {} to metres"),
    Mistake(_LENGTHS, lambda value: value / 100, "the unit of {}: centimetres, not metres", "convert {} to metres"),
    Mistake(("1",), lambda value: value / 255, "the range of {}: 0..255, not 0..1", "write {} in 0..1"),
    Mistake(_LENGTHS, lambda value: value / 2, "{}: twice the correct value", "halve {}"),
    Mistake(_LENGTHS, lambda value: value * 2, "{}: half of the correct value", "double {}"),
    Mistake(_ANY, lambda value: value / 10, "the decimal point of {}", "divide {} by 10"),
    Mistake(_ANY, lambda value: value * 10, "the decimal point of {}", "multiply {} by 10"),
)


class Named(NamedTuple):
    """What is wrong with numbers, what to do, and whether it is a mistake that people make."""

    cause: str
    action: str
    is_mistake: bool = False


def words_of_change(what: str, parts: Sequence[str], unit: str, old: Values, new: Values) -> Named:
    """Return the mistake in numbers, and what to do; `what` has {} where the names of the wrong parts go."""
    if len(old) != len(new):
        return Named(what.format("the numbers"), f"set {what.format('the numbers')} to {format_numbers(new)}")
    off = [index for index, pair in enumerate(zip(old, new, strict=True)) if not _is_same(*pair)]
    wrong = (
        what.format(enumerated([_with_article(parts[index]) for index in off]))
        if len(off) < 4
        else what.format("the numbers")
    )
    for mistake in _MISTAKES:
        fits = (_is_same(mistake.correct(old[index]), new[index], 2e-3) for index in off)
        if (not mistake.units or unit in mistake.units) and off and all(fits):
            return Named(mistake.cause.format(wrong), mistake.action.format(wrong), is_mistake=True)
    if len(off) == 2 and all(_is_same(old[one], new[other]) for one, other in (off, off[::-1])):
        return Named(f"{wrong} are swapped", f"swap {wrong}", is_mistake=True)
    return Named(wrong, f"set {wrong} to {enumerated(list(dict.fromkeys(format_number(new[index]) for index in off)))}")


def _with_article(part: str) -> str:
    return part if len(part) == 1 else f"the {part}"


def plausible(unit: str, old: Values) -> Iterator[Values]:
    """Yield numbers that a person may have meant: another sign, another unit, another order, a quarter turn."""
    count = range(len(old))
    for mistake in _MISTAKES:
        if mistake.units and unit not in mistake.units:
            continue
        for indices in ((index,) for index in count if old[index]):
            yield _with(old, {index: mistake.correct(old[index]) for index in indices})
        if sum(map(bool, old)) > 1:
            yield tuple(mistake.correct(value) if value else value for value in old)
    for one, other in combinations(count, 2):
        if old[one] != old[other]:
            yield _with(old, {one: old[other], other: old[one]})
    if unit == "rad" and len(old) > 1:
        for index in count:
            yield from (_with(old, {index: turn}) for turn in _QUARTER_TURNS)


def _with(values: Values, others: dict[int, float]) -> Values:
    return tuple(others.get(index, value) for index, value in enumerate(values))


def _is_same(one: float, other: float, relative: float = 1e-9) -> bool:
    return isclose(one, other, rel_tol=relative, abs_tol=_SAME)


def values_of(text: str | None) -> Values:
    """Return the numbers of an attribute; none where ROS 2 cannot read it."""
    try:
        return tuple(numbers(text)) if text is not None else ()
    except NumberError:
        return ()


def format_numbers(values: Values) -> str:
    """Return numbers as a URDF contains them."""
    return " ".join(map(format_number, values))


def format_number(value: float) -> str:
    """Return a number in as few characters as a robot that a person writes needs."""
    if not isfinite(value):
        return repr(value)
    text = f"{round(value, 6) + 0.0:.6g}"
    if text == "0" and abs(value) > 1e-12:  # an inertia
        return f"{value:.6g}"
    return text if "e" not in text else f"{value:.6f}".rstrip("0").rstrip(".")


def round_numbers(values: Values, digits: int) -> Values:
    """Return numbers with so many decimals."""
    return tuple(round(value, digits) + 0.0 for value in values)
