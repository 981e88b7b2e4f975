"""A report as JSON, schema grader/report/v1: `grader schema report` describes it."""

from typing import Any

from grader import __version__
from grader.grading.report import Report, Result
from grader.report.plain import exact, location, problem, rounded, to_json


def render_json(report: Report) -> str:
    """The whole report. No clock, no absolute path, no random order: same input, same bytes."""
    return to_json(report_data(report))


def report_data(report: Report) -> dict[str, Any]:
    """The report as plain data."""
    submission, rubric = report.submission, report.rubric
    return {
        "schema": "grader/report/v1",
        "grader": {"version": __version__},
        "rubric": {"id": rubric.id, "title": rubric.title, "sha256": rubric.sha256},
        "submission": {"id": submission.id, "path": submission.path, "sha256": submission.sha256},
        "parts": list(report.parts),
        "score": exact(report.score),
        "max_score": exact(report.max_score),
        "pending": exact(report.pending),
        "problems": [problem(each) for each in submission.urdf.problems],
        "results": [_result(result) for result in report.results],
    }


def _result(result: Result) -> dict[str, Any]:
    criterion, outcome = result.criterion, result.outcome
    return {
        "id": criterion.id,
        "part": criterion.part,
        "title": criterion.title,
        "status": outcome.status,
        "points": exact(result.points),
        "max_points": exact(criterion.points),
        "message": outcome.message,
        "measured": rounded(outcome.measured),
        "expected": rounded(outcome.expected),
        "tolerance": outcome.tolerance,
        "unit": outcome.unit,
        "because": result.because,
        "location": location(outcome.location),
        "feedback": criterion.feedback if outcome.status == "failed" else "",
        "hints": [],
    }
