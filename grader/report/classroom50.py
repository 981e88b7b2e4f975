"""A report as Classroom 50's result.json, schema classroom50/result/v1. Its scores are whole numbers.

If points are fractions, all are multiplied by 10, 100 and so on, so that none is rounded. Classroom 50 refuses scores above their
maximum (schemas/result-v1.schema.json, validate_result of its runner.py). So the score is at most the maximum, even with extra
credit. The test of a bonus shows its points, and is not part of the maximum.
https://github.com/foundation50/classroom50
"""

import re
from collections.abc import Mapping
from typing import Any

from grader.errors import InputError
from grader.grading.report import Report, Result
from grader.report.content import earned_text
from grader.report.json_data import to_json
from grader.report.order import is_failure
from grader.report.plain_text import criterion_lines
from grader.text import printable

_REQUIRED = ("CLASSROOM", "ASSIGNMENT", "SUBMISSION_TAG", "USERNAME", "COMMIT_URL", "RELEASE_URL")
_KINDS = ("individual", "group", "team")
_TAG = re.compile(r"submit/([0-9]{4}-[01][0-9]-[0-3][0-9])T([01][0-9]|2[0-3])-([0-5][0-9])-([0-5][0-9])Z-[!-~]+")


def identity_from(environment: Mapping[str, str]) -> dict[str, str]:
    """Return whose result it is, from the runner's environment variables. Raises InputError if some are missing."""
    missing = [name for name in _REQUIRED if not environment.get(name)]
    if missing:
        raise InputError(
            f"classroom50 requires {', '.join(missing)} in the environment: Classroom 50's runner sets them"
        )
    given = {name: printable(environment[name]) for name in _REQUIRED}
    time = _TAG.fullmatch(environment["SUBMISSION_TAG"])
    if time is None:
        raise InputError(
            f"SUBMISSION_TAG must look like submit/2026-09-01T10-00-00Z-ab12cd3, not {given['SUBMISSION_TAG']!r}"
        )
    kind = environment.get("ASSIGNMENT_TYPE") or _KINDS[0]
    if kind not in _KINDS:
        raise InputError(f"ASSIGNMENT_TYPE must be one of {', '.join(_KINDS)}, not {printable(kind)!r}")
    return {
        "classroom": given["CLASSROOM"],
        "assignment": given["ASSIGNMENT"],
        "assignment_type": kind,
        "owner": given["USERNAME"],
        "submission": given["SUBMISSION_TAG"],
        "commit": given["COMMIT_URL"],
        "release": given["RELEASE_URL"],
        "review": printable(environment.get("REVIEW_URL") or environment["COMMIT_URL"]),
        "datetime": f"{time[1]}T{time[2]}:{time[3]}:{time[4]}Z",  # the runner replaces it by the commit's time
    }


def render_classroom50(report: Report, identity: Mapping[str, str]) -> str:
    """Return the report. What needs manual grading has not passed and has no points."""
    scale = _scale(report)
    return to_json(
        {
            "schema": "classroom50/result/v1",
            **identity,
            "score": int(min(report.score, report.max_score) * scale),
            "max-score": int(report.max_score * scale),
            "tests": [_test(result, report, scale) for result in report.results],
        }
    )


def _scale(report: Report) -> int:
    """Return the factor that makes all points whole: 1, 10, 100 and so on."""
    points = [number for result in report.results for number in (result.points, result.criterion.points)]
    digits = max((-int(number.normalize().as_tuple().exponent) for number in points), default=0)
    return int(10 ** max(0, digits))


def _test(result: Result, report: Report, scale: int) -> dict[str, Any]:
    is_decided = result.manual_mark is not None or result.is_adjusted
    bonus = (
        [f"Extra credit: {earned_text((result,))}. It is not part of the maximum."] if result.criterion.bonus else []
    )
    return {
        "test-name": printable(f"{result.criterion.title} ({result.criterion.id})"),
        "passed": not is_failure(result) and (is_decided or result.outcome.status == "passed"),
        "score": int(min(result.points, result.criterion.points) * scale),
        "max-score": int(result.criterion.points * scale),
        "message": "\n".join((*bonus, *criterion_lines(result, report))),
    }
