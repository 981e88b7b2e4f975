"""Solve for numbers: which number of a robot, with which value, brings what a criterion measures to what it expects."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from math import hypot, isfinite, pi
from typing import NamedTuple

from grader.checks.outcome import Outcome
from grader.grading.hints.model import Model
from grader.robot.edits.difference import RobotDifference
from grader.robot.edits.draft import Draft, Set, child_of
from grader.robot.edits.numbers import Values, plausible, rounded, values_of, written
from grader.robot.edits.pieces import FITTED, SOLVED, Piece
from grader.xml.parsing import Element
from grader.xml.urdf_format import CHILDREN, TAGS

_EXACT = 0.05  # of the tolerance: an edit brings a value to the expected one, not just into the tolerance
_STEP = 1e-4
_FLAT, _WILD = 1e-6, 1e3  # slopes that are none, and that are a leap
_DIGITS = range(2, 7)
_SHORT = 3  # decimals of a number that a person would write
_MAX_SLOTS = 60
_ADDED = ("origin", "axis")  # elements that a person adds to give them a value


class Slot(NamedTuple):
    """Numbers of one element: an attribute, or all attributes with one number each."""

    owner: Element
    tag: str
    attributes: tuple[str, ...]
    values: Values
    unit: str

    def sets(self, values: Values, text: Callable[[Values], str] = written) -> tuple[Set, ...]:
        """Return what is set to give the numbers these values."""
        if len(self.attributes) == 1:
            return (Set(self.owner, self.tag, self.attributes[0], text(values)),) if values != self.values else ()
        pairs = zip(self.attributes, values, self.values, strict=True)
        return tuple(Set(self.owner, self.tag, name, text((value,))) for name, value, old in pairs if value != old)


def slots(draft: Draft, shown: Sequence[str], moved: Sequence[str]) -> Iterator[Slot]:
    """Yield the numbers of the joints that move links, and of what links show."""
    links = _known(map(draft.link, shown))
    parts = [part for own in links for part in own.iterchildren("visual", "inertial")]
    colours = (draft.material(used.get("name") or "") for part in parts for used in part.iterchildren("material"))
    for owner in (*_known(map(draft.joint_of, moved)), *parts, *_known(colours)):
        tags = ("origin",) if owner.get("type") in ("fixed", "floating") else _ADDED
        for tag in (tag for tag in tags if tag in CHILDREN[str(owner.tag)]):
            yield from _slots(owner, tag)
        for element in owner.iterdescendants(*(tag for tag in TAGS if tag not in _ADDED)):
            yield from _slots(element, "")


def _known(found: Iterable[Element | None]) -> Iterator[Element]:
    return (element for element in found if element is not None)


def _slots(owner: Element, tag: str) -> Iterator[Slot]:
    """Yield the numbers of an element, or of its child (perhaps missing): those of a vector, else all together."""
    element, known = child_of(owner, tag) if tag else owner, TAGS[tag or str(owner.tag)].attributes
    names = [name for name, one in known.items() if one.parts]
    vectors = [name for name in names if len(known[name].parts) > 1]
    for those in (*([name] for name in vectors), [name for name in names if name not in vectors]):
        given: dict[str, Values] = {}
        for name in those:
            default = "1 0 0" if (tag, element) == ("axis", None) else known[name].default
            values = values_of(element.get(name, default) if element is not None else default)
            given |= {name: values} if len(values) == len(known[name].parts) else {}
        if given:
            unit = known[next(iter(given))].unit
            yield Slot(owner, tag, tuple(given), tuple(value for values in given.values() for value in values), unit)


class Solver:
    """Searches the values with which one criterion measures what it expects."""

    def __init__(self, model: Model, difference: RobotDifference, name: str, outcome: Outcome) -> None:
        self._model, self._difference, self._name = model, difference, name
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
                is_short = slot.unit == "rad" or all(rounded((new,), _SHORT)[0] == new for new in changed)
                yield self._difference.of_sets(slot.sets(values), SOLVED if is_short and len(changed) == 1 else FITTED)

    def _values(self, slot: Slot, start: Values) -> Iterator[Values]:
        known_residuals: dict[Values, Values | None] = {slot.values: start}

        def ask(values: Values) -> Values | None:
            if values not in known_residuals:
                known_residuals[values] = self._residual(slot, values) if all(map(isfinite, values)) else None
            return known_residuals[values]

        columns = [self._column(ask, slot.values, index) for index in range(len(slot.values))]
        touched = [index for index, column in enumerate(columns) if column is None or any(column)]
        if not touched:
            return
        if _is_turned(slot):
            for values in plausible(slot.unit, slot.values):
                if self._is_exact(ask(values)):
                    yield values
        known = {index: column for index in touched if (column := columns[index]) is not None}
        subsets = [(index,) for index in known] + ([tuple(known)] if len(known) > 1 else [])
        for subset in subsets:
            solved = self._solved(ask, slot.values, start, {index: known[index] for index in subset})
            if solved is not None:
                yield solved

    def _solved(
        self, ask: Callable[[Values], Values | None], old: Values, start: Values, columns: Mapping[int, Values]
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
            after = ask(values)
            if after is None or hypot(*after) > 0.9 * hypot(*residual):
                return self._short(ask, old, values) if self._is_exact(after) else None
            residual = after
            columns = {index: column for index in columns if (column := self._column(ask, values, index)) is not None}
        return self._short(ask, old, values)

    def _short(self, ask: Callable[[Values], Values | None], old: Values, values: Values) -> Values | None:
        shorts = [
            tuple(
                before if abs(before - value) < _STEP / 10 else value
                for before, value in zip(old, rounded(values, digits), strict=True)
            )
            for digits in _DIGITS
        ]
        shorts += [values] if max(map(abs, values)) < 0.01 else []
        return next((short for short in shorts if self._is_exact(ask(short))), None)

    def _column(self, ask: Callable[[Values], Values | None], values: Values, index: int) -> Values | None:
        """Return how what is measured changes with one of the values; None where it cannot be told."""
        size = _STEP * max(abs(values[index]), 1e-2 if abs(values[index]) < 1e-2 and values[index] else 1.0)
        slopes = (_slope(ask, values, index, step) for step in (size, -size))  # a channel of a colour ends at 1
        return next((slope for slope in slopes if slope and max(map(abs, slope)) < _WILD), None)

    def _residual(self, slot: Slot, values: Values) -> Values | None:
        sets = self._difference.with_twins(slot.sets(values, _precisely))
        return self._difference_of(self._model.results(sets, (self._name,))[self._name].outcome)

    def _difference_of(self, outcome: Outcome) -> Values | None:
        actual, expected = _vector(outcome.measured), self._expected
        if actual is None or expected is None or len(actual) != len(expected) or outcome.unit != self._outcome.unit:
            return None
        return tuple(a - b for a, b in zip(actual, expected, strict=True))

    def _is_exact(self, residual: Values | None) -> bool:
        return residual is not None and all(abs(value) <= self._exact for value in residual)


def _slope(ask: Callable[[Values], Values | None], values: Values, index: int, step: float) -> Values:
    """Return how what is measured changes with one of the values, from this one on; empty where it cannot be told."""
    before = ask(values)
    after = ask(tuple(value + step if other == index else value for other, value in enumerate(values)))
    slope = ((b - a) / step for a, b in zip(before, after, strict=True)) if before and after else ()
    return tuple(value if abs(value) > _FLAT else 0.0 for value in slope)


def _precisely(values: Values) -> str:
    return " ".join(map(repr, values))


def _is_turned(slot: Slot) -> bool:
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
