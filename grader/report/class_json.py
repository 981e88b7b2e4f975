"""A class as JSON, schema grader/class/v1."""

from typing import Any

from grader import __version__
from grader.classroom.gradebook.agreement import Agreement
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.hints import CommonFix
from grader.classroom.gradebook.sections import Comparison
from grader.classroom.gradebook.statistics import ClassStatistics
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.gradebook.summary import ClassSummary
from grader.report.as_json import KINDS
from grader.report.class_schemas import COUNTS
from grader.report.json_data import EDIT, exact, fields, rounded, to_json


def render_class_json(
    summary: ClassSummary, grades: Grades, run: dict[str, int] | None, comparison: Comparison | None = None
) -> str:
    """Return the statistics and all current grades; `run` counts what a batch has done, `comparison` is of sections."""
    rubric, late = summary.rubric, summary.late
    return to_json(
        {
            "schema": "grader/class/v1",
            "grader": {"version": __version__},
            "rubric": {"id": rubric.id, "title": rubric.title, "sha256": rubric.sha256},
            **({"run": run} if run is not None else {}),
            "statistics": _statistics(summary.statistics),
            "fixes": list(map(_fix, summary.fixes)),
            "identical": [
                {"students": list(work.students), "same_file": list(map(list, work.same_file))}
                for work in summary.identical
            ],
            "agreement": _agreement(summary.agreement),
            **({"comparison": _comparison(comparison)} if comparison is not None else {}),
            "needs_attention": summary.attention.total,
            "attention": [
                {"reason": group.reason, "students": [{"id": item.key, "detail": item.detail} for item in group.items]}
                for group in summary.attention.groups
            ],
            "evidence_without_urdf": summary.evidence_only["URDF"],
            "evidence_without_package": summary.evidence_only["package"],
            "late": {"count": late.students, **fields(late, "lost least most")},
            "students": [_grade(grade, grades.carried(grade)) for grade in grades.all()],
        }
    )


def _grade(grade: StudentGrade, carried: list[str]) -> dict[str, Any]:
    """Return a student's current grade as plain data."""
    student, has_result = grade.student, grade.result is not None
    return {
        "id": student.key,
        **fields(student, "name email"),
        "status": grade.verdict,
        "reason": grade.reason,
        "score": exact(grade.score) if has_result else None,
        "max_score": exact(grade.out_of) if has_result else None,
        "pending": exact(grade.pending) if has_result else None,
        "late": fields(grade.late, "days points reason"),
        "total": exact(grade.total) if has_result or grade.final is not None else None,
        "final_mark": exact(grade.final),
        "is_excused": grade.is_excused,
        "is_final": not grade.why_not_final,
        "carried": carried,
        "manual_marks": grade.marks,
        "paths": list(grade.files.paths),
        **fields(grade.files, "attempt earlier"),
    }


def _fix(fix: CommonFix) -> dict[str, Any]:
    """Return a change that several students need as plain data."""
    return {**fields(fix, "action count criteria points"), "example": list(map(EDIT.data, fix.example))}


def _statistics(statistics: ClassStatistics) -> dict[str, Any]:
    """Return the statistics as plain data, shares and correlations rounded to 1e-6."""
    return {
        "counts": dict(sorted(statistics.verdicts.items())),
        "max_score": exact(statistics.out_of),
        "final_marks": statistics.final,
        **fields(statistics, "excused graded pending undecided"),
        "points": fields(statistics.points, "earned lost pending"),
        "reasons": [{"reason": reason, "count": count} for reason, count in statistics.reasons],
        **fields(statistics, "mean deviation lowest median highest"),
        "tenths": list(statistics.bins),
        "criteria": [
            {
                "id": row.criterion.id,
                "max_points": exact(row.criterion.points),
                **KINDS.data(row.criterion),
                **fields(row, f"{COUNTS} share discrimination"),
            }
            for row in statistics.criteria
        ],
        "failures": [
            {"criterion": failure.criterion.id, "message": failure.message, "count": failure.count}
            for failure in statistics.failures
        ],
    }


def _comparison(comparison: Comparison) -> dict[str, Any]:
    """Return the comparison as plain data, shares rounded to 1e-6."""
    return {
        "by": comparison.by,
        "groups": [
            {
                **fields(section, "name students graded late late_points mean median"),
                "shares": {
                    row.id: rounded(share) for row, share in zip(comparison.criteria, section.shares, strict=True)
                },
            }
            for section in comparison.sections
        ],
        "differing": [comparison.criteria[position].id for position in comparison.differing],
    }


def _agreement(agreement: Agreement) -> dict[str, Any]:
    return {
        **fields(agreement, "items same mean_difference_percent"),
        "largest": [
            {"id": item.key, **fields(item, "criterion first second max_points")} for item in agreement.largest
        ],
    }
