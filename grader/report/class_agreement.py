"""The agreement of two graders in the summary of a class."""

from collections.abc import Iterator
from typing import Any

from grader.classroom.gradebook.agreement import Agreement
from grader.report.json_data import exact, rounded
from grader.text import counted, format_points, printable


def agreement_lines(agreement: Agreement) -> Iterator[str]:
    """Yield the lines below the heading; none if nothing was marked twice."""
    if not agreement.items:
        return
    same = f"{agreement.same} with the same points"
    mean = f"mean difference {agreement.mean_difference:.1f} % of the maximum"
    yield f"{counted(agreement.items, 'item')} marked twice, {same}, {mean}"
    for item in agreement.largest:
        points = f"{format_points(item.first)} and {format_points(item.second)} of {format_points(item.maximum)} points"
        yield printable(f"{item.key}, {item.criterion}: {points}")


def agreement_json(agreement: Agreement) -> dict[str, Any]:
    """Return the agreement as plain data."""
    return {
        "items": agreement.items,
        "same": agreement.same,
        "mean_difference_percent": rounded(agreement.mean_difference),
        "largest": [
            {
                "id": item.key,
                "criterion": item.criterion,
                "first": exact(item.first),
                "second": exact(item.second),
                "max_points": exact(item.maximum),
            }
            for item in agreement.largest
        ],
    }
