"""A class as JSON, schema grader/class/v1."""

from typing import Any, NamedTuple

from grader import __version__
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.sections import SectionComparison
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.gradebook.summary import ClassSummary
from grader.classroom.run.progress import Progress
from grader.report.as_json import KINDS
from grader.report.json_data import (
    COUNT,
    EDIT,
    FLAG,
    GRADER,
    POINTS,
    RUBRIC,
    TEXT,
    TOTAL,
    Key,
    Many,
    Record,
    array,
    each,
    exact,
    inner,
    mapping,
    nullable,
    record,
    rounded,
    schema_key,
    to_json,
)

_STATUSES = ("errored", "graded", "missing", "unreadable")
_CRITERION = Record(
    {
        "id": (TEXT, "criterion.id"),
        "max_points": (POINTS, "criterion.points"),
        **inner("criterion", KINDS),
        **each(TOTAL, "passed manual_marks carried failed skipped pending errored"),
        "share": nullable(POINTS),
        "discrimination": nullable({"type": "number", "minimum": -1, "maximum": 1}),
    },
    optional=tuple(KINDS),
)
_STATISTICS = Record(
    {
        "counts": (
            record(dict.fromkeys(_STATUSES, COUNT), optional=_STATUSES),
            lambda statistics: dict(sorted(statistics.verdicts.items())),
        ),
        "max_score": (POINTS, "out_of"),
        "final_marks": (TOTAL, "final"),
        **each(TOTAL, "excused graded pending undecided"),
        "points": Record(each(POINTS, "earned lost pending")),
        "reasons": (
            array(record({"reason": TEXT, "count": COUNT})),
            lambda statistics: [{"reason": reason, "count": count} for reason, count in statistics.reasons],
        ),
        **each(POINTS, "mean deviation lowest median highest"),
        "tenths": ({**array(TOTAL), "minItems": 10, "maxItems": 10}, "bins"),
        "criteria": Many(_CRITERION),
        "failures": Many(Record({"criterion": (TEXT, "criterion.id"), "message": TEXT, "count": COUNT})),
    }
)
_FIX = Record({"action": TEXT, "count": COUNT, "criteria": array(TEXT), "points": POINTS, "example": Many(EDIT)})
_AGREEMENT = Record(
    {
        **each(TOTAL, "items same"),
        "mean_difference_percent": POINTS,
        "largest": Many(Record({"id": (TEXT, "key"), "criterion": TEXT, **each(POINTS, "first second max_points")})),
    }
)
_CHOICE = Record({"criterion": (TEXT, "criterion.id"), "text": TEXT, "points": {"type": "number"}, "students": TOTAL})
_IDENTICAL = Record({"students": array(TEXT), "same_file": array(array(TEXT)), "equal": TEXT})
_SECTION = Record(
    {
        "name": TEXT,
        **each(TOTAL, "students graded late"),
        "late_points": POINTS,
        **each(nullable(POINTS), "mean median"),
    }
)
_GROUP = record({**_SECTION.schema["properties"], "shares": mapping(nullable(POINTS))})
_COMPARISON = Record(
    {
        "by": {"enum": ["section", "marker"]},
        "groups": (array(_GROUP), lambda comparison: list(_groups(comparison))),
        "differing": (array(TEXT), lambda found: [found.criteria[position].id for position in found.differing]),
    }
)
_ATTENTION = Record({"reason": TEXT, "students": (Many(Record({"id": (TEXT, "key"), "detail": TEXT})), "items")})


class _Student(NamedTuple):
    grade: StudentGrade
    carried: list[str]


def _of_result(name: str) -> Key:
    """Return the key of points that only a student with a result has."""
    return nullable(POINTS), lambda one: exact(getattr(one.grade, name)) if one.grade.result is not None else None


def _total(student: _Student) -> int | float | None:
    grade = student.grade
    return exact(grade.total) if grade.result is not None or grade.final is not None else None


_STUDENT = Record(
    {
        "id": (TEXT, "grade.student.key"),
        **inner("grade.student", each(TEXT, "name email")),
        "status": ({"enum": ["graded", "unreadable", "errored", "missing"]}, "grade.verdict"),
        "reason": (TEXT, "grade.reason"),
        "score": _of_result("score"),
        "max_score": _of_result("out_of"),
        "pending": _of_result("pending"),
        "late": (Record({"days": TOTAL, "points": {"type": "number", "maximum": 0}, "reason": TEXT}), "grade.late"),
        "total": (nullable(POINTS), _total),
        "final_mark": (nullable(POINTS), "grade.final"),
        "is_excused": (FLAG, "grade.is_excused"),
        "is_final": (FLAG, lambda student: not student.grade.why_not_final),
        "carried": array(TEXT),
        "manual_marks": (TOTAL, "grade.marks"),
        **inner("grade.files", {"paths": array(TEXT), "attempt": TOTAL, "earlier": array(TEXT)}),
    }
)


class ClassReport(NamedTuple):
    """What is said of a class. `run` counts what a batch has just done, `comparison` is of sections."""

    summary: ClassSummary
    grades: Grades
    run: Progress | None = None
    comparison: SectionComparison | None = None

    @property
    def students(self) -> list[_Student]:
        """All students."""
        return [_Student(grade, self.grades.carried(grade)) for grade in self.grades.all()]


CLASS = Record(
    {
        **schema_key("grader/class/v1"),
        "grader": (GRADER, lambda _: {"version": __version__}),
        "rubric": (RUBRIC, "summary.rubric"),
        "run": Record(each(TOTAL, "total graded unchanged errored")),
        "statistics": (_STATISTICS, "summary.statistics"),
        "fixes": (Many(_FIX), "summary.fixes"),
        "identical": (Many(_IDENTICAL), "summary.identical"),
        "agreement": (_AGREEMENT, "summary.agreement"),
        "choices": (Many(_CHOICE), "summary.choices"),
        "comparison": _COMPARISON,
        "needs_attention": (TOTAL, "summary.attention.total"),
        "attention": (Many(_ATTENTION), "summary.attention.groups"),
        "evidence_without_urdf": (TOTAL, lambda report: report.summary.evidence_only["URDF"]),
        "evidence_without_package": (TOTAL, lambda report: report.summary.evidence_only["package"]),
        "late": (Record({"count": (TOTAL, "students"), **each(POINTS, "lost least most")}), "summary.late"),
        "students": Many(_STUDENT),
    },
    optional=("run", "comparison"),
)


def render_class_json(report: ClassReport) -> str:
    """Return the statistics and all current grades."""
    return to_json(CLASS.data(report))


def _groups(comparison: SectionComparison) -> Any:
    """Yield the sections, each with its share of the points of each criterion."""
    for section in comparison.sections:
        shares = zip(comparison.criteria, section.shares, strict=True)
        yield {**_SECTION.data(section), "shares": {row.id: rounded(share) for row, share in shares}}
