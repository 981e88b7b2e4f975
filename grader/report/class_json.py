"""A class as JSON, schema grader/class/v1."""

from collections.abc import Iterable
from typing import Any

from grader import __version__
from grader.classroom.gradebook.grades import Looks, Standing
from grader.classroom.gradebook.statistics import ClassStatistics, CriterionStatistics
from grader.grading.rubric import Rubric
from grader.report.json_data import exact, rounded, to_json


def render_class_json(
    rubric: Rubric, statistics: ClassStatistics, standings: Iterable[Standing], looks: Looks, run: dict[str, int] | None
) -> str:
    """Everyone's current grade and the statistics; `run` counts what the batch has done, if there was one just now."""
    return to_json(
        {
            "schema": "grader/class/v1",
            "grader": {"version": __version__},
            "rubric": {"id": rubric.id, "title": rubric.title, "sha256": rubric.sha256},
            **({"run": run} if run is not None else {}),
            "statistics": statistics_data(statistics),
            "needs_a_look": looks.total,
            "students": [standing_data(each) for each in standings],
        }
    )


def standing_data(standing: Standing) -> dict[str, Any]:
    """One student's current grade as plain data."""
    student, has_result = standing.student, standing.result is not None
    return {
        "id": student.key,
        "name": student.name,
        "email": student.email,
        "status": standing.verdict,
        "reason": standing.reason,
        "score": exact(standing.score) if has_result else None,
        "max_score": exact(standing.out_of) if has_result else None,
        "pending": exact(standing.pending) if has_result else None,
        "late": {"days": standing.late.days, "points": exact(standing.late.points), "because": standing.late.words},
        "total": exact(standing.total) if has_result else None,
        "is_final": not standing.why_not_final,
        "marks_by_hand": standing.marks,
        "paths": list(standing.origin.paths),
        "attempt": standing.attempt,
        "earlier": list(standing.earlier),
    }


def statistics_data(statistics: ClassStatistics) -> dict[str, Any]:
    """The statistics as plain data; shares and correlations to 1e-6."""
    return {
        "counts": dict(sorted(statistics.verdicts.items())),
        "max_score": exact(statistics.out_of),
        "graded": statistics.graded,
        "pending": statistics.pending,
        "mean": rounded(statistics.mean),
        "deviation": rounded(statistics.deviation),
        "lowest": exact(statistics.lowest),
        "median": exact(statistics.median),
        "highest": exact(statistics.highest),
        "tenths": list(statistics.bins),
        "criteria": [_criterion(each) for each in statistics.criteria],
        "failures": [
            {"criterion": each.criterion.id, "message": each.message, "count": each.count}
            for each in statistics.failures
        ],
    }


def _criterion(each: CriterionStatistics) -> dict[str, Any]:
    return {
        "id": each.criterion.id,
        "max_points": exact(each.criterion.points),
        "passed": each.passed,
        "marked_by_hand": each.marked,
        "failed": each.failed,
        "skipped": each.skipped,
        "pending": each.pending,
        "errored": each.errored,
        "share": rounded(each.share),
        "discrimination": rounded(each.discrimination),
    }
