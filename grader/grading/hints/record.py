"""Hints as JSON text, which a gradebook stores, and back.

The graded URDF is stored without its path, so that two submissions whose files differ only in their names have the same
hints.
"""

import json
from collections.abc import Sequence
from decimal import Decimal
from typing import Any

from grader.grading.report import Hint, Report
from grader.source import Edit, Edits, Location

NO_HINTS = '{"hints":[],"complete":false}'  # of a search that failed
_MAIN = ""  # the path of the graded URDF


def hints_to_record(report: Report) -> str:
    """Return the hints of a report as JSON text, each with the criteria whose results have it."""
    criteria: dict[str, list[str]] = {}
    hints: dict[str, Hint] = {}
    for result in report.results:
        if result.hint is not None:
            hints[result.hint.shown_by] = result.hint
            criteria.setdefault(result.hint.shown_by, []).append(result.criterion.id)
    stored = [_data_of(hint, criteria[name], report.submission.path) for name, hint in hints.items()]
    return json.dumps({"hints": stored, "complete": report.hints_complete}, separators=(",", ":"))


def hints_from_record(text: str) -> tuple[Hint, ...]:
    """Return stored hints; the path of the graded URDF is empty."""
    return tuple(map(_hint, json.loads(text)["hints"]))


def own_edits(hint: Hint, others: Sequence[Hint]) -> Edits:
    """Return the edits of a hint that are not those of another one of the submission, which it includes."""
    mine = set(hint.edits)
    earlier = {edit for other in others if mine > set(other.edits) for edit in other.edits}
    return tuple(edit for edit in hint.edits if edit not in earlier)


def add_stored_hints(report: Report, text: str) -> Report:
    """Return a report with its stored hints, up to the level that the rubric allows."""
    level, main = report.rubric.hints, report.submission.path or ""
    if level == "none":
        return report
    record = json.loads(text)
    hints: dict[str, Hint] = {}
    for stored in record["hints"]:
        hint = _hint(stored)
        is_shown = level == "edit"
        edits = tuple(_with_path(edit, main) for edit in hint.edits) if is_shown else ()
        at = hint.at._replace(path=hint.at.path or main)
        hints |= dict.fromkeys(stored["criteria"], hint._replace(at=at, edits=edits, action=hint.action * is_shown))
    results = tuple(result._replace(hint=hints.get(result.criterion.id)) for result in report.results)
    return report._replace(results=results, hints_complete=record["complete"])


def _with_path(edit: Edit, main: str) -> Edit:
    return edit if edit.path != _MAIN else edit._replace(path=main)


def _data_of(hint: Hint, criteria: list[str], main: str | None) -> dict[str, Any]:
    return {
        **hint._asdict(),
        "at": (_MAIN if hint.at.path == main else hint.at.path, hint.at.line, hint.at.column),
        "gains": {name: str(points) for name, points in hint.gains.items()},
        "edits": [edit._replace(path=_MAIN) if edit.path == main else edit for edit in hint.edits],
        "criteria": criteria,
    }


def _hint(stored: dict[str, Any]) -> Hint:
    return Hint(
        stored["message"],
        Location(*stored["at"]),
        {name: Decimal(points) for name, points in stored["gains"].items()},
        tuple(Edit(*edit) for edit in stored["edits"]),
        stored["action"],
        stored["shown_by"],
        stored.get("certainty", "preferred"),  # of a version that did not store it
    )
