"""A JSON report in a few lines: its score, and what did not pass."""

from collections.abc import Iterator, Mapping
from typing import Any


def results(report: Mapping[str, Any], shown: tuple[str, ...] = ()) -> Iterator[str]:
    """Yield the score of a JSON report, its notes, what did not pass or is to be shown, what was found, and the problems."""
    yield f"{report['score']:g} of {report['max_score']:g}, {report['pending']:g} pending"
    yield from (f"note: {note}" for note in report["notes"])
    others = report["submission"].get("other_candidates", ())
    yield from (f"graded: {report['submission']['path']}" for _ in others[:1])
    yield from (f"not graded: {other['path']}: {other['reason']}" for other in others)
    rows = [row for row in report["results"] if row["status"] != "passed" or row["id"] in shown]
    texts = [_result(row, row["id"] in shown) for row in rows]
    for what in dict.fromkeys(texts):
        ids = ", ".join(row["id"] for row, text in zip(rows, texts, strict=True) if text == what)
        yield from what.replace("IDS", ids, 1).splitlines()
    for piece in report.get("evidence", ()) if "evidence" in shown else ():
        yield from (f"evidence {piece['id']}: {_found(file)}" for file in piece["files"])
        yield from (f"evidence {piece['id']}: perhaps {_found(file)}" for file in piece["possible"])
    yield from (f"{row['code']}{_place(row['location'])}: {row['message']}" for row in report["problems"])


def _result(row: Mapping[str, Any], is_shown: bool) -> str:
    """Return a result with its hints, and the text of an answer that is to be shown; several may differ in their ids only."""
    carried = " (carried)" if row["carried"] else ""
    answer = row["measured"] if is_shown and isinstance(row["measured"], str) else ""
    return "\n".join((
        f"{row['status']}{carried} IDS{_place(row['location'])}: {row['message']}",
        *(f"  | {line}" for line in answer.splitlines()),
        *(f"  hint: {hint['message']}" for hint in row["hints"]),
    ))  # fmt: skip


def _found(file: Mapping[str, Any]) -> str:
    return ", ".join(str(file[key]) for key in ("path", "heading", "page") if file.get(key))


def _place(location: Mapping[str, Any] | None) -> str:
    return f" {location['path']}:{location['line']}:{location['column']}" if location else ""
