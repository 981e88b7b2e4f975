"""A report as Gradescope's results.json: a test for each criterion, with the points that it earns.

What needs manual grading has no points here, because Gradescope would show them as lost; give them in Gradescope. Extra credit
has points, but no maximum (`max_score` is optional). The maxima add up to the autograder points of the assignment; the score,
which is given as a whole, may exceed them.
https://gradescope-autograders.readthedocs.io/en/latest/specs/#output-format
"""

from typing import Any

from grader.grading.report import Report, Result
from grader.report.as_json import additions
from grader.report.json_data import exact, to_json
from grader.report.markdown import criterion_markdown, overview_markdown
from grader.report.order import is_failure
from grader.text import counted_points, printable


def render_gradescope(report: Report) -> str:
    """Return the report. Students see it at once, unless the assignment's settings hide it."""
    return to_json(
        {
            "score": exact(report.counting if report.counting is not None else report.score),
            "output": overview_markdown(report),
            "output_format": "md",
            "test_output_format": "md",
            "test_name_format": "text",
            "visibility": "visible",
            "stdout_visibility": "hidden",
            "extra_data": {
                "grader": report.version,
                "rubric": printable(report.rubric.id),
                "rubric_sha256": report.rubric.sha256,
                "submission_sha256": report.submission.sha256,
                "pending": exact(report.pending),
            },
            "tests": [_test(result, report) for result in report.results],
        }
    )


def _test(result: Result, report: Report) -> dict[str, Any]:
    criterion = result.criterion
    parts = [part.id for part in report.rubric.parts]
    of_part = [other.id for other in report.rubric.criteria if other.part == criterion.part]
    number = f"{parts.index(criterion.part) + 1}.{of_part.index(criterion.id) + 1}"
    is_lost = is_failure(result) or (result.outcome.status == "skipped" and not result.is_adjusted)
    decided = {
        "score": exact(result.points),
        **({} if criterion.bonus else {"max_score": exact(criterion.points)}),
        "status": "failed" if is_lost else "passed",
    }
    kinds = [*(["extra credit"] if criterion.bonus else []), *(["manual grading"] if result.is_open else [])]
    most = f" ({', '.join((f'up to {counted_points(criterion.points)}', *kinds))})" if kinds else ""
    return {
        **({} if result.is_open else decided),
        "name": printable(criterion.title) + most,
        "number": number,
        "output": criterion_markdown(result, report),
        "output_format": "md",
        "tags": [criterion.id, criterion.part, "adjusted" if result.is_adjusted else result.outcome.status],
        "visibility": "visible",
        "extra_data": {
            "id": criterion.id,
            "status": result.outcome.status,
            "because": result.because,
            "carried": result.carried or None,
            **additions(result),
        },
    }
