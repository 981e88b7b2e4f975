"""A JSON report, of a submission or a class, in a few lines."""

from collections.abc import Iterator, Mapping
from typing import Any


def results(report: Mapping[str, Any], shown: tuple[str, ...] = ()) -> Iterator[str]:
    """Yield the lines of a class, or the score of a report, its notes, what did not pass or is to be shown, and the problems."""
    if "attention" in report:
        yield from map(_student, report["students"])
        yield from (
            f"{group['reason']}: {_ids(group['students'])}" for group in report["attention"]
        )
        return
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
    for problem in report["problems"]:
        is_told = any(problem["message"] in row["message"] for row in rows)
        yield f"{problem['code']}{_place(problem['location'])}{'' if is_told else ': ' + problem['message']}"


def _student(row: Mapping[str, Any]) -> str:
    """Return a student's identity, status, points, lateness, marks and files."""
    late = row["late"]
    is_unread = row["status"] == "unreadable" and not row["manual_marks"]
    parts = (
        f"{row['score']:g}/{row['max_score']:g}"
        if row["score"] is not None and not is_unread
        else "",
        f"{row['pending']:g} pending" if row["pending"] and not is_unread else "",
        f"late {late['days']:g}: {late['points']:g}" if late["days"] else "",
        late["reason"],
        f"grade {row['grade']:g}" if row["grade"] not in (None, row["score"]) else "",
        f"final mark {row['final_mark']:g}" if row["final_mark"] is not None else "",
        "excused" if row["is_excused"] else "",
        f"{row['manual_marks']} manual" if row["manual_marks"] else "",
    )
    who = f"{row['id']} ({row['name']})" if row["name"] not in ("", row["id"]) else row["id"]
    files = f" <- {', '.join(row['paths'])}" if row["paths"] else ""
    return f"{who}: {', '.join(part for part in (row['status'], *parts) if part)}{files}"


def _ids(students: list[Mapping[str, str]]) -> str:
    details = {
        row["id"]: row["detail"] for row in students if len(students) < 3
    }  # few, so that a table can be read
    return ", ".join(
        f"{row['id']} ({details[row['id']]})" if details.get(row["id"]) else row["id"]
        for row in students
    )


def _result(row: Mapping[str, Any], is_shown: bool) -> str:
    """Return a result with its hints, and the text of an answer that is to be shown; several may differ in their ids only.

    Of pictures and answers that need manual grading, as they do in most cases, there are the ids only.
    """
    if (
        row["status"] == "pending"
        and row["id"].startswith(("evidence-", "answer-"))
        and not is_shown
    ):
        return "pending IDS"
    carried = " (carried)" if row["carried"] else ""
    answer = row["measured"] if is_shown and isinstance(row["measured"], str) else ""
    return "\n".join(
        (
            f"{row['status']}{carried} IDS{_place(row['location'])}: {row['message']}",
            *(f"  | {line}" for line in answer.splitlines()),
            *(f"  hint: {hint['message']}" for hint in row["hints"]),
        )
    )


def _found(file: Mapping[str, Any]) -> str:
    return ", ".join(str(file[key]) for key in ("path", "heading", "page") if file.get(key))


def _place(location: Mapping[str, Any] | None) -> str:
    return f" {location['path']}:{location['line']}:{location['column']}" if location else ""
