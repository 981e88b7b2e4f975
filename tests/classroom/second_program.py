"""The grades of a class, computed a second time: from the reports of `grader grade`, the roster, marks and the late policy.

Nothing of the package is imported, so no mistake in its gradebook, marks, lateness or tables is repeated here.
"""

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from decimal import ROUND_FLOOR, Decimal
from math import ceil
from statistics import median
from typing import Any, NamedTuple

Row = Mapping[str, str]


class Policy(NamedTuple):
    """The late policy: the deadline, the grace period, percent of the maximum for a day, and the floor in percent."""

    due: datetime
    grace: timedelta
    per_day: Decimal
    floor: Decimal


def plain(number: Decimal) -> str:
    """Return a number without zeros at its end."""
    text = format(number, "f")
    return text.rstrip("0").rstrip(".") if "." in text else text


def newest(marks: Sequence[Row], student: str) -> dict[str, str]:
    """Return the points of a student's newest marks by criterion, without those that were withdrawn."""
    found = {
        one["criterion"]: one["points"]
        for one in marks
        if one["student"] == student and one["points"]
    }
    return {name: points for name, points in found.items() if points != "-"}


def days_late(student: Row, own_deadline: str, policy: Policy) -> int:
    """Return the days begun after the grace period; a submission that is late by an unknown time is one day late."""
    if student["late"] not in ("", "yes"):
        return int(student["late"])
    if student["submitted"]:
        due = (
            datetime.fromisoformat(own_deadline or student["due"])
            if own_deadline or student["due"]
            else policy.due
        )
        over = datetime.fromisoformat(student["submitted"]) - due - policy.grace
        return max(0, ceil(over / timedelta(days=1)))
    return int(student["late"] == "yes")


def cells_of(
    student: Row, report: Mapping[str, Any] | None, marks: Sequence[Row], policy: Policy
) -> dict[str, str]:
    """Return the cells of a student in `grades.csv` by column, without those that are empty."""
    given = newest(marks, student["id"])
    final = given.pop("grade", "") or given.pop("total", "")
    own_deadline = given.pop("deadline", "")
    cells = {
        "id": student["id"],
        "name": student["name"],
        "section": student["section"],
        "email": student["email"],
    }
    if report is None:
        status = "excused" if final == "excused" else "missing"
        return {**cells, "status": status, "grade": final if final != "excused" else ""}
    points, maximum, pending = dict[str, str](), Decimal(0), Decimal(0)
    for one in report["results"]:
        maximum += Decimal(str(one["max_points"]))
        if one["id"] in given:
            points[one["id"]] = given[one["id"]]
        elif one["status"] == "pending":
            pending += Decimal(str(one["max_points"]))
        else:
            points[one["id"]] = plain(Decimal(str(one["points"])))
    if final == "excused":
        return {**cells, "status": "excused"}
    score, days = (
        sum(map(Decimal, points.values()), Decimal(0)),
        days_late(student, own_deadline, policy),
    )
    least = min(score, maximum * policy.floor / 100)
    late = max(least, score - maximum * policy.per_day * days / 100) - score
    if final:
        late, pending = Decimal(0), Decimal(0)
    numbers = {
        "score": score,
        "max_score": maximum,
        "pending": pending,
        "late_days": Decimal(days),
        "late_points": late,
    }
    total = final or plain(score + late)
    return {
        **cells,
        **points,
        "status": "graded",
        "grade": total,
        **{key: plain(one) for key, one in numbers.items()},
    }


def published(cells: Mapping[str, str]) -> str:
    """Return the grade that an LMS gets: two decimals, rounded down; empty while something is open."""
    if not cells.get("grade") or cells.get("pending", "0") != "0":
        return ""
    return str(Decimal(cells["grade"]).quantize(Decimal("0.01"), ROUND_FLOOR))


def summary(totals: Sequence[Decimal]) -> tuple[float, float]:
    """Return the mean and the median."""
    return float(sum(totals, Decimal(0)) / len(totals)), float(median(totals))
