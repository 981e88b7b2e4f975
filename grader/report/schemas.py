"""The JSON Schemas (draft 2020-12) of the grader's output and of rubrics."""

from typing import Any

from grader.grading.keys import rubric_schema

_DRAFT = "https://json-schema.org/draft/2020-12/schema"
_TEXT: dict[str, Any] = {"type": "string"}
_NUMBER: dict[str, Any] = {"type": "number"}
_COUNT: dict[str, Any] = {"type": "integer", "minimum": 1}
_POINTS: dict[str, Any] = {"type": "number", "minimum": 0}
_HASH: dict[str, Any] = {"type": "string", "pattern": "^[0-9a-f]{64}$"}


def _object(properties: dict[str, Any], optional: tuple[str, ...] = ()) -> dict[str, Any]:
    required = [name for name in properties if name not in optional]
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def _array(items: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": items}


def _nullable(schema: dict[str, Any]) -> dict[str, Any]:
    return {"anyOf": [schema, {"type": "null"}]}


_LOCATION = _object({"path": _TEXT, "line": _COUNT, "column": _COUNT})
_PROBLEM = _object(
    {
        "code": {"type": "string", "pattern": "^[A-Z]+[0-9]{3}$"},
        "severity": {"enum": ["error", "warning", "note"]},
        "message": _TEXT,
        "location": _LOCATION,
    }
)
_VALUE: dict[str, Any] = {"type": ["null", "boolean", "number", "string", "array", "object"]}
_RESULT = _object(
    {
        "id": _TEXT,
        "part": _TEXT,
        "title": _TEXT,
        "status": {"enum": ["passed", "failed", "skipped", "pending", "errored"]},
        "points": _POINTS,
        "max_points": _POINTS,
        "message": _TEXT,
        "measured": _VALUE,
        "expected": _VALUE,
        "tolerance": _nullable(_POINTS),
        "unit": _nullable(_TEXT),
        "because": _nullable(_TEXT),
        "location": _nullable(_LOCATION),
        "feedback": _TEXT,
        "hints": _array(_object({"message": _TEXT, "edit": {"type": "object"}, "verified": {"type": "boolean"}})),
        "mark": _object({"points": _POINTS, "by": _TEXT, "comment": _TEXT}),
    },
    optional=("mark",),
)
_EXHIBIT = _object(
    {"path": _TEXT, "size": {"type": "integer", "minimum": 0}, "width": _nullable(_COUNT), "height": _nullable(_COUNT)}
)

REPORT_SCHEMA: dict[str, Any] = {
    "$schema": _DRAFT,
    "title": "grader report",
    **_object(
        {
            "schema": {"const": "grader/report/v1"},
            "grader": _object({"version": _TEXT}),
            "rubric": _object({"id": _TEXT, "title": _TEXT, "sha256": _HASH}),
            "submission": _object(
                {
                    "id": _TEXT,
                    "path": _nullable(_TEXT),
                    "sha256": _nullable(_HASH),
                    "package": _nullable(_TEXT),
                    "passed_over": _array(_object({"path": _TEXT, "because": _TEXT})),
                    "left_out": _array(_TEXT),
                }
            ),
            "notes": _array(_TEXT),
            "parts": _array(_TEXT),
            "score": _POINTS,
            "max_score": _POINTS,
            "pending": _POINTS,
            "problems": _array(_PROBLEM),
            "results": _array(_RESULT),
            "evidence": _array(_object({"id": _TEXT, "part": _TEXT, "title": _TEXT, "files": _array(_EXHIBIT)})),
            "other_pictures": _array(_EXHIBIT),
        }
    ),
}

_VECTOR = {**_array(_NUMBER), "minItems": 3, "maxItems": 3}
_ROW = {**_array(_NUMBER), "minItems": 4, "maxItems": 4}
_JOINT = _object({"name": _TEXT, "type": _TEXT, "parent": _TEXT, "child": _TEXT, "axis": _nullable(_VECTOR)})

INSPECT_SCHEMA: dict[str, Any] = {
    "$schema": _DRAFT,
    "title": "grader inspection",
    **_object(
        {
            "schema": {"const": "grader/inspect/v1"},
            "path": _TEXT,
            "verdict": {"enum": ["clean", "degraded", "rejected"]},
            "problems": _array(_PROBLEM),
            "robot": _nullable(
                _object({"name": _TEXT, "root": _nullable(_TEXT), "links": _array(_TEXT), "joints": _array(_JOINT)})
            ),
            "relative_to": _nullable(_TEXT),
            "poses": {
                "type": "object",
                "additionalProperties": _nullable({**_array(_ROW), "minItems": 4, "maxItems": 4}),
            },
        }
    ),
}


_TOTAL: dict[str, Any] = {"type": "integer", "minimum": 0}
_DEDUCTION: dict[str, Any] = {"type": "number", "maximum": 0}
_GRADER = _object({"version": _TEXT})
_CRITERION_STATISTICS = _object(
    {
        "id": _TEXT,
        "max_points": _POINTS,
        "passed": _TOTAL,
        "marked_by_hand": _TOTAL,
        "failed": _TOTAL,
        "skipped": _TOTAL,
        "pending": _TOTAL,
        "errored": _TOTAL,
        "share": _nullable({"type": "number", "minimum": 0}),
        "discrimination": _nullable({"type": "number", "minimum": -1, "maximum": 1}),
    }
)
_STATISTICS = _object(
    {
        "counts": _object(
            {"errored": _COUNT, "graded": _COUNT, "missing": _COUNT, "unreadable": _COUNT},
            optional=("errored", "graded", "missing", "unreadable"),
        ),
        "max_score": _POINTS,
        "graded": _TOTAL,
        "pending": _TOTAL,
        "mean": _POINTS,
        "deviation": _POINTS,
        "lowest": _POINTS,
        "median": _POINTS,
        "highest": _POINTS,
        "tenths": {**_array(_TOTAL), "minItems": 10, "maxItems": 10},
        "criteria": _array(_CRITERION_STATISTICS),
        "failures": _array(_object({"criterion": _TEXT, "message": _TEXT, "count": _COUNT})),
    }
)
_STUDENT = _object(
    {
        "id": _TEXT,
        "name": _TEXT,
        "email": _TEXT,
        "status": {"enum": ["graded", "unreadable", "errored", "missing"]},
        "reason": _TEXT,
        "score": _nullable(_POINTS),
        "max_score": _nullable(_POINTS),
        "pending": _nullable(_POINTS),
        "late": _object({"days": _TOTAL, "points": _DEDUCTION, "because": _TEXT}),
        "total": _nullable(_POINTS),
        "is_final": {"type": "boolean"},
        "marks_by_hand": _TOTAL,
        "paths": _array(_TEXT),
        "attempt": _TOTAL,
        "earlier": _array(_TEXT),
    }
)

CLASS_SCHEMA: dict[str, Any] = {
    "$schema": _DRAFT,
    "title": "grader class",
    **_object(
        {
            "schema": {"const": "grader/class/v1"},
            "grader": _GRADER,
            "rubric": _object({"id": _TEXT, "title": _TEXT, "sha256": _HASH}),
            "run": _object({"total": _TOTAL, "graded": _TOTAL, "unchanged": _TOTAL, "errored": _TOTAL}),
            "statistics": _STATISTICS,
            "needs_a_look": _TOTAL,
            "students": _array(_STUDENT),
        },
        optional=("run",),
    ),
}

_RUN = _object({"run": _COUNT, "started": _TEXT, "grader": _GRADER, "rubric": _object({"sha256": _HASH})})
_CHANGE: dict[str, Any] = {"id": _TEXT, "before": _nullable(_POINTS), "after": _nullable(_POINTS)}

DIFF_SCHEMA: dict[str, Any] = {
    "$schema": _DRAFT,
    "title": "grader diff",
    **_object(
        {
            "schema": {"const": "grader/diff/v1"},
            "from": _RUN,
            "to": _RUN,
            "students": _array(_object({**_CHANGE, "because": _array(_TEXT), "criteria": _array(_object(_CHANGE))})),
        }
    ),
}


def json_schema(name: str) -> dict[str, Any]:
    """Return the schema of a report, rubric, inspection, class or diff."""
    if name == "rubric":
        return rubric_schema()
    return {"report": REPORT_SCHEMA, "inspect": INSPECT_SCHEMA, "class": CLASS_SCHEMA, "diff": DIFF_SCHEMA}[name]
