"""The JSON Schemas (draft 2020-12) of the grader's output and of rubrics."""

from typing import Any

from grader.grading.schema import rubric_schema

_DRAFT = "https://json-schema.org/draft/2020-12/schema"
_TEXT: dict[str, Any] = {"type": "string"}
_NUMBER: dict[str, Any] = {"type": "number"}
_COUNT: dict[str, Any] = {"type": "integer", "minimum": 1}
_POINTS: dict[str, Any] = {"type": "number", "minimum": 0}
_TOTAL: dict[str, Any] = {"type": "integer", "minimum": 0}
_FLAG: dict[str, Any] = {"type": "boolean"}
_HASH: dict[str, Any] = {"type": "string", "pattern": "^[0-9a-f]{64}$"}


def _object(properties: dict[str, Any], optional: tuple[str, ...] = ()) -> dict[str, Any]:
    required = [name for name in properties if name not in optional]
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def _document(title: str, properties: dict[str, Any], optional: tuple[str, ...] = ()) -> dict[str, Any]:
    return {"$schema": _DRAFT, "title": f"grader {title}", **_object(properties, optional)}


def _array(items: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": items}


def _nullable(schema: dict[str, Any]) -> dict[str, Any]:
    return {"anyOf": [schema, {"type": "null"}]}


def _all(schema: dict[str, Any], names: str) -> dict[str, Any]:
    """Return properties of one type, from their names between spaces."""
    return dict.fromkeys(names.split(), schema)


_GRADER = _object({"version": _TEXT})
_RUBRIC = _object({**_all(_TEXT, "id title"), "sha256": _HASH})
_PLACE = {"path": _TEXT, **_all(_COUNT, "line column")}
_CALL = _object({"macro": _TEXT, "location": _object(_PLACE)})
_LOCATION = _object({**_PLACE, "calls": _array(_CALL)}, ("calls",))
_PROBLEM = _object(
    {
        "code": {"type": "string", "pattern": "^[A-Z]+[0-9]{3}$"},
        "severity": {"enum": ["error", "warning", "note"]},
        "message": _TEXT,
        "location": _LOCATION,
    }
)
_VALUE: dict[str, Any] = {"type": ["null", "boolean", "number", "string", "array", "object"]}
_EDIT = _object({**_PLACE, **_all(_TEXT, "old new renamed")}, ("renamed",))
_GAINS: dict[str, Any] = {"type": "object", "additionalProperties": _POINTS}
_ADJUSTMENT = _object({"action": {"enum": ["drop", "full"]}, "reason": _TEXT})
_RESULT = _object(
    {
        **_all(_TEXT, "id part title message feedback"),
        **_all(_POINTS, "points max_points"),
        **_all(_VALUE, "measured expected"),
        **_all(_nullable(_TEXT), "unit because carried"),
        "status": {"enum": ["passed", "failed", "skipped", "pending", "errored"]},
        "tolerance": _nullable(_POINTS),
        "location": _nullable(_LOCATION),
        "hints": _array(_object({"message": _TEXT, "edits": _array(_EDIT), "gains": _GAINS, "verified": _FLAG})),
        "mark": _object({"points": _POINTS, **_all(_TEXT, "by comment")}),
        "bonus": {"const": True},
        "adjustment": _ADJUSTMENT,
        "comment": _object(_all(_TEXT, "text by")),
    },
    optional=("mark", "bonus", "adjustment", "comment"),
)
_EXHIBIT = _object({**_all(_TEXT, "path heading"), "size": _TOTAL, **_all(_nullable(_COUNT), "width height page")})
_SUBMISSION = _object(
    {
        "id": _TEXT,
        **_all(_nullable(_TEXT), "path package"),
        "sha256": _nullable(_HASH),
        "passed_over": _array(_object(_all(_TEXT, "path because"))),
        "left_out": _array(_TEXT),
    }
)
REPORT_SCHEMA = _document(
    "report",
    {
        "schema": {"const": "grader/report/v1"},
        "grader": _GRADER,
        "rubric": _RUBRIC,
        "submission": _SUBMISSION,
        **_all(_array(_TEXT), "notes parts"),
        **_all(_POINTS, "score max_score pending"),
        "problems": _array(_PROBLEM),
        "results": _array(_RESULT),
        "evidence": _array(_object({**_all(_TEXT, "id part title"), **_all(_array(_EXHIBIT), "files perhaps")})),
        "other_pictures": _array(_EXHIBIT),
    },
)

_VECTOR = {**_array(_NUMBER), "minItems": 3, "maxItems": 3}
_ROW = {**_array(_NUMBER), "minItems": 4, "maxItems": 4}
_POSE = {**_array(_ROW), "minItems": 4, "maxItems": 4}
_JOINT = _object({**_all(_TEXT, "name type parent child"), "axis": _nullable(_VECTOR)})
_ROBOT = _object({"name": _TEXT, "root": _nullable(_TEXT), "links": _array(_TEXT), "joints": _array(_JOINT)})
INSPECT_SCHEMA = _document(
    "inspection",
    {
        "schema": {"const": "grader/inspect/v1"},
        "path": _TEXT,
        "verdict": {"enum": ["clean", "degraded", "rejected"]},
        "problems": _array(_PROBLEM),
        "robot": _nullable(_ROBOT),
        "relative_to": _nullable(_TEXT),
        "poses": {"type": "object", "additionalProperties": _nullable(_POSE)},
    },
)

_STATUSES = ("errored", "graded", "missing", "unreadable")
_CRITERION_STATISTICS = _object(
    {
        "id": _TEXT,
        "max_points": _POINTS,
        **_all(_TOTAL, "passed marked_by_hand carried failed skipped pending errored"),
        "share": _nullable(_POINTS),
        "discrimination": _nullable({"type": "number", "minimum": -1, "maximum": 1}),
        "bonus": {"const": True},
        "adjustment": _ADJUSTMENT,
    },
    optional=("bonus", "adjustment"),
)
_STATISTICS = _object(
    {
        "counts": _object(dict.fromkeys(_STATUSES, _COUNT), optional=_STATUSES),
        **_all(_TOTAL, "final_marks excused graded pending undecided"),
        "points": _object(_all(_POINTS, "earned lost pending")),
        "reasons": _array(_object({"reason": _TEXT, "count": _COUNT})),
        **_all(_POINTS, "max_score mean deviation lowest median highest"),
        "tenths": {**_array(_TOTAL), "minItems": 10, "maxItems": 10},
        "criteria": _array(_CRITERION_STATISTICS),
        "failures": _array(_object({**_all(_TEXT, "criterion message"), "count": _COUNT})),
    }
)
_FIX = _object(
    {"action": _TEXT, "count": _COUNT, "criteria": _array(_TEXT), "points": _POINTS, "example": _array(_EDIT)}
)
_STUDENT = _object(
    {
        **_all(_TEXT, "id name email reason"),
        "status": {"enum": ["graded", "unreadable", "errored", "missing"]},
        **_all(_nullable(_POINTS), "score max_score pending total"),
        "late": _object({"days": _TOTAL, "points": {"type": "number", "maximum": 0}, "because": _TEXT}),
        "final_mark": _nullable(_POINTS),
        **_all(_FLAG, "is_excused is_final"),
        **_all(_TOTAL, "marks_by_hand attempt"),
        **_all(_array(_TEXT), "paths earlier carried"),
    }
)
_DIFFERENCE = _object({**_all(_TEXT, "id criterion"), **_all(_POINTS, "first second max_points")})
_AGREEMENT = _object(
    {
        **_all(_TOTAL, "items same"),
        "mean_difference_percent": {"type": "number", "minimum": 0},
        "largest": _array(_DIFFERENCE),
    }
)
_GROUP = _object(
    {
        "name": _TEXT,
        **_all(_TOTAL, "students graded late"),
        "late_points": _POINTS,
        **_all(_nullable(_POINTS), "mean median"),
        "shares": {"type": "object", "additionalProperties": _nullable(_POINTS)},
    }
)
CLASS_SCHEMA = _document(
    "class",
    {
        "schema": {"const": "grader/class/v1"},
        "grader": _GRADER,
        "rubric": _RUBRIC,
        "run": _object(_all(_TOTAL, "total graded unchanged errored")),
        "statistics": _STATISTICS,
        "fixes": _array(_FIX),
        "identical": _array(_object({"students": _array(_TEXT), "same_file": _array(_array(_TEXT))})),
        "agreement": _AGREEMENT,
        "comparison": _object(
            {"by": {"enum": ["section", "marker"]}, "groups": _array(_GROUP), "differing": _array(_TEXT)}
        ),
        "needs_a_look": _TOTAL,
        "attention": _array(_object({"reason": _TEXT, "students": _array(_object({"id": _TEXT, "detail": _TEXT}))})),
        "evidence_without_urdf": _TOTAL,
        "late": _object({"count": _TOTAL, **_all(_POINTS, "lost least most")}),
        "students": _array(_STUDENT),
    },
    optional=("run", "comparison"),
)

_RUN = _object({"run": _COUNT, "started": _TEXT, "grader": _GRADER, "rubric": _object({"sha256": _HASH})})
_CHANGE = {"id": _TEXT, **_all(_nullable(_POINTS), "before after")}
DIFF_SCHEMA = _document(
    "diff",
    {
        "schema": {"const": "grader/diff/v1"},
        **_all(_RUN, "from to"),
        "students": _array(
            _object(
                {
                    **_CHANGE,
                    "name": _TEXT,
                    "because": _array(_TEXT),
                    "criteria": _array(_object(_CHANGE)),
                    "rubric": _array(_object({**_all(_TEXT, "id key"), **_all(_VALUE, "before after")})),
                }
            )
        ),
    },
)

_LOSS = _object({**_all(_TEXT, "name diff"), "criteria": {"type": "object", "additionalProperties": _TEXT}})
_SURVIVOR = _object({**_all(_TEXT, "id family path diff suggestion"), "line": _COUNT, "reason": _nullable(_TEXT)})
_MARGIN = _object(
    {
        "criterion": _TEXT,
        "unit": _nullable(_TEXT),
        **_all(_POINTS, "tolerance reference"),
        **_all(_nullable(_POINTS), "caught passed"),
        "is_near": _FLAG,
    }
)
RUBRIC_TEST_SCHEMA = _document(
    "rubric test",
    {
        "schema": {"const": "grader/rubric-test/v1"},
        "grader": _GRADER,
        "rubric": _RUBRIC,
        "seed": {"type": "integer"},
        "score": {"type": "number", "minimum": 0, "maximum": 100},
        "reference": _object({**_all(_POINTS, "score max_score pending"), "lost": _array(_TEXT)}),
        "equivalents": _object(
            {
                "tried": {"type": "object", "additionalProperties": _TOTAL},
                "unused": {"type": "object", "additionalProperties": _TEXT},
                "lost": _array(_LOSS),
            }
        ),
        "samples": _nullable(_object({**_all(_TOTAL, "tried skipped"), "different": _array(_LOSS)})),
        "mutants": _object(_all(_TOTAL, "total tried caught same_robot ignored survived")),
        **_all(_array(_SURVIVOR), "survivors ignored"),
        "faults": _array(_LOSS),
        **_all(_array(_TEXT), "unused_patterns idle"),
        "margins": _array(_MARGIN),
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
