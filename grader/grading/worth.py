"""What criteria are worth together: points that are part of the maximum, and extra credit."""

from collections.abc import Iterable
from decimal import Decimal
from typing import NamedTuple

from grader.grading.criterion import Criterion
from grader.text import counted_points, format_points


class Worth(NamedTuple):
    """The maximum of some criteria, and the points of extra credit in addition to it."""

    points: Decimal
    bonus: Decimal

    @property
    def text(self) -> str:
        """The points in words: 14 points; 14 points and 5 bonus points; 5 bonus points."""
        extra = f"{format_points(self.bonus)} bonus point{'' if self.bonus == 1 else 's'}" if self.bonus else ""
        return " and ".join(filter(None, (counted_points(self.points) if self.points or not extra else "", extra)))

    @property
    def short(self) -> str:
        """The points in short: 14; 14 + 5 bonus; 5 bonus."""
        extra = f"{format_points(self.bonus)} bonus" if self.bonus else ""
        return " + ".join(filter(None, (format_points(self.points) if self.points or not extra else "", extra)))


def worth(criteria: Iterable[Criterion]) -> Worth:
    """Return what criteria are worth together."""
    points = bonus = Decimal(0)
    for criterion in criteria:
        points += criterion.maximum
        bonus += criterion.points - criterion.maximum
    return Worth(points, bonus)
