"""A report as JSON, schema grader/report/v1: `grader schema report` describes it."""

from dataclasses import asdict
from typing import Any

from grader.grading.criterion import Criterion
from grader.grading.report import Hint, Report, Result
from grader.report.json_data import edit, exact, location, problem, rounded, to_json


def render_json(report: Report) -> str:
    """Return the report. It has no clock, absolute path or random order: the same input gives the same bytes."""
    return to_json(report_data(report))


def report_data(report: Report) -> dict[str, Any]:
    """Return the report as plain data."""
    submission, rubric = report.submission, report.rubric
    return {
        "schema": "grader/report/v1",
        "grader": {"version": report.version},
        "rubric": {"id": rubric.id, "title": rubric.title, "sha256": rubric.sha256},
        "submission": {
            "id": submission.id,
            "path": submission.path,
            "sha256": submission.sha256,
            "package": submission.package and (submission.package.folder or "."),  # "." is the submission itself
            "other_candidates": [{"path": file.path, "reason": file.reason} for file in submission.other_candidates],
            "ignored": list(submission.ignored),
        },
        "notes": list(report.notes),
        "parts": list(report.parts),
        "score": exact(report.score),
        "max_score": exact(report.max_score),
        "pending": exact(report.pending),
        **grade_data(report),
        "problems": [problem(found) for found in report.problems],
        "results": [_result(result) for result in report.results],
        "evidence": [
            {
                "id": found.evidence.id,
                "part": found.evidence.part,
                "title": found.evidence.title,
                "files": list(map(asdict, found.files)),
                "possible": list(map(asdict, found.possible)),
            }
            for found in report.exhibits
        ],
        "other_pictures": list(map(asdict, report.others)),
    }


def grade_data(report: Report) -> dict[str, Any]:
    """Return the key with the grade of a student in a class, if a person or the late penalty changes the score."""
    if report.grade is None:
        return {}
    points, late, is_final = report.grade
    return {"grade": {"points": exact(points) if points is not None else None, "late": exact(late), "final": is_final}}


def _result(result: Result) -> dict[str, Any]:
    criterion, outcome = result.criterion, result.outcome
    is_failed = outcome.status == "failed" and not result.why_given
    return {
        "id": criterion.id,
        "part": criterion.part,
        "title": criterion.title,
        "status": outcome.status,
        "points": exact(result.points),
        "max_points": exact(criterion.points),
        "message": outcome.message,
        "measured": rounded(outcome.measured),
        "expected": criterion.answer or rounded(outcome.expected),
        "tolerance": outcome.tolerance,
        "unit": outcome.unit,
        "because": result.because,
        "carried": result.carried or None,
        "location": location(outcome.location),
        "feedback": criterion.feedback if is_failed else "",
        "hints": list(map(_hint, result.hints)),
        **additions(result),
    }


def additions(result: Result) -> dict[str, Any]:
    """Return the keys that few criteria have: extra credit, an adjustment, a manual mark, a comment without points."""
    mark, comment = result.manual_mark, result.comment
    return {
        **kinds(result.criterion),
        **({"mark": {"points": exact(mark.points), "by": mark.by, "comment": mark.comment}} if mark else {}),
        **({"comment": comment._asdict()} if comment else {}),
    }


def kinds(criterion: Criterion) -> dict[str, Any]:
    """Return the keys that few criteria of a rubric have: extra credit, an adjustment."""
    return {
        **({"bonus": True} if criterion.bonus else {}),
        **({"adjustment": criterion.adjustment._asdict()} if criterion.adjustment is not None else {}),
    }


def _hint(hint: Hint) -> dict[str, Any]:
    gains = {name: exact(points) for name, points in hint.gains.items()}
    return {"message": hint.message, "edits": list(map(edit, hint.edits)), "gains": gains, "verified": True}
