"""A report as the result file of a platform.

This is Gradescope's results.json or Classroom 50's result.json.

In Gradescope's, what needs manual grading has no points, because they would be shown as lost: give
them in Gradescope. Extra credit has points, but no maximum (`max_score` is optional). The maxima
add up to the autograder points of the assignment; the score, which is given as a whole, may exceed
them. https://gradescope-autograders.readthedocs.io/en/latest/specs/#output-format

The scores of Classroom 50's are whole numbers: if points are fractions, all are multiplied by 10,
100 and so on, so that none is rounded. Classroom 50 refuses scores above their maximum
(schemas/result-v1.schema.json, validate_result of its runner.py). So the score is at most the
maximum, even with extra credit. The test of a bonus shows its points, and is not part of the
maximum. https://github.com/foundation50/classroom50
"""

from typing import Any

from grader.base.errors import InputError
from grader.base.grouping import StringsByName
from grader.base.patterns import on_use
from grader.base.text import counted_points, printable
from grader.lab.grading.report import Report, Result
from grader.report.content import entries
from grader.report.criteria import Entry, earned_text, is_failure, plain_lines
from grader.report.json_data import exact, to_json
from grader.report.writers.as_json import ADDITIONS
from grader.report.writers.markdown import criterion_markdown, overview_markdown


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
            "tests": [_gradescope_test(entry, report) for entry in entries(report).values()],
        }
    )


def _gradescope_test(entry: Entry, report: Report) -> dict[str, Any]:
    result = entry.result
    criterion = entry.result.criterion
    status = entry.result.outcome.status
    kinds = []
    if criterion.bonus:
        kinds.append("extra credit")
    if result.is_open:
        kinds.append("manual grading")
    name = printable(criterion.title)
    if kinds:
        name += f" ({', '.join((f'up to {counted_points(criterion.points)}', *kinds))})"
    return {
        **({} if result.is_open else _gradescope_points(result)),
        "name": name,
        "output": criterion_markdown(entry, report),
        "output_format": "md",
        "tags": [criterion.id, criterion.part, "adjusted" if result.is_adjusted else status],
        "visibility": "visible",
        "extra_data": {
            "id": criterion.id,
            "status": status,
            "because": result.because,
            "carried": result.carried or None,
            **ADDITIONS.data(result),
        },
    }


def _gradescope_points(result: Result) -> dict[str, Any]:
    is_lost = is_failure(result) or (result.outcome.status == "skipped" and not result.is_adjusted)
    most = {} if result.criterion.bonus else {"max_score": exact(result.criterion.points)}
    return {"score": exact(result.points), **most, "status": "failed" if is_lost else "passed"}


_REQUIRED = ("CLASSROOM", "ASSIGNMENT", "SUBMISSION_TAG", "USERNAME", "COMMIT_URL", "RELEASE_URL")
_KINDS = ("individual", "group", "team")
_TAG = on_use(
    r"submit/([0-9]{4}-[01][0-9]-[0-3][0-9])T([01][0-9]|2[0-3])-([0-5][0-9])-([0-5][0-9])Z-[!-~]+"
)


def identity_from(environment: StringsByName) -> dict[str, str]:
    """Return whose result it is, from the runner's environment variables.

    Raises InputError if some are missing.
    """
    missing = [name for name in _REQUIRED if not environment.get(name)]
    if missing:
        raise InputError(
            f"classroom50 requires {', '.join(missing)} in the environment: Classroom 50's "
            "runner sets them"
        )
    given = {name: printable(environment[name]) for name in _REQUIRED}
    tag = _TAG.fullmatch(environment["SUBMISSION_TAG"])
    if not tag:
        raise InputError(
            "SUBMISSION_TAG must look like submit/2026-09-01T10-00-00Z-ab12cd3, not "
            f"{given['SUBMISSION_TAG']!r}"
        )
    day, hour, minute, second = tag.groups()
    kind = environment.get("ASSIGNMENT_TYPE") or _KINDS[0]
    if kind not in _KINDS:
        kinds = ", ".join(_KINDS)
        raise InputError(f"ASSIGNMENT_TYPE must be one of {kinds}, not {printable(kind)!r}")
    review = printable(environment.get("REVIEW_URL") or environment["COMMIT_URL"])
    return {
        "classroom": given["CLASSROOM"],
        "assignment": given["ASSIGNMENT"],
        "assignment_type": kind,
        "owner": given["USERNAME"],
        "submission": given["SUBMISSION_TAG"],
        "commit": given["COMMIT_URL"],
        "release": given["RELEASE_URL"],
        "review": review,
        "datetime": f"{day}T{hour}:{minute}:{second}Z",  # replaced by the commit's time
    }


def render_classroom50(report: Report, identity: StringsByName) -> str:
    """Return the report. What needs manual grading has not passed and has no points."""
    scale = _scale(report)
    return to_json(
        {
            "schema": "classroom50/result/v1",
            **identity,
            "score": int(min(report.score, report.max_score) * scale),
            "max-score": int(report.max_score * scale),
            "tests": [
                _classroom50_test(entry, report, scale) for entry in entries(report).values()
            ],
        }
    )


def _scale(report: Report) -> int:
    """Return the factor that makes all points whole: 1, 10, 100 and so on."""
    points = [
        number for result in report.results for number in (result.points, result.criterion.points)
    ]
    digits = max((-int(number.normalize().as_tuple().exponent) for number in points), default=0)
    return int(10 ** max(0, digits))


def _classroom50_test(entry: Entry, report: Report, scale: int) -> dict[str, Any]:
    result = entry.result
    lines = plain_lines(entry, report.submission.source)
    if result.criterion.bonus:
        lines = [f"Extra credit: {earned_text(result)}. It is not part of the maximum.", *lines]
    return {
        "test-name": printable(f"{result.criterion.title} ({result.id})"),
        "passed": entry.status in ("passed", "adjusted"),
        "score": int(min(result.points, result.criterion.points) * scale),
        "max-score": int(result.criterion.points * scale),
        "message": "\n".join(lines),
    }
