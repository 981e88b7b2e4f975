"""Numbers as urdfdom reads them; Python's `float()` is another language.

A vector is split at spaces only; each piece goes through a C++ stream in the classic locale (`urdf_model/utils.h`):
white space is skipped before a number and refused behind it; nan, inf, hex and overflow are refused.
"""

import re
from functools import lru_cache
from math import isinf

from grader.robot.transforms import Vector
from grader.text import quoted

_NUMBER = re.compile(r"[ \t\n\v\f\r]*[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_KEPT_LENGTH = 64  # longer texts are read anew each time, so that what is kept stays small
_VERSION = re.compile(r"[ \t\n\v\f\r]*([+-]?[0-9]+)")
_LONG = 2**63


class NumberError(ValueError):
    """Text that ROS 2 does not take for a number; the message says why in plain words."""


def number(text: str) -> float:
    """The value of one number, as urdfdom's strToDouble gives it; raises NumberError."""
    return _kept_number(text) if len(text) <= _KEPT_LENGTH else _number(text)


def numbers(text: str) -> list[float]:
    """Every number of a list with spaces between; raises NumberError at the first piece that is none."""
    return [number(piece) for piece in text.split(" ") if piece]


def vector(text: str) -> Vector:
    """Three numbers, as urdfdom's Vector3::init gives them; raises NumberError."""
    return _kept_vector(text) if len(text) <= _KEPT_LENGTH else _vector(text)


def rgba(text: str) -> tuple[float, float, float, float] | None:
    """Four channels in 0..1; None for another count, which ROS 2 silently takes for black; raises NumberError."""
    values = numbers(text)
    for value in values:
        if not 0.0 <= value <= 1.0:
            raise NumberError(f"{value:g} is outside 0..1")
    if len(values) != 4:
        return None
    return (values[0], values[1], values[2], values[3])


def is_version_one(text: str) -> bool:
    """Whether a robot's `version` is 1.0 in the eyes of urdfdom's URDFVersion, C's strtol included."""
    pieces = text.split(".")
    if pieces[-1] == "":
        pieces.pop()
    parsed = [_VERSION.fullmatch(piece) for piece in pieces]
    if len(pieces) != 2 or not all(parsed):
        return False
    values = [_strtol(match[1]) for match in parsed if match]
    return all(value >= 0 for value in values) and [value % 2**32 for value in values] == [1, 0]


def _number(text: str) -> float:
    if _NUMBER.fullmatch(text) is None:
        raise NumberError(_why_not(text))
    value = float(text)
    if isinf(value):
        raise NumberError(f"{quoted(text.strip())} is too large for a number")
    return value


def _vector(text: str) -> Vector:
    values = numbers(text)
    if len(values) != 3:
        raise NumberError(f"it has {len(values)} number{'' if len(values) == 1 else 's'} where 3 are needed")
    return (values[0], values[1], values[2])


# A class's files hold the same few texts thousands of times.
_kept_number = lru_cache(maxsize=4096)(_number)
_kept_vector = lru_cache(maxsize=4096)(_vector)


def _strtol(digits: str) -> int:
    # C stops at the largest long; Python refuses to read thousands of digits.
    magnitude = digits.lstrip("+-0")[:20] or "0"
    value = min(int(magnitude), _LONG - 1)
    return -value if digits[0] == "-" else value


def _why_not(text: str) -> str:
    shown = quoted(text)
    if not text.strip():
        return "it is empty"
    if "," in text:
        return f"{shown} holds a comma: numbers are separated by spaces"
    if "$" in text:
        return f"{shown} is xacro, which ROS 2 does not evaluate in a .urdf file"
    if any(c in text for c in "\t\n\v\f\r"):
        return f"{shown} holds a tab or a line break: only plain spaces may separate numbers"
    if _NUMBER.fullmatch(text.rstrip(" ")):
        return f"{shown} has a space behind the number, where ROS 2 takes none"
    if any(c in text for c in "\u201c\u201d\u2018\u2019"):
        return f"{shown} holds a typographic quote, as word processors make them"
    if not text.isascii():
        return f"{shown} holds a character that is not plain ASCII, such as a typographic minus or space"
    return f"{shown} is not a number"
