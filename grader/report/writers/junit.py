"""A report as JUnit XML: a suite for each part, a test case for each criterion.

Jenkins, GitLab and others show it.

A failure is the student's, an error the grader's. What needs manual grading and extra credit that
was not earned are skipped. There are no times: the same submission gives the same report.
"""

from itertools import groupby
from typing import Any

from lxml import etree

from grader.base.source import Base
from grader.base.text import format_points, printable
from grader.lab.grading.report import Report, Result
from grader.report.content import (
    closing_lines,
    counting_text,
    entries,
    graded_line,
    head,
    report_sections,
)
from grader.report.criteria import Entry, earned_text, is_failure, name_status, plain_lines
from grader.report.locations import archive_around

# The element for each status of a criterion that is not passed.
_KINDS = {
    "failed": "failure",
    "partial": "failure",
    "errored": "error",
    "skipped": "skipped",
    "pending": "skipped",
}
_COUNTS = {"failures": "failure", "errors": "error", "skipped": "skipped"}


def render_junit(report: Report, base: Base) -> str:
    """Return the report as JUnit XML.

    Its paths are those in the repository, where the submission is at `base`.
    """
    top = etree.Element("testsuites", {"name": graded_line(report), **_counts(report.results)})
    said = [*(line.text for line in head(report, report_sections(report))), *closing_lines(report)]
    parts = groupby(entries(report).values(), key=lambda entry: entry.result.criterion.part)
    suites = [(report.rubric.part(part).title, tuple(some)) for part, some in parts]
    for number, (title, some) in enumerate(suites or [(report.rubric.title, ())]):
        counts = _counts(tuple(entry.result for entry in some))
        suite = etree.SubElement(top, "testsuite", {"name": printable(title), **counts})
        if number == 0:  # the format has no other place for it that every reader shows
            _properties(suite, _facts(report))
        for entry in some:
            _case(suite, entry, report, base)
        if number == 0:
            _put(suite, "system-out", said)
    etree.indent(top)
    return etree.tostring(top, encoding="utf-8", xml_declaration=True).decode() + "\n"


def _counts(results: tuple[Result, ...]) -> dict[str, str]:
    kinds = [_kind(result) for result in results]
    return {
        "tests": str(len(kinds)),
        **{key: str(kinds.count(kind)) for key, kind in _COUNTS.items()},
    }


def _kind(result: Result) -> str:
    """Return the element for the status of a criterion; empty if it has all points."""
    if result.carried:
        return ""
    if is_failure(result) and result.criterion.bonus:
        return "skipped"
    return _KINDS.get(name_status(result), "")


def _facts(report: Report) -> dict[str, str]:
    submission = report.submission
    return {
        "score": format_points(report.score),
        "max_score": format_points(report.max_score),
        "pending": format_points(report.pending),
        **({"grade": counting_text(report)} if report.grade else {}),
        "submission": printable(submission.id),
        "submission_sha256": submission.sha256 or "",
        "rubric": printable(report.rubric.id),
        "rubric_sha256": report.rubric.sha256,
        "grader": report.version,
    }


def _case(suite: Any, entry: Entry, report: Report, base: Base) -> None:
    result = entry.result
    criterion = entry.result.criterion
    where = entry.location
    name = printable(f"{criterion.title} ({criterion.id})")
    group = f"{report.rubric.id}.{criterion.part}"
    case = etree.SubElement(suite, "testcase", name=name, classname=group)
    if where and where.path != "-" and not (base.archive or archive_around(where.path)):
        case.set("file", printable(base.folder + where.path))
        case.set("line", str(where.line))
    _properties(case, {"points": earned_text(result)})
    kind = _kind(result)
    lines = plain_lines(entry, report.submission.source)
    if not kind:
        _put(case, "system-out", lines)
        return
    cause = "manual mark" if result.manual_mark else result.outcome.status
    _put(case, kind, lines, {"type": cause, "message": lines[0]})


def _put(parent: Any, tag: str, lines: list[str], attributes: dict[str, str] | None = None) -> None:
    etree.SubElement(parent, tag, attributes).text = "\n".join(lines) + "\n"


def _properties(element: Any, values: dict[str, str]) -> None:
    properties = etree.SubElement(element, "properties")
    for name, value in values.items():
        etree.SubElement(properties, "property", name=name, value=value)
