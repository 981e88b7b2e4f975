"""A report as JSON, schema grader/report/v1.

It has its objects, from which `grader schema report` follows.
"""

from functools import cache
from typing import Any, get_args

from grader.base.extents import ended
from grader.base.source import Certainty
from grader.lab.grading.report import Hint, Report, Result
from grader.report.json_data import (
    ADJUSTMENT,
    COUNT,
    EDIT,
    FLAG,
    GRADER,
    HASH,
    NUMBER,
    POINTS,
    RUBRIC,
    TEXT,
    TOTAL,
    VALUE,
    JsonObject,
    KeyType,
    Many,
    Maybe,
    array,
    each,
    inner,
    mapping,
    nullable,
    rounded,
    schema_key,
    to_json,
)
from grader.report.writers.problem_json import LOCATION, PROBLEM, problems_with_ends

_CERTAINTY = {"enum": list(get_args(Certainty))}
_HINT = JsonObject(
    {
        "message": TEXT,
        "edits": Many(EDIT),
        "gains": mapping(POINTS),
        "verified": (FLAG, lambda _: True),
        "certainty": _CERTAINTY,
        "after": array(TEXT),
    },
    ("after",),
)
_KINDS: dict[str, KeyType] = {
    "bonus": {"const": True},
    "adjustment": ADJUSTMENT,
}  # absent of most criteria
# the keys that few criteria have: those of the rubric, a manual mark, a comment without points
ADDITIONS = JsonObject(
    {
        **inner("criterion", _KINDS),
        "mark": (JsonObject({"points": POINTS, **each(TEXT, "by comment")}), "manual_mark"),
        "comment": JsonObject(each(TEXT, "text by")),
    },
    (*_KINDS, "mark", "comment"),
)


def _expectation(result: Result) -> Any:
    return result.criterion.answer or rounded(result.outcome.expected)


def _feedback(result: Result) -> str:
    is_failed = result.outcome.status == "failed" and not result.why_given
    return result.criterion.feedback_on(result.outcome) if is_failed else ""


def _hints(result: Result) -> list[Hint]:
    if result.hint:
        return [result.hint]
    return []


_RESULT = JsonObject(
    {
        **inner("criterion", each(TEXT, "id part title")),
        "status": (
            {"enum": ["passed", "failed", "skipped", "pending", "errored"]},
            "outcome.status",
        ),
        "points": POINTS,
        "max_points": (POINTS, "criterion.points"),
        **inner("outcome", {"message": TEXT, "measured": VALUE}),
        "expected": (VALUE, _expectation),
        **inner("outcome", {"tolerance": nullable(POINTS), "unit": nullable(TEXT)}),
        "because": nullable(TEXT),
        "carried": (nullable(TEXT), lambda result: result.carried or None),
        "location": (Maybe(LOCATION), "outcome.location"),
        "feedback": (TEXT, _feedback),
        "hints": (Many(_HINT), _hints),
        **ADDITIONS.keys,
    },
    ADDITIONS.optional,
)
_EXHIBIT = JsonObject({"path": TEXT, "size": TOTAL, "heading": TEXT, "page": nullable(COUNT)})


def _package(submission: Any) -> str | None:
    package = submission.package
    return package and (package.folder or ".")  # "." is the submission itself


_SUBMISSION = JsonObject(
    {
        "id": TEXT,
        "path": nullable(TEXT),
        "sha256": nullable(HASH),
        "package": (nullable(TEXT), _package),
        "other_candidates": (Many(JsonObject(each(TEXT, "path reason"))), "unused_candidates"),
        "ignored": array(TEXT),
    }
)
SCORE = each(POINTS, "score max_score pending")
_GRADE = JsonObject({"points": nullable(POINTS), "late": NUMBER, "final": (FLAG, "is_final")})
# Of a student in a class, if a person or lateness changes the score.
_OF_CLASS = JsonObject({"grade": _GRADE}, ("grade",))
_EVIDENCE = JsonObject(
    {**inner("evidence", each(TEXT, "id part title")), **each(Many(_EXHIBIT), "files possible")}
)
REPORT = JsonObject(
    {
        **schema_key("grader/report/v1"),
        "grader": (GRADER, lambda report: {"version": report.version}),
        "rubric": RUBRIC,
        "submission": _SUBMISSION,
        "notes": (array(TEXT), "all_notes"),
        "parts": array(TEXT),
        **SCORE,
        **_OF_CLASS.keys,
        "problems": Many(PROBLEM),
        "results": Many(_RESULT),
        "evidence": (Many(_EVIDENCE), "evidence"),
        "other_pictures": Many(_EXHIBIT),
    },
    _OF_CLASS.optional,
)


def render_json(report: Report) -> str:
    """Return the report.

    It has no clock, absolute path or random order: the same input gives the same bytes.
    """
    return to_json(REPORT.data(_with_ends(report)))


def _with_ends(report: Report) -> Report:
    """Return a report whose locations have their ends."""
    source_of = cache(report.submission.source)  # reads each file once
    results = []
    for result in report.results:
        at = result.outcome.location
        if at:
            at = ended(at, source_of)
        results.append(result._replace(outcome=result.outcome._replace(location=at)))
    return report._replace(
        results=tuple(results), problems=problems_with_ends(report.problems, source_of)
    )
