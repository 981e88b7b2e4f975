"""How many submissions are late, and how many points they lose."""

from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.grades import Grades

_MAYBE_LATE = (
    "result IS NOT NULL AND final IS NULL AND NOT is_excused AND (is_late OR submitted <> '' OR days_late > 0)"
)


class LateTotals(NamedTuple):
    """How many submissions are late, the points that they lose in total, and the least and the most that one of them loses."""

    students: int
    lost: Decimal
    least: Decimal
    most: Decimal


def late_totals(grades: Grades) -> LateTotals:
    """Return the totals of a gradebook, without students who have a final mark or an excuse: they lose nothing."""
    lost = [-grade.late.points for grade in grades.where(_MAYBE_LATE) if grade.late.days]
    zero = Decimal(0)
    return LateTotals(len(lost), sum(lost, zero), min(lost, default=zero), max(lost, default=zero))
