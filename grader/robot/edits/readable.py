"""Numbers that ROS 2 cannot read, written as it reads them: decimal commas, units, a minus sign from a PDF."""

import re
from collections.abc import Callable, Iterator
from math import isfinite, pi

from grader.robot.edits.numbers import format_number, values_of
from grader.static_python.budget import Budget, OutOfBudget
from grader.static_python.expressions import evaluate
from grader.static_python.values import ExpressionFails, Undetermined, Value
from grader.xml.urdf_format import PARTS

_WORK = 1_000  # of one expression
_MAX_LENGTH = 200


def is_readable(attribute: str, text: str) -> bool:
    """Return whether ROS 2 reads the numbers of an attribute."""
    parts = PARTS.get(attribute, ())
    if not parts:
        return True
    values = values_of(text)
    is_in_range = attribute != "rgba" or all(0.0 <= value <= 1.0 for value in values)
    return len(values) == len(parts) and is_in_range and (len(parts) > 1 or text == text.rstrip())


def readable_values(attribute: str, text: str) -> Iterator[tuple[str, str, str]]:
    """Yield what a text may stand for, each with what was wrong, and what to do."""
    found: dict[str, tuple[str, str]] = {}
    for separator in _SEPARATORS if len(text) <= _MAX_LENGTH else ():
        current, causes = text, []
        for pattern, new, cause, action in (*_STEPS, separator, *(_COLOUR if attribute == "rgba" else ())):
            after = re.sub(pattern, new, current)
            if after != current:
                causes.append((cause, action))
            current = after
        if causes and is_readable(attribute, current):
            found.setdefault(current, causes[0])
    for current in _with_count(attribute, text):
        found.setdefault(current, (f"the count of numbers in {attribute}", f"write {len(PARTS[attribute])} numbers"))
    yield from ((current, *causes) for current, causes in found.items())


def _with_count(attribute: str, text: str) -> Iterator[str]:
    """Yield as many numbers as an attribute needs: with zeros for those that are missing, or without the last ones."""
    pieces, count = text.replace(",", " ").split(), len(PARTS.get(attribute, ()))
    is_other = len(pieces) > count or (attribute in ("xyz", "rpy") and len(pieces) < count)
    if count > 1 and is_other and all(map(values_of, pieces)):
        yield " ".join([*pieces, "0", "0", "0"][:count])
        yield " ".join(["0", "0", "0", *pieces][-count:])


def _evaluate(found: re.Match[str]) -> str:
    """Return a number for an expression: ${0.6/4}, pi/2."""

    def find(name: str) -> Value:
        if name.lower() in ("pi", "m_pi"):
            return pi
        raise Undetermined(f"{name} is not known")

    try:
        value = evaluate(found[1] or found[0], find, Budget(_WORK))
    except (ExpressionFails, Undetermined, OutOfBudget):
        return found[0]
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
    return format_number(float(value)) if is_number and not values_of(found[0]) else found[0]


def _in_range(found: re.Match[str]) -> str:
    """Return a colour in 0..1: 153 is 0.6."""
    values = values_of(found[0])
    if max(values, default=0.0) <= 1.0:
        return found[0]
    channels = (format_number(round(value / 255.0, 3)) for value in values[:3])
    return " ".join([*channels, *(format_number(min(value, 1.0)) for value in values[3:])])


_SPACES = "separate the numbers by spaces"
_COMMAS = "commas between numbers", _SPACES
_UNIT = "a unit after a number", "write the number without the unit"
_UNITS = {"mm": "*0.001", "cm": "*0.01", "deg|degrees|\u00b0": "*pi/180", "m|rad|radians|kg": ""}
# What is replaced by what, in this order; then one of the separators.
_Step = tuple[str, str | Callable[[re.Match[str]], str], str, str]
_STEPS: tuple[_Step, ...] = (
    ("[\u2010-\u2015\u2212\ufe63\uff0d]", "-", "a minus sign that is not ASCII", "write - for the minus"),
    (r"[\s\u00a0\u2000-\u200b\u202f\ufeff]+", " ", "white space that is not a space", _SPACES),
    (r"\A | \Z", "", "a space after the number", "remove the space"),
    (r"\A[\[(\"']+|[\])\"']+\Z", "", "quotes or brackets around numbers", "remove the quotes or brackets"),
    (r"\.{2,}", ".", "an extra decimal point", "remove one decimal point"),
    (r"\+-|--+", "-", "a double sign", "remove one sign"),
    (r"(?<=[0-9.])[oO]|[oO](?=[0-9.])|(?<!\S)[oO](?!\S)", "0", "a letter in a number", "write a zero for the letter O"),
    *((rf"(?i)(?<=[0-9.]) ?(?:{unit})(?!\w)", factor, *_UNIT) for unit, factor in _UNITS.items()),
    (
        r"\$\{([^{}]*)\}|\S+",
        _evaluate,
        "an expression, which ROS 2 does not evaluate",
        "write the value of the expression",
    ),
    (r"([+-]) (?=[0-9.])", r"\1", "a space after a sign", "remove the space"),
    (r" ?(?:[,|] |; ?)", " ", *_COMMAS),
)
_SEPARATORS: tuple[_Step, ...] = ((",", ".", "a decimal comma", "write a decimal point"), (",", " ", *_COMMAS))
_COLOUR: tuple[_Step, ...] = (
    (r".+", _in_range, "the range of the colour: 0..255, not 0..1", "write the colour in 0..1"),
    (r"\A\S+ \S+ \S+\Z", r"\g<0> 1", "the opacity is missing", "add the opacity"),
)
