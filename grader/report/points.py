"""Points in words: exact, without trailing zeros, never rounded up."""

from decimal import Decimal


def points_words(points: Decimal) -> str:
    """Points as they are: 58.5, and 70 rather than 70.0."""
    return format(points.normalize(), "f") if points else "0"


def so_many_points(points: Decimal) -> str:
    """Points with the word for them: 1 point, 58.5 points."""
    return f"{points_words(points)} point{'' if points == 1 else 's'}"
