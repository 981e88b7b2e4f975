"""Numbers as urdfdom reads them, which is not what Python's `float()` accepts.

A vector is split at spaces only; each piece is read by a C++ stream in the classic locale
(`urdf_model/utils.h`): white space is allowed before a number and rejected after it; nan, inf, hex
and overflow are rejected.
"""

import re
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache, wraps
from math import isfinite, isinf, pi
from typing import TypeVar

from grader.base.patterns import on_use
from grader.base.text import counted, quoted
from grader.base.transforms import Quaternion, Vector

_NUMBER = on_use(r"[ \t\n\v\f\r]*[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_MAX_CACHED_LENGTH = 64  # characters: longer texts would make the cache large
_COMMA = r"[+-]?[0-9]+,[0-9]+"  # 0,15 for 0.15
_ARITHMETIC = on_use(r"(?:[0-9.+\-*/()]|pi)+")
_MAX_WORK = 1_000  # parts
_VERSION = r"[ \t\n\v\f\r]*([+-]?[0-9]+)"
_MAX_LONG = 2**63 - 1

_Value = TypeVar("_Value")


class NumberError(ValueError):
    """Text that ROS 2 does not read as a number; the message says why."""


def _cached_reader(read: Callable[[str], _Value]) -> Callable[[str], _Value]:
    """Return a reader that keeps values.

    The files of a class contain the same few texts thousands of times.
    """
    cached = lru_cache(maxsize=4096)(read)
    return wraps(read)(lambda text: cached(text) if len(text) <= _MAX_CACHED_LENGTH else read(text))


@_cached_reader
def number(text: str) -> float:
    """Return the value of one number as urdfdom's strToDouble does; raises NumberError."""
    if not _NUMBER.fullmatch(text):
        raise NumberError(_why_no_number(text))
    value = float(text)
    if isinf(value):
        raise NumberError(f"{quoted(text.strip())} is too large for a number")
    return value


def finite_number(text: str | None) -> float | None:
    """Return the number that a parameter file or an element surely has; None for any other text."""
    try:
        value = float(text or "")
    except ValueError:
        return None
    return value if isfinite(value) else None


def numbers(text: str) -> list[float]:
    """Return the numbers of a list with spaces between.

    Raises NumberError for the first piece that is not a number.
    """
    return [number(piece) for piece in text.split(" ") if piece]


@_cached_reader
def vector(text: str) -> Vector:
    """Return three numbers as urdfdom's Vector3::init does; raises NumberError."""
    values = numbers(text)
    if len(values) != 3:
        raise NumberError(f"it has {counted(len(values), 'number')}, expected 3")
    return (values[0], values[1], values[2])


@_cached_reader
def quaternion(text: str) -> Quaternion:
    """Return the four numbers x, y, z, w as urdfdom 6 reads them; raises NumberError."""
    values = numbers(text)
    if len(values) != 4:
        raise NumberError(f"it has {counted(len(values), 'number')}, expected 4")
    return (values[0], values[1], values[2], values[3])


def readable_numbers(text: str, count: int) -> list[str] | None:
    """Return the numbers that a list surely means, as texts, for one that ROS 2 cannot read.

    Returns None if it can be read.

    There may be twice as many, as in a pose. They are separated by any white space or by commas,
    with decimal commas, or are computed, as in pi/2.

    >>> readable_numbers("0,1, 0, 2", 3), readable_numbers("0 0 1", 3)
    (['0.1', '0', '2'], None)
    """
    with suppress(NumberError):
        if len(numbers(text)) == count:
            return None
    if "$" in text or len(text) > _MAX_CACHED_LENGTH:
        return None
    pieces = text.replace("\N{MINUS SIGN}", "-").split()
    decimal = [piece.strip(",").replace(",", ".") for piece in pieces]
    ways = [pieces, decimal, " ".join(pieces).replace(",", " ").split()]
    readings = []
    for way in ways:
        values = [_computed(piece) for piece in way]
        if len(way) in (count, 2 * count) and None not in values:
            readings.append([str(value) for value in values])
    return readings[0] if readings else None


def _computed(piece: str) -> str | None:
    """Return a number, or the value of an expression with pi, as a text that ROS 2 reads.

    The expression is arithmetic. Returns None for any other text.
    """
    if _NUMBER.fullmatch(piece):
        return piece
    if not _ARITHMETIC.fullmatch(piece):
        return None
    from grader.ros.python.budget import Budget, OutOfBudget  # late: few files have such numbers
    from grader.ros.python.expressions import evaluate
    from grader.ros.python.values import EvaluationFails, Undetermined

    try:
        value = evaluate(piece, {"pi": pi}.__getitem__, Budget(_MAX_WORK))
    except (EvaluationFails, Undetermined, OutOfBudget, KeyError):
        return None
    is_number = isinstance(value, int | float) and isfinite(value)
    return f"{value:.12g}" if is_number else None


def rgba(text: str) -> tuple[float, float, float, float] | None:
    """Return four channels in 0..1.

    Returns None for another count, which ROS 2 silently shows as black. Raises NumberError.
    """
    values = numbers(text)
    for value in values:
        if not 0.0 <= value <= 1.0:
            raise NumberError(f"{value:g} is outside 0..1")
    if len(values) != 4:
        return None
    return (values[0], values[1], values[2], values[3])


def version_in(text: str) -> tuple[int, int] | None:
    """Return a robot's `version` as urdfdom's URDFVersion reads it, by C's strtol.

    It is None for a text that it refuses.
    """
    parsed = [re.fullmatch(_VERSION, piece) for piece in text.removesuffix(".").split(".")]
    values = [_strtol(match[1]) for match in parsed if match]
    if len(parsed) != 2 or len(values) != 2 or min(values) < 0:
        return None
    major, minor = values
    return major % 2**32, minor % 2**32


def _strtol(digits: str) -> int:
    # C stops at the largest long; Python refuses to convert thousands of digits.
    value = min(int(digits.lstrip("+-0")[:20] or "0"), _MAX_LONG)
    if digits[0] == "-":
        return -value
    return value


def _why_no_number(text: str) -> str:
    if not text.strip():
        return "it is empty"
    reasons = {
        "contains a comma: write a decimal point, or a space between two numbers": re.fullmatch(
            _COMMA, text
        ),
        "contains a comma: separate numbers by spaces": "," in text,
        "is xacro, which ROS 2 does not evaluate": "$" in text,
        "contains a tab or a line break: separate numbers by plain spaces": not set(
            "\t\n\v\f\r"
        ).isdisjoint(text),
        "has a space after the number, which ROS 2 does not accept": _NUMBER.fullmatch(
            text.rstrip(" ")
        ),
        "contains a typographic quote, as word processors write": not set(
            "\u201c\u201d\u2018\u2019"
        ).isdisjoint(text),
        (
            "contains a character that is not ASCII, such as a typographic minus or space"
        ): not text.isascii(),
        "is not a number": True,
    }
    return f"{quoted(text)} {next(reason for reason, applies in reasons.items() if applies)}"
