"""A report as JUnit XML: a suite for each part, a test case for each criterion. Jenkins, GitLab and others show it.

A failure is the student's, an error the grader's. What needs manual grading and extra credit that was not earned are skipped.
There are no times: the same submission gives the same report.
"""

from itertools import groupby
from typing import Any

from lxml import etree

from grader.grading.report import Report, Result
from grader.report.content import counting_text, earned_text, other_problems, score_text
from grader.report.details import result_details
from grader.report.locations import Base, archive_around
from grader.report.order import is_failure
from grader.report.plain_text import criterion_lines, problem_line, provenance, submission_lines
from grader.text import format_points, printable


def render_junit(report: Report, base: Base) -> str:
    """Return the report; its paths are those in the repository, where the submission is at `base`."""
    top = etree.Element("testsuites", {"name": printable(report.rubric.title), **_counts(report.results)})
    titles = {part.id: part.title for part in report.rubric.parts}
    said = [
        score_text(report),
        *submission_lines(report),
        *map(problem_line, other_problems(report)),
        provenance(report),
    ]
    suites = [
        (titles[part], tuple(some)) for part, some in groupby(report.results, key=lambda result: result.criterion.part)
    ]
    for number, (title, results) in enumerate(suites or [(report.rubric.title, ())]):
        suite = etree.SubElement(top, "testsuite", {"name": printable(title), **_counts(results)})
        if number == 0:  # the format has no other place for it that every reader shows
            _properties(suite, _submission_properties(report))
        for result in results:
            _case(suite, result, report, base)
        if number == 0:
            etree.SubElement(suite, "system-out").text = "\n".join(said) + "\n"
    etree.indent(top)
    return etree.tostring(top, encoding="utf-8", xml_declaration=True).decode() + "\n"


def _counts(results: tuple[Result, ...]) -> dict[str, str]:
    kinds = [_kind(result) for result in results]
    named = {"failures": "failure", "errors": "error", "skipped": "skipped"}
    return {"tests": str(len(kinds)), **{key: str(kinds.count(kind)) for key, kind in named.items()}}


def _kind(result: Result) -> str:
    """Return the element for the status of a criterion; empty if it has all points."""
    if is_failure(result) and result.criterion.bonus:
        return "skipped"
    if is_failure(result):
        return "error" if result.outcome.status == "errored" and result.manual_mark is None else "failure"
    is_decided = result.manual_mark is not None or result.is_adjusted
    return "skipped" if not is_decided and result.outcome.status in ("skipped", "pending") else ""


def _submission_properties(report: Report) -> dict[str, str]:
    submission = report.submission
    return {
        "score": format_points(report.score),
        "max_score": format_points(report.max_score),
        "pending": format_points(report.pending),
        **({"grade": counting_text(report)} if report.grade is not None else {}),
        "submission": printable(submission.id),
        "submission_sha256": submission.sha256 or "",
        "rubric": printable(report.rubric.id),
        "rubric_sha256": report.rubric.sha256,
        "grader": report.version,
    }


def _case(suite: Any, result: Result, report: Report, base: Base) -> None:
    criterion = result.criterion
    case = etree.SubElement(
        suite,
        "testcase",
        name=printable(f"{criterion.title} ({criterion.id})"),
        classname=f"{report.rubric.id}.{criterion.part}",
    )
    where = result_details(result, report).location
    if where is not None and where.path != "-" and not (base.archive or archive_around(where.path)):
        case.set("file", printable(base.folder + where.path))
        case.set("line", str(where.line))
    _properties(case, {"points": earned_text((result,))})
    lines = criterion_lines(result, report)
    kind = _kind(result)
    if not kind:
        etree.SubElement(case, "system-out").text = "\n".join(lines) + "\n"
        return
    found = etree.SubElement(
        case, kind, type="manual mark" if result.manual_mark else result.outcome.status, message=lines[0]
    )
    found.text = "\n".join(lines) + "\n"


def _properties(element: Any, values: dict[str, str]) -> None:
    properties = etree.SubElement(element, "properties")
    for name, value in values.items():
        etree.SubElement(properties, "property", name=name, value=value)
