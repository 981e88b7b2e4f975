"""The JSON Schemas (draft 2020-12) of the grader's output and of rubrics."""

from typing import Any

from grader.grading.schema import rubric_schema
from grader.report.class_schemas import (
    ADJUSTMENT,
    CLASS_SCHEMA,
    COUNT,
    DIFF_SCHEMA,
    EDIT,
    FLAG,
    GRADER,
    HASH,
    NUMBER,
    PLACE,
    POINTS,
    RUBRIC,
    TEXT,
    TOTAL,
    VALUE,
    array,
    document,
    each,
    nullable,
    record,
)

_CALL = record({"macro": TEXT, "location": record(PLACE)})
_LOCATION = record({**PLACE, "calls": array(_CALL)}, ("calls",))
_PROBLEM = record(
    {
        "code": {"type": "string", "pattern": "^[A-Z]+[0-9]{3}$"},
        "severity": {"enum": ["error", "warning", "note"]},
        "message": TEXT,
        "location": _LOCATION,
    }
)
_GAINS: dict[str, Any] = {"type": "object", "additionalProperties": POINTS}
_RESULT = record(
    {
        **each(TEXT, "id part title message feedback"),
        **each(POINTS, "points max_points"),
        **each(VALUE, "measured expected"),
        **each(nullable(TEXT), "unit because carried"),
        "status": {"enum": ["passed", "failed", "skipped", "pending", "errored"]},
        "tolerance": nullable(POINTS),
        "location": nullable(_LOCATION),
        "hints": array(record({"message": TEXT, "edits": array(EDIT), "gains": _GAINS, "verified": FLAG})),
        "mark": record({"points": POINTS, **each(TEXT, "by comment")}),
        "bonus": {"const": True},
        "adjustment": ADJUSTMENT,
        "comment": record(each(TEXT, "text by")),
    },
    optional=("mark", "bonus", "adjustment", "comment"),
)
_EXHIBIT = record({**each(TEXT, "path heading"), "size": TOTAL, **each(nullable(COUNT), "width height page")})
_SUBMISSION = record(
    {
        "id": TEXT,
        **each(nullable(TEXT), "path package"),
        "sha256": nullable(HASH),
        "other_candidates": array(record(each(TEXT, "path reason"))),
        "ignored": array(TEXT),
    }
)
REPORT_SCHEMA = document(
    "report",
    {
        "schema": {"const": "grader/report/v1"},
        "grader": GRADER,
        "rubric": RUBRIC,
        "submission": _SUBMISSION,
        **each(array(TEXT), "notes parts"),
        **each(POINTS, "score max_score pending"),
        "grade": record({"points": nullable(POINTS), "late": NUMBER, "final": FLAG}),
        "problems": array(_PROBLEM),
        "results": array(_RESULT),
        "evidence": array(record({**each(TEXT, "id part title"), **each(array(_EXHIBIT), "files possible")})),
        "other_pictures": array(_EXHIBIT),
    },
    optional=("grade",),
)

_VECTOR = {**array(NUMBER), "minItems": 3, "maxItems": 3}
_ROW = {**array(NUMBER), "minItems": 4, "maxItems": 4}
_POSE = {**array(_ROW), "minItems": 4, "maxItems": 4}
_JOINT = record({**each(TEXT, "name type parent child"), "axis": nullable(_VECTOR)})
_ROBOT = record({"name": TEXT, "root": nullable(TEXT), "links": array(TEXT), "joints": array(_JOINT)})
INSPECT_SCHEMA = document(
    "inspection",
    {
        "schema": {"const": "grader/inspect/v1"},
        "path": TEXT,
        "verdict": {"enum": ["clean", "degraded", "rejected"]},
        "problems": array(_PROBLEM),
        "robot": nullable(_ROBOT),
        "relative_to": nullable(TEXT),
        "poses": {"type": "object", "additionalProperties": nullable(_POSE)},
    },
)

_LOSS = record({**each(TEXT, "name diff"), "criteria": {"type": "object", "additionalProperties": TEXT}})
_SURVIVOR = record({**each(TEXT, "id family path diff suggestion"), "line": COUNT, "reason": nullable(TEXT)})
_MARGIN = record(
    {
        "criterion": TEXT,
        "unit": nullable(TEXT),
        **each(POINTS, "tolerance reference"),
        "is_near": FLAG,
    }
)
RUBRIC_TEST_SCHEMA = document(
    "rubric test",
    {
        "schema": {"const": "grader/rubric-test/v1"},
        "grader": GRADER,
        "rubric": RUBRIC,
        "seed": {"type": "integer"},
        "score": {"type": "number", "minimum": 0, "maximum": 100},
        "reference": record({**each(POINTS, "score max_score pending"), "lost": array(TEXT)}),
        "equivalents": record(
            {
                "tried": {"type": "object", "additionalProperties": TOTAL},
                "unused": {"type": "object", "additionalProperties": TEXT},
                "lost": array(_LOSS),
            }
        ),
        "samples": nullable(record({**each(TOTAL, "tried skipped"), "different": array(_LOSS)})),
        "mutants": record(each(TOTAL, "total tried caught same_robot ignored survived")),
        **each(array(_SURVIVOR), "survivors ignored"),
        "faults": array(_LOSS),
        **each(array(TEXT), "unused_patterns idle"),
        "margins": array(_MARGIN),
    },
)


def json_schema(name: str) -> dict[str, Any]:
    """Return the schema of a report, rubric, inspection, class, diff or rubric test."""
    if name == "rubric":
        return rubric_schema()
    return {
        "report": REPORT_SCHEMA,
        "inspect": INSPECT_SCHEMA,
        "class": CLASS_SCHEMA,
        "diff": DIFF_SCHEMA,
        "rubric-test": RUBRIC_TEST_SCHEMA,
    }[name]
