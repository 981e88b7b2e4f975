"""A class as JSON, schema grader/class/v1.

The changes between two runs have the schema grader/diff/v1.
"""

from collections.abc import Sequence
from decimal import Decimal
from functools import partial
from operator import itemgetter
from types import SimpleNamespace

from grader import __version__
from grader.classroom.gradebook.grade_changes import Change, why_open
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.statistics import COUNTS, CriterionFigures, statistics
from grader.classroom.results.results import Run
from grader.lab.rubric.criterion import GRADE
from grader.report.json_data import (
    COUNT,
    FLAG,
    GRADER,
    HASH,
    POINTS,
    RUBRIC,
    TEXT,
    TOTAL,
    JsonObject,
    Key,
    Many,
    array,
    each,
    exact,
    inner,
    mapping,
    nullable,
    object_schema,
    schema_key,
    to_json,
)
from grader.workers.queue import Progress

_STATUSES = ("errored", "excused", "graded", "missing", "unreadable")
_SUMMARY = JsonObject({"students": TOTAL, **each(nullable(POINTS), "mean median")})
_NO_GRADES = {**dict.fromkeys(_SUMMARY.keys), "students": 0}
_MISTAKE = JsonObject({**each(TEXT, "criterion message"), "students": array(TEXT)})
_EQUAL = JsonObject({"students": array(TEXT), "equal": TEXT})
_CONCERN = JsonObject({"id": (TEXT, itemgetter(0)), "detail": (TEXT, itemgetter(1))})
_ATTENTION = JsonObject(
    {"reason": (TEXT, itemgetter(0)), "students": (Many(_CONCERN), itemgetter(1))}
)
_RUN = JsonObject(
    {
        "run": COUNT,
        "time": TEXT,
        "grader": (GRADER, lambda run: {"version": run.version}),
        "rubric": (object_schema({"sha256": HASH}), lambda run: {"sha256": run.rubric}),
        "max_score": (
            nullable(POINTS),
            lambda run: exact(Decimal(run.maximum)) if run.maximum else None,
        ),
        "deadline": (TEXT, "due"),
    }
)
_SPAN = each(nullable(POINTS), "before after")
_STEP = JsonObject({"id": TEXT, **_SPAN})
_PENALTY = {"type": "number", "maximum": 0}
_RECORDED = JsonObject(
    {
        "not_final_because": (TEXT, why_open),
        "late_days": (TOTAL, "days_late"),
        "late_points": (_PENALTY, lambda grade: exact(Decimal(grade.penalty or 0))),
        "deadline": TEXT,
    }
)


def _count(name: str, row: CriterionFigures) -> int:
    return row.counts[name]


_CRITERION = JsonObject(
    {
        "id": (TEXT, "criterion.id"),
        "max_points": (POINTS, "criterion.points"),
        **{name: (TOTAL, partial(_count, name)) for name in COUNTS},
        "share": nullable(POINTS),
    }
)
_STATISTICS = JsonObject(
    {
        "counts": (object_schema(dict.fromkeys(_STATUSES, COUNT), optional=_STATUSES), "statuses"),
        "grades": (
            _SUMMARY.schema,
            lambda figures: _SUMMARY.data(figures.all) if figures.all else _NO_GRADES,
        ),
        **each(TOTAL, "open late"),
        "tenths": (array(TOTAL), lambda figures: [len(keys) for keys in figures.tenths]),
        "criteria": Many(_CRITERION),
        "mistakes": (Many(_MISTAKE), "common_mistakes"),
        "sections": (
            mapping(_SUMMARY.schema),
            lambda figures: {name: _SUMMARY.data(one) for name, one in figures.sections.items()},
        ),
    }
)


def _report_points(name: str) -> Key:
    """Return the key of points that only a student with a graded submission has."""
    return nullable(
        POINTS
    ), lambda one: exact(getattr(one.report, name)) if one.stored is not None else None


_STUDENT = JsonObject(
    {
        "id": (TEXT, "student.key"),
        **inner("student", each(TEXT, "name email section")),
        "status": {"enum": list(_STATUSES)},
        "reason": (TEXT, lambda one: one.stored.reason if one.stored is not None else ""),
        "score": _report_points("score"),
        "max_score": _report_points("max_score"),
        "pending": (POINTS, "pending"),
        "late": JsonObject({"days": TOTAL, "points": _PENALTY, "reason": TEXT}),
        GRADE: (nullable(POINTS), "shown_total"),
        "final_mark": (nullable(POINTS), "final_points"),
        "is_excused": FLAG,
        "not_final_because": (TEXT, "why_open"),
        "carried": (
            array(TEXT),
            lambda one: [row.criterion.id for row in one.results if row.carried],
        ),
        "manual_marks": (
            TOTAL,
            lambda one: sum(row.manual_mark is not None for row in one.results),
        ),
        "marked_before": (array(TEXT), "older"),
        "paths": (
            array(TEXT),
            lambda one: list(one.stored.paths) if one.stored is not None else [],
        ),
        "submission": (TEXT, lambda one: one.stored.digest if one.stored is not None else ""),
    }
)


CLASS = JsonObject(
    {
        **schema_key("grader/class/v1"),
        "grader": (GRADER, lambda _: {"version": __version__}),
        "rubric": (RUBRIC, "statistics.rubric"),
        "run": JsonObject(each(TOTAL, "total graded unchanged errored")),
        "max_score": (POINTS, "statistics.maximum"),
        "statistics": _STATISTICS,
        "equal": (Many(_EQUAL), "statistics.equal"),
        "attention": (Many(_ATTENTION), lambda report: report.statistics.attention.items()),
        "ignored_marks": (array(TEXT), "book.marks.ignored"),
        "students": Many(_STUDENT),
    },
    optional=("run",),
)


def render_class_json(book: Gradebook, done: Progress | None = None) -> str:
    """Return the statistics and all current grades."""
    students = list(book)
    report = SimpleNamespace(
        book=book, statistics=statistics(book, students), students=students, run=done
    )
    return to_json(CLASS.data(report))


_CHANGE = JsonObject(
    {
        "id": (TEXT, "key"),
        "name": TEXT,
        **_SPAN,
        "from": (_RECORDED, "old"),
        "to": (_RECORDED, "new"),
        "reasons": (array(TEXT), "why"),
        "criteria": Many(_STEP),
    }
)
DIFF = JsonObject(  # of the two runs, and the changes
    {
        **schema_key("grader/diff/v1"),
        "from": (_RUN, itemgetter(0)),
        "to": (_RUN, itemgetter(1)),
        "students": (Many(_CHANGE), itemgetter(2)),
    }
)


def render_changes_json(changes: Sequence[Change], runs: tuple[Run, Run]) -> str:
    """Return the changes as JSON, schema grader/diff/v1."""
    return to_json(DIFF.data((*runs, changes)))
