"""Numbers that ROS 2 cannot read, written as it reads them: decimal commas, units, a minus sign from a PDF."""

import re
from collections.abc import Callable, Iterator
from math import isfinite, pi, radians
from typing import NamedTuple

from grader.robot.edits.families import number as written
from grader.robot.numbers import NumberError, numbers
from grader.static_python.closed import evaluate
from grader.static_python.closed_values import Budget, ExpressionFails, OutOfBudget, Undetermined, Value

COUNTS = {"xyz": 3, "rpy": 3, "size": 3, "scale": 3, "rgba": 4}
_TEXTS = frozenset({"name", "type", "link", "joint", "filename", "version"})
_WORK = 1_000  # of one expression
_UNITS = {"mm": 0.001, "cm": 0.01, "deg": pi / 180, "degrees": pi / 180, "\u00b0": pi / 180, "%": 0.01}
_UNIT = re.compile(r"([0-9.]+)[ ]?(mm|cm|meters?|metres?|m|radians|rad|degrees|deg|\u00b0|kg|%)(?![\w])", re.IGNORECASE)
_EXPRESSION = re.compile(r"\$\{([^{}]*)\}")


Step = Callable[[str, str], str]  # a text and the name of its attribute -> the text that was meant


class Written(NamedTuple):
    """A text as ROS 2 reads it, what was wrong with it, and what to do."""

    text: str
    cause: str
    action: str


def is_readable(attribute: str, text: str) -> bool:
    """Return whether ROS 2 reads the numbers of an attribute."""
    if attribute in _TEXTS:
        return True
    try:
        values = numbers(text)
    except NumberError:
        return False
    if attribute not in COUNTS and text != text.rstrip():
        return False
    return len(values) == COUNTS.get(attribute, 1) and (
        attribute != "rgba" or all(0.0 <= value <= 1.0 for value in values)
    )


def readable(attribute: str, text: str) -> Iterator[Written]:
    """Yield what a text may stand for: each step is one that ROS 2 needs, and the first that changed the text names the mistake."""
    found: dict[str, Written] = {}
    for commas in _COMMAS:
        current, causes = text, []
        for step, cause, action in (*_STEPS, commas, *_LAST):
            after = step(current, attribute)
            if after != current:
                causes.append((cause, action))
            current = after
        if causes and is_readable(attribute, current):
            found.setdefault(current, Written(current, *causes[0]))
    yield from found.values()


def with_count(attribute: str, text: str) -> Iterator[str]:
    """Yield numbers in the count that an attribute needs: with zeros for those that are missing, or without those at the end."""
    pieces = [piece for piece in text.split() if _is_number(piece)]
    count = COUNTS.get(attribute, 1)
    if len(pieces) > count:
        yield " ".join(pieces[:count])
    elif attribute == "scale" and len(pieces) == 1:
        yield " ".join(pieces * count)
    elif attribute in ("xyz", "rpy"):
        missing = ["0"] * (count - len(pieces))
        yield from dict.fromkeys(" ".join(found) for found in ((*pieces, *missing), (*missing, *pieces)))


def _replaced(pattern: str, new: str) -> Step:
    compiled = re.compile(pattern)
    return lambda text, _: compiled.sub(new, text)


def _without_units(text: str, attribute: str) -> str:
    del attribute
    return _UNIT.sub(lambda found: _scaled(found[1], _UNITS.get(found[2].lower(), 1.0)), text)


def _scaled(text: str, factor: float) -> str:
    try:
        return text if factor == 1.0 else written(float(text) * factor)
    except ValueError:
        return text


def _evaluated(text: str, attribute: str) -> str:
    """Return a text with its arithmetic done: ${0.6/4}, pi/2."""
    text = _EXPRESSION.sub(lambda found: _value(found[1]), text)
    if any(character in text for character in "*/") or "pi" in text.lower():
        pieces = text.split(" ")
        text = " ".join(piece if _is_number(piece) else _value(piece) for piece in pieces)
    if attribute not in COUNTS and " " in text.strip() and any(character in text for character in "*/+"):
        text = _value(text)
    return text


def _is_number(text: str) -> bool:
    try:
        return len(numbers(text)) <= 1
    except NumberError:
        return False


def _value(text: str) -> str:
    try:
        value = evaluate(text.replace("\u03c0", "pi"), _name, Budget(_WORK))
    except (ExpressionFails, Undetermined, OutOfBudget):
        return text
    if isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value):
        return written(float(value))
    return text


def _name(name: str) -> Value:
    if name.lower() in ("pi", "m_pi"):
        return pi
    if name == "radians":
        return radians(1.0)
    raise Undetermined(f"{name} is not known")


def _in_range(text: str, attribute: str) -> str:
    """Return a colour in 0..1: 153 is 0.6."""
    try:
        values = numbers(text)
    except NumberError:
        return text
    if attribute != "rgba" or len(values) not in (3, 4) or all(0.0 <= value <= 1.0 for value in values):
        return text
    if all(0.0 <= value <= 255.0 for value in values):
        channels = [written(round(value / 255.0, 3)) for value in values[:3]]
        opacity = ["1" if value > 1.0 else written(value) for value in values[3:]]
        return " ".join([*channels, *opacity])
    return " ".join(written(min(1.0, abs(value))) for value in values)


def _with_opacity(text: str, attribute: str) -> str:
    try:
        return f"{text.strip()} 1" if attribute == "rgba" and len(numbers(text)) == 3 else text
    except NumberError:
        return text


_STEPS: tuple[tuple[Step, str, str], ...] = (
    (_replaced("[\u2010-\u2015\u2212\ufe63\uff0d]", "-"), "a minus sign that is not ASCII", "write - for the minus"),
    (_replaced("""["'\u201c\u201d\u2018\u2019\\[\\](){}](?<!\\{)(?<!\\})""", ""), "quotes or brackets around numbers", "remove the quotes or brackets"),
    (_evaluated, "an expression, which ROS 2 does not evaluate", "write the value of the expression"),
    (_replaced(r"[\s\u00a0\u2000-\u200b\u202f\ufeff]+", " "), "white space that is not a space", "separate the numbers by spaces"),
    (_without_units, "a unit after a number", "write the number without the unit"),
    (_replaced(r"(?<=[0-9.])[oO]|[oO](?=[0-9.])|(?<![\\w.])[oO](?![\\w.])", "0"), "a letter in a number", "write a zero for the letter O"),
    (_replaced(r"(?<![\w.])[lI](?=[.0-9])|(?<=[0-9.])[lI](?![a-z])", "1"), "a letter in a number", "replace the letter with 1"),
    (_replaced(r"\.{2,}", "."), "an extra decimal point", "remove one decimal point"),
    (_replaced(r"([+-])\s+(?=[0-9.])", r"\1"), "a space after a sign", "remove the space"),
    (_replaced(r"--+", "-"), "a double sign", "remove one sign"),
    (_replaced(r"\+-", "-"), "two signs", "remove one sign"),
    (_replaced(r"(?<=[0-9.])(?=[+-])(?<![eE])", " "), "the space between two numbers is missing", "separate the numbers by spaces"),
)  # fmt: skip
_COMMAS: tuple[tuple[Step, str, str], ...] = (
    (lambda text, _: text, "", ""),
    (_replaced(r"\s*[,;|]\s*", " "), "commas between numbers", "separate the numbers by spaces"),
    (_replaced(r"(?<=[0-9]),(?=[0-9])|(?<![0-9]),(?=[0-9])", "."), "a decimal comma", "write a decimal point"),
    (
        lambda text, _: re.sub(r"\s*[,;|]\s+", " ", text).replace(",", "."),
        "decimal commas and commas between numbers",
        "write decimal points, and separate the numbers by spaces",
    ),
    (
        lambda text, _: re.sub(r"\s*;\s*", " ", text).replace(",", "."),
        "decimal commas and semicolons between numbers",
        "write decimal points, and separate the numbers by spaces",
    ),
    (_replaced(r"\.\s+(?=[0-9])", "."), "a space in a number", "remove the space"),
    (_replaced(r"(?<=[0-9])\s*:\s*(?=[0-9.+-])", " "), "colons between numbers", "separate the numbers by spaces"),
)
_LAST: tuple[tuple[Step, str, str], ...] = (
    (lambda text, _: re.sub(r"[^0-9]+$", "", text) if text.endswith(("/", ",", ";")) else text, "a character after the numbers", "remove the last character"),
    (lambda text, _: text.strip(), "a space after the number", "remove the space"),
    (_in_range, "the range of the colour: 0..255, not 0..1", "write the colour in 0..1"),
    (_with_opacity, "the opacity is missing", "add the opacity"),
)  # fmt: skip
