"""Numbers that ROS 2 cannot read, written as it reads them: decimal commas, units, a minus sign from a PDF."""

import re
from collections.abc import Callable, Iterator
from itertools import product
from math import isfinite, pi

from grader.robot.edits.numbers import number, values_of
from grader.static_python.closed import evaluate
from grader.static_python.closed_values import Budget, ExpressionFails, OutOfBudget, Undetermined, Value
from grader.xml.urdf_format import PARTS

_WORK = 1_000  # of one expression
_UNITS = {"mm": 0.001, "cm": 0.01, "deg": pi / 180, "degrees": pi / 180, "\u00b0": pi / 180, "%": 0.01}
_UNIT = re.compile(r"([0-9.]+)[ ]?(mm|cm|meters?|metres?|m|radians|rad|degrees|deg|\u00b0|kg|%)(?![\w])", re.IGNORECASE)
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_MAX_LENGTH = 200


def is_readable(attribute: str, text: str) -> bool:
    """Return whether ROS 2 reads the numbers of an attribute."""
    parts = PARTS.get(attribute, ())
    if not parts:
        return True
    values = values_of(text)
    is_in_range = attribute != "rgba" or all(0.0 <= value <= 1.0 for value in values)
    return len(values) == len(parts) and is_in_range and (len(parts) > 1 or text == text.rstrip())


def readable(attribute: str, text: str) -> Iterator[tuple[str, str, str]]:
    """Yield what a text may stand for, each with what was wrong, and what to do."""
    found: dict[str, tuple[str, str]] = {}
    for steps in (
        product(*((step if isinstance(step, tuple) else (step,)) for step in _STEPS))
        if len(text) <= _MAX_LENGTH
        else ()
    ):
        current, causes = text, []
        for function, cause, action in map(_NAMED.__getitem__, steps):
            after = function(current, attribute)
            if after != current:
                causes.append((cause, action))
            current = after
        if causes and is_readable(attribute, current):
            found.setdefault(current, causes[0])
    for current, (cause, action) in found.items():
        yield current, cause, action
    yield from (
        (it, f"the count of numbers in {attribute}", f"write {len(PARTS[attribute])} numbers")
        for it in _counted(attribute, text)
    )


def _counted(attribute: str, text: str) -> Iterator[str]:
    """Yield as many numbers as an attribute needs: with zeros for those that are missing, or without the last ones."""
    pieces, count = _NUMBER.findall(text.replace(",", " ")), len(PARTS.get(attribute, ()))
    if count > 1 and len(pieces) > count:
        yield " ".join(pieces[:count])
    elif attribute == "scale" and len(pieces) == 1:
        yield " ".join(pieces * count)
    elif attribute in ("xyz", "rpy") and len(pieces) < count:
        missing = ["0"] * (count - len(pieces))
        yield from dict.fromkeys(" ".join(it) for it in ((*pieces, *missing), (*missing, *pieces)))


def _replaced(pattern: str, new: str) -> Callable[[str, str], str]:
    compiled = re.compile(pattern)
    return lambda text, _: compiled.sub(new, text)


def _without_units(text: str, _: str) -> str:
    def scaled(found: re.Match[str]) -> str:
        factor = _UNITS.get(found[2].lower(), 1.0)
        values = values_of(found[1])
        return number(values[0] * factor) if factor != 1.0 and len(values) == 1 else found[1]

    return _UNIT.sub(scaled, text)


def _evaluated(text: str, attribute: str) -> str:
    """Return a text with its arithmetic done: ${0.6/4}, pi/2."""
    text = re.sub(r"\$\{([^{}]*)\}", lambda found: _value(found[1]), text)
    if any(character in text for character in "*/+") or "pi" in text.lower():
        whole = [text] if len(PARTS.get(attribute, ())) == 1 else text.split(" ")
        text = " ".join(piece if values_of(piece) else _value(piece) for piece in whole)
    return text


def _value(text: str) -> str:
    def find(name: str) -> Value:
        if name.lower() in ("pi", "m_pi"):
            return pi
        raise Undetermined(f"{name} is not known")

    try:
        value = evaluate(text.replace("\u03c0", "pi"), find, Budget(_WORK))
    except (ExpressionFails, Undetermined, OutOfBudget):
        return text
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
    return number(float(value)) if is_number else text


def _in_range(text: str, attribute: str) -> str:
    """Return a colour in 0..1: 153 is 0.6."""
    values = values_of(text)
    if attribute != "rgba" or len(values) not in (3, 4) or all(0.0 <= value <= 1.0 for value in values):
        return text
    if all(0.0 <= value <= 255.0 for value in values):
        channels = [number(round(value / 255.0, 3)) for value in values[:3]]
        return " ".join([*channels, *("1" if value > 1.0 else number(value) for value in values[3:])])
    return " ".join(number(min(1.0, abs(value))) for value in values)


def _with_opacity(text: str, attribute: str) -> str:
    return f"{text.strip()} 1" if attribute == "rgba" and len(values_of(text)) == 3 else text


_SPACES = "separate the numbers by spaces"
_NAMED: dict[str, tuple[Callable[[str, str], str], str, str]] = {
    "minus": (_replaced("[\u2010-\u2015\u2212\ufe63\uff0d]", "-"), "a minus sign that is not ASCII", "write - for the minus"),
    "quotes": (_replaced("""["'\u201c\u201d\u2018\u2019\\[\\](){}](?<!\\{)(?<!\\})""", ""), "quotes or brackets around numbers", "remove the quotes or brackets"),
    "expression": (_evaluated, "an expression, which ROS 2 does not evaluate", "write the value of the expression"),
    "white": (_replaced(r"[\s\u00a0\u2000-\u200b\u202f\ufeff]+", " "), "white space that is not a space", _SPACES),
    "unit": (_without_units, "a unit after a number", "write the number without the unit"),
    "letter O": (_replaced(r"(?<=[0-9.])[oO]|[oO](?=[0-9.])|(?<![\w.])[oO](?![\w.])", "0"), "a letter in a number", "write a zero for the letter O"),
    "letter l": (_replaced(r"(?<![\w.])[lI](?=[.0-9])|(?<=[0-9.])[lI](?![a-z])", "1"), "a letter in a number", "replace the letter with 1"),
    "points": (_replaced(r"\.{2,}", "."), "an extra decimal point", "remove one decimal point"),
    "sign": (_replaced(r"([+-])\s+(?=[0-9.])", r"\1"), "a space after a sign", "remove the space"),
    "signs": (_replaced(r"\+-|--+", "-"), "a double sign", "remove one sign"),
    "no space": (_replaced(r"(?<=[0-9.])(?=[+-])(?<![eE])", " "), "the space between two numbers is missing", _SPACES),
    "none": (lambda text, _: text, "", ""),
    "commas": (_replaced(r"\s*[,;|]\s*", " "), "commas between numbers", _SPACES),
    "decimal": (_replaced(r"(?<=[0-9]),(?=[0-9])|(?<![0-9]),(?=[0-9])", "."), "a decimal comma", "write a decimal point"),
    "both": (lambda text, _: re.sub(r"\s*[,;|]\s+", " ", text).replace(",", "."), "decimal commas and commas between numbers", "write decimal points, and separate the numbers by spaces"),
    "semicolons": (lambda text, _: re.sub(r"\s*;\s*", " ", text).replace(",", "."), "decimal commas and semicolons between numbers", "write decimal points, and separate the numbers by spaces"),
    "gap": (_replaced(r"\.\s+(?=[0-9])", "."), "a space in a number", "remove the space"),
    "colons": (_replaced(r"(?<=[0-9])\s*:\s*(?=[0-9.+-])", " "), "colons between numbers", _SPACES),
    "end": (_replaced(r"[/,;]+[^0-9]*\Z", ""), "a character after the numbers", "remove the last character"),
    "strip": (lambda text, _: text.strip(), "a space after the number", "remove the space"),
    "range": (_in_range, "the range of the colour: 0..255, not 0..1", "write the colour in 0..1"),
    "opacity": (_with_opacity, "the opacity is missing", "add the opacity"),
}  # fmt: skip
# The steps in their order; of several in a tuple each is tried.
_STEPS: tuple[str | tuple[str, ...], ...] = (
    *("minus", "quotes", "expression", "white", "unit", "letter O", "letter l", "points", "sign", "signs", "no space"),
    ("none", "commas", "decimal", "both", "semicolons", "gap", "colons"),
    *("end", "strip", "range", "opacity"),
)
