"""How many submissions are late, and how many points they lose."""

import json
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.grades import Grades

_MAYBE_LATE = (
    "result IS NOT NULL AND final IS NULL AND NOT is_excused AND (is_late OR submitted <> '' OR days_late > 0)"
)
_TIMES = "SELECT is_late OR submitted <> '' OR days_late IS NOT NULL, roster_entry FROM grade WHERE result IS NOT NULL"


class LateTotals(NamedTuple):
    """How many submissions are late, the points that they lose in total, and the least and the most that one of them loses.

    `unknown` counts the submissions if a deadline has no effect, because nothing says of any of them when it was submitted.
    """

    students: int
    lost: Decimal
    least: Decimal
    most: Decimal
    unknown: int = 0


def late_totals(grades: Grades) -> LateTotals:
    """Return the totals of a gradebook, without students who have a final mark or an excuse: they lose nothing."""
    lost = [-grade.late.points for grade in grades.where(_MAYBE_LATE) if grade.late.days]
    zero = Decimal(0)
    unknown = _undated(grades) if grades.has_deadline else 0
    return LateTotals(len(lost), sum(lost, zero), min(lost, default=zero), max(lost, default=zero), unknown)


def _undated(grades: Grades) -> int:
    """Return how many submissions there are; 0 if it is known of one when it was submitted, or whether it is late."""
    rows = list(grades.book.rows(_TIMES))
    is_known = any(has_time or (entry and json.loads(entry).get("is_late") is not None) for has_time, entry in rows)
    return 0 if is_known else len(rows)
