"""Measured numbers: whether they are within a tolerance, and how a message shows them."""

from functools import lru_cache
from math import isnan

# A tolerance includes its end: 0.152 is within 0.002 of 0.15, although the floats differ by
# slightly more.
SLACK = 1e-9
_FEW, _MANY = 100.0, 1e7  # from here on: no decimals, an exponent


def within(actual: float, expected: float, tolerance: float) -> bool:
    """Return whether a value is within a tolerance of another; never true of NaN."""
    return abs(actual - expected) <= tolerance + SLACK


def number_text(value: float, digits: int = 9) -> str:
    """Return a number of a URDF for a message."""
    if isnan(value):
        return "missing or unreadable"
    return f"{value + 0.0:.{digits}g}"


def in_millimetres(length: float) -> str:
    """Return the size of a difference in metres, rounded for reading: 25 mm."""
    millimetres = abs(length) * 1000
    if _FEW <= millimetres < _MANY:
        return f"{millimetres:.0f} mm"
    return f"{millimetres:.3g} mm"


def in_degrees(angle: float) -> str:
    """Return an angle in degrees, rounded for reading: 1.5 degrees."""
    return f"{angle:.3g} degree{'' if f'{angle:.3g}' == '1' else 's'}"


@lru_cache(maxsize=4096)
def point(values: tuple[float, ...]) -> str:
    """Return coordinates as a URDF writes them, rounded for reading."""
    return " ".join(map(_short_number, values))


@lru_cache(maxsize=4096)
def _short_number(value: float) -> str:
    if abs(value) >= _MANY:
        return f"{value:.3g}"
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
