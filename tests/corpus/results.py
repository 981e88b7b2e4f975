"""A JSON report in a few lines: its score, and what did not pass."""

from collections.abc import Iterator, Mapping
from typing import Any


def results(report: Mapping[str, Any], shown: tuple[str, ...] = ()) -> Iterator[str]:
    """Yield the score of a JSON report, its notes, and what did not pass or is to be shown, with place, message and hints."""
    yield f"{report['score']:g} of {report['max_score']:g}, {report['pending']:g} pending"
    yield from (f"note: {note}" for note in report["notes"])
    for row in report["results"]:
        if row["status"] != "passed" or row["id"] in shown:
            carried = " (carried)" if row["carried"] else ""
            yield f"{row['status']}{carried} {row['id']}{_place(row['location'])}: {row['message']}"
            yield from (f"  hint: {hint['message']}" for hint in row["hints"])
    yield from (f"{row['code']}{_place(row['location'])}: {row['message']}" for row in report["problems"])


def _place(location: Mapping[str, Any] | None) -> str:
    return f" {location['path']}:{location['line']}:{location['column']}" if location else ""
