"""An inspection as JUnit XML: a suite for each file, a test case for each finding.

An error is a failure; warnings and notes are skipped. The first suite says what was inspected, and
passes.
"""

from itertools import groupby
from typing import Any

from lxml import etree

from grader.base.text import printable
from grader.report.findings import (
    Finding,
    findings_in_inspection,
    message_in_repository,
    place_in_repository,
)
from grader.report.inspection import Inspection, problem_counts
from grader.report.locations import excerpt_lines, location_text


def inspection_junit(inspection: Inspection) -> str:
    """Return the findings of an inspection as JUnit XML."""
    findings = findings_in_inspection(inspection)
    title = f"{printable(inspection.path)}: {problem_counts(inspection)}"
    top = etree.Element("testsuites", {"name": title, **_counts(findings, 1)})
    first = etree.SubElement(top, "testsuite", {"name": "grader inspect", **_counts([], 1)})
    case = etree.SubElement(first, "testcase", name=title, classname="grader.inspect")
    if inspection.extent:
        etree.SubElement(case, "system-out").text = f"{printable(inspection.extent.words)}\n"
    for path, of_file in groupby(findings, key=lambda finding: finding.location.path):
        some = list(of_file)
        attributes = {"name": printable(path), **_counts(some)}
        suite = etree.SubElement(top, "testsuite", attributes)
        for finding in some:
            _add_case(suite, finding, inspection)
    etree.indent(top)
    return etree.tostring(top, encoding="utf-8", xml_declaration=True).decode() + "\n"


def _counts(findings: list[Finding], passed: int = 0) -> dict[str, str]:
    failures = [finding for finding in findings if finding.severity == "error"]
    return {
        "tests": str(len(findings) + passed),
        "failures": str(len(failures)),
        "errors": "0",
        "skipped": str(len(findings) - len(failures)),
    }


def _add_case(suite: Any, finding: Finding, inspection: Inspection) -> None:
    path, where = place_in_repository(finding, inspection.base)
    message = message_in_repository(finding, inspection.base)
    name = f"{finding.rule.label} {message}"
    case = etree.SubElement(suite, "testcase", name=name, classname=f"grader.{finding.rule.id}")
    if where:
        case.set("file", path)
        case.set("line", str(where.line))
    attributes = {"type": finding.severity, "message": message}
    kind = "failure" if finding.severity == "error" else "skipped"
    lines = [location_text(finding.location), *excerpt_lines(finding.location, inspection.source)]
    etree.SubElement(case, kind, attributes).text = "\n".join(lines) + "\n"
