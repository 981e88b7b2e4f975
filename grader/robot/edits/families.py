"""Families of mistakes in numbers: each yields the values that a student may have meant, and what is wrong with the written ones."""

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations
from math import radians
from typing import NamedTuple

Values = tuple[float, ...]

COMPONENTS = {
    "xyz": ("x", "y", "z"),
    "rpy": ("the roll", "the pitch", "the yaw"),
    "size": ("the length (x)", "the width (y)", "the height (z)"),
    "rgba": ("red", "green", "blue", "the opacity"),
    "axis": ("x of the axis", "y of the axis", "z of the axis"),
    "limit": ("the lower limit", "the upper limit", "the effort", "the velocity"),
    "mimic": ("the multiplier", "the offset"),
    "dynamics": ("the damping", "the friction"),
}
_LENGTHS = ("xyz", "size", "radius", "length", "scale")
_ANGLE_STEP = 5.0  # degrees: what is written in degrees is a multiple
_CLOSE = {"rpy": 2e-2, "rgba": 6e-3, "axis": 2e-2}  # radians, channels, components; else metres:
_CLOSE_LENGTH = 1e-3
_SAME = 3e-4


class HalfLength(NamedTuple):
    """Half a length of a shape, the component of a position that it may be missing in, and what it is half of."""

    length: float
    component: int
    name: str


class Slot(NamedTuple):
    """Numbers of one attribute, "axis" for those of an axis, and the half lengths of the shapes there with component and name."""

    attribute: str
    values: Values
    halves: tuple["HalfLength", ...] = ()
    is_given: bool = True

    def component(self, index: int) -> str:
        """Return what one of the numbers is called."""
        return COMPONENTS[self.attribute][index] if self.attribute in COMPONENTS else f"the {self.attribute}"


class Change(NamedTuple):
    """Other values: what is wrong with the written ones ("the sign of the roll"), and what to do ("negate the roll")."""

    values: Values
    cause: str
    action: str


def negated(slot: Slot) -> Iterator[Change]:
    """Negate one number, or all: a mirrored wheel, an axis that points backward, an offset to the wrong side."""
    nonzero = [index for index, value in enumerate(slot.values) if value]
    if slot.attribute not in ("xyz", "rpy", "axis", "limit", "mimic"):
        return
    for index in nonzero:
        name = slot.component(index)
        yield Change(_with(slot.values, {index: -slot.values[index]}), f"the sign of {name}", f"negate {name}{{}}")
    if len(nonzero) > 1:
        values = tuple(-value if value else value for value in slot.values)
        yield Change(values, f"the direction of {_called(slot)}", f"negate {_called(slot)}{{}}")


def in_radians(slot: Slot) -> Iterator[Change]:
    """Convert degrees to radians: rpy="-90 0 0", lower="-90" upper="90"."""
    angles = slot.values[: {"rpy": 3, "limit": 2}.get(slot.attribute, 0)]
    if any(value and not value % _ANGLE_STEP for value in angles):
        values = (*map(radians, angles), *slot.values[len(angles) :])
        name = _called(slot)
        yield Change(values, f"the unit of {name}{{}}: degrees, not radians", f"convert {name}{{}} to radians")


def in_metres(slot: Slot) -> Iterator[Change]:
    """Convert millimetres or centimetres to metres, all numbers or one: size="600 400 200"."""
    for factor, unit in ((1000.0, "millimetres"), (100.0, "centimetres")) if slot.attribute in _LENGTHS else ():
        large = [index for index, value in enumerate(slot.values) if abs(value) >= 1.0]
        if large:
            values = tuple(value / factor for value in slot.values)
            yield Change(
                values, f"the unit of {_called(slot)}{{}}: {unit}, not metres", f"convert {_called(slot)}{{}} to metres"
            )
        if large and len(large) < len([value for value in slot.values if value]):
            values = _with(slot.values, {index: slot.values[index] / factor for index in large})
            names = " and ".join(map(slot.component, large))
            yield Change(values, f"the unit of {names}{{}}: {unit}, not metres", f"convert {names}{{}} to metres")


def in_shares(slot: Slot) -> Iterator[Change]:
    """Convert channels of a colour from 0..255 to 0..1: rgba="0 153 0 1"."""
    if slot.attribute == "rgba" and any(value > 1.0 for value in slot.values):
        values = tuple(round(value / 255.0, 3) for value in slot.values[:3])
        yield Change((*values, *(min(1.0, value) for value in slot.values[3:])), "the range of the colour{}: 0..255, not 0..1", "write the colour{} in 0..1")  # fmt: skip


def swapped(slot: Slot) -> Iterator[Change]:
    """Exchange two numbers: length and width, x and y, roll and pitch."""
    for one, other in combinations(range(len(slot.values)), 2):
        if slot.values[one] != slot.values[other]:
            names = f"{slot.component(one)} and {slot.component(other)}"
            values = _with(slot.values, {one: slot.values[other], other: slot.values[one]})
            yield Change(values, f"{names}{{}} are swapped", f"swap {names}{{}}")


def halved(slot: Slot) -> Iterator[Change]:
    """Double or halve a size: a diameter for a radius, a half extent for a full length."""
    if slot.attribute in ("size", "radius", "length"):
        for factor, action in ((0.5, "halve"), (2.0, "double")):
            for index in range(len(slot.values)):
                name = slot.component(index)
                value = slot.values[index] * factor
                yield Change(
                    _with(slot.values, {index: value}),
                    f"{name}{{}}, which is {'half' if factor > 1 else 'twice'} the correct value",
                    f"{action} {name}{{}}",
                )
            if len(slot.values) > 1:
                values = tuple(value * factor for value in slot.values)
                yield Change(values, f"the size{{}}, which is {'half' if factor > 1 else 'twice'} the full lengths", f"{action} {_called(slot)}{{}}")  # fmt: skip


def half_shapes(slot: Slot) -> Iterator[Change]:
    """Add or remove half a shape's height, radius or length: a lidar whose frame is at the top of the box, and half in it."""
    for half, index, name in slot.halves if slot.attribute == "xyz" else ():
        for sign, verb, word in ((1, "add", "small"), (-1, "subtract", "large")):
            component = slot.component(index)
            values = _with(slot.values, {index: slot.values[index] + sign * half}) if slot.values else ()
            to = "to" if sign > 0 else "from"
            yield Change(
                values,
                f"{component}{{}} is too {word} by half of {name}",
                f"{verb} half of {name} {to} {component}{{}}",
            )


Family = Callable[[Slot], Iterator[Change]]
# Tried as they are: cheap, and plausible without knowing the expected value.
BLIND: Sequence[Family] = (negated, in_radians, in_metres, in_shares, swapped)
# These only name the mistake where an expected value is known: there are too many of them to try.
NAMING: Sequence[Family] = (*BLIND, halved, half_shapes)


def named(slot: Slot, wanted: Values) -> tuple[Change, bool]:
    """Return the change to expected values, and whether a family names it; else it is named by the numbers that change."""
    for family in NAMING:
        for change in family(slot):
            if is_close(slot.attribute, change.values, wanted):
                return change._replace(values=wanted), True
    if len(slot.values) != len(wanted):
        cause = f"{_called(slot)}{{}}, which ROS 2 cannot read" if slot.is_given else f"{_called(slot)}{{}}"
        return Change(wanted, cause, f"set {_called(slot)}{{}} to {written(wanted)}"), False
    off = [index for index, (a, b) in enumerate(zip(slot.values, wanted, strict=True)) if abs(a - b) > _SAME]
    values = _with(slot.values, {index: wanted[index] for index in off})
    names = " and ".join(map(slot.component, off)) or _called(slot)
    to = " and ".join(dict.fromkeys(number(wanted[index]) for index in off))
    return Change(values, names, f"set {names}{{}} to {to}"), False


def is_close(attribute: str, one: Values, other: Values) -> bool:
    """Return whether values are the same for a robot that a person wrote."""
    close = _CLOSE.get(attribute, _CLOSE_LENGTH)
    return len(one) == len(other) and all(abs(a - b) <= close for a, b in zip(one, other, strict=True))


def written(values: Values) -> str:
    """Return numbers as a URDF contains them."""
    return " ".join(map(number, values))


def number(value: float) -> str:
    """Return a number in as few characters as a robot that a person writes needs."""
    text = f"{round(value, 6) + 0.0:.6g}"
    return text if "e" not in text else f"{value:.6f}".rstrip("0").rstrip(".")


def _called(slot: Slot) -> str:
    if slot.attribute == "limit":
        return "the limits"
    return slot.attribute if slot.attribute in ("xyz", "rpy") else f"the {slot.attribute}"


def _with(values: Values, others: dict[int, float]) -> Values:
    return tuple(others.get(index, value) for index, value in enumerate(values))
