"""The JSON Schemas (draft 2020-12) of a class and of the changes between two runs."""

from grader.report.json_data import (
    ADJUSTMENT,
    COUNT,
    EDIT,
    FLAG,
    GRADER,
    HASH,
    POINTS,
    RUBRIC,
    TEXT,
    TOTAL,
    VALUE,
    Record,
    array,
    each,
    nullable,
    record,
    schema_key,
)

COUNTS = "passed manual_marks carried failed skipped pending errored"  # of the results of a criterion
_STATUSES = ("errored", "graded", "missing", "unreadable")
_CRITERION_STATISTICS = record(
    {
        "id": TEXT,
        "max_points": POINTS,
        **each(TOTAL, COUNTS),
        "share": nullable(POINTS),
        "discrimination": nullable({"type": "number", "minimum": -1, "maximum": 1}),
        "bonus": {"const": True},
        "adjustment": ADJUSTMENT.schema,
    },
    optional=("bonus", "adjustment"),
)
_STATISTICS = record(
    {
        "counts": record(dict.fromkeys(_STATUSES, COUNT), optional=_STATUSES),
        **each(TOTAL, "final_marks excused graded pending undecided"),
        "points": record(each(POINTS, "earned lost pending")),
        "reasons": array(record({"reason": TEXT, "count": COUNT})),
        **each(POINTS, "max_score mean deviation lowest median highest"),
        "tenths": {**array(TOTAL), "minItems": 10, "maxItems": 10},
        "criteria": array(_CRITERION_STATISTICS),
        "failures": array(record({**each(TEXT, "criterion message"), "count": COUNT})),
    }
)
_FIX = record(
    {"action": TEXT, "count": COUNT, "criteria": array(TEXT), "points": POINTS, "example": array(EDIT.schema)}
)
_STUDENT = record(
    {
        **each(TEXT, "id name email reason"),
        "status": {"enum": ["graded", "unreadable", "errored", "missing"]},
        **each(nullable(POINTS), "score max_score pending total"),
        "late": record({"days": TOTAL, "points": {"type": "number", "maximum": 0}, "reason": TEXT}),
        "final_mark": nullable(POINTS),
        **each(FLAG, "is_excused is_final"),
        **each(TOTAL, "manual_marks attempt"),
        **each(array(TEXT), "paths earlier carried"),
    }
)
_DIFFERENCE = record({**each(TEXT, "id criterion"), **each(POINTS, "first second max_points")})
_AGREEMENT = record(
    {
        **each(TOTAL, "items same"),
        "mean_difference_percent": {"type": "number", "minimum": 0},
        "largest": array(_DIFFERENCE),
    }
)
_GROUP = record(
    {
        "name": TEXT,
        **each(TOTAL, "students graded late"),
        "late_points": POINTS,
        **each(nullable(POINTS), "mean median"),
        "shares": {"type": "object", "additionalProperties": nullable(POINTS)},
    }
)
CLASS = Record(
    {
        **schema_key("grader/class/v1"),
        "grader": GRADER,
        "rubric": RUBRIC.schema,
        "run": record(each(TOTAL, "total graded unchanged errored")),
        "statistics": _STATISTICS,
        "fixes": array(_FIX),
        "identical": array(record({"students": array(TEXT), "same_file": array(array(TEXT))})),
        "agreement": _AGREEMENT,
        "comparison": record(
            {"by": {"enum": ["section", "marker"]}, "groups": array(_GROUP), "differing": array(TEXT)}
        ),
        "needs_attention": TOTAL,
        "attention": array(record({"reason": TEXT, "students": array(record({"id": TEXT, "detail": TEXT}))})),
        "evidence_without_urdf": TOTAL,
        "evidence_without_package": TOTAL,
        "late": record({"count": TOTAL, **each(POINTS, "lost least most")}),
        "students": array(_STUDENT),
    },
    optional=("run", "comparison"),
)

_RUN = record({"run": COUNT, "started": TEXT, "grader": GRADER, "rubric": record({"sha256": HASH})})
_CHANGE = {"id": TEXT, **each(nullable(POINTS), "before after")}
DIFF = Record(
    {
        **schema_key("grader/diff/v1"),
        **each(_RUN, "from to"),
        "students": array(
            record(
                {
                    **_CHANGE,
                    "name": TEXT,
                    "reasons": array(TEXT),
                    "criteria": array(record(_CHANGE)),
                    "rubric": array(record({**each(TEXT, "id key"), **each(VALUE, "before after")})),
                }
            )
        ),
    }
)
